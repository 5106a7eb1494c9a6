"""The door of a gate for a link that cannot be held: what comes too early stays outside."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.signatures import PacketSignature, packet_layout

__all__ = ["MOST_LOST", "PacketDoor", "door_layout"]

LOST_BITS = 8
MOST_LOST = (1 << LOST_BITS) - 1
"""Packets in a row that stayed outside and still get a status each."""


def door_layout(bus_bytes: int) -> data.StructLayout:
    """Return a beat behind a door.

    Members
    -------
    beat : packet_layout(bus_bytes)
    cut : unsigned(1)
        In a last beat: the rest of the packet stayed outside, and the beat has no meaning.
    lost : unsigned(8)
        In a first beat: number of packets that stayed outside since the packet before, at most 255.
    """
    return data.StructLayout({"beat": packet_layout(bus_bytes), "cut": 1, "lost": LOST_BITS})


class PacketDoor(wiring.Component):
    """Let packets in as long as `inside` is ready; drop them whole when it is not.

    If `inside` is not ready for a beat of a packet that has begun, the packet is cut: its rest is
    dropped, and it gets an end that is marked. Packets that begin before this end has been taken
    stay outside. The latency is 0.

    Parameters
    ----------
    bus_bytes : int

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
        `ready` is constantly 1.
    inside : Out(stream.Signature(door_layout(bus_bytes)))
        `valid` and `payload` depend on those of `packets`. The payload may change before the
        transfer.
    lost : Out(8)
        Packets that stayed outside since the last one that was let in. A register.
    report : In(1)
        One of `lost` is reported. Not if `inside` transfers.
    drops : Out(1)
        A packet that stayed outside, or was cut, ends in this cycle.
    """

    def __init__(self, bus_bytes: int):
        self.bus_bytes = bus_bytes
        super().__init__(
            {
                "packets": In(PacketSignature(bus_bytes)),
                "inside": Out(stream.Signature(door_layout(bus_bytes))),
                "lost": Out(LOST_BITS),
                "report": In(1),
                "drops": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        packets, inside, beat = self.packets, self.inside, self.packets.payload
        # A packet that was cut has no end yet. The rest of the arriving packet is dropped. A beat
        # of the arriving packet was let in.
        owes_end, skips, begun = Signal(), Signal(), Signal()
        enters, refused = Signal(), Signal()
        m.d.comb += [
            packets.ready.eq(1),
            inside.valid.eq(owes_end | (packets.valid & ~skips)),
            inside.payload.beat.eq(beat),
            inside.payload.beat.last.eq(beat.last | owes_end),
            inside.payload.beat.count.eq(Mux(owes_end, self.bus_bytes, beat.count)),
            inside.payload.cut.eq(owes_end),
            inside.payload.lost.eq(self.lost),
            enters.eq(packets.valid & ~skips & ~owes_end & inside.ready),
            refused.eq(packets.valid & ~enters),
            self.drops.eq(refused & beat.last),
        ]
        with m.If(owes_end & inside.ready):
            m.d.sync += owes_end.eq(0)
        with m.If(enters):
            m.d.sync += begun.eq(~beat.last)
        with m.If(refused):
            m.d.sync += skips.eq(~beat.last)
            with m.If(begun & ~skips):
                m.d.sync += owes_end.eq(1)
            with m.If(beat.last):
                m.d.sync += begun.eq(0)
        # A packet that was cut gets its status by its end.
        alone = Signal()
        m.d.comb += alone.eq(self.drops & ~begun & ~self.lost.all())
        m.d.sync += self.lost.eq(Mux(enters & ~begun, 0, self.lost + alone - self.report))
        return m
