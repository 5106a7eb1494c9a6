"""The control flow of a plan, common to both directions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from firm_hdl.plan.tree import (
    Constant,
    Fixed,
    Item,
    Length,
    Loop,
    Pad,
    Part,
    Plan,
    Run,
    Step,
    numbered,
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
        step was aligned by skipping N bytes. ``again``: another word of a run followed. Else what
        followed the step: ``body``, the first element of a loop that its length counts, or the
        first word of a run; ``loop N again``, another element (N counts the loops around it);
        ``next``, neither.
    """

    step: int
    way: str


@dataclass(slots=True, kw_only=True)
class Machine(ABC):
    """The control flow of a plan, common to both directions."""

    plan: Plan
    # Elements left in each open loop, outermost first, the current one included.
    loops: list[int] = field(default_factory=list)
    # Items left of the latest run that a length counts, a NUL included: what a step takes as rest.
    left: int = 0
    # The latest run.
    ran: Run | None = None
    # The value of the latest length: items on the wire, a NUL included.
    length: int = 0
    # Cycles for which the next step is held.
    held: int = 0
    # The step that was executed last, and what followed it.
    last: int = -1
    way: str = "next"
    visits: list[Visit] = field(default_factory=list)
    edges: set[Edge] = field(default_factory=set)

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
        self.block(self.plan.items, 0)
        self.go_to(-1)  # What followed the last step.

    def go_to(self, index: int) -> None:
        """Note what followed the step before."""
        if self.last >= 0:
            self.edges.add(Edge(self.last, self.way))
        self.last, self.way = index, "next"

    def block(self, items: Sequence[Item], first: int) -> None:
        """Run items; `first` is the number of the first step."""
        for index, item in numbered(items, first):
            match item:
                case Step():
                    self.step(index, item)
                case Run(count=Length()):
                    self.ran, self.left = item, self.length
                    if self.left:
                        self.align(item.align)
                    # Items and NUL of one word are left to the next step, which takes them as rest.
                    keep = self.plan.word_count(item)
                    if self.left > keep:
                        self.way = "body"
                        self.go_to(index)
                        self.words(index, item, keep)
                case Run(count=Constant(number)):
                    self.go_to(index)
                    self.step_align(index, item.align)
                    self.left = number
                    self.words(index, item, 0)
                case Loop(count=Constant(number)):
                    self.loop(index, item, number)
                case Loop():
                    if self.length:
                        self.way = "body"
                    self.loop(index, item, self.length)

    def loop(self, index: int, loop: Loop, count: int) -> None:
        level = len(self.loops)
        for left in range(count, 0, -1):
            self.loops.append(left)
            self.block(loop.body, index)
            self.loops.pop()
            if left > 1:
                self.way = f"loop {level} again"

    def step(self, index: int, step: Step) -> None:
        self.go_to(index)
        start = self.offset
        if step.rest is not None:
            self.edges.add(Edge(index, "rest" if self.left else "no rest"))
            if self.left and self.ran is not None:
                self.transfer_items(self.ran, self.left)
        padding = self.step_align(index, step.align)
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

    def step_align(self, index: int, align: int) -> int:
        """Skip the padding before a map or a constant run, and return its size."""
        if align == 1:
            return 0
        padding = self.align(align)
        self.edges.add(Edge(index, f"padding {padding}"))
        return padding

    def align(self, align: int) -> int:
        """Skip padding, and return its size."""
        padding = (self.plan.header_bytes - self.offset) % align
        self.skip(padding)
        return padding

    def visit(self, index: int, size: int, held: int) -> None:
        self.visits.append(Visit(index, size, self.offset, held))

    def words(self, index: int, run: Run, keep: int) -> None:
        """Process the full words of a run, one per cycle, until at most `keep` items are left."""
        lanes = self.plan.leaves[run.leaf].lanes
        while self.left > keep:
            start = self.offset
            self.transfer_items(run, lanes)
            self.visit(index, self.offset - start, self.held)
            self.held = 0
            if self.left > keep:
                self.edges.add(Edge(index, "again"))

    def transfer_items(self, run: Run, count: int) -> None:
        """Process one transfer of a run, with the NUL if the run ends with it."""
        self.left -= count
        has_nul = run.count.nul and not self.left
        items = count - has_nul
        if items:
            self.items(run, items, not run.has_tail and not self.left)
        if has_nul:
            self.terminator()

    def is_last(self, part: Part) -> bool:
        """Return whether a transfer of items is the last of its leaf."""
        return part.last == "always" or (part.last == "in loop" and self.loops[-1] == 1)
