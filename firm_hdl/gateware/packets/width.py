"""Convert a packet stream to another bus width."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream
from firm_hdl.gateware.packets.sides import beat_layout, put_in, put_out, side_members
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.signatures import PacketSignature

__all__ = ["PacketWidth"]


class PacketWidth(Component):
    """Carry packets from a bus of one width to a bus of another width.

    The bytes of a packet do not change. All beats but the last one are full.

    Throughput one beat per cycle on the narrower side, without gaps between packets. Latency from
    the narrow beat that completes a wide one: 1 cycle. From a wide beat to its first narrow one: 2
    cycles. Between buses of the same width: 1 cycle.

    `packets_in.ready`, and `valid` and `payload` of `packets_out`, are registers. One clock domain,
    `sync`; its reset discards the bytes inside, and the next beat begins a packet.

    Parameters
    ----------
    in_bytes, out_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    side_bits : int
        Bits that travel beside each beat, such as a tag. 0: there are none.

    Members
    -------
    packets_in : In(PacketSignature(in_bytes))
    side_in : In(side_bits)
        Only with `side_bits`. As stable as the payload.
    packets_out : Out(PacketSignature(out_bytes))
    side_out : Out(side_bits)
        Only with `side_bits`; valid with the beat. What came beside the wide beat, or beside the
        narrow one that completed the wide beat.
    """

    packets_in: PacketStream
    packets_out: PacketStream
    side_in: Value
    side_out: Value

    def __init__(self, in_bytes: int, out_bytes: int, *, side_bits: int = 0):
        self.in_bytes, self.out_bytes, self.side_bits = in_bytes, out_bytes, side_bits
        super().__init__(
            {
                "packets_in": In(PacketSignature(in_bytes)),
                "packets_out": Out(PacketSignature(out_bytes)),
                **side_members(side_bits),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.slice = out = StreamSlice(beat_layout(self.out_bytes, self.side_bits))
        put_out(m, out.o, self)
        if self.in_bytes > self.out_bytes:
            self._split(m, out)
        else:
            self._join(m, out)
        return m

    def _join(self, m: Module, out: StreamSlice) -> None:
        """Store narrow beats in registers; the last one of a wide beat bypasses them."""
        ratio = self.out_bytes // self.in_bytes
        packets, beat, wide = self.packets_in, self.packets_in.payload, out.i.payload
        number = Signal(range(ratio))
        completes = Signal()
        m.d.comb += [
            completes.eq(beat.last | (number == ratio - 1)),
            packets.ready.eq(out.i.ready),
            out.i.valid.eq(packets.valid & completes),
            # Before this beat, all are full.
            wide.count.eq(
                Cat(Const(0, (self.in_bytes - 1).bit_length()), number)
                + Mux(beat.last, beat.count, self.in_bytes)
            ),
            wide.last.eq(beat.last),
        ]
        if self.side_bits:
            m.d.comb += wide.side.eq(self.side_in)
        bits = 8 * self.in_bytes
        incoming, parts = Value.cast(beat.data), Value.cast(wide.data)
        for place in range(ratio):
            kept = Signal(bits, name=f"kept_{place}", reset_less=True)
            is_here = number == place
            m.d.comb += parts[bits * place : bits * (place + 1)].eq(Mux(is_here, incoming, kept))
            with m.If(packets.valid & packets.ready & is_here):
                m.d.sync += kept.eq(incoming)
        with m.If(packets.valid & packets.ready):
            m.d.sync += number.eq(Mux(completes, 0, number + 1))

    def _split(self, m: Module, out: StreamSlice) -> None:
        """Register a wide beat, and send it in parts."""
        ratio, low = self.in_bytes // self.out_bytes, (self.out_bytes - 1).bit_length()
        m.submodules.wide = wide = StreamSlice(beat_layout(self.in_bytes, self.side_bits))
        beat = wide.o.payload
        number = Signal(range(ratio))
        final = Signal(range(ratio))
        is_final = Signal()
        put_in(m, self, wide.i)
        m.d.comb += [
            # An empty packet has one beat, too.
            final.eq(Mux(beat.last, Mux(beat.count == 0, 0, (beat.count - 1)[low:]), ratio - 1)),
            is_final.eq(number == final),
            out.i.valid.eq(wide.o.valid),
            wide.o.ready.eq(out.i.ready & is_final),
            Value.cast(out.i.payload.data).eq(
                Value.cast(beat.data).word_select(number, 8 * self.out_bytes)
            ),
            out.i.payload.last.eq(beat.last & is_final),
            out.i.payload.count.eq(
                Mux(
                    beat.last & is_final,
                    beat.count - Cat(Const(0, low), number),
                    self.out_bytes,
                )
            ),
        ]
        if self.side_bits:
            m.d.comb += out.i.payload.side.eq(beat.side)
        with m.If(out.i.valid & out.i.ready):
            m.d.sync += number.eq(Mux(is_final, 0, number + 1))
