"""What the golden model and the circuits of a type make of packets, against what is right."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from itertools import chain

from firm_hdl.plan import Edge, Plan
from firm_hdl.plan.edges import edges
from firm_hdl.plan.interpret import decode, encode
from firm_hdl.sim.record import RunResult
from firm_hdl.verify.cases.make import Case
from firm_hdl.verify.results.records import PlanCoverage
from firm_hdl.verify.ts3.compare import (
    Expected,
    packet_differences,
    run_differences,
    transfer_differences,
)
from firm_hdl.verify.ts3.result import Result

__all__ = ["Checks"]


class Checks:
    """The checks of one plan.

    Parameters
    ----------
    plan : Plan
    result : Result
        Takes failures, and what was judged.
    """

    def __init__(self, plan: Plan, result: Result):
        self._plan, self._result = plan, result
        self._leaves = {leaf.path: number for number, leaf in enumerate(plan.leaves)}

    def golden(
        self, cases: Sequence[Case], bare: Sequence[tuple[Case, bytes]]
    ) -> list[AbstractSet[Edge]]:
        """Check the golden model against the oracle; return the decisions of each packet."""
        failures, plan = self._result.failures, self._plan
        taken: list[AbstractSet[Edge]] = []
        for case, packet in chain(((case, case.sent) for case in cases), bare):
            where = f"golden model, {case.what}"
            decoded = decode(plan, packet)
            taken.append(decoded.edges)
            if decoded.status != case.status:
                failures.append(f"{where}: status {decoded.status}")
            failures += transfer_differences(where, plan, decoded.streams, [case.transfers])
        for case in cases:
            where = f"golden model, {case.what}"
            streams = {self._leaves[path]: list(items) for path, items in case.transfers.items()}
            try:
                packet, status = encode(plan, streams)
            except ValueError as error:
                failures.append(f"{where}: {error}")
                continue
            failures += packet_differences(where, [packet], [case.packet])
            if status != "OK":
                failures.append(f"{where}: status {status} when encoding")
        self.cover(taken)
        return taken

    def cover(self, taken: Iterable[AbstractSet[Edge]]) -> None:
        """Note which decisions of the plan some packets take."""
        possible = edges(self._plan)
        missing = sorted(possible.difference(*taken))
        self._result.coverage = PlanCoverage(
            taken=len(possible) - len(missing),
            possible=len(possible),
            missing=tuple(f"step {edge.step}: {edge.way}" for edge in missing),
        )

    def good(self, where: str, seen: RunResult, cases: Sequence[Case]) -> None:
        """Check what the circuits made of cases against the oracle."""
        wanted = Expected(
            packets=[case.packet for case in cases],
            transfers=[case.transfers for case in cases],
            statuses=[case.status for case in cases],
            sent_statuses=["OK"] * len(cases),
        )
        names = [case.what for case in cases]
        self._result.failures += run_differences(where, self._plan, seen, wanted, names)
        self._result.judged += len(seen.packets)

    def broken(self, where: str, seen: RunResult, packets: Sequence[bytes]) -> None:
        """Check what the circuits made of packets that are wrong against the golden model."""
        golden = [decode(self._plan, packet) for packet in packets]
        sent = [encode(self._plan, decoded.streams) for decoded in golden]
        wanted = Expected(
            packets=[packet for packet, _ in sent],
            transfers=[
                {self._plan.leaves[leaf].path: got for leaf, got in decoded.streams.items()}
                for decoded in golden
            ],
            statuses=[decoded.status for decoded in golden],
            sent_statuses=[status for _, status in sent],
        )
        names = [packet.hex() for packet in packets]
        self._result.failures += run_differences(where, self._plan, seen, wanted, names)
