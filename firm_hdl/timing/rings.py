"""The rings of beats of the converters, and what decides when beats leave a serializer."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from firm_hdl.plan.tree import Item, Loop, Plan, Run, Step

__all__ = ["ends_in_tail", "first_step", "may_end_empty", "most_beats", "ring_beats"]


def ring_beats(bus_bytes: int) -> int:
    """Return the number of beats in the ring of a converter.

    A power of two, and more beats than one step can touch.
    """
    return 8 if bus_bytes > 2 else 16


def most_beats(plan: Plan) -> int:
    """Return the largest number of beats that a step touches, including its padding."""
    # An empty packet has a beat, too.
    return max(1, *(_beats(plan, index, step) for index, step in enumerate(plan.steps)))


def _beats(plan: Plan, index: int, step: Step | Run) -> int:
    bus = plan.bus_bytes
    if isinstance(step, Run):
        size = bus + (0 if step.counted else step.align - 1)
    else:
        size = step.bytes + step.align - 1
        if step.rest is not None:
            size += bus + plan.run_of[step.rest].count.nul
        if isinstance(begin := plan.begins.get(index), Run):
            size += begin.align - 1
    return -(-(bus - 1 + size) // bus)


def first_step(plan: Plan) -> int:
    """Return the number of the first step with a leaf; earlier steps have constants only."""
    steps = enumerate(plan.steps)
    return next(i for i, step in steps if isinstance(step, Run) or step.parts)


def ends_in_tail(plan: Plan) -> bool:
    """Tell whether the last step always ends the packet, and takes nothing but a rest."""
    last = plan.items[-1]
    return isinstance(last, Step) and last.rest is not None and not last.slices


def may_end_empty(plan: Plan) -> bool:
    """Tell whether a packet may end in a step without bytes, other than a tail.

    Then its last beat may be full before it is known to be the last one.
    """
    return not ends_in_tail(plan) and any(not step.bytes for step in _final_steps(plan.items))


def _final_steps(items: Sequence[Item]) -> Iterator[Step]:
    """Yield the step, if any, that ends items; and not that of a length, which has bytes."""
    last = items[-1]
    if isinstance(last, Loop):
        yield from _final_steps(last.body)
    elif isinstance(last, Step):
        yield last
