"""The lanes at which steps may start, and the sizes of a circuit that follow from them.

Sets of lanes are propagated through the control flow of the plan, up to a fixed point. A plan in
which every word starts in lane 0 needs no rotator.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.plan.ir import BeginRun, IntoBody, Jump, RunStep, Step, successors
from firm_hdl.plan.tree import Plan
from firm_hdl.wire import residues as rs

__all__ = [
    "Geometry",
    "Place",
    "first_step",
    "geometry",
    "may_end_empty",
    "most_beats",
    "only_ends",
    "ring_beats",
]


@dataclass(frozen=True, slots=True)
class Place:
    """The lanes of a bus word at which a step may start, in ascending order.

    Attributes
    ----------
    first : tuple of int
        Lanes of the first byte after the previous step, where a rest or padding starts.
    map : tuple of int
        Lanes of the first byte of the map or of the word of a run.
    """

    first: tuple[int, ...]
    map: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Geometry:
    """Sizes of a converter.

    Attributes
    ----------
    places : tuple of Place
        By step.
    item_lanes, map_lanes : tuple of int
        Lanes at which the word of items and the word of the map may start, in ascending order.
    item_unit, map_unit : int
        Granularity of that word in bytes, a power of two: its lanes and sizes are multiples.
    aligns : bool
        Whether the circuit computes any padding.
    """

    places: tuple[Place, ...]
    item_lanes: tuple[int, ...]
    map_lanes: tuple[int, ...]
    item_unit: int
    map_unit: int
    aligns: bool


def geometry(plan: Plan) -> Geometry:
    """Compute the geometry of a plan."""
    flow = _Flow(plan)
    places = flow.places()
    bus = plan.bus_bytes
    item_lanes: set[int] = set()
    map_lanes: set[int] = set()
    item_sizes, map_sizes = {bus}, {bus}
    for step, place in zip(plan.steps, places, strict=True):
        map_sizes.add(step.bytes)
        if step.rest is not None:
            item_lanes.update(place.first)
            item_sizes.add(plan.item_bytes(step.rest))
        if isinstance(step, RunStep) and plan.runs[step.run].counted:
            item_lanes.update(place.map)
        elif step.bytes or isinstance(step, RunStep):
            map_lanes.update(place.map)
            if step.bytes > bus:
                item_lanes.update(place.map)
    return Geometry(
        places=places,
        item_lanes=tuple(sorted(item_lanes)) or (0,),
        map_lanes=tuple(sorted(map_lanes)) or (0,),
        item_unit=math.gcd(*item_lanes, *item_sizes),
        map_unit=math.gcd(*map_lanes, *map_sizes),
        aligns=any(step.align > 1 for step in plan.steps)
        or any(isinstance(s.begin, BeginRun) and s.begin.align > 1 for s in plan.steps),
    )


def ring_beats(bus_bytes: int) -> int:
    """Return the number of beats in the ring of a converter.

    A power of two, and more beats than one step can touch.
    """
    return 8 if bus_bytes > 2 else 16


def most_beats(plan: Plan) -> int:
    """Return the largest number of beats that a step touches, including its padding."""
    # An empty packet has a beat, too.
    return max(1, *(_beats(plan, step) for step in plan.steps))


def _beats(plan: Plan, step: Step) -> int:
    bus = plan.bus_bytes
    size = max(step.bytes, bus if isinstance(step, RunStep) else 0) + step.align - 1
    if step.rest is not None:
        size += bus + plan.runs[step.rest].terminated
    if isinstance(step.begin, BeginRun):
        size += step.begin.align - 1
    return -(-(bus - 1 + size) // bus)


def first_step(plan: Plan) -> int:
    """Return the index of the first step with a leaf; earlier steps have constants only."""
    steps = enumerate(plan.steps)
    return next(i for i, step in steps if step.parts or isinstance(step, RunStep))


def only_ends(step: Step) -> bool:
    """Tell whether a step always ends the packet, and takes nothing but a rest."""
    ends = step.exits.default.step is None and not step.exits.repeats
    return ends and step.rest is not None and not step.slices


def may_end_empty(plan: Plan) -> bool:
    """Tell whether a packet may end in a step without bytes.

    Then its last beat may be full before it is known to be the last one.
    """
    return any(
        step.exits.default.step is None and not step.bytes and not only_ends(step)
        for step in plan.steps
        if not isinstance(step, RunStep)
    )


class _Flow:
    def __init__(self, plan: Plan):
        self.plan = plan
        # The lane after padding depends on the lane before padding alone, because an alignment
        # divides the bus width or is a multiple of this width.
        self.modulus = plan.bus_bytes

    def places(self) -> tuple[Place, ...]:
        first = [0] * len(self.plan.steps)
        todo = [(self.plan.start, 1)]
        while todo:
            jump, residues = todo.pop()
            if jump.step is not None and residues & ~first[jump.step]:
                first[jump.step] |= residues
                todo.extend(self.successors(jump.step, first[jump.step]))
        return tuple(
            Place(tuple(rs.members(residues)), tuple(rs.members(self.start(step, residues))))
            for step, residues in zip(self.plan.steps, first, strict=True)
        )

    def advance(self, residues: int, count: int) -> int:
        return rs.advance(residues, count, self.modulus)

    def aligned(self, residues: int, align: int) -> int:
        """Align positions, which count from the start of the packet's header."""
        header = self.plan.header_bytes
        after_header = self.advance(residues, -header)
        return self.advance(rs.aligned(after_header, align, self.modulus), header)

    def start(self, step: Step, residues: int) -> int:
        """Return the positions where a step's own word may start."""
        if step.rest is not None:
            residues = rs.spread(residues, self.plan.item_bytes(step.rest), self.modulus)
        return self.aligned(residues, step.align)

    def successors(self, index: int, residues: int) -> Iterator[tuple[Jump, int]]:
        step = self.plan.steps[index]
        start = self.start(step, residues)
        # The words of a run are as wide as the bus, so that any number of them ends in this lane.
        after = into_body = start if isinstance(step, RunStep) else self.advance(start, step.bytes)
        if isinstance(step.begin, BeginRun):
            into_body = self.aligned(after, step.begin.align)
        for way, jump in successors(step):
            yield jump, into_body if isinstance(way, IntoBody) else after | into_body
