"""The writing side of a packet memory: it stores packets, and frees those that are dropped."""

from __future__ import annotations

from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.packets.memory import MemoryShape, Outcome, WhenFull
from firm_hdl.gateware.signatures import PacketSignature, packet_layout

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

    `packets.ready` is a register, or constantly 1 with the policy `"drop"`.

    Parameters
    ----------
    shape : MemoryShape
    when_full : "wait" or "drop"

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
    abort : In(1)
        Drop the packet; only counts with its last beat.
    word : Out(packet_layout(bus_bytes))
        `count` is `bus_bytes` in all beats but the last one of a packet.
    at : Out(address)
        Where the word is written.
    writes : Out(1)
    kept : Out(position)
        All words before this position are of packets that are kept.
    keeps : Out(1)
        A packet is kept; the next value of `kept` is the end of it.
    size : Out(range(memory_bytes + 1))
        Bytes of the packet, if `keeps`.
    freed : In(position)
        All words before this position are free.
    stored : In(range(packets + 1))
        Number of packets that are kept and whose first beat was not sent.
    ended : Out(1)
        A packet was decided: 2 cycles after the transfer of its last beat. A register.
    outcome : Out(Outcome)
        Whether the packet was kept, or why it was dropped; valid with `ended`.
    """

    def __init__(self, shape: MemoryShape, when_full: WhenFull):
        self.shape, self.waits = shape, when_full == "wait"
        super().__init__(
            {
                "packets": In(PacketSignature(shape.bus_bytes)),
                "abort": In(1),
                "word": Out(packet_layout(shape.bus_bytes)),
                "at": Out(shape.address_bits),
                "writes": Out(1),
                "kept": Out(shape.position_bits),
                "keeps": Out(1),
                "size": Out(range(shape.memory_bytes + 1)),
                "freed": In(shape.position_bits),
                "stored": In(range(shape.packets + 1)),
                "ended": Out(1),
                "outcome": Out(Outcome),
            }
        )
        # The beat in the register, and whether there was room for it when it came.
        self.beat = Signal(packet_layout(shape.bus_bytes), reset_less=True)
        self.has_beat, self.fits = Signal(), Signal()
        self.aborts = Signal(reset_less=True)
        # The rest of the packet is dropped, after the beat in the register.
        self.drops = Signal()
        # The packet goes back to its first word.
        self.rewinds = Signal()

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
        room, counts, ends = Signal(init=1), Signal(), Signal()
        m.d.comb += [
            packets.ready.eq(room if self.waits else 1),
            # Beats that are dropped need no room.
            counts.eq(packets.valid & room & ~self.drops),
            ends.eq(counts & packets.payload.last & ~self.abort),
        ]
        # Whether the packet goes back, and whether a beat comes, are known late in the cycle. So
        # all that follows from a position is computed for both positions.
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
            self.has_beat.eq(packets.valid & packets.ready),
            self.beat.eq(packets.payload),
            self.beat.count.eq(Mux(packets.payload.last, packets.payload.count, shape.bus_bytes)),
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
        left = [self.stored < self.shape.packets - more for more in range(3)]
        return Mux(self.keeps, Mux(ends, left[2], left[1]), Mux(ends, left[1], left[0]))

    def _write(self, m: Module) -> None:
        """Write the beat in the register, and decide on the packet with its last beat."""
        shape, beat = self.shape, self.beat
        # Words of the packet that are written. With all bits set, the beat takes the last word.
        words = Signal(shape.address_bits)
        # The packet lost a beat before the current one, because it is larger than the memory.
        dropping, large = Signal(), Signal(reset_less=True)
        discarded, fails, ends = Signal(), Signal(), Signal()
        at = Signal(shape.position_bits)
        m.d.comb += [
            ends.eq(self.has_beat & beat.last),
            discarded.eq(dropping | ~self.fits),
            fails.eq(discarded | words.all()),
            self.keeps.eq(ends & ~discarded & ~self.aborts),
            self.drops.eq(Mux(self.has_beat, ~beat.last & fails, dropping)),
            self.rewinds.eq(self.has_beat & ~self.keeps & (beat.last | fails)),
            self.word.eq(beat),
            self.at.eq(at),
            self.writes.eq(self.has_beat & ~discarded),
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
                        Mux(discarded, Outcome.FULL, Outcome.KEPT),
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
