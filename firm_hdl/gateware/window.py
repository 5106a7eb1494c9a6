"""A window onto the bytes of a packet: a queue of beats, a byte offset, one shifter."""

from __future__ import annotations

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.plan import Plan
from firm_hdl.plan.geometry import geometry

__all__ = ["Window"]


class Window(wiring.Component):
    """Show the next unread bytes of the packet at the head of a stream.

    The queue holds one beat more than a step can touch, so that `packets.ready` is a function of
    registers alone and the stream moves one beat per cycle. Beats stay where they arrived; the
    window is shifted by the offset of the next unread byte, in granules (a plan whose steps all
    start at bus words has no shifter). Latency 1 cycle from `packets` to the window.

    A beat whose bytes are all read leaves the queue, except the last one of a packet: that one is
    left to `finish` or `drop`, so the window never shows bytes of the next packet.

    Parameters
    ----------
    plan : Plan
        Decides all sizes.

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
    data : Out(ArrayLayout(8, word_bytes))
        The next bytes, first one in lane 0. What is past `available` is not specified.
    available : Out(range(reach_beats * bus_bytes + 1))
        Bytes of the packet that are there to read.
    have : Out(word_bytes)
        Bit k: byte k is there.
    held : Out(1)
        There is a beat, and the window stands.
    ended : Out(1)
        The packet ends with the available bytes.
    phase : Out(3)
        Position behind the encapsulation header, modulo 8.
    first_bytes, first_last : Out
        Unread bytes of the first beat, and whether it is the packet's last.
    advance : In
        Bytes to go forward with `take`; padding may reach past what is there.
    take, finish, drop : In(1)
        Go forward; remove the rest of the packet (when `ended`); remove the first beat (when
        `held`). At most one at a time.
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        self.geometry = geometry(plan)
        bus, reach = plan.bus_bytes, self.geometry.reach_beats
        word = self.geometry.word_bytes
        super().__init__(
            {
                "packets": In(PacketSignature(bus)),
                "data": Out(data.ArrayLayout(8, word)),
                "available": Out(range(reach * bus + 1)),
                "have": Out(word),
                "held": Out(1),
                "ended": Out(1),
                "phase": Out(3),
                "first_bytes": Out(range(bus + 1)),
                "first_last": Out(1),
                # A step, and up to 7 bytes of padding behind it.
                "advance": In(range(word + 8)),
                "take": In(1),
                "finish": In(1),
                "drop": In(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus, reach = self.plan.bus_bytes, self.geometry.reach_beats
        depth = reach + 1
        beats = [Signal(self.packets.payload.shape(), name=f"beat_{i}") for i in range(depth)]
        fill = Signal(range(depth + 1))
        offset = Signal(range(bus + self.geometry.word_bytes + 8))
        pops = Signal(range(reach + 1))

        # Beats of this packet that may be read: those up to the first `last`.
        valid: list[Signal] = []
        ends: list[Signal] = []
        for i in range(reach):
            valid.append(Signal(name=f"valid_{i}"))
            ends.append(Signal(name=f"ends_{i}"))
            before = valid[i - 1] & ~ends[i - 1] if i else Const(1)
            m.d.comb += [
                valid[i].eq((fill > i) & before),
                ends[i].eq(valid[i] & beats[i].last),
            ]
        self._levels(m, beats, valid, ends, offset)
        self._shift(m, beats, offset)
        self._queue(m, beats, fill, pops)

        past = Signal(range(bus + 2 * self.geometry.word_bytes + 16))
        m.d.comb += past.eq(offset + Mux(self.take, self.advance, 0))
        passed = [valid[i] & ~ends[i] & (past >= (i + 1) * bus) for i in range(reach)]
        next_offset = Signal.like(offset)
        with m.If(self.finish):
            for i in reversed(range(reach)):
                with m.If(ends[i]):
                    m.d.comb += pops.eq(i + 1)
        with m.Elif(self.drop):
            m.d.comb += pops.eq(1)
        with m.Else():
            m.d.comb += [
                pops.eq(sum(passed[1:], passed[0])),
                next_offset.eq(past - Array(i * bus for i in range(reach + 1))[pops]),
            ]
        # Low bits that the plan proves to be zero are kept so, and cost nothing.
        low = self.geometry.granule_bytes.bit_length() - 1
        m.d.sync += offset.eq(Cat(Const(0, low), next_offset[low:]))
        self._phase(m, offset)
        return m

    def _levels(
        self,
        m: Module,
        beats: list[Signal],
        valid: list[Signal],
        ends: list[Signal],
        offset: Signal,
    ) -> None:
        bus = self.plan.bus_bytes
        total = Signal(range(len(valid) * bus + 1))
        for i, beat in enumerate(beats[: len(valid)]):
            with m.If(valid[i]):
                m.d.comb += total.eq(i * bus + Mux(beat.last, beat.count, bus))
        first = Signal(range(bus + 1))
        m.d.comb += [
            self.available.eq(Mux(total > offset, total - offset, 0)),
            self.have.eq(Cat(self.available > k for k in range(self.geometry.word_bytes))),
            self.ended.eq(Cat(ends).any()),
            self.first_last.eq(ends[0]),
            # An offset past the end of the last beat means padding that is not there.
            self.held.eq(valid[0] & ((offset < bus) | beats[0].last)),
            first.eq(Mux(beats[0].last, beats[0].count, bus)),
            self.first_bytes.eq(Mux(first > offset, first - offset, 0)),
        ]

    def _shift(self, m: Module, beats: list[Signal], offset: Signal) -> None:
        bus, word = self.plan.bus_bytes, self.geometry.word_bytes
        now: Value = Cat(beat.data for beat in beats[: self.geometry.reach_beats])
        for bit in reversed(range(bus.bit_length() - 1)):
            if 1 << bit < self.geometry.granule_bytes:
                break
            shifted = Signal(len(now), name=f"shifted_{1 << bit}")
            m.d.comb += shifted.eq(Mux(offset[bit], now >> (8 << bit), now))
            now = shifted
        m.d.comb += Value.cast(self.data).eq(now[: 8 * word])

    def _queue(self, m: Module, beats: list[Signal], fill: Signal, pops: Signal) -> None:
        depth = len(beats)
        m.d.comb += self.packets.ready.eq(fill < depth)
        arrives = self.packets.valid & self.packets.ready
        slot = Signal.like(fill)
        m.d.comb += slot.eq(fill - pops)
        m.d.sync += fill.eq(slot + arrives)
        for i, beat in enumerate(beats):
            with m.Switch(pops):
                for count in range(depth):
                    with m.Case(count):
                        if i + count < depth:
                            m.d.sync += beat.eq(beats[i + count])
            # Written even if nothing arrives: what is past `fill` does not count.
            with m.If(slot == i):
                m.d.sync += beat.eq(self.packets.payload)

    def _phase(self, m: Module, offset: Signal) -> None:
        header = self.plan.header_bytes
        if not self.geometry.aligns:
            return
        if self.plan.bus_bytes >= 8:
            m.d.comb += self.phase.eq(offset[:3] - header)
            return
        phase = Signal(unsigned(3), init=-header % 8)
        m.d.comb += self.phase.eq(phase)
        with m.If(self.finish | self.drop):
            m.d.sync += phase.eq(-header % 8)
        with m.Elif(self.take):
            m.d.sync += phase.eq(phase + self.advance)
