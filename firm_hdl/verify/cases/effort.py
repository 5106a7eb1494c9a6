"""Which cases of a type there are, and which of them are simulated, stalled and damaged.

The Python simulator takes time for every leaf in every cycle. So a type of a thousand leaves takes
minutes if all of its cases run, and an array of 8 MiB takes an hour. Of such types, those cases are
chosen that take the most decisions of the plan for their size. The golden model still sees all
cases. The result says what was left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet

from firm_hdl.plan import Edge, Plan
from firm_hdl.verify.cases.directed import more_cases
from firm_hdl.verify.cases.make import Case, make_cases
from firm_hdl.verify.references.oracle import RosbagsOracle

__all__ = [
    "LARGE_STRIDE",
    "MAX_MESSAGE_BYTES",
    "MOST_WORK",
    "all_cases",
    "chosen",
    "disturbed",
    "is_large",
    "message_limit",
    "too_large",
    "work_of",
]

MAX_MESSAGE_BYTES = 1 << 16
"""Small enough that a packet with a length over this limit can be completed in simulation."""

LARGE_WORK = 300_000
"""The work of all cases of a large type, which is stalled and damaged less often."""

LARGE_STRIDE = 4
"""Of the cases of a large type, one in so many is stalled and damaged."""

MOST_WORK = 1_000_000
"""The most work of all cases of a type that are simulated."""

MORE_FOR_NEW = 4
"""The factor for `MOST_WORK` for packets that take a decision which no other packet takes."""

MOST_WORK_OF_ONE = 1_500_000
"""The most work of the smallest message of a type; no larger type is simulated."""

MOST_CASE_BYTES = 1 << 18
"""No more cases are made when all packets together have so many bytes."""

# A circuit of few leaves has other work to do in a cycle.
LEAST_LEAVES = 8


def message_limit(min_bytes: int) -> int:
    """Return the largest message that converters are tested with.

    Parameters
    ----------
    min_bytes : int
        Of the type's smallest message.
    """
    return MAX_MESSAGE_BYTES + (min_bytes if min_bytes > MAX_MESSAGE_BYTES // 2 else 0)


def work_of(plan: Plan, packet_bytes: int) -> int:
    """Return beats times leaves. The time of a simulation is roughly proportional to it."""
    return -(-packet_bytes // plan.bus_bytes) * max(len(plan.leaves), LEAST_LEAVES)


def too_large(plan: Plan, min_bytes: int) -> str:
    """Say why a type is too large to simulate, if it is."""
    if work_of(plan, min_bytes) <= MOST_WORK_OF_ONE:
        return ""
    return (
        f"too large to simulate: its smallest message has {min_bytes} bytes, "
        f"and its circuits {len(plan.leaves)} streams"
    )


def all_cases(
    oracle: RosbagsOracle, name: str, plan: Plan, *, seed: int = 0, most: int | None = None
) -> list[Case]:
    """Make at most `most` cases; without a limit, also those that the plan's other decisions need.

    Parameters are those of `make_cases`.
    """
    bus_bytes = plan.bus_bytes
    made = make_cases(oracle, name, wire=plan.wire, bus_bytes=bus_bytes, seed=seed, most=most)
    cases = list(_some(made))
    if most is None and _size(cases) < MOST_CASE_BYTES:
        cases += more_cases(oracle, name, plan, cases, seed=seed)
    return cases


def _size(cases: Iterable[Case]) -> int:
    """Return the size of packets together, in bytes."""
    return sum(len(case.packet) for case in cases)


def _some(cases: Iterable[Case]) -> Iterator[Case]:
    """Yield cases until they are large together; the first in any case."""
    size = 0
    for case in cases:
        yield case
        size += len(case.packet)
        if size >= MOST_CASE_BYTES:
            return


def is_large(plan: Plan, cases: Sequence[Case]) -> bool:
    """Whether a type takes long to simulate; it is stalled and damaged less often."""
    return work_of(plan, _size(cases)) > LARGE_WORK


def disturbed(plan: Plan, cases: Sequence[Case]) -> list[Case]:
    """Choose what to stall and damage of a large type's cases; nothing if all are too large."""
    return within(plan, cases[::LARGE_STRIDE], LARGE_WORK)


def within(plan: Plan, cases: Sequence[Case], most: int) -> list[Case]:
    """Return cases in their order, without the largest of them if all would be too much work."""
    left = sorted(range(len(cases)), key=lambda number: (len(cases[number].packet), number))
    while sum(work_of(plan, len(cases[number].packet)) for number in left) > most:
        left.pop()
    return [cases[number] for number in sorted(left)]


def chosen(
    plan: Plan, packets: Sequence[bytes], taken: Sequence[AbstractSet[Edge]], most: int = MOST_WORK
) -> list[int]:
    """Choose packets to simulate, all of them if that is not too much.

    Parameters
    ----------
    plan : Plan
    packets : sequence of bytes
        At least one.
    taken : sequence of set of Edge
        The decisions that each packet takes.
    most : int
        Work that all of them together may be. The first that is chosen may be more, and so may
        those that take decisions which none before takes, up to `MORE_FOR_NEW` times this.

    Returns
    -------
    list of int
        Indices of packets, in their order.
    """
    works = [work_of(plan, len(packet)) for packet in packets]
    if sum(works) <= most:
        return list(range(len(packets)))
    left = set(range(len(packets)))
    found: list[int] = []
    seen: set[Edge] = set()
    spent = 0
    while left:
        # The most that is new for its work; where nothing is, the least work.
        best = max(left, key=lambda n: (len(taken[n] - seen) / works[n], -works[n], -n))
        left.remove(best)
        limit = most if taken[best] <= seen else MORE_FOR_NEW * most
        if found and spent + works[best] > limit:
            continue
        found.append(best)
        seen |= taken[best]
        spent += works[best]
    return sorted(found)
