"""A report as Markdown, for a terminal or a merge request."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from firm_hdl.verify.report.summary import Summary
from firm_hdl.verify.report.tables import Table
from firm_hdl.verify.report.templates import environment

__all__ = ["to_markdown"]

MOST_FAILURES = 20
MOST_NAMES = 50


def to_markdown(summary: Summary) -> str:
    """Write a report as Markdown."""
    found = environment(is_html=False, text=_text, table=_table, block=_block)
    found.globals.update(summary=summary, most={"failures": MOST_FAILURES, "names": MOST_NAMES})
    text = found.get_template("report.md.j2").render()
    return re.sub("\n{3,}", "\n\n", text).strip() + "\n"


def _table(table: Table) -> str:
    if not table.rows:
        return ""
    drawn = {n for n, cell in enumerate(table.rows[0]) if cell.counts is not None}
    kept = [n for n in range(len(table.headings)) if n not in drawn]
    lines = [
        _row(_text(table.headings[n].rstrip("#")) for n in kept),
        _row("---:" if table.headings[n].endswith("#") else "---" for n in kept),
        *(_row(_text(row[n].text) for n in kept) for row in table.rows),
    ]
    return "\n".join([*lines, ""])


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _text(text: str) -> str:
    """Escape text, so that nothing in it is Markdown syntax."""
    return re.sub(r"([\\`*{}\[\]<>#|~]|\b_|_\b)", r"\\\1", " ".join(text.split()))


def _block(texts: Sequence[str]) -> str:
    """Write texts unchanged inside a fence that is longer than any fence in the texts."""
    longest = max((len(found) for text in texts for found in re.findall("`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return "\n".join([fence, *texts, fence, ""])
