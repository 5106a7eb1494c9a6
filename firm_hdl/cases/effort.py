"""The choice of a type's cases, and of those that are simulated, stalled and damaged.

The Python simulator takes time for every leaf in every cycle. So a type of a thousand leaves takes
minutes if all of its cases run, and an array of 8 MiB takes an hour. For such types, only the cases
that take the most decisions of the plan for their size are simulated. The golden model still sees
all cases. The result says what was left out.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet

from firm_hdl.cases.directed import more_cases
from firm_hdl.cases.make import Case, make_cases
from firm_hdl.cases.oracle import RosbagsOracle
from firm_hdl.metrics import metrics_of
from firm_hdl.model import Message
from firm_hdl.plan import Edge, Plan
from firm_hdl.plan.edges import edges
from firm_hdl.plan.shape import shape

__all__ = [
    "LARGE_STRIDE",
    "MAX_MESSAGE_BYTES",
    "MOST_WORK",
    "all_cases",
    "cases_to_disturb",
    "digest",
    "figures",
    "is_large",
    "message_limit",
    "packets_to_simulate",
    "too_large",
    "work_of",
]


OF_THE_TYPE = ("depth", "types", "leaves", "dynamic_leaves", "min_bytes", "shifting")
"""Attributes of :class:`firm_hdl.metrics.Metrics`."""


def figures(message: Message, plan: Plan, packets: Sequence[bytes]) -> dict[str, float]:
    """Return figures by name.

    * `packets`: the packets of all cases.
    """
    of_the_type = metrics_of(message, plan.wire)
    found: dict[str, float] = {name: getattr(of_the_type, name) for name in OF_THE_TYPE}
    found["streams"] = len(plan.leaves)
    found["steps"] = len(plan.steps)
    found["loop_levels"] = plan.levels
    found["decisions"] = len(edges(plan))
    found["case_bytes"] = sum(map(len, packets))
    return found


def digest(plan: Plan) -> str:
    """Return a digest of the shape of a plan. Plans with equal circuits have equal digests."""
    return hashlib.sha256(repr(shape(plan)).encode()).hexdigest()[:16]


MAX_MESSAGE_BYTES = 1 << 16
"""Small enough that a packet with a length over this limit can be completed in simulation."""

LARGE_WORK = 300_000
"""A type is large if its cases together are more work. It is stalled and damaged less often."""

LARGE_STRIDE = 4
"""One in this many cases of a large type is stalled and damaged."""

MOST_WORK = 1_000_000
"""The most work of all cases of a type that are simulated."""

MORE_FOR_NEW = 4
"""The factor for `MOST_WORK` for packets with a decision that no packet chosen before takes."""

MOST_WORK_OF_ONE = 1_500_000
"""A type is not simulated if its smallest message is more work than this."""

MOST_CASE_BYTES = 1 << 18
"""No more cases are made once all packets together have this many bytes."""

# A circuit with fewer leaves has other work in a cycle, so it counts as one with this many.
LEAST_LEAVES = 8


def message_limit(min_bytes: int) -> int:
    """Return the largest message that converters are tested with.

    * `min_bytes`: the size of the type's smallest message.
    """
    return MAX_MESSAGE_BYTES + (min_bytes if min_bytes > MAX_MESSAGE_BYTES // 2 else 0)


def work_of(plan: Plan, packet_bytes: int) -> int:
    """Return beats times leaves. The time of a simulation is roughly proportional to it."""
    return -(-packet_bytes // plan.bus_bytes) * max(len(plan.leaves), LEAST_LEAVES)


def too_large(plan: Plan, min_bytes: int) -> str:
    """Return why a type is too large to simulate; empty if it is not."""
    if work_of(plan, min_bytes) <= MOST_WORK_OF_ONE:
        return ""
    return (
        f"too large to simulate: its smallest message has {min_bytes} bytes, "
        f"and its circuits {len(plan.leaves)} streams"
    )


def all_cases(
    oracle: RosbagsOracle, name: str, plan: Plan, *, seed: int = 0, most: int | None = None
) -> list[Case]:
    """Make at most `most` cases; without a limit, add cases for the plan's remaining decisions.

    Parameters are those of `make_cases`.
    """
    bus_bytes = plan.bus_bytes
    made = make_cases(oracle, name, wire=plan.wire, bus_bytes=bus_bytes, seed=seed, most=most)
    cases = list(_limited(made))
    if most is None and _size(cases) < MOST_CASE_BYTES:
        cases += more_cases(oracle, name, plan, cases, seed=seed)
    return cases


def _size(cases: Iterable[Case]) -> int:
    """Return the total size of the packets in bytes."""
    return sum(len(case.packet) for case in cases)


def _limited(cases: Iterable[Case]) -> Iterator[Case]:
    """Yield at least one case, and more until their total size reaches `MOST_CASE_BYTES`."""
    size = 0
    for case in cases:
        yield case
        size += len(case.packet)
        if size >= MOST_CASE_BYTES:
            return


def is_large(plan: Plan, cases: Sequence[Case]) -> bool:
    """Whether a type takes long to simulate; it is stalled and damaged less often."""
    return work_of(plan, _size(cases)) > LARGE_WORK


def cases_to_disturb(plan: Plan, cases: Sequence[Case]) -> list[Case]:
    """Choose which cases of a large type to stall and damage; none if all are too large."""
    return limit_work(plan, cases[::LARGE_STRIDE], LARGE_WORK)


def limit_work(plan: Plan, cases: Sequence[Case], most: int) -> list[Case]:
    """Return cases in their order; leave out the largest until the work is at most `most`."""
    left = sorted(range(len(cases)), key=lambda number: (len(cases[number].packet), number))
    while sum(work_of(plan, len(cases[number].packet)) for number in left) > most:
        left.pop()
    return [cases[number] for number in sorted(left)]


def packets_to_simulate(
    plan: Plan, packets: Sequence[bytes], taken: Sequence[AbstractSet[Edge]], most: int = MOST_WORK
) -> list[int]:
    """Choose packets to simulate, all of them if that is not too much.

    * `packets`: at least one packet.
    * `taken`: the decisions that each packet takes.
    * `most`: the most work of the chosen packets together. The first packet may be more work.
      Packets with new decisions may bring the work to `MORE_FOR_NEW` times this limit.

    Returns the indices of packets, in their order.
    """
    works = [work_of(plan, len(packet)) for packet in packets]
    if sum(works) <= most:
        return list(range(len(packets)))
    left = set(range(len(packets)))
    found: list[int] = []
    seen: set[Edge] = set()
    spent = 0
    while left:
        # The most new decisions for the work; if nothing is new, the least work.
        best = max(left, key=lambda n: (len(taken[n] - seen) / works[n], -works[n], -n))
        left.remove(best)
        limit = most if taken[best] <= seen else MORE_FOR_NEW * most
        if found and spent + works[best] > limit:
            continue
        found.append(best)
        seen |= taken[best]
        spent += works[best]
    return sorted(found)
