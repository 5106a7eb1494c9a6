"""The top level of a packet part: AXI4-Stream (Arm IHI 0051), and ports of plain vectors.

What travels beside a packet has the name that AXI4-Stream has for it: `tid` is the source and
`tdest` the destination of a packet; `tuser` at the input of a FIFO drops a packet, and `tuser` at
the output of a serializer asks for that.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Cat, Module, Mux, Shape, Value
from amaranth.lib.wiring import In, Out

from firm_hdl.errors import UserError
from firm_hdl.export.parts.catalog import Part
from firm_hdl.export.top import MAX_INPUT_BITS, Port, add_domain, trailing_ones
from firm_hdl.gateware.component import Component

__all__ = ["PartTop", "clocks_of", "part_ports"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Pin:
    """A port, and what it is connected to in the part.

    Attributes
    ----------
    port : Port
    value : Value
    is_count : bool
        The port is `tkeep`, and `value` is the number of bytes.
    """

    port: Port
    value: Value
    is_count: bool = False


def clocks_of(part: Part) -> dict[str, tuple[str, str]]:
    """Return the ports of each clock domain of a part: its clock, and its reset, active low."""
    if part.kind != "crossing":
        return {"sync": ("aclk", "aresetn")}
    return {
        "write": ("s_axis_aclk", "s_axis_aresetn"),
        "read": ("m_axis_aclk", "m_axis_aresetn"),
    }


def part_ports(part: Part) -> tuple[Port, ...]:
    """List the ports of the top level of a part, clocks and resets first.

    Raises
    ------
    UserError
        If the part has more input bits than Amaranth elaborates.
    """
    ports = [port for names in clocks_of(part).values() for port in _clock(*names)]
    ports += [pin.port for pin in _pins(part)]
    bits = sum(port.width for port in ports if port.direction == "in")
    if bits > MAX_INPUT_BITS:
        raise UserError(
            f"The part has {bits} input bits, and Amaranth elaborates at most {MAX_INPUT_BITS}"
        )
    return tuple(ports)


def _clock(clock: str, reset: str) -> Iterator[Port]:
    yield Port(name=clock, direction="in", width=1, meaning="Clock; the rising edge is active.")
    yield Port(name=reset, direction="in", width=1, meaning="Synchronous reset, active low.")


class PartTop(Component):
    """A packet part with ports of plain vectors. It adds neither registers nor latency.

    On an input, `tkeep` is a contiguous run of ones from lane 0, and only its value in the last
    beat of a packet matters.

    Parameters
    ----------
    part : Part

    Members
    -------
    As :func:`part_ports` lists them.
    """

    def __init__(self, part: Part):
        self.part = part
        flows = {"in": In, "out": Out}
        super().__init__(
            {port.name: flows[port.direction](Shape(port.width)) for port in part_ports(part)}
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for name, (clock, reset) in clocks_of(self.part).items():
            add_domain(m, name, getattr(self, clock), getattr(self, reset))
        m.submodules.part = self.part.component
        for pin in _pins(self.part):
            port = getattr(self, pin.port.name)
            if pin.port.direction == "in":
                if pin.is_count:
                    last = getattr(self, pin.port.name.replace("tkeep", "tlast"))
                    port = Mux(last, trailing_ones(port), len(port))
                m.d.comb += pin.value.eq(port)
            elif pin.is_count:
                m.d.comb += port.eq(Cat(pin.value > lane for lane in range(len(port))))
            else:
                m.d.comb += port.eq(pin.value)
        return m


def _pins(part: Part) -> list[_Pin]:
    """List the pins of a part; a value without bits has none."""
    block: Any = part.component
    if part.kind == "arbiter":
        pins = list(_arbiter(block))
    elif part.kind == "router":
        pins = list(_router(block))
    else:
        pins = [
            *_packets("s_axis", block.packets_in),
            *_packets("m_axis", block.packets_out, False),
        ]
    if part.kind == "fifo":
        pins.append(_in("s_axis_tuser", block.abort, "With tlast: drop the packet."))
    if part.kind in ("gate", "fifo"):
        pins.append(_out("packet_bytes", block.size, "Bytes of the packet on m_axis."))
    if part.kind == "fifo":
        pins.append(_out("ended", block.ended, "A packet was kept or dropped, in one cycle."))
        codes = "0 kept, 1 aborted, 2 full, 3 large"
        pins.append(_out("outcome", Value.cast(block.outcome), f"With ended: {codes}."))
    if part.kind == "gate":
        pins += _status(block.status)
    if part.kind in ("gate", "fifo", "router"):
        counters = block.counters
        pins += [
            _out(f"count_{name}", Value.cast(counters[name]), f"Number of packets: {name}.")
            for name in counters.shape().members
        ]
    return [pin for pin in pins if pin.port.width]


def _in(name: str, value: Value, meaning: str) -> _Pin:
    return _Pin(
        port=Port(name=name, direction="in", width=len(value), meaning=meaning), value=value
    )


def _out(name: str, value: Value, meaning: str, width: int | None = None) -> _Pin:
    bits = len(value) if width is None else width
    return _Pin(port=Port(name=name, direction="out", width=bits, meaning=meaning), value=value)


def _packets(base: str, stream: Any, is_input: bool = True) -> Iterator[_Pin]:
    """Yield the pins of a packet stream."""
    beat = stream.payload
    forward, backward = (_in, _out) if is_input else (_out, _in)
    data = Value.cast(beat.data)
    yield forward(f"{base}_tdata", data, "Bytes of the packet, the first one in bits 7 to 0.")
    lanes = "Valid bytes, from lane 0 on; all ones except in the last beat."
    keep = Port(
        name=f"{base}_tkeep",
        direction="in" if is_input else "out",
        width=len(beat.data),
        meaning=lanes,
    )
    yield _Pin(port=keep, value=beat.count, is_count=True)
    yield forward(f"{base}_tlast", beat.last, "Last beat of the packet.")
    yield forward(f"{base}_tvalid", stream.valid, "beat: valid.")
    yield backward(f"{base}_tready", stream.ready, "beat: ready.")


def _status(status: Any) -> Iterator[_Pin]:
    # The width of AXI4-Stream's tdata is a multiple of 8 bits.
    meaning = "Status of a packet, one transfer per packet; 0 is OK."
    yield _out("m_axis_status_tdata", Value.cast(status.payload), meaning, width=8)
    yield _out("m_axis_status_tvalid", status.valid, "status: valid.")
    yield _in("m_axis_status_tready", status.ready, "status: ready.")


def _arbiter(block: Any) -> Iterator[_Pin]:
    beside = "What travels beside the beat."
    for number, stream in enumerate(block.packets_in):
        yield from _packets(f"s_axis_{number}", stream)
        if block.side_bits:
            yield _in(f"s_axis_{number}_tuser", block.sides_in[number], beside)
    yield from _packets("m_axis", block.packets_out, False)
    yield _out("m_axis_tid", block.source, "Number of the packet's input.")
    if block.side_bits:
        yield _out("m_axis_tuser", block.side_out, beside)


def _router(block: Any) -> Iterator[_Pin]:
    beside = "What travels beside the beat."
    yield from _packets("s_axis", block.packets_in)
    yield _in("s_axis_tdest", block.topic, "With a first beat: number of the packet's output.")
    if block.side_bits:
        yield _in("s_axis_tuser", block.side_in, beside)
    for number, stream in enumerate(block.packets_out):
        yield from _packets(f"m_axis_{number}", stream, False)
        if block.side_bits:
            yield _out(f"m_axis_{number}_tuser", block.side_out, beside)
