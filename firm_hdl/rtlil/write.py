"""Write RTLIL as `amaranth.back.rtlil` does, and quickly for designs with large memories.

Amaranth writes a bit for each bit of a memory. For a memory of a megabyte, that takes half a minute
and 8 MB of text. RTLIL extends a constant that has fewer digits than bits by its first digit, so
``8388608'0`` is the same (Yosys, ``frontends/rtlil/rtlil_parser.y``).
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

from amaranth.back import rtlil
from amaranth.hdl import Elaboratable, Fragment, ValueCastable, _ir, _nir
from amaranth.hdl._ir import PortDirection
from amaranth.lib import wiring

from firm_hdl.names.attributes import PURPOSE
from firm_hdl.rtlil.connections import check_connections

__all__ = ["convert_fragment", "rtlil_of"]


_SECTION = re.compile(r"^\w+\n-{3,}$", re.MULTILINE)
_ROLE = re.compile(r":\w+:`\.?(\w+)`")


def rtlil_of(design: Any, *, name: str, ports: Any = None, platform: Any = None) -> str:
    """Return the RTLIL of a design, without source attributes, which have paths of the machine.

    * `design`: a component or other elaboratable, or already RTLIL.
    * `name`: name of the outermost module.
    * `ports`, `platform`: as for `amaranth.back.rtlil.convert`; a component needs no ports.

    Raises `TypeError` if the design or its name is none, or an elaboratable that is no component
    has no ports. Raises `ValueError` if the name is no word. Raises `wiring.ConnectionError`: as
    :func:`.check_connections`.
    """
    if not isinstance(name, str):
        raise TypeError(f"Name of a design must be a text, not {name!r}")
    if [name] != name.split():
        raise ValueError(f"Name of a design must be one word, not {name!r}")
    if isinstance(design, str):
        return design
    if not isinstance(design, Elaboratable | Fragment):
        raise TypeError(
            "A design must be an Amaranth component or another elaboratable, or the text of its "
            f"RTLIL, not {design!r}"
        )
    if ports is None and not isinstance(getattr(design, "signature", None), wiring.Signature):
        raise TypeError(
            f"{design!r} is no component of amaranth.lib.wiring, so its ports must be given: "
            "ports=[...]"
        )
    fragment = Fragment.get(design, platform)
    check_connections(fragment)
    if ports is None:
        ports = {
            "__".join(map(str, path)): (
                value.as_value() if isinstance(value, ValueCastable) else value,
                PortDirection.Input if member.flow == wiring.In else PortDirection.Output,
            )
            for path, member, value in design.signature.flatten(design)
        }
    return convert_fragment(fragment, ports, name=name)


def convert_fragment(fragment: Fragment | _ir.Design, ports: Any, *, name: str) -> str:
    """Return an elaborated design as RTLIL. Parameters are those of `amaranth.back.rtlil`."""
    top = fragment.fragment if isinstance(fragment, _ir.Design) else fragment
    purposes = dict(_purposes(top, (name,)))
    netlist = _ir.build_netlist(fragment, ports=ports, name=name)
    empty = rtlil.EmptyModuleChecker(netlist)
    design, names = rtlil.Design(emit_src=False), rtlil._ast.SignalDict()
    for index, module in enumerate(netlist.modules):
        if empty.is_empty(index):
            continue
        builder = design.module(".".join(module.name), src_loc=module.src_loc)
        if index == 0:
            builder.attribute("top", 1)
        if purpose := purposes.get(module.name):
            builder.attribute(PURPOSE, purpose)
        _Emitter(builder, netlist, module, names, empty_checker=empty).emit()
    return str(design)


def _purposes(fragment: Fragment, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield the paths of modules, and what their docstrings say about them.

    So the docstring of a component is text of the generated files, and a wave form in it, too.
    """
    for origin in (fragment.origins or ())[:1]:
        text = inspect.getdoc(type(origin)) or ""
        if text and not type(origin).__module__.startswith("amaranth."):
            first, _, rest = text.partition("\n\n")
            purpose = f"{type(origin).__name__}: {' '.join(first.split())}"
            if type(origin).__module__.startswith("firm_hdl."):
                # All before the sections of a docstring, such as "Parameters", in plain text.
                rest = _SECTION.split(rest)[0].strip()
                purpose += "\n\n" * bool(rest) + _ROLE.sub(r"\1", rest).replace("::\n", ":\n")
            yield path, purpose
    for part, name, _ in fragment.subfragments:
        if name is not None:
            yield from _purposes(part, (*path, name))


class _Emitter(rtlil.ModuleEmitter):
    def emit_memory(self, cell_idx: int, cell: _nir.Memory) -> None:
        if any(cell.init) or not cell.width * cell.depth:
            super().emit_memory(cell_idx, cell)
            return
        self.builder.cell(
            "$meminit_v2",
            ports={
                "ADDR": self.sigspec(),
                "DATA": f"{cell.width * cell.depth}'0",
                "EN": self.sigspec(_nir.Value.ones(cell.width)),
            },
            parameters={
                "MEMID": self.memories[cell_idx].memid,
                "ABITS": 0,
                "WIDTH": cell.width,
                "WORDS": cell.depth,
                "PRIORITY": 0,
            },
        )
