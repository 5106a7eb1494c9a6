"""The sentences of a report, for HTML and Markdown."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from firm_hdl.drawing.svg import number, seconds
from firm_hdl.verify.report.charts import law_text, line_text
from firm_hdl.verify.report.outcomes import NotRun, Outcome
from firm_hdl.verify.report.summary import Group, Summary, Trend
from firm_hdl.verify.report.tables import SIGNS
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed

__all__ = [
    "caption_of_fit",
    "facts",
    "headline",
    "note_of",
    "shown_packages",
    "shown_tests",
    "shown_trends",
    "slowest_suite",
    "sources",
    "trends_by_suite",
]

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

    Returns
    -------
    tests, rest
        The rest is a text about the tests that are left out; empty if there are none.
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
