"""A picture of a message's bytes, as SVG: eight bytes per row, in wire order.

Libraries for bit fields cannot draw such a picture. Messages have parts whose size varies, and some
have hundreds of equal items. Only the first and the last rows of such items are shown.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, TypeAlias
from xml.sax.saxutils import escape

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

__all__ = ["Band", "BandCell", "Grid", "Note", "bands", "to_svg"]

Kind: TypeAlias = Literal["header", "padding", "length", "field"]


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
    """Bytes in a row.

    Attributes
    ----------
    depth : int
        Number of loops around the grid.
    start : int or None
        Offset in the packet; `None` after the first note.
    cells : list of BandCell
    """

    depth: int
    start: int | None
    cells: list[BandCell] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class Note:
    """A line of text: a part whose size varies, a message without bytes, or the start of a loop.

    Attributes
    ----------
    kind : "data", "padding" or "loop"
    """

    depth: int
    kind: Literal["data", "padding", "loop"]
    text: str


Band: TypeAlias = "Grid | Note"


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

    def note(self, kind: Literal["data", "padding", "loop"], text: str) -> None:
        self.bands.append(Note(depth=self.depth, kind=kind, text=text))
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
BYTE_WIDTH = 42
ROW_HEIGHT = 22
LEFT = 64
INDENT = 18
CHARACTER_WIDTH = 6.7
GRID_WIDTH = ROW_BYTES * BYTE_WIDTH

COLOURS = {
    "header": "#d9d9d9",
    "padding": "#f4f4f4",
    "length": "#fbe3b4",
    "field": "#cfe2f7",
    "data": "#d8efd3",
    "loop": "#eadcf5",
}
STYLE = (
    "text{font-family:monospace;font-size:11px;fill:#222}"
    ".o{fill:#777;text-anchor:end}.h{font-weight:bold;font-size:13px}.c{text-anchor:middle}"
    "rect{stroke:#555;stroke-width:1}"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Piece:
    """A cell's part of a row, or the mark for rows of a cell that are left out."""

    cell: BandCell
    row: int
    first: int
    bytes: int
    starts: bool
    left_out: int


def to_svg(layout: Layout, title: str) -> str:
    """Draw a layout."""
    shapes = [f'<text class="h" x="8" y="20">{escape(title)}</text>']
    y = 34
    for lane in range(ROW_BYTES):
        x = LEFT + lane * BYTE_WIDTH + BYTE_WIDTH // 2
        shapes.append(f'<text class="o c" x="{x}" y="{y + 10}">+{lane}</text>')
    y += 16
    right = int(len(title) * CHARACTER_WIDTH * 1.2)
    for band in bands(layout):
        drawn, height, edge = _draw(band, y)
        shapes += drawn
        right = max(right, edge)
        y += height + 6
    width = right + 12
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {y}" '
        f'width="{width}" height="{y}">\n'
        f"<style>{STYLE}</style>\n"
        f'<rect x="0" y="0" width="{width}" height="{y}" style="fill:#fff;stroke:none"/>\n'
        + "\n".join(shapes)
        + "\n</svg>\n"
    )


def _draw(band: Band, y: int) -> tuple[list[str], int, int]:
    """Return shapes, their height, and their right edge."""
    left = LEFT + band.depth * INDENT
    drawn = _note(band, left, y) if isinstance(band, Note) else _grid(band, left, y)
    shapes, height, right = drawn
    rails = [
        f'<rect x="{6 + 8 * level}" y="{y - 6}" width="5" height="{height + 6}" '
        f'style="fill:{COLOURS["loop"]};stroke:none"/>'
        for level in range(band.depth)
    ]
    return rails + shapes, height, right


def _note(note: Note, left: int, y: int) -> tuple[list[str], int, int]:
    dashes = "" if note.kind == "loop" else ' stroke-dasharray="5 3"'
    width = max(GRID_WIDTH, int(len(note.text) * CHARACTER_WIDTH) + 16)
    shapes = [
        f'<rect x="{left}" y="{y}" width="{width}" height="{ROW_HEIGHT}" '
        f'fill="{COLOURS[note.kind]}"{dashes}/>',
        f'<text x="{left + 8}" y="{y + 15}">{escape(note.text)}</text>',
    ]
    return shapes, ROW_HEIGHT, left + width


def _grid(grid: Grid, left: int, y: int) -> tuple[list[str], int, int]:
    rows: dict[int, list[_Piece]] = {}
    for cell in grid.cells:
        for piece in _pieces(cell):
            rows.setdefault(piece.row, []).append(piece)
    shapes = []
    right = x = left + GRID_WIDTH + 10
    for line, (row, pieces) in enumerate(sorted(rows.items())):
        top = y + line * ROW_HEIGHT
        offset = row * ROW_BYTES
        text = str(grid.start + offset) if grid.start is not None else f"+{offset}"
        if not pieces[0].left_out:
            shapes.append(f'<text class="o" x="{left - 8}" y="{top + 15}">{text}</text>')
        for piece in pieces:
            shapes += _cell(piece, left, top)
        named = (p.cell for p in pieces if p.starts and p.cell.kind != "padding")
        label = ", ".join(f"{cell.name} {cell.type}" for cell in named)
        if label:
            shapes.append(f'<text x="{x}" y="{top + 15}">{escape(label)}</text>')
            right = max(right, x + int(len(label) * CHARACTER_WIDTH))
    return shapes, len(rows) * ROW_HEIGHT, right


def _pieces(cell: BandCell) -> Iterator[_Piece]:
    """Cut a cell into rows; if there are many, keep only the first and the last rows."""
    end = cell.at + cell.bytes
    rows = list(range(cell.at // ROW_BYTES, -(-end // ROW_BYTES)))
    shown = rows if len(rows) <= 4 else [rows[0], rows[1], rows[-1]]
    for row in shown:
        first = max(cell.at, row * ROW_BYTES)
        last = min(end, (row + 1) * ROW_BYTES)
        left_out = len(rows) - 2 if len(shown) < len(rows) and row == rows[1] else 0
        yield _Piece(
            cell=cell,
            row=row,
            first=first % ROW_BYTES,
            bytes=last - first,
            starts=row == rows[0],
            left_out=left_out,
        )


def _cell(piece: _Piece, left: int, top: int) -> Iterator[str]:
    cell = piece.cell
    x, width = left + piece.first * BYTE_WIDTH, piece.bytes * BYTE_WIDTH
    short = cell.name.rpartition(".")[2]
    text = f"... {piece.left_out} rows" if piece.left_out else short if piece.starts else ""
    room = int((width - 6) / CHARACTER_WIDTH)
    if len(text) > room:
        text = text[: room - 1] + "~"
    yield (
        f'<rect x="{x}" y="{top}" width="{width}" height="{ROW_HEIGHT}" '
        f'fill="{COLOURS[cell.kind]}">'
        f"<title>{escape(f'{cell.name} {cell.type}'.strip())}, {cell.bytes} bytes</title></rect>"
    )
    if text:
        yield f'<text class="c" x="{x + width // 2}" y="{top + 15}">{escape(text)}</text>'
