"""The offsets of the leaves of a plan in a packet, found by running the plan on offsets alone.

This is an independent check of alignment: the layout computes residues from the message's types,
this module from the steps, one residue modulo 8 at a time. OMG DDS-XTypes 1.3, clause 7.4.1: a
primitive of n bytes starts at a multiple of n, with no more padding than that requires.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.plan.tree import (
    Constant,
    Item,
    Leaf,
    Length,
    Loop,
    Pad,
    Part,
    Plan,
    Run,
    Slice,
    Step,
    numbered,
)
from firm_hdl.wire import RULES

__all__ = ["check_offsets", "paddings"]

Places: TypeAlias = "frozenset[tuple[int, int]]"
"""Offsets modulo 8, each with the number of static padding bytes after it, up to the next slice."""


def check_offsets(plan: Plan) -> list[str]:
    """Return the errors in the alignment and padding of a plan that is sound otherwise."""
    walk = _Walk(plan)
    walk.packet()
    walk.problems.update(
        (f"step {index}: is aligned already", None)
        for index, counts in walk.skipped.items()
        if not any(counts)
    )
    return list(walk.problems)


def paddings(plan: Plan) -> dict[int, frozenset[int]]:
    """Return, for each step that is aligned, the numbers of bytes that may be skipped before it.

    Unlike the layout, the result respects limits: a loop of at most one element has no padding
    before a second element. The padding before a run that a length counts is not included.
    """
    walk = _Walk(plan, limited=True)
    walk.packet()
    return {
        index: frozenset(counts)
        for index, counts in walk.skipped.items()
        if index not in walk.counted
    }


@dataclass(slots=True)
class _Walk:
    plan: Plan
    # Whether counts in a packet are within their limits; otherwise they are arbitrary.
    limited: bool = False
    # The places after a body, by its first step, its level and the places before it.
    known: dict[tuple[int, int, Places], Places] = field(default_factory=dict)
    # A dict, because it keeps the order.
    problems: dict[str, None] = field(default_factory=dict)
    # Numbers of bytes that are skipped before each aligned step or run.
    skipped: dict[int, set[int]] = field(default_factory=dict)
    # Runs that a length counts.
    counted: set[int] = field(default_factory=set)
    max_align: int = field(init=False)

    def __post_init__(self) -> None:
        self.max_align = RULES[self.plan.wire].max_align

    def report(self, index: int, problem: str) -> None:
        self.problems[f"step {index}: {problem}"] = None

    def packet(self) -> None:
        # Alignment counts from the end of the encapsulation header. So a packet starts at -4 there.
        start = frozenset({(-self.plan.header_bytes % 8, 0)})
        end = self.block(self.plan.items, 0, 0, start)
        if any(pad for _, pad in end):
            self.problems["the end: padding that no value follows"] = None

    def check_padding_used(self, places: Places, index: int) -> None:
        if any(pad for _, pad in places):
            self.report(index, "padding that no value follows")

    def align_of(self, leaf: Leaf) -> int:
        return min(leaf.item_bytes, self.max_align) or 1

    def align(self, index: int, align: int, places: Places) -> Places:
        if align == 1:
            return places
        self.check_padding_used(places, index)
        self.skipped.setdefault(index, set()).update(-r % align for r, _ in places)
        return frozenset(((r + -r % align) % 8, 0) for r, _ in places)

    def block(self, items: Sequence[Item], first: int, level: int, places: Places) -> Places:
        """Follow items inside `level` loops; return the places after them."""
        # A loop and the first loop in its body have one number, so the level is needed as well.
        key = (first, level, places)
        if key not in self.known:
            for index, item in numbered(items, first):
                match item:
                    case Step():
                        places = self.step(index, item, places)
                    case Run():
                        places = self.run(index, item, places)
                    case Loop():
                        self.check_padding_used(places, index)
                        places = self.loop(index, item, level + 1, places)
            self.known[key] = places
        return self.known[key]

    def loop(self, index: int, loop: Loop, level: int, places: Places) -> Places:
        if isinstance(loop.count, Length):
            # Places only become more, and there are 64 at most: soon another element adds none.
            for _ in range(loop.count.limit if self.limited else 1 << 32):
                more = places | self.block(loop.body, index, level, places)
                if more == places:
                    break
                places = more
            return places
        order: list[Places] = []
        # Where the places recur, the elements between are a period.
        while len(order) < loop.count.number and places not in order:
            order.append(places)
            places = self.block(loop.body, index, level, places)
        if places in order:
            start = order.index(places)
            return order[start + (loop.count.number - start) % (len(order) - start)]
        return places

    def step(self, index: int, step: Step, places: Places) -> Places:
        if step.align != 1:
            part = step.slices[0] if step.slices else None
            if isinstance(part, Part):
                self.check_align(index, step.align, self.plan.leaves[part.leaf])
            else:
                self.report(index, "alignment that no value follows")
        places = self.align(index, step.align, places)
        for item in step.slices:
            places = frozenset(self.slice(index, item, *place) for place in places)
        return places

    def check_align(self, index: int, align: int, leaf: Leaf) -> None:
        """Check that a step or run has the alignment of the value that it starts with."""
        if align not in (1, self.align_of(leaf)):
            self.report(index, f"{leaf} is aligned to {align}, not {self.align_of(leaf)}")

    def slice(self, index: int, item: Slice, residue: int, pad: int) -> tuple[int, int]:
        # Padding is judged at the value after it, which says how much is right.
        if isinstance(item, Pad):
            if pad + item.bytes > 7:
                self.report(index, "8 padding bytes or more")
            return residue, min(7, pad + item.bytes)
        if isinstance(item, Part) and item.first == 0:
            self.expect(index, self.plan.leaves[item.leaf], residue, pad)
        elif pad:
            self.report(index, "padding that no value follows")
        return (residue + pad + item.bytes) % 8, 0

    def expect(self, index: int, leaf: Leaf, residue: int, pad: int) -> None:
        want = -residue % self.align_of(leaf)
        if pad != want:
            problem = f"{leaf} has {pad} bytes of padding before it, not {want}"
            self.report(index, f"{problem}, at offset {residue} modulo 8")

    def run(self, index: int, run: Run, places: Places) -> Places:
        """Follow a whole run, including the rest that a later step takes."""
        leaf = self.plan.leaves[run.leaf]
        self.check_align(index, run.align, leaf)
        counts: Sequence[int]
        empty: Places
        if isinstance(run.count, Constant):
            counts, empty = [run.count.number], frozenset()
        else:
            self.counted.add(index)
            self.check_padding_used(places, index)
            # Eight counts are enough for all offsets modulo 8 at which the run can end.
            most = min(run.count.most, 8) if self.limited else 8
            # An empty run has neither items nor padding.
            counts, empty = range(1, most + 1), places
        starts = self.align(index, run.align, places)
        for residue, pad in starts:
            self.expect(index, leaf, residue, pad)
        return empty | {
            ((residue + pad + count * leaf.item_bytes) % 8, 0)
            for residue, pad in starts
            for count in counts
        }
