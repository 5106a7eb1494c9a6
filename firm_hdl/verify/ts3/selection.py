"""Which cases of a type there are, and which of them are simulated, stalled and damaged."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet

from firm_hdl.plan import Edge, Plan
from firm_hdl.verify.cases.directed import more_cases
from firm_hdl.verify.cases.effort import (
    LARGE_STRIDE,
    LARGE_WORK,
    MOST_CASE_BYTES,
    chosen,
    some_cases,
    within,
    work_of,
)
from firm_hdl.verify.cases.make import Case, make_cases
from firm_hdl.verify.references.oracle import RosbagsOracle
from firm_hdl.verify.systems.options import Options

__all__ = ["affordable", "all_cases", "disturbed", "is_large"]


def all_cases(oracle: RosbagsOracle, name: str, plan: Plan, options: Options) -> list[Case]:
    """Make the cases, and those that the plan's other decisions need if there is no limit."""
    made = make_cases(
        oracle,
        name,
        wire=plan.wire,
        bus_bytes=plan.bus_bytes,
        seed=options.seed,
        most=options.most_cases,
    )
    cases = list(some_cases(made))
    if options.most_cases is None and _size(cases) < MOST_CASE_BYTES:
        cases += more_cases(oracle, name, plan, cases, seed=options.seed)
    return cases


def is_large(plan: Plan, cases: Sequence[Case]) -> bool:
    """Whether a type takes long to simulate; it is stalled and damaged less often."""
    return work_of(plan, _size(cases)) > LARGE_WORK


def disturbed(plan: Plan, cases: Sequence[Case]) -> list[Case]:
    """Choose what to stall and damage of a large type's cases; nothing if all are too large."""
    return within(plan, cases[::LARGE_STRIDE], LARGE_WORK)


def affordable(
    plan: Plan,
    cases: Sequence[Case],
    bare: Sequence[tuple[Case, bytes]],
    taken: Sequence[AbstractSet[Edge]],
) -> list[int]:
    """Choose what to simulate; return the numbers of cases, and of `bare` packets behind them.

    Parameters
    ----------
    taken : sequence of set of Edge
        Decisions of cases, then of bare packets.
    """
    packets = [*(case.sent for case in cases), *(packet for _, packet in bare)]
    return chosen(plan, packets, taken)


def _size(cases: Sequence[Case]) -> int:
    """Return the size of packets together, in bytes."""
    return sum(len(case.packet) for case in cases)
