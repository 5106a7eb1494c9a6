# amaranth: UnusedElaboratable=no
"""Packet parts as designs of their own: gate, FIFO, width, crossing, arbiter and router.

The top level of a part has AXI4-Stream (Arm IHI 0051) and ports of plain vectors. What travels
beside a packet has the name that AXI4-Stream has for it: `tid` is the source and `tdest` the
destination of a packet; `tuser` at the input of a FIFO drops a packet, and `tuser` at the output of
a serializer asks for that.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from amaranth.hdl import Cat, Value
from amaranth.lib import wiring

import firm_hdl
from firm_hdl.errors import UserError
from firm_hdl.export.design import (
    BuiltDesign,
    core_file,
    design_folder,
    inputs_of_design,
    verilog_file,
    vhdl_folder,
    write_design,
)
from firm_hdl.export.top import AXIS_CLOCKS, Pin, PlainTop, Port, check_input_bits
from firm_hdl.garbage import search_put_off
from firm_hdl.gateware.packets import (
    GateStatus,
    Outcome,
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketWidth,
)
from firm_hdl.model import Message
from firm_hdl.names.identifiers import plain
from firm_hdl.rtlil import netlist_of, rtlil_of
from firm_hdl.vhdl.convert import convert
from firm_hdl.vhdl.names import legal

__all__ = ["KINDS", "Kind", "Part", "PartTop", "build_part", "make_part", "part_ports"]


def _in(name: str, value: Value, meaning: str) -> Pin:
    port = Port(name=name, direction="in", width=len(value), meaning=meaning)
    return Pin(port=port, value=value)


def _out(name: str, value: Value, meaning: str, width: int | None = None) -> Pin:
    bits = len(value) if width is None else width
    return Pin(port=Port(name=name, direction="out", width=bits, meaning=meaning), value=value)


def _packets(base: str, stream: Any, is_input: bool = True) -> Iterator[Pin]:
    beat = stream.payload
    forward, backward = (_in, _out) if is_input else (_out, _in)
    data = Value.cast(beat.data)
    yield forward(f"{base}_tdata", data, "Bytes of the packet, the first one in bits 7 to 0.")
    keep = Port(
        name=f"{base}_tkeep",
        direction="in" if is_input else "out",
        width=len(beat.data),
        meaning="Valid bytes, from lane 0 on; all ones except in the last beat.",
    )
    yield Pin(port=keep, value=beat.count, is_count=True)
    yield forward(f"{base}_tlast", beat.last, "Last beat of the packet.")
    yield forward(f"{base}_tvalid", stream.valid, "beat: valid.")
    yield backward(f"{base}_tready", stream.ready, "beat: ready.")


_BESIDE = "What travels beside the beat."


def _through(block: Any) -> Iterator[Pin]:
    yield from _packets("s_axis", block.packets_in)
    yield from _packets("m_axis", block.packets_out, False)
    if "side_in" in block.signature.members:
        yield _in("s_axis_tuser", block.side_in, _BESIDE)
        yield _out("m_axis_tuser", block.side_out, _BESIDE)


def _counters(block: Any) -> Iterator[Pin]:
    for name in block.counters.shape().members:
        value = Value.cast(block.counters[name])
        yield _out(f"count_{name}", value, f"Number of packets: {name}.")


_SIZE = "Bytes of the packet on m_axis."


def _gate(block: Any) -> Iterator[Pin]:
    yield from _through(block)
    yield _out("packet_bytes", block.size, _SIZE)
    status = block.status
    # The width of AXI4-Stream's tdata is a multiple of 8 bits.
    meaning = "Status of a packet, one transfer per packet; 0 is OK."
    yield _out("m_axis_status_tdata", Value.cast(status.payload), meaning, width=8)
    yield _out("m_axis_status_tvalid", status.valid, "status: valid.")
    yield _in("m_axis_status_tready", status.ready, "status: ready.")
    yield from _counters(block)


def _fifo(block: Any) -> Iterator[Pin]:
    yield from _packets("s_axis", block.packets_in)
    yield from _packets("m_axis", block.packets_out, False)
    drop = "With tlast: drop the packet."
    sides = [block.side_in] if "side_in" in block.signature.members else []
    if sides:
        drop = "Bit 0 with tlast: drop the packet. The others travel beside the beat."
    yield _in("s_axis_tuser", Cat(block.abort, *sides), drop)
    if sides:
        yield _out("m_axis_tuser", block.side_out, _BESIDE)
    yield _out("packet_bytes", block.size, _SIZE)
    yield _out("ended", block.ended, "A packet was kept or dropped, in one cycle.")
    codes = "0 kept, 1 aborted, 2 full, 3 large"
    yield _out("outcome", Value.cast(block.outcome), f"With ended: {codes}.")
    yield from _counters(block)


def _arbiter(block: Any) -> Iterator[Pin]:
    for number, stream in enumerate(block.packets_in):
        yield from _packets(f"s_axis_{number}", stream)
        if block.side_bits:
            yield _in(f"s_axis_{number}_tuser", block.sides_in[number], _BESIDE)
    yield from _packets("m_axis", block.packets_out, False)
    yield _out("m_axis_tid", block.source, "Number of the packet's input.")
    if block.side_bits:
        yield _out("m_axis_tuser", block.side_out, _BESIDE)


def _router(block: Any) -> Iterator[Pin]:
    yield from _packets("s_axis", block.packets_in)
    yield _in("s_axis_tdest", block.topic, "With a first beat: number of the packet's output.")
    if block.side_bits:
        yield _in("s_axis_tuser", block.side_in, _BESIDE)
    for number, stream in enumerate(block.packets_out):
        yield from _packets(f"m_axis_{number}", stream, False)
        if block.side_bits:
            yield _out(f"m_axis_{number}_tuser", block.side_out, _BESIDE)
    yield from _counters(block)


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """A kind of packet part."""

    text: str  # What it does, for people.
    # Makes the component of the parameters, and for a gate of a message.
    component: Callable[..., wiring.Component]
    parameters: tuple[str, ...]  # Those of the component, which are options of the command line.
    in_name: tuple[str, ...]  # The parameters that are in the name of a part.
    # Lists the ports of a component, except clocks and resets.
    pins: Callable[[Any], Iterator[Pin]]
    # Ports of each clock domain: its clock, and its reset, active low.
    clocks: Mapping[str, tuple[str, str]] = field(default_factory=lambda: AXIS_CLOCKS)
    codes: Any = None  # Values of a port, for the manifest.


_STORE = ("memory_bytes", "packets", "when_full")

KINDS: Mapping[str, Kind] = {
    "gate": Kind(
        text="forward only the good packets of a message type",
        component=PacketGate,
        parameters=("wire", "bus_bytes", "max_message_bytes", *_STORE, "side_bits"),
        in_name=("bus_bytes",),
        pins=_gate,
        codes=GateStatus,
    ),
    "fifo": Kind(
        text="store packets, and forward them whole or drop them",
        component=PacketFifo,
        parameters=("bus_bytes", *_STORE, "side_bits"),
        in_name=("bus_bytes",),
        pins=_fifo,
        codes=Outcome,
    ),
    "width": Kind(
        text="carry packets to a bus of another width",
        component=PacketWidth,
        parameters=("in_bytes", "out_bytes", "side_bits"),
        in_name=("in_bytes", "out_bytes"),
        pins=_through,
    ),
    "crossing": Kind(
        text="carry packets to another clock",
        component=PacketCrossing,
        parameters=("bus_bytes", "beats", "side_bits"),
        in_name=("bus_bytes",),
        pins=_through,
        clocks={
            "write": ("s_axis_aclk", "s_axis_aresetn"),
            "read": ("m_axis_aclk", "m_axis_aresetn"),
        },
    ),
    "arbiter": Kind(
        text="merge packet streams, packet by packet, round robin",
        component=PacketArbiter,
        parameters=("bus_bytes", "inputs", "side_bits"),
        in_name=("bus_bytes", "inputs"),
        pins=_arbiter,
    ),
    "router": Kind(
        text="send each packet to the output with the number in tdest",
        component=PacketRouter,
        parameters=("bus_bytes", "topics", "topic_bits", "side_bits"),
        in_name=("bus_bytes", "topics"),
        pins=_router,
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A packet part with its parameters.

    Attributes
    ----------
    kind : str
        One of :data:`KINDS`.
    name : str
        Name of its folder and of its top level.
    parameters : dict
        As given; with ``type`` and ``dialect``, if it is a gate.
    component : Component
    """

    kind: str
    name: str
    parameters: dict[str, Any]
    component: wiring.Component

    @property
    def clocks(self) -> Mapping[str, tuple[str, str]]:
        """Ports of each clock domain: its clock, and its reset, active low."""
        return KINDS[self.kind].clocks

    def pins(self) -> list[Pin]:
        """List the pins; a value without bits has none."""
        return [pin for pin in KINDS[self.kind].pins(self.component) if pin.port.width]


def make_part(
    kind: str, *, message: Message | None = None, name: str | None = None, **parameters: Any
) -> Part:
    """Make a packet part.

    * `kind`: one of :data:`KINDS`.
    * `message`: what a gate forwards; `None` for other parts.
    * `name`: default: the kind, the message type, and the widths of buses, such as
      ``packet_fifo_8``.
    * `parameters`: those of the component, such as `bus_bytes`; see
      :mod:`firm_hdl.gateware.packets`.

    Raises `UserError` if the part cannot have these parameters or this name.
    """
    if name is not None and legal(name) != name:
        raise UserError(f"The VHDL of every part uses the name '{name}' itself")
    given = dict(parameters)
    words = ["packet", kind]
    messages = [] if message is None else [message]
    for each in messages:
        given |= {"type": each.name, "dialect": each.dialect}
        words.append(plain(each.name, "f").lower())
    try:
        component = KINDS[kind].component(*messages, **parameters)
    except ValueError as error:
        raise UserError(str(error)) from None
    words += [str(parameters[each]) for each in KINDS[kind].in_name]
    return Part(kind=kind, name=name or "_".join(words), parameters=given, component=component)


def part_ports(part: Part) -> tuple[Port, ...]:
    """List the ports of the top level of a part, clocks and resets first.

    Raises `UserError` if the part has more input bits than Amaranth elaborates.
    """
    texts = ("Clock; the rising edge is active.", "Synchronous reset, active low.")
    ports = [
        Port(name=name, direction="in", width=1, meaning=meaning)
        for names in part.clocks.values()
        for name, meaning in zip(names, texts, strict=True)
    ]
    ports += [pin.port for pin in part.pins()]
    check_input_bits("The part", ports)
    return tuple(ports)


class PartTop(PlainTop):
    """A packet part with ports of plain vectors. It adds neither registers nor latency.

    Its members are as :func:`part_ports` lists them.
    """

    def __init__(self, part: Part):
        super().__init__(part.component, "part", part_ports(part), part.pins(), part.clocks)


def build_part(
    part: Part, out: str | os.PathLike[str] = "parts_out", *, force: bool = False
) -> BuiltDesign:
    """Write the design of a packet part into a folder of its own, ``out/NAME``.

    * `out`: created if it does not exist.
    * `force`: write the folder even if it is current.

    Raises `UserError` if the part is too large, or the folder cannot be written.
    """
    name, codes = part.name, KINDS[part.kind].codes
    folder = design_folder(out, name)
    ports = part_ports(part)
    with search_put_off():
        design = rtlil_of(PartTop(part), name=name)
    settings = ", ".join(f"{key} {value}" for key, value in part.parameters.items())
    what = f"packet {part.kind}: {settings}"

    def make_files() -> dict[str, str]:
        header = f"{name}: {what}\nMade by firm-hdl {firm_hdl.__version__}\n"
        netlist = netlist_of(design)
        vhdl = convert(netlist, name=name, header=header).files
        return {
            **verilog_file(netlist, name=name, header=header),
            **vhdl_folder(vhdl),
            **core_file(name, vhdl, kind="part", description=what),
        }

    facts: dict[str, Any] = {
        "part": part.kind,
        "parameters": part.parameters,
        "clocks": [{"clock": clock, "reset": reset} for clock, reset in part.clocks.values()],
    }
    if codes is not None:
        facts["codes"] = {code.name: code.value for code in codes}
    wanted = ("name", "direction", "width", "meaning")
    return write_design(
        folder,
        inputs=inputs_of_design(facts, design),
        facts=facts,
        ports=[{name: getattr(port, name) for name in wanted} for port in ports],
        make_files=make_files,
        force=force,
    )
