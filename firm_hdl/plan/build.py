"""Build a plan from a layout and a bus width.

The layout is flattened into segments: bytes in a row whose map is static. A segment ends where a
length decides what follows, where a loop starts or ends, or where padding is known in the circuit
only. Segments are cut into steps (see :mod:`firm_hdl.plan.cut`). The step that holds a length also
takes the first items of its run if the window has room for both.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from firm_hdl.model import Primitive
from firm_hdl.plan.cut import cut, split
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    Begin,
    BeginArray,
    BeginLoop,
    BeginRun,
    Exits,
    Fixed,
    Jump,
    Leaf,
    LeafKind,
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
)
from firm_hdl.wire import Layout, LoopNode, Node, Path, RunNode, Scalar, Trigger, walk
from firm_hdl.wire.layout import LENGTH, OCTET, Gap

__all__ = ["build_plan"]


def build_plan(
    layout: Layout,
    *,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
    window_words: int = 1,
) -> Plan:
    """Plan the converters of a layout.

    Parameters
    ----------
    layout : Layout
    bus_bytes : int
        Width of the packet stream: 1, 2, 4, 8, 16, 32 or 64 bytes.
    max_message_bytes : int
        A packet whose lengths promise more is an error; at most 2**32 - 1.
    window_words : 1 or 2
        Bus words that a step may take. With 2, the step that holds a length also takes the first
        items, and remainders need no step of their own. This saves about one cycle for each string
        or sequence, and costs a wider shifter and a longer path through it. Messages of fixed size
        always have 2.

    Raises
    ------
    TypeError
        If a parameter is not an integer.
    ValueError
        If a parameter is out of range, or no message of the type fits `max_message_bytes`.
    """
    check_bus_bytes(bus_bytes)
    check_max_message_bytes(layout, max_message_bytes)
    if not isinstance(window_words, int) or isinstance(window_words, bool):
        raise TypeError(f"Window must have an integer number of words, not {window_words!r}")
    if window_words not in (1, 2):
        raise ValueError(f"Window must have 1 or 2 bus words, not {window_words!r}")
    # Without lengths, a wide window does not slow the circuit down, and keeps the bus busy.
    if not any(isinstance(n, RunNode | LoopNode) and n.count is None for n in walk(layout.nodes)):
        window_words = 2
    builder = _Builder(layout, bus_bytes, max_message_bytes, window_words * bus_bytes)
    steps = builder.build()
    return Plan(
        message=layout.message.name,
        wire=layout.rules.wire,
        bus_bytes=bus_bytes,
        max_message_bytes=max_message_bytes,
        header_bytes=layout.rules.header_bytes,
        slack_bytes=layout.rules.slack_bytes,
        leaves=tuple(builder.leaves),
        runs=tuple(builder.runs),
        levels=builder.levels,
        start=builder.jump_to(0),
        steps=steps,
    )


@dataclass(slots=True, kw_only=True)
class _Mark:
    """A position between steps where a loop starts or ends, or a constant counter is loaded.

    `kind` is "enter" (load `counter` with `count`), "loop" (the body of loop `counter` starts) or
    "end" (the body ends).
    """

    kind: str
    counter: int | str
    count: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Count:
    """A number of elements that a length decides: its leaf, and its largest legal value."""

    length: int
    limit: int


@dataclass(slots=True)
class _Builder:
    layout: Layout
    bus_bytes: int
    max_message_bytes: int
    window_bytes: int
    leaves: list[Leaf] = field(default_factory=list)
    runs: list[Run] = field(default_factory=list)
    levels: int = 0
    # Steps and marks in wire order. `link` fills in exits and bodies at the end.
    program: list[Step | _Mark] = field(default_factory=list)
    segment: list[Slice] = field(default_factory=list)
    segment_align: int = 1
    depth: int = 0
    # Index of the step at each place of the program that is a step.
    numbers: dict[int, int] = field(default_factory=dict)

    def build(self) -> tuple[Step, ...]:
        rules = self.layout.rules
        if rules.header_bytes:
            self.segment.append(Fixed(at=0, data=rules.encapsulation, check=True))
            options = bytes(rules.option_bytes)
            self.segment.append(Fixed(at=len(rules.encapsulation), data=options, check=False))
        self.nodes(self.layout.nodes)
        self.flush()
        places = [place for place, item in enumerate(self.program) if not isinstance(item, _Mark)]
        self.numbers = {place: index for index, place in enumerate(places)}
        return self.link()

    # Nodes to segments.

    def nodes(self, nodes: tuple[Node, ...]) -> None:
        for node in nodes:
            match node:
                case Scalar():
                    self.gap(node.gap)
                    self.value(self.leaf(node.path, "scalar", node.type), node.type.bytes)
                case Trigger():
                    self.value(self.leaf(node.path, "trigger", OCTET), 0)
                case RunNode(count=None):
                    self.counted_run(node)
                case RunNode():
                    self.array(node)
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
        if gap.bytes is None:
            self.flush()
            self.segment_align = gap.align
        elif gap.bytes:
            self.segment.append(Pad(at=self.segment_bytes, bytes=gap.bytes))

    def value(self, leaf: int, size: int, *, last: bool = False, level: int | None = None) -> None:
        at = self.segment_bytes
        self.segment.append(
            Part(at=at, bytes=size, leaf=leaf, first=0, size=size, last=last, last_level=level)
        )

    def limit(self, bound: int | None, item_bytes: int, end_bytes: int = 0) -> int:
        """Return the largest count that a legal message can have."""
        # An element without bytes still takes a transfer, so it counts as one byte.
        left = self.max_message_bytes - self.layout.min_bytes - end_bytes
        room = max(0, left // max(1, item_bytes))
        return room if bound is None else min(bound, room)

    def lanes(self, item: Primitive) -> int:
        return max(1, self.bus_bytes // item.bytes)

    def counted_run(self, node: RunNode) -> None:
        assert node.gap is not None
        self.gap(node.gap)
        length = self.leaf(node.path, "length", LENGTH)
        self.value(length, LENGTH.bytes)
        items = self.leaf(node.path, "items", node.item, self.lanes(node.item))
        limit = self.limit(node.bound, node.item.bytes, int(node.terminated))
        if node.item.bytes > self.bus_bytes:
            self.item_loop(node, items, _Count(length=length, limit=limit))
        else:
            run = self.new_run(items, terminated=node.terminated)
            self.run(node, BeginRun(length=length, limit=limit, run=run, body=None))

    def array(self, node: RunNode) -> None:
        assert node.count is not None
        items = self.leaf(node.path, "items", node.item, self.lanes(node.item))
        size = node.item.bytes
        full, tail = divmod(node.count, self.lanes(node.item))
        if node.count * size <= max(size, self.bus_bytes):
            self.gap(node.item_gap)
            self.value(items, node.count * size, last=True)
            return
        if size > self.bus_bytes:
            self.item_loop(node, items, node.count)
            return
        self.gap(node.item_gap)
        run = self.new_run(items, last=not tail)
        begin = BeginArray(count=full * self.lanes(node.item), run=run, body=None)
        self.run(replace(node, item_gap=Gap(align=1, bytes=0)), begin)
        if tail:
            self.value(items, tail * size, last=True)

    def new_run(self, items: int, *, terminated: bool = False, last: bool = True) -> int:
        self.runs.append(Run(items=items, terminated=terminated, last=last))
        return len(self.runs) - 1

    def item_loop(self, node: RunNode, items: int, count: int | _Count) -> None:
        """Plan items wider than the bus: a loop over single items, some steps each."""
        level = self.enter_loop(count)
        # Only the first item has padding, but the loop may align each item, as later items are
        # aligned already. The gap of the layout is that of the first item, so it cannot be static.
        if node.item_gap.bytes is None or node.item_gap.bytes:
            self.segment_align = node.item_gap.align
        self.value(items, node.item.bytes, level=level)
        self.leave_loop()

    def loop(self, node: LoopNode) -> None:
        if node.count is not None:
            self.enter_loop(node.count)
        else:
            assert node.gap is not None
            self.gap(node.gap)
            length = self.leaf(node.path, "length", LENGTH)
            self.value(length, LENGTH.bytes)
            limit = self.limit(node.bound, node.min_body_bytes)
            self.enter_loop(_Count(length=length, limit=limit))
        self.nodes(node.body)
        self.leave_loop()

    def enter_loop(self, count: int | _Count) -> int:
        level = self.depth
        self.depth += 1
        self.levels = max(self.levels, self.depth)
        if isinstance(count, int):
            self.flush()
            self.program.append(_Mark(kind="enter", counter=level, count=count))
        else:
            length, limit = count.length, count.limit
            self.flush(BeginLoop(length=length, limit=limit, level=level, body=_END))
        self.program.append(_Mark(kind="loop", counter=level))
        return level

    def leave_loop(self) -> None:
        self.flush()
        self.depth -= 1
        self.program.append(_Mark(kind="end", counter=self.depth))

    # Segments to steps.

    def run(self, node: RunNode, begin: BeginRun | BeginArray) -> None:
        """End the segment with the start of a run, and add the run's body if it may be needed."""
        at_once = self.bus_bytes + (1 if self.runs[begin.run].terminated else 0)
        body = RunStep(run=begin.run, head=min(at_once, self.window_bytes), exits=_NOWHERE)
        if isinstance(begin, BeginArray) and not self.segment:
            self.flush()
            self.program.append(_Mark(kind="enter", counter=RUN_COUNTER, count=begin.count))
            self.program.append(replace(body, align=self.take_align()))
            return
        gap = node.item_gap.bytes
        used = cut(self.segment, self.bus_bytes, self.bus_bytes)[-1] + (gap or 0)
        head = min(at_once, self.window_bytes - used)
        if gap is None or head < self.bus_bytes:
            head = 0
        self.flush(replace(begin, gap=gap or 0, head=head))
        if not (isinstance(begin, BeginArray) and begin.count * node.item.bytes <= head):
            self.program.append(replace(body, align=node.item_gap.align if gap is None else 1))

    def take_align(self) -> int:
        align, self.segment_align = self.segment_align, 1
        return align

    def flush(self, begin: Begin | None = None) -> None:
        """Cut the segment into steps. The last step starts `begin`."""
        if not self.segment:
            assert begin is None
            return
        heads = begin is not None and not isinstance(begin, BeginLoop) and begin.head > 0
        bus = self.bus_bytes
        if not self.program and not heads:
            # From the start of the packet, cuts at bus words need no shifter.
            sizes = [min(bus, self.segment_bytes - at) for at in range(0, self.segment_bytes, bus)]
            sizes = sizes or [0]
        else:
            # Elsewhere the offset is dynamic. The last step may be longer, so that a remainder
            # takes no cycle, unless that room is needed for the head of a run.
            sizes = cut(self.segment, bus, bus if heads else self.window_bytes)
        align = self.take_align()
        steps = split(self.segment, sizes)
        for index, slices in enumerate(steps):
            self.program.append(
                MapStep(
                    align=align if index == 0 else 1,
                    bytes=sizes[index],
                    slices=slices,
                    begin=begin if index == len(steps) - 1 else None,
                    exits=_NOWHERE,
                )
            )
        self.segment = []

    # Control flow.

    def jump_to(self, place: int) -> Jump:
        """Return the jump to the next step from a place of the program where no loop ends."""
        enter: list[tuple[int | str, int]] = []
        while place < len(self.program):
            item = self.program[place]
            if not isinstance(item, _Mark):
                break
            assert item.kind != "end"
            if item.kind == "enter":
                enter.append((item.counter, item.count))
            place += 1
        return Jump(enter=tuple(enter), step=self.numbers.get(place))

    def exits_at(self, place: int, bodies: dict[int, int]) -> Exits:
        """Return the exits of a step or run that ends in front of a place of the program."""
        repeats: list[tuple[int, Jump]] = []
        while place < len(self.program):
            item = self.program[place]
            if not isinstance(item, _Mark) or item.kind != "end":
                break
            assert isinstance(item.counter, int)
            repeats.append((item.counter, self.jump_to(bodies[place])))
            place += 1
        return Exits(repeats=tuple(repeats), default=self.jump_to(place))

    def link(self) -> tuple[Step, ...]:
        bodies, ends = self.loop_places()
        steps: list[Step] = []
        for place, item in enumerate(self.program):
            if isinstance(item, _Mark):
                continue
            after = place + 1
            if item.begin is not None:
                begin = item.begin
                if isinstance(begin, BeginLoop):
                    begin = replace(begin, body=self.jump_to(after))
                    after = ends[after] + 1
                elif after < len(self.program):
                    # If the run has a body, it is the next step.
                    next_step = self.program[after]
                    if isinstance(next_step, RunStep) and next_step.run == begin.run:
                        begin = replace(begin, body=self.jump_to(after))
                        after += 1
                item = replace(item, begin=begin)
            steps.append(replace(item, exits=self.exits_at(after, bodies)))
        return tuple(steps)

    def loop_places(self) -> tuple[dict[int, int], dict[int, int]]:
        """Return the start of each loop's body by the loop's end, and the end by its start."""
        bodies: dict[int, int] = {}
        ends: dict[int, int] = {}
        open_loops: list[int] = []
        for place, item in enumerate(self.program):
            if isinstance(item, _Mark) and item.kind == "loop":
                open_loops.append(place)
            elif isinstance(item, _Mark) and item.kind == "end":
                start = open_loops.pop()
                bodies[place] = start + 1
                ends[start] = place
        return bodies, ends


_END = Jump(step=None)
_NOWHERE = Exits(default=_END)
