"""A picture of a plan: its steps with the bytes that each takes, its runs, and its loops."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from firm_hdl.drawing.svg import Figure
from firm_hdl.export.datasheet.rows import WIDTH, Cell, Kind, Row, draw_rows
from firm_hdl.plan import Count, Fixed, Item, Leaf, Loop, Pad, Part, Plan, Run, Slice, Step
from firm_hdl.plan.tree import numbered
from firm_hdl.plan.yaml import counted

__all__ = ["plan_figure"]

_REST_WIDTH, _ALIGN_WIDTH = 60, 40
"""Widths of the cells of a rest, and of padding whose size varies."""

_KINDS: dict[str, Kind] = {"length": "length", "items": "data"}


def plan_figure(plan: Plan) -> Figure:
    """Draw a plan."""
    rows = _Rows(plan)
    return draw_rows(
        [*rows.block(plan.items, 0, 0)], f"Plan of {plan.message}", width=rows.start + WIDTH
    )


class _Rows:
    def __init__(self, plan: Plan):
        self.leaves = plan.leaves
        steps = [step for step in plan.steps if isinstance(step, Step)]
        most = max((step.bytes for step in steps), default=0)
        self.byte_width = WIDTH / max(most, plan.bus_bytes)
        # What varies comes first, in columns of its own.
        self.rest = _REST_WIDTH * any(step.rest is not None for step in steps)
        self.start = self.rest + _ALIGN_WIDTH * any(step.align > 1 for step in steps)

    def block(self, items: Sequence[Item], first: int, depth: int) -> Iterator[Row]:
        for number, item in numbered(items, first):
            match item:
                case Step():
                    label = ", ".join(self.labels(item)) or "no bytes"
                    cells = tuple(self.cells(item))
                    yield Row(depth=depth, place=str(number), label=label, cells=cells)
                case Run():
                    label = f"{self.leaves[item.leaf]}: one bus word per cycle, "
                    label += f"{self.count(item.count, 'item')}{_aligned(item.align)}"
                    yield Row(depth=depth, place=str(number), label=label)
                case Loop():
                    label = f"loop: {self.count(item.count, 'time')}"
                    yield Row(depth=depth, label=label, kind="loop")
                    yield from self.block(item.body, number, depth + 1)

    def count(self, count: Count, noun: str) -> str:
        leaf = getattr(count, "leaf", None)
        if leaf is None:
            return counted(count.most, noun)
        nul = " and a NUL" if count.nul else ""
        return f"{self.leaves[leaf]} {noun}s{nul}, at most {count.most:,}"

    def cells(self, step: Step) -> Iterator[Cell]:
        if step.rest is not None:
            title = f"rest of {self.leaves[step.rest]}: at most one bus word"
            yield Cell(x=0, width=self.rest, kind="data", text="rest", title=title, dashed=True)
        if step.align > 1:
            title = f"padding up to a multiple of {step.align} bytes"
            width = self.start - self.rest
            text = f"to {step.align}"
            yield Cell(
                x=self.rest, width=width, kind="padding", text=text, title=title, dashed=True
            )
        for at, item in step.places:
            if item.bytes:
                kind, text, title = self.slice(item)
                yield Cell(
                    x=self.start + at * self.byte_width,
                    width=item.bytes * self.byte_width,
                    kind=kind,
                    text=text,
                    title=f"{title}, {counted(item.bytes, 'byte')}",
                )

    def slice(self, item: Slice) -> tuple[Kind, str, str]:
        match item:
            case Pad():
                return "padding", "", "padding"
            case Fixed():
                what = "checked" if item.check else "ignored"
                return "header", item.data.hex(" "), f"{item.data.hex(' ')}, {what}"
            case Part():
                leaf = self.leaves[item.leaf]
                return _KINDS.get(leaf.kind, "field"), _short(leaf), _part(leaf, item)

    def labels(self, step: Step) -> Iterator[str]:
        if step.rest is not None:
            yield f"rest of {self.leaves[step.rest]}"
        for part in step.parts:
            yield _part(self.leaves[part.leaf], part)


def _short(leaf: Leaf) -> str:
    name = leaf.path[-1]
    return leaf.path[-2] if name == "items" and len(leaf.path) > 1 else name


def _part(leaf: Leaf, part: Part) -> str:
    if part.bytes == part.size:
        return str(leaf)
    return f"{leaf} bytes {part.first}..{part.first + part.bytes - 1} of {part.size}"


def _aligned(align: int) -> str:
    return f", from a multiple of {align} bytes" if align > 1 else ""
