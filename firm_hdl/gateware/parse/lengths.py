"""Predecode: a length in every lane where one can end, decoded as beats arrive.

The sequencer has one cycle from a length to the position after the items that the length counts.
So all that follows from the value alone is computed here, before the sequencer needs it:
comparisons, the size of the rest, and the position of the next step. The sequencer then selects an
entry by its position, and fields of the entry by its step.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.flow import exceeds, last_word
from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, align_up, beat_layout, known_lane_bits
from firm_hdl.plan import Begin, BeginLoop, BeginRun, MapStep, Plan, RunStep
from firm_hdl.plan.geometry import Geometry

__all__ = [
    "LENGTH_BYTES",
    "Lengths",
    "LoopMeaning",
    "Meaning",
    "RunMeaning",
    "meanings_of",
    "shift_of",
]

LENGTH_BYTES = 4


def shift_of(plan: Plan, step: int | None) -> int:
    """Return the distance from the start of a step's own bytes to the last one of them.

    It is -1 if there are none, as at the end of the packet (`None`).
    """
    if step is None:
        return -1
    taken = plan.steps[step]
    return (plan.bus_bytes if isinstance(taken, RunStep) else taken.bytes) - 1


@dataclass(frozen=True, slots=True, kw_only=True)
class _Meaning(ABC):
    """What a length means in one step: the names of its fields in a table entry.

    Steps with the same meaning share a field. So the number of fields grows with the kinds of
    lengths, not with the number of lengths.

    Attributes
    ----------
    plan : Plan
    begin : Begin
        The loop or run that the step begins.
    """

    plan: Plan
    begin: Begin

    @property
    @abstractmethod
    def kind(self) -> str:
        """What is counted: equal for lengths whose items have one size."""

    @property
    def max_count(self) -> int:
        """The largest legal value."""
        return self.plan.max_count(self.begin)

    @property
    def over(self) -> str:
        """The value is above `max_count`."""
        return f"over_{self.max_count}"

    @property
    def skips(self) -> str:
        """The body is skipped: no element, no word before the rest, or an illegal length."""
        return f"skips_{self.kind}_{self.max_count}"

    @property
    def counted(self) -> str | None:
        """The value is large enough to be counted by its claim; `None`: it has no claim."""
        claim = self.begin.claim
        return None if claim is None else f"counted_{claim.least}"

    @property
    def single(self) -> str:
        """The body is executed at most once."""
        return f"single_{self.kind}"

    @property
    def double(self) -> str:
        """Two passes of the body; valid only if `single` is 0."""
        return f"double_{self.kind}"


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopMeaning(_Meaning):
    """The length of a loop.

    Attributes
    ----------
    has_leaves : bool
        Whether steps without bytes matter, because they have leaves.
    """

    begin: BeginLoop
    has_leaves: bool

    @property
    def kind(self) -> str:
        return "nothing" if self.is_nothing else "loop"

    @property
    def is_nothing(self) -> bool:
        """The length counts elements that have no bytes, and leaves do not matter."""
        if self.has_leaves:
            return False
        body = self.plan.steps[self.begin.body.step or 0]
        return isinstance(body, MapStep) and not body.bytes and body.begin is None


@dataclass(frozen=True, slots=True, kw_only=True)
class RunMeaning(_Meaning):
    """The length of a run.

    Attributes
    ----------
    nexts : tuple of int
        The steps to which exits of the length's step lead.
    """

    begin: BeginRun
    nexts: tuple[int, ...]

    @property
    def kind(self) -> str:
        return f"run_{self.item_bytes}{'_nul' if self.terminated else ''}"

    @property
    def item_bytes(self) -> int:
        """Bytes of an item."""
        return self.plan.item_bytes(self.begin.run)

    @property
    def terminated(self) -> bool:
        """Whether a NUL follows the items."""
        return self.plan.runs[self.begin.run].terminated

    @property
    def lanes(self) -> int:
        """Items of a word."""
        return self.plan.leaves[self.plan.runs[self.begin.run].items].lanes

    @property
    def word(self) -> int:
        """The largest value of which all items are in the rest."""
        return self.plan.word(self.begin.run)

    @property
    def rest(self) -> str:
        """Items of the rest."""
        return f"rest_{self.kind}"

    def next_last_at(self, step: int) -> str:
        """The last byte of `step`, which follows, if all items are in the rest."""
        align, shift = self.plan.steps[step].align, shift_of(self.plan, step)
        return f"last_{self.kind}_{self.begin.align}_{align}_{shift + 1}"


Meaning: TypeAlias = LoopMeaning | RunMeaning


def meanings_of(plan: Plan, *, has_leaves: bool = True) -> dict[int, Meaning]:
    """Return what the lengths of a plan mean, by step.

    Parameters
    ----------
    plan : Plan
    has_leaves : bool
        Whether steps without bytes matter, because they have leaves.
    """
    found: dict[int, Meaning] = {}
    for index, step in enumerate(plan.steps):
        match step.begin:
            case BeginLoop() as begin:
                found[index] = LoopMeaning(plan=plan, begin=begin, has_leaves=has_leaves)
            case BeginRun() as begin:
                nexts = tuple(j.step for j in step.exits.jumps if j.step is not None)
                found[index] = RunMeaning(plan=plan, begin=begin, nexts=nexts)
    return found


class Lengths(wiring.Component):
    """A table of decoded lengths, by the position of a length's last byte.

    An entry is written together with the beat of that byte. Each lane in which a length can end
    has a memory of its own. Entries are read combinationally.

    Parameters
    ----------
    plan : Plan
    geometry : Geometry
    meanings : sequence of Meaning
        Of the steps with a length.

    Members
    -------
    beat : In(beat_layout(plan))
        The beat that is written to the packet buffer in this cycle.
    phase : In(3)
        Position after the encapsulation header of the beat's packet, modulo 8. Not used on a bus
        of 8 bytes or more.
    key : In(position)
        Last byte of a length.
    entry : Out
        The fields that :class:`Meaning` names, and `zero`.
    count : Out
        The length that was looked up in the cycle before, as wide as legal values. The number is
        not needed earlier, and its memories do not load `key`, which is late in the cycle.
    """

    def __init__(self, plan: Plan, geometry: Geometry, meanings: Sequence[Meaning]):
        self.plan, self.ring, self.meanings = plan, Ring(plan), meanings
        self.lanes = sorted(
            {
                (lane + step.bytes - 1) % plan.bus_bytes
                for step, place in zip(plan.steps, geometry.places, strict=True)
                if step.begin is not None
                for lane in place.map
            }
        )
        self.layout = data.StructLayout(self._fields())
        self.count_bits = max((m.max_count.bit_length() for m in self.meanings), default=1)
        super().__init__(
            {
                "beat": In(beat_layout(plan)),
                "phase": In(3),
                "key": In(self.ring.bits),
                "entry": Out(self.layout),
                "count": Out(self.count_bits),
            }
        )

    def _fields(self) -> dict[str, int]:
        fields = {"zero": 1}
        for meaning in self.meanings:
            fields |= {meaning.over: 1, meaning.skips: 1, meaning.single: 1, meaning.double: 1}
            if meaning.counted is not None:
                fields[meaning.counted] = 1
            if isinstance(meaning, RunMeaning):
                fields[meaning.rest] = meaning.lanes.bit_length()
                for step in meaning.nexts:
                    fields[meaning.next_last_at(step)] = self.ring.bits
        return fields

    def elaborate(self, platform: object) -> Module:
        m = Module()
        ring = self.ring
        # The first bytes of a length may be in earlier beats.
        history = Signal(8 * (LENGTH_BYTES - 1), reset_less=True)
        stream = Cat(history, self.beat.data)
        with m.If(self.beat.valid):
            m.d.sync += history.eq(stream[-len(history) :])
        entries, counts = [], []
        key = ring.position("key_before")
        m.d.sync += key.eq(self.key)
        for lane in self.lanes:
            length = Signal(8 * LENGTH_BYTES, name=f"length_{lane}")
            entry = Signal(self.layout, name=f"entry_{lane}")
            m.d.comb += length.eq(stream[8 * lane : 8 * (lane + LENGTH_BYTES)])
            self._decode(m, length, lane, entry)
            entries.append(self._store(m, f"entry_{lane}", Value.cast(entry), self.key))
            counts.append(self._store(m, f"count_{lane}", length[: self.count_bits], key))
        self._select(m, Value.cast(self.entry), self.key, entries)
        self._select(m, self.count, key, counts)
        return m

    def _store(self, m: Module, name: str, value: Value, key: Value) -> Value:
        """Write a value with each beat; return that of the beat with `key`."""
        ring = self.ring
        memory = LutMemory(m, name, len(value), ring.depth)
        write, read = memory.write, memory.reader()
        m.d.comb += [
            write.addr.eq(self.beat.at),
            write.data.eq(value),
            write.en.eq(self.beat.valid),
            read.addr.eq(ring.slot(key)),
        ]
        return read.data

    def _select(self, m: Module, target: Value, key: Value, values: list[Value]) -> None:
        """Select the value of the lane of `key`; only lanes in which lengths end occur."""
        _, known = known_lane_bits(self.lanes, self.plan.bus_bytes)
        lane = self.ring.lane(key)[known:]
        with m.Switch(lane):
            for number, value in zip(self.lanes[:-1], values, strict=False):
                with m.Case(number >> known):
                    m.d.comb += target.eq(value)
            with m.Default():
                m.d.comb += target.eq(values[-1])

    def _decode(self, m: Module, length: Signal, lane: int, entry: data.View) -> None:
        zero = ~length.any()
        m.d.comb += entry.zero.eq(zero)
        for meaning in self.meanings:
            over = exceeds(length, meaning.max_count)
            match meaning:
                case LoopMeaning():
                    skips = Const(1, 1) if meaning.is_nothing else zero
                    single, double = length == 1, length == 2
                case RunMeaning(lanes=lanes, word=word):
                    skips, single, double = (~exceeds(length, n * lanes + word) for n in range(3))
                    m.d.comb += entry[meaning.rest].eq(self._rest(length, lanes, word - lanes))
                    self._places(m, length, lane, entry, meaning)
            m.d.comb += [
                entry[meaning.over].eq(over),
                entry[meaning.skips].eq(skips | over),
                entry[meaning.single].eq(single),
                entry[meaning.double].eq(double),
            ]
            if meaning.begin.claim is not None:
                counted = exceeds(length, meaning.begin.claim.least - 1)
                m.d.comb += entry[meaning.counted].eq(counted)

    @staticmethod
    def _rest(length: Value, lanes: int, nul: int) -> Value:
        """Return the number of items in the last word; 0 if the length counts no item."""
        return Mux(exceeds(length, nul), last_word(length[:8] - nul, lanes), 0)

    def _places(
        self, m: Module, length: Signal, lane: int, entry: data.View, meaning: RunMeaning
    ) -> None:
        """Decode the last byte of the next step, if no word comes before the rest."""
        ring = self.ring
        phase: Value | int = self.plan.header_bytes if self.plan.bus_bytes >= 8 else self.phase
        items = Signal(ring.bits, name=f"items_{lane}_{meaning.kind}")
        items_end = Signal(ring.bits, name=f"items_end_{lane}_{meaning.kind}")
        beat = Cat(Const(0, ring.lane_bits), self.beat.at)
        count = length[: meaning.word.bit_length()]
        first_align = meaning.begin.align
        aligned = align_up(m, beat, lane + 1, first_align, phase)
        m.d.comb += [
            items.eq(Mux(length.any(), aligned, beat + (lane + 1)) if first_align > 1 else aligned),
            items_end.eq(items + (count << (meaning.item_bytes.bit_length() - 1))),
        ]
        for step in meaning.nexts:
            align, shift = self.plan.steps[step].align, shift_of(self.plan, step)
            last = align_up(m, items_end, 0, align, phase, shift)
            m.d.comb += entry[meaning.next_last_at(step)].eq(last)
