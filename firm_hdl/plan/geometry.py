"""The window that a plan needs: its width, where steps may start, and how many beats they touch.

Residues of the position are followed through the control flow of the plan until no set grows any
more. A plan whose steps all start at bus words needs no shifter at all.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.plan.ir import RUN_COUNTER, BeginArray, Exits, Jump, Plan, RunStep
from firm_hdl.wire import residues as rs

__all__ = ["Geometry", "geometry"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Geometry:
    """Sizes of a converter.

    Attributes
    ----------
    window_bytes : int
        Largest number of bytes that a step takes in one cycle; at least 1.
    skip_bytes : int
        Largest number of bytes by which a step advances, including padding of known size in front
        of a run.
    start_alignment_bytes : int
        Every step starts at a multiple of this many bytes of a bus word; a power of two up to the
        bus width.
    window_beats : int
        Largest number of beats that the bytes of one step touch; at least 1.
    aligns : bool
        Whether the circuit computes any padding.
    """

    window_bytes: int
    skip_bytes: int
    start_alignment_bytes: int
    window_beats: int
    aligns: bool


def geometry(plan: Plan) -> Geometry:
    """Compute the geometry of a plan."""
    starts = _starts(plan)
    bus = plan.bus_bytes
    offsets = {position % bus for residues in starts for position in rs.members(residues)}
    alignment = bus
    while any(offset % alignment for offset in offsets):
        alignment //= 2
    beats = 1
    for step, residues in zip(plan.steps, starts, strict=True):
        for position in rs.members(residues):
            beats = max(beats, -(-(position % bus + step.most_bytes) // bus))
    window = max((1, *(step.most_bytes for step in plan.steps)))
    gaps = (step.bytes + step.gap for step in plan.steps if step.begin is not None)
    return Geometry(
        window_bytes=window,
        skip_bytes=max((window, *gaps)),
        start_alignment_bytes=alignment,
        window_beats=beats,
        aligns=any(step.align > 1 for step in plan.steps),
    )


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
        self.modulus = max(rs.MODULUS, plan.bus_bytes)
        entered = {
            jump.step
            for jump in plan.jumps()
            if any(counter == RUN_COUNTER for counter, _ in jump.enter)
        }
        bodies = (plan.steps[index] for index in entered if index is not None)
        begins = (step.begin for step in plan.steps)
        # The planner cuts runs of constant count to whole bus words.
        self.constant_runs = {
            *(body.run for body in bodies if isinstance(body, RunStep)),
            *(begin.run for begin in begins if isinstance(begin, BeginArray)),
        }

    def advance(self, residues: int, count: int) -> int:
        return rs.advance(residues, count, self.modulus)

    def aligned(self, residues: int, align: int) -> int:
        """Align positions in the packet, which count from the start of its header."""
        header = self.plan.header_bytes
        after_header = self.advance(residues, -header)
        return self.advance(rs.aligned(after_header, align, self.modulus), header)

    def run_end(self, residues: int, run: int) -> int:
        """Return the positions where a run may end if its last word starts at one of `residues`."""
        if run in self.constant_runs:
            return self.advance(residues, self.plan.bus_bytes)
        return rs.spread(residues, self.plan.item_bytes(run), self.modulus)

    def successors(self, index: int, residues: int) -> Iterator[tuple[Jump, int]]:
        step = self.plan.steps[index]
        bus = self.plan.bus_bytes
        if isinstance(step, RunStep):
            start = residues | self.advance(residues, bus)
            # The body repeats itself without going through an exit.
            yield from self.exits(step.exits, self.run_end(start, step.run))
            yield Jump(step=index), start
            return
        after = self.advance(residues, step.bytes)
        begin = step.begin
        if begin is None:
            yield from self.exits(step.exits, after)
            return
        first = self.advance(after, step.gap)
        ends = 0 if isinstance(begin, BeginArray) else after
        if step.take is not None:
            ends |= self.run_end(first, step.take.run)
            first = self.advance(first, bus)
        if ends:
            yield from self.exits(step.exits, ends)
        if begin.body is not None:
            yield begin.body, first

    def exits(self, exits: Exits, residues: int) -> Iterator[tuple[Jump, int]]:
        for _, jump in exits.repeats:
            yield jump, residues
        yield exits.default, residues
