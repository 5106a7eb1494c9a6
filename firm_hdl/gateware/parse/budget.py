"""The budget of nested lengths: what they claim of the packet, and whether so much is left."""

from __future__ import annotations

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.positions import any_of, named, pick
from firm_hdl.names.attributes import REMARK
from firm_hdl.program import DeserializerProgram

__all__ = ["Budget"]


class Budget(wiring.Component):
    """Charge lengths to a budget of bytes. A length can come in each cycle.

    Lengths inside each other could claim far more bytes than a packet may have, each of them legal
    by itself; a deserializer would then write zeros for hours. So all that are inside one outermost
    length share a budget, which is renewed with that length.

    The check is a pipeline beside the sequencer, so that it is not in the loop that limits the
    clock rate::

        cycle     | 0        | 1         | 2                 | 3              | 4
        length    | executed | looked up | times bytes each  | taken off left |
        starts    | 1        |           |                   |                |
        count     |          | valid     |                   |                |
        pending   |          | 1         | 1                 | 1              | 1 if it fails
        fails     |          |           |                   |                | 1 if it fails

    Parameters
    ----------
    program : DeserializerProgram
        With lengths that have claims.

    Members
    -------
    step : In(StructLayout)
        Whether the sequencer is in a state, by its name: one-hot.
    starts : In(1)
        The state is executed, and its length is charged.
    cancels : In(1)
        A length that started a cycle ago is not charged: an error came before it in wire order.
    count : In(count_bits)
        The length on the wire, a cycle after its state.
    pending : Out(1)
        A length is in the pipeline, or `fails`. A register.
    fails : Out(1)
        A length claims more than is left. Any other error that was found while `pending` comes
        later in wire order. Only in the last cycle of `pending`; a register.
    """

    def __init__(self, program: DeserializerProgram):
        self.claims = {
            number: length.charge
            for number, length in program.lengths.items()
            if length.charge is not None
        }
        super().__init__(
            {
                "step": In(data.StructLayout({each.name: 1 for each in program.states})),
                "starts": In(1),
                "cancels": In(1),
                "count": In(program.count_bits),
                "pending": Out(1),
                "fails": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        claims, step = self.claims, Value.cast(self.step)
        total = max(claim.budget or 0 for claim in claims.values())
        # Items may shorten later padding by so many bytes: each length claims as many less.
        padding_credit = max(claim.padding_credit for claim in claims.values())
        # What is left can be negative; and a legal length claims at most the budget and the credit.
        width = (total + padding_credit).bit_length() + 1

        loads, multiplies, subtracts = (Signal(name=f"starts_{k}") for k in (1, 2, 3))
        m.d.sync += [
            loads.eq(self.starts),
            multiplies.eq(loads & ~self.cancels),
            subtracts.eq(multiplies),
        ]
        renewed = any_of([step[number] for number, claim in claims.items() if claim.budget])
        for k in (1, 2, 3):
            before, renewed = renewed, Signal(name=f"renews_{k}")
            m.d.sync += renewed.eq(before)

        # Cycle 2: `more - less` is the count times the bytes of an item, less the credit. The
        # product is a sum of shifted counts: the digits 1 and -1 of the item's size.
        number = Signal(len(self.count), name="number", reset_less=True)
        m.d.sync += number.eq(self.count)
        # For each place of the sum: the sizes of items, and the shifted count of each.
        added: list[list[tuple[Value, Value]]] = []
        subtracted: list[list[tuple[Value, Value]]] = []
        for size in sorted({claim.bytes for claim in claims.values()}):
            chosen = any_of([step[k] for k, claim in claims.items() if claim.bytes == size])
            before, now = (
                Signal(name=f"bytes_{size}_{k}", reset_less=True) for k in ("loads", "now")
            )
            m.d.sync += [before.eq(chosen), now.eq(before)]
            for terms, shifts in zip((added, subtracted), _shifts(size), strict=True):
                for place, shift in enumerate(shifts):
                    if place == len(terms):
                        terms.append([])
                    terms[place].append((now, number << shift))
        more, less = (
            self._sum(m, *each, width)
            for each in (("more", added, padding_credit), ("less", subtracted, 0))
        )

        # Cycle 3.
        remaining = Signal(
            width - 1,
            name="remaining",
            reset_less=True,
            attrs={REMARK: f"what is left of a budget of {total} bytes"},
        )
        left, exceeds = Signal(width, name="left"), Signal(name="exceeds")
        m.d.comb += [
            left.eq(Mux(renewed, total, remaining) + less - more),
            exceeds.eq(subtracts & left[-1]),
        ]
        m.d.sync += [
            self.pending.eq(self.starts | loads | multiplies | exceeds),
            self.fails.eq(exceeds),
        ]
        with m.If(subtracts):
            m.d.sync += remaining.eq(left)
        # An outermost length that is too small to be charged begins a new budget, too. While its
        # state waits for bytes, the budget is renewed again and again; lengths inside come later.
        with m.Elif(renewed):
            m.d.sync += remaining.eq(total)
        return m

    def _sum(
        self,
        m: Module,
        name: str,
        places: list[list[tuple[Value, Value]]],
        less: int,
        width: int,
    ) -> Value:
        """Return a register with the sum of one term of each place, less a constant."""
        if not places:
            return Const(0, 1)
        remark = f"bytes claimed, less {less} that padding may save" if less else "bytes claimed"
        target = Signal(width, name=name, reset_less=True, attrs={REMARK: remark})
        total: Value = Const(0, width)
        for place, terms in enumerate(places):
            total = named(m, f"{name}_at_{place}", pick(terms, width)) + total
        m.d.sync += target.eq(total - less)
        return target


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
