"""The control flow of a plan, common to both directions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from firm_hdl.plan.ir import (
    RUN_COUNTER,
    BeginArray,
    BeginLoop,
    CountedBegin,
    Exits,
    Fixed,
    Jump,
    MapStep,
    Pad,
    Part,
    Plan,
    Run,
    RunStep,
    Take,
)

__all__ = ["Edge", "Machine", "Payload", "Visit"]

Payload: TypeAlias = "int | tuple[tuple[int, ...], bool]"
"""The payload of one transfer: a number, or for items all lanes and `last`."""


class Visit(NamedTuple):
    """One cycle of a plan: the step, and the bytes that it takes, without padding in front."""

    step: int
    bytes: int


class Edge(NamedTuple):
    """A decision that a plan leaves to the packet.

    Attributes
    ----------
    step : int
    way : str
        ``padding N``: the step was aligned by skipping N bytes. ``again``: the body of a run was
        repeated. ``body``: the loop or run that the step starts continues in its body. ``loop N
        again`` and ``next``: the exit that was taken.
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
    visits: list[Visit] = field(default_factory=list)
    edges: set[Edge] = field(default_factory=set)
    # The loop or run of each length. A length's first bytes may come some steps before its start.
    begins: dict[int, CountedBegin] = field(init=False)

    def __post_init__(self) -> None:
        self.begins = self.plan.counted

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

    def go(self) -> None:
        """Run the plan from start to end."""
        index = self.enter(self.plan.start)
        while index is not None:
            index = self.step(index)

    def enter(self, jump: Jump) -> int | None:
        self.counters.update(jump.enter)
        return jump.step

    def step(self, index: int) -> int | None:
        """Run one step, all repetitions of a run's body included, and return the next one."""
        step = self.plan.steps[index]
        if step.align != 1:
            padding = (self.plan.header_bytes - self.offset) % step.align
            self.edges.add(Edge(index, f"padding {padding}"))
            self.skip(padding)
        start = self.offset
        for item in step.slices:
            match item:
                case Pad():
                    self.skip(item.bytes)
                case Fixed():
                    self.fixed(item)
                case Part():
                    self.part(item)
        if isinstance(step, RunStep):
            while self.counters[RUN_COUNTER]:
                start = self.offset
                self.take(step.take)
                self.visits.append(Visit(index, self.offset - start))
                if self.counters[RUN_COUNTER]:
                    self.edges.add(Edge(index, "again"))
            return self.leave(index, step.exits)
        body = self.begin(step)
        self.visits.append(Visit(index, self.offset - start))
        if body is None:
            return self.leave(index, step.exits)
        self.edges.add(Edge(index, "body"))
        return self.enter(body)

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
        begin = step.begin
        if begin is None:
            return None
        count = begin.count if isinstance(begin, BeginArray) else self.length
        if not count:
            return None
        if isinstance(begin, BeginLoop):
            self.counters[begin.level] = count
            return begin.body
        self.counters[RUN_COUNTER] = count
        self.skip(begin.gap)
        if step.take is not None:
            self.take(step.take)
        if not self.counters[RUN_COUNTER]:
            return None
        if begin.body is None:
            raise ValueError("The plan starts a run that needs a body but has none")
        return begin.body

    def take(self, take: Take) -> None:
        """Process one cycle of a run: take its rest if that fits in the head, else all lanes."""
        run = self.plan.runs[take.run]
        leaf = self.plan.leaves[run.items]
        left = self.counters[RUN_COUNTER]
        finish = left * leaf.item_bytes <= take.head
        count = left if finish else leaf.lanes
        after = left - count
        self.counters[RUN_COUNTER] = after
        nul = 1 if run.terminated else 0
        items = count - (nul if finish else 0)
        if items:
            self.items(run, items, run.last and after <= nul)
        if finish and nul:
            self.terminator()

    def is_last(self, part: Part) -> bool:
        """Return whether a transfer of items is the last of its leaf."""
        return part.last or (part.last_level is not None and self.counters[part.last_level] == 1)
