"""A report as one page of HTML that needs nothing else: no server, no network, no other file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from importlib.resources import files

from firm_hdl.verify.report.charts import colour, counts_bar, cumulative, scatter, stages
from firm_hdl.verify.report.outcomes import Outcome, failures_of
from firm_hdl.verify.report.prose import (
    SECTIONS,
    caption_of_fit,
    facts,
    headline,
    note_of,
    shown_packages,
    shown_tests,
    shown_trends,
    sources,
)
from firm_hdl.verify.report.summary import Curve, Summary, Trend
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
from firm_hdl.verify.report.verdicts import Reason, reason_groups

__all__ = ["to_html"]

# The page loads nothing, and what is in a name or in a text cannot make it.
POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'"

MOST_CHARTS = 6
MOST_OPEN_ROWS = 40
MOST_ARTICLES = 20
MOST_NAMES = 50
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
    failed = summary.failed
    for outcome in failed[:MOST_ARTICLES]:
        yield f"<article><h3>{escape(title_of(outcome))}</h3>"
        texts = [escape(text) for text in failures_of(outcome)]
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
    if failed[MOST_ARTICLES:]:
        table, rest = cut(failure_table(failed[MOST_ARTICLES:]))
        yield f"<details><summary>{len(failed) - MOST_ARTICLES} more tests failed</summary>"
        yield _table(table, "failed", "Find failures", rest) + "</details>"


def _rest(summary: Summary) -> Iterator[str]:
    for name, outcomes in (("not run", summary.not_run), ("not judged", summary.not_judged)):
        if outcomes:
            tests = "test was" if len(outcomes) == 1 else "tests were"
            yield f"<h3>{len(outcomes)} {tests} {name}</h3>"
            yield from map(_group, reason_groups(outcomes))
    if summary.noted:
        yield "<h3>Notes</h3>"
        yield from map(_group, reason_groups(summary.noted, note_of))


def _group(group: Reason) -> str:
    head = f"{len(group.outcomes)}: {escape(group.text)}"
    return f"<details><summary>{head}</summary>{_list(group.outcomes)}</details>"


def _list(outcomes: Sequence[Outcome]) -> str:
    items = "".join(f"<li>{escape(title_of(each))}</li>" for each in outcomes[:MOST_NAMES])
    left = len(outcomes) - MOST_NAMES
    return f"<ul>{items}{f'<li>and {left} more</li>' if left > 0 else ''}</ul>"


def _results(summary: Summary) -> Iterator[str]:
    if summary.by_distro:
        yield _table(group_table(summary.by_suite, "Test system"))
        yield _table(group_table(summary.by_distro, "Test system|Distribution"))


def _oracles(summary: Summary) -> Iterator[str]:
    if summary.oracles:
        yield _table(oracle_table(summary))
    if summary.said:
        yield _table(said_table(summary))


def _writers(summary: Summary) -> Iterator[str]:
    if summary.writers:
        yield _table(writer_table(summary))


def _circuits(summary: Summary) -> Iterator[str]:
    if summary.circuits:
        yield _table(circuits_table(summary))


def _packages(summary: Summary) -> Iterator[str]:
    if summary.by_package:
        shown, rest = shown_packages(summary, MOST_ROWS)
        table = group_table(shown, "Test system|Distribution|Package")
        is_open = " open" if len(table.rows) <= MOST_OPEN_ROWS else ""
        yield f"<details{is_open}><summary>Show {len(summary.by_package)} rows</summary>"
        yield _table(table, "packages", "Find a package", rest) + "</details>"


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
    # The suite that takes most time is the one that people ask about.
    spent = {curve.suite: curve.seconds.total for curve in summary.curves if curve.seconds}
    suites = list(dict.fromkeys(trend.suite for trend in summary.trends))
    slowest = max(suites, key=lambda suite: spent.get(suite, 0))
    for suite in suites:
        yield f"<details{' open' if suite == slowest else ''}><summary>{escape(suite)}</summary>"
        yield from _trends_of([trend for trend in summary.trends if trend.suite == suite])
        yield "</details>"


def _trends_of(trends: Sequence[Trend]) -> Iterator[str]:
    yield '<div class="pair">'
    for trend in shown_trends(trends, MOST_CHARTS):
        yield f"<figure>{scatter(trend)}<figcaption>{escape(caption_of_fit(trend))}"
        yield "</figcaption></figure>"
    yield "</div>"
    yield _table(trend_table(trend for trend in trends if trend.time == "total"))
    yield "<details><summary>By stage</summary>"
    yield _table(trend_table(trend for trend in trends if trend.time != "total")) + "</details>"


def _coverage(summary: Summary) -> Iterator[str]:
    if not summary.coverage:
        return
    yield _table(coverage_table(summary))
    if summary.uncovered:
        yield f"<details open><summary>{len(summary.uncovered)} tests did not take all</summary>"
        table, rest = cut(missing_table(summary.uncovered))
        yield _table(table, rest=rest) + "</details>"


def _extremes(summary: Summary) -> Iterator[str]:
    for title, outcomes in (
        ("Slowest tests", summary.slowest),
        ("Most complex types", summary.most_complex),
    ):
        if outcomes:
            yield f"<h3>{title}</h3>" + _table(every_table(outcomes))


def _tests(summary: Summary) -> Iterator[str]:
    if summary.outcomes:
        shown, rest = shown_tests(summary, MOST_ROWS)
        yield f"<details><summary>Show {len(shown)} of {len(summary.outcomes)} tests</summary>"
        yield _table(every_table(shown), "tests", "Find tests, such as nav_msgs fail", rest)
        yield "</details>"


def _environment(summary: Summary) -> Iterator[str]:
    for name, lines in sources(summary):
        yield f"<h3>{escape(name)}</h3><pre>{escape(chr(10).join(lines))}</pre>"


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


def _table(table: Table, name: str = "", hint: str = "", rest: str = "") -> str:
    heads = "".join(
        f'<th data-sort class="{"n" if text.endswith("#") else "t"}">{escape(text.rstrip("#"))}'
        "</th>"
        for text in table.headings
    )
    rows = "".join(f"<tr>{''.join(map(_cell, row))}</tr>\n" for row in table.rows)
    found = f'<input type="search" data-table="table-{name}" placeholder="{hint}">' if name else ""
    mark = f' id="table-{name}"' if name else ""
    more = f'<p class="soft">{escape(rest)}</p>' if rest else ""
    return (
        f'{found}<div class="wide"><table{mark}><thead><tr>{heads}</tr></thead>'
        f"<tbody>\n{rows}</tbody></table></div>{more}"
    )


def _cell(cell: Cell) -> str:
    if cell.counts is not None:
        return f'<td data-v="{cell.value}">{counts_bar(cell.counts)}</td>'
    if cell.value is not None:
        kind = f"n {_class(cell.verdict)}".strip()
        return f'<td class="{kind}" data-v="{cell.value:.9g}">{escape(cell.text)}</td>'
    kind = f' class="t {_class(cell.verdict)}"' if cell.verdict else ""
    if len(cell.text) < SHORT:
        # Nothing is gained by breaking it.
        kind = kind or ' class="t"'
    return f"<td{kind}>{escape(cell.text)}</td>"
