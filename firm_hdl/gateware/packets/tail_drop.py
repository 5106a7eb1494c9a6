"""Tail drop, for a link that cannot be held: packets that find no room are dropped."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.packets.sides import beat_layout

__all__ = ["MOST_DROPPED", "TailDrop", "tail_drop_layout"]

DROPPED_BITS = 8
MOST_DROPPED = (1 << DROPPED_BITS) - 1
"""Packets in a row that are dropped and still get a status each."""


def tail_drop_layout(beat: data.StructLayout) -> data.StructLayout:
    """Return a beat after a tail drop.

    Members
    -------
    beat : beat
    aborted : unsigned(1)
        In a last beat: the rest of the packet was dropped, and the beat has no meaning.
    dropped : unsigned(8)
        In a first beat: number of packets that were dropped whole since the packet before, at most
        255.
    any_dropped : unsigned(1)
        `dropped` is not 0.
    """
    return data.StructLayout(
        {
            "beat": beat,
            "aborted": 1,
            "dropped": DROPPED_BITS,
            "any_dropped": 1,
        }
    )


class TailDrop(wiring.Component):
    """Pass packets on while `packets_out` is ready; drop them whole while it is not.

    If `packets_out` is not ready for a beat of a packet that has begun, the packet is aborted: the
    rest of it is dropped, and a last beat with `aborted` is sent instead. Packets that begin before
    this beat has been taken are dropped whole.

    Latency 1 cycle: beats are registered first, because they may come from far away.

    Parameters
    ----------
    bus_bytes, side_bits : int

    Members
    -------
    packets_in : In(stream.Signature(beat_layout(bus_bytes, side_bits)))
        `ready` is constantly 1.
    packets_out : Out(stream.Signature(tail_drop_layout(beat_layout(bus_bytes, side_bits))))
        `valid` and `payload` depend on registers only. The payload may change before the transfer.
    dropped : Out(8)
        Packets that were dropped whole since the last one that was passed on. A register.
    report : In(1)
        One of `dropped` is reported, and no longer counts. Not if `packets_out` transfers.
    drops : Out(1)
        A packet of which beats were dropped ended in the cycle before.
    """

    def __init__(self, bus_bytes: int, side_bits: int = 0):
        self.bus_bytes, self.beat = bus_bytes, beat_layout(bus_bytes, side_bits)
        super().__init__(
            {
                "packets_in": In(stream.Signature(self.beat)),
                "packets_out": Out(stream.Signature(tail_drop_layout(self.beat))),
                "dropped": Out(DROPPED_BITS),
                "report": In(1),
                "drops": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        out = self.packets_out
        came = Signal()
        beat = Signal(self.beat, reset_less=True)
        # A packet was aborted, and its last beat has not been sent.
        abort_pending = Signal()
        # The rest of the arriving packet is dropped; a beat of the arriving packet was passed on.
        drops_rest = Signal()
        begun = Signal()
        passes = Signal()
        refused = Signal()
        m.d.comb += [
            self.packets_in.ready.eq(1),
            out.valid.eq(abort_pending | (came & ~drops_rest)),
            out.payload.beat.eq(beat),
            out.payload.beat.last.eq(beat.last | abort_pending),
            out.payload.beat.count.eq(Mux(abort_pending, self.bus_bytes, beat.count)),
            out.payload.aborted.eq(abort_pending),
            out.payload.dropped.eq(self.dropped),
            out.payload.any_dropped.eq(self.dropped.any()),
            passes.eq(came & ~drops_rest & ~abort_pending & out.ready),
            refused.eq(came & ~passes),
            self.drops.eq(refused & beat.last),
        ]
        m.d.sync += [came.eq(self.packets_in.valid), beat.eq(self.packets_in.payload)]
        with m.If(abort_pending & out.ready):
            m.d.sync += abort_pending.eq(0)
        with m.If(passes):
            m.d.sync += begun.eq(~beat.last)
        with m.If(refused):
            m.d.sync += drops_rest.eq(~beat.last)
            with m.If(begun & ~drops_rest):
                m.d.sync += abort_pending.eq(1)
            with m.If(beat.last):
                m.d.sync += begun.eq(0)
        # A packet that was aborted gets its status with its last beat.
        dropped_whole = Signal()
        m.d.comb += dropped_whole.eq(self.drops & ~begun & ~self.dropped.all())
        # Both are late in the cycle, so no sum depends on them.
        with m.If(passes & ~begun):
            m.d.sync += self.dropped.eq(0)
        with m.Elif(dropped_whole & ~self.report):
            m.d.sync += self.dropped.eq(self.dropped + 1)
        with m.Elif(self.report & ~dropped_whole):
            m.d.sync += self.dropped.eq(self.dropped - 1)
        return m
