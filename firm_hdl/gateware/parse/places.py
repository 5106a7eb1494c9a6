"""Where the next step ends: the part of the sequencer that computes positions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.parse.lengths import Meaning, RunMeaning, shift_of
from firm_hdl.gateware.positions import Ring, align_addend, any_of, pick
from firm_hdl.plan import BeginRun, Plan, RunStep
from firm_hdl.plan.ir import IntoBody, LoopAgain, Next, successors

__all__ = ["NextPlace", "place_fields", "place_traits"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Successor:
    """A successor of a step.

    Attributes
    ----------
    align : int
        Alignment of the next step.
    shift : int
        Distance from the start of the next step to its last byte.
    rest : bool
        The step is the last word of a counted run, and the run's rest comes before the next step.
    """

    align: int
    shift: int
    rest: bool = False


def _successors(plan: Plan, index: int) -> Iterator[tuple[str, _Successor]]:
    """Yield the successors of a step, by name: `exit`, `again_N` if loop N may repeat, `body`."""
    step = plan.steps[index]
    rest = isinstance(step, RunStep) and plan.runs[step.run].counted
    if isinstance(step, RunStep):
        yield "body", _Successor(align=1, shift=plan.bus_bytes - 1)
    for way, jump in successors(step):
        align = 1 if jump.step is None else plan.steps[jump.step].align
        shift = shift_of(plan, jump.step)
        match way:
            case IntoBody(begin=BeginRun(align=first)):
                yield "body", _Successor(align=first, shift=shift)
            case IntoBody():
                yield "body", _Successor(align=align, shift=shift)
            case LoopAgain(level=level):
                yield f"again_{level}", _Successor(align=align, shift=shift, rest=rest)
            case Next():
                yield "exit", _Successor(align=align, shift=shift, rest=rest)


def _distance(plan: Plan, align: int, shift: int) -> int:
    """Return the distance from one step's last byte to the next one's, before alignment.

    If the phase is not a constant, the distance is 1: alignment and shift are added later.
    """
    if plan.bus_bytes < 8:
        return 1
    return 1 + (shift if align == 1 else align_addend(align, plan.header_bytes, shift))


def place_traits(plan: Plan, index: int) -> dict[str, int]:
    """Return the traits of a step from which the next position is computed.

    Each successor of the step has an addend (`add`), the `mask` of the bits that alignment clears,
    and the value of these bits (`low`); if the phase is not a constant, `low` is a distance. With
    `rest`, the register `tail`, the distance over the rest, replaces the addend. `is` tells that
    the step ends a loop's body.
    """
    bus, traits = plan.bus_bytes, dict[str, int]()
    for name, successor in _successors(plan, index):
        low = successor.shift
        if bus >= 8:
            low = (plan.header_bytes + successor.shift) % successor.align
        traits |= {
            f"{name}_add": _distance(plan, successor.align, successor.shift),
            f"{name}_mask": successor.align - 1,
            f"{name}_low": low,
            f"{name}_rest": successor.rest,
        }
        if name.startswith("again"):
            traits[f"{name}_is"] = 1
    return traits


def place_fields(plan: Plan) -> dict[str, int]:
    """Return the widths of these traits, in bits."""
    bus = plan.bus_bytes
    widths = {"add": (3 * bus + 8).bit_length(), "mask": 3, "low": 3, "rest": 1}
    if bus < 8:
        widths["low"] = Ring(plan).bits
    names = {name for index in range(len(plan.steps)) for name, _ in _successors(plan, index)}
    again = {f"{name}_is": 1 for name in sorted(names) if name.startswith("again")}
    return again | {
        f"{name}_{what}": bits for name in sorted(names) for what, bits in widths.items()
    }


class NextPlace:
    """The last byte of the step that follows. Not a component: logic of one module.

    Parameters
    ----------
    flow : Flow
    last_at : Signal
        The last byte of the step's map or word.
    phase : Value or int
        Position after the packet's encapsulation header, modulo 8.
    meanings : mapping of int to Meaning
        By step.
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
        flow: Flow,
        last_at: Signal,
        phase: Value | int,
        meanings: Mapping[int, Meaning],
        entry: data.View | None,
    ):
        self.m, self.flow, self.plan = m, flow, flow.plan
        self.last_at, self.phase, self.meanings, self.entry = last_at, phase, meanings, entry
        self.ring = Ring(self.plan)
        tail = self._tail()
        self.exit = self._sum("exit", self._exits(), tail)
        self.body = self._sum("body", [(Const(1, 1), "body")], tail)
        self.after_rest = self._after_rest()

    def _trait(self, name: str) -> Value:
        """Return a trait of the step: a register, or logic if positions are short."""
        width = place_fields(self.plan).get(name)
        if width is None:
            return Const(0, 1)
        if name in vars(self.flow.traits):
            trait: Value = vars(self.flow.traits)[name]
            return trait
        values = [place_traits(self.plan, k).get(name, 0) for k in range(len(self.plan.steps))]
        return pick([(self.flow.step[k], value) for k, value in enumerate(values)], width)

    def _exits(self) -> list[tuple[Value, str]]:
        """Return the successors behind exits: whether each exit is taken, and its name."""
        found: list[tuple[Value, str]] = []
        free: Value = Const(1, 1)
        # The innermost loop goes on first.
        for level in reversed(range(self.plan.levels)):
            if f"again_{level}_is" in place_fields(self.plan):
                again = self._trait(f"again_{level}_is") & ~self.flow.levels[level].last
                found.append((free & again, f"again_{level}"))
                free = free & ~again
        return [*found, (free, "exit")]

    def _sum(self, kind: str, successors: list[tuple[Value, str]], tail: Value) -> Value:
        """Return the last byte of the successor that follows."""
        m, ring = self.m, self.ring

        def chosen(what: str, width: int) -> Value:
            return pick([(on, self._trait(f"{name}_{what}")) for on, name in successors], width)

        amount, total = Signal(len(tail), name=f"{kind}_amount"), ring.position(f"{kind}_sum")
        mask, low = Signal(3, name=f"to_{kind}_mask"), ring.position(f"to_{kind}_low")
        rest = Signal(name=f"to_{kind}_rest")
        m.d.comb += [
            rest.eq(chosen("rest", 1)),
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
        for taken, step, meaning in self._rests():
            addend = _distance(plan, plan.steps[step].align, shift_of(plan, step))
            assert self.entry is not None
            sizes.append((taken, addend + meaning.terminated))
            rest = Value.cast(self.entry[meaning.rest]) << (meaning.item_bytes.bit_length() - 1)
            rests.append((taken, rest))
        if sizes:
            total = pick(sizes, len(tail)) + pick(rests, len(tail))
            with self.m.If(self.flow.traits.begins_run):
                self.m.d.sync += tail.eq(total)
        return tail

    def _after_rest(self) -> Value:
        cases: dict[str, list[Value]] = {}
        for taken, step, meaning in self._rests():
            cases.setdefault(meaning.next_last_at(step), []).append(taken)
        if not cases:
            return Const(0, self.ring.bits)
        assert self.entry is not None
        fields = [(any_of(on), Value.cast(self.entry[field])) for field, on in cases.items()]
        return fields[0][1] if len(fields) == 1 else pick(fields, self.ring.bits)

    def _rests(self) -> Iterator[tuple[Value, int, RunMeaning]]:
        """Yield the exits of steps that begin a run with a rest: taken, next step, length."""
        for each in self.flow.exits:
            meaning, step = self.meanings.get(each.step), each.jump.step
            if isinstance(meaning, RunMeaning) and step is not None:
                yield each.taken, step, meaning
