"""What a plan needs of its window: how wide, where steps may start, how many beats they touch.

Found by following residues of the position through the control flow of the plan until nothing new
turns up. A plan whose steps all start at bus words needs no shifter at all.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.plan.ir import RUN_COUNTER, Exits, Jump, Plan

__all__ = ["Geometry", "geometry"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Geometry:
    """Sizes of a converter.

    Attributes
    ----------
    word_bytes : int
        Most bytes that a step takes in one cycle; at least 1.
    skip_bytes : int
        Most bytes that a step goes forward, padding of known size in front of a run included.
    granule_bytes : int
        Every step starts at a multiple of this many bytes of a bus word; a power of two up to the
        bus width.
    reach_beats : int
        Most beats that the bytes of one step touch; at least 1.
    aligns : bool
        Whether any padding is computed in the circuit.
    """

    word_bytes: int
    skip_bytes: int
    granule_bytes: int
    reach_beats: int
    aligns: bool


def geometry(plan: Plan) -> Geometry:
    """Compute the geometry of a plan."""
    starts = _starts(plan)
    bus = plan.bus_bytes
    offsets = {position % bus for residues in starts for position in _members(residues)}
    granule = bus
    while any(offset % granule for offset in offsets):
        granule //= 2
    reach = 1
    for step, residues in zip(plan.steps, starts, strict=True):
        for position in _members(residues):
            reach = max(reach, -(-(position % bus + step.most_bytes) // bus))
    word = max((1, *(step.most_bytes for step in plan.steps)))
    gaps = (step.bytes + step.begin.gap for step in plan.steps if step.begin is not None)
    return Geometry(
        word_bytes=word,
        skip_bytes=max((word, *gaps)),
        granule_bytes=granule,
        reach_beats=reach,
        aligns=any(step.align > 1 for step in plan.steps),
    )


def _members(residues: int) -> Iterator[int]:
    return (r for r in range(residues.bit_length()) if residues >> r & 1)


def _starts(plan: Plan) -> list[int]:
    """Return, per step, the set of positions where it may start, as a mask of residues."""
    flow = _Flow(plan)
    starts = [0] * len(plan.steps)
    todo = [(plan.start, 1)]
    while todo:
        jump, residues = todo.pop()
        if jump.step is None:
            continue
        residues = flow.aligned(residues, plan.steps[jump.step].align)
        if residues & ~starts[jump.step]:
            starts[jump.step] |= residues
            todo.extend(flow.successors(jump.step, starts[jump.step]))
    return starts


class _Flow:
    def __init__(self, plan: Plan):
        self.plan = plan
        self.modulus = max(8, plan.bus_bytes)
        self.all = (1 << self.modulus) - 1
        jumps = [plan.start]
        for step in plan.steps:
            jumps.extend((step.exits.default, *(jump for _, jump in step.exits.repeats)))
            if step.begin is not None and step.begin.body is not None:
                jumps.append(step.begin.body)
        entered = {
            jump.step for jump in jumps if any(counter == RUN_COUNTER for counter, _ in jump.enter)
        }
        # Runs of constant count are cut to whole bus words by the planner.
        self.constant_runs = {plan.steps[index].run for index in entered if index is not None} | {
            step.begin.run
            for step in plan.steps
            if step.begin is not None and step.begin.run is not None and step.begin.length is None
        }

    def advance(self, residues: int, count: int) -> int:
        count %= self.modulus
        return (residues << count | residues >> (self.modulus - count)) & self.all

    def aligned(self, residues: int, align: int) -> int:
        if align == 1:
            return residues
        result = 0
        for position in _members(residues):
            pad = -(position - self.plan.header_bytes) % align
            result |= self.advance(1 << position, pad)
        return result

    def run_end(self, residues: int, run: int) -> int:
        """Return where the last bytes of a run may end that are taken from one of `residues`."""
        if run in self.constant_runs:
            return self.advance(residues, self.plan.bus_bytes)
        info = self.plan.runs[run]
        unit = self.plan.leaves[info.items].item_bytes
        result = residues
        for n in range(1, self.modulus // unit):
            result |= self.advance(residues, n * unit)
        return result

    def successors(self, index: int, residues: int) -> Iterator[tuple[Jump, int]]:
        step = self.plan.steps[index]
        bus = self.plan.bus_bytes
        after = self.advance(residues, step.bytes)
        if step.run is not None:
            start = residues | self.advance(residues, bus)
            # The body repeats itself without going through an exit.
            yield from self.exits(step.exits, self.run_end(start, step.run))
            yield Jump(step=index), start
            return
        begin = step.begin
        if begin is None:
            yield from self.exits(step.exits, after)
            return
        first = self.advance(after, begin.gap)
        if begin.run is not None and begin.head:
            ends = self.run_end(first, begin.run)
            first = self.advance(first, bus)
        else:
            ends = 0
        if begin.length is not None:
            ends |= after
        if ends:
            yield from self.exits(step.exits, ends)
        if begin.body is not None:
            yield begin.body, first

    def exits(self, exits: Exits, residues: int) -> Iterator[tuple[Jump, int]]:
        for _, jump in exits.repeats:
            yield jump, residues
        yield exits.default, residues
