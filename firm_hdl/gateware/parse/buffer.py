"""The packet buffer: the position of each arriving beat, and the ends of packets."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, beat_layout, named
from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.names.attributes import REMARK
from firm_hdl.plan import Plan

__all__ = ["ArrivalSignature", "Buffer"]


def ArrivalSignature(plan: Plan) -> wiring.Signature:
    """Return the signature of the packets in the buffer, seen from the buffer.

    Members
    -------
    beat : Out(beat_layout(plan))
        The beat that is written to the buffer in this cycle.
    limit : Out(position)
        All bytes of the current packet before this position are in the buffer.
    ended : Out(1)
        The packet ends at `limit`.
    following : Out(beat)
        First beat of the next packet, if `ended`.
    next : In(1)
        Go to the next packet; only if `ended`.
    """
    ring = Ring(plan)
    return wiring.Signature(
        {
            "beat": Out(beat_layout(plan)),
            "limit": Out(ring.bits),
            "ended": Out(1),
            "following": Out(ring.beat_bits),
            "next": In(1),
        }
    )


class Buffer(wiring.Component):
    """Give each beat a position in the ring; tell how many bytes of the current packet arrived.

    The buffer itself stores no bytes: its readers write `beat` to memories of their own, and read
    it from the next cycle on. The sequencer stores decoded lengths and flags, the mover the bytes.

    Latency 1 cycle from `packets` to `arrival.beat`, and 2 cycles to `arrival.limit`.

    Parameters
    ----------
    plan : Plan

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
        `ready` is a register.
    arrival : Out(ArrivalSignature(plan))
    freed : In(beat)
        No reader needs a beat before this one.
    """

    def __init__(self, plan: Plan):
        self.ring = ring = Ring(plan)
        super().__init__(
            {
                "packets": In(PacketSignature(plan.bus_bytes)),
                "arrival": Out(ArrivalSignature(plan)),
                "freed": In(ring.beat_bits),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        ring, beat = self.ring, self.arrival.beat
        at = self._receive(m)
        next_beat = Signal(ring.beat_bits)
        ends_now = Signal()
        layout = data.StructLayout({"limit": ring.bits, "following": ring.beat_bits})
        end = Signal(layout)
        #   cycle           | 0         | 1         | 2
        #   packets         | last beat |           |
        #   arrival.beat    |           | valid     |
        #   newest          |           | the end   |
        #   limit, ended    |           |           | the end, 1
        #
        # The end of the arriving packet if its last beat is written now; else how far it has come.
        newest = Signal(layout)
        first_missing = Mux(beat.valid, next_beat, at)
        m.d.comb += [
            next_beat.eq(at + 1),
            ends_now.eq(beat.valid & beat.last),
            end.limit.eq(Cat(Const(0, ring.lane_bits), at) + beat.count),
            end.following.eq(next_beat),
            newest.limit.eq(Mux(ends_now, end.limit, Cat(Const(0, ring.lane_bits), first_missing))),
            newest.following.eq(next_beat),
        ]
        self._queue_ends(m, layout, ends_now, end, newest)
        return m

    def _receive(self, m: Module) -> Signal:
        """Register a beat if the ring has room; return the ring position it is written to."""
        ring, packets, beat = self.ring, self.packets, self.arrival.beat
        payload = Signal(packets.payload.shape(), name="payload", reset_less=True)
        # Counts of beats: transferred on `packets`, and written to the ring. `room` is computed a
        # cycle ahead, so it counts with the beat that arrives now.
        arrived, at = Signal(ring.beat_bits, name="arrived"), Signal(ring.beat_bits, name="at")
        used, full = Signal(ring.beat_bits, name="used"), Signal(name="full")
        room, arrives = Signal(name="room", init=1), Signal(name="arrives")
        m.d.comb += [
            packets.ready.eq(room),
            arrives.eq(packets.valid & room),
            used.eq(arrived - self.freed),
            beat.data.eq(Value.cast(payload.data)),
            beat.count.eq(payload.count),
            beat.last.eq(payload.last),
            beat.at.eq(at),
            beat.valid.eq(full),
        ]
        m.d.sync += [
            full.eq(arrives),
            payload.eq(packets.payload),
            arrived.eq(arrived + arrives),
            at.eq(at + full),
            # The highest bit of `used` is set only if the ring is full: `used` is its depth then.
            room.eq(~used[-1] & ~((used == ring.depth - 1) & arrives)),
        ]
        return at

    def _queue_ends(
        self,
        m: Module,
        layout: data.StructLayout,
        ends_now: Signal,
        end: data.View,
        newest: data.View,
    ) -> None:
        """Queue the ends of packets: the first two in registers, the others in a memory.

        With two registers, `next` only selects. The memory has a word for each beat of the ring,
        because a packet may have one beat.
        """
        arrival = self.arrival
        ends = LutMemory(m, "ends", layout, self.ring.depth)
        write, read = ends.write, ends.reader()
        pushed, popped = (
            Signal(self.ring.beat_bits, name=name, attrs={REMARK: f"ends {what}, modulo 2 laps"})
            for name, what in (("pushed", "stored in the memory"), ("popped", "taken out of it"))
        )
        second = Signal(
            layout, name="second", attrs={REMARK: "the end of the packet after the current one"}
        )
        has_second = Signal(name="has_second")
        stored = Signal(name="stored")
        # Every cycle writes a word, but only `pushed` makes it one of the queue. So `ends_now` and
        # `has_second` do not have to reach the enable of the memory.
        m.d.comb += [
            stored.eq(pushed != popped),
            write.addr.eq(pushed),
            write.data.eq(end),
            write.en.eq(1),
            read.addr.eq(popped),
        ]
        # `next` is late in the cycle, so it only selects or enables. It is high only if `ended`;
        # `has_second` implies `ended`.
        first = Signal(layout, name="first")
        m.d.comb += first.eq(Mux(has_second, Value.cast(second), Value.cast(newest)))
        more, follows = Signal(name="more"), Signal(name="follows")
        m.d.comb += [more.eq(stored | ends_now), follows.eq(arrival.ended & ends_now)]
        with m.If(named(m, "takes_first", arrival.next | ~arrival.ended)):
            m.d.sync += [
                arrival.limit.eq(first.limit),
                arrival.following.eq(first.following),
                arrival.ended.eq(has_second | ends_now),
            ]
        with m.If(arrival.next | ~has_second):
            m.d.sync += second.eq(Mux(stored, Value.cast(read.data), Value.cast(end)))
        m.d.sync += has_second.eq(
            Mux(has_second, Mux(arrival.next, more, 1), Mux(arrival.next, 0, follows))
        )
        # If `has_second`, every end is pushed. One that `second` takes at once is popped as well.
        with m.If(has_second & ends_now):
            m.d.sync += pushed.eq(pushed + 1)
        with m.If(arrival.next & has_second & more):
            m.d.sync += popped.eq(popped + 1)
