"""The state of the collector: its registers, and its decisions in the current cycle."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from amaranth.hdl import Module, Signal, Value
from amaranth.lib import stream

from firm_hdl.gateware.collect.offered import OfferedLength
from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.positions import pick
from firm_hdl.program import Length, SerializerProgram, SerializerState

__all__ = ["CollectState"]


class CollectState:
    """The place of the collector in the message and in the plan. Not a component: signals.

    Attributes
    ----------
    m : Module
    program : SerializerProgram
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

    def __init__(self, m: Module, program: SerializerProgram, streams: Sequence[stream.Interface]):
        self.m, self.program, self.plan, self.streams = m, program, program.plan, streams
        plan = self.plan
        self.lengths = {
            each.leaf: OfferedLength(m, each, streams[each.leaf])
            for each in program.lengths.values()
        }
        self.flow = self._flow()
        self.traits, self.step = self.flow.traits, self.flow.step
        lanes = plan.max_run_lanes
        self.rest, self.has_nul = Signal(range(lanes + 1), name="rest"), Signal(name="has_nul")
        self.zero = self.of_length(lambda length: length.zero)
        self.done, self.ends = Signal(name="done"), Signal(name="ends")
        self.free, self.complete = Signal(name="free"), Signal(name="complete")
        most = max(len(each.transfers) for each in program.states)
        self.served = [Signal(name=f"served_{k}") for k in range(most)]

    def _flow(self) -> Flow[SerializerState]:
        flow, bits = Flow(self.m, self.program), self.plan.bus_bytes.bit_length()
        flow.register("map_bytes", bits, lambda s: s.word_bytes)
        flow.register("items_bytes", bits, lambda s: s.item_word_bytes)
        flow.register("map_mask", 3, lambda s: s.map_mask)
        flow.register("map_addend", 3, lambda s: s.map_addend)
        flow.register("begins_nothing", 1, lambda s: s.begins_nothing)
        flow.register("begins_run", 1, lambda s: s.begins_run)
        flow.register("begins_string", 1, lambda s: s.begins_string)
        flow.register("begins_loop", 1, lambda s: s.begins_loop)
        flow.register("is_words", 1, lambda s: s.is_words)
        flow.register("takes_rest", 1, lambda s: s.takes_rest)
        flow.register("two_word_map", 1, lambda s: s.two_word_map)
        flow.add_exits()
        return flow

    def of_length(
        self,
        field: Callable[[OfferedLength], Value],
        width: int = 1,
        test: Callable[[Length], bool] = lambda _: True,
    ) -> Value:
        """Return a field of the step's length; 0 if the step has none, or the test fails."""
        cases = [
            (self.step[number], field(self.lengths[length.leaf]))
            for number, length in self.program.lengths.items()
            if test(length)
        ]
        return pick(cases, width)
