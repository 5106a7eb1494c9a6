"""Merge several packet streams into one."""

from __future__ import annotations

from amaranth.hdl import Array, Cat, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.signatures import PacketSignature, packet_layout

__all__ = ["PacketArbiter"]


class PacketArbiter(wiring.Component):
    """Merge packet streams, packet by packet, round robin.

    The inputs take turns. After the end of a packet, it is the turn of the next input that offers
    one. So an input waits for at most one packet of each other input. `source` is the number of the
    packet's input.

    Latency 1 cycle, if it is the input's turn; else one more. Throughput one beat per cycle,
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

    def __init__(self, bus_bytes: int, inputs: int, *, side_bits: int = 0):
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
        turn, chosen = Signal(range(self.inputs)), Signal(range(self.inputs))
        layout = data.StructLayout(
            {
                "beat": packet_layout(self.bus_bytes),
                "source": turn.shape(),
                **({"side": self.side_bits} if self.side_bits else {}),
            }
        )
        m.submodules.slice = out = StreamSlice(layout)
        valid, last, fires = Signal(), Signal(), Signal()
        # A packet has begun and not ended.
        inside = Signal()
        beats = Array(Value.cast(port.payload) for port in self.packets_in)
        m.d.comb += [
            valid.eq(Cat(port.valid for port in self.packets_in).bit_select(turn, 1)),
            Value.cast(out.i.payload.beat).eq(beats[turn]),
            out.i.payload.source.eq(turn),
            out.i.valid.eq(valid),
            last.eq(out.i.payload.beat.last),
            fires.eq(valid & out.i.ready),
            self.packets_out.payload.eq(out.o.payload.beat),
            self.packets_out.valid.eq(out.o.valid),
            self.source.eq(out.o.payload.source),
            out.o.ready.eq(self.packets_out.ready),
        ]
        if self.side_bits:
            m.d.comb += [
                out.i.payload.side.eq(Array(self.sides_in)[turn]),
                self.side_out.eq(out.o.payload.side),
            ]
        for number, port in enumerate(self.packets_in):
            m.d.comb += port.ready.eq(out.i.ready & (turn == number))
        self._choose(m, turn, chosen)
        with m.If(fires):
            m.d.sync += inside.eq(~last)
        with m.If(Mux(valid, fires & last, ~inside)):
            m.d.sync += turn.eq(chosen)
        return m

    def _choose(self, m: Module, turn: Signal, chosen: Signal) -> None:
        """Choose the next input after `turn` that offers a packet; else `turn` itself."""
        count = self.inputs
        m.d.comb += chosen.eq(turn)
        with m.Switch(turn):
            for number in range(count):
                with m.Case(number):
                    # The last assignment wins, so the nearest input comes last.
                    for distance in reversed(range(1, count)):
                        other = (number + distance) % count
                        with m.If(self.packets_in[other].valid):
                            m.d.comb += chosen.eq(other)
