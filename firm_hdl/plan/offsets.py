"""The offsets of the leaves of a plan in a packet, found by running the plan on offsets alone.

This is an independent check of alignment: the layout computes residues from the message's types,
this module from the steps, one residue modulo 8 at a time. OMG DDS-XTypes 1.3, clause 7.4.1: a
primitive of n bytes starts at a multiple of n, with no more padding than that requires.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.plan.ir import (
    RUN_COUNTER,
    BeginLoop,
    BeginRun,
    Fixed,
    Leaf,
    Pad,
    Part,
    Plan,
    RunStep,
    Step,
)
from firm_hdl.wire import RULES

__all__ = ["Span", "check_offsets", "loop_spans", "paddings"]

Span: TypeAlias = "tuple[int, int]"
"""Level and first step of a loop."""

Place: TypeAlias = "tuple[int, int]"
"""An offset modulo 8, and the number of static padding bytes after it, up to the next slice."""


def loop_spans(plan: Plan) -> dict[Span, int]:
    """Return the last step of each loop."""
    spans: dict[Span, int] = {}
    for index, step in enumerate(plan.steps):
        for level, jump in step.exits.repeats:
            if jump.step is not None:
                spans[level, jump.step] = index
    return spans


def check_offsets(plan: Plan) -> list[str]:
    """Return the errors in alignment and padding of a plan with sound control flow."""
    walk = _Walk(plan)
    start: set[Place] = {(-plan.header_bytes % 8, 0)}
    end = walk.region(0, len(plan.steps) - 1, 0, start)
    walk.check_padding_used(end, "the end")
    for index, step in enumerate(plan.steps):
        if step.align != 1 and not any(walk.skipped.get(index, ())):
            walk.report(f"step {index}: is aligned already")
        begin = step.begin
        if isinstance(begin, BeginRun) and begin.align != 1 and index not in walk.padded_runs:
            leaf = plan.items_leaf(begin.run)
            walk.report(f"step {index}: {leaf} is aligned already")
    return list(walk.problems)


def paddings(plan: Plan) -> dict[int, frozenset[int]]:
    """Return, for each step that is aligned, the numbers of bytes that may be skipped before it.

    Unlike the layout, the result respects limits: a loop of at most one element has no padding
    before a second element.
    """
    walk = _Walk(plan, limited=True)
    walk.region(0, len(plan.steps) - 1, 0, {(-plan.header_bytes % 8, 0)})
    return {index: frozenset(found) for index, found in walk.skipped.items()}


@dataclass(slots=True)
class _Walk:
    plan: Plan
    # Whether counts in a packet are within their limits; otherwise they are arbitrary.
    limited: bool = False
    spans: dict[Span, int] = field(init=False)
    # Constant counts by level (or "run") and first step.
    counts: dict[tuple[int | str, int], int] = field(default_factory=dict)
    known: dict[tuple[int, int, int, Place], frozenset[Place]] = field(default_factory=dict)
    # A dict, because it keeps the order.
    problems: dict[str, None] = field(default_factory=dict)
    # Numbers of bytes that are skipped before each aligned step.
    skipped: dict[int, set[int]] = field(default_factory=dict)
    # Steps that start a run with padding before it, at some offset.
    padded_runs: set[int] = field(default_factory=set)
    max_align: int = field(init=False)

    def __post_init__(self) -> None:
        self.spans = loop_spans(self.plan)
        self.max_align = RULES[self.plan.wire].max_align
        for jump in self.plan.jumps():
            for counter, count in jump.enter:
                if jump.step is not None:
                    self.counts[counter, jump.step] = count

    def report(self, problem: str) -> None:
        self.problems[problem] = None

    def check_padding_used(self, places: set[Place], where: str) -> None:
        if any(pad for _, pad in places):
            self.report(f"{where}: padding that no value follows")

    def align(self, leaf: Leaf) -> int:
        return min(leaf.item_bytes, self.max_align) or 1

    def region(self, first: int, last: int, depth: int, places: set[Place]) -> set[Place]:
        """Follow a range of steps that is inside `depth` loops; return the places after it."""
        result: set[Place] = set()
        for place in places:
            key = (first, last, depth, place)
            if key not in self.known:
                self.known[key] = frozenset(self.run_region(first, last, depth, place))
            result |= self.known[key]
        return result

    def run_region(self, first: int, last: int, depth: int, place: Place) -> set[Place]:
        places = {place}
        index = first
        while index <= last:
            if (depth, index) in self.counts:
                count = self.counts[depth, index]
                self.check_padding_used(places, f"step {index}")
                end = self.spans.get((depth, index), last)
                places = self.repeat(index, end, depth + 1, places, count)
                index = end + 1
            else:
                places, index = self.step(index, depth, places)
        return places

    def repeat(
        self, first: int, last: int, depth: int, places: set[Place], count: int
    ) -> set[Place]:
        seen: dict[frozenset[Place], int] = {}
        order: list[set[Place]] = []
        for done in range(count):
            frozen = frozenset(places)
            if frozen in seen:
                # The sets recur from here on.
                period = done - seen[frozen]
                return order[seen[frozen] + (count - done) % period]
            seen[frozen] = done
            order.append(places)
            places = self.region(first, last, depth, places)
        return places

    def any_number(
        self, first: int, last: int, depth: int, places: set[Place], most: int | None
    ) -> set[Place]:
        while most is None or most > 0:
            more = places | self.region(first, last, depth, places)
            if more == places:
                break
            places = more
            most = None if most is None else most - 1
        return places

    def step(self, index: int, depth: int, places: set[Place]) -> tuple[set[Place], int]:
        """Follow a step and what it starts; return the places after that, and the next step."""
        step = self.plan.steps[index]
        if step.align != 1:
            self.check_padding_used(places, f"step {index}")
            self.check_step_align(index, step)
            self.skipped.setdefault(index, set()).update(-r % step.align for r, _ in places)
            places = {((r + -r % step.align) % 8, 0) for r, _ in places}
        if isinstance(step, RunStep):
            return self.constant_run(index, step.run, places), index + 1
        for item in step.slices:
            places = {self.slice(index, item, place) for place in places}
        begin = step.begin
        if begin is None:
            return places, index + 1
        self.check_padding_used(places, f"step {index}")
        if isinstance(begin, BeginLoop):
            end = self.spans.get((depth, index + 1), index + 1)
            most = begin.limit if self.limited else None
            return self.any_number(index + 1, end, depth + 1, places, most), end + 1
        return self.begin_run(index, begin, places), index + 2

    def check_step_align(self, index: int, step: Step) -> None:
        """Check that a step has the alignment of the value that it starts with."""
        if isinstance(step, RunStep):
            leaf = self.plan.items_leaf(step.run)
        else:
            first = step.slices[0] if step.slices else None
            if not isinstance(first, Part):
                self.report(f"step {index}: alignment that no value follows")
                return
            leaf = self.plan.leaves[first.leaf]
        if step.align != self.align(leaf):
            self.report(f"step {index}: {leaf} is aligned to {step.align}, not {self.align(leaf)}")

    def slice(self, index: int, item: Pad | Fixed | Part, place: Place) -> Place:
        residue, pad = place
        if isinstance(item, Pad):
            if pad + item.bytes > 7:
                self.report(f"step {index}: 8 padding bytes or more")
            return residue, min(7, pad + item.bytes)
        if isinstance(item, Part) and item.first == 0:
            leaf = self.plan.leaves[item.leaf]
            self.expect(index, leaf, residue, pad)
        elif pad:
            self.report(f"step {index}: padding that no value follows")
        return (residue + pad + item.bytes) % 8, 0

    def expect(self, index: int, leaf: Leaf, residue: int, pad: int) -> None:
        align = self.align(leaf)
        if pad != -residue % align:
            self.report(
                f"step {index}: {leaf} has {pad} bytes of padding before it, "
                f"not {-residue % align}, at offset {residue} modulo 8"
            )

    def begin_run(self, index: int, begin: BeginRun, places: set[Place]) -> set[Place]:
        """Follow a whole run, including the rest that a later step takes."""
        leaf = self.plan.items_leaf(begin.run)
        align = self.align(leaf)
        if self.plan.steps[index + 1].align != 1:
            self.report(f"step {index + 1}: is aligned within a run")
        if begin.align not in (1, align):
            self.report(f"step {index}: {leaf} is aligned to {begin.align}, not {align}")
        # An empty run has neither items nor padding.
        result = set(places)
        for residue, _ in places:
            padding = -residue % begin.align
            if begin.align == 1:
                self.expect(index, leaf, residue, 0)
            elif padding:
                self.padded_runs.add(index)
            start = residue + padding
            result |= {((start + n * leaf.item_bytes) % 8, 0) for n in self.run_counts(begin)}
        return result

    def run_counts(self, begin: BeginRun) -> Sequence[int]:
        """Return nonzero counts of a run, enough for all offsets modulo 8 at which it can end."""
        most = self.plan.max_count(begin) if self.limited else 8
        return range(1, min(most, 8) + 1)

    def constant_run(self, index: int, run: int, places: set[Place]) -> set[Place]:
        leaf = self.plan.items_leaf(run)
        for residue, pad in places:
            self.expect(index, leaf, residue, pad)
        count = self.counts.get((RUN_COUNTER, index), 0)
        return {((r + pad + count * leaf.item_bytes) % 8, 0) for r, pad in places}
