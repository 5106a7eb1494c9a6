"""Rows of bytes as a figure: cells in proportion to their bytes, with a label beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from firm_hdl.drawing.svg import Figure

__all__ = ["CHARACTER_WIDTH", "LEFT", "WIDTH", "Cell", "Kind", "Row", "clipped", "draw_rows"]

Kind: TypeAlias = Literal["header", "padding", "length", "field", "data", "loop"]

LEFT = 64
WIDTH = 336
"""Left edge and width of the cells of a row."""

ROW_HEIGHT = 22
INDENT = 18
CHARACTER_WIDTH = 6.7
MOST_INDENTS = 10
MOST_CHARACTERS = 96
MOST_ROWS = 160
"""Rows of a figure; of more, those in the middle are left out."""
_LAST_ROWS = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """Bytes in a row."""

    # From the left edge of the cells.
    x: float
    width: float
    kind: Kind
    text: str = ""  # What the cell shows, as far as there is room.
    title: str = ""  # What the cell is.
    dashed: bool = False  # Whether the number of bytes varies.


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A row: cells with a label, or, without cells, a box with the label."""

    depth: int = 0  # Number of loops around the row.
    place: str = ""  # What stands left of the row, such as an offset.
    label: str = ""
    cells: tuple[Cell, ...] = ()
    kind: Kind = "data"  # Of the box.
    joined: bool = False  # Whether the row continues the one above.


def draw_rows(
    rows: Sequence[Row], label: str, *, heads: Sequence[str] = (), width: float = WIDTH
) -> Figure:
    """Draw rows below each other.

    * `label`: the text for screen readers.
    * `heads`: texts above the cells, at equal distances.
    * `width`: width of the cells.
    """
    figure = Figure(0, 0, label)
    y = 4.0
    for number, head in enumerate(heads):
        figure.text(LEFT + (number + 0.5) * width / len(heads), y + 10, head, "place")
    y += 14 if heads else 0
    right = LEFT + width
    left_out = len(rows) - MOST_ROWS
    shown = list(rows)
    if left_out > 0:
        shown[MOST_ROWS - _LAST_ROWS : -_LAST_ROWS] = [
            Row(label=f"{left_out} more rows are left out", kind="padding")
        ]
    for row in shown:
        top = y + (0 if row.joined else 6)
        depth = min(row.depth, MOST_INDENTS)
        left = LEFT + depth * INDENT
        for level in range(depth):
            figure.box(2 + 5 * level, y, 3, top + ROW_HEIGHT - y, "loop")
        if row.place:
            figure.text(left - 8, top + 15, row.place, "place", "end")
        text = clipped(row.label, MOST_CHARACTERS)
        title = row.label if text != row.label else ""
        at = left + 8.0
        if row.cells:
            at = left + width + 10
            for cell in row.cells:
                _draw_cell(figure, cell, left, top)
        else:
            end = max(width, len(text) * CHARACTER_WIDTH + 16)
            dashed = "" if row.kind == "loop" else " dashed"
            figure.box(left, top, end, ROW_HEIGHT, f"bytes {row.kind}{dashed}", title)
            right = max(right, left + end)
        if text:
            figure.text(at, top + 15, text, "code", "start")
        right = max(right, at + len(text) * CHARACTER_WIDTH)
        y = top + ROW_HEIGHT
    figure.width, figure.height = int(right) + 4, int(y) + 6
    return figure


def _draw_cell(figure: Figure, cell: Cell, left: float, top: float) -> None:
    dashed = " dashed" if cell.dashed else ""
    kind = f"bytes {cell.kind}{dashed}"
    figure.box(left + cell.x, top, cell.width, ROW_HEIGHT, kind, cell.title)
    text = clipped(cell.text, int((cell.width - 4) / CHARACTER_WIDTH))
    if text and (len(text) > 1 or text == cell.text):
        figure.text(left + cell.x + cell.width / 2, top + 15, text, "code")


def clipped(text: str, most: int) -> str:
    """Cut a text to a number of characters."""
    return text if len(text) <= most else f"{text[: max(0, most - 1)]}\N{HORIZONTAL ELLIPSIS}"
