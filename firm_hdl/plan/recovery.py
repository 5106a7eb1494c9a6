"""The time that a bad packet can cost a deserializer, found from the plan alone.

After an error, a deserializer completes every sequence whose length it has already transferred, one
step per cycle (``docs/reference/status.md``). So what follows the error is at most the steps of a
message in which every length is 0, and the steps of the elements that one sequence, and one
sequence inside each of these elements, have claimed. :mod:`firm_hdl.plan.limits` tells how much
lengths can claim together. The worst packet claims what has the most steps per byte.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from typing import TypeAlias

from firm_hdl.plan.ir import RUN_COUNTER, Begin, BeginLoop, Claim, Plan, RunStep
from firm_hdl.plan.offsets import Span, loop_spans

__all__ = ["Recovery", "recovery"]

ERROR_CYCLES = 3
"""Cycles from the one in which a step could be executed, if it has an error, to the step after it.

In two of them, the sequencer finds the error and the bytes that are good; in one, it executes the
step with these bytes.
"""

END_CYCLES = 1
"""Cycles after the last step, if the end of the packet is no part of it."""

FEW = 2
"""Elements after which each further one has as many bytes: it starts as the one before it."""

_ALIGNMENTS = 8
"""Offsets that differ by this many bytes, the largest alignment, have the same padding."""

_Region: TypeAlias = tuple[int, int, int]
"""A range of steps inside loops: the first one, the last one, and the number of loops."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Recovery:
    """How long a deserializer is busy with a bad packet, and with a good one, in cycles.

    Consumers take all outputs at once, and the packet's beats have come.

    Attributes
    ----------
    cycles : int
        Upper bound from the cycle in which the step with the error could be executed to the last
        step of the packet. The next packet follows, and the status is valid a latency later.
    longest_packet : int
        Cycles of a legal packet of `max_message_bytes`: the one that takes longest among packets
        with many shortest elements, or items, in one place.
    """

    cycles: int
    longest_packet: int


@dataclass(frozen=True, slots=True, kw_only=True)
class _Level:
    """A sequence that may be open when an error is found.

    Attributes
    ----------
    most : int
        Largest legal count on the wire.
    steps : Fraction
        Steps of an element whose lengths are 0, or of an item.
    begin : Begin
    body : _Region
        The steps of an element, or of a word.
    offset : int
        The offset behind the length, if the sequences around have one element each, and all other
        lengths are 0. It counts from the end of the header.
    after : tuple of _Region and int
        What follows the sequence in the packet, and how often.
    """

    most: int
    steps: Fraction
    begin: Begin
    body: _Region
    offset: int
    after: tuple[tuple[_Region, int], ...]

    @property
    def claim(self) -> Claim | None:
        """What the length claims, if it is counted."""
        return self.begin.claim


def recovery(plan: Plan, shortest_cycles: int) -> Recovery:
    """Compute how long a deserializer is busy with bad packets and with long ones.

    Parameters
    ----------
    plan : Plan
    shortest_cycles : int
        Cycles of the shortest packet.
    """
    steps = _Steps(plan)
    whole = (0, len(plan.steps) - 1, 0)
    chains = list(steps.chains(whole, -plan.header_bytes, (), ()))
    worst = max(map(_most_steps, chains), default=Fraction(0))
    legal = [chain[-1] for chain in chains if all(level.most for level in chain)]
    longest = max(map(steps.longest, legal), default=0)
    return Recovery(
        cycles=ERROR_CYCLES + steps.of_region(*whole) + ceil(worst) + END_CYCLES,
        longest_packet=shortest_cycles + longest,
    )


@dataclass(slots=True)
class _Steps:
    """The steps of a plan, if every length is 0."""

    plan: Plan
    spans: dict[Span, int] = field(init=False)
    # Constant counts by level (or "run") and first step.
    counts: dict[tuple[int | str, int], int] = field(default_factory=dict)
    # Bytes of regions, for each offset of their start modulo `_ALIGNMENTS`.
    sizes: dict[_Region, tuple[int, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.spans = loop_spans(self.plan)
        for jump in self.plan.jumps():
            for counter, count in jump.enter:
                if jump.step is not None:
                    self.counts[counter, jump.step] = count

    def places(self, first: int, last: int, depth: int) -> Iterator[tuple[int, int, int]]:
        """Yield the parts of a range of steps: the first step, the last one, and a constant count.

        A part is a loop of constant count, or one step with the body of what it begins.
        """
        index = first
        while index <= last:
            if (depth, index) in self.counts:
                end = self.spans.get((depth, index), last)
                yield index, end, self.counts[depth, index]
            else:
                begin, end = self.plan.steps[index].begin, index
                if isinstance(begin, BeginLoop):
                    end = self.spans.get((depth, index + 1), index + 1)
                elif begin is not None:
                    end = index + 1
                yield index, end, 0
            index = end + 1

    def of_region(self, first: int, last: int, depth: int) -> int:
        """Return the number of steps of a range that is inside `depth` loops."""
        total = 0
        for index, end, count in self.places(first, last, depth):
            step = self.plan.steps[index]
            if count:
                total += count * self.of_region(index, end, depth + 1)
            elif isinstance(step, RunStep):
                lanes = self.plan.items_leaf(step.run).lanes
                total += self.counts[RUN_COUNTER, index] // lanes
            else:
                total += 1
        return total

    def skip(self, region: _Region, offset: int) -> int:
        """Return the offset behind a range of steps that starts at an offset."""
        first, last, depth = region
        if first > last:
            return offset
        if region not in self.sizes:
            # From the end, so that the sizes of all ends of the range are known, too.
            found = (0,) * _ALIGNMENTS
            for place in reversed(list(self.places(*region))):
                ends = [self.skip_place(place, depth, start) for start in range(_ALIGNMENTS)]
                found = tuple(
                    end - start + found[end % _ALIGNMENTS] for start, end in enumerate(ends)
                )
                self.sizes[place[0], last, depth] = found
        return offset + self.sizes[region][offset % _ALIGNMENTS]

    def skip_place(self, place: tuple[int, int, int], depth: int, offset: int) -> int:
        index, end, count = place
        if count:
            return self.repeat((index, end, depth + 1), count, offset)
        step = self.plan.steps[index]
        offset += -offset % step.align
        if isinstance(step, RunStep):
            items = self.counts[RUN_COUNTER, index]
            return offset + items * self.plan.item_bytes(step.run)
        return offset + step.bytes

    def repeat(self, region: _Region, count: int, offset: int) -> int:
        """Return the offset behind a range of steps that is repeated."""
        # Where an element starts as one before it, the elements between them are a period.
        seen: dict[int, tuple[int, int]] = {}
        while count:
            count -= 1
            left, start = seen.setdefault(offset % _ALIGNMENTS, (count, offset))
            if left > count:
                rounds, count = divmod(count + 1, left - count)
                offset += rounds * (offset - start)
                seen.clear()
            else:
                offset = self.skip(region, offset)
        return offset

    def chains(
        self,
        region: _Region,
        offset: int,
        around: tuple[_Level, ...],
        after: tuple[tuple[_Region, int], ...],
    ) -> Iterator[tuple[_Level, ...]]:
        """Yield each sequence of a range after the sequences around it, outermost first.

        Parameters
        ----------
        region : _Region
        offset : int
            Where the range starts.
        around : tuple of _Level
        after : tuple of _Region and int
            What follows the range, and how often.
        """
        _, last, depth = region
        for place in self.places(*region):
            index, end, count = place
            begin = self.plan.steps[index].begin
            rest = (((end + 1, last, depth), 1), *after)
            body = (index, end, depth + 1)
            if count:
                yield from self.chains(body, offset, around, ((body, count - 1), *rest))
            offset = self.skip_place(place, depth, offset)
            if begin is not None and not count:
                body = (index + 1, end, depth + 1)
                chain = (*around, self.level(begin, body, offset, rest))
                yield chain
                if isinstance(begin, BeginLoop):
                    yield from self.chains(body, offset, chain, rest)

    def level(
        self, begin: Begin, body: _Region, offset: int, after: tuple[tuple[_Region, int], ...]
    ) -> _Level:
        if isinstance(begin, BeginLoop):
            steps = Fraction(self.of_region(*body))
        else:
            steps = Fraction(1, self.plan.items_leaf(begin.run).lanes)
        most = self.plan.max_count(begin)
        return _Level(most=most, steps=steps, begin=begin, body=body, offset=offset, after=after)

    def longest(self, level: _Level) -> int:
        """Return the cycles of the longest legal packet with many elements in one sequence.

        The packet has `max_message_bytes`, or the sequence its largest length. The cycles of the
        shortest packet are not counted.
        """
        if level.most <= FEW:
            return ceil(level.most * level.steps)
        size = self.size(level, FEW)
        each = self.size(level, FEW + 1) - size
        if not each:
            return ceil(level.most * level.steps)
        count = min(level.most, FEW + max(0, self.plan.max_message_bytes - size) // each)
        return ceil(count * max(level.steps, Fraction(each, self.plan.bus_bytes)))

    def size(self, level: _Level, count: int) -> int:
        """Return the bytes of a packet in which a sequence has some elements."""
        begin = level.begin
        if isinstance(begin, BeginLoop):
            offset = self.repeat(level.body, count, level.offset)
        else:
            offset = level.offset + -level.offset % begin.align
            offset += count * self.plan.item_bytes(begin.run)
        for region, times in level.after:
            offset = self.repeat(region, times, offset)
        return offset + self.plan.header_bytes


def _most_steps(chain: tuple[_Level, ...]) -> Fraction:
    """Return the largest number of steps that sequences inside each other can have claimed.

    Each sequence has either claimed too little to be counted, or a part of the budget; the bound is
    the sum of both.
    """
    steps, budget = Fraction(0), 0
    counted: list[tuple[Fraction, int, Claim, _Level]] = []
    for level in chain:
        if level.claim is None:
            steps += level.most * level.steps
        else:
            budget = (level.claim.total or budget) + level.claim.saved
            counted.append((level.steps / level.claim.bytes, level.most, level.claim, level))
    for rate, most, claim, level in sorted(counted, key=lambda each: -each[0]):
        taken = min(budget, most * claim.bytes)
        budget -= taken
        # All that the level may claim is taken, or it may also have claimed some bytes uncounted.
        extra = min(claim.least - 1, most - taken // claim.bytes)
        steps += taken * rate + extra * level.steps
    return steps
