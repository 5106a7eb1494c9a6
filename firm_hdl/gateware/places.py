"""Where the next step starts: the part of the parser that computes positions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.lengths import Meaning, shift_of
from firm_hdl.gateware.positions import Ring, any_of, pick, raised_by
from firm_hdl.plan import BeginRun, RunStep

__all__ = ["NextPlace"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Way:
    """A way out of a step.

    Attributes
    ----------
    taken : Value
        The step takes this way, if it takes one of its kind.
    size : int or None
        Bytes of the step; `None` for the last word of a counted run, whose rest is behind it.
    align : int
        Alignment of the position.
    shift : int
        Bytes behind the aligned position.
    """

    taken: Value
    size: int | None
    align: int
    shift: int


class NextPlace:
    """Positions of the step that follows. Not a component: logic of one module.

    Parameters
    ----------
    name : str
    flow : Flow
    place : Signal
        Position of the map or word of the step.
    phase : Value or int
        Position behind the packet's encapsulation header, modulo 8.
    meanings : mapping of int to Meaning
        By step.
    entry : View or None
        The step's length, decoded; `None` if the plan has no lengths.
    of_length : bool
        The position of the last byte of the next step's length, instead of that of its map.

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
        name: str,
        flow: Flow,
        place: Signal,
        phase: Value | int,
        meanings: Mapping[int, Meaning],
        entry: data.View | None,
        *,
        of_length: bool,
    ):
        self.m, self.name, self.flow, self.plan = m, name, flow, flow.plan
        self.place, self.phase, self.meanings = place, phase, meanings
        self.entry, self.of_length = entry, of_length
        self.ring = Ring(self.plan)
        tail = self._tail()
        self.exit = self._sum("exit", list(self._exits()), tail)
        self.body = self._sum("body", list(self._bodies()), tail)
        self.after_rest = self._after_rest()

    def _shift(self, step: int | None) -> int:
        return shift_of(self.plan, step) if self.of_length else 0

    def _exits(self) -> Iterator[_Way]:
        plan = self.plan
        for taken, index, jump in self.flow.exits:
            step = plan.steps[index]
            align = 1 if jump.step is None else plan.steps[jump.step].align
            size: int | None = step.bytes
            if isinstance(step, RunStep):
                size = None if plan.runs[step.run].counted else plan.bus_bytes
            yield _Way(taken=taken, size=size, align=align, shift=self._shift(jump.step))

    def _bodies(self) -> Iterator[_Way]:
        plan = self.plan
        for index, step in enumerate(plan.steps):
            taken = self.flow.step[index]
            if isinstance(step, RunStep):
                yield _Way(taken=taken, size=plan.bus_bytes, align=1, shift=0)
            elif step.begin is not None and step.begin.body is not None:
                body = step.begin.body.step
                assert body is not None
                is_run = isinstance(step.begin, BeginRun)
                align = step.begin.align if is_run else plan.steps[body].align
                yield _Way(taken=taken, size=step.bytes, align=align, shift=self._shift(body))

    def _raised(self, align: int, shift: int) -> int:
        """Return what to add for an alignment and a shift, if the phase is constant."""
        if not isinstance(self.phase, int):
            return 0
        return shift if align == 1 else raised_by(align, self.phase, shift)

    def _sum(self, kind: str, ways: list[_Way], tail: Value) -> Value:
        """Return the position of the way that is taken."""
        m, ring, name = self.m, self.ring, f"{self.name}_{kind}"
        amount, total = Signal(len(tail), name=f"{name}_amount"), ring.position(f"{name}_sum")
        sizes = [
            (way.taken, tail if way.size is None else way.size + self._raised(way.align, way.shift))
            for way in ways
        ]
        m.d.comb += [amount.eq(pick(sizes, len(amount))), total.eq(self.place + amount)]
        if isinstance(self.phase, int):
            return Cat(self._low_bit(ways, k, total[k]) for k in range(3)) | (
                total & ~Const(7, len(total))
            )
        pad, result = Signal(3, name=f"{name}_pad"), ring.position(name)
        mask = pick([(way.taken, way.align - 1) for way in ways], 3)
        shift = pick([(way.taken, way.shift) for way in ways], len(amount))
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
        tail = Signal(range(6 * bus + 16), name=f"{self.name}_tail", reset_less=True)
        sizes: list[tuple[Value, int]] = []
        rests: list[tuple[Value, Value]] = []
        for taken, index, jump in self.flow.exits:
            meaning = self.meanings.get(index)
            if meaning is None or meaning.run is None or jump.step is None:
                continue
            run = plan.runs[meaning.run.run]
            raised = self._raised(plan.steps[jump.step].align, self._shift(jump.step))
            sizes.append((taken, bus + run.terminated + raised))
            unit = plan.item_bytes(meaning.run.run)
            assert self.entry is not None
            rest = Value.cast(self.entry[meaning.rest]) << (unit.bit_length() - 1)
            rests.append((taken, rest))
        if sizes:
            total = pick(sizes, len(tail)) + pick(rests, len(tail))
            with self.m.If(self.flow.state.run_begin):
                self.m.d.sync += tail.eq(total)
        return tail

    def _after_rest(self) -> Value:
        cases: dict[str, list[Value]] = {}
        for taken, index, jump in self.flow.exits:
            meaning = self.meanings.get(index)
            if meaning is None or meaning.run is None or jump.step is None:
                continue
            if not self.of_length:
                cases.setdefault(meaning.place(jump), []).append(taken)
            elif shift_of(self.plan, jump.step):
                cases.setdefault(meaning.key(jump), []).append(taken)
        if not cases:
            return Const(0, self.ring.bits)
        assert self.entry is not None
        fields = [(any_of(on), Value.cast(self.entry[field])) for field, on in cases.items()]
        return fields[0][1] if len(fields) == 1 else pick(fields, self.ring.bits)
