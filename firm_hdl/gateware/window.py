"""A window onto the next bytes of a packet: slots that hold beats, a byte offset, one shifter."""

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

    Beats stay in the slots where they arrived. The slots that a step can touch are put in order and
    shifted by the offset of the next unread byte. The shift is a multiple of the alignment that all
    steps have in common: a plan whose steps all start at bus words has no shifter. The number of
    slots exceeds the beats that a step can touch, so that `packets.ready` is a function of
    registers alone and the stream moves one beat per cycle. Latency 1 cycle from `packets` to the
    window.

    A beat whose bytes are all read frees its slot. The last beat of a packet is freed only by
    `finish` or `drop`, so the window never shows bytes of the next packet.

    Parameters
    ----------
    plan : Plan
        Decides all sizes.

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
    data : Out(ArrayLayout(8, window_bytes))
        The next bytes; the first one is in lane 0. Bytes that are not present have no defined
        value.
    have : Out
        Bit k: byte k is present. Has at least `slack_bytes + 1` bits more than `data` has bytes.
    held : Out(1)
        A beat is present and the offset lies inside it.
    ended : Out(1)
        The last beat of the packet is among the beats that a step can touch.
    first_bytes : Out(range(bus_bytes + 1))
        Unread bytes of the first beat.
    first_last : Out(1)
        The first beat is the last one of its packet.
    count : In(range(skip_bytes + 1))
        Bytes by which `take` advances the window.
    align : In(3)
        Mask of the low bits of the position, counted from behind the encapsulation header, that
        must be 0 after `take`. The padding up to there is skipped in the same cycle, even if its
        bytes are not present.
    take : In(1)
        Advance the window.
    finish : In(1)
        Remove all beats of the packet that a step can touch. When `ended`, these are all that is
        left of the packet.
    drop : In(1)
        Remove the first beat; only when `held`. At most one of `take`, `finish` and `drop` is high.
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        self.geometry = geometry(plan)
        bus, most_beats = plan.bus_bytes, self.geometry.window_beats
        word = self.geometry.window_bytes
        super().__init__(
            {
                "packets": In(PacketSignature(bus)),
                "data": Out(data.ArrayLayout(8, word)),
                "have": Out(max(most_beats * bus, word + plan.slack_bytes + 1)),
                "held": Out(1),
                "ended": Out(1),
                "first_bytes": Out(range(bus + 1)),
                "first_last": Out(1),
                "count": In(range(self.geometry.skip_bytes + 1)),
                "align": In(3),
                "take": In(1),
                "finish": In(1),
                "drop": In(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus, most_beats = self.plan.bus_bytes, self.geometry.window_beats
        depth = 1 << most_beats.bit_length()
        # A beat's bytes, which of them are valid, and whether it is the last one.
        slot = data.StructLayout({"data": 8 * bus, "keep": bus, "last": 1})
        slots = [Signal(slot, name=f"slot_{i}") for i in range(depth)]
        first = Signal(range(depth))
        fill = Signal(range(depth + 1))
        offset = Signal(range(bus + self.geometry.skip_bytes + 8))
        pops = Signal(range(most_beats + 1))
        self._write(m, slots, first, fill, pops)

        # Only beats up to the first `last` belong to this packet and may be read.
        beats = [Signal(slot, name=f"beat_{i}") for i in range(most_beats)]
        valid = [Signal(name=f"valid_{i}") for i in range(most_beats)]
        ends = [Signal(name=f"ends_{i}") for i in range(most_beats)]
        before: Value = Const(1)
        for i, beat in enumerate(beats):
            m.d.comb += [
                beat.eq(Array(slots)[(first + i)[: len(first)]]),
                valid[i].eq((fill > i) & before),
                ends[i].eq(valid[i] & beat.last),
            ]
            before = valid[i] & ~beat.last
        self._read(m, beats, valid, ends, offset)

        past = self._past(m, offset)
        m.d.comb += self._pops(m, pops, past, offset, valid, ends)
        low = bus.bit_length() - 1
        with m.If(self.finish | self.drop):
            m.d.sync += offset.eq(0)
        with m.Elif(self.take):
            # Low bits that the plan proves to be zero are constants, and cost nothing.
            fixed = self.geometry.start_alignment_bytes.bit_length() - 1
            beats_over = past[low:] - pops
            m.d.sync += offset.eq(Cat(Const(0, fixed), past[fixed:low], beats_over))
        with m.Else():
            m.d.sync += offset[low:].eq(offset[low:] - pops)
        return m

    def _write(
        self, m: Module, slots: list[Signal], first: Signal, fill: Signal, pops: Signal
    ) -> None:
        bus, depth = self.plan.bus_bytes, len(slots)
        payload = self.packets.payload
        free = Signal.like(first)
        m.d.comb += self.packets.ready.eq(fill < depth)
        arrives = self.packets.valid & self.packets.ready
        with m.If(arrives):
            m.d.sync += free.eq(free + 1)
            for i, beat in enumerate(slots):
                with m.If(free == i):
                    m.d.sync += [
                        beat.data.eq(Value.cast(payload.data)),
                        beat.keep.eq(Cat(~payload.last | (payload.count > k) for k in range(bus))),
                        beat.last.eq(payload.last),
                    ]
        m.d.sync += [fill.eq(fill - pops + arrives), first.eq(first + pops)]

    def _read(
        self,
        m: Module,
        beats: list[Signal],
        valid: list[Signal],
        ends: list[Signal],
        offset: Signal,
    ) -> None:
        bus, word = self.plan.bus_bytes, self.geometry.window_bytes
        low = bus.bit_length() - 1
        inside = offset[low:] == 0
        keep = Cat(
            beat.keep & inside.replicate(bus) & ok.replicate(bus)
            for beat, ok in zip(beats, valid, strict=True)
        )
        m.d.comb += [
            Value.cast(self.data).eq(
                self._shifted(m, Cat(b.data for b in beats), offset, 8, name="shifted")[: 8 * word]
            ),
            self.have.eq(self._shifted(m, keep, offset, 1, name="shifted")),
            self.ended.eq(Cat(ends).any()),
            # An offset past the end of the last beat skips padding that the packet does not have.
            self.held.eq(valid[0] & (inside | beats[0].last)),
            self.first_last.eq(ends[0]),
        ]
        unread = self._shifted(m, beats[0].keep, offset, 1, name="unread")
        m.d.comb += self.first_bytes.eq(Mux(inside, sum(unread[1:bus], unread[0]), 0))

    def _shifted(
        self, m: Module, now: Value, offset: Signal, unit_bits: int, *, name: str
    ) -> Value:
        """Return a value shifted right by the offset, with `unit_bits` bits for each byte."""
        for bit in reversed(range(self.plan.bus_bytes.bit_length() - 1)):
            if 1 << bit < self.geometry.start_alignment_bytes:
                break
            amount = unit_bits << bit
            shifted = Signal(len(now), name=f"{name}_{amount}")
            m.d.comb += shifted.eq(Mux(offset[bit], now >> amount, now))
            now = shifted
        return now

    def _past(self, m: Module, offset: Signal) -> Signal:
        """Return the offset behind the bytes that are taken and the padding that follows them."""
        # Wide enough for an offset, a step, and the padding of both.
        taken = Signal(range(self.plan.bus_bytes + 2 * self.geometry.skip_bytes + 16))
        past = Signal.like(taken)
        m.d.comb += taken.eq(offset + self.count)
        if not self.geometry.aligns:
            m.d.comb += past.eq(taken)
            return past
        header = self.plan.header_bytes
        position = Signal(unsigned(3))
        if self.plan.bus_bytes >= 8:
            m.d.comb += position.eq(taken - header)
        else:
            # The offset has fewer bits than the position, so the position has a register.
            start = Signal(unsigned(3), init=-header % 8)
            m.d.comb += position.eq(start + self.count)
            with m.If(self.finish | self.drop):
                m.d.sync += start.eq(-header % 8)
            with m.Elif(self.take):
                m.d.sync += start.eq(position + (-position & self.align))
        m.d.comb += past.eq(taken + (-position & self.align))
        return past

    def _pops(
        self,
        m: Module,
        pops: Signal,
        past: Signal,
        offset: Signal,
        valid: list[Signal],
        ends: list[Signal],
    ) -> Value:
        """Return the assignment of `pops`: the number of beats that leave in this cycle."""
        low = self.plan.bus_bytes.bit_length() - 1
        taken = Signal.like(pops, name="pops_taken")
        idle = Signal.like(pops, name="pops_idle")
        finished = Signal.like(pops, name="pops_finished")
        for i in range(len(valid)):
            goes = valid[i] & ~ends[i]
            with m.If(goes & (past[low:] > i)):
                m.d.comb += taken.eq(i + 1)
            with m.If(goes & (offset[low:] > i)):
                m.d.comb += idle.eq(i + 1)
            with m.If(valid[i]):
                m.d.comb += finished.eq(i + 1)
        going = Mux(self.take, taken, idle)
        return pops.eq(Mux(self.finish, finished, Mux(self.drop, 1, going)))
