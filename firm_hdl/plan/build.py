"""Build a plan from a layout and a bus width.

The layout is flattened into segments: bytes in a row whose map is static. A segment ends where a
length decides what follows, where a loop starts or ends, or where the padding differs from packet
to packet. Segments are cut into steps (see :mod:`firm_hdl.plan.cut`). The last word of a run is its
rest: the step after the run takes it together with its own bytes.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from firm_hdl.model import Primitive
from firm_hdl.plan.cut import split, step_sizes
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    ArrayEnd,
    Begin,
    BeginLoop,
    BeginRun,
    Claim,
    Fixed,
    Jump,
    Leaf,
    LeafKind,
    LoopEnd,
    MapStep,
    Pad,
    Part,
    Plan,
    Run,
    RunStep,
    Slice,
    Step,
)
from firm_hdl.plan.limits import (
    DEFAULT_MAX_MESSAGE_BYTES,
    check_bus_bytes,
    check_max_message_bytes,
    claims_of,
    most_items,
)
from firm_hdl.plan.link import END, NOWHERE, BodyEnd, BodyStart, Load, Mark, link
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
    claims = claims_of(layout, max_message_bytes)
    builder = _Builder(layout, bus_bytes, max_message_bytes, has_lengths, claims)
    start, steps = builder.build()
    return Plan(
        message=layout.message.name,
        wire=layout.rules.wire,
        bus_bytes=bus_bytes,
        max_message_bytes=max_message_bytes,
        header_bytes=layout.rules.header_bytes,
        max_trailing_bytes=layout.rules.max_trailing_bytes,
        leaves=tuple(builder.leaves),
        runs=tuple(builder.runs),
        levels=builder.levels,
        start=start,
        steps=steps,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Count:
    """A number of elements that a length decides: its leaf, its largest legal value, its claim."""

    length: int
    limit: int
    claim: Claim | None


@dataclass(slots=True)
class _Builder:
    """The state of planning: the program so far, and the open segment.

    Attributes
    ----------
    layout, bus_bytes, max_message_bytes
        As for :func:`build_plan`.
    has_lengths : bool
        Whether the message has any length.
    claims : dict of Path to Claim
        What lengths claim, by the path of the string or sequence.
    leaves, runs : list
        In wire order.
    levels : int
        Number of loop counters.
    program : list of Step or Mark
        In wire order. Steps get their exits and bodies at the end, from `link`.
    segment : list of Slice
        Values that have not been cut into steps.
    segment_align : int
        Alignment of the segment's first step that the circuit computes; 1: no such alignment.
    rest : int or None
        The run whose rest the next step takes.
    depth : int
        Number of open loops.
    """

    layout: Layout
    bus_bytes: int
    max_message_bytes: int
    has_lengths: bool
    claims: dict[Path, Claim]
    leaves: list[Leaf] = field(default_factory=list)
    runs: list[Run] = field(default_factory=list)
    levels: int = 0
    program: list[Step | Mark] = field(default_factory=list)
    segment: list[Slice] = field(default_factory=list)
    segment_align: int = 1
    rest: int | None = None
    depth: int = 0

    def build(self) -> tuple[Jump, tuple[Step, ...]]:
        """Return the jump to the first step, and all steps."""
        rules = self.layout.rules
        if rules.header_bytes:
            self.segment.append(Fixed(at=0, data=rules.encapsulation, check=True))
            options = bytes(rules.option_bytes)
            self.segment.append(Fixed(at=len(rules.encapsulation), data=options, check=False))
        self.nodes(self.layout.nodes)
        self.flush()
        self.flush_rest()
        return link(self.program)

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

    @property
    def segment_bytes(self) -> int:
        return self.segment[-1].at + self.segment[-1].bytes if self.segment else 0

    def gap(self, gap: Gap) -> None:
        """Add padding to the segment. If the circuit computes it, a new segment starts."""
        if gap.bytes is None:
            self.flush()
            self.segment_align = gap.align
        elif gap.bytes:
            self.segment.append(Pad(at=self.segment_bytes, bytes=gap.bytes))

    def value(self, leaf: int, size: int, end: ArrayEnd | LoopEnd | None = None) -> None:
        at = self.segment_bytes
        self.segment.append(Part(at=at, bytes=size, leaf=leaf, first=0, size=size, end=end))

    def lanes(self, item: Primitive) -> int:
        return max(1, self.bus_bytes // item.bytes)

    def length(self, node: RunNode | LoopNode, length: LengthField) -> _Count:
        """Add a length to the segment; return its leaf, limit and claim."""
        self.gap(length.gap)
        leaf = self.leaf(node.path, "length", LENGTH)
        self.value(leaf, LENGTH.bytes)
        most = most_items(self.layout, node, self.max_message_bytes)
        limit = most if length.bound is None else min(length.bound, most)
        return _Count(length=leaf, limit=limit, claim=self.claims.get(node.path))

    def counted_run(self, node: RunNode, length: LengthField) -> None:
        """Plan a string or a sequence of primitives: a length, then a run or a loop."""
        count = self.length(node, length)
        items = self.leaf(node.path, "items", node.item, self.lanes(node.item))
        if node.item.bytes > self.bus_bytes:
            self.item_loop(node, items, count)
        else:
            run = self.new_run(items, terminated=node.terminated)
            align = node.item_gap.align if node.item_gap.bytes != 0 else 1
            leaf, limit, claim = count.length, count.limit, count.claim
            self.flush(
                BeginRun(length=leaf, limit=limit, run=run, align=align, claim=claim, body=END)
            )
            self.program.append(RunStep(run=run, exits=NOWHERE))
            self.rest = run

    def array(self, node: RunNode, count: int) -> None:
        """Plan an array of primitives: values of a segment, a run, or a loop."""
        items = self.leaf(node.path, "items", node.item, self.lanes(node.item))
        size = node.item.bytes
        if size > self.bus_bytes and count > 1:
            self.item_loop(node, items, count)
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
            self.value(items, remaining * size, ArrayEnd())
            return
        self.flush()
        self.flush_rest()
        run = self.new_run(items, counted=False, last=not tail)
        self.program.append(Load(counter=RUN_COUNTER, count=full * lanes))
        self.program.append(RunStep(align=self.take_align(), run=run, exits=NOWHERE))
        if tail:
            self.value(items, tail * size, ArrayEnd())

    def new_run(
        self, items: int, *, counted: bool = True, terminated: bool = False, last: bool = True
    ) -> int:
        self.runs.append(Run(items=items, counted=counted, terminated=terminated, last=last))
        return len(self.runs) - 1

    def item_loop(self, node: RunNode, items: int, count: int | _Count) -> None:
        """Plan items wider than the bus: a loop over single items, some steps each."""
        level = self.enter_loop(count)
        # Only the first item has padding, but the loop may align each item, as later items are
        # aligned already. The gap of the layout is that of the first item, so it cannot be static.
        if node.item_gap.bytes is None or node.item_gap.bytes:
            self.segment_align = node.item_gap.align
        self.value(items, node.item.bytes, LoopEnd(level=level))
        self.leave_loop()

    def loop(self, node: LoopNode) -> None:
        match node.length:
            case LengthField() as length:
                self.enter_loop(self.length(node, length))
            case ConstantLength(count=count):
                self.enter_loop(count)
        self.nodes(node.body)
        self.leave_loop()

    def enter_loop(self, count: int | _Count) -> int:
        level = self.depth
        self.depth += 1
        self.levels = max(self.levels, self.depth)
        if isinstance(count, int):
            self.flush()
            # The body's first step is also reached from the body's end, where no such rest is left.
            self.flush_rest()
            self.program.append(Load(counter=level, count=count))
        else:
            leaf, limit, claim = count.length, count.limit, count.claim
            self.flush(BeginLoop(length=leaf, limit=limit, level=level, claim=claim, body=END))
        self.program.append(BodyStart(level=level))
        return level

    def leave_loop(self) -> None:
        """End the body of the innermost loop."""
        self.flush()
        self.depth -= 1
        self.join_rest()
        self.program.append(BodyEnd(level=self.depth))

    def join_rest(self) -> None:
        """Give the rest of a body's last run to the body's first step, or to a step of its own."""
        if self.rest is None:
            return
        place = self.body_start(self.depth)
        first = self.program[place]
        # A step has room for a rest and one bus word.
        if (
            isinstance(first, MapStep)
            and first.bytes <= self.bus_bytes
            and first.rest in (None, self.rest)
        ):
            self.program[place] = replace(first, rest=self.rest)
        else:
            self.flush_rest()

    def body_start(self, level: int) -> int:
        """Return the place of the first step of the body of the innermost open loop."""
        place = len(self.program) - 1
        while self.program[place] != BodyStart(level=level):
            place -= 1
        while isinstance(self.program[place], Mark):
            place += 1
        return place

    # Segments to steps.

    def take_align(self) -> int:
        """Return the alignment of the next step, and reset it for the steps after that."""
        align, self.segment_align = self.segment_align, 1
        return align

    def flush_rest(self) -> None:
        """Take the rest of a run in a step of its own."""
        if self.rest is not None:
            self.program.append(MapStep(rest=self.rest, exits=NOWHERE))
            self.rest = None

    def flush(self, begin: Begin | None = None) -> None:
        """Cut the segment into steps. The last step starts `begin`."""
        if not self.segment:
            assert begin is None
            return
        # A short last step would cost a cycle in each iteration, or in each short packet.
        may_be_wide = self.depth > 0 or not self.has_lengths
        if not self.program:
            may_be_wide |= self.layout.min_bytes <= 16 * self.bus_bytes
        sizes = step_sizes(
            self.segment,
            self.bus_bytes,
            at_start=not self.program,
            may_be_wide=may_be_wide,
            has_rest=self.rest is not None,
        )
        align = self.take_align()
        for index, slices in enumerate(split(self.segment, sizes)):
            self.program.append(
                MapStep(
                    rest=self.rest,
                    align=align if index == 0 else 1,
                    bytes=sizes[index],
                    slices=slices,
                    begin=begin if index == len(sizes) - 1 else None,
                    exits=NOWHERE,
                )
            )
            self.rest = None
        self.segment = []
