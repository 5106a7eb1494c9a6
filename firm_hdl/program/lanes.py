"""The lanes of a bus word at which words of items and maps may start.

Sets of lanes are propagated through the control flow, up to a fixed point. A program in which every
word starts in lane 0 needs no rotator.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from firm_hdl.plan.tree import Plan, Run, Step
from firm_hdl.program.control import Transition, control_of, start_of
from firm_hdl.wire import residues as rs

__all__ = ["StartLanes", "WordLanes", "start_lanes", "word_lanes"]


@dataclass(frozen=True, slots=True)
class StartLanes:
    """The lanes at which a state may start, in ascending order."""

    # Lanes of the first byte after the previous state, where a rest or padding starts.
    first: tuple[int, ...]
    map: tuple[int, ...]  # Lanes of the first byte of the map or of the word of a run.


@dataclass(frozen=True, slots=True, kw_only=True)
class WordLanes:
    """Where one of the two words of a state may be, over all states."""

    # Lanes of the word's first byte, in ascending order; lane 0 if there is no such word.
    lanes: tuple[int, ...]
    unit: int  # Bytes, a power of two: all lanes and sizes of the word are multiples.
    used: bool  # Some state has the word.


def word_lanes(plan: Plan, starts: Sequence[StartLanes]) -> tuple[WordLanes, WordLanes]:
    """Return where the word of items may be, and the map."""
    bus = plan.bus_bytes
    item_lanes: set[int] = set()
    map_lanes: set[int] = set()
    item_sizes, map_sizes = {bus}, {bus}
    for step, start in zip(plan.steps, starts, strict=True):
        if isinstance(step, Run):
            (item_lanes if step.counted else map_lanes).update(start.map)
            continue
        map_sizes.add(step.bytes)
        if step.rest is not None:
            item_lanes.update(start.first)
            item_sizes.add(plan.leaves[step.rest].item_bytes)
        if step.bytes:
            map_lanes.update(start.map)
        if step.bytes > bus:
            item_lanes.update(start.map)
    items, map_ = (
        WordLanes(
            lanes=tuple(sorted(lanes)) or (0,), unit=math.gcd(*lanes, *sizes), used=bool(lanes)
        )
        for lanes, sizes in ((item_lanes, item_sizes), (map_lanes, map_sizes))
    )
    return items, map_


def start_lanes(plan: Plan) -> tuple[StartLanes, ...]:
    """Return the lanes at which each state may start."""
    control = control_of(plan)
    # The lane after padding depends on the lane before padding alone, because an alignment divides
    # the bus width or is a multiple of this width.
    modulus = plan.bus_bytes

    def aligned(residues: int, align: int) -> int:
        """Align positions, which count from the start of the packet's header."""
        after_header = rs.advance(residues, -plan.header_bytes, modulus)
        return rs.advance(rs.aligned(after_header, align, modulus), plan.header_bytes, modulus)

    def map_start(step: Step | Run, residues: int) -> int:
        if isinstance(step, Run) and step.counted:
            # The state before has aligned the items.
            return residues
        if isinstance(step, Step) and step.rest is not None:
            residues = rs.spread(residues, plan.leaves[step.rest].item_bytes, modulus)
        return aligned(residues, step.align)

    def successors(index: int, residues: int) -> Iterator[tuple[Transition, int]]:
        step, begin, body = plan.steps[index], control[index].begin, control[index].body
        # The words of a run are as wide as the bus: any number of them ends in the same lane.
        size = step.bytes if isinstance(step, Step) else 0
        after = into_body = rs.advance(map_start(step, residues), size, modulus)
        if isinstance(begin, Run):
            into_body = aligned(after, begin.align)
        if begin is not None and body is not None:
            yield body, into_body
        for each in control[index].exits:
            yield each, after | into_body

    first = [0] * len(plan.steps)
    todo = [(start_of(plan), 1)]
    while todo:
        transition, residues = todo.pop()
        if transition.to is not None and residues & ~first[transition.to]:
            first[transition.to] |= residues
            todo.extend(successors(transition.to, first[transition.to]))
    return tuple(
        StartLanes(tuple(rs.members(lanes)), tuple(rs.members(map_start(step, lanes))))
        for step, lanes in zip(plan.steps, first, strict=True)
    )
