"""The time that a bad packet can cost a deserializer, found from the plan alone.

After an error, a deserializer completes every sequence whose length it has already transferred, one
step per cycle (``docs/interface.md``). So what follows the error is at most the steps of a message
in which every length is 0, and the steps of the elements that one sequence, and one sequence inside
each of these elements, have claimed. :mod:`firm_hdl.plan.limits` tells how much lengths can claim
together. The worst packet claims what has the most steps per byte.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil

from firm_hdl.plan.interpret import decode
from firm_hdl.plan.ir import RUN_COUNTER, Begin, BeginLoop, Claim, Fixed, Plan, RunStep
from firm_hdl.plan.offsets import Span, loop_spans
from firm_hdl.wire.alignment import LENGTH

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

MOST_STEPS = 1 << 14
"""Most steps of such a packet. Padding matters little in larger elements."""


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
    length : int
        Leaf of the length.
    most : int
        Largest legal count on the wire.
    steps : Fraction
        Steps of an element whose lengths are 0, or of an item.
    claim : Claim or None
    """

    length: int
    most: int
    steps: Fraction
    claim: Claim | None


def recovery(plan: Plan, shortest_cycles: int) -> Recovery:
    """Compute how long a deserializer is busy with bad packets and with long ones.

    Parameters
    ----------
    plan : Plan
    shortest_cycles : int
        Cycles of the shortest packet.
    """
    steps = _Steps(plan)
    shortest = steps.of_region(0, len(plan.steps) - 1, 0)
    chains = list(steps.chains(0, len(plan.steps) - 1, 0, ()))
    worst = max(map(_most_steps, chains), default=Fraction(0))
    longest = max(map(_Longest(plan, shortest).cycles, chains), default=0)
    return Recovery(
        cycles=ERROR_CYCLES + shortest + ceil(worst) + END_CYCLES,
        longest_packet=shortest_cycles + longest,
    )


@dataclass(slots=True)
class _Steps:
    """The steps of a plan, if every length is 0."""

    plan: Plan
    spans: dict[Span, int] = field(init=False)
    # Constant counts by level (or "run") and first step.
    counts: dict[tuple[int | str, int], int] = field(default_factory=dict)

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

    def chains(
        self, first: int, last: int, depth: int, around: tuple[_Level, ...]
    ) -> Iterator[tuple[_Level, ...]]:
        """Yield each sequence of a range after the sequences around it, outermost first."""
        for index, end, count in self.places(first, last, depth):
            begin = self.plan.steps[index].begin
            if count:
                yield from self.chains(index, end, depth + 1, around)
            elif begin is not None:
                chain = (*around, self.level(begin, index, end, depth))
                yield chain
                if isinstance(begin, BeginLoop):
                    yield from self.chains(index + 1, end, depth + 1, chain)

    def level(self, begin: Begin, index: int, end: int, depth: int) -> _Level:
        if isinstance(begin, BeginLoop):
            steps = Fraction(self.of_region(index + 1, end, depth + 1))
        else:
            steps = Fraction(1, self.plan.items_leaf(begin.run).lanes)
        most = self.plan.max_count(begin)
        return _Level(length=begin.length, most=most, steps=steps, claim=begin.claim)


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


@dataclass(slots=True)
class _Longest:
    """The longest legal packets.

    Attributes
    ----------
    plan : Plan
    shortest : int
        Steps of the shortest packet.
    starts : dict of int to bytes
        A packet up to a length, by its leaf: the sequences around it have one element each, and all
        other lengths are 0.
    """

    plan: Plan
    shortest: int
    starts: dict[int, bytes] = field(default_factory=dict)

    def cycles(self, chain: tuple[_Level, ...]) -> int:
        """Return the cycles of a packet in which the last sequence of a chain is the longest.

        The packet has `max_message_bytes`, or the sequence its largest length. The cycles of the
        shortest packet are not counted. The chain around the sequence was asked for before.
        """
        level = chain[-1]
        start = self.starts[level.length] = self._start(chain)
        most = ceil(level.most * level.steps)
        if level.most <= FEW or self.shortest + (FEW + 1) * level.steps > MOST_STEPS:
            return most
        size = self._size(start, FEW)
        each = self._size(start, FEW + 1) - size
        if not each:
            return most
        count = min(level.most, FEW + max(0, self.plan.max_message_bytes - size) // each)
        return ceil(count * max(level.steps, Fraction(each, self.plan.bus_bytes)))

    def _start(self, chain: tuple[_Level, ...]) -> bytes:
        """Return a packet up to the length of the last sequence of a chain."""
        if len(chain) > 1:
            packet = self.starts[chain[-2].length] + _number(1)
        else:
            fixed = (item for step in self.plan.steps for item in step.slices)
            packet = b"".join(item.data for item in fixed if isinstance(item, Fixed))
        begin = self.plan.begins[chain[-1].length]
        # The packet ends before the length, so the interpreter continues with lengths of 0. The
        # length is the end of its step.
        visits = decode(self.plan, packet).steps
        end = next(visit.end for visit in visits if self.plan.steps[visit.step].begin is begin)
        return packet.ljust(end - LENGTH.bytes, b"\0")

    def _size(self, start: bytes, count: int) -> int:
        """Return the bytes of a packet after whose start a length is `count`."""
        return decode(self.plan, start + _number(count)).steps[-1].end


def _number(count: int) -> bytes:
    return count.to_bytes(LENGTH.bytes, "little")
