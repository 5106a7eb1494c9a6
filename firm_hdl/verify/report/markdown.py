"""A report as Markdown, for a terminal or a merge request."""

from __future__ import annotations

import re
from collections.abc import Iterator

from firm_hdl.verify.report.outcomes import Outcome, failures_of
from firm_hdl.verify.report.prose import (
    SECTIONS,
    facts,
    headline,
    note_of,
    shown_packages,
    shown_tests,
    sources,
)
from firm_hdl.verify.report.summary import Summary
from firm_hdl.verify.report.tables import (
    MOST_ROWS,
    Cell,
    Table,
    circuits_table,
    coverage_table,
    cut,
    every_table,
    failure_table,
    group_table,
    missing_table,
    oracle_table,
    said_table,
    stage_table,
    title_of,
    trend_table,
    within_table,
    writer_table,
)
from firm_hdl.verify.report.verdicts import reason_groups

__all__ = ["to_markdown"]

MOST_FAILURES = 20
MOST_NAMES = 50


def to_markdown(summary: Summary) -> str:
    """Write a report as Markdown."""
    lines = [f"# {_text(summary.title)}", "", f"**{_text(headline(summary))}**", ""]
    lines += [f"* {_text(figure)} {_text(what)}" for figure, what in facts(summary)]
    for name, make in _SECTIONS.items():
        parts = list(make(summary))
        if parts:
            title, text = SECTIONS[name]
            lines += ["", f"## {title}", "", *([text, ""] if text else []), *parts]
    return re.sub("\n{3,}", "\n\n", "\n".join(lines)).rstrip() + "\n"


def _failures(summary: Summary) -> Iterator[str]:
    failed = summary.failed
    for outcome in failed[:MOST_FAILURES]:
        yield from (f"### {_text(title_of(outcome))}", "", *_block(*failures_of(outcome)))
        if outcome.record is not None and outcome.record.command:
            yield from ("Repeat it:", "", *_block(outcome.record.command))
        if outcome.record is not None and outcome.record.waveform_command:
            yield from ("With a waveform:", "", *_block(outcome.record.waveform_command))
    if failed[MOST_FAILURES:]:
        yield from (f"{len(failed) - MOST_FAILURES} more tests failed:", "")
        yield from _cut(failure_table(failed[MOST_FAILURES:]))


def _rest(summary: Summary) -> Iterator[str]:
    parts = [(name, reason_groups(outcomes)) for name, outcomes in _untested(summary)]
    parts.append(("Note", reason_groups(summary.noted, note_of)))
    for name, groups in parts:
        for group in groups:
            yield from (f"{name}, {len(group.outcomes)}: {_text(group.text)}", "")
            shown = group.outcomes[:MOST_NAMES]
            yield from (f"* {_text(title_of(each))}" for each in shown)
            left = len(group.outcomes) - len(shown)
            yield from ([f"* and {left} more"] if left else [])
            yield ""


def _untested(summary: Summary) -> Iterator[tuple[str, list[Outcome]]]:
    yield "Not run", summary.not_run
    yield "Not judged", summary.not_judged


def _oracles(summary: Summary) -> Iterator[str]:
    yield from _table(oracle_table(summary))
    yield from _table(said_table(summary))


def _writers(summary: Summary) -> Iterator[str]:
    if summary.writers:
        yield from _table(writer_table(summary))


def _circuits(summary: Summary) -> Iterator[str]:
    if summary.circuits:
        yield from _table(circuits_table(summary))


def _results(summary: Summary) -> Iterator[str]:
    yield from _table(group_table(summary.by_suite, "Test system"))
    yield from _table(group_table(summary.by_distro, "Test system|Distribution"))


def _packages(summary: Summary) -> Iterator[str]:
    shown, rest = shown_packages(summary, MOST_ROWS)
    yield from _table(group_table(shown, "Test system|Distribution|Package"))
    yield from (_text(rest), "")


def _time(summary: Summary) -> Iterator[str]:
    if summary.curves:
        yield from ("Share of tests completed within a time:", "")
        yield from _table(within_table(summary.curves))
        yield from ("Run times of the stages:", "")
        yield from _table(stage_table(summary.curves))


def _trends(summary: Summary) -> Iterator[str]:
    yield from _table(trend_table(summary.trends))


def _coverage(summary: Summary) -> Iterator[str]:
    yield from _table(coverage_table(summary))
    if summary.uncovered:
        yield from (f"{len(summary.uncovered)} tests did not take all:", "")
        yield from _cut(missing_table(summary.uncovered))


def _extremes(summary: Summary) -> Iterator[str]:
    for title, outcomes in (
        ("Slowest tests:", summary.slowest),
        ("Most complex types:", summary.most_complex),
    ):
        if outcomes:
            yield from (title, "", *_table(every_table(outcomes)))


def _tests(summary: Summary) -> Iterator[str]:
    shown, rest = shown_tests(summary, MOST_ROWS)
    yield from _table(every_table(shown))
    yield from (_text(rest), "")


def _environment(summary: Summary) -> Iterator[str]:
    for name, lines in sources(summary):
        yield from (f"### {_text(name)}", "", *_block("\n".join(lines)))


_SECTIONS = {
    "failures": _failures,
    "results": _results,
    "oracles": _oracles,
    "rest": _rest,
    "packages": _packages,
    "circuits": _circuits,
    "writers": _writers,
    "coverage": _coverage,
    "time": _time,
    "trends": _trends,
    "extremes": _extremes,
    "tests": _tests,
    "environment": _environment,
}


def _cut(table: Table) -> Iterator[str]:
    shown, rest = cut(table)
    yield from _table(shown)
    yield from (_text(rest), "")


def _table(table: Table) -> Iterator[str]:
    if not table.rows:
        return
    drawn = {n for n, cell in enumerate(table.rows[0]) if cell.counts is not None}
    kept = [n for n in range(len(table.headings)) if n not in drawn]
    yield _row(_text(table.headings[n].rstrip("#")) for n in kept)
    yield _row("---:" if table.headings[n].endswith("#") else "---" for n in kept)
    for row in table.rows:
        yield _row(_cell(row[n]) for n in kept)
    yield ""


def _row(cells: Iterator[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _cell(cell: Cell) -> str:
    return _text(cell.text)


def _text(text: str) -> str:
    """Write text such that nothing in it is a mark."""
    return re.sub(r"([\\`*{}\[\]<>#|~]|\b_|_\b)", r"\\\1", " ".join(text.split()))


def _block(*texts: str) -> Iterator[str]:
    """Write texts as they are, inside a fence that is in none of them."""
    longest = max((len(found) for text in texts for found in re.findall("`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    yield from (fence, *texts, fence, "")
