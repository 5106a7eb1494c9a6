"""A report as Markdown, for a terminal or a merge request."""

from __future__ import annotations

import re
from collections.abc import Iterator

from firm_hdl.verify.report.prose import SECTIONS, facts, headline, reasons, sources
from firm_hdl.verify.report.summary import Summary
from firm_hdl.verify.report.tables import (
    Cell,
    Table,
    coverage_table,
    every_table,
    group_table,
    missing_table,
    stage_table,
    title_of,
    trend_table,
    within_table,
)

__all__ = ["to_markdown"]


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
    for outcome in summary.failed:
        yield from (f"### {_text(title_of(outcome))}", "", *_block(*outcome.failures))
        if outcome.record is not None and outcome.record.command:
            yield from ("Repeat it:", "", *_block(outcome.record.command))
        if outcome.record is not None and outcome.record.waveform_command:
            yield from ("With a waveform:", "", *_block(outcome.record.waveform_command))


def _rest(summary: Summary) -> Iterator[str]:
    for name, outcomes in (("Not run", summary.not_run), ("Skipped", summary.skipped)):
        if outcomes:
            yield from (f"{name}:", "", *(f"* {_text(reasons(each))}" for each in outcomes), "")


def _results(summary: Summary) -> Iterator[str]:
    yield from _table(group_table(summary.by_distro, "Test system|Distribution"))


def _packages(summary: Summary) -> Iterator[str]:
    yield from _table(group_table(summary.by_package, "Test system|Distribution|Package"))


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
        yield from _table(missing_table(summary.uncovered))


def _extremes(summary: Summary) -> Iterator[str]:
    for title, outcomes in (
        ("Slowest tests:", summary.slowest),
        ("Most complex types:", summary.most_complex),
    ):
        if outcomes:
            yield from (title, "", *_table(every_table(outcomes)))


def _tests(summary: Summary) -> Iterator[str]:
    yield from _table(every_table(summary.outcomes))


def _environment(summary: Summary) -> Iterator[str]:
    for name, lines in sources(summary):
        yield from (f"### {_text(name)}", "", *_block("\n".join(lines)))


_SECTIONS = {
    "failures": _failures,
    "results": _results,
    "rest": _rest,
    "packages": _packages,
    "coverage": _coverage,
    "time": _time,
    "trends": _trends,
    "extremes": _extremes,
    "tests": _tests,
    "environment": _environment,
}


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
