"""The budget of nested lengths: what they claim of the packet, and whether so much is left."""

from __future__ import annotations

from amaranth.hdl import Const, Mux, Signal, Value

from firm_hdl.gateware.parse.state import ParseState
from firm_hdl.gateware.positions import any_of, pick

__all__ = ["Claims"]


class Claims:
    """Check what the length of a step claims. Not a component: logic of one module.

    The sequencer executes the step of a counted length, and the check begins in the next cycle: it
    holds the sequencer for `Claim.check_cycles` cycles, before it executes the next step. The order
    of the length waits as long. So the check is not in the loop that limits the clock rate.

    The count is multiplied by the bytes of an item, one bit of them per cycle, and each partial
    product is taken from the budget. So the multiplication needs one subtractor.

    Parameters
    ----------
    state : ParseState
        Of a plan in which lengths have claims.
    counted : Value(1)
        The step's length is legal by itself, and large enough to be counted.
    count : Value
        The length on the wire, a cycle later.

    Attributes
    ----------
    holds : Signal(1)
        The next step must not be executed, and no error of it be found. A register.
    fails : Signal(1)
        The length claims more than is left of the budget. Only in the last cycle of `holds`; a
        register. Then `state.refused` is high until the sequencer has left the loop or run.
    """

    def __init__(self, state: ParseState, counted: Value, count: Value):
        m = state.m
        claims = [
            (index, step.begin.claim)
            for index, step in enumerate(state.plan.steps)
            if step.begin is not None and step.begin.claim is not None
        ]
        total = max(claim.total or 0 for _, claim in claims)
        width = total.bit_length()
        bits = max(claim.bytes for _, claim in claims).bit_length()
        self.holds, self.fails = Signal(name="claim_holds"), Signal(name="claim_fails")
        # The count is loaded (`comes`), then multiplied.
        comes, exceeded = Signal(name="claim_comes"), Signal(name="claim_exceeded")
        factor = Signal(bits, name="claim_factor", reset_less=True)
        addend = Signal(width, name="claim_addend", reset_less=True)
        budget = Signal(width, name="claim_budget", reset_less=True)
        left = Signal(width + 1, name="claim_left")
        last, too_much = Signal(name="claim_last"), Signal(name="claim_too_much")
        more = factor[1:].any() if bits > 1 else Const(0, 1)
        renews = any_of([state.step[i] for i, claim in claims if claim.total is not None])
        starts = state.issue & counted & ~state.bad
        m.d.comb += [
            left.eq(budget - addend),
            last.eq(self.holds & ~comes & ~self.fails & ~more),
            too_much.eq(exceeded | (factor[0] & left[-1])),
        ]
        m.d.sync += [
            comes.eq(starts),
            self.holds.eq(Mux(self.holds, ~self.fails & (~last | too_much), starts)),
            self.fails.eq(last & too_much),
        ]
        with m.If(comes):
            m.d.sync += [addend.eq(count), exceeded.eq(0)]
        with m.Elif(self.holds):
            m.d.sync += [factor.eq(factor >> 1), addend.eq(addend << 1), exceeded.eq(too_much)]
            with m.If(factor[0]):
                m.d.sync += budget.eq(left)
        with m.Else():
            m.d.sync += factor.eq(pick([(state.step[i], c.bytes) for i, c in claims], bits))
            with m.If(renews):
                m.d.sync += budget.eq(total)
        if state.refused is not None:
            m.d.sync += state.refused.eq(self.fails | (state.refused & ~state.issue))
