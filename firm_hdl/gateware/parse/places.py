"""Where the next step ends: the part of the sequencer that computes positions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.parse.lengths import Meaning, shift_of
from firm_hdl.gateware.positions import Ring, any_of, pick, raised_by
from firm_hdl.plan import BeginRun, Jump, RunStep

__all__ = ["NextPlace"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Way:
    """A way out of a step.

    Attributes
    ----------
    taken : Value
        The step takes this way, if it takes one of its kind.
    align : int
        Alignment of the next step.
    shift : int
        Distance from the start of the next step to its last byte.
    rest : bool
        The step is the last word of a counted run, whose rest is behind it.
    """

    taken: Value
    align: int
    shift: int
    rest: bool = False


class NextPlace:
    """The last byte of the step that follows. Not a component: logic of one module.

    Parameters
    ----------
    flow : Flow
    last : Signal
        The last byte of the step's map or word.
    phase : Value or int
        Position behind the packet's encapsulation header, modulo 8.
    meanings : mapping of int to Meaning
        By step.
    entry : View or None
        The step's length, decoded; `None` if the plan has no lengths.

    Attributes
    ----------
    exit : Value
        If the step is left through an exit.
    body : Value
        If it goes on in the body of the run or loop that it begins.
    after_rest : Value
        If it is left through an exit, and begins a run that is all rest.
    """

    def __init__(
        self,
        m: Module,
        flow: Flow,
        last: Signal,
        phase: Value | int,
        meanings: Mapping[int, Meaning],
        entry: data.View | None,
    ):
        self.m, self.flow, self.plan = m, flow, flow.plan
        self.last, self.phase, self.meanings, self.entry = last, phase, meanings, entry
        self.ring = Ring(self.plan)
        tail = self._tail()
        self.exit = self._sum("exit", list(self._exits()), tail)
        self.body = self._sum("body", list(self._bodies()), tail)
        self.after_rest = self._after_rest()

    def _exits(self) -> Iterator[_Way]:
        plan = self.plan
        for taken, index, jump in self.flow.exits:
            step = plan.steps[index]
            align = 1 if jump.step is None else plan.steps[jump.step].align
            rest = isinstance(step, RunStep) and plan.runs[step.run].counted
            yield _Way(taken=taken, align=align, shift=shift_of(plan, jump.step), rest=rest)

    def _bodies(self) -> Iterator[_Way]:
        plan = self.plan
        for index, step in enumerate(plan.steps):
            taken = self.flow.step[index]
            if isinstance(step, RunStep):
                yield _Way(taken=taken, align=1, shift=plan.bus_bytes - 1)
            elif step.begin is not None and step.begin.body is not None:
                body = step.begin.body.step
                assert body is not None
                align = plan.steps[body].align
                if isinstance(step.begin, BeginRun):
                    align = step.begin.align
                yield _Way(taken=taken, align=align, shift=shift_of(plan, body))

    def _raised(self, align: int, shift: int) -> int:
        """Return what to add to the last byte, for the next one, its alignment, and a shift.

        If the phase is not a constant, that is only the next byte.
        """
        if not isinstance(self.phase, int):
            return 1
        return 1 + (shift if align == 1 else raised_by(align, self.phase, shift))

    def _sum(self, kind: str, ways: list[_Way], tail: Value) -> Value:
        """Return the position of the way that is taken."""
        m, ring = self.m, self.ring
        amount, total = Signal(len(tail), name=f"{kind}_amount"), ring.position(f"{kind}_sum")
        sizes = [
            (way.taken, tail if way.rest else self._raised(way.align, way.shift)) for way in ways
        ]
        m.d.comb += [amount.eq(pick(sizes, len(amount))), total.eq(self.last + amount)]
        if isinstance(self.phase, int):
            return Cat(self._low_bit(ways, k, total[k]) for k in range(3)) | (
                total & ~Const(7, len(total))
            )
        pad, result = Signal(3, name=f"{kind}_pad"), ring.position(f"{kind}_last")
        mask = pick([(way.taken, way.align - 1) for way in ways], 3)
        shift = pick([(way.taken, way.shift) for way in ways], ring.bits)
        m.d.comb += [
            pad.eq((self.phase - total) & mask),
            result.eq(total + pad + shift),
        ]
        return result

    def _low_bit(self, ways: list[_Way], k: int, bit: Value) -> Value:
        """Return a bit of a position; it is known where the alignment covers it."""
        assert isinstance(self.phase, int)
        aligned = [way for way in ways if way.align >= 2 << k]
        ones = [
            way.taken for way in aligned if (self.phase + way.shift) % way.align >> k & 1
        ]
        return (bit & ~any_of([way.taken for way in aligned])) | any_of(ones)

    def _tail(self) -> Value:
        """Return how far it is from the last word of a run to the step behind the rest."""
        plan, bus = self.plan, self.plan.bus_bytes
        tail = Signal(range(5 * bus + 16), name="tail", reset_less=True)
        sizes: list[tuple[Value, int]] = []
        rests: list[tuple[Value, Value]] = []
        for taken, step, _, meaning in self._rests():
            raised = self._raised(plan.steps[step].align, shift_of(plan, step))
            assert meaning.run is not None and self.entry is not None
            sizes.append((taken, raised + plan.runs[meaning.run.run].terminated))
            unit = plan.item_bytes(meaning.run.run)
            rest = Value.cast(self.entry[meaning.rest]) << (unit.bit_length() - 1)
            rests.append((taken, rest))
        if sizes:
            total = pick(sizes, len(tail)) + pick(rests, len(tail))
            with self.m.If(self.flow.state.run_begin):
                self.m.d.sync += tail.eq(total)
        return tail

    def _after_rest(self) -> Value:
        cases: dict[str, list[Value]] = {}
        for taken, _, jump, meaning in self._rests():
            cases.setdefault(meaning.last(jump), []).append(taken)
        if not cases:
            return Const(0, self.ring.bits)
        assert self.entry is not None
        fields = [(any_of(on), Value.cast(self.entry[field])) for field, on in cases.items()]
        return fields[0][1] if len(fields) == 1 else pick(fields, self.ring.bits)

    def _rests(self) -> Iterator[tuple[Value, int, Jump, Meaning]]:
        """Yield the exits of steps that begin a run with a rest: taken, next step, jump, length."""
        for taken, index, jump in self.flow.exits:
            meaning = self.meanings.get(index)
            if meaning is not None and meaning.run is not None and jump.step is not None:
                yield taken, jump.step, jump, meaning
