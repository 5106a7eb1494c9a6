"""The content of a report as data, which is written as HTML, Markdown or JSON."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from firm_hdl.verify.report.outcomes import Counts, NotRun, Outcome, count, outcomes_of
from firm_hdl.verify.report.stats import Box, Correlation, box_of, correlate, curve_of, share_within
from firm_hdl.verify.report.verdicts import OracleSum, Remark, oracle_sums, remarks_of
from firm_hdl.verify.results.file import Results
from firm_hdl.verify.results.records import STAGES, Record
from firm_hdl.verify.results.verdict import Failed, NotJudged

__all__ = ["LIMITS", "Curve", "Group", "Summary", "Trend", "summarise"]

LIMITS = (0.01, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60)
"""Times in seconds. The report has the share of tests that took at most each of these times."""

MOST_POINTS = 1000
"""The largest number of points in a chart; statistics use all points."""

_TOP = 15
"""The number of slowest tests, and of most complex types, that are listed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Tests that have something in common.

    Attributes
    ----------
    labels : tuple of str
        What the tests have in common, such as the suite and the distribution.
    counts : Counts
    cpu_seconds : float
    """

    labels: tuple[str, ...]
    counts: Counts
    cpu_seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """Times of the tests of a suite.

    Attributes
    ----------
    suite : str
    points : tuple of (float, float)
        Times in seconds, and the share of tests that took at most this time.
    within : mapping of float to float
        The same share for each of `LIMITS`.
    seconds, cpu_seconds : Box or None
        Wall-clock time, and processor time.
    stages : mapping of str to Box
        Times of each stage that took time.
    stage_values : mapping of str to tuple of float
        Times of each stage, at most `MOST_POINTS` of them.
    """

    suite: str
    points: tuple[tuple[float, float], ...]
    within: Mapping[float, float]
    seconds: Box | None
    cpu_seconds: Box | None
    stages: Mapping[str, Box]
    stage_values: Mapping[str, tuple[float, ...]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Trend:
    """The correlation of a figure of types with a time of their tests.

    Attributes
    ----------
    suite, metric, time : str
        `time` is the name of a stage, or ``total``.
    correlation : Correlation
    points : tuple of (float, float)
        Pairs of figure and seconds, at most `MOST_POINTS` of them; only if `time` is ``total``.
    """

    suite: str
    metric: str
    time: str
    correlation: Correlation
    points: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CoverageSum:
    """Plan coverage of a suite.

    Attributes
    ----------
    suite : str
    types, full : int
        The number of tests with plan coverage, and the number of those with every decision taken.
    taken, possible : int
        Decisions of all of these tests.
    """

    suite: str
    types: int
    full: int
    taken: int
    possible: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RunSummary:
    """A file of results.

    Attributes
    ----------
    name : str
    options : mapping of str to object
    sessions : tuple of mapping of str to str
    planned, recorded : int
    failure : str or None
        Why the run failed; empty if it did not, `None` if it has not ended.
    """

    name: str
    options: Mapping[str, Any]
    sessions: tuple[Mapping[str, str], ...]
    planned: int
    recorded: int
    failure: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """The content of a report.

    Attributes
    ----------
    title : str
    counts : Counts
    by_suite, by_distro, by_package : tuple of Group
        A test counts once in `by_suite`, and once for each of its distributions in the others.
    outcomes : tuple of Outcome
    circuits : mapping of str to (int, int)
        By suite: different circuits, and tests that rely on the circuit of another type.
    writers : mapping of str to (mapping of str to int)
        By suite: libraries that wrote packets, and the number of tests for which they did.
    curves : tuple of Curve
    trends : tuple of Trend
    coverage : tuple of CoverageSum
    oracles : tuple of OracleSum
        The verdicts of the oracles of definitions.
    said : tuple of Remark
        Known differences from these oracles, and reasons why they did not judge.
    runs : tuple of RunSummary
    """

    title: str
    counts: Counts
    by_suite: tuple[Group, ...]
    by_distro: tuple[Group, ...]
    by_package: tuple[Group, ...]
    outcomes: tuple[Outcome, ...]
    circuits: Mapping[str, tuple[int, int]]
    writers: Mapping[str, Mapping[str, int]]
    curves: tuple[Curve, ...]
    trends: tuple[Trend, ...]
    coverage: tuple[CoverageSum, ...]
    oracles: tuple[OracleSum, ...]
    said: tuple[Remark, ...]
    runs: tuple[RunSummary, ...]

    @property
    def failures(self) -> list[str]:
        """Why runs failed, if they did."""
        return [run.failure for run in self.runs if run.failure]

    @property
    def verdict(self) -> str:
        """The worst outcome of the tests and of the runs."""
        if self.failures or self.counts.failed:
            return Failed.name
        return self.counts.verdict if self.has_ended else NotRun.name

    @property
    def has_ended(self) -> bool:
        """Whether all runs have ended, and not only their tests."""
        return all(run.failure is not None for run in self.runs)

    @property
    def failed(self) -> list[Outcome]:
        """Tests that failed."""
        return [each for each in self.outcomes if isinstance(each.verdict, Failed)]

    @property
    def not_run(self) -> list[Outcome]:
        """Tests without a result."""
        return [each for each in self.outcomes if isinstance(each.verdict, NotRun)]

    @property
    def not_judged(self) -> list[Outcome]:
        """Tests that no oracle could judge."""
        return [each for each in self.outcomes if isinstance(each.verdict, NotJudged)]

    @property
    def noted(self) -> list[Outcome]:
        """Tests with a note, except those of definitions: their known differences are in `said`."""
        records = ((each, each.record) for each in self.outcomes)
        return [each for each, r in records if r is not None and r.note and not r.verdicts]

    @property
    def slowest(self) -> list[Outcome]:
        """The slowest tests, the slowest first."""
        return self._top(lambda record: record.seconds.total)

    @property
    def most_complex(self) -> list[Outcome]:
        """One test of each of the types with most leaves; ties are decided by steps and time."""

        def by(record: Record) -> tuple[float, float, float]:
            figures = record.metrics
            return figures.get("leaves", 0), figures.get("steps", 0), record.seconds.total

        return self._top(lambda record: by(record) if record.metrics.get("leaves") else 0, True)

    @property
    def uncovered(self) -> list[Outcome]:
        """Tests that did not take every decision of their plan."""
        return [
            each
            for each in self.outcomes
            if each.record is not None
            and (coverage := each.record.coverage) is not None
            and coverage.taken < coverage.possible
        ]

    def _top(self, by: Callable[[Record], Any], of_types: bool = False) -> list[Outcome]:
        known = [(by(each.record), each) for each in self.outcomes if each.record is not None]
        known = [pair for pair in known if pair[0]]
        known.sort(key=lambda pair: pair[0], reverse=True)
        first: dict[object, Outcome] = {}
        for _, each in known:
            if len(first) == _TOP:
                break
            first.setdefault(each.test.type if of_types else each.test.key, each)
        return list(first.values())


def summarise(files: Mapping[str, Results], title: str = "Verification of firm-hdl") -> Summary:
    """Summarise files of results, by name."""
    outcomes = outcomes_of(list(files.values()))
    suites: dict[str, list[Outcome]] = defaultdict(list)
    for outcome in outcomes:
        suites[_suite(outcome)].append(outcome)
    return Summary(
        title=title,
        counts=count(outcomes),
        by_suite=_groups((outcome, (_suite(outcome),)) for outcome in outcomes),
        by_distro=_groups(
            (outcome, (_suite(outcome), distro))
            for outcome in outcomes
            for distro in outcome.test.distros
        ),
        by_package=_groups(
            (outcome, (_suite(outcome), distro, outcome.test.package))
            for outcome in outcomes
            for distro in outcome.test.distros
        ),
        outcomes=tuple(outcomes),
        circuits={
            suite: known for suite, own in suites.items() if (known := _circuits(own)) != (0, 0)
        },
        writers={suite: names for suite, own in suites.items() if (names := _writers(own))},
        curves=tuple(_curve(suite, own) for suite, own in suites.items() if _ran(own)),
        trends=tuple(trend for suite, own in suites.items() for trend in _trends(suite, own)),
        coverage=tuple(
            found for suite, own in suites.items() if (found := _coverage(suite, own)).types
        ),
        oracles=oracle_sums(outcomes),
        said=remarks_of(outcomes),
        runs=tuple(_run(name, results) for name, results in files.items()),
    )


def _suite(outcome: Outcome) -> str:
    test = outcome.test
    bus = f"{test.bus_bytes}-byte bus" if test.bus_bytes else ""
    return ", ".join(part for part in (test.system, test.simulator, bus) if part)


def _groups(labelled: Iterable[tuple[Outcome, tuple[str, ...]]]) -> tuple[Group, ...]:
    found: dict[tuple[str, ...], list[Outcome]] = defaultdict(list)
    for outcome, labels in labelled:
        found[labels].append(outcome)
    return tuple(
        Group(
            labels=labels,
            counts=count(own),
            cpu_seconds=sum(o.record.cpu_seconds for o in own if o.record is not None),
        )
        for labels, own in sorted(found.items())
    )


def _ran(outcomes: Iterable[Outcome]) -> list[Record]:
    """Return records of tests that took time."""
    ran = [o for o in outcomes if not isinstance(o.verdict, NotJudged)]
    records = [outcome.record for outcome in ran if outcome.record is not None]
    return [record for record in records if record.seconds.total > 0]


def _circuits(outcomes: Iterable[Outcome]) -> tuple[int, int]:
    records = [outcome.record for outcome in outcomes if outcome.record is not None]
    shapes = {record.shape for record in records if record.shape}
    return len(shapes), sum(bool(record.same_as) for record in records)


def _writers(outcomes: Iterable[Outcome]) -> dict[str, int]:
    records = [outcome.record for outcome in outcomes if outcome.record is not None]
    return dict(Counter(name for record in records for name in record.written_by))


def _curve(suite: str, outcomes: Sequence[Outcome]) -> Curve:
    records = _ran(outcomes)
    totals = [record.seconds.total for record in records]
    stages = {
        stage: tuple(seconds)
        for stage in STAGES
        if (seconds := [s for r in records if (s := getattr(r.seconds, stage)) > 0])
    }
    boxes = {stage: box_of(values) for stage, values in stages.items()}
    return Curve(
        suite=suite,
        points=tuple(curve_of(totals)),
        within={limit: share_within(totals, limit) for limit in LIMITS},
        seconds=box_of(totals),
        cpu_seconds=box_of([record.cpu_seconds for record in records if record.cpu_seconds]),
        stages={stage: box for stage, box in boxes.items() if box is not None},
        stage_values={
            stage: points[:: -(-len(points) // MOST_POINTS)] for stage, points in stages.items()
        },
    )


def _trends(suite: str, outcomes: Sequence[Outcome]) -> Iterable[Trend]:
    # Tests that rely on another test's circuit take hardly any time.
    records = [record for record in _ran(outcomes) if not record.same_as]
    times = {
        time: np.array([getattr(record.seconds, time) for record in records], dtype=float)
        for time in ("total", *STAGES)
    }
    for metric in sorted({name for record in records for name in record.metrics}):
        figures = [record.metrics.get(metric, np.nan) for record in records]
        x = np.array(figures, dtype=float)
        for time, seconds in times.items():
            chosen = ~np.isnan(x) & (seconds > 0)
            xs, ys = x[chosen], seconds[chosen]
            found = correlate(xs, ys)
            if found is None:
                continue
            points: tuple[tuple[float, float], ...] = ()
            if time == "total":
                step = -(-len(xs) // MOST_POINTS)
                points = tuple(zip(xs[::step].tolist(), ys[::step].tolist(), strict=True))
            yield Trend(suite=suite, metric=metric, time=time, correlation=found, points=points)


def _coverage(suite: str, outcomes: Iterable[Outcome]) -> CoverageSum:
    found = [o.record.coverage for o in outcomes if o.record is not None and o.record.coverage]
    return CoverageSum(
        suite=suite,
        types=len(found),
        full=sum(each.taken == each.possible for each in found),
        taken=sum(each.taken for each in found),
        possible=sum(each.possible for each in found),
    )


def _run(name: str, results: Results) -> RunSummary:
    return RunSummary(
        name=name,
        options=results.options,
        sessions=results.sessions,
        planned=len(results.planned),
        recorded=len(results.records),
        failure=results.failure,
    )
