"""Entities of the user's layer in VHDL: records outside, the circuit's plain ports inside."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from firm_hdl.export.ports import PlainPort, vhdl_type
from firm_hdl.export.primitives import TYPES_NAME, primitive_name
from firm_hdl.export.record_top import record_ports
from firm_hdl.export.top import Direction, Port, ports_of
from firm_hdl.export.tree import Tree
from firm_hdl.export.vhdl.constants import comment
from firm_hdl.export.vhdl.values import ValueType
from firm_hdl.plan import Plan

__all__ = [
    "IEEE",
    "LIBRARIES",
    "Conversions",
    "Core",
    "Line",
    "component",
    "entity_around",
    "instance",
    "plain_lines",
    "record_lines",
    "record_wrapper",
    "stream_lines",
    "stream_wrapper",
]

IEEE = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
"""

LIBRARIES = f"""\
{IEEE}
use work.{TYPES_NAME}.all;
"""

_STATUS_READY, _TAKEN = "m_axis_status_tready", "'1'"


class Line(NamedTuple):
    """A port in VHDL."""

    name: str
    direction: str
    type: str
    meaning: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Core:
    """A circuit with plain ports."""

    entity: str
    names: Mapping[str, str]  # Names of ports, where they differ from those of `ports_of`.


def stream_lines(plan: Plan, tree: Tree, direction: Direction) -> list[Line]:
    """List the ports of a converter with a record of streams."""
    forwards, backwards = ("out", "in") if direction == "deserializer" else ("in", "out")
    lines = [_outer_line(port) for port in ports_of(plan, direction) if port.leaf is None]
    status = next(k for k, line in enumerate(lines) if line[0].startswith("m_axis_status"))
    lines[status:status] = [
        Line("msg", forwards, tree.root.type, f"Data and valid of {plan.message}."),
        Line("rdy", backwards, tree.root.ready_type, "Ready of the fields."),
    ]
    return lines


def record_lines(plan: Plan, values: ValueType, direction: Direction) -> list[Line]:
    """List the ports of a converter with a record of values."""
    return [
        Line("msg", port.direction, values.name, f"The fields of {plan.message}.")
        if port.name == "msg_data"
        else _outer_line(port)
        for port in record_ports(plan, direction, values.bits)
    ]


def _outer_line(port: Port) -> Line:
    """Return a port of the user's layer: the core's port, but ``tkeep`` is always a vector."""
    kind = vhdl_type(port.width, vector=_is_vector(port))
    return Line(port.name, port.direction, kind, port.meaning)


def plain_lines(ports: Iterable[PlainPort], names: Mapping[str, str]) -> list[Line]:
    """List the plain ports of a circuit, for an instance or a component."""
    return [
        Line(names.get(port.name, port.name), port.direction, port.vhdl_type, "") for port in ports
    ]


def _is_vector(port: Port) -> bool:
    """Return whether a port is a vector even if it has one bit, like ``tkeep`` of AXI4-Stream."""
    return port.name.endswith("_tkeep")


def component(entity: str, lines: list[Line]) -> Iterator[str]:
    """Yield the declaration of a component."""
    yield f"\n  component {entity} is\n"
    yield from (f"  {line}" for line in _port_clause(lines, meanings=False))
    yield "  end component;\n"


def instance(
    label: str, entity: str, lines: list[Line], packages: Sequence[str], tied: str = ""
) -> str:
    """Write an instance of an entity, and the signals that it needs.

    * `label`: the instance's name.
    * `lines`: ports of the entity.
    * `packages`: packages with the types of the ports.
    * `tied`: a statement, without its semicolon, that ties off fields.
    """
    width = max(len(line.name) for line in lines)
    signals = [
        f"signal {line.name:{width}} : {line.type};\n"
        for line in lines
        if line.name not in ("aclk", "aresetn", _STATUS_READY)
    ]
    # A packet waits until its status is taken.
    parts = ",\n".join(
        f"    {line.name:{width}} => {_TAKEN if line.name == _STATUS_READY else line.name}"
        for line in lines
    )
    return "".join(
        [
            "-- Before the architecture:\n",
            IEEE,
            *(f"use work.{package}.all;\n" for package in packages),
            "\n-- Before its begin:\n",
            *signals,
            "\n-- After it:\n",
            f"{label} : entity work.{entity}\n  port map (\n{parts}\n  );\n",
            f"{tied};\n" if tied else "",
        ]
    )


def _port_clause(lines: list[Line], *, meanings: bool = True) -> Iterator[str]:
    """Yield the lines of a port clause."""
    names = max(len(line.name) for line in lines)
    kinds = max(len(line.type) for line in lines) + 5
    yield "  port (\n"
    for index, (name, direction, type_, meaning) in enumerate(lines):
        end, kind = ";" if index < len(lines) - 1 else "", f"{direction:3} {type_}"
        line = f"    {name:{names}} : {kind + end:{kinds}}  -- {meaning}"
        if not meanings or len(line) > 100:
            if meanings:
                yield from comment(meaning, "    ")
            line = f"    {name:{names}} : {kind}{end}"
        yield f"{line}\n"
    yield "  );\n"


def entity_around(
    entity: str,
    packages: Iterable[str],
    lines: list[Line],
    core: Core,
    parts: Mapping[str, str],
    signals: list[tuple[str, str]],
    assignments: list[str],
) -> Iterator[str]:
    """Yield the text of an entity around a core.

    * `packages`: packages to use, besides that of primitives.
    * `lines`: ports of the entity.
    * `parts`: actuals of the core's ports, by the names that `core` may change.
    * `signals`: names and types of signals.
    * `assignments`: lines of the architecture.
    """
    width = max(len(core.names.get(port, port)) for port in parts)
    names = max((len(name) for name, _ in signals), default=0)
    joined = ",\n".join(
        f"      {core.names.get(port, port):{width}} => {actual}" for port, actual in parts.items()
    )
    uses = "".join(f"use work.{package}.all;\n" for package in packages)
    yield f"\n{LIBRARIES}{uses}\nentity {entity} is\n"
    yield from _port_clause(lines)
    yield f"end entity;\n\narchitecture wrapper of {entity} is\n"
    yield "\n" * bool(signals)
    yield from (f"  signal {name:{names}} : {kind};\n" for name, kind in signals)
    yield f"\nbegin\n\n  core : entity work.{core.entity}\n    port map (\n{joined}\n    );\n"
    yield "\n" * bool(assignments)
    yield from assignments
    yield "\nend architecture;\n"


def stream_wrapper(plan: Plan, tree: Tree, direction: Direction, *, entity: str, core: Core) -> str:
    """Write a converter with a record of streams, one for each leaf."""
    package = tree.package.name
    conversions = Conversions(plan, tree, direction)
    ports = ports_of(plan, direction)
    parts = {port.name: conversions.actual(port) for port in ports}
    lines = stream_lines(plan, tree, direction)
    head = f"-- The {direction} of {plan.message} with records.\n-- {core.entity} has flat ports.\n"
    return head + "".join(
        entity_around(
            entity, [package], lines, core, parts, conversions.signals, conversions.assignments
        )
    )


class Conversions:
    """The actuals of a core's ports; a conversion gets a signal of its own.

    Some synthesis tools do not support a conversion in a port map.

    * `tree`: the records of the message.
    * `msg`, `rdy`: names of the records.
    * `names`: names of signals, where they differ from those of ports.
    """

    def __init__(
        self,
        plan: Plan,
        tree: Tree,
        direction: Direction,
        *,
        msg: str = "msg",
        rdy: str = "rdy",
        names: Mapping[str, str] | None = None,
    ) -> None:
        self.plan, self.direction = plan, direction
        self.msg, self.rdy, self.names = msg, rdy, names or {}
        self.nodes = {node.leaf: node for node in tree.root.leaves()}
        self.signals: list[tuple[str, str]] = []  # Names and types.
        self.assignments: list[str] = []  # Lines of an architecture.

    def actual(self, port: Port) -> str:
        """Return what a port of the core is connected to; add a signal if it takes one."""
        if port.leaf is None:
            return _packet_actual(port)
        leaf = self.plan.leaves[port.leaf]
        node = self.nodes[port.leaf]
        if port.member == "ready":
            return f"{self.rdy}.{node.access}"
        whole = f"{self.msg}.{node.access}.{port.member}"
        if port.member != "data":
            return whole
        primitive = primitive_name(leaf)
        if leaf.kind == "items" and port.width == 1:
            return f"{whole}(0)"
        if leaf.kind != "items" and (primitive == "bool" or primitive.startswith("float")):
            return whole
        name = self.names.get(port.name, port.name)
        self.signals.append((name, vhdl_type(port.width, vector=True)))
        if self.direction == "serializer":
            convert = "to_slv" if leaf.kind == "items" else "std_logic_vector"
            self.assignments.append(f"  {name} <= {convert}({whole});\n")
        else:
            convert = (
                f"to_{primitive}_items"
                if leaf.kind == "items"
                else "signed"
                if leaf.signed
                else "unsigned"
            )
            self.assignments.append(f"  {whole} <= {convert}({name});\n")
        return name


def _packet_actual(port: Port) -> str:
    """Return the actual of a packet or status port: the port of the same name."""
    # The core has a bit where the entity has a vector of one bit.
    return f"{port.name}(0)" if port.width == 1 and _is_vector(port) else port.name


def record_wrapper(
    plan: Plan, values: ValueType, direction: Direction, *, entity: str, core: Core
) -> str:
    """Write a converter with a record of values that has one handshake."""
    bits = values.bits
    parts = {port.name: _packet_actual(port) for port in record_ports(plan, direction, bits)}
    parts["msg_data"] = "msg_data" if bits > 1 else "msg_data(0)"
    convert = (
        f"  msg <= to_{values.base}(msg_data);\n"
        if direction == "deserializer"
        else "  msg_data <= to_slv(msg);\n"
    )
    lines = record_lines(plan, values, direction)
    signals = [("msg_data", vhdl_type(bits, vector=True))]
    head = (
        f"-- The {direction} of {plan.message}: whole messages, as a record of values.\n"
        f"-- {core.entity} has flat ports.\n"
    )
    return head + "".join(
        entity_around(entity, [values.package], lines, core, parts, signals, [convert])
    )
