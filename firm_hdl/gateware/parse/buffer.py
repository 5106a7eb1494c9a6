"""The packet buffer: beats as they arrive, and where their packets end."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, beat_layout
from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.plan import Plan

__all__ = ["Buffer"]


class Buffer(wiring.Component):
    """Give each beat its place in the ring, and tell how much of the packet being read is there.

    The bytes are kept by those who read them: the sequencer keeps lengths, the mover lanes. They
    write `beat` to their memories, and can read it in the cycle after.

    Latency 1 cycle from `packets` to `beat`, and 2 cycles to `limit`.

    Parameters
    ----------
    plan : Plan

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
        `ready` is a register.
    beat : Out(beat_layout(plan))
    limit : Out(position)
        Bytes in front of this position are there, as far as they are of the packet being read.
    ended : Out(1)
        The packet ends at `limit`.
    following : Out(beat)
        Where the next packet starts, if `ended`.
    next : In(1)
        Go to the next packet; only if `ended`.
    freed : In(beat)
        Beats in front of this one are not needed any more.
    """

    def __init__(self, plan: Plan):
        self.plan, self.ring = plan, Ring(plan)
        ring = self.ring
        super().__init__(
            {
                "packets": In(PacketSignature(plan.bus_bytes)),
                "beat": Out(beat_layout(plan)),
                "limit": Out(ring.bits),
                "ended": Out(1),
                "following": Out(ring.beat_bits),
                "next": In(1),
                "freed": In(ring.beat_bits),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        ring, beat = self.ring, self.beat
        at = self._receive(m)
        next_beat = Signal(ring.beat_bits)
        ends_now = Signal()
        layout = data.StructLayout({"limit": ring.bits, "following": ring.beat_bits})
        end = Signal(layout)
        # Where the packet that arrives ends, if it ends now; else, how far it is there.
        newest = Signal(layout)
        here = Mux(beat.valid, next_beat, at)
        m.d.comb += [
            next_beat.eq(at + 1),
            ends_now.eq(beat.valid & beat.last),
            end.limit.eq(Cat(Const(0, ring.lane_bits), at) + beat.count),
            end.following.eq(next_beat),
            newest.limit.eq(Mux(ends_now, end.limit, Cat(Const(0, ring.lane_bits), here))),
            newest.following.eq(next_beat),
        ]
        self._follow(m, layout, ends_now, end, newest)
        return m

    def _receive(self, m: Module) -> Signal:
        """Register a beat if there is room for it; return where it is written."""
        ring, packets = self.ring, self.packets
        payload = Signal(packets.payload.shape(), name="payload", reset_less=True)
        # Beats that have arrived, and those that are written.
        arrived, at = Signal(ring.beat_bits, name="arrived"), Signal(ring.beat_bits, name="at")
        used, full = Signal(ring.beat_bits, name="used"), Signal(name="full")
        room, arrives = Signal(name="room", init=1), Signal(name="arrives")
        m.d.comb += [
            packets.ready.eq(room),
            arrives.eq(packets.valid & room),
            used.eq(arrived - self.freed),
            self.beat.data.eq(Value.cast(payload.data)),
            self.beat.count.eq(payload.count),
            self.beat.last.eq(payload.last),
            self.beat.at.eq(at),
            self.beat.valid.eq(full),
        ]
        m.d.sync += [
            full.eq(arrives),
            payload.eq(packets.payload),
            arrived.eq(arrived + arrives),
            at.eq(at + full),
            room.eq(~used[-1] & ~((used == ring.depth - 1) & arrives)),
        ]
        return at

    def _follow(
        self,
        m: Module,
        layout: data.StructLayout,
        ends_now: Signal,
        end: data.View,
        newest: data.View,
    ) -> None:
        """Queue the ends of packets: two in registers, so that `next` is only a select, then more.

        There are as many as there are beats, because a packet may have one beat.
        """
        ends = LutMemory(m, "ends", layout, self.ring.depth)
        write, read = ends.write, ends.reader()
        pushed = Signal(self.ring.beat_bits, name="pushed")
        popped = Signal(self.ring.beat_bits, name="popped")
        second, has_second = Signal(layout, name="second"), Signal(name="has_second")
        stored = Signal(name="stored")
        m.d.comb += [
            stored.eq(pushed != popped),
            write.addr.eq(pushed),
            write.data.eq(end),
            write.en.eq(1),
            read.addr.eq(popped),
        ]
        # `next` is late, so it only selects or enables. It comes only if `ended`, and `has_second`
        # is never without `ended`.
        first = Mux(has_second, Value.cast(second), Value.cast(newest))
        more, follows = Signal(name="more"), Signal(name="follows")
        m.d.comb += [more.eq(stored | ends_now), follows.eq(self.ended & ends_now)]
        with m.If(self.next | ~self.ended):
            m.d.sync += [
                Cat(self.limit, self.following).eq(first),
                self.ended.eq(has_second | ends_now),
            ]
        with m.If(self.next | ~has_second):
            m.d.sync += second.eq(Mux(stored, Value.cast(read.data), Value.cast(end)))
        m.d.sync += has_second.eq(
            Mux(has_second, Mux(self.next, more, 1), Mux(self.next, 0, follows))
        )
        # An end that `second` takes as it comes is pushed and popped.
        with m.If(has_second & ends_now):
            m.d.sync += pushed.eq(pushed + 1)
        with m.If(self.next & has_second & more):
            m.d.sync += popped.eq(popped + 1)
