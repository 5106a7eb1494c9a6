"""Top levels: a converter with ports for a design in VHDL or Verilog.

Packets and statuses are AXI4-Stream (Arm IHI 0051). Each leaf of the message is a stream of its own
under the field's name. Ports are plain vectors. Each :class:`Port` has a description, which the
manifest repeats.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import ClockDomain, Module, Shape, Signal, Value
from amaranth.lib import data
from amaranth.lib.wiring import In, Out

from firm_hdl.errors import UserError
from firm_hdl.export.ports import PlainPort
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.axi_stream import count_of_keep, keep_of_count
from firm_hdl.gateware.component import Component
from firm_hdl.gateware.limits import MAX_CELL_BITS
from firm_hdl.gateware.members import MemberTree
from firm_hdl.gateware.signatures import leaf_shape
from firm_hdl.model import Array, Field, Message, Sequence
from firm_hdl.names.identifiers import flat_names
from firm_hdl.plan import DIRECTIONS, Direction, Leaf, Plan

__all__ = [
    "AXIS_CLOCKS",
    "DIRECTIONS",
    "MAX_INPUT_BITS",
    "Direction",
    "Pin",
    "PlainTop",
    "Port",
    "Top",
    "add_domain",
    "check_input_bits",
    "converter_of",
    "field_of",
    "leaf_members",
    "leaf_names",
    "port_members",
    "ports_of",
]

MAX_INPUT_BITS = MAX_CELL_BITS
"""Largest number of input bits of a design, because Amaranth makes one cell of all inputs."""

AXIS_CLOCKS: Mapping[str, tuple[str, str]] = {"sync": ("aclk", "aresetn")}
"""Clock and reset of a design with one clock domain."""

# Names that no leaf may have. A leaf's ports are its name with ``_data``, ``_last`` and so on, and
# these must not be names of packet or status ports.
_RESERVED = ("s_axis", "m_axis", "m_axis_status")


@dataclass(frozen=True, slots=True, kw_only=True)
class Port(PlainPort):
    """A port of a converter's top level."""

    meaning: str  # Description for people.
    signed: bool = False
    leaf: int | None = None  # Index of the leaf that the port belongs to; `None` for other ports.
    # Member of the leaf's stream: `data`, `last`, `valid` or `ready`; empty for other ports.
    member: str = ""


def leaf_names(plan: Plan) -> dict[tuple[str, ...], str]:
    """Return the prefix of the port names of each leaf, by the leaf's path."""
    return flat_names((leaf.path for leaf in plan.leaves), _RESERVED)


def field_of(message: Message, leaf: Leaf) -> Field | None:
    """Return the innermost field that a leaf belongs to."""
    found = None
    current: Message | None = message
    names = iter(leaf.path)
    for name in names:
        match = next((f for f in current.fields if f.name == name), None) if current else None
        if match is None:
            break
        found, kind = match, match.type
        if isinstance(kind, Array | Sequence):
            # Skip the next part of the path: "length" or "items" of the leaf, or "item" before an
            # element.
            next(names, None)
            kind = kind.element
        current = kind if isinstance(kind, Message) else None
    return found


def ports_of(plan: Plan, direction: Direction) -> tuple[Port, ...]:
    """List the ports of a top level: clock, reset, packets, leaves in wire order, status."""
    names = leaf_names(plan)
    ports = [
        Port(name="aclk", direction="in", width=1, meaning="Clock; the rising edge is active."),
        Port(name="aresetn", direction="in", width=1, meaning="Synchronous reset, active low."),
        *_packet_ports(plan.bus_bytes, direction),
    ]
    for index, leaf in enumerate(plan.leaves):
        ports += _leaf_ports(leaf, index, names[leaf.path], direction)
    # The width of AXI4-Stream's tdata is a multiple of 8 bits.
    status = [("tdata", 8, "Status of a packet, one transfer per packet; 0 is OK.")]
    ports += _stream("m_axis_status", "t", status, "status", is_input=False)
    return tuple(ports)


def _packet_ports(bus_bytes: int, direction: Direction) -> list[Port]:
    payload = [
        ("tdata", 8 * bus_bytes, "Bytes of the packet, the first one in bits 7 to 0."),
        ("tkeep", bus_bytes, "Valid bytes, from lane 0 on; all ones except in the last beat."),
        ("tlast", 1, "Last beat of the packet."),
    ]
    if direction == "deserializer":
        return _stream("s_axis", "t", payload, "beat", is_input=True)
    payload.append(("tuser", 1, "With tlast: the packet's status is not OK; drop it."))
    return _stream("m_axis", "t", payload, "beat", is_input=False)


def _leaf_ports(leaf: Leaf, index: int, base: str, direction: Direction) -> list[Port]:
    shape = leaf_shape(leaf)
    if isinstance(shape, data.StructLayout):
        payload = [
            ("data", shape["data"].width, _meaning(leaf)),
            ("last", 1, f"{leaf}: last transfer of the array or sequence."),
        ]
        signed = False
    else:
        payload = [("data", shape.width, _meaning(leaf))]
        signed = shape.signed
    is_input = direction == "serializer"
    return _stream(base, "", payload, str(leaf), is_input=is_input, signed=signed, leaf=index)


def _stream(
    base: str,
    initial: str,
    payload: list[tuple[str, int, str]],
    what: str,
    *,
    is_input: bool,
    signed: bool = False,
    leaf: int | None = None,
) -> list[Port]:
    """List the ports of a stream; `signed` applies to ``data``."""
    forward, backward = ("in", "out") if is_input else ("out", "in")
    whole = [
        *((forward, *entry) for entry in payload),
        (forward, f"{initial}valid", 1, f"{what}: valid."),
        (backward, f"{initial}ready", 1, f"{what}: ready."),
    ]
    return [
        Port(
            name=f"{base}_{name}",
            direction="in" if way == "in" else "out",
            width=width,
            meaning=meaning,
            signed=signed and name == "data",
            leaf=leaf,
            member=name if leaf is not None else "",
        )
        for way, name, width, meaning in whole
    ]


def _meaning(leaf: Leaf) -> str:
    if leaf.kind == "trigger":
        return f"{leaf}: always 1; marks one empty message."
    if leaf.kind == "length":
        return f"{leaf}: number of elements that follow."
    form = {
        "bool": "1 is true",
        "float": "IEEE 754 bits",
        "int": "two's complement" if leaf.signed else "unsigned",
    }[leaf.primitive.kind]
    if leaf.kind == "items":
        lanes = f"{leaf.lanes} x {leaf.type}" if leaf.lanes > 1 else leaf.type
        return f"{leaf}: {lanes} ({form}), first item in the lowest bits."
    return f"{leaf}: {leaf.type} ({form})."


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin:
    """A port, and the value behind it."""

    port: Any  # Its name, direction, width and sign count.
    value: Value
    is_count: bool = False  # The port is `tkeep`, and `value` is the number of bytes.


def check_input_bits(what: str, ports: Iterable[PlainPort]) -> None:
    """Refuse a design with more input bits than Amaranth elaborates.

    Raises `UserError`.
    """
    bits = sum(port.width for port in ports if port.direction == "in")
    if bits > MAX_INPUT_BITS:
        raise UserError(
            f"{what} has {bits} input bits, and Amaranth elaborates at most {MAX_INPUT_BITS}"
        )


class PlainTop(Component):
    """A component with ports of plain vectors. It adds neither registers nor latency.

    On an input, ``tkeep`` is a contiguous run of ones from lane 0, and only its value in the last
    beat of a packet matters.

    * `inside`: the component.
    * `name`: name of its instance.
    * `pins`: those of all ports but clocks and resets.
    * `clocks`: ports of each clock domain: its clock, and its synchronous reset, active low.
    * `also_resets`: resets all domains while it is high.
    """

    def __init__(
        self,
        inside: Any,
        name: str,
        ports: Iterable[Any],
        pins: Iterable[Pin],
        clocks: Mapping[str, tuple[str, str]] = AXIS_CLOCKS,
        also_resets: Value | None = None,
    ):
        self._also_resets = also_resets
        self._inside, self._name, self._pins, self._clocks = inside, name, list(pins), clocks
        super().__init__(port_members(ports))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for name, (clock, reset) in self._clocks.items():
            resetn = getattr(self, reset)
            if self._also_resets is not None:
                resetn &= ~self._also_resets
            add_domain(m, name, getattr(self, clock), resetn)
        m.submodules[self._name] = self._inside
        for pin in self._pins:
            name, value = pin.port.name, getattr(self, pin.port.name)
            if pin.port.direction == "out":
                source = keep_of_count(pin.value, pin.port.width) if pin.is_count else pin.value
                m.d.comb += value.eq(source)
            elif pin.is_count:
                last = getattr(self, f"{name.removesuffix('keep')}last")
                m.d.comb += pin.value.eq(count_of_keep(m, value, last))
            else:
                m.d.comb += pin.value.eq(value)
        return m


def converter_of(message: Message, plan: Plan, direction: Direction) -> Deserializer | Serializer:
    """Return a converter with a plan."""
    core = Deserializer if direction == "deserializer" else Serializer
    return core(message, plan=plan)


class Top(PlainTop):
    """A converter with AXI4-Stream on its packet side and named ports on its message side.

    The top level adds neither registers nor latency. `aresetn` is active low and synchronous to the
    rising edge of `aclk`; one cycle of reset discards all packets and messages inside. A last beat
    without any ones in ``tkeep`` adds no bytes, so it can end an empty packet.

    Parameters
    ----------
    core : Deserializer or Serializer

    Members
    -------
    As :func:`ports_of` lists them.

    Raises
    ------
    TypeError
        If the core is another component.
    """

    def __init__(self, core: Deserializer | Serializer):
        if not isinstance(core, Deserializer | Serializer):
            raise TypeError(
                f"A top level has a Deserializer or a Serializer, not {core!r}; "
                "firm_hdl.verilog.convert and firm_hdl.vhdl.convert write any component"
            )
        self.core = core
        self.direction: Direction = (
            "deserializer" if isinstance(core, Deserializer) else "serializer"
        )
        self.ports = ports_of(core.plan, self.direction)
        super().__init__(core, "core", self.ports, self._connected())

    def _connected(self) -> Iterator[Pin]:
        core: Any = self.core
        beat, base = core.packets.payload, self.ports[2].name.removesuffix("_tdata")
        values = {
            f"{base}_tdata": beat.data,
            f"{base}_tkeep": beat.count,
            f"{base}_tlast": beat.last,
            f"{base}_tuser": None if base == "s_axis" else core.packet_error,
            f"{base}_tvalid": core.packets.valid,
            f"{base}_tready": core.packets.ready,
            "m_axis_status_tdata": core.status.payload,
            "m_axis_status_tvalid": core.status.valid,
            "m_axis_status_tready": core.status.ready,
        }
        leaves = dict(leaf_members(core.message, core.tree))
        # Leaves come last in the text of the circuit.
        for port in sorted(self.ports[2:], key=lambda port: port.leaf is not None):
            leaf = port.leaf
            value = values[port.name] if leaf is None else leaves[leaf][port.member]
            yield Pin(port=port, value=Value.cast(value), is_count=port.name == f"{base}_tkeep")


def port_members(ports: Iterable[Any]) -> dict[str, Any]:
    """Return the members of a component with such ports."""
    flows = {"in": In, "out": Out}
    return {port.name: flows[port.direction](Shape(port.width, port.signed)) for port in ports}


def leaf_members(message: Any, tree: MemberTree) -> Iterator[tuple[int, dict[str, Value]]]:
    """Yield each leaf of a message's interface: its index, and its signals by `Port.member`."""
    for index, path in tree.leaves():
        stream = message
        for name in path:
            stream = getattr(stream, name)
        members = {"data": stream.payload, "valid": stream.valid, "ready": stream.ready}
        if isinstance(stream.payload, data.View):
            members |= {name: stream.payload[name] for name in ("data", "last")}
        yield index, {name: Value.cast(value) for name, value in members.items()}


def add_domain(m: Module, name: str, clock: Signal, resetn: Value) -> None:
    """Give a top level the clock domain of its ports: a clock, and a reset that is active low."""
    # The port itself is the clock: an assignment would delay the clock by a delta cycle.
    domain = ClockDomain(name, local=True)
    domain.clk = clock
    m.domains += domain
    m.d.comb += domain.rst.eq(~resetn)
