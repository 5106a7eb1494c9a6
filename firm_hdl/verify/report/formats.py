"""``firm-hdl report``, and a report in its formats: one page of HTML, Markdown, and JSON.

The page needs no server, no network and no other file. Markdown is for a terminal or a merge
request, and JSON for other programs.
"""

from __future__ import annotations

import argparse
import json
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from jinja2 import Environment
from markupsafe import Markup

from firm_hdl.drawing.document import pages, style
from firm_hdl.errors import UserError
from firm_hdl.files import write_file
from firm_hdl.verify.report import charts, tables
from firm_hdl.verify.report import tables as prose
from firm_hdl.verify.report.charts import counts_bar
from firm_hdl.verify.report.summary import (
    Outcome,
    Summary,
    failures_of,
    reason_groups,
    summarise,
)
from firm_hdl.verify.report.tables import Table, TableCell
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.records import to_json as record_to_json
from firm_hdl.verify.results.verdict import NotRun

__all__ = ["FORMATS", "add_report", "run_report", "write_report"]

_FOLDER = Path(__file__).parent

_MOST_CHARTS = 6
_MOST_OPEN_ROWS = 40
_MOST_ARTICLES = 20
_MOST_NAMES = 50
_SHORT = 40


def to_html(summary: Summary) -> str:
    """Write a report as a page."""
    most = {
        "articles": _MOST_ARTICLES,
        "charts": _MOST_CHARTS,
        "names": _MOST_NAMES,
        "open_rows": _MOST_OPEN_ROWS,
    }
    # Globals are visible in the macros of the template without being parameters.
    found = _environment(is_html=True, cell=_html_cell)
    found.globals.update(summary=summary, most=most)
    page = found.get_template("page.html.j2")
    own, script = (_FOLDER.joinpath(f"page.{end}").read_text("utf-8") for end in ("css", "js"))
    return page.render(style=style("figure", "page") + own, script=script).lstrip() + "\n"


def _html_cell(cell: TableCell) -> Markup:
    kind = cell.verdict.replace(" ", "-")
    if cell.counts is not None:
        return Markup('<td data-v="{}">{}</td>').format(cell.value, Markup(counts_bar(cell.counts)))
    if cell.value is not None:
        return Markup('<td class="{}" data-v="{:.9g}">{}</td>').format(
            f"n {kind}".strip(), cell.value, cell.text
        )
    # Short text is not broken into lines.
    if kind or len(cell.text) < _SHORT:
        return Markup('<td class="{}">{}</td>').format(f"t {kind}".strip(), cell.text)
    return Markup("<td>{}</td>").format(cell.text)


_MOST_FAILURES = 20


def to_markdown(summary: Summary) -> str:
    """Write a report as Markdown."""
    found = _environment(is_html=False, text=_md_text, table=_md_table, block=_md_block)
    found.globals.update(summary=summary, most={"failures": _MOST_FAILURES, "names": _MOST_NAMES})
    text = found.get_template("report.md.j2").render()
    return re.sub("\n{3,}", "\n\n", text).strip() + "\n"


def _md_table(table: Table) -> str:
    if not table.rows:
        return ""
    drawn = {n for n, cell in enumerate(table.rows[0]) if cell.counts is not None}
    kept = [n for n in range(len(table.headings)) if n not in drawn]
    lines = [
        _md_row(_md_text(table.headings[n].rstrip("#")) for n in kept),
        _md_row("---:" if table.headings[n].endswith("#") else "---" for n in kept),
        *(_md_row(_md_text(row[n].text) for n in kept) for row in table.rows),
    ]
    return "\n".join([*lines, ""])


def _md_row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _md_text(text: str) -> str:
    """Escape text, so that nothing in it is Markdown syntax."""
    return re.sub(r"([\\`*{}\[\]<>#|~]|\b_|_\b)", r"\\\1", " ".join(text.split()))


def _md_block(texts: Sequence[str]) -> str:
    """Write texts unchanged inside a fence that is longer than any fence in the texts."""
    longest = max((len(found) for text in texts for found in re.findall("`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return "\n".join([fence, *texts, fence, ""])


_FORMAT = "firm-hdl report 2"


def to_json(summary: Summary) -> str:
    """Write a report as JSON: the fields of `Summary`, and tests with their records."""
    # Each outcome is written once, below, because there may be a hundred thousand of them.
    content: dict[str, Any] = {"format": _FORMAT, **asdict(replace(summary, outcomes=()))}
    content["verdict"] = summary.verdict
    del content["outcomes"]
    for name in ("failed", "not_run", "not_judged", "uncovered", "slowest", "most_complex"):
        content[name] = [outcome.test.key for outcome in getattr(summary, name)]
    text = _written(content, indent=1).removesuffix("\n}")
    # One line for each test, which is also much faster to write than indented JSON.
    tests = ",\n".join(f"  {_written(_json_outcome(outcome))}" for outcome in summary.outcomes)
    return f'{text},\n "outcomes": [\n{tests}\n ]\n}}\n'


def _written(content: object, indent: int | None = None) -> str:
    return json.dumps(content, indent=indent, ensure_ascii=False, allow_nan=False)


def _json_outcome(outcome: Outcome) -> dict[str, Any]:
    found: dict[str, Any] = {
        "test": asdict(outcome.test),
        "verdict": outcome.verdict.name,
        "details": () if isinstance(outcome.verdict, NotRun) else outcome.verdict.details,
        "record": None,
        "circuit_of": outcome.circuit_of,
        "key": outcome.test.key,
    }
    if outcome.record is not None:
        found["record"] = record_to_json(outcome.record)
        del found["record"]["test"]
    return found


FORMATS: Mapping[str, Callable[[Summary], str]] = {
    "html": to_html,
    "md": to_markdown,
    "json": to_json,
}
"""Functions that write reports, by the suffixes of file names."""


def _environment(*, is_html: bool, **filters: Any) -> Environment:
    """Return a Jinja environment with the functions that templates may use.

    * `is_html`: whether text is escaped, so that nothing in it is a tag.
    * `**filters`: filters by the names that templates have for them.
    """
    found = pages(_FOLDER)
    found.autoescape = is_html
    found.globals.update(
        charts=charts,
        prose=prose,
        tables=tables,
        failures_of=failures_of,
        reason_groups=reason_groups,
    )
    found.filters.update(filters)
    return found


def add_report(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl report``."""
    parser.add_argument(
        "results", nargs="+", metavar="RESULTS", help="files that firm-hdl verify --results wrote"
    )
    parser.add_argument("--out", metavar="FILE", help="file to write; default: standard output")
    parser.add_argument(
        "--format", choices=list(FORMATS), help="default: that of the file's name, or md"
    )
    parser.add_argument("--title", default="Verification of firm-hdl", help="default: %(default)s")
    parser.set_defaults(run=run_report)


def run_report(given: argparse.Namespace) -> None:
    """Run ``firm-hdl report``.

    Raises `UserError` if a file is not one of results.
    """
    form = given.format
    if given.out is None:
        print(_made(given.results, form or "md", given.title), end="")
        return
    write_report(given.results, given.out, form, given.title)
    print(f"wrote   {given.out}")


def write_report(
    results: Sequence[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    form: str | None = None,
    title: str = "Verification of firm-hdl",
) -> None:
    """Write a report of files of results.

    * `form`: a key of `FORMATS`; `None`: the suffix of `out`.

    Raises `UserError` if a file is not one of results, or if the suffix of `out` is not a key of
    `FORMATS`.
    """
    path = Path(out)
    form = form or path.suffix.lstrip(".").lower()
    if form not in FORMATS:
        ends = ", ".join(f".{name}" for name in FORMATS)
        raise UserError(f"'{out}': the name of a report must end in {ends}, or give --format")
    for each in results:
        if path.exists() and path.samefile(each):
            raise UserError(f"'{out}' is one of the results; the report needs another name")
    text = _made(results, form, title)
    write_file(path, text)


def _made(results: Sequence[str | os.PathLike[str]], form: str, title: str) -> str:
    found = {str(path): read_results(path) for path in results}
    return FORMATS[form](summarise(found, title))
