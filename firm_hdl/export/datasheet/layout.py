"""A picture of a message's bytes: eight bytes per row, in wire order.

Libraries for bit fields cannot draw such a picture. Messages have parts whose size varies, and some
have hundreds of equal items. Only the first and the last rows of such items are shown.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.drawing.svg import Figure
from firm_hdl.export.datasheet.rows import WIDTH, Cell, Kind, Row, draw_rows
from firm_hdl.plan.yaml import counted
from firm_hdl.wire import (
    ConstantLength,
    Gap,
    Layout,
    LengthField,
    LoopNode,
    Node,
    RunNode,
    Scalar,
    Trigger,
)

__all__ = ["Band", "BandCell", "Grid", "bands", "layout_figure"]


@dataclass(frozen=True, slots=True, kw_only=True)
class BandCell:
    """The bytes of one value or padding; `at` counts from the start of the grid."""

    at: int
    bytes: int
    kind: Kind
    name: str
    type: str = ""


@dataclass(slots=True, kw_only=True)
class Grid:
    """Bytes in a row."""

    depth: int  # Number of loops around the grid.
    start: int | None  # Offset in the packet; `None` after the first note.
    cells: list[BandCell] = field(default_factory=list)


Band: TypeAlias = "Grid | Row"
"""Bytes; or a text: a part whose size varies, a message without bytes, or the start of a loop."""


def bands(layout: Layout) -> list[Band]:
    """List the bands of a layout."""
    drawing = _Drawing()
    header = layout.rules.header_bytes
    if header:
        drawing.cell("header", header, "encapsulation", f"{header} bytes")
        # Rows start at the end of the header, because alignment counts from there.
        drawing.grid = None
    drawing.nodes(layout.nodes)
    return drawing.bands


@dataclass(slots=True)
class _Drawing:
    bands: list[Band] = field(default_factory=list)
    grid: Grid | None = None
    depth: int = 0
    # Offset in the packet; `None` after the first note.
    at: int | None = 0

    def cell(self, kind: Kind, size: int, name: str, type_: str = "") -> None:
        if self.grid is None:
            self.grid = Grid(depth=self.depth, start=self.at)
            self.bands.append(self.grid)
        cells = self.grid.cells
        at = cells[-1].at + cells[-1].bytes if cells else 0
        cells.append(BandCell(at=at, bytes=size, kind=kind, name=name, type=type_))
        if self.at is not None:
            self.at += size

    def note(self, kind: Kind, text: str) -> None:
        self.bands.append(Row(depth=self.depth, kind=kind, label=text))
        self.grid, self.at = None, None

    def gap(self, gap: Gap) -> None:
        if gap.bytes is None:
            most, align = gap.align - 1, gap.align
            self.note("padding", f"0 to {most} bytes of padding, to a multiple of {align}")
        elif gap.bytes:
            self.cell("padding", gap.bytes, "padding")

    def nodes(self, nodes: tuple[Node, ...]) -> None:
        for node in nodes:
            name = ".".join(node.path)
            match node:
                case Scalar():
                    self.gap(node.gap)
                    self.cell("field", node.type.bytes, name, str(node.type))
                case Trigger():
                    self.note("data", f"{name}: no bytes")
                case RunNode():
                    self.run(node, name)
                case LoopNode():
                    self.loop(node, name)

    def run(self, node: RunNode, name: str) -> None:
        if isinstance(node.length, ConstantLength):
            count = node.length.count
            self.gap(node.item_gap)
            self.cell("field", count * node.item.bytes, name, f"{node.item}[{count}]")
            return
        self.length(node.length, name)
        most = "" if node.length.bound is None else f", at most {node.length.bound}"
        text = f"{name}: length x {node.item}{most}"
        if node.item_gap.bytes is None:
            text += f", aligned to {node.item_gap.align} if there are any"
        elif node.item_gap.bytes:
            text += f", after {node.item_gap.bytes} bytes of padding if there are any"
        self.note("data", text + (", and a NUL that length counts" if node.terminated else ""))

    def length(self, length: LengthField, name: str) -> None:
        self.gap(length.gap)
        self.cell("length", 4, f"{name}.length", "uint32")

    def loop(self, node: LoopNode, name: str) -> None:
        match node.length:
            case LengthField(bound=bound) as length:
                self.length(length, name)
                times = f"length{'' if bound is None else f' (at most {bound})'} times"
            case ConstantLength(count=count):
                times = f"{count} times"
        self.note("loop", f"{name}: {times}")
        self.depth += 1
        self.nodes(node.body)
        self.depth -= 1
        self.grid = None


ROW_BYTES = 8
_BYTE_WIDTH = WIDTH / ROW_BYTES
_MOST_ROWS = 4
"""Rows of a cell; of more, only the first two and the last one are drawn."""


def layout_figure(layout: Layout) -> Figure:
    """Draw a layout."""
    rows = [row for band in bands(layout) for row in _rows(band)]
    heads = [f"+{lane}" for lane in range(ROW_BYTES)]
    return draw_rows(rows, f"Bytes of {layout.message.name}", heads=heads)


def _rows(band: Band) -> Iterator[Row]:
    if isinstance(band, Row):
        yield band
        return
    rows: dict[int, list[BandCell]] = {}
    left_out: dict[int, int] = {}
    for cell in band.cells:
        numbers = range(cell.at // ROW_BYTES, -(-(cell.at + cell.bytes) // ROW_BYTES))
        shown = numbers if len(numbers) <= _MOST_ROWS else (*numbers[:2], numbers[-1])
        if len(shown) < len(numbers):
            left_out[numbers[1]] = len(numbers) - 2
        for number in shown:
            rows.setdefault(number, []).append(cell)
    for index, (number, cells) in enumerate(sorted(rows.items())):
        at = number * ROW_BYTES
        place = f"+{at}" if band.start is None else str(band.start + at)
        named = (c for c in cells if c.at >= at and c.kind != "padding")
        yield Row(
            depth=band.depth,
            place="" if number in left_out else place,
            label=", ".join(f"{cell.name} {cell.type}" for cell in named),
            cells=tuple(_cell(cell, at, left_out.get(number, 0)) for cell in cells),
            joined=index > 0,
        )


def _cell(cell: BandCell, at: int, left_out: int) -> Cell:
    """Return a cell's part of the row that begins with byte `at`."""
    first, end = max(cell.at, at), min(cell.at + cell.bytes, at + ROW_BYTES)
    short = cell.name.rpartition(".")[2] if cell.at >= at else ""
    return Cell(
        x=(first - at) * _BYTE_WIDTH,
        width=(end - first) * _BYTE_WIDTH,
        kind=cell.kind,
        text=f"... {left_out} rows" if left_out else short,
        title=f"{f'{cell.name} {cell.type}'.strip()}, {counted(cell.bytes, 'byte')}",
    )
