"""The tables of a report, which all of its forms have: headings, and rows of cells.

A cell is what is read and, where it is a number, what it sorts by. Forms differ in how they write
it down, not in what is there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from firm_hdl.verify.report.charts import law_text, line_text
from firm_hdl.verify.report.outcomes import Counts, NotRun, Outcome, failures_of
from firm_hdl.verify.report.summary import LIMITS, Curve, Group, Summary, Trend
from firm_hdl.verify.report.svg import number, seconds
from firm_hdl.verify.results.records import STAGES
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
    "said_table",
    "stage_table",
    "title_of",
    "trend_table",
    "within_table",
    "writer_table",
]

MOST_ROWS = 1000
"""How long a table of tests or packages may be on a page; JSON has all of them."""

MOST_TEXT = 300

SIGNS = {
    Passed.name: "✓ passed",
    KnownDifference.name: "~ known difference",
    Failed.name: "✗ failed",
    NotJudged.name: "- not judged",
    NotRun.name: "? not run",
}
"""How verdicts are written: never by colour alone."""


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell.

    Attributes
    ----------
    text : str
    value : float or None
        What it sorts by, if it is a number.
    verdict : str
        Its colour; empty for that of text.
    counts : Counts or None
        Drawn as a bar, where something can be drawn.
    """

    text: str
    value: float | None = None
    verdict: str = ""
    counts: Counts | None = None


@dataclass(frozen=True, slots=True)
class Table:
    """A table; the headings of numbers end in ``#``."""

    headings: tuple[str, ...]
    rows: tuple[tuple[TableCell, ...], ...]


def _count(value: float) -> TableCell:
    return TableCell(number(value), value)


def _time(value: float) -> TableCell:
    return TableCell(seconds(value) if value else "-", value)


def _of(headings: str, rows: Iterable[Iterable[TableCell]]) -> Table:
    """Make a table, without columns that are empty."""
    names, made = headings.split("|"), [tuple(row) for row in rows]
    kept = [
        column
        for column in range(len(names))
        if not made or any(row[column].text or row[column].counts for row in made)
    ]
    return Table(
        tuple(names[column] for column in kept),
        tuple(tuple(row[column] for column in kept) for row in made),
    )


def cut(table: Table, most: int = MOST_ROWS) -> tuple[Table, str]:
    """Return the first rows of a table, and a word on the rest, which is empty if there is none."""
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

    def rows() -> Iterator[Iterable[TableCell]]:
        for group in groups:
            counts = group.counts
            yield (
                *map(TableCell, group.labels),
                TableCell(SIGNS[counts.verdict], verdict=counts.verdict),
                TableCell("", (counts.passed + counts.known) / max(1, counts.total), counts=counts),
                *map(_count, (counts.passed, counts.known, counts.failed)),
                *map(_count, (counts.not_judged, counts.not_run)),
                _time(group.cpu_seconds),
            )

    columns = "Passed#|Known difference#|Failed#|Not judged#|Not run#|CPU time#"
    return _of(f"{names}|Result|Share|{columns}", rows())


def writer_table(summary: Summary) -> Table:
    """Count tests by the libraries that wrote their packets."""
    return _of(
        "Test system|Library|Tests#",
        (
            (TableCell(suite), TableCell(name), _count(tests))
            for suite, writers in summary.writers.items()
            for name, tests in writers.items()
        ),
    )


def circuits_table(summary: Summary) -> Table:
    """Count different circuits by suite."""
    return _of(
        "Test system|Different circuits#|Tested with that of another type#",
        (
            (TableCell(suite), _count(shapes), _count(shared))
            for suite, (shapes, shared) in summary.circuits.items()
        ),
    )


def oracle_table(summary: Summary) -> Table:
    """Count what oracles said of definitions."""
    return _of(
        "Distribution|Oracle|Agree#|Of these, both refuse#|Known difference#|Differ#|Not judged#",
        (
            (
                TableCell(each.distro),
                TableCell(each.oracle),
                *map(_count, (each.agree, each.refused, each.known)),
                TableCell(
                    number(each.differ), each.differ, verdict=Failed.name if each.differ else ""
                ),
                _count(each.not_judged),
            )
            for each in summary.oracles
        ),
    )


def said_table(summary: Summary) -> Table:
    """List known differences from oracles, and why they did not judge."""
    return _of(
        "Oracle|Verdict|Key or reason|Definitions#|Such as",
        (
            (
                *map(TableCell, (each.oracle, each.verdict, each.what)),
                _count(each.count),
                TableCell(each.example),
            )
            for each in summary.said
        ),
    )


def failure_table(outcomes: Iterable[Outcome]) -> Table:
    """List failed tests in a line each."""

    def rows() -> Iterator[Iterable[TableCell]]:
        for outcome in outcomes:
            text = failures_of(outcome)[0]
            shown = text if len(text) <= MOST_TEXT else f"{text[:MOST_TEXT]}..."
            command = outcome.record.command if outcome.record is not None else ""
            yield TableCell(title_of(outcome)), TableCell(shown), TableCell(command)

    return _of("Test|Failure|Repeat it", rows())


def within_table(curves: Iterable[Curve]) -> Table:
    """List the shares of tests that were completed within some times."""
    limits = "|".join(f"{limit:g} s#" for limit in LIMITS)
    return _of(
        f"Test system|Tests#|{limits}",
        (
            (
                TableCell(curve.suite),
                _count(0 if curve.seconds is None else curve.seconds.count),
                *(TableCell(_percent(share), share) for share in curve.within.values()),
            )
            for curve in curves
        ),
    )


def _percent(share: float) -> str:
    text = f"{share:.1%}"
    # Rounding must not say that all is done.
    return "99.9%" if text == "100.0%" and share < 1 else text


def stage_table(curves: Iterable[Curve]) -> Table:
    """List quartiles of the times of stages."""

    def rows() -> Iterator[Iterable[TableCell]]:
        for curve in curves:
            boxes = [(stage, curve.stages[stage]) for stage in STAGES if stage in curve.stages]
            boxes += [("all stages", curve.seconds)] if curve.seconds else []
            boxes += [("processor", curve.cpu_seconds)] if curve.cpu_seconds else []
            for name, box in boxes:
                times = (box.least, box.q1, box.median, box.q3, box.p95, box.most, box.total)
                yield (TableCell(curve.suite), TableCell(name), *map(_time, times))

    columns = "Least#|Quartile 1#|Median#|Quartile 3#|95 %#|Most#|Sum#"
    return _of(f"Test system|Stage|{columns}", rows())


def trend_table(trends: Iterable[Trend]) -> Table:
    """List how figures go with times."""

    def rows() -> Iterator[Iterable[TableCell]]:
        for trend in trends:
            found = trend.correlation
            yield (
                TableCell(trend.suite),
                TableCell(trend.metric.replace("_", " ")),
                TableCell(trend.time),
                _count(found.count),
                *(TableCell(f"{value:+.2f}", value) for value in (found.spearman, found.pearson)),
                TableCell(law_text(found.power)),
                _r2(found.power.r2 if found.power else None),
                TableCell(line_text(found.linear)),
                _r2(found.linear.r2 if found.linear else None),
            )

    columns = "Spearman#|Pearson r#|Power law, in s|R²#|Line, in s|R²#"
    return _of(f"Test system|Figure x|Time|Tests#|{columns}", rows())


def _r2(value: float | None) -> TableCell:
    return TableCell("-", -1.0) if value is None else TableCell(f"{value:.2f}", value)


def every_table(outcomes: Iterable[Outcome]) -> Table:
    """List tests one by one."""

    def rows() -> Iterator[Iterable[TableCell]]:
        for outcome in outcomes:
            test, record = outcome.test, outcome.record
            metrics = record.metrics if record is not None else {}
            circuit = f"{test.wire} {test.bus_bytes or ''}".strip()
            yield (
                TableCell(test.type),
                TableCell(" ".join(test.distros)),
                TableCell(" ".join(part for part in (test.system, test.simulator) if part)),
                TableCell(circuit),
                TableCell(SIGNS[outcome.verdict.name], verdict=outcome.verdict.name),
                _time(record.seconds.total if record else 0),
                _time(record.cpu_seconds if record else 0),
                *(_count(metrics.get(name, 0)) for name in ("leaves", "steps")),
                _count(record.packets if record else 0),
                _count(record.cycles if record else 0),
                _covered(outcome),
                TableCell(outcome.circuit_of),
            )

    columns = "Time#|CPU#|Leaves#|Steps#|Packets#|Cycles#|Plan coverage#|Circuit of"
    return _of(f"Type|Distributions|Test system|Wire|Result|{columns}", rows())


def _covered(outcome: Outcome) -> TableCell:
    coverage = outcome.record.coverage if outcome.record is not None else None
    if coverage is None:
        return TableCell("-", -1.0)
    share = coverage.taken / coverage.possible if coverage.possible else 1.0
    return TableCell(f"{coverage.taken} of {coverage.possible}", share)


def coverage_table(summary: Summary) -> Table:
    """List plan coverage by suite."""
    return _of(
        "Test system|Tests#|All decisions taken#|Decisions taken#|Of#|Coverage#",
        (
            (
                TableCell(each.suite),
                *map(_count, (each.types, each.full, each.taken, each.possible)),
                TableCell(_percent(share := each.taken / max(1, each.possible)), share),
            )
            for each in summary.coverage
        ),
    )


def missing_table(outcomes: Iterable[Outcome]) -> Table:
    """List decisions that no packet took."""

    def rows() -> Iterator[Iterable[TableCell]]:
        for outcome in outcomes:
            assert outcome.record is not None and outcome.record.coverage is not None
            names = "; ".join(outcome.record.coverage.missing)
            yield TableCell(title_of(outcome)), _covered(outcome), TableCell(names or "not named")

    return _of("Test|Plan coverage#|Not taken", rows())
