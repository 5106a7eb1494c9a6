"""Any component as a design of its own, with ports of plain vectors and of records.

The ports have the names that converters have: a packet stream and an AXI4-Stream have ``tdata``,
``tkeep`` and so on, and a leaf of a message has ``data``, ``valid`` and ``ready``. Beside the plain
ports, each message has a record in VHDL and a struct in SystemVerilog.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

from amaranth.hdl import Fragment, Value
from amaranth.hdl._xfrm import DomainCollector
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In

import firm_hdl
from firm_hdl import rtlil
from firm_hdl.errors import UserError
from firm_hdl.export.design import (
    BuiltDesign,
    core_file,
    design_folder,
    inputs_of_design,
    shared_unit,
    verilog_file,
    verilog_module,
    vhdl_folder,
    write_design,
)
from firm_hdl.export.message_ports import (
    FoundMessage,
    message_ports,
    record_facts,
    record_files,
    struct_files,
)
from firm_hdl.export.ports import PlainPort
from firm_hdl.export.top import AXIS_CLOCKS, Pin, PlainTop, check_input_bits
from firm_hdl.export.verilog.backend import waivers
from firm_hdl.garbage import search_put_off
from firm_hdl.gateware.signatures import MessageSignature, bus_bytes_of
from firm_hdl.names.identifiers import flat_names, identifier
from firm_hdl.plan import build_plan
from firm_hdl.vhdl.convert import convert
from firm_hdl.wire import lay_out

__all__ = ["ComponentPort", "ComponentTop", "Path", "PlainPorts", "build_component", "parts_of"]

Path = tuple[str, ...]

_AXIS = {"data": "tdata", "count": "tkeep", "last": "tlast", "valid": "tvalid", "ready": "tready"}


@dataclass(frozen=True, slots=True, kw_only=True)
class ComponentPort(PlainPort):
    """A port of the top level of a component."""

    signed: bool
    member: str  # The member of the component that it belongs to, or what it is.


@dataclass(frozen=True, slots=True)
class _Part:
    """A signal of a component, or a field of one; its port is a mask of `lanes`, if there are any.

    `spelled` is the path from which the name of the port is made.
    """

    path: Path
    spelled: Path
    flow: Any
    value: Value
    lanes: int = 0


def parts_of(
    component: wiring.Component, has_axis: Callable[[Path], bool] = lambda path: True
) -> Iterator[_Part]:
    """Yield the signals of the members of a component; of structures, their fields.

    * `has_axis`: whether a packet stream with that path has the ports of AXI4-Stream.
    """
    members = [
        (tuple(str(name) for name in path), member, value)
        for path, member, value in component.signature.flatten(component)
    ]
    lanes = {
        path[:-1]: bus_bytes_of(value)
        for path, _, value in members
        if path[-1:] == ("payload",) and has_axis(path[:-1])
    }
    for path, member, value in members:
        for inner, each in _fields(path, value):
            count = lanes.get(inner[:-1], 0)
            last = _AXIS.get(inner[-1], inner[-1]) if count else inner[-1]
            mask = count if last == "tkeep" else 0
            yield _Part(inner, (*inner[:-1], last), member.flow, each, mask)


def _fields(path: Path, value: Any) -> Iterator[tuple[Path, Value]]:
    """Yield the fields of a structure, and any other value as it is."""
    if isinstance(value, data.View) and isinstance(value.shape(), data.StructLayout):
        base = path[:-1] if path[-1] == "payload" else path
        for name in value.shape().members:
            yield from _fields((*base, name), value[name])
    elif path[-1] == "payload":
        yield (*path[:-1], "data"), Value.cast(value)
    else:
        yield path, Value.cast(value)


class PlainPorts:
    """The members of a component as ports of plain vectors.

    * `kind`: what the component is, for errors, and the name of its instance.
    * `clocks`: as for :class:`.PlainTop`.
    * `has_axis`, `spell`: as for :func:`parts_of`; `spell` returns the path from which a port's
      name is made.

    Raises `UserError` if there are more input bits than Amaranth elaborates.
    """

    def __init__(
        self,
        component: wiring.Component,
        *,
        kind: str,
        clocks: Mapping[str, tuple[str, str]] = AXIS_CLOCKS,
        has_axis: Callable[[Path], bool] = lambda path: True,
        spell: Callable[[Path], Path] = lambda path: path,
    ):
        self.component, self.kind, self.clocks = component, kind, clocks
        parts = list(parts_of(component, has_axis))
        reserved = [name for pair in clocks.values() for name in pair]
        names = flat_names((spell(part.spelled) for part in parts), reserved)
        # Those of the members. What has no bits has no port.
        self.pins = [
            Pin(
                port=ComponentPort(
                    name=names[spell(part.spelled)],
                    direction="in" if part.flow == In else "out",
                    width=part.lanes or len(part.value),
                    signed=part.value.shape().signed,
                    member=".".join(part.path),
                ),
                value=part.value,
                is_count=bool(part.lanes),
            )
            for part in parts
            if part.lanes or len(part.value)
        ]
        outer = (
            ComponentPort(name=name, direction="in", width=1, signed=False, member=member)
            for pair in clocks.values()
            for name, member in zip(pair, ("clock", "reset, low"), strict=True)
        )
        # Clocks and resets, and then the members.
        self.ports: tuple[ComponentPort, ...] = (*outer, *(pin.port for pin in self.pins))
        check_input_bits(f"The {kind}", self.ports)


class ComponentTop(PlainTop):
    """A component with ports of plain vectors. It adds neither registers nor latency.

    `inside` is the component, if it was elaborated already.
    """

    is_closed = False

    def __init__(self, plain: PlainPorts, inside: Any = None, also_resets: Value | None = None):
        inside = plain.component if inside is None else inside
        super().__init__(
            inside, plain.kind, plain.ports, plain.pins, plain.clocks, also_resets=also_resets
        )


def _messages(signature: Any, path: Path = ()) -> Iterator[FoundMessage]:
    """Yield the messages among the members of a component."""
    for name, member in signature.members.items():
        if not member.is_signature:
            continue
        for place in product(*map(range, member.dimensions)):
            here = (*path, name, *map(str, place))
            is_input = isinstance(member.signature, wiring.FlippedSignature)
            plain = member.signature.flip() if is_input else member.signature
            if isinstance(plain, MessageSignature):
                plan = build_plan(lay_out(plain.message, plain.wire), bus_bytes=plain.bus_bytes)
                way: Any = "serializer" if is_input else "deserializer"
                yield FoundMessage(here, way, plain.message, plan)
            else:
                yield from _messages(member.signature, here)


def _clocks(fragment: Fragment) -> dict[str, tuple[str, str]]:
    """Return the ports of the clock domains that a design uses and does not define."""
    collector = DomainCollector()
    collector(fragment)
    names = sorted(collector.used_domains - collector.defined_domains - {"comb"})
    prefixes = {name: "" if name == "sync" else f"{name}_" for name in names}
    ordered = sorted(names, key=lambda name: name != "sync")
    return {name: (f"{prefixes[name]}aclk", f"{prefixes[name]}aresetn") for name in ordered}


def build_component(
    component: wiring.Component,
    out: str | os.PathLike[str] = "designs_out",
    *,
    name: str,
    force: bool = False,
) -> BuiltDesign:
    """Write a component as VHDL and Verilog, with records and structs of its messages.

    The folder ``out/NAME`` has the entity ``NAME`` and the module ``NAME_verilog`` with ports of
    plain vectors, and, if members are messages, the entity ``NAME_records`` and the module
    ``NAME_sv``. A message has two ports there: one with data and valid of all fields, and one with
    ready, whose name ends in ``_rdy``. Their types are those that ``firm-hdl build`` writes for the
    same message, wire format and bus.

    A clock domain that the component does not define has the ports ``aclk`` and ``aresetn`` if it
    is `sync`, else ``DOMAIN_aclk`` and ``DOMAIN_aresetn``. Resets are synchronous and active low.

    Parameters
    ----------
    component : Component
        Any component of Amaranth. Its packet streams become AXI4-Stream.
    out : path
        Created if it does not exist.
    name : str
        Name of the folder and of the entity, in VHDL and Verilog.
    force : bool
        Write the folder even if it is current.

    Raises
    ------
    TypeError
        If it is no component.
    UserError
        If the name cannot be used, the component is too large, or the folder cannot be written.
    """
    if not isinstance(component, wiring.Component):
        raise TypeError(f"A component of Amaranth is needed, not {component!r}")
    if not isinstance(name, str) or identifier(name) != name:
        raise UserError(f"{name!r} is not a name in VHDL and Verilog")
    folder = design_folder(out, name)
    with search_put_off():
        fragment = Fragment.get(component, None)
        clocks = _clocks(fragment)
        plain = PlainPorts(component, kind="design", clocks=clocks)
        circuit = rtlil.rtlil_of(ComponentTop(plain, fragment), name=name)
    reason = "The component has no messages"
    messages = []
    try:
        messages = message_ports(list(_messages(component.signature)), plain.ports)
    except UserError as error:
        # The plain ports are there all the same.
        reason = str(error)
    module = verilog_module(name)

    def make_files() -> dict[str, str]:
        header = f"{name}: {type(component).__name__}\nMade by firm-hdl {firm_hdl.__version__}\n"
        netlist = rtlil.netlist_of(circuit)
        vhdl = convert(netlist, name=name, header=header)
        if vhdl.top != name:
            raise UserError(f"The VHDL of every design uses the name '{name}' itself")
        vhdl_ports = vhdl.entities[name].ports
        records = record_files(
            name, plain.ports, messages, kind="design", vhdl_ports=vhdl_ports, header=header
        )
        structs = struct_files(name, module, plain.ports, messages, kind="design", header=header)
        owners = {"The design": vhdl.files, "its messages": records, "its structs": structs}
        if shared := shared_unit(owners):
            raise UserError(f"{shared}; give the design another name")
        files = {**vhdl.files, **records}
        return {
            **verilog_file(netlist, name=name, header=header),
            "waivers.vlt": waivers([module]),
            **{f"systemverilog/{file}": text for file, text in structs.items()},
            **vhdl_folder(files),
            **core_file(name, files, kind="design", description=type(component).__name__),
        }

    facts = {
        "design": name,
        "clocks": [{"clock": clock, "reset": reset} for clock, reset in clocks.values()],
        "records": record_facts(name, messages, reason),
    }
    return write_design(
        folder,
        inputs=inputs_of_design(facts, circuit),
        facts=facts,
        ports=[asdict(port) for port in plain.ports],
        make_files=make_files,
        force=force,
    )
