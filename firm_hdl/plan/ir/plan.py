"""The whole plan of a converter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.model import Wire
from firm_hdl.plan.ir.leaves import Leaf, Run
from firm_hdl.plan.ir.steps import Begin, BeginLoop, Jump, Step, successors

__all__ = ["Plan"]


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A converter of one message type, for one wire and one bus width.

    Attributes
    ----------
    message : str
        Full name of the type.
    wire : Wire
    bus_bytes : int
        1, 2, 4, 8, 16, 32 or 64.
    max_message_bytes : int
        Size of the longest packet that lengths may promise, header included.
    header_bytes : int
        Bytes of the encapsulation header; alignment counts from its end.
    max_trailing_bytes : int
        Largest number of bytes that may follow the message in its packet.
    leaves : tuple of Leaf
        In wire order.
    runs : tuple of Run
    levels : int
        Number of loop counters.
    start : Jump
        Jump to the first step of each packet.
    steps : tuple of Step
    """

    message: str
    wire: Wire
    bus_bytes: int
    max_message_bytes: int
    header_bytes: int
    max_trailing_bytes: int
    leaves: tuple[Leaf, ...]
    runs: tuple[Run, ...]
    levels: int
    start: Jump
    steps: tuple[Step, ...]

    def jumps(self) -> Iterator[Jump]:
        """Yield every jump of the plan."""
        yield self.start
        for step in self.steps:
            yield from (jump for _, jump in successors(step))

    @property
    def begins(self) -> dict[int, Begin]:
        """The loop or run that each length counts, by the index of the length's leaf."""
        return {step.begin.length: step.begin for step in self.steps if step.begin is not None}

    @property
    def has_claims(self) -> bool:
        """Whether lengths share a budget."""
        return any(begin.claim is not None for begin in self.begins.values())

    def has_nul(self, begin: Begin) -> bool:
        """Tell whether a count on the wire includes a NUL; the leaf's length never does."""
        return not isinstance(begin, BeginLoop) and self.runs[begin.run].terminated

    def max_count(self, begin: Begin) -> int:
        """Return the largest legal count on the wire, a NUL included."""
        return begin.limit + self.has_nul(begin)

    def items_leaf(self, run: int) -> Leaf:
        """Return the leaf of a run's items."""
        return self.leaves[self.runs[run].items]

    @property
    def max_run_lanes(self) -> int:
        """Lanes of the widest run; 1 without runs."""
        return max((self.leaves[run.items].lanes for run in self.runs), default=1)

    def word(self, run: int) -> int:
        """Return the largest count that fits in one word of a run, its NUL included."""
        return self.items_leaf(run).lanes + self.runs[run].terminated

    def item_bytes(self, run: int) -> int:
        """Return the bytes of one item of a run."""
        return self.items_leaf(run).item_bytes
