"""All decisions that packets can make in a plan, so that tests can say which of them they took.

The paper that firm-hdl follows leaves open how much of a generated circuit its tests reach. A plan
answers that: a converter's behaviour is its steps, and what is left to the packet is listed here.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.plan.interpret import Edge
from firm_hdl.plan.ir import RUN_COUNTER, Begin, Plan, Step
from firm_hdl.plan.offsets import jumps, paddings

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
    if step.run is not None:
        size = plan.leaves[plan.runs[step.run].items].item_bytes
        if most.get((RUN_COUNTER, index), 0) * size > step.head:
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

    for jump in jumps(plan):
        for counter, count in jump.enter:
            note(counter, jump.step, count)
    for step in plan.steps:
        begin = step.begin
        if begin is not None and begin.body is not None:
            if begin.level is not None:
                note(begin.level, begin.body.step, begin.limit)
            else:
                left = _items(begin) - _head_items(plan, begin)
                note(RUN_COUNTER, begin.body.step, left)
    return most


def _items(begin: Begin) -> int:
    """Return the most items on the wire, a NUL included."""
    return begin.limit + (1 if begin.terminated else 0)


def _head_items(plan: Plan, begin: Begin) -> int:
    """Return how many items a step takes of a run that it does not finish."""
    if begin.run is None or not begin.head:
        return 0
    return plan.leaves[plan.runs[begin.run].items].lanes


def _goes_on(plan: Plan, begin: Begin) -> bool:
    if begin.run is None:
        return begin.limit > 0
    size = plan.leaves[plan.runs[begin.run].items].item_bytes
    return _items(begin) * size > begin.head


def _may_be_done(plan: Plan, begin: Begin) -> bool:
    """Return whether a step that starts something may be its end, too."""
    if begin.length is not None:
        return True
    assert begin.count is not None
    if begin.run is None:
        return False
    size = plan.leaves[plan.runs[begin.run].items].item_bytes
    return begin.count * size <= begin.head
