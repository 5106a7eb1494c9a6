"""Where the next step ends: the part of the sequencer that computes positions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.positions import Ring, any_of, pick
from firm_hdl.program import (
    DeserializerProgram,
    DeserializerState,
    Length,
    NextMap,
    align_addend,
)

__all__ = ["NextPlace", "add_next_positions"]


def _names(program: DeserializerProgram) -> dict[str, Callable[[DeserializerState], Any]]:
    """Return the next positions that states have, by the name of their registers."""
    found: dict[str, Callable[[DeserializerState], Any]] = {
        f"again_{level}": lambda s, level=level: s.again[level] if s.again else None  # type: ignore[misc]
        for level in range(program.plan.levels)
    }
    found |= {"body": lambda s: s.body_start, "exit": lambda s: s.exit}
    return {name: of for name, of in found.items() if any(of(s) for s in program.states)}


def _widths(program: DeserializerProgram) -> dict[str, int]:
    """Return the widths of the fields of a next position, in bits."""
    bus = program.plan.bus_bytes
    low = 3 if bus >= 8 else Ring(program.plan).bits
    return {"add": (3 * bus + 8).bit_length(), "mask": 3, "low": low, "over_rest": 1}


def add_next_positions(flow: Flow[DeserializerState]) -> None:
    """Add the registers from which the next position is computed.

    On a narrow bus, positions are short: their constants are not worth registers.
    """
    program = flow.program
    assert isinstance(program, DeserializerProgram)
    if program.plan.bus_bytes < 8:
        return
    names = _names(program)
    for name, of in names.items():
        if name.startswith("again"):
            flow.register(f"{name}_is", 1, lambda s, of=of: of(s) is not None)  # type: ignore[misc]
    for name, of in names.items():
        for what, bits in _widths(program).items():
            flow.register(
                f"{name}_{what.removeprefix('over_')}",
                bits,
                lambda s, of=of, what=what: getattr(of(s), what, 0),  # type: ignore[misc]
            )


class NextPlace:
    """The last byte of the step that follows. Not a component: logic of one module.

    Parameters
    ----------
    flow : Flow
    last_at : Signal
        The last byte of the step's map or word.
    phase : Value or int
        Position after the packet's encapsulation header, modulo 8.
    entry : View or None
        The step's length, decoded; `None` if the plan has no lengths.

    Attributes
    ----------
    exit : Value
        If the next step is an exit.
    body : Value
        If the next step is the body of the run or loop that the step begins.
    after_rest : Value
        If the next step is an exit, and the step begins a run whose items are all in the rest.
    """

    def __init__(
        self,
        m: Module,
        program: DeserializerProgram,
        flow: Flow[DeserializerState],
        last_at: Signal,
        phase: Value | int,
        entry: data.View | None,
    ):
        self.m, self.flow, self.program, self.plan = m, flow, program, program.plan
        self.last_at, self.phase, self.entry = last_at, phase, entry
        self.ring = Ring(self.plan)
        tail = self._tail()
        self.exit = self._sum("exit", self._exits(), tail)
        self.body = self._sum("body", [(Const(1, 1), "body")], tail)
        self.after_rest = self._after_rest()

    def _trait(self, name: str, what: str) -> Value:
        """Return a field of a next position: a register, or logic if positions are short."""
        register = f"{name}_{what.removeprefix('over_')}"
        if register in vars(self.flow.traits):
            trait: Value = vars(self.flow.traits)[register]
            return trait
        of = _names(self.program).get(name)
        if of is None:
            return Const(0, 1)
        states = self.program.states[:-1]
        if what == "is":
            return pick([(self.flow.step[s.number], int(of(s) is not None)) for s in states], 1)
        values = [(self.flow.step[s.number], int(getattr(of(s), what, 0))) for s in states]
        return pick(values, _widths(self.program)[what])

    def _exits(self) -> list[tuple[Value, str]]:
        """Return the successors behind exits: whether each exit is taken, and its name."""
        found: list[tuple[Value, str]] = []
        free: Value = Const(1, 1)
        # The innermost loop goes on first.
        for level in reversed(range(self.plan.levels)):
            if f"again_{level}" in _names(self.program):
                again = self._trait(f"again_{level}", "is") & ~self.flow.levels[level].last
                found.append((free & again, f"again_{level}"))
                free = free & ~again
        return [*found, (free, "exit")]

    def _sum(self, kind: str, successors: list[tuple[Value, str]], tail: Value) -> Value:
        """Return the last byte of the successor that follows."""
        m, ring = self.m, self.ring

        def chosen(what: str, width: int) -> Value:
            return pick([(on, self._trait(name, what)) for on, name in successors], width)

        amount, total = Signal(len(tail), name=f"{kind}_amount"), ring.position(f"{kind}_sum")
        mask, low = Signal(3, name=f"to_{kind}_mask"), ring.position(f"to_{kind}_low")
        rest = Signal(name=f"to_{kind}_rest")
        m.d.comb += [
            rest.eq(chosen("over_rest", 1)),
            amount.eq(Mux(rest, tail, chosen("add", len(tail)))),
            total.eq(self.last_at + amount),
            mask.eq(chosen("mask", 3)),
            low.eq(chosen("low", len(low))),
        ]
        if isinstance(self.phase, int):
            return (total & ~Cat(mask, Const(0, len(total) - 3))) | low
        pad, result = Signal(3, name=f"{kind}_pad"), ring.position(f"{kind}_last")
        m.d.comb += [pad.eq((self.phase - total) & mask), result.eq(total + pad + low)]
        return result

    def _tail(self) -> Value:
        """Return the distance from the last word of a run to the step after the rest."""
        plan, bus = self.plan, self.plan.bus_bytes
        tail = Signal(range(5 * bus + 16), name="tail", reset_less=True)
        sizes: list[tuple[Value, int]] = []
        rests: list[tuple[Value, Value]] = []
        for taken, state, length in self._rests():
            addend = 1
            if bus >= 8 and state.align == 1:
                addend = 1 + state.last_offset
            elif bus >= 8:
                addend = 1 + align_addend(state.align, plan.header_bytes, state.last_offset)
            assert self.entry is not None
            sizes.append((taken, addend + length.has_nul))
            rest = Value.cast(self.entry[length.rest]) << (length.item_bytes.bit_length() - 1)
            rests.append((taken, rest))
        if sizes:
            total = pick(sizes, len(tail)) + pick(rests, len(tail))
            with self.m.If(self.flow.traits.begins_run):
                self.m.d.sync += tail.eq(total)
        return tail

    def _after_rest(self) -> Value:
        cases: dict[str, list[Value]] = {}
        for taken, state, length in self._rests():
            following = NextMap(state.align, state.last_offset)
            cases.setdefault(length.next_last(following), []).append(taken)
        if not cases:
            return Const(0, self.ring.bits)
        assert self.entry is not None
        fields = [(any_of(on), Value.cast(self.entry[field])) for field, on in cases.items()]
        return fields[0][1] if len(fields) == 1 else pick(fields, self.ring.bits)

    def _rests(self) -> Iterator[tuple[Value, DeserializerState, Length]]:
        """Yield the exits of states that begin a run with a rest: taken, next state, length."""
        for each in self.flow.exits:
            length, to = self.program.lengths.get(each.state), each.way.to
            if length is not None and length.level is None and to is not None:
                yield each.taken, self.program.states[to], length
