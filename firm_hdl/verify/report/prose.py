"""What a report says in words, in all of its forms."""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.verify.report.charts import law_text, line_text
from firm_hdl.verify.report.outcomes import Outcome
from firm_hdl.verify.report.summary import Summary, Trend
from firm_hdl.verify.report.svg import number, seconds
from firm_hdl.verify.report.tables import title_of

__all__ = [
    "SECTIONS",
    "caption_of_fit",
    "facts",
    "headline",
    "reasons",
    "shown_trends",
    "sources",
]

SECTIONS = {
    "failures": ("Failures", ""),
    "results": (
        "Results by distribution",
        "A type that is the same in several distributions is tested once, and counts in each.",
    ),
    "rest": ("Not tested", "A test that there is no result of is not counted as passed."),
    "packages": ("Results by package", ""),
    "coverage": (
        "Plan coverage",
        "A plan lists every decision that a packet can make in a converter: each step that may "
        "follow a step, each padding, each end of a loop. Coverage is the share of them that the "
        "packets of a test took.",
    ),
    "time": (
        "Time",
        "By the clock on the wall, per test, on one processor. Generation: from the definition to "
        "test cases and a circuit that is ready to run. Simulation: running it. Testing: comparing "
        "what came out with the oracle and the golden model.",
    ),
    "trends": (
        "What makes a test slow",
        "Figures of types against the time of their tests, with the power law and the line that "
        "fit best by least squares. R² of a power law is that of the logarithms. Leaves are fields "
        "of all levels; dynamic leaves are of no fixed size; streams are those of the message side "
        "of a converter; steps and decisions are those of its plan; shifting counts places on the "
        "wire whose padding differs from message to message; case bytes are those of all cases.",
    ),
    "extremes": ("Slowest and most complex", ""),
    "tests": ("All tests", ""),
    "environment": ("Environment and options", ""),
}
"""Titles of the sections, and what is to be known to read them."""


def headline(summary: Summary) -> str:
    """Say in a line what came out."""
    counts = summary.counts
    if not counts.total:
        return "? no tests"
    parts = [f"{number(counts.passed)} of {number(counts.total)} tests passed"]
    parts += [f"{number(counts.failed)} failed"] if counts.failed else []
    parts += [f"{number(counts.not_run)} not run"] if counts.not_run else []
    parts += [f"{number(counts.skipped)} skipped"] if counts.skipped else []
    sign = {"pass": "✓", "fail": "✗", "not run": "?", "skipped": "-"}[counts.verdict]
    return f"{sign} {', '.join(parts)}"


def facts(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield the figures that a reader looks for first."""
    counts = summary.counts
    yield number(counts.failed), "failed"
    yield number(counts.total), "tests"
    yield number(len({outcome.test.type for outcome in summary.outcomes})), "types"
    if summary.circuits:
        different = sum(shapes for shapes, _ in summary.circuits.values())
        yield number(different), "different circuits"
    if summary.coverage:
        taken = sum(each.taken for each in summary.coverage)
        possible = sum(each.possible for each in summary.coverage)
        share = f"{taken / max(1, possible):.2%}"
        yield "99.99%" if share == "100.00%" and taken < possible else share, "plan coverage"
    records = [outcome.record for outcome in summary.outcomes if outcome.record is not None]
    cpu = sorted(record.cpu_seconds for record in records if record.cpu_seconds)
    if cpu:
        yield seconds(cpu[len(cpu) // 2]), "median CPU time per test"
        yield seconds(sum(cpu)), "CPU time in total"


def reasons(outcome: Outcome) -> str:
    """Say which test was not run, or why it was skipped."""
    record = outcome.record
    if outcome.circuit_of:
        return f"{title_of(outcome)}: has the circuit of {outcome.circuit_of}, which was not run"
    reason = record.reason if record is not None else ""
    return f"{title_of(outcome)}{': ' if reason else ''}{reason}"


def shown_trends(summary: Summary, most: int) -> list[Trend]:
    """Choose which trends to draw: for each test system those that explain most."""
    found = [
        trend
        for trend in summary.trends
        if trend.time == "total" and trend.correlation.power is not None
    ]
    found.sort(key=lambda trend: -abs(trend.correlation.spearman))
    suites: dict[str, int] = {}
    chosen = []
    for trend in found:
        suites[trend.suite] = suites.get(trend.suite, 0) + 1
        if suites[trend.suite] <= most:
            chosen.append(trend)
    return sorted(chosen, key=lambda trend: list(suites).index(trend.suite))


def caption_of_fit(trend: Trend) -> str:
    """Say what was fitted to points."""
    law, line = trend.correlation.power, trend.correlation.linear
    parts = [f"power law {law_text(law)} s (R² {law.r2:.2f})"] if law else []
    parts += [f"line {line_text(line)} s (R² {line.r2:.2f})"] if line else []
    return f"{trend.suite}; x = {trend.metric.replace('_', ' ')}: {', '.join(parts)}"


def sources(summary: Summary) -> Iterator[tuple[str, list[str]]]:
    """Yield the files that a report is of, with the options of the run and what it ran on."""
    for run in summary.runs:
        lines = [f"{run.recorded} of {run.planned} planned tests have a record"]
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
