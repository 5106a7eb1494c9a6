"""The state of the collector: its registers, and its decisions in the current cycle."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from amaranth.hdl import Module, Signal, Value
from amaranth.lib import stream

from firm_hdl.gateware.collect.offered import OfferedLength
from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.positions import pick
from firm_hdl.plan import BeginLoop, BeginRun, Plan, RunStep
from firm_hdl.plan.transfers import transfers

__all__ = ["COUNT_BITS", "CollectState"]

COUNT_BITS = 32
"""Width of lengths. Counters have this width, because the items of any length are taken."""


class CollectState:
    """The place of the collector in the message and in the plan. Not a component: signals.

    Attributes
    ----------
    m : Module
    plan : Plan
    streams : sequence of stream.Interface
        By leaf.
    lengths : dict of int to OfferedLength
        By leaf.
    flow : Flow
        The step and the counters.
    traits, step : SimpleNamespace, list of Value(1)
        The traits of the step, and the step itself: those of `flow`.
    rest : Signal(range(lanes + 1))
        Number of items in the rest of the last run, until a step takes them. A register.
    has_nul : Signal(1)
        A NUL follows these items. A register.
    zero : Value(1)
        The step's length is 0. This and the following ones are combinational.
    done : Signal(1)
        The step, when complete, is left through an exit and not into a body.
    ends : Signal(1)
        The message ends with this step.
    free : Signal(1)
        The words may be written: `words` is not valid, or transfers.
    complete : Signal(1)
        The step is complete: its words are valid in the next cycle, and the next step follows.
    served : list of Signal(1)
        By number of a transfer in its step: it was taken in an earlier cycle. Registers.
    """

    def __init__(self, m: Module, plan: Plan, streams: Sequence[stream.Interface]):
        self.m, self.plan, self.streams = m, plan, streams
        self.lengths = {
            leaf: OfferedLength(m, plan, leaf, streams[leaf], streams[leaf].ready)
            for leaf in plan.begins
        }
        self.flow = self._flow()
        self.traits, self.step = self.flow.traits, self.flow.step
        lanes = plan.max_run_lanes
        self.rest, self.has_nul = Signal(range(lanes + 1), name="rest"), Signal(name="has_nul")
        self.zero = self.of_length(lambda length: length.zero)
        self.done, self.ends = Signal(name="done"), Signal(name="ends")
        self.free, self.complete = Signal(name="free"), Signal(name="complete")
        most = max(len(list(transfers(plan, step))) for step in plan.steps)
        self.served = [Signal(name=f"served_{k}") for k in range(most)]

    def _flow(self) -> Flow:
        size = self.plan.bus_bytes.bit_length()
        widths = {"map_bytes": size, "items_bytes": size, "map_mask": 3, "map_addend": 3}
        flags = "begins_nothing begins_run begins_string begins_loop is_words takes_rest"
        widths |= dict.fromkeys([*flags.split(), "two_word_map"], 1)
        most = (1 << COUNT_BITS) - 1
        return Flow(self.m, self.plan, lambda _: most, widths, self._traits, has_end=False)

    def _traits(self, index: int | None) -> dict[str, int]:
        if index is None:
            return {}
        plan, bus = self.plan, self.plan.bus_bytes
        step = plan.steps[index]
        is_words = isinstance(step, RunStep)
        counted = isinstance(step, RunStep) and plan.runs[step.run].counted
        lead = step.bytes > bus
        begin = step.begin
        map_addend = step.align - 1 - plan.header_bytes % step.align if bus >= 8 else 0
        return {
            "map_bytes": bus if is_words and not counted else step.bytes - bus * lead,
            "items_bytes": bus if lead or counted else 0,
            "map_mask": step.align - 1,
            "map_addend": map_addend,
            "begins_nothing": begin is None and not is_words,
            "begins_run": isinstance(begin, BeginRun),
            "begins_string": isinstance(begin, BeginRun) and plan.runs[begin.run].terminated,
            "begins_loop": isinstance(begin, BeginLoop),
            "is_words": is_words,
            "takes_rest": step.rest is not None,
            "two_word_map": lead,
        }

    def of_length(
        self, field: Callable[[OfferedLength], Value], width: int = 1, kind: type = object
    ) -> Value:
        """Return a field of the step's length; 0 if the step begins nothing of the kind."""
        begins = ((i, step.begin) for i, step in enumerate(self.plan.steps))
        cases = [
            (self.step[i], field(self.lengths[begin.length]))
            for i, begin in begins
            if begin is not None and isinstance(begin, kind)
        ]
        return pick(cases, width)
