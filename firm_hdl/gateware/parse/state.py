"""The state of the sequencer: its registers, and its decisions in the current cycle."""

from __future__ import annotations

from amaranth.hdl import Const, Module, Signal, Value

from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.parse.lengths import meanings_of, shift_of
from firm_hdl.gateware.parse.places import place_fields, place_traits
from firm_hdl.gateware.positions import Ring
from firm_hdl.plan import BeginLoop, BeginRun, Plan, RunStep
from firm_hdl.plan.geometry import geometry

__all__ = ["ParseState"]


class ParseState:
    """The place of the sequencer in the packet and in the plan. Not a component: signals.

    Parameters
    ----------
    m : Module
    plan : Plan
    has_leaves : bool
        As of :class:`Sequencer`.

    Attributes
    ----------
    m : Module
    plan : Plan
    has_leaves : bool
    ring : Ring
    meanings : dict of int to Meaning
        Decoded fields of a step's length, by the step's index.
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

    def __init__(self, m: Module, plan: Plan, *, has_leaves: bool):
        self.m, self.plan, self.has_leaves = m, plan, has_leaves
        self.ring = ring = Ring(plan)
        self.meanings = meanings_of(plan, has_leaves=has_leaves)
        checks = has_leaves and plan.has_claims
        self.refused = Signal(name="refused") if checks else None
        self.flow = self._flow()
        self.traits, self.step = self.flow.traits, self.flow.step
        start = shift_of(plan, plan.start.step) % (1 << ring.bits)
        self.last_at = ring.position("last_at", init=start)
        self.first_at = ring.position("first_at")
        lanes = plan.max_run_lanes
        self.rest = Signal(range(lanes + 1), name="rest")
        self.nul_at, self.has_nul = ring.position("nul_at"), Signal(name="has_nul")
        self.phase: Value | int = plan.header_bytes
        if plan.bus_bytes < 8:
            header = plan.header_bytes % 8
            aligns = geometry(plan).aligns
            self.phase = Signal(3, name="phase", init=header) if aligns else Const(header, 3)
        self.bad, self.new_error = Signal(name="bad"), Signal(name="new_error")
        self.fails = Signal(name="fails")
        self.items_at, self.map_at = ring.position("items_at"), ring.position("map_at")
        self.step_end, self.left = ring.position("step_end"), ring.position("left")
        self.present, self.done = Signal(name="present"), Signal(name="done")
        self.exits_always = Signal(name="exits_always")
        self.ends_message = Signal(name="ends_message")
        self.ends_packet = Signal(name="ends_packet")
        self.issue, self.drains = Signal(name="issue"), Signal(name="drains")

    def _flow(self) -> Flow:
        plan = self.plan
        flags = "begins_nothing begins_run begins_loop is_words is_counted takes_rest"
        # `map_offset` is in two's complement.
        widths = {"map_offset": plan.bus_bytes.bit_length() + 1}
        widths |= dict.fromkeys([*flags.split(), "two_word_map", "at_end"], 1)
        # On a narrow bus, positions are short: their traits are not worth registers.
        widths |= place_fields(plan) if plan.bus_bytes >= 8 else {}
        # After a length that claims too much, its step begins nothing.
        written = "begins_nothing" if self.refused is not None else ""
        return Flow(
            self.m, plan, plan.max_count, widths, self._traits, has_end=True, written=written
        )

    def _traits(self, index: int | None) -> dict[str, int]:
        plan, bus = self.plan, self.plan.bus_bytes
        if index is None:
            return {"at_end": 1, "begins_nothing": 1, "map_offset": 1}
        step = plan.steps[index]
        is_words = isinstance(step, RunStep)
        is_lead = step.bytes > bus
        return {
            # From the last byte to the first one of the map's last word.
            "map_offset": is_lead * bus - shift_of(plan, index),
            "begins_nothing": step.begin is None and not is_words,
            "begins_run": isinstance(step.begin, BeginRun),
            "begins_loop": isinstance(step.begin, BeginLoop),
            "is_words": is_words,
            "is_counted": isinstance(step, RunStep) and plan.runs[step.run].counted,
            "takes_rest": step.rest is not None,
            "two_word_map": is_lead,
            **(place_traits(plan, index) if bus >= 8 else {}),
        }
