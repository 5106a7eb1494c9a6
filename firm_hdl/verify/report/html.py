"""A report as one page of HTML that needs no server, no network and no other file."""

from __future__ import annotations

from markupsafe import Markup

from firm_hdl.verify.report.charts import counts_bar
from firm_hdl.verify.report.summary import Summary
from firm_hdl.verify.report.tables import TableCell
from firm_hdl.verify.report.templates import environment, text_of

__all__ = ["to_html"]

MOST_CHARTS = 6
MOST_OPEN_ROWS = 40
MOST_ARTICLES = 20
MOST_NAMES = 50
SHORT = 40


def to_html(summary: Summary) -> str:
    """Write a report as a page."""
    most = {
        "articles": MOST_ARTICLES,
        "charts": MOST_CHARTS,
        "names": MOST_NAMES,
        "open_rows": MOST_OPEN_ROWS,
    }
    # Globals are visible in the macros of the template without being parameters.
    found = environment(is_html=True, cell=_cell)
    found.globals.update(summary=summary, most=most)
    page = found.get_template("page.html.j2")
    return page.render(style=text_of("page.css"), script=text_of("page.js")).lstrip() + "\n"


def _cell(cell: TableCell) -> Markup:
    kind = cell.verdict.replace(" ", "-")
    if cell.counts is not None:
        return Markup('<td data-v="{}">{}</td>').format(cell.value, Markup(counts_bar(cell.counts)))
    if cell.value is not None:
        return Markup('<td class="{}" data-v="{:.9g}">{}</td>').format(
            f"n {kind}".strip(), cell.value, cell.text
        )
    # Short text is not broken into lines.
    if kind or len(cell.text) < SHORT:
        return Markup('<td class="{}">{}</td>').format(f"t {kind}".strip(), cell.text)
    return Markup("<td>{}</td>").format(cell.text)
