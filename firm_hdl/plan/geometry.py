"""Sizes that the cycles of a converter depend on, and its circuit."""

from __future__ import annotations

from firm_hdl.plan.ir import BeginRun, RunStep, Step
from firm_hdl.plan.tree import Plan

__all__ = ["first_step", "may_end_empty", "most_beats", "only_ends", "ring_beats"]


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
