"""Pieces of packets, with bytes in any lanes, as packets of full beats."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, ResetInserter, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.axi_stream import count_of_keep
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.signatures import packet_layout

__all__ = ["BytePacker", "pieces_layout"]


def pieces_layout(bus_bytes: int) -> data.StructLayout:
    """Return the payload of an AXI4-Stream whose TKEEP counts in each transfer.

    Members
    -------
    data : unsigned(8 * bus_bytes)
        Bytes; the first one is in the lowest bits.
    keep : unsigned(bus_bytes)
        Lanes with bytes: any run of them, or none.
    last : unsigned(1)
        The packet ends.
    """
    return data.StructLayout({"data": 8 * bus_bytes, "keep": bus_bytes, "last": 1})


class BytePacker(wiring.Component):
    """Move the bytes of a packet together, so that all beats but the last one are full.

    A DMA that gathers a packet from several buffers ends each of them with a transfer that is not
    full. Bytes behind a gap within a transfer are dropped; no DMA sends such a transfer.

    A transfer is taken per cycle, and one cycle more per packet. Up to a full beat waits for the
    transfer that follows, as that may be the end of the packet without a byte. Outputs and
    `i.ready` are registers, except that `cut` makes `i.ready` low at once. One clock domain,
    `sync`.

    Parameters
    ----------
    bus_bytes : int

    Members
    -------
    i : In(stream.Signature(pieces_layout(bus_bytes)))
    cut : In(1)
        While it is high, nothing is taken. A packet of which nothing has left is discarded; any
        other one ends with an empty beat, which is bad.
    packets : Out(PacketSignature(bus_bytes))
    bad : Out(1)
        With the last beat: the packet was cut.
    """

    def __init__(self, bus_bytes: int):
        self.bus_bytes = bus_bytes
        super().__init__(
            {
                "i": In(stream.Signature(pieces_layout(bus_bytes))),
                "cut": In(1),
                "packets": Out(PacketSignature(bus_bytes)),
                "bad": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus, came = self.bus_bytes, self.i.payload
        # It stays until the packet under way has ended.
        is_cut = Signal()
        # The first beats of the packet have left, and its end has not.
        inside = Signal()
        stops = Signal()
        m.d.sync += is_cut.eq(self.cut | (is_cut & inside))
        m.d.comb += stops.eq(self.cut | is_cut)

        # The bytes of a transfer, from lane 0 on.
        layout = packet_layout(bus)
        piece = StreamSlice(layout)
        m.submodules.piece = ResetInserter(stops)(piece)
        first = [came.keep[lane] & ~came.keep[:lane].any() for lane in range(bus)]
        start = Cat(
            Cat(here for lane, here in enumerate(first) if lane >> bit & 1).any()
            for bit in range((bus - 1).bit_length())
        )
        m.d.comb += [
            Value.cast(piece.i.payload.data).eq(came.data >> Cat(Const(0, 3), start)),
            piece.i.payload.count.eq(count_of_keep(m, (came.keep >> start)[:bus], Const(1))),
            piece.i.payload.last.eq(came.last),
            piece.i.valid.eq(self.i.valid & ~stops),
            self.i.ready.eq(piece.i.ready & ~stops),
        ]

        # What is held comes first, and the bytes of the transfer follow it.
        m.submodules.slice = out = StreamSlice(data.StructLayout({"beat": layout, "bad": 1}))
        held = Signal(8 * bus)
        count = Signal(range(bus + 1))
        ends = Signal()
        total = Signal(range(2 * bus + 1))
        joined = Signal(16 * bus)
        transfer, beat = piece.o.payload, out.i.payload.beat
        kept = Cat((count > lane).replicate(8) for lane in range(bus))
        m.d.comb += [
            total.eq(count + transfer.count),
            joined.eq((held & kept) | (Value.cast(transfer.data) << Cat(Const(0, 3), count))),
            Value.cast(beat.data).eq(joined),
            # Also where nothing leaves, so that `ready` does not depend on sizes.
            piece.o.ready.eq(out.i.ready & ~is_cut & ~ends),
            self.packets.payload.eq(out.o.payload.beat),
            self.bad.eq(out.o.payload.bad),
            self.packets.valid.eq(out.o.valid),
            out.o.ready.eq(self.packets.ready),
        ]
        moves = Signal()
        m.d.comb += moves.eq(out.i.valid & out.i.ready)
        with m.If(is_cut):
            m.d.comb += [out.i.valid.eq(inside), beat.last.eq(1), out.i.payload.bad.eq(1)]
            m.d.sync += [count.eq(0), ends.eq(0)]
        with m.Elif(ends):
            m.d.comb += [out.i.valid.eq(1), beat.count.eq(count), beat.last.eq(1)]
            m.d.comb += Value.cast(beat.data).eq(held)
            with m.If(moves):
                m.d.sync += [count.eq(0), ends.eq(0)]
        with m.Elif(piece.o.valid):
            overflows = total > bus
            m.d.comb += [
                out.i.valid.eq(overflows | transfer.last),
                beat.count.eq(Mux(overflows, bus, total)),
                beat.last.eq(~overflows),
            ]
            with m.If(out.i.ready):
                m.d.sync += [
                    held.eq(Mux(overflows, joined[8 * bus :], joined)),
                    count.eq(Mux(overflows, total - bus, Mux(transfer.last, 0, total))),
                    ends.eq(overflows & transfer.last),
                ]
        with m.If(moves):
            m.d.sync += inside.eq(~beat.last)
        return m
