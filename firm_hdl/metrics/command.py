"""The output of the command ``metrics``: figures as a table, as CSV, as JSON."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterable
from dataclasses import asdict, fields

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.identity.command import of_each
from firm_hdl.metrics.analysis import Analyses, Metrics
from firm_hdl.model import WIRE_OF, Interface
from firm_hdl.wire import Wire

__all__ = ["FORMATS", "metrics_text", "report"]

_COLUMNS = tuple(item.name for item in fields(Metrics))

# Columns of the table with their headings. The table does not have all figures.
_HEADINGS = {
    "name": "name",
    "depth": "depth",
    "types": "types",
    "leaves": "leaves",
    "fixed_leaves": "fixed",
    "dynamic_leaves": "dynamic",
    "min_bytes": "min",
    "max_bytes": "max",
    "aligned": "aligned",
    "padded": "padded",
    "shifting": "shifting",
    "features": "features",
}


def report(rows: Iterable[Metrics], form: str) -> str:
    """Write figures in one of the formats.

    Parameters
    ----------
    rows : iterable of Metrics
    form : str
        A key of `FORMATS`.
    """
    return FORMATS[form](list(rows))


def _table(rows: list[Metrics]) -> str:
    lines = [[*_HEADINGS.values()], *([_cell(row, name) for name in _HEADINGS] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    text = ""
    for line in lines:
        cells = [
            cell.ljust(width) if name in ("name", "features") else cell.rjust(width)
            for name, cell, width in zip(_HEADINGS, line, widths, strict=True)
        ]
        text += "  ".join(cells).rstrip() + "\n"
    unsized = (f"{row.name} has no sizes: {row.unsized}\n" for row in rows if row.unsized)
    return text + "".join(unsized)


def _cell(row: Metrics, name: str) -> str:
    value = getattr(row, name)
    if isinstance(value, tuple):
        return ",".join(value) or "-"
    return "-" if value is None else str(value)


def _csv(rows: list[Metrics]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for row in rows:
        values = asdict(row) | {"features": " ".join(row.features)}
        # `None` gives an empty cell: the type has no maximum, or no size at all.
        writer.writerow([values[name] for name in _COLUMNS])
    return text.getvalue()


def _json(rows: list[Metrics]) -> str:
    return json.dumps([asdict(row) for row in rows], indent=2) + "\n"


FORMATS: dict[str, Callable[[list[Metrics]], str]] = {"table": _table, "csv": _csv, "json": _json}
"""The writers of figures, by format."""


def metrics_text(
    library: Library,
    names: Iterable[str],
    form: str,
    wire: Wire | None,
) -> tuple[str, DefinitionError | None]:
    """Write the figures of types. A service or an action gives the figures of its messages.

    Parameters
    ----------
    library : Library
    names : iterable of str
    form : str
        A key of `FORMATS`.
    wire : "ros1", "cdr" or None
        `None`: the wire format of the library's dialect.

    Returns
    -------
    tuple of str and DefinitionError or None
        The text, and the errors of the types that are not in it.
    """
    analyses = Analyses(wire or WIRE_OF[library.dialect])
    rows: dict[str, Metrics] = {}

    def analyse(interface: Interface) -> None:
        for message in interface.messages:
            if message.name not in rows:
                rows[message.name] = analyses.metrics(message)

    _, wrong = of_each(library, names, analyse)
    return report(rows.values(), form), wrong
