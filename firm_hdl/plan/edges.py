"""All decisions that a plan leaves to the packet, so that tests can report which were covered.

The paper that firm-hdl follows leaves open how much of a generated circuit its tests reach. A plan
answers this question: a converter executes steps, and a packet decides only what is listed here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from firm_hdl.plan.interpret import Edge
from firm_hdl.plan.offsets import paddings
from firm_hdl.plan.tree import Item, Length, Loop, Plan, Run, Step, numbered

__all__ = ["edges"]

NEXT = ("next",)


def edges(plan: Plan) -> frozenset[Edge]:
    """Return every decision that some legal packet takes.

    Decisions that limits exclude are left out, such as a second iteration of a loop that has at
    most one element, or all of the body of a run that is at most a bus word long.
    :attr:`firm_hdl.plan.Decoded.edges` has the decisions of one packet.
    """
    found = set(_ways(plan, plan.items, 0, 0, NEXT))
    for index, counts in paddings(plan).items():
        found.update(Edge(index, f"padding {count}") for count in counts)
    for index, step in enumerate(plan.steps):
        if isinstance(step, Step) and step.rest is not None:
            found.add(Edge(index, "no rest"))
            if plan.run_of[step.rest].count.most:
                found.add(Edge(index, "rest"))
    return frozenset(found)


def _ways(
    plan: Plan, items: Sequence[Item], first: int, level: int, after: Sequence[str]
) -> Iterator[Edge]:
    """Yield what may follow each step of items inside `level` loops.

    * `after`: what may follow the last item.
    """
    # What follows the item at a place, once it is done. After a step that begins a run or a loop,
    # it is what follows that item, in case there is no element and no word before the rest.
    ends = [NEXT] * (len(items) - 1) + [after]
    for place, (index, item) in enumerate(numbered(items, first)):
        ways = ends[place]
        match item:
            case Step():
                following = items[place + 1] if place + 1 < len(items) else item
                if not isinstance(following, Step) and isinstance(following.count, Length):
                    ways = ends[place + 1]
                    if _may_need_body(plan, following):
                        ways = ["body", *ways]
                yield from (Edge(index, way) for way in ways)
            case Run():
                if _may_need_body(plan, item):
                    yield from (Edge(index, way) for way in ways)
                    lanes = plan.leaves[item.leaf].lanes
                    if item.count.most > lanes + _kept(plan, item):
                        yield Edge(index, "again")
            case Loop():
                again = [f"loop {level} again"] if item.count.most > 1 else []
                yield from _ways(plan, item.body, index, level + 1, [*again, *ways])


def _kept(plan: Plan, run: Run) -> int:
    """Return the items of a run that its words may leave as the rest."""
    return plan.word_count(run) if isinstance(run.count, Length) else 0


def _may_need_body(plan: Plan, item: Run | Loop) -> bool:
    return item.count.most > (_kept(plan, item) if isinstance(item, Run) else 0)
