"""The linked steps of a plan, for gateware."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.plan.ir.leaves import Run
from firm_hdl.plan.ir.steps import Begin, BeginLoop, Jump, Step, successors
from firm_hdl.plan.tree import Leaf, Plan

__all__ = ["Linked"]


@dataclass(frozen=True, kw_only=True)
class Linked:
    """The steps of a plan with jumps between them.

    Attributes
    ----------
    plan : Plan
    runs : tuple of Run
    start : Jump
        Jump to the first step of each packet.
    steps : tuple of Step
    """

    plan: Plan
    runs: tuple[Run, ...]
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
        return self.plan.leaves[self.runs[run].items]

    @property
    def max_run_lanes(self) -> int:
        """Lanes of the widest run; 1 without runs."""
        return max((self.plan.leaves[run.items].lanes for run in self.runs), default=1)

    def word(self, run: int) -> int:
        """Return the largest count that fits in one word of a run, its NUL included."""
        return self.items_leaf(run).lanes + self.runs[run].terminated

    def item_bytes(self, run: int) -> int:
        """Return the bytes of one item of a run."""
        return self.items_leaf(run).item_bytes
