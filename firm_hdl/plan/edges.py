"""All decisions that packets can make in a plan, so that tests can say which of them they took.

The paper that firm-hdl follows leaves open how much of a generated circuit its tests reach. A plan
answers that: a converter's behaviour is its steps, and what is left to the packet is listed here.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.plan.interpret import Edge
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    Begin,
    BeginArray,
    BeginLoop,
    BeginRun,
    Plan,
    RunStep,
    Step,
)
from firm_hdl.plan.offsets import paddings

__all__ = ["edges"]


def edges(plan: Plan) -> frozenset[Edge]:
    """Return every decision that some legal packet takes.

    What limits forbid is left out: no second turn of a loop that has at most one element, for
    instance. :attr:`firm_hdl.plan.Decoded.edges` has what one packet took.
    """
    padding = paddings(plan)
    most = _most(plan)
    return frozenset(
        Edge(index, way)
        for index, step in enumerate(plan.steps)
        for way in _ways(plan, index, step, padding.get(index, frozenset()), most)
    )


Counts = dict[tuple["int | str", int], int]


def _ways(
    plan: Plan, index: int, step: Step, padding: frozenset[int], most: Counts
) -> Iterator[str]:
    if step.align != 1:
        yield from (f"padding {count}" for count in padding)
    if (
        isinstance(step, RunStep)
        and most.get((RUN_COUNTER, index), 0) * plan.item_bytes(step.run) > step.head
    ):
        yield "again"
    begin = step.begin
    if begin is not None and begin.body is not None and _goes_on(plan, begin):
        yield "body"
    if begin is not None and begin.body is not None and not _may_be_done(plan, begin):
        return
    for level, jump in step.exits.repeats:
        if jump.step is not None and most.get((level, jump.step), 0) > 1:
            yield f"loop {level} again"
    yield "next"


def _most(plan: Plan) -> Counts:
    """Return the largest count of every loop and run, by counter and first step."""
    most: Counts = {}

    def note(counter: int | str, step: int | None, count: int) -> None:
        if step is not None:
            most[counter, step] = max(count, most.get((counter, step), 0))

    for jump in plan.jumps():
        for counter, count in jump.enter:
            note(counter, jump.step, count)
    for step in plan.steps:
        begin = step.begin
        if begin is not None and begin.body is not None:
            if isinstance(begin, BeginLoop):
                note(begin.level, begin.body.step, begin.limit)
            else:
                left = plan.most(begin) - _head_items(plan, begin)
                note(RUN_COUNTER, begin.body.step, left)
    return most


def _head_items(plan: Plan, begin: BeginRun | BeginArray) -> int:
    """Return how many items a step takes of a run that it does not finish."""
    return plan.leaves[plan.runs[begin.run].items].lanes if begin.head else 0


def _goes_on(plan: Plan, begin: Begin) -> bool:
    if isinstance(begin, BeginLoop):
        return begin.limit > 0
    return plan.most(begin) * plan.item_bytes(begin.run) > begin.head


def _may_be_done(plan: Plan, begin: Begin) -> bool:
    """Return whether a step that starts something may be its end, too."""
    return not isinstance(begin, BeginArray) or not _goes_on(plan, begin)
