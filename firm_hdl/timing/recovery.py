"""The time that a bad packet can cost a deserializer, found from the plan alone.

After an error, a deserializer completes every sequence whose length it has already transferred, one
step per cycle (``docs/reference/status.md``). So what follows the error is at most the steps of a
message in which every length is 0, and the steps of the elements that one sequence, and one
sequence inside each of these elements, have claimed. :mod:`firm_hdl.plan.limits` tells how much
lengths can claim together. The worst packet claims what has the most steps per byte.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from typing import NamedTuple

from firm_hdl.plan.tree import Charge, Constant, Item, Length, Loop, Plan, Run, Step

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


class _Tail(NamedTuple):
    """The items of a body from one of them on, and how often they are repeated."""

    items: tuple[Item, ...]
    start: int = 0
    times: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Recovery:
    """How long a deserializer is busy with a bad packet, and with a good one, in cycles.

    Consumers take all outputs at once, and the packet's beats have come.
    """

    # Upper bound from the cycle in which the step with the error could be executed to the last step
    # of the packet. The next packet follows, and the status is valid a latency later.
    cycles: int
    # Cycles of a legal packet of `max_message_bytes`: the one that takes longest among packets with
    # many shortest elements, or items, in one place.
    longest_packet: int


@dataclass(frozen=True, slots=True, kw_only=True)
class _Level:
    """A sequence that may be open when an error is found."""

    item: Run | Loop
    count: Length
    steps: Fraction  # Steps of an element whose lengths are 0, or of an item.
    # The offset behind the length, if the sequences around have one element each, and all other
    # lengths are 0. It counts from the end of the header.
    offset: int
    after: tuple[_Tail, ...]  # What follows the sequence in the packet.


def recovery(plan: Plan, shortest_cycles: int) -> Recovery:
    """Compute how long a deserializer is busy with bad packets and with long ones.

    * `shortest_cycles`: cycles of the shortest packet.
    """
    empty = _Empty(plan)
    chains = list(empty.chains(plan.items, -plan.header_bytes, (), ()))
    worst = max(map(_most_steps, chains), default=Fraction(0))
    legal = [chain[-1] for chain in chains if all(level.count.most for level in chain)]
    longest = max(map(empty.longest, legal), default=0)
    return Recovery(
        cycles=ERROR_CYCLES + empty.steps(plan.items) + ceil(worst) + END_CYCLES,
        longest_packet=shortest_cycles + longest,
    )


@dataclass(slots=True)
class _Empty:
    """The steps and bytes of a plan, if every length is 0."""

    plan: Plan
    # By the items of a body: the bytes of each tail of it, for each offset of its start modulo
    # `_ALIGNMENTS`.
    sizes: dict[int, list[tuple[int, ...]]] = field(default_factory=dict)

    def steps(self, items: Sequence[Item]) -> int:
        """Return the number of steps of items."""
        total = 0
        for item in items:
            match item:
                case Step():
                    total += 1
                case Run(count=Constant(number)):
                    total += number // self.plan.leaves[item.leaf].lanes
                case Loop(count=Constant(number)):
                    total += number * self.steps(item.body)
        return total

    def skip(self, tail: _Tail, offset: int) -> int:
        """Return the offset behind a tail, taken once, that starts at an offset."""
        items = tail.items
        if id(items) not in self.sizes:
            tables = [(0,) * _ALIGNMENTS]
            for item in reversed(items):
                ends = [self.skip_item(item, start) for start in range(_ALIGNMENTS)]
                behind = tables[-1]
                tables.append(
                    tuple(end - at + behind[end % _ALIGNMENTS] for at, end in enumerate(ends))
                )
            self.sizes[id(items)] = tables[::-1]
        return offset + self.sizes[id(items)][tail.start][offset % _ALIGNMENTS]

    def skip_item(self, item: Item, offset: int) -> int:
        match item:
            case Step():
                return offset + -offset % item.align + item.bytes
            case Run(count=Constant(number)):
                return self.skip_run(item, number, offset)
            case Loop(count=Constant(number)):
                return self.repeat(_Tail(item.body, times=number), offset)
            case _:
                return offset

    def skip_run(self, run: Run, count: int, offset: int) -> int:
        return offset + -offset % run.align + count * self.plan.leaves[run.leaf].item_bytes

    def repeat(self, tail: _Tail, offset: int) -> int:
        """Return the offset behind a tail."""
        # Where an element starts as one before it, the elements between them are a period.
        seen: dict[int, tuple[int, int]] = {}
        count = tail.times
        while count:
            count -= 1
            left, start = seen.setdefault(offset % _ALIGNMENTS, (count, offset))
            if left > count:
                rounds, count = divmod(count + 1, left - count)
                offset += rounds * (offset - start)
                seen.clear()
            else:
                offset = self.skip(tail, offset)
        return offset

    def chains(
        self,
        items: tuple[Item, ...],
        offset: int,
        around: tuple[_Level, ...],
        after: tuple[_Tail, ...],
    ) -> Iterator[tuple[_Level, ...]]:
        """Yield each sequence in items after the sequences around it, outermost first.

        * `offset`: where the items start.
        * `after`: what follows the items.
        """
        for place, item in enumerate(items, 1):
            rest = (_Tail(items, place), *after)
            match item:
                case Loop(count=Constant(number)):
                    others = _Tail(item.body, times=number - 1)
                    yield from self.chains(item.body, offset, around, (others, *rest))
                case Run(count=Length() as count):
                    steps = Fraction(1, self.plan.leaves[item.leaf].lanes)
                    level = _Level(item=item, count=count, steps=steps, offset=offset, after=rest)
                    yield (*around, level)
                case Loop(count=Length() as count):
                    steps = Fraction(self.steps(item.body))
                    level = _Level(item=item, count=count, steps=steps, offset=offset, after=rest)
                    yield (*around, level)
                    yield from self.chains(item.body, offset, (*around, level), rest)
            offset = self.skip_item(item, offset)

    def longest(self, level: _Level) -> int:
        """Return the cycles of the longest legal packet with many elements in one sequence.

        The packet has `max_message_bytes`, or the sequence its largest length. The cycles of the
        shortest packet are not counted.
        """
        most = level.count.most
        if most <= FEW:
            return ceil(most * level.steps)
        size = self.size(level, FEW)
        each = self.size(level, FEW + 1) - size
        if not each:
            return ceil(most * level.steps)
        count = min(most, FEW + max(0, self.plan.max_message_bytes - size) // each)
        return ceil(count * max(level.steps, Fraction(each, self.plan.bus_bytes)))

    def size(self, level: _Level, count: int) -> int:
        """Return the bytes of a packet in which a sequence has some elements."""
        if isinstance(level.item, Loop):
            offset = self.repeat(_Tail(level.item.body, times=count), level.offset)
        else:
            offset = self.skip_run(level.item, count, level.offset)
        for tail in level.after:
            offset = self.repeat(tail, offset)
        return offset + self.plan.header_bytes


def _most_steps(chain: tuple[_Level, ...]) -> Fraction:
    """Return the largest number of steps that sequences inside each other can have claimed.

    Each sequence has either claimed too little to be charged, or a part of the budget; the bound is
    the sum of both.
    """
    steps, budget = Fraction(0), 0
    charged: list[tuple[Fraction, _Level, Charge]] = []
    for level in chain:
        charge = level.count.charge
        if charge is None:
            steps += level.count.most * level.steps
        else:
            budget = (charge.budget or budget) + charge.padding_credit
            charged.append((level.steps / charge.bytes, level, charge))
    for rate, level, charge in sorted(charged, key=lambda each: -each[0]):
        taken = min(budget, level.count.most * charge.bytes)
        budget -= taken
        # All that the level may claim is taken, or it may also have claimed some bytes uncharged.
        extra = min(charge.charged_from - 1, level.count.most - taken // charge.bytes)
        steps += taken * rate + extra * level.steps
    return steps
