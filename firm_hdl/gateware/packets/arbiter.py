"""Merge several packet streams into one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream
from firm_hdl.gateware.limits import check_bits, check_integer
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.positions import any_of
from firm_hdl.gateware.signatures import PacketSignature, packet_layout

__all__ = ["PacketArbiter"]


@dataclass(frozen=True, slots=True)
class _Turn:
    """Whose turn it is, in two codes: the number of the input, and a bit for each input.

    The number selects payloads, because that takes the fewest look-up tables. The bits decide all
    else, because they need no decoder.
    """

    number: Signal
    bits: Signal

    @staticmethod
    def named(name: str, inputs: int) -> _Turn:
        """Return new signals; at the reset, it is the turn of input 0."""
        number = Signal(range(inputs), name=f"{name}_number")
        return _Turn(number, Signal(inputs, name=f"{name}_bits", init=1))

    def eq(self, other: _Turn) -> list[Any]:
        return [self.number.eq(other.number), self.bits.eq(other.bits)]


class PacketArbiter(Component):
    """Merge packet streams, packet by packet, round robin.

    The inputs take turns. After the end of a packet, it is the turn of the next input that offers
    one. So an input waits for at most one packet of each other input. `source` is the number of the
    packet's input.

    Latency 2 cycles, if it is the input's turn; else one more. Throughput one beat per cycle,
    without gaps between packets of different inputs, and between packets of one input. A packet
    that has begun is not interrupted: an input that begins a packet and stops holds all others.
    Gates and FIFOs send a packet only after its last beat was stored.

    All outputs depend on registers only. One clock domain, `sync`; its reset discards the beats
    inside, so the packets of all inputs have to begin again.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    inputs : int
        Number of inputs, at least 1.
    side_bits : int
        Bits that travel beside each beat, such as the size of its packet. 0: there are none.

    Members
    -------
    packets_in : array(inputs) of In(PacketSignature(bus_bytes))
    sides_in : array(inputs) of In(side_bits)
        Only with `side_bits`. As stable as the payload of the input.
    packets_out : Out(PacketSignature(bus_bytes))
    source : Out(range(inputs))
        Number of the packet's input; valid with each beat of `packets_out`.
    side_out : Out(side_bits)
        Only with `side_bits`. What came beside the beat; valid with it.
    """

    packets_in: Sequence[PacketStream]
    sides_in: Sequence[Value]
    packets_out: PacketStream
    source: Value
    side_out: Value

    def __init__(self, bus_bytes: int, inputs: int, *, side_bits: int = 0):
        check_integer("Number of inputs", inputs)
        check_bits("Number of side bits", side_bits)
        if inputs < 1:
            raise ValueError(f"Number of inputs must be at least 1, not {inputs}")
        self.bus_bytes, self.inputs, self.side_bits = bus_bytes, inputs, side_bits
        sides = {"sides_in": In(side_bits).array(inputs), "side_out": Out(side_bits)}
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)).array(inputs),
                "packets_out": Out(PacketSignature(bus_bytes)),
                "source": Out(range(inputs)),
                **(sides if side_bits else {}),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        turn = _Turn.named("turn", self.inputs)
        layout = data.StructLayout(
            {
                "beat": packet_layout(self.bus_bytes),
                "source": turn.number.shape(),
                **({"side": self.side_bits} if self.side_bits else {}),
            }
        )
        m.submodules.slice = out = StreamSlice(layout)
        valid = Signal()
        last = Signal()
        # The chosen beat. Inputs come from far away, so nothing follows their multiplexer.
        beat = Signal(layout, reset_less=True)
        has_beat = Signal()
        beats = Array(Value.cast(port.payload) for port in self.packets_in)
        m.d.comb += [
            valid.eq((Cat(port.valid for port in self.packets_in) & turn.bits).any()),
            out.i.payload.eq(beat),
            out.i.valid.eq(has_beat),
            last.eq((Cat(port.payload.last for port in self.packets_in) & turn.bits).any()),
            self.packets_out.payload.eq(out.o.payload.beat),
            self.packets_out.valid.eq(out.o.valid),
            self.source.eq(out.o.payload.source),
            out.o.ready.eq(self.packets_out.ready),
        ]
        with m.If(out.i.ready):
            m.d.sync += [
                has_beat.eq(valid),
                Value.cast(beat.beat).eq(beats[turn.number]),
                beat.source.eq(turn.number),
            ]
            if self.side_bits:
                m.d.sync += beat.side.eq(Array(self.sides_in)[turn.number])
        if self.side_bits:
            m.d.comb += self.side_out.eq(out.o.payload.side)
        self._take_turns(m, turn, out, valid, last)
        return m

    def _take_turns(
        self, m: Module, turn: _Turn, out: StreamSlice, valid: Signal, last: Signal
    ) -> None:
        """Go on to the next input after the end of a packet, or while none is offered."""
        chosen = _Turn.named("chosen", self.inputs)
        following = _Turn.named("following", self.inputs)
        fires = Signal()
        opens = Signal()
        # A packet has begun and not ended.
        inside = Signal()
        # `ready` of each input. These are registers of their own, because much follows `ready` in
        # the same cycle, and the inputs are far from each other.
        readies = Signal(self.inputs, init=1)
        self._choose(m, turn, chosen)
        m.d.comb += [
            fires.eq(valid & out.i.ready),
            *following.eq(turn),
            # The slice is ready in the next cycle if its register moves now, or if nothing comes.
            # Then it takes the chosen beat, so another one may be chosen.
            opens.eq(~out.o.valid | out.o.ready | (out.i.ready & ~out.i.valid)),
        ]
        with m.If(fires):
            m.d.sync += inside.eq(~last)
        with m.If(Mux(valid, fires & last, ~inside)):
            m.d.comb += following.eq(chosen)
        m.d.sync += [*turn.eq(following), readies.eq(Mux(opens, following.bits, 0))]
        for number, port in enumerate(self.packets_in):
            m.d.comb += port.ready.eq(readies[number])

    def _choose(self, m: Module, turn: _Turn, chosen: _Turn) -> None:
        """Choose the next input after `turn` that offers a packet; else `turn` itself."""
        count = self.inputs
        # By input: the cases in which the input is chosen.
        cases: list[list[Value]] = [[] for _ in range(count)]
        for number in range(count):
            nearer: Value = Const(0, 1)
            for distance in range(1, count):
                other = (number + distance) % count
                offers = self.packets_in[other].valid
                cases[other].append(turn.bits[number] & offers & ~nearer)
                nearer = nearer | offers
            cases[number].append(turn.bits[number] & ~nearer)
        for number, each in enumerate(cases):
            m.d.comb += chosen.bits[number].eq(any_of(each))
        for bit in range(len(chosen.number)):
            ones = [chosen.bits[number] for number in range(count) if number >> bit & 1]
            m.d.comb += chosen.number[bit].eq(any_of(ones))
