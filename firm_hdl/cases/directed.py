"""Further cases, until every decision of a plan was taken.

:mod:`firm_hdl.cases.make` chooses each length and value independently of the others. Some
decisions need a combination: a padding of five bytes between two strings, or a second element in
the last turn of an outer loop. So this module draws more cases, and keeps those that take a new
decision. The record of a test names the decisions that are still missing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from firm_hdl.cases.make import Case, make_cases
from firm_hdl.cases.oracle import RosbagsOracle
from firm_hdl.plan import Edge, Plan, decode, encode
from firm_hdl.plan.edges import edges
from firm_hdl.plan.tree import Constant, Item, Loop, Run, Step, numbered

__all__ = ["bare_packets", "more_cases"]

TRIES = 300
"""The search ends after this many seeds in a row without a new decision."""


def more_cases(
    oracle: RosbagsOracle, name: str, plan: Plan, cases: Sequence[Case], *, seed: int = 0
) -> list[Case]:
    """Return cases that take decisions which no given case takes.

    * `name`: ``package/msg/Type``.
    * `plan`: the plan of that type.
    * `seed`: the seed of the given cases.
    """
    missing = set(edges(plan))
    for case in cases:
        missing -= _taken(plan, case)
    found: list[Case] = []
    idle = number = 0
    while missing and idle < TRIES:
        number += 1
        idle += 1
        drawn = make_cases(
            oracle,
            name,
            wire=plan.wire,
            bus_bytes=plan.bus_bytes,
            seed=(seed << 32) + number,
            most=3,
        )
        for case in drawn:
            new = missing & _taken(plan, case)
            if new:
                missing -= new
                found.append(case)
                idle = 0
    return found


def _taken(plan: Plan, case: Case) -> frozenset[Edge]:
    """Return the decisions that a case takes.

    Decisions that only bare strings take count if the case takes them with bare strings.
    """
    decoded = decode(plan, case.packet)
    bare = _bare_edges(plan)
    if not bare:
        return decoded.edges
    packet, _ = encode(plan, decoded.streams, bare_strings=True)
    return decoded.edges | (bare & decode(plan, packet).edges)


def bare_packets(plan: Plan, cases: Iterable[Case]) -> list[tuple[Case, bytes]]:
    """Return cases with packets in which the empty CDR strings are bare: their length is 0.

    ROS 2 and our deserializer read such packets, but no library writes them. The serializer
    answers with the case's own packet. Only cases are returned whose bare strings take a new
    decision; so there are none for ROS 1, and for types without strings.
    """
    missing = _bare_edges(plan)
    found = []
    for case in cases:
        if not missing:
            break
        packet, _ = encode(plan, decode(plan, case.packet).streams, bare_strings=True)
        new = missing & decode(plan, packet).edges
        if new:
            missing -= new
            found.append((case, packet))
    return found


def _bare_edges(plan: Plan) -> frozenset[Edge]:
    """Return the decisions that only a CDR string of length 0 takes, which has not even a NUL."""
    return frozenset(
        Edge(index, "no rest")
        for index, step in _after_runs(plan.items, 0)
        if step.rest is not None and plan.run_of[step.rest].count.nul
    )


def _after_runs(items: Sequence[Item], first: int) -> Iterator[tuple[int, Step]]:
    """Yield the steps that nothing but a run leads to, with their numbers."""
    before: Item | None = None
    for index, item in numbered(items, first):
        if isinstance(item, Loop):
            # The first step of a body is also reached from before the loop.
            yield from _after_runs(item.body, index)
        elif isinstance(item, Step) and isinstance(_last_of(before), Run):
            yield index, item
        before = item


def _last_of(item: Item | None) -> Item | None:
    """Return what is always the last step or run of an item."""
    while isinstance(item, Loop) and isinstance(item.count, Constant):
        item = item.body[-1]
    return item
