"""The tables and the sentences of a report, for HTML and Markdown.

A cell of a table has a text and, if it is a number, the value to sort by.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import wraps
from typing import TypeAlias, TypeVar

from firm_hdl.drawing.svg import number, seconds
from firm_hdl.verify.report.charts import law_text, line_text
from firm_hdl.verify.report.summary import (
    LIMITS,
    Curve,
    Fit,
    Group,
    Outcome,
    Summary,
    Trend,
    failures_of,
)
from firm_hdl.verify.results.records import STAGES, Record, Test
from firm_hdl.verify.results.verdict import (
    Counts,
    Failed,
    KnownDifference,
    NotJudged,
    NotRun,
    Passed,
)

__all__ = [
    "MOST_ROWS",
    "SIGNS",
    "Table",
    "TableCell",
    "caption_of_fit",
    "circuits_table",
    "coverage_table",
    "cut",
    "every_table",
    "facts",
    "failure_table",
    "group_table",
    "headline",
    "missing_table",
    "note_of",
    "oracle_table",
    "remark_table",
    "shown_packages",
    "shown_tests",
    "shown_trends",
    "slowest_suite",
    "sources",
    "stage_table",
    "title_of",
    "trend_table",
    "trends_by_suite",
    "within_table",
    "writer_table",
]

T = TypeVar("T")

MOST_ROWS = 1000
"""The largest number of rows of a table on a page; JSON has all tests and packages."""

MOST_TEXT = 300

SIGNS = {
    Passed.name: "✓ passed",
    KnownDifference.name: "~ known difference",
    Failed.name: "✗ failed",
    NotJudged.name: "- not judged",
    NotRun.name: "? not run",
}
"""The text of each verdict; a verdict is never shown by colour alone."""


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell."""

    text: str
    value: float | None = None  # The value to sort by, if it is a number.
    verdict: str = ""  # The verdict that gives the cell its colour; empty: the colour of text.
    counts: Counts | None = None  # Counts that are drawn as a bar in HTML.


Row: TypeAlias = "Iterable[TableCell | str | float]"
"""Cells of a row. A plain text or number becomes a cell of its own."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table; the headings of numbers end in ``#``."""

    headings: tuple[str, ...]
    rows: tuple[tuple[TableCell, ...], ...]


def _of(headings: str, rows: Iterable[Row]) -> Table:
    """Make a table, without columns that are empty."""
    names, made = headings.split("|"), [tuple(map(_cell, row)) for row in rows]
    kept = [
        column
        for column in range(len(names))
        if not made or any(row[column].text or row[column].counts for row in made)
    ]
    return Table(
        tuple(names[column] for column in kept),
        tuple(tuple(row[column] for column in kept) for row in made),
    )


def _cell(value: TableCell | str | float) -> TableCell:
    if isinstance(value, TableCell):
        return value
    return TableCell(value) if isinstance(value, str) else TableCell(number(value), value)


def _with(headings: str) -> Callable[[Callable[[T], Iterator[Row]]], Callable[[T], Table]]:
    """Decorate a function that yields rows, so that it returns a table with the headings."""

    def decorate(rows: Callable[[T], Iterator[Row]]) -> Callable[[T], Table]:
        @wraps(rows)
        def table(given: T) -> Table:
            return _of(headings, rows(given))

        return table

    return decorate


def _time(value: float) -> TableCell:
    return TableCell(seconds(value) if value else "-", value)


def _result(verdict: str) -> TableCell:
    return TableCell(SIGNS[verdict], verdict=verdict)


def cut(table: Table, most: int = MOST_ROWS) -> tuple[Table, str]:
    """Return the first rows of a table, and a text about the rest; the text may be empty."""
    left = len(table.rows) - most
    if left <= 0:
        return table, ""
    return Table(table.headings, table.rows[:most]), f"and {number(left)} more"


def title_of(test: Test) -> str:
    """Name a test in a line, with all that tells it from others of a report."""
    return ", ".join(filter(None, [test.title, test.simulator, test.wire, test.options]))


def group_table(groups: Iterable[Group], names: str) -> Table:
    """List groups of tests with their counts."""
    columns = "Passed#|Known difference#|Failed#|Not judged#|Not run#|CPU time#"
    return _of(f"{names}|Result|Share|{columns}", map(_group_row, groups))


def _group_row(group: Group) -> Row:
    counts = group.counts
    share = (counts.passed + counts.known) / max(1, counts.total)
    return (
        *group.labels,
        _result(counts.verdict),
        TableCell("", share, counts=counts),
        *(counts.passed, counts.known, counts.failed, counts.not_judged, counts.not_run),
        _time(group.cpu_seconds),
    )


@_with("Test system|Library|Tests#")
def writer_table(summary: Summary) -> Iterator[Row]:
    """Count tests by the libraries that wrote their packets."""
    for suite, writers in summary.writers.items():
        for name, tests in writers.items():
            yield suite, name, tests


@_with("Test system|Different circuits#|Tested with that of another type#")
def circuits_table(summary: Summary) -> Iterator[Row]:
    """Count different circuits by suite."""
    for suite, (shapes, shared) in summary.circuits.items():
        yield suite, shapes, shared


@_with("Distribution|Oracle|Agree#|Of these, both refuse#|Known difference#|Differ#|Not judged#")
def oracle_table(summary: Summary) -> Iterator[Row]:
    """Count the verdicts of oracles of definitions."""
    for each in summary.oracles:
        verdict = Failed.name if each.differ else ""
        differ = TableCell(number(each.differ), each.differ, verdict=verdict)
        agreed = each.agree, each.refused, each.known
        yield each.distro, each.oracle, *agreed, differ, each.not_judged


@_with("Oracle|Verdict|Key or reason|Definitions#|Such as")
def remark_table(summary: Summary) -> Iterator[Row]:
    """List known differences from oracles, and reasons why oracles did not judge."""
    for each in summary.said:
        yield each.oracle, each.verdict, each.what, each.count, each.example


@_with("Test|Failure|Repeat it")
def failure_table(outcomes: Iterable[Outcome]) -> Iterator[Row]:
    """List failed tests, one in a row."""
    for outcome in outcomes:
        text = failures_of(outcome)[0]
        shown = text if len(text) <= MOST_TEXT else f"{text[:MOST_TEXT]}..."
        yield title_of(outcome.test), shown, outcome.record.command if outcome.record else ""


@_with("|".join(["Test system", "Tests#", *(f"{limit:g} s#" for limit in LIMITS)]))
def within_table(curves: Iterable[Curve]) -> Iterator[Row]:
    """List the shares of tests that were completed within some times."""
    for curve in curves:
        shares = (TableCell(_percent(share), share) for share in curve.within.values())
        yield curve.suite, 0 if curve.seconds is None else curve.seconds.count, *shares


def _percent(share: float) -> str:
    text = f"{share:.1%}"
    # Rounding must not turn a share below 1 into 100 %.
    return "99.9%" if text == "100.0%" and share < 1 else text


@_with("Test system|Stage|Least#|Quartile 1#|Median#|Quartile 3#|95 %#|Most#|Sum#")
def stage_table(curves: Iterable[Curve]) -> Iterator[Row]:
    """List quartiles of the times of stages."""
    for curve in curves:
        boxes = [(stage, curve.stages[stage]) for stage in STAGES if stage in curve.stages]
        boxes += [("all stages", curve.seconds)] if curve.seconds else []
        boxes += [("processor", curve.cpu_seconds)] if curve.cpu_seconds else []
        for name, box in boxes:
            times = (box.least, box.q1, box.median, box.q3, box.p95, box.most, box.total)
            yield curve.suite, name, *map(_time, times)


@_with("Test system|Figure x|Time|Tests#|Spearman#|Pearson r#|Power law, in s|R²#|Line, in s|R²#")
def trend_table(trends: Iterable[Trend]) -> Iterator[Row]:
    """List the correlations of figures with times."""
    for trend in trends:
        found = trend.correlation
        yield (
            trend.suite,
            trend.metric.replace("_", " "),
            trend.time,
            found.count,
            *(TableCell(f"{value:+.2f}", value) for value in (found.spearman, found.pearson)),
            law_text(found.power),
            _r2(found.power),
            line_text(found.linear),
            _r2(found.linear),
        )


def _r2(fit: Fit | None) -> TableCell:
    return TableCell("-", -1.0) if fit is None else TableCell(f"{fit.r2:.2f}", fit.r2)


@_with(
    "Type|Distributions|Test system|Wire|Result|"
    "Time#|CPU#|Leaves#|Steps#|Packets#|Cycles#|Plan coverage#|Circuit of"
)
def every_table(outcomes: Iterable[Outcome]) -> Iterator[Row]:
    """List tests one by one."""
    for outcome in outcomes:
        test = outcome.test
        record = outcome.record or Record(test=test, verdict=NotJudged("it was not run"))
        yield (
            test.type,
            " ".join(test.distros),
            f"{test.system} {test.simulator}".strip(),
            f"{test.wire} {test.bus_bytes or ''}".strip(),
            _result(outcome.verdict.name),
            *map(_time, (record.seconds.total, record.cpu_seconds)),
            *(record.metrics.get(name, 0) for name in ("leaves", "steps")),
            *(record.packets, record.cycles),
            _covered(outcome),
            outcome.circuit_of,
        )


def _covered(outcome: Outcome) -> TableCell:
    coverage = outcome.record.coverage if outcome.record is not None else None
    if coverage is None:
        return TableCell("-", -1.0)
    share = coverage.taken / coverage.possible if coverage.possible else 1.0
    return TableCell(f"{coverage.taken} of {coverage.possible}", share)


@_with("Test system|Tests#|All decisions taken#|Decisions taken#|Of#|Coverage#")
def coverage_table(summary: Summary) -> Iterator[Row]:
    """List plan coverage by suite."""
    for each in summary.coverage:
        share = each.taken / max(1, each.possible)
        counts = each.types, each.full, each.taken, each.possible
        yield each.suite, *counts, TableCell(_percent(share), share)


@_with("Test|Plan coverage#|Not taken")
def missing_table(outcomes: Iterable[Outcome]) -> Iterator[Row]:
    """List decisions that no packet took."""
    for outcome in outcomes:
        assert outcome.record is not None and outcome.record.coverage is not None
        names = "; ".join(outcome.record.coverage.missing)
        yield title_of(outcome.test), _covered(outcome), names or "not named"


_ORDER = (Failed.name, NotRun.name, NotJudged.name, KnownDifference.name, Passed.name)


def headline(summary: Summary) -> str:
    """Return the result in one line."""
    counts = summary.counts
    if not counts.total and summary.has_ended and not summary.failures:
        return "? no tests"
    parts = [f"{number(counts.passed)} of {number(counts.total)} tests passed"]
    parts += [f"{number(counts.known)} with a known difference"] if counts.known else []
    parts += [f"{number(counts.failed)} failed"] if counts.failed else []
    parts += [f"{number(counts.not_run)} not run"] if counts.not_run else []
    parts += [f"{number(counts.not_judged)} not judged"] if counts.not_judged else []
    line = f"{SIGNS[summary.verdict][0]} {', '.join(parts)}"
    if summary.failures and not counts.failed:
        line += f"; the run failed: {summary.failures[0]}"
    return line if summary.has_ended else f"{line}; a run has not ended"


def facts(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield the figures that a reader looks for first."""
    counts = summary.counts
    yield number(counts.failed), "failed"
    yield number(counts.total), "tests"
    # Names of ROS 1 do not contain ``msg``.
    names = {outcome.test.type.replace("/msg/", "/") for outcome in summary.outcomes}
    yield number(len(names)), "types"
    if summary.circuits:
        # Test systems have the same circuits, so the numbers are not added.
        systems: dict[str, set[str]] = {}
        for outcome in summary.outcomes:
            if outcome.record is not None and outcome.record.shape:
                systems.setdefault(outcome.test.system, set()).add(outcome.record.shape)
        yield number(max(map(len, systems.values()))), "different circuits"
    if summary.coverage:
        taken = sum(each.taken for each in summary.coverage)
        possible = sum(each.possible for each in summary.coverage)
        share = f"{taken / max(1, possible):.2%}"
        yield "99.99%" if share == "100.00%" and taken < possible else share, "plan coverage"
    yield from _cpu_facts(summary)


def _cpu_facts(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield the median processor time of the types with most tests, and the total time."""
    spent: dict[tuple[str, str], float] = defaultdict(float)
    tests: dict[tuple[str, str], int] = defaultdict(int)
    for outcome in summary.outcomes:
        if outcome.record is not None and outcome.record.cpu_seconds:
            key = outcome.test.distro, outcome.test.type.replace("/msg/", "/")
            spent[key] += outcome.record.cpu_seconds
            tests[key] += 1
    if not spent:
        return
    most = max(tests.values())
    whole = sorted(spent[key] for key, count in tests.items() if count == most)
    what = "test" if most == 1 else f"type, {most} tests of each"
    yield seconds(whole[len(whole) // 2]), f"median CPU time per {what}"
    yield seconds(sum(spent.values())), "CPU time in total"


def note_of(outcome: Outcome) -> str:
    """Return the note of a test; empty in most cases."""
    return "" if outcome.record is None else outcome.record.note


def shown_tests(summary: Summary, most: int) -> tuple[list[Outcome], str]:
    """Choose which tests to list: all, or those that did not pass and then the slowest.

    Returns also a text about the tests that are left out; empty if there are none.
    """
    found = list(summary.outcomes)
    left = len(found) - most
    if left <= 0:
        return found, ""

    def order(outcome: Outcome) -> tuple[int, float]:
        record = outcome.record
        place = _ORDER.index(outcome.verdict.name)
        return place, -record.seconds.total if record is not None else 0.0

    found.sort(key=order)
    text = "those that did not pass come first, then the slowest; the report as JSON has all"
    return found[:most], f"and {number(left)} more: {text}"


def shown_packages(summary: Summary, most: int) -> tuple[list[Group], str]:
    """Choose which packages to list: all, or the first ones, beginning with those not passed."""
    found = list(summary.by_package)
    left = len(found) - most
    if left <= 0:
        return found, ""
    found.sort(key=lambda group: group.counts.verdict == Passed.name)
    return found[:most], f"and {number(left)} more; the report as JSON has all"


def shown_trends(trends: Iterable[Trend], most: int) -> list[Trend]:
    """Choose which trends of a suite to draw: those with the strongest correlation."""
    found = [
        trend for trend in trends if trend.time == "total" and trend.correlation.power is not None
    ]
    found.sort(key=lambda trend: -abs(trend.correlation.spearman))
    return found[:most]


def trends_by_suite(summary: Summary) -> dict[str, list[Trend]]:
    """Return the trends of each suite."""
    found: dict[str, list[Trend]] = {}
    for trend in summary.trends:
        found.setdefault(trend.suite, []).append(trend)
    return found


def slowest_suite(summary: Summary) -> str:
    """Return the suite with trends that takes most time. It is shown open."""
    spent = {curve.suite: curve.seconds.total for curve in summary.curves if curve.seconds}
    return max(trends_by_suite(summary), key=lambda suite: spent.get(suite, 0))


def caption_of_fit(trend: Trend) -> str:
    """Describe the functions that were fitted to points."""
    law, line = trend.correlation.power, trend.correlation.linear
    parts = [f"power law {law_text(law)} s (R² {law.r2:.2f})"] if law else []
    parts += [f"line {line_text(line)} s (R² {line.r2:.2f})"] if line else []
    return f"{trend.suite}; x = {trend.metric.replace('_', ' ')}: {', '.join(parts)}"


def sources(summary: Summary) -> Iterator[tuple[str, list[str]]]:
    """Yield the files of a report, with the options and environments of their runs."""
    for run in summary.runs:
        lines = [f"{run.recorded} of {run.planned} planned tests have a record"]
        lines += ["the last session has not ended"] if run.failure is None else []
        lines += [f"failed: {run.failure}"] if run.failure else []
        lines += [f"{name}: {_plain(value)}" for name, value in run.options.items()]
        before = None
        for index, session in enumerate(run.sessions, 1):
            own = {key: text for key, text in session.items() if key != "started"}
            started = f" {session['started']}" if "started" in session else ""
            lines.append(f"session {index}{started}{': as before' if own == before else ''}")
            if own != before:
                lines += [f"    {key}: {text}" for key, text in own.items()]
            before = own
        yield run.name, lines


def _plain(value: object) -> str:
    if isinstance(value, list):
        return ", ".join(map(str, value)) or "none"
    return "default" if value is None else str(value)
