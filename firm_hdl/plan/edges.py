"""All decisions that a plan leaves to the packet, so that tests can report which were covered.

The paper that firm-hdl follows leaves open how much of a generated circuit its tests reach. A plan
answers that: a converter's behaviour is its steps, and the packet only decides what is listed here.
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

    Decisions that limits exclude are left out, such as a second iteration of a loop that has at
    most one element. :attr:`firm_hdl.plan.Decoded.edges` has the decisions of one packet.
    """
    padding = paddings(plan)
    most = _max_counts(plan)
    return frozenset(
        Edge(index, way)
        for index, step in enumerate(plan.steps)
        for way in _ways(plan, index, step, padding.get(index, frozenset()), most)
    )


MaxCounts = dict[tuple["int | str", int], int]


def _ways(
    plan: Plan, index: int, step: Step, padding: frozenset[int], most: MaxCounts
) -> Iterator[str]:
    if step.align != 1:
        yield from (f"padding {count}" for count in padding)
    if (
        isinstance(step, RunStep)
        and most.get((RUN_COUNTER, index), 0) * plan.item_bytes(step.run) > step.head
    ):
        yield "again"
    begin = step.begin
    if begin is not None and begin.body is not None and _may_need_body(plan, begin):
        yield "body"
    if begin is not None and begin.body is not None and not _may_finish(plan, begin):
        return
    for level, jump in step.exits.repeats:
        if jump.step is not None and most.get((level, jump.step), 0) > 1:
            yield f"loop {level} again"
    yield "next"


def _max_counts(plan: Plan) -> MaxCounts:
    """Return the largest count of every loop and run, by counter and first step."""
    most: MaxCounts = {}

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
    """Return the number of items that a step takes of a run that it does not finish."""
    return plan.leaves[plan.runs[begin.run].items].lanes if begin.head else 0


def _may_need_body(plan: Plan, begin: Begin) -> bool:
    if isinstance(begin, BeginLoop):
        return begin.limit > 0
    return plan.most(begin) * plan.item_bytes(begin.run) > begin.head


def _may_finish(plan: Plan, begin: Begin) -> bool:
    """Return whether a step may also finish the loop or run that it starts."""
    return not isinstance(begin, BeginArray) or not _may_need_body(plan, begin)
