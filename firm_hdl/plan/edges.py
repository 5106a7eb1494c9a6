"""All decisions that a plan leaves to the packet, so that tests can report which were covered.

The paper that firm-hdl follows leaves open how much of a generated circuit its tests reach. A plan
answers this question: a converter executes steps, and a packet decides only what is listed here.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.plan.interpret import Edge
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    Begin,
    BeginLoop,
    BeginRun,
    IntoBody,
    LoopAgain,
    Next,
    Plan,
    RunStep,
    Step,
    successors,
)
from firm_hdl.plan.offsets import paddings

__all__ = ["edges"]


def edges(plan: Plan) -> frozenset[Edge]:
    """Return every decision that some legal packet takes.

    Decisions that limits exclude are left out, such as a second iteration of a loop that has at
    most one element, or all of the body of a run that is at most a bus word long.
    :attr:`firm_hdl.plan.Decoded.edges` has the decisions of one packet.
    """
    padding = paddings(plan)
    counts = _max_counts(plan)
    return frozenset(
        Edge(index, way)
        for index, step in enumerate(plan.steps)
        for way in _ways(plan, index, step, padding.get(index, frozenset()), counts)
    )


MaxCounts = dict[tuple["int | str", int], int]


def _ways(
    plan: Plan, index: int, step: Step, padding: frozenset[int], counts: MaxCounts
) -> Iterator[str]:
    if isinstance(step, RunStep) and not counts.get((RUN_COUNTER, index), 0):
        return
    if step.rest is not None:
        yield "no rest"
        if counts.get(("rest", step.rest), 0):
            yield "rest"
    yield from (f"padding {count}" for count in padding)
    if isinstance(step, RunStep) and counts[RUN_COUNTER, index] > _once(plan, step):
        yield "again"
    for way, jump in successors(step):
        match way:
            case IntoBody(begin=begin):
                if _may_need_body(plan, begin):
                    yield "body"
            case LoopAgain(level=level):
                if jump.step is not None and counts.get((level, jump.step), 0) > 1:
                    yield f"loop {level} again"
            case Next():
                yield "next"


def _max_counts(plan: Plan) -> MaxCounts:
    """Return the largest count of each loop and body of a run, by counter and first step.

    Also that of each run that a length counts, by "rest" and the index of the run.
    """
    counts: MaxCounts = {}

    def note(counter: int | str, step: int | None, count: int) -> None:
        if step is not None:
            counts[counter, step] = count

    for jump in plan.jumps():
        for counter, count in jump.enter:
            note(counter, jump.step, count)
    for step in plan.steps:
        match step.begin:
            case BeginLoop() as begin:
                note(begin.level, begin.body.step, begin.limit)
            case BeginRun() as begin:
                note("rest", begin.run, plan.max_count(begin))
                if _may_need_body(plan, begin):
                    note(RUN_COUNTER, begin.body.step, plan.max_count(begin))
    return counts


def _once(plan: Plan, step: RunStep) -> int:
    """Return the largest count for which the body of a run takes one cycle."""
    lanes = plan.items_leaf(step.run).lanes
    return lanes + plan.word(step.run) if plan.runs[step.run].counted else lanes


def _may_need_body(plan: Plan, begin: Begin) -> bool:
    if isinstance(begin, BeginLoop):
        return begin.limit > 0
    return plan.max_count(begin) > plan.word(begin.run)
