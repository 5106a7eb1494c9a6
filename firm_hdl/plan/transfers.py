"""The transfers of a step: which leaves it completes, and which leaves may transfer every cycle."""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.plan.ir import Part, RunStep, Step, successors
from firm_hdl.plan.tree import Plan

__all__ = ["repeated_leaves", "transfers"]


def transfers(plan: Plan, step: Step) -> Iterator[tuple[int, Part | None]]:
    """Yield the transfers that a step completes, in wire order.

    Yields
    ------
    The leaf, and the transfer's part of the map; `None` for a word or the rest of a run.
    """
    if step.rest is not None:
        yield plan.runs[step.rest].items, None
    for part in step.parts:
        if part.completes:
            yield part.leaf, part
    if isinstance(step, RunStep):
        yield plan.runs[step.run].items, None


def repeated_leaves(plan: Plan) -> frozenset[int]:
    """Return the leaves that may transfer in two steps in a row."""
    leaves = [{leaf for leaf, _ in transfers(plan, step)} for step in plan.steps]
    start = plan.start.step or 0
    repeated: set[int] = set()
    for index, step in enumerate(plan.steps):
        following = {start if jump.step is None else jump.step for _, jump in successors(step)}
        if isinstance(step, RunStep):
            following.add(index)
        for other in following:
            repeated |= leaves[index] & leaves[other]
    return frozenset(repeated)
