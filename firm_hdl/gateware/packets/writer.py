"""The writing side of a packet memory: it stores packets, and frees those that are dropped."""

from __future__ import annotations

from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.packets.memory import MemoryShape, Outcome, WhenFull

__all__ = ["PacketWriter"]


@dataclass(frozen=True, slots=True)
class _Room:
    """What follows from a position: the position after it, and whether one or two beats fit."""

    next: Value
    one: Value
    two: Value


class PacketWriter(wiring.Component):
    """Write packets to a memory; free the memory of a packet that is dropped.

    A beat is registered, and written in the next cycle. With the last beat, the writer decides
    whether the packet is kept. At most one packet in the memory is undecided, and it is the newest
    one. So to drop a packet, the writer goes back to the first word of it.

    The writer decides on arrival whether a beat is kept or dropped, and registers the decision. So
    the look-ahead for the beat after it begins with registers.

    `packets.ready` is a register, or constantly 1 with the policy `"drop"`.

    Parameters
    ----------
    shape : MemoryShape
    when_full : "wait" or "drop"

    Members
    -------
    packets : In(stream.Signature(shape.beat))
    abort : In(1)
        Drop the packet; only counts with its last beat.
    word : Out(shape.beat)
        `count` is `bus_bytes` in all beats but the last one of a packet.
    at : Out(address)
        Where the word is written.
    writes : Out(1)
        A register.
    kept : Out(position)
        All words before this position are of packets that are kept.
    keeps : Out(1)
        A packet is kept; the next value of `kept` is the end of it. A register.
    size : Out(range(memory_bytes + 1))
        Bytes of the packet, if `keeps`.
    freed : In(position)
        All words before this position are free.
    stored : In(range(packets + 2))
        Number of packets that are kept and whose first beat was not sent, or only in the cycle
        before.
    begun : In(1)
        In the cycle before, the first beat of a packet was sent.
    ended : Out(1)
        A packet was decided: 2 cycles after the transfer of its last beat. A register.
    outcome : Out(Outcome)
        Whether the packet was kept, or why it was dropped; valid with `ended`.
    """

    def __init__(self, shape: MemoryShape, when_full: WhenFull):
        self.shape, self.waits = shape, when_full == "wait"
        super().__init__(
            {
                "packets": In(stream.Signature(shape.beat)),
                "abort": In(1),
                "word": Out(shape.beat),
                "at": Out(shape.address_bits),
                "writes": Out(1),
                "kept": Out(shape.position_bits),
                "keeps": Out(1),
                "size": Out(range(shape.memory_bytes + 1)),
                "freed": In(shape.position_bits),
                "stored": In(range(shape.packets + 2)),
                "begun": In(1),
                "ended": Out(1),
                "outcome": Out(Outcome),
            }
        )
        # The beat in the register, and whether there was room for it when it came.
        self.beat = Signal(shape.beat, reset_less=True)
        self.has_beat = Signal()
        self.fits = Signal()
        self.aborts = Signal(reset_less=True)
        # The rest of the packet is dropped, after the beat in the register.
        self.drops = Signal()
        # The packet of the beat in the register goes back to its first word.
        self.rewinds = Signal()
        # With the next beat, its packet has as many words as the memory.
        self.fills = Signal()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        self._receive(m)
        self._write(m)
        return m

    def _receive(self, m: Module) -> None:
        """Register a beat; look ahead whether there is room for the next one."""
        shape, packets = self.shape, self.packets
        # The position of the next beat that is received, if no packet were dropped.
        arrived = Signal(shape.position_bits)
        room = Signal(init=1)
        comes = Signal()
        last = packets.payload.last
        lost = Signal()
        fails = Signal()
        counts = Signal()
        ends = Signal()
        m.d.comb += [
            packets.ready.eq(room if self.waits else 1),
            comes.eq(packets.valid & packets.ready),
            # Beats that are dropped need no room.
            lost.eq(self.drops | ~room),
            # A beat that fills the memory, and does not end its packet, is one too many.
            fails.eq(lost | self.fills),
            counts.eq(packets.valid & ~lost),
            ends.eq(counts & last & ~self.abort),
        ]
        m.d.sync += [
            self.writes.eq(counts),
            self.keeps.eq(ends),
            self.rewinds.eq(comes & Mux(last, lost | self.abort, fails)),
        ]
        with m.If(comes):
            m.d.sync += self.drops.eq(~last & fails)
        # The difference of positions takes most of a cycle. So all that follows from a position is
        # computed for both positions, and for both cases of whether a beat comes.
        stays, goes_back = self._after(m, arrived), self._after(m, self.kept)
        # What becomes free in this cycle is seen in the next one.
        m.d.sync += [
            arrived.eq(
                Mux(
                    self.rewinds,
                    Mux(counts, goes_back.next, self.kept),
                    Mux(counts, stays.next, arrived),
                )
            ),
            room.eq(
                Mux(
                    self.rewinds,
                    Mux(counts, goes_back.two, goes_back.one),
                    Mux(counts, stays.two, stays.one),
                )
                & self._may_store(ends)
            ),
            self.has_beat.eq(comes),
            self.beat.eq(packets.payload),
            self.beat.count.eq(Mux(last, packets.payload.count, shape.bus_bytes)),
            self.aborts.eq(self.abort),
            self.fits.eq(room),
        ]

    def _after(self, m: Module, position: Value) -> _Room:
        """Return what follows from the position of the next beat."""
        used = Signal(len(position))
        m.d.comb += used.eq(position - self.freed)
        return _Room(
            next=(position + 1)[: len(position)],
            one=~used[-1],
            two=~used[-1] & ~used[:-1].all(),
        )

    def _may_store(self, ends: Value) -> Value:
        """Return whether one more packet may be stored; `ends`: a packet that may be kept ends."""
        # By how many packets more than `stored` there will be: `stored` follows `keeps` and `begun`
        # in the next cycle only, and a packet that ends now is kept in the next cycle.
        left = {more: self.stored < self.shape.packets - more for more in (-1, 0, 1, 2)}
        fewer, same, more = (Mux(ends, left[n + 1], left[n]) for n in (-1, 0, 1))
        return Mux(self.begun, Mux(self.keeps, same, fewer), Mux(self.keeps, more, same))

    def _write(self, m: Module) -> None:
        """Write the beat in the register, and say what became of the packet with its last beat."""
        shape, beat = self.shape, self.beat
        # Words of the packet that are written, before the beat.
        words = Signal(shape.address_bits)
        # The packet lost a beat before the current one, because it is larger than the memory.
        dropping = Signal()
        large = Signal(reset_less=True)
        ends = Signal()
        at = Signal(shape.position_bits)
        # Words of the packet before the beat that fills the memory.
        most = shape.beats - 1
        m.d.comb += [
            ends.eq(self.has_beat & beat.last),
            self.fills.eq(
                Mux(
                    self.has_beat,
                    (words == most - 1) & ~(beat.last | self.drops),
                    words == most,
                )
            ),
            self.word.eq(beat),
            self.at.eq(at),
            self.size.eq(Cat(Const(0, shape.lane_bits), words) + beat.count),
        ]
        m.d.sync += [
            dropping.eq(self.drops),
            self.ended.eq(ends),
            self.outcome.eq(
                Mux(
                    self.aborts,
                    Outcome.ABORTED,
                    Mux(
                        dropping & large,
                        Outcome.LARGE,
                        Mux(self.writes, Outcome.KEPT, Outcome.FULL),
                    ),
                )
            ),
        ]
        # A beat that fits, and after which the rest of the packet is dropped, is one too many.
        with m.If(self.has_beat & ~dropping):
            m.d.sync += large.eq(self.fits)
        with m.If(self.has_beat):
            m.d.sync += words.eq(Mux(ends | self.drops, 0, words + 1))
            m.d.sync += at.eq(Mux(self.rewinds, self.kept, at + 1))
        with m.If(self.keeps):
            m.d.sync += self.kept.eq(at + 1)
