"""Exported text against the Python simulation, cycle by cycle.

All runs of a type's converters in Python are recorded. A simulator of exported text replays them in
one go, with a reset between two runs. The first output that differs, of any port in any cycle, is
reported. The packets, transfers of leaves and statuses are also reconstructed from the rows of the
other simulator, and compared with those of the Python simulation. So an empty recording does not
pass as "no difference".
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from firm_hdl.cases import NotJudgedError
from firm_hdl.export.build import BuildError, check_size
from firm_hdl.export.top import Top
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.jobs.processes import ToolError
from firm_hdl.plan import Plan
from firm_hdl.sim.record import RunResult
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed, Verdict
from firm_hdl.verify.simulators import TextSimulator
from firm_hdl.verify.simulators.semantics import traffic
from firm_hdl.verify.simulators.trace import Trace, read_row

__all__ = ["Comparison", "Crosscheck", "check_exportable", "first_difference"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """The result of a replay.

    Attributes
    ----------
    failures : tuple of str
        Texts about the differences.
    cycles, packets, transfers, statuses : int
        Counted in what the other simulator showed: cycles compared, packets that came out,
        transfers of leaves, and statuses of both converters.
    seconds : float
        The duration of the replay.
    """

    failures: tuple[str, ...]
    cycles: int = 0
    packets: int = 0
    transfers: int = 0
    statuses: int = 0
    seconds: float = 0.0

    @property
    def verdict(self) -> Verdict:
        """The verdict; its cases are cycles that were compared."""
        if self.failures:
            return Failed(self.failures)
        return Passed(self.cycles) if self.cycles else NotJudged("no cycle was compared")


@dataclass(slots=True)
class Crosscheck:
    """The recorded runs of one type, and their replay.

    Parameters
    ----------
    simulator : TextSimulator
    cores : sequence
        Converters that are simulated in Python, the deserializer first.
    make : callable
        Returns new instances of the same converters, to be exported.
    message : str
        Name of the type.
    """

    simulator: TextSimulator
    cores: Sequence[Deserializer | Serializer]
    make: Callable[[], Sequence[Deserializer | Serializer]]
    message: str
    trace: Trace = field(init=False)
    seen: list[RunResult | None] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        self.trace = Trace(self.cores, self.message)

    def start(self, name: str) -> Callable[[list[int]], None]:
        """Begin a run; return the function that observes each of its cycles."""
        self.trace.start(name)
        self.seen.append(None)
        return self.trace.observe

    def done(self, seen: RunResult) -> None:
        """Keep the result of the last run, which is complete."""
        self.seen[-1] = seen

    def compare(self) -> Comparison:
        """Replay all runs, and compare."""
        began = time.perf_counter()
        title = self.simulator.title

        def tops() -> list[Top]:
            return [Top(core) for core in self.make()]

        try:
            with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
                rows = self.simulator.replay(self.trace, tops, Path(folder))
        except ToolError as error:
            return Comparison(failures=(f"{title}: {error}",))
        rows = [row.rstrip() for row in rows]
        failures = []
        if difference := first_difference(self.trace, rows):
            failures.append(f"{title}: {difference}")
        found = traffic(self.trace, rows)
        for run, seen in zip(found, self.seen, strict=True):
            if seen is not None and (difference := run.difference(seen)):
                failures.append(f"{title}, {run.name}: {difference}")
        return Comparison(
            failures=tuple(failures),
            cycles=len(rows),
            packets=sum(len(run.packets) for run in found),
            transfers=sum(len(bits) for run in found for bits in run.transfers.values()),
            statuses=sum(len(run.statuses) + len(run.sent_statuses) for run in found),
            seconds=time.perf_counter() - began,
        )


def check_exportable(plan: Plan) -> None:
    """Raise `NotJudgedError` if converters with that plan are too large to be exported."""
    try:
        check_size(plan)
    except BuildError as error:
        raise NotJudgedError(f"it cannot be exported: {error}") from None


def first_difference(trace: Trace, rows: Sequence[str]) -> str | None:
    """Describe the first output that is not as recorded; `None` if all are."""
    if trace.expected == rows:
        return None
    ports = {pin.number: pin for pin in trace.outputs}
    right: dict[int, str] = {}
    shown: dict[int, str] = {}
    for index, (row, other) in enumerate(zip(trace.expected, rows, strict=False)):
        if row == other:
            changes = dict(read_row(row))
            right.update(changes)
            shown.update(changes)
            continue
        right.update(read_row(row))
        shown.update(read_row(other))
        for number, bits in right.items():
            if shown.get(number) != bits:
                pin = ports[number]
                run, cycle = trace.run_of(index)
                return (
                    f"{run}, cycle {cycle}: {pin.port.name} of the "
                    f"{trace.devices[pin.device].direction} is {_short(shown.get(number, 'U'))} "
                    f"instead of {_short(bits)}"
                )
    if len(rows) != len(trace.expected):
        return f"{len(rows)} cycles instead of {len(trace.expected)}"
    # The values are equal. One of the rows has a port that did not change.
    return None


def _short(bits: str) -> str:
    return hex(int(bits, 2)) if len(bits) > 4 and not set(bits) - {"0", "1"} else f"'{bits}'"
