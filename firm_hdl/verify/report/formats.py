"""A report in its formats: one page of HTML, Markdown, and JSON.

The page needs no server, no network and no other file. Markdown is for a terminal or a merge
request, and JSON for other programs.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from importlib.resources import files
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined
from markupsafe import Markup

from firm_hdl.verify.report import charts, prose, tables
from firm_hdl.verify.report.charts import counts_bar
from firm_hdl.verify.report.outcomes import NotRun, Outcome, failures_of
from firm_hdl.verify.report.summary import Summary
from firm_hdl.verify.report.tables import Table, TableCell
from firm_hdl.verify.report.verdicts import reason_groups
from firm_hdl.verify.results.records import to_json as record_to_json

__all__ = ["FORMATS", "to_html", "to_json", "to_markdown"]

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
    return page.render(style=_text_of("page.css"), script=_text_of("page.js")).lstrip() + "\n"


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


def _text_of(name: str) -> str:
    """Return the text of a file that is beside this one."""
    return files(__package__ or "").joinpath(name).read_text(encoding="utf-8")


def _environment(*, is_html: bool, **filters: Any) -> Environment:
    """Return a Jinja environment with the functions that templates may use.

    Parameters
    ----------
    is_html : bool
        Whether text is escaped, so that nothing in it is a tag.
    **filters
        Filters by the names that templates have for them.
    """
    found = Environment(
        loader=FunctionLoader(_text_of),
        autoescape=is_html,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.globals.update(
        charts=charts,
        prose=prose,
        tables=tables,
        failures_of=failures_of,
        reason_groups=reason_groups,
    )
    found.filters.update(filters)
    return found
