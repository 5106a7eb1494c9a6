"""Write RTLIL as `amaranth.back.rtlil` does, and quickly for designs with large memories.

Amaranth writes a bit for each bit of a memory. For a memory of a megabyte, that takes half a minute
and 8 MB of text. RTLIL extends a constant that has fewer digits than bits by its first digit, so
``8388608'0`` is the same (Yosys, ``frontends/rtlil/rtlil_parser.y``).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amaranth.back import rtlil
from amaranth.hdl import Fragment, Signal, _ir, _nir
from amaranth.lib import wiring

__all__ = ["convert", "convert_fragment"]


def convert(component: wiring.Component, *, name: str) -> str:
    """Return a component as RTLIL, without source attributes, which have paths of the machine.

    Parameters
    ----------
    component : wiring.Component
        Its members are the ports, with ``__`` between the names on the way to a member.
    name : str
        Name of the outermost module.
    """
    ports = {
        "__".join(map(str, path)): (
            getattr(value, "as_value", lambda value=value: value)(),
            _ir.PortDirection.Input if member.flow == wiring.In else _ir.PortDirection.Output,
        )
        for path, member, value in component.signature.flatten(component)
    }
    return convert_fragment(Fragment.get(component, None), ports, name=name)


def convert_fragment(
    fragment: Fragment, ports: dict[str, Any] | Sequence[Signal], *, name: str
) -> str:
    """Return an elaborated design as RTLIL. Parameters are those of `amaranth.back.rtlil`."""
    netlist = _ir.build_netlist(fragment, ports=ports, name=name)
    empty = rtlil.EmptyModuleChecker(netlist)
    design, names = rtlil.Design(emit_src=False), rtlil._ast.SignalDict()
    for index, module in enumerate(netlist.modules):
        if empty.is_empty(index):
            continue
        builder = design.module(".".join(module.name), src_loc=module.src_loc)
        if index == 0:
            builder.attribute("top", 1)
        _Emitter(builder, netlist, module, names, empty_checker=empty).emit()
    return str(design)


class _Emitter(rtlil.ModuleEmitter):  # type: ignore[misc]
    def emit_memory(self, cell_idx: int, cell: _nir.Memory) -> None:
        if any(cell.init):
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
