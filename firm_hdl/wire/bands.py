"""The bytes of a message as bands: the parts of a picture of its layout, from top to bottom.

Offsets count from the start of the packet up to the first :class:`Note`. After a note and after a
loop, offsets start again from 0.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

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

__all__ = ["Band", "BandCell", "Grid", "Note", "bands"]

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
