"""A report as one page of HTML that needs nothing else: no server, no network, no other file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import escape
from importlib.resources import files

from firm_hdl.verify.report.charts import colour, counts_bar, cumulative, scatter, stages
from firm_hdl.verify.report.outcomes import Outcome
from firm_hdl.verify.report.prose import (
    SECTIONS,
    caption_of_fit,
    facts,
    headline,
    reasons,
    shown_trends,
    sources,
)
from firm_hdl.verify.report.summary import Curve, Summary
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

__all__ = ["to_html"]

# The page loads nothing, and what is in a name or in a text cannot make it.
POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'"

MOST_CHARTS = 6
MOST_OPEN_ROWS = 40
SHORT = 40


def to_html(summary: Summary) -> str:
    """Write a report as a page."""
    here = files(__package__ or "")
    style = here.joinpath("page.css").read_text(encoding="utf-8")
    script = here.joinpath("page.js").read_text(encoding="utf-8")
    title = escape(summary.title)
    body = "\n".join(_body(summary))
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n{body}\n"
        f"<script>\n{script}</script>\n</body>\n</html>\n"
    )


def _body(summary: Summary) -> Iterator[str]:
    verdict = summary.counts.verdict
    yield f"<header><h1>{escape(summary.title)}</h1>"
    yield f'<div class="verdict {_class(verdict)}">{escape(headline(summary))}</div>'
    yield '<div class="tiles">'
    for figure, what in facts(summary):
        yield f'<div class="tile"><b>{escape(figure)}</b><span>{escape(what)}</span></div>'
    yield "</div></header>"
    sections = [(name, list(make(summary))) for name, make in _SECTIONS.items()]
    there = [(name, parts) for name, parts in sections if parts]
    yield "<nav>" + "".join(f'<a href="#{n}">{escape(SECTIONS[n][0])}</a>' for n, _ in there)
    yield "</nav><main>"
    for name, parts in there:
        title, text = SECTIONS[name]
        yield f'<section id="{name}"><h2>{escape(title)}</h2>'
        yield f'<p class="soft">{escape(text)}</p>' if text else ""
        yield from parts
        yield "</section>"
    yield "<footer>Made by firm-hdl report. Headings of tables sort.</footer></main>"


def _class(verdict: str) -> str:
    return verdict.replace(" ", "-")


def _failures(summary: Summary) -> Iterator[str]:
    for outcome in summary.failed:
        yield f"<article><h3>{escape(title_of(outcome))}</h3>"
        texts = [escape(text) for text in outcome.failures]
        yield f"<pre>{texts[0]}</pre>"
        if texts[1:]:
            yield f"<details><summary>{len(texts) - 1} more</summary>"
            yield "".join(f"<pre>{text}</pre>" for text in texts[1:]) + "</details>"
        if outcome.record is not None and outcome.record.command:
            yield f'<div class="soft">Repeat it</div><pre>{escape(outcome.record.command)}</pre>'
        if outcome.record is not None and outcome.record.waveform_command:
            yield '<div class="soft">With a waveform</div>'
            yield f"<pre>{escape(outcome.record.waveform_command)}</pre>"
        yield "</article>"


def _rest(summary: Summary) -> Iterator[str]:
    for name, outcomes in (("not run", summary.not_run), ("skipped", summary.skipped)):
        if outcomes:
            tests = "test" if len(outcomes) == 1 else "tests"
            was = "was" if len(outcomes) == 1 else "were"
            yield f"<details><summary>{len(outcomes)} {tests} {was} {name}</summary>"
            yield _list(outcomes) + "</details>"


def _list(outcomes: Iterable[Outcome]) -> str:
    items = "".join(f"<li>{escape(text)}</li>" for text in map(reasons, outcomes))
    return f"<ul>{items}</ul>"


def _results(summary: Summary) -> Iterator[str]:
    if summary.by_distro:
        yield _table(group_table(summary.by_distro, "Test system|Distribution"))


def _packages(summary: Summary) -> Iterator[str]:
    if summary.by_package:
        table = group_table(summary.by_package, "Test system|Distribution|Package")
        is_open = " open" if len(table.rows) <= MOST_OPEN_ROWS else ""
        yield f"<details{is_open}><summary>{len(table.rows)} packages</summary>"
        yield _table(table, "packages", "Find a package") + "</details>"


def _time(summary: Summary) -> Iterator[str]:
    if not summary.curves:
        return
    yield "<h3>Share of tests completed within a time</h3><figure>"
    yield _key(summary.curves) + cumulative(summary.curves)
    yield "<figcaption>Circles are at 50 % and at 95 % of the tests.</figcaption></figure>"
    yield _table(within_table(summary.curves))
    yield "<h3>Run times of the stages</h3>"
    for curve in summary.curves:
        yield f"<figure><figcaption>{escape(curve.suite)}</figcaption>{stages(curve)}</figure>"
    yield '<p class="soft">A box is from the first quartile to the third, with the median as a bar '
    yield "and a tick at 95 %; each point is a test.</p>"
    yield _table(stage_table(summary.curves))


def _key(curves: Iterable[Curve]) -> str:
    items = (
        f'<span><i class="{colour(index)}"></i>{escape(curve.suite)}</span>'
        for index, curve in enumerate(curves)
    )
    return f'<div class="key">{"".join(items)}</div>'


def _trends(summary: Summary) -> Iterator[str]:
    if not summary.trends:
        return
    yield '<div class="key"><span><i class="fit-law-key"></i>power law</span>'
    yield '<span><i class="dash fit-line-key"></i>line (bent by the logarithmic axes)</span></div>'
    yield '<div class="pair">'
    for trend in shown_trends(summary, MOST_CHARTS):
        yield f"<figure>{scatter(trend)}<figcaption>{escape(caption_of_fit(trend))}"
        yield "</figcaption></figure>"
    yield "</div>"
    total = [trend for trend in summary.trends if trend.time == "total"]
    yield _table(trend_table(total))
    yield "<details><summary>By stage</summary>"
    yield _table(trend_table(t for t in summary.trends if t.time != "total")) + "</details>"


def _coverage(summary: Summary) -> Iterator[str]:
    if not summary.coverage:
        return
    yield _table(coverage_table(summary))
    if summary.uncovered:
        yield f"<details open><summary>{len(summary.uncovered)} tests did not take all</summary>"
        yield _table(missing_table(summary.uncovered)) + "</details>"


def _extremes(summary: Summary) -> Iterator[str]:
    for title, outcomes in (
        ("Slowest tests", summary.slowest),
        ("Most complex types", summary.most_complex),
    ):
        if outcomes:
            yield f"<h3>{title}</h3>" + _table(every_table(outcomes))


def _tests(summary: Summary) -> Iterator[str]:
    if summary.outcomes:
        yield f"<details><summary>Show all {len(summary.outcomes)} tests</summary>"
        yield _table(every_table(summary.outcomes), "tests", "Find tests, such as nav_msgs fail")
        yield "</details>"


def _environment(summary: Summary) -> Iterator[str]:
    for name, lines in sources(summary):
        yield f"<h3>{escape(name)}</h3><pre>{escape(chr(10).join(lines))}</pre>"


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


def _table(table: Table, name: str = "", hint: str = "") -> str:
    heads = "".join(
        f'<th data-sort class="{"n" if text.endswith("#") else "t"}">{escape(text.rstrip("#"))}'
        "</th>"
        for text in table.headings
    )
    rows = "".join(f"<tr>{''.join(map(_cell, row))}</tr>\n" for row in table.rows)
    found = f'<input type="search" data-table="table-{name}" placeholder="{hint}">' if name else ""
    mark = f' id="table-{name}"' if name else ""
    return (
        f'{found}<div class="wide"><table{mark}><thead><tr>{heads}</tr></thead>'
        f"<tbody>\n{rows}</tbody></table></div>"
    )


def _cell(cell: Cell) -> str:
    if cell.counts is not None:
        return f'<td data-v="{cell.value}">{counts_bar(cell.counts)}</td>'
    if cell.value is not None:
        return f'<td class="n" data-v="{cell.value:.9g}">{escape(cell.text)}</td>'
    kind = f' class="t {_class(cell.verdict)}"' if cell.verdict else ""
    if len(cell.text) < SHORT:
        # Nothing is gained by breaking it.
        kind = kind or ' class="t"'
    return f"<td{kind}>{escape(cell.text)}</td>"
