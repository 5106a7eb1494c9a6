"""The control flow of a plan, common to both directions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from firm_hdl.plan.ir import (
    RUN_COUNTER,
    ArrayEnd,
    Begin,
    BeginLoop,
    Exits,
    Fixed,
    Jump,
    LoopEnd,
    MapStep,
    Pad,
    Part,
    Plan,
    Run,
    RunStep,
)

__all__ = ["Edge", "Machine", "Payload", "Visit"]

Payload: TypeAlias = "int | tuple[tuple[int, ...], bool]"
"""The payload of one transfer: a number, or for items all lanes and `last`."""


class Visit(NamedTuple):
    """One cycle of a plan.

    Attributes
    ----------
    step : int
    bytes : int
        Bytes that the step takes, without computed padding.
    end : int
        Bytes of the packet up to the end of the step.
    held : int
        Cycles for which a deserializer holds the step, to check what the length before it claims.
    """

    step: int
    bytes: int
    end: int
    held: int = 0


class Edge(NamedTuple):
    """A decision that a plan leaves to the packet.

    Attributes
    ----------
    step : int
    way : str
        ``rest`` and ``no rest``: whether a run had a rest that the step took. ``padding N``: the
        step was aligned by skipping N bytes. ``again``: the body of a run was repeated. ``body``:
        the loop or run that the step starts continues in its body. ``loop N again`` and ``next``:
        the exit that was taken.
    """

    step: int
    way: str


@dataclass(slots=True, kw_only=True)
class Machine(ABC):
    """The control flow of a plan, common to both directions."""

    plan: Plan
    counters: dict[int | str, int] = field(default_factory=dict)
    # The value of the latest length: items on the wire, a NUL included.
    length: int = 0
    # Cycles for which the next step is held.
    held: int = 0
    visits: list[Visit] = field(default_factory=list)
    edges: set[Edge] = field(default_factory=set)
    # The loop or run of each length. The length's first bytes may be in steps before the start.
    begins: dict[int, Begin] = field(init=False)

    def __post_init__(self) -> None:
        self.begins = self.plan.begins

    @property
    @abstractmethod
    def offset(self) -> int:
        """Number of bytes of the packet so far."""

    @abstractmethod
    def skip(self, count: int) -> None:
        """Skip padding."""

    @abstractmethod
    def fixed(self, item: Fixed) -> None:
        """Read or write bytes that are the same in every packet."""

    @abstractmethod
    def part(self, part: Part) -> None:
        """Read or write a part of a transfer."""

    @abstractmethod
    def items(self, run: Run, count: int, last: bool) -> None:
        """Read or write one transfer of a run, of `count` items."""

    @abstractmethod
    def terminator(self) -> None:
        """Read or write a string's NUL."""

    def run(self) -> None:
        """Run the plan from start to end."""
        index = self.enter(self.plan.start)
        while index is not None:
            index = self.step(index)

    def enter(self, jump: Jump) -> int | None:
        self.counters.update(jump.enter)
        return jump.step

    def step(self, index: int) -> int | None:
        """Run one step, including all repetitions of a run's body, and return the next step."""
        step = self.plan.steps[index]
        start = self.offset
        padding = 0
        if step.rest is not None:
            left = self.counters.get(RUN_COUNTER, 0)
            self.edges.add(Edge(index, "rest" if left else "no rest"))
            if left:
                self.transfer_items(step.rest, left)
        if step.align != 1:
            padding = self.align(step.align)
            self.edges.add(Edge(index, f"padding {padding}"))
        if isinstance(step, RunStep):
            self.words(index, step.run)
            return self.leave(index, step.exits)
        held, self.held = self.held, 0
        for item in step.slices:
            match item:
                case Pad():
                    self.skip(item.bytes)
                case Fixed():
                    self.fixed(item)
                case Part():
                    self.part(item)
        self.visit(index, self.offset - start - padding, held)
        body = self.begin(step)
        if body is None:
            return self.leave(index, step.exits)
        self.edges.add(Edge(index, "body"))
        return self.enter(body)

    def visit(self, index: int, size: int, held: int) -> None:
        self.visits.append(Visit(index, size, self.offset, held))

    def align(self, align: int) -> int:
        """Skip padding, and return its size."""
        padding = (self.plan.header_bytes - self.offset) % align
        self.skip(padding)
        return padding

    def leave(self, index: int, exits: Exits) -> int | None:
        for level, jump in exits.repeats:
            if self.counters[level] > 1:
                self.counters[level] -= 1
                self.edges.add(Edge(index, f"loop {level} again"))
                return self.enter(jump)
        self.edges.add(Edge(index, "next"))
        return self.enter(exits.default)

    def begin(self, step: MapStep) -> Jump | None:
        """Start the step's loop or run, and return the jump to its body, if it is needed."""
        begin, count = step.begin, self.length
        if begin is None:
            return None
        if isinstance(begin, BeginLoop):
            if not count:
                return None
            self.counters[begin.level] = count
            return begin.body
        self.counters[RUN_COUNTER] = count
        if count:
            self.align(begin.align)
        return begin.body if count > self.plan.word(begin.run) else None

    def words(self, index: int, run: int) -> None:
        """Process the full words of a run, one per cycle, except the rest of a counted run."""
        lanes = self.plan.items_leaf(run).lanes
        rest = self.plan.word(run) if self.plan.runs[run].counted else 0
        while True:
            start = self.offset
            self.transfer_items(run, lanes)
            self.visit(index, self.offset - start, self.held)
            self.held = 0
            if self.counters[RUN_COUNTER] <= rest:
                return
            self.edges.add(Edge(index, "again"))

    def transfer_items(self, index: int, count: int) -> None:
        """Process one transfer of a run, with the NUL if the run ends with it."""
        run = self.plan.runs[index]
        left = self.counters[RUN_COUNTER] - count
        self.counters[RUN_COUNTER] = left
        has_nul = run.terminated and not left
        items = count - has_nul
        if items:
            self.items(run, items, run.last and not left)
        if has_nul:
            self.terminator()

    def is_last(self, part: Part) -> bool:
        """Return whether a transfer of items is the last of its leaf."""
        match part.end:
            case ArrayEnd():
                return True
            case LoopEnd(level=level):
                return self.counters[level] == 1
            case None:
                return False
