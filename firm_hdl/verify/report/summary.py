"""The content of a report as data, which is written as HTML, Markdown or JSON.

The input is the outcome of every planned test. A test counts as passed only if a record says so. A
test without a record was not run. A test that relies on the circuit of another type passes only if
the test of that type has passed, too.

Functions are fitted by least squares: a line to the figures themselves, and a power law as a line
to their logarithms. R² is computed in the space of the fit: of the figures or of the logarithms.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from firm_hdl.verify.results.file import Results
from firm_hdl.verify.results.oracles import (
    OracleSum,
    Remark,
    oracle_sums,
    remarks_of,
    without_names,
)
from firm_hdl.verify.results.records import STAGES, Record, Test, settled
from firm_hdl.verify.results.verdict import (
    Counts,
    Failed,
    NotJudged,
    NotRun,
    Verdict,
)

__all__ = [
    "LIMITS",
    "Box",
    "Correlation",
    "Curve",
    "Fit",
    "Group",
    "Outcome",
    "Summary",
    "Trend",
    "box_of",
    "correlate",
    "curve_of",
    "failures_of",
    "outcomes_of",
    "reason_groups",
    "share_within",
    "summarise",
]


LEAST_POINTS = 5
"""The smallest number of points that a function is fitted to."""

LEAST_VALUES = 3
MOST_CURVE_POINTS = 240


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """The distribution of values."""

    count: int
    # Quartiles and the 95th percentile between the smallest value and the largest.
    least: float
    q1: float
    median: float
    q3: float
    p95: float
    most: float
    total: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """A fitted function: ``a + b x`` for a line, ``a x^b`` for a power law."""

    a: float
    b: float
    r2: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Correlation:
    """The correlation of a figure with a time."""

    count: int  # The number of pairs.
    # The correlation of the values, and that of their ranks.
    pearson: float
    spearman: float
    # `None` if there are too few points. Only pairs above zero count for the power law.
    linear: Fit | None
    power: Fit | None


def box_of(values: Sequence[float]) -> Box | None:
    """Return the distribution of values; `None` if there are no values."""
    if not values:
        return None
    at = np.quantile(np.asarray(values, dtype=float), (0, 0.25, 0.5, 0.75, 0.95, 1))
    names = ("least", "q1", "median", "q3", "p95", "most")
    quantiles = dict(zip(names, at.tolist(), strict=True))
    return Box(count=len(values), total=float(sum(values)), **quantiles)


def curve_of(values: Sequence[float]) -> list[tuple[float, float]]:
    """Return points of the cumulative distribution of values; the last one is at 1."""
    ordered = sorted(values)
    count = len(ordered)
    if not count:
        return []
    step = max(1, count // MOST_CURVE_POINTS)
    ranks = [*range(step, count, step), count]
    return [(ordered[rank - 1], rank / count) for rank in ranks]


def share_within(values: Sequence[float], limit: float) -> float:
    """Return the share of values that are at most `limit`."""
    return sum(value <= limit for value in values) / len(values) if values else 0.0


def correlate(
    x: Sequence[float] | np.ndarray, y: Sequence[float] | np.ndarray
) -> Correlation | None:
    """Return the correlation of two figures.

    It is `None` if one of the figures does not vary.
    """
    xs, ys = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(xs) < 2 or np.ptp(xs) == 0 or np.ptp(ys) == 0:
        return None
    above = (xs > 0) & (ys > 0)
    line = _line(xs, ys)
    law = _line(np.log(xs[above]), np.log(ys[above]))
    return Correlation(
        count=len(xs),
        pearson=float(np.corrcoef(xs, ys)[0, 1]),
        spearman=float(np.corrcoef(_ranks(xs), _ranks(ys))[0, 1]),
        linear=line,
        power=None if law is None else Fit(a=float(np.exp(law.a)), b=law.b, r2=law.r2),
    )


def _line(xs: np.ndarray, ys: np.ndarray) -> Fit | None:
    if len(xs) < LEAST_POINTS or len(np.unique(xs)) < LEAST_VALUES or np.ptp(ys) == 0:
        return None
    x, y = xs - xs.mean(), ys - ys.mean()
    # `@` would start threads, which cost more time than they save with so few values.
    b = float((x * y).sum() / (x * x).sum())
    left = y - b * x
    r2 = float(1 - (left * left).sum() / (y * y).sum())
    return Fit(a=float(ys.mean() - b * xs.mean()), b=b, r2=r2)


def _ranks(values: np.ndarray) -> np.ndarray:
    """Return ranks. Equal values get the mean of their ranks."""
    _, which, counts = np.unique(values, return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    return np.asarray(((ends - counts + ends + 1) / 2)[which])


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """The outcome of a test."""

    test: Test
    verdict: Verdict | NotRun
    record: Record | None
    # Name of the type whose equal circuit was simulated instead of the circuit of this type.
    circuit_of: str = ""


def failures_of(outcome: Outcome) -> tuple[str, ...]:
    """Return the failures of a test; none if it did not fail."""
    return outcome.verdict.failures if isinstance(outcome.verdict, Failed) else ()


def outcomes_of(files: Sequence[Results]) -> list[Outcome]:
    """Return the outcome of every test of some files, sorted by key.

    A test that is in several files counts as failed if it failed in one of them.
    """
    tests: dict[str, Test] = {}
    records: dict[str, Record] = {}
    for file in files:
        tests.update((test.key, test) for test in file.planned)
        for key, record in file.records.items():
            tests.setdefault(key, record.test)
            if key not in records or not isinstance(records[key].verdict, Failed):
                records[key] = record
    return [_outcome(tests[key], records.get(key), records) for key in sorted(tests)]


def _outcome(test: Test, record: Record | None, records: Mapping[str, Record]) -> Outcome:
    if record is None:
        return Outcome(test=test, verdict=NotRun(), record=None)
    verdict = settled(record, records)
    other = records.get(record.same_as)
    circuit_of = record.same_as if other is None else other.test.type
    return Outcome(test=test, verdict=verdict, record=record, circuit_of=circuit_of)


LIMITS = (0.01, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60)
"""Times in seconds. The report has the share of tests that took at most each of these times."""

MOST_POINTS = 1000
"""The largest number of points in a chart; statistics use all points."""

_TOP = 15
"""The number of slowest tests, and of most complex types, that are listed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Tests that have something in common."""

    # What the tests have in common, such as the suite and the distribution.
    labels: tuple[str, ...]
    counts: Counts
    cpu_seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """Times of the tests of a suite."""

    suite: str
    # Times in seconds, and the share of tests that took at most this time.
    points: tuple[tuple[float, float], ...]
    within: Mapping[float, float]  # The same share for each of `LIMITS`.
    # Wall-clock time, and processor time.
    seconds: Box | None
    cpu_seconds: Box | None
    stages: Mapping[str, Box]  # Times of each stage that took time.
    # Times of each stage, at most `MOST_POINTS` of them.
    stage_values: Mapping[str, tuple[float, ...]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Trend:
    """The correlation of a figure of types with a time of their tests."""

    # `time` is the name of a stage, or `total`.
    suite: str
    metric: str
    time: str
    correlation: Correlation
    # Pairs of figure and seconds, at most `MOST_POINTS` of them; only if `time` is `total`.
    points: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CoverageSum:
    """Plan coverage of a suite."""

    suite: str
    # The number of tests with plan coverage, and the number of those with every decision taken.
    types: int
    full: int
    # Decisions of all of these tests.
    taken: int
    possible: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RunSummary:
    """A file of results."""

    name: str
    options: Mapping[str, Any]
    sessions: tuple[Mapping[str, str], ...]
    planned: int
    recorded: int
    failure: str | None  # Why the run failed; empty if it did not, `None` if it has not ended.


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """The content of a report."""

    title: str
    counts: Counts
    # A test counts once in `by_suite`, and once for each of its distributions in the others.
    by_suite: tuple[Group, ...]
    by_distro: tuple[Group, ...]
    by_package: tuple[Group, ...]
    outcomes: tuple[Outcome, ...]
    # By suite: different circuits, and tests that rely on the circuit of another type.
    circuits: Mapping[str, tuple[int, int]]
    # By suite: libraries that wrote packets, and the number of tests for which they did.
    writers: Mapping[str, Mapping[str, int]]
    curves: tuple[Curve, ...]
    trends: tuple[Trend, ...]
    coverage: tuple[CoverageSum, ...]
    oracles: tuple[OracleSum, ...]  # The verdicts of the oracles of definitions.
    # Known differences from these oracles, and reasons why they did not judge.
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
    records = [each.record for each in outcomes if each.record is not None]
    return Summary(
        title=title,
        counts=Counts.of(each.verdict for each in outcomes),
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
        oracles=oracle_sums(records),
        said=remarks_of(records),
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
            counts=Counts.of(each.verdict for each in own),
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Reason:
    """Tests with the same text, apart from names and numbers."""

    text: str  # The text of the first of these tests.
    outcomes: tuple[Outcome, ...]


def reason_groups(
    outcomes: Iterable[Outcome], text_of: Callable[[Outcome], str] | None = None
) -> list[Reason]:
    """Group tests that were not judged for the same reason, the largest group first.

    * `text_of`: returns the text to group a test by; `None`: why a test was not judged or not run.
    """
    groups: dict[str, list[Outcome]] = defaultdict(list)
    texts: dict[str, str] = {}
    for outcome in outcomes:
        text = (text_of or _reason_of)(outcome)
        key = without_names(text)
        texts.setdefault(key, text)
        groups[key].append(outcome)
    found = [Reason(text=texts[key], outcomes=tuple(own)) for key, own in groups.items()]
    return sorted(found, key=lambda reason: -len(reason.outcomes))


def _reason_of(outcome: Outcome) -> str:
    """Return why a test was not judged or not run; empty if it was judged."""
    return outcome.verdict.reason if isinstance(outcome.verdict, NotJudged | NotRun) else ""
