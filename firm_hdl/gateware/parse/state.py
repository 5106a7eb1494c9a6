"""The state of the sequencer: its registers, and its decisions in the current cycle."""

from __future__ import annotations

from amaranth.hdl import Const, Module, Signal, Value

from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.parse.places import add_next_positions
from firm_hdl.gateware.positions import Ring
from firm_hdl.program import DeserializerProgram, DeserializerState

__all__ = ["ParseState"]


class ParseState:
    """The place of the sequencer in the packet and in the plan. Not a component: signals.

    Parameters
    ----------
    m : Module
    program : DeserializerProgram

    Attributes
    ----------
    m : Module
    program : DeserializerProgram
    plan : Plan
    has_leaves : bool
    ring : Ring
    flow : Flow
        The step and the counters.
    traits, step : SimpleNamespace, list of Value(1)
        The traits of the step, and the step itself: those of `flow`.
    last_at : Signal(position)
        Last byte of the step's map or word. A length of the step is the end of its map; so this is
        the length's last byte, too.
    first_at : Signal(position)
        First byte after the previous step, or the first item of a run.
    rest : Signal(range(lanes + 1))
        Items in the rest of the run that the step takes.
    nul_at : Signal(position)
        The NUL after these items.
    has_nul : Signal(1)
        There must be a NUL at `nul_at`.
    phase : int, Const or Signal(3)
        Position after the packet's encapsulation header, modulo 8: an `int` on a bus of 8 bytes or
        more, and a signal on others if anything is aligned to it.
    refused : Signal(1) or None
        A length claimed too much: `step` is the length's step again, and is left at once. The
        traits are those of the step after it. `None` without leaves, or if the plan has no claims.
    bad : Signal(1)
        An error was found in the packet.
    new_error : Signal(1)
        The error was found in the cycle before, in this step. The step has no order yet.
    fails : Signal(1)
        Without leaves only: an error was found in the packet up to the cycle before. Depends on
        registers only.
    items_at, map_at : Signal(position)
        First byte of the word of items, and of the last word of the map. These signals, and all
        below, are combinational.
    step_end : Signal(position)
        First byte after the step's map or word.
    left : Signal(position)
        Bytes in the buffer from `step_end` on; negative if bytes of the step are missing.
    present : Signal(1)
        All bytes of the step are in the buffer.
    exits_always : Signal(1)
        The next step is an exit of this one, whatever the step's length is.
    done : Signal(1)
        The next step is an exit of this one, not the body of a run or loop that it begins.
    ends_message : Signal(1)
        The message ends with this step.
    ends_packet : Signal(1)
        The message ends with this step, and the packet has ended.
    issue : Signal(1)
        The step's order is taken in this cycle, and the next step follows.
    drains : Signal(1)
        The packet has an error, and the step is ordered whatever its bytes are.
    """

    def __init__(self, m: Module, program: DeserializerProgram):
        self.m, self.program = m, program
        self.plan, self.has_leaves = plan, has_leaves = program.plan, program.has_leaves
        self.ring = ring = Ring(plan)
        checks = has_leaves and plan.has_claims
        self.refused = Signal(name="refused") if checks else None
        self.flow = self._flow()
        self.traits, self.step = self.flow.traits, self.flow.step
        start = program.states[program.start.to or 0].last_offset
        self.last_at = ring.position("last_at", init=start % (1 << ring.bits))
        self.first_at = ring.position("first_at")
        lanes = plan.max_run_lanes
        self.rest = Signal(range(lanes + 1), name="rest")
        self.nul_at, self.has_nul = ring.position("nul_at"), Signal(name="has_nul")
        self.phase: Value | int = plan.header_bytes
        if plan.bus_bytes < 8:
            header = plan.header_bytes % 8
            self.phase = Const(header, 3)
            if program.aligns:
                self.phase = Signal(3, name="phase", init=header)
        self.bad, self.new_error = Signal(name="bad"), Signal(name="new_error")
        self.fails = Signal(name="fails")
        self.items_at, self.map_at = ring.position("items_at"), ring.position("map_at")
        self.step_end, self.left = ring.position("step_end"), ring.position("left")
        self.present, self.done = Signal(name="present"), Signal(name="done")
        self.exits_always = Signal(name="exits_always")
        self.ends_message = Signal(name="ends_message")
        self.ends_packet = Signal(name="ends_packet")
        self.issue, self.drains = Signal(name="issue"), Signal(name="drains")

    def _flow(self) -> Flow[DeserializerState]:
        program, bus = self.program, self.plan.bus_bytes
        flow = Flow(self.m, program)
        flow.register("map_offset", bus.bit_length() + 1, lambda s: s.map_offset)
        # After a length that claims too much, its step begins nothing.
        written = self.refused is not None
        flow.register("begins_nothing", 1, lambda s: s.begins_nothing, written=written)
        flow.register("begins_run", 1, lambda s: s.begins_run)
        flow.register("begins_loop", 1, lambda s: s.begins_loop)
        flow.register("is_words", 1, lambda s: s.is_words)
        flow.register("is_counted", 1, lambda s: s.is_counted)
        flow.register("takes_rest", 1, lambda s: s.takes_rest)
        flow.register("two_word_map", 1, lambda s: s.two_word_map)
        flow.register("at_end", 1, lambda s: s.at_end)
        add_next_positions(flow)
        flow.add_exits()
        return flow
