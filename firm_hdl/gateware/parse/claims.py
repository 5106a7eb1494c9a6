"""The budget of nested lengths: what they claim of the packet, and whether so much is left."""

from __future__ import annotations

from amaranth.hdl import Const, Mux, Signal, Value

from firm_hdl.gateware.parse.state import ParseState
from firm_hdl.gateware.positions import any_of, pick

__all__ = ["Claims"]


class Claims:
    """Check what the length of a step claims. Not a component: logic of one module.

    The check is a pipeline beside the sequencer, so that it is not in the loop that limits the
    clock rate. The sequencer executes the step of a counted length. In the next cycle, the length
    comes from its table; then it is multiplied by the bytes of an item, as a sum of shifted
    lengths; then the product is taken from the budget. A length can enter in each cycle.

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
    pending : Signal(1)
        A length is in the pipeline, or `fails`: in the 3 cycles after the step of a counted length,
        and in the fourth one if it fails. A register.
    fails : Signal(1)
        A length claims more than is left of the budget. Any other error that was found while
        `pending` comes later in wire order. Only in the last cycle of `pending`; a register.
    """

    def __init__(self, state: ParseState, counted: Value, count: Value):
        self.m, self.state = state.m, state
        m = state.m
        self.claims = {
            index: length.claim
            for index, length in state.program.lengths.items()
            if length.claim is not None
        }
        total = max(claim.total or 0 for claim in self.claims.values())
        # What is left can be negative; and a legal length has at most the bytes of the budget and
        # those that are saved.
        self.saved = max(claim.saved for claim in self.claims.values())
        self.width = (total + self.saved).bit_length() + 1
        self.pending, self.fails = Signal(name="claim_pending"), Signal(name="claim_fails")
        starts = Signal(name="claim_starts")
        m.d.comb += starts.eq(state.issue & counted & ~state.bad)
        renews = any_of([state.step[i] for i, claim in self.claims.items() if claim.total])
        loads, multiplies, subtracts = self._started(starts)
        *_, renewed = self._delayed("claim_renewed", renews)
        more, less = self._product(count)
        budget = Signal(self.width - 1, name="claim_budget", reset_less=True)
        left, exceeds = Signal(self.width, name="claim_left"), Signal(name="claim_exceeds")
        m.d.comb += [
            left.eq(Mux(renewed, total, budget) + less - more),
            exceeds.eq(subtracts & left[-1]),
        ]
        m.d.sync += [
            self.pending.eq(starts | loads | multiplies | exceeds),
            self.fails.eq(exceeds),
        ]
        with m.If(subtracts):
            m.d.sync += budget.eq(left)
        with m.Elif(renewed):
            m.d.sync += budget.eq(total)
        if state.refused is not None:
            m.d.sync += state.refused.eq(self.fails | (state.refused & ~state.issue))

    def _delayed(self, name: str, value: Value) -> list[Signal]:
        """Return a value 1, 2 and 3 cycles later."""
        stages = [Signal(name=f"{name}_{number}") for number in (1, 2, 3)]
        for stage, before in zip(stages, [value, *stages], strict=False):
            self.m.d.sync += stage.eq(before)
        return stages

    def _started(self, starts: Value) -> list[Signal]:
        """Return whether a length started 1, 2 and 3 cycles ago.

        Without leaves, an error before the length is found a cycle after its step. It is earlier in
        wire order, so the length no longer counts.
        """
        stages = self._delayed("claim", starts)
        if not self.state.has_leaves:
            self.m.d.sync += stages[1].eq(stages[0] & ~self.state.fails)
        return stages

    def _product(self, count: Value) -> tuple[Value, Value]:
        """Return two numbers, in the third cycle; their difference is what the length claims."""
        m = self.m
        number = Signal(len(count), name="claim_count", reset_less=True)
        m.d.sync += number.eq(count)
        # The shifts that are added, and those that are subtracted, for each size of an item.
        added: list[list[tuple[Value, Value]]] = []
        subtracted: list[list[tuple[Value, Value]]] = []
        for size in sorted({claim.bytes for claim in self.claims.values()}):
            chosen = any_of([self.state.step[i] for i, c in self.claims.items() if c.bytes == size])
            before = Signal(name=f"claim_of_{size}_loads", reset_less=True)
            now = Signal(name=f"claim_of_{size}", reset_less=True)
            m.d.sync += [before.eq(chosen), now.eq(before)]
            for terms, shifts in zip((added, subtracted), _shifts(size), strict=True):
                for place, shift in enumerate(shifts):
                    if place == len(terms):
                        terms.append([])
                    terms[place].append((now, number << shift))
        numbers = []
        for name, terms, start in (("more", added, -self.saved), ("less", subtracted, 0)):
            if not terms:
                numbers.append(Const(0, 1))
                continue
            target = Signal(self.width, name=f"claim_{name}", reset_less=True)
            sum_of_terms: Value | int = start
            for each in terms:
                sum_of_terms = pick(each, self.width) + sum_of_terms
            m.d.sync += target.eq(sum_of_terms)
            numbers.append(target)
        return numbers[0], numbers[1]


def _shifts(number: int) -> tuple[list[int], list[int]]:
    """Return powers of two of which a number is the sum, and those to subtract; as few as possible.

    These are the digits 1 and -1 of the non-adjacent form.
    """
    added, subtracted, shift = [], [], 0
    while number:
        if number & 3 == 3:
            subtracted.append(shift)
            number += 1
        elif number & 1:
            added.append(shift)
            number -= 1
        number >>= 1
        shift += 1
    return added, subtracted
