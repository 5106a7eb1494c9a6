"""The tables of a report, for HTML and Markdown: headings, and rows of cells.

A cell has a text and, if it is a number, the value to sort by.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import wraps
from typing import TypeAlias, TypeVar

from firm_hdl.drawing.svg import number, seconds
from firm_hdl.verify.report.charts import law_text, line_text
from firm_hdl.verify.report.outcomes import Counts, NotRun, Outcome, failures_of
from firm_hdl.verify.report.stats import Fit
from firm_hdl.verify.report.summary import LIMITS, Curve, Group, Summary, Trend
from firm_hdl.verify.results.records import STAGES, Record
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed

__all__ = [
    "MOST_ROWS",
    "SIGNS",
    "Table",
    "TableCell",
    "circuits_table",
    "coverage_table",
    "cut",
    "every_table",
    "failure_table",
    "group_table",
    "missing_table",
    "oracle_table",
    "remark_table",
    "stage_table",
    "title_of",
    "trend_table",
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
    """A cell.

    Attributes
    ----------
    text : str
    value : float or None
        The value to sort by, if it is a number.
    verdict : str
        The verdict that gives the cell its colour; empty: the colour of text.
    counts : Counts or None
        Counts that are drawn as a bar in HTML.
    """

    text: str
    value: float | None = None
    verdict: str = ""
    counts: Counts | None = None


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


def title_of(outcome: Outcome) -> str:
    """Name a test in a line."""
    test = outcome.test
    circuit = [test.wire, f"{test.bus_bytes}-byte bus" if test.bus_bytes else "", test.options]
    return ", ".join(
        part
        for part in (test.type, " ".join(test.distros), test.system, test.simulator, *circuit)
        if part
    )


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
        yield title_of(outcome), shown, outcome.record.command if outcome.record else ""


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
        yield title_of(outcome), _covered(outcome), names or "not named"
