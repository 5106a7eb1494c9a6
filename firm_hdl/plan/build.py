"""Build a plan from a layout and a bus width.

The layout is flattened into segments: bytes in a row whose map is static. A segment ends where a
length decides what follows, where a loop starts or ends, or where the padding differs from packet
to packet. Segments are cut into steps (see :mod:`firm_hdl.plan.cut`). The last word of a run is its
rest: the step after the run takes it together with its own bytes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

from firm_hdl.model import Primitive
from firm_hdl.plan.cut import split, step_sizes
from firm_hdl.plan.limits import (
    DEFAULT_MAX_MESSAGE_BYTES,
    charges_of,
    check_bus_bytes,
    check_max_message_bytes,
    most_items,
)
from firm_hdl.plan.tree import (
    Charge,
    Constant,
    Count,
    Fixed,
    Item,
    Leaf,
    LeafKind,
    Length,
    Loop,
    Pad,
    Part,
    Plan,
    Run,
    Slice,
    Step,
)
from firm_hdl.wire import (
    ConstantLength,
    Gap,
    Layout,
    LengthField,
    LoopNode,
    Node,
    Path,
    RunNode,
    Scalar,
    Trigger,
    walk,
)
from firm_hdl.wire.alignment import LENGTH, OCTET

__all__ = ["build_plan"]


def build_plan(
    layout: Layout,
    *,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
) -> Plan:
    """Plan the converters of a layout.

    Parameters
    ----------
    layout : Layout
    bus_bytes : int
        Width of the packet stream: 1, 2, 4, 8, 16, 32 or 64 bytes.
    max_message_bytes : int
        A packet whose lengths promise more is an error; at most 2**32 - 1.

    Raises
    ------
    TypeError
        If a parameter is not an integer.
    ValueError
        If a parameter is out of range, or no message of the type fits `max_message_bytes`.
    """
    check_bus_bytes(bus_bytes)
    check_max_message_bytes(layout, max_message_bytes)
    has_lengths = any(
        isinstance(node, RunNode | LoopNode) and isinstance(node.length, LengthField)
        for node in walk(layout.nodes)
    )
    charges = charges_of(layout, max_message_bytes)
    builder = _Builder(layout, bus_bytes, max_message_bytes, has_lengths, charges)
    items = builder.build()
    return Plan(
        message=layout.message.name,
        wire=layout.rules.wire,
        bus_bytes=bus_bytes,
        max_message_bytes=max_message_bytes,
        leaves=tuple(builder.leaves),
        items=items,
    )


@dataclass(slots=True)
class _Builder:
    """The state of planning: the leaves and items so far, and the open segment."""

    # As for `build_plan`.
    layout: Layout
    bus_bytes: int
    max_message_bytes: int
    has_lengths: bool  # Whether the message has any length.
    charges: dict[Path, Charge]  # What lengths claim, by the path of the string or sequence.
    leaves: list[Leaf] = field(default_factory=list)  # In wire order.
    # The items of the message so far, and those of the body of each open loop.
    open: list[list[Item]] = field(default_factory=lambda: [[]])
    segment: list[Slice] = field(default_factory=list)  # Values that have not been cut into steps.
    # Alignment of the segment's first step that the circuit computes; 1: no such alignment.
    segment_align: int = 1
    rest: int | None = None  # The leaf of items whose rest the next step takes.

    def build(self) -> tuple[Item, ...]:
        rules = self.layout.rules
        if rules.header_bytes:
            self.segment.append(Fixed(data=rules.encapsulation, check=True))
            self.segment.append(Fixed(data=bytes(rules.option_bytes), check=False))
        self.nodes(self.layout.nodes)
        self.flush()
        self.flush_rest()
        return tuple(self.open[0])

    def add(self, item: Item) -> None:
        self.open[-1].append(item)

    # Nodes to segments.

    def nodes(self, nodes: tuple[Node, ...]) -> None:
        for node in nodes:
            match node:
                case Scalar():
                    self.gap(node.gap)
                    self.value(self.leaf(node.path, "scalar", node.type), node.type.bytes)
                case Trigger():
                    self.value(self.leaf(node.path, "trigger", OCTET), 0)
                case RunNode(length=LengthField() as length):
                    self.counted_run(node, length)
                case RunNode(length=ConstantLength(count=count)):
                    self.array(node, count)
                case LoopNode():
                    self.loop(node)

    def leaf(self, path: Path, kind: LeafKind, item: Primitive, lanes: int = 1) -> int:
        if kind != "scalar":
            path = (*path, kind)
        name = "bool" if kind == "trigger" else item.name
        signed = item.signed and item.kind == "int"
        self.leaves.append(Leaf(path=path, kind=kind, type=name, signed=signed, lanes=lanes))
        return len(self.leaves) - 1

    def gap(self, gap: Gap) -> None:
        """Add padding to the segment. If the circuit computes it, a new segment starts."""
        if gap.bytes is None:
            self.flush()
            self.segment_align = gap.align
        elif gap.bytes:
            self.segment.append(Pad(bytes=gap.bytes))

    def value(self, leaf: int, size: int, last: Literal["always", "in loop"] | None = None) -> None:
        self.segment.append(Part(bytes=size, leaf=leaf, first=0, size=size, last=last))

    def lanes(self, item: Primitive) -> int:
        return max(1, self.bus_bytes // item.bytes)

    def length(self, node: RunNode | LoopNode, length: LengthField) -> Length:
        """Add a length to the segment, and return the count that it gives."""
        self.gap(length.gap)
        leaf = self.leaf(node.path, "length", LENGTH)
        self.value(leaf, LENGTH.bytes)
        most = most_items(self.layout, node, self.max_message_bytes)
        limit = most if length.bound is None else min(length.bound, most)
        return Length(
            leaf=leaf,
            limit=limit,
            nul=isinstance(node, RunNode) and node.terminated,
            charge=self.charges.get(node.path),
        )

    def counted_run(self, node: RunNode, length: LengthField) -> None:
        """Plan a string or a sequence of primitives: a length, then a run or a loop."""
        count = self.length(node, length)
        items = self.leaf(node.path, "items", node.item, self.lanes(node.item))
        if node.item.bytes > self.bus_bytes:
            self.item_loop(node, items, count)
        else:
            # The segment ends with the length, so some step takes the rest of an earlier run here.
            self.flush()
            # Even padding whose size is known belongs to the run: an empty run does not have it.
            align = node.item_gap.align if node.item_gap.bytes != 0 else 1
            self.add(Run(leaf=items, count=count, align=align))
            self.rest = items

    def array(self, node: RunNode, count: int) -> None:
        """Plan an array of primitives: values of a segment, a run, or a loop."""
        items = self.leaf(node.path, "items", node.item, self.lanes(node.item))
        size = node.item.bytes
        if size > self.bus_bytes and count > 1:
            self.item_loop(node, items, Constant(count))
            return
        self.gap(node.item_gap)
        lanes = self.lanes(node.item)
        full, tail = divmod(count, lanes)
        if count <= 2 * lanes:
            # One or two transfers are as static as other values, and share steps with them.
            remaining = count
            if remaining > lanes:
                self.value(items, lanes * size)
                remaining -= lanes
            self.value(items, remaining * size, "always")
            return
        # The order counts: `flush` gives the alignment of an open segment to its first step, so
        # what `take_align` finds afterwards is that of the items, and 1 if padding is in the
        # segment.
        self.flush()
        self.flush_rest()
        words, align = Constant(full * lanes), self.take_align()
        self.add(Run(leaf=items, count=words, align=align, has_tail=tail > 0))
        if tail:
            self.value(items, tail * size, "always")

    def item_loop(self, node: RunNode, items: int, count: Count) -> None:
        """Plan items wider than the bus: a loop over single items, some steps each."""
        self.enter_loop()
        # Only the first item has padding, but the loop may align each item, as later items are
        # aligned already. The gap of the layout is that of the first item, so it cannot be static.
        if node.item_gap.bytes is None or node.item_gap.bytes:
            self.segment_align = node.item_gap.align
        self.value(items, node.item.bytes, "in loop")
        self.leave_loop(count)

    def loop(self, node: LoopNode) -> None:
        match node.length:
            case LengthField() as length:
                count: Count = self.length(node, length)
            case ConstantLength(count=number):
                count = Constant(number)
        self.enter_loop()
        self.nodes(node.body)
        self.leave_loop(count)

    def enter_loop(self) -> None:
        self.flush(before_loop=True)
        # The body's first step is also reached from the body's end, where no such rest is left.
        self.flush_rest()
        self.open.append([])

    def leave_loop(self, count: Count) -> None:
        """End the body of the innermost loop."""
        self.flush()
        self.join_rest()
        body = tuple(self.open.pop())
        self.add(Loop(count=count, body=body))

    def join_rest(self) -> None:
        """Give the rest of a body's last run to the body's first step, or to a step of its own."""
        if self.rest is None:
            return
        joined = self.joined(self.open[-1], self.rest)
        if joined is None:
            self.flush_rest()
        else:
            # The step after the loop takes the rest of the last element.
            self.open[-1] = list(joined)

    def joined(self, items: Sequence[Item], rest: int) -> tuple[Item, ...] | None:
        """Return items whose first step takes a rest; `None` if this step cannot."""
        # The body of a loop over strings. Its first step is reached from before the loop, where the
        # rest has 0 items, and from the element before, whose rest it takes:
        #
        #   --> | rest, then length | words of the run | --+
        #       ^------------------------------------------+
        first: Item | None = items[0]
        match first:
            # Its count is constant, as a length would be in a step before it. So it has an element,
            # and that element takes the rest.
            case Loop():
                body = self.joined(first.body, rest)
                first = None if body is None else replace(first, body=body)
            # A step has room for a rest and one bus word.
            case Step() if first.bytes <= self.bus_bytes and first.rest in (None, rest):
                first = replace(first, rest=rest)
            case _:
                first = None
        return None if first is None else (first, *items[1:])

    # Segments to steps.

    def take_align(self) -> int:
        """Return the alignment of the next step, and reset it for the steps after that."""
        align, self.segment_align = self.segment_align, 1
        return align

    def flush_rest(self) -> None:
        """Take the rest of a run in a step of its own."""
        if self.rest is not None:
            self.add(Step(rest=self.rest))
            self.rest = None

    def flush(self, *, before_loop: bool = False) -> None:
        """Cut the segment into steps."""
        if not self.segment:
            return
        is_first = self.open == [[]]  # The segment starts the packet.
        # A short last step would cost a cycle in each element, before a loop, or in short packets.
        may_be_wide = len(self.open) > 1 or before_loop or not self.has_lengths
        if is_first:
            may_be_wide |= self.layout.least_bytes <= 16 * self.bus_bytes
        sizes = step_sizes(
            self.segment,
            self.bus_bytes,
            at_start=is_first,
            may_be_wide=may_be_wide,
            has_rest=self.rest is not None,
        )
        align = self.take_align()
        for index, slices in enumerate(split(self.segment, sizes)):
            self.add(Step(rest=self.rest, align=align if index == 0 else 1, slices=slices))
            self.rest = None
        self.segment = []
