"""The length that a step begins a run or a loop with, decoded."""

from __future__ import annotations

from collections.abc import Iterable

from amaranth.hdl import Cat, Const, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.parse.claims import Claims
from firm_hdl.gateware.parse.lengths import Lengths
from firm_hdl.gateware.parse.state import ParseState
from firm_hdl.gateware.positions import any_of, pick

__all__ = ["StepLength"]


class StepLength:
    """The length of the step, looked up in a table. Not a component: logic of one module.

    All values are combinational, from registers and a memory that is read at `state.last_at`. In a
    step without a length, `run_skips` and `loop_skips` are 0, and the other values have no meaning.

    Parameters
    ----------
    state : ParseState
    beat : Value(beat_layout(plan))
        The beat that is written to the packet buffer in this cycle.

    Attributes
    ----------
    entry : View or None
        The fields that :class:`Length` names; `None` if the plan has no lengths.
    count : Value
        The length on the wire, a cycle later. It includes the NUL of a CDR `string`.
    claims : Claims or None
        The check of what the length claims; `None` if no length of the plan has a claim.
    zero, over : Value(1)
        The length is 0; the length is above the largest legal value.
    run_skips, loop_skips : Value(1)
        The body of the run or of the loop is skipped: no element, no word before the rest, or an
        illegal length.
    single : Value(1)
        The body is executed at most once.
    double : Value(1)
        Two passes of the body; valid only if `single` is 0.
    rest : Value(range(lanes + 1))
        Items in the rest.
    """

    def __init__(self, state: ParseState, beat: data.View):
        self.state = state
        self.entry: data.View | None = None
        self.claims: Claims | None = None
        self.zero: Value = Const(0, 1)
        self.over = self.run_skips = self.loop_skips = self.zero
        self.single = self.double = self.count = self.rest = self.zero
        lengths = state.program.lengths
        if not lengths:
            return
        self.entry = self._look_up(beat)
        self.zero = self.entry.zero
        every = lengths.items()
        runs = [(index, each) for index, each in every if each.level is None]
        loops = [(index, each) for index, each in every if each.level is not None]
        self.over = self._select((index, each.over) for index, each in every)
        self.run_skips = self._select(((index, each.skips) for index, each in runs), exact=True)
        self.loop_skips = self._select(((index, each.skips) for index, each in loops), exact=True)
        self.single = self._select((index, each.single) for index, each in every)
        self.double = self._select((index, each.double) for index, each in every)
        self.rest = self._select(((index, each.rest) for index, each in runs), len(state.rest))
        claims = [(index, each.counted) for index, each in every if each.counted is not None]
        if claims:
            counted = self._select(claims, exact=True)
            self.claims = Claims(state, counted & ~self.over, self.count)

    def _look_up(self, beat: data.View) -> data.View:
        """Return the entry of the step's length."""
        m, plan, ring = self.state.m, self.state.plan, self.state.ring
        m.submodules.lengths = lengths = Lengths(self.state.program)
        m.d.comb += [lengths.beat.eq(beat), lengths.key.eq(self.state.last_at)]
        self.count = lengths.count
        if isinstance(self.state.phase, Signal):
            # The phase of the packet that arrives.
            phase = Signal(3, name="arriving_phase", init=plan.header_bytes % 8)
            m.d.comb += lengths.phase.eq(phase)
            with m.If(beat.valid & beat.last):
                at = Cat(Const(0, ring.lane_bits), beat.at)
                m.d.sync += phase.eq(at + plan.bus_bytes + plan.header_bytes)
        return lengths.entry

    def _select(
        self, named: Iterable[tuple[int, str]], width: int = 1, *, exact: bool = False
    ) -> Value:
        """Select a field of the entry by the step; 0 where the step has none, if `exact`.

        Parameters
        ----------
        named : iterable of (int, str)
            Steps, and the name of the field of each.
        """
        assert self.entry is not None
        fields: dict[str, list[Value]] = {}
        for index, field in named:
            fields.setdefault(field, []).append(self.state.step[index])
        if len(fields) == 1 and not exact:
            return Value.cast(self.entry[next(iter(fields))])
        return pick(
            [(any_of(chosen), Value.cast(self.entry[field])) for field, chosen in fields.items()],
            width,
        )
