"""Where the next state ends: the part of the sequencer that computes positions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from operator import attrgetter

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from firm_hdl.gateware.flow import Flow
from firm_hdl.gateware.parse.lengths import StepLength
from firm_hdl.gateware.positions import Ring, any_of, named, pick
from firm_hdl.program import (
    DeserializerProgram,
    DeserializerState,
    Length,
    NextMap,
    NextPosition,
    distance_to,
)

__all__ = ["NextPositions", "next_positions"]


_REMARKS = {
    "add": "bytes from last_at to the last byte of the step after it",
    "mask": "low bits of that position that are cleared, for alignment",
    "low": "low bits that are set then",
    "over_rest": "over_rest is added instead: the rest of a run is in between",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class NextPositions:
    """The last byte of the next state, for each way to it."""

    exit: Value  # If the next state is an exit.
    body: Value  # If it is the body of the run or loop that the state begins.
    # If it is an exit, and the state begins a run whose items are all in the rest.
    after_rest: Value


@dataclass(frozen=True, slots=True)
class _Way:
    """A way to the next state: whether it is taken, and the fields of :class:`NextPosition`."""

    taken: Value
    add: Value
    mask: Value
    low: Value
    over_rest: Value


def next_positions(
    m: Module,
    program: DeserializerProgram,
    flow: Flow[DeserializerState],
    last_at: Value,
    phase: Value | int,
    length: StepLength,
    begins_run: Value,
) -> NextPositions:
    """Compute where the next state ends.

    * `last_at`: the last byte of the state's map or word.
    * `phase`: position after the packet's encapsulation header, modulo 8.
    * `begins_run`: the length of the state counts the items of a run.
    """
    ring, bus = Ring(program.plan), program.plan.bus_bytes

    def way(
        name: str, taken: Value, of: Callable[[DeserializerState], NextPosition | None]
    ) -> _Way:
        def field(what: str, bits: int) -> Value:
            def value(state: DeserializerState) -> int:
                return int(getattr(of(state), what, 0))

            # On a narrow bus, positions are short: their constants are not worth registers.
            if bus < 8:
                return flow.select(bits, value)
            return flow.register(f"{name}_{what}", bits, value, remark=_REMARKS[what])

        low_bits = 3 if bus >= 8 else ring.bits
        return _Way(
            taken,
            field("add", (3 * bus + 8).bit_length()),
            field("mask", 3),
            field("low", low_bits),
            field("over_rest", 1),
        )

    # All fields are registers that belong to the state. What is late is only which exit is taken,
    # and whether the length skips the body (the caller selects by that).
    #
    #   next last_at = ((last_at + add) & ~mask) | low           alignment counts from a constant
    #   next last_at = last_at + add + padding + low             from the register `phase`
    #
    # The innermost loop that has elements left goes on; else the default exit is taken.
    exits, free = [], Const(1, 1)
    for level in reversed(range(program.plan.levels)):

        def again(state: DeserializerState, level: int = level) -> NextPosition | None:
            return state.again[level] if state.again else None

        def repeats(state: DeserializerState, level: int = level) -> bool:
            return bool(state.again) and state.again[level] is not None

        if any(map(repeats, program.states)):
            at_end = (
                flow.register(f"again_{level}", 1, repeats) if bus >= 8 else flow.select(1, repeats)
            )
            taken = at_end & ~flow.levels[level].last
            if not isinstance(free, Const):
                taken = taken & free
            taken = named(m, f"repeats_{level}", taken)
            exits.append(way(f"again_{level}", taken, again))
            free = free & ~taken
    if not isinstance(free, Const):
        free = named(m, "leaves_all_loops", free)
    exits.append(way("exit", free, attrgetter("exit")))
    bodies = [way("body", Const(1, 1), attrgetter("body_start"))]
    over_rest, after_rest = _over_rests(m, program, flow, length, begins_run)

    def last(kind: str, ways: list[_Way]) -> Value:
        def chosen(what: str, width: int) -> Value:
            return pick([(each.taken, getattr(each, what)) for each in ways], width)

        amount, total = Signal(len(over_rest), name=f"{kind}_amount"), ring.position(f"{kind}_sum")
        mask, low = Signal(3, name=f"to_{kind}_mask"), ring.position(f"to_{kind}_low")
        m.d.comb += [
            amount.eq(Mux(chosen("over_rest", 1), over_rest, chosen("add", len(over_rest)))),
            total.eq(last_at + amount),
            mask.eq(chosen("mask", 3)),
            low.eq(chosen("low", len(low))),
        ]
        result = ring.position(
            f"{kind}_last_at",
            remark="((last_at + add) and not mask) or low: from 21, +6, mask 3, low 3 lead to 27",
        )
        if isinstance(phase, int):
            m.d.comb += result.eq((total & ~Cat(mask, Const(0, len(total) - 3))) | low)
            return result
        pad = Signal(3, name=f"{kind}_pad")
        m.d.comb += [pad.eq((phase - total) & mask), result.eq(total + pad + low)]
        return result

    return NextPositions(exit=last("exit", exits), body=last("body", bodies), after_rest=after_rest)


def _over_rests(
    m: Module,
    program: DeserializerProgram,
    flow: Flow[DeserializerState],
    length: StepLength,
    begins_run: Value,
) -> tuple[Value, Value]:
    """Return two values of the state after a run.

    Returns
    -------
    Its distance from the run's last word over the rest: a register that is written in every cycle
    of the state that begins the run. And its last byte, if the run begins now and has nothing but a
    rest.
    """
    # The words of a run are counted from its length, not from positions. So the distance over the
    # rest is known when the run begins, and waits in a register until the last word:
    #
    #   cycle       | 0             | 1      | ... | n      | n + 1
    #   state       | begins a run  | word   |     | word   | the state with the rest
    #   over_rest   |               | valid  |     | added to last_at
    #
    plan = program.plan
    over_rest = Signal(range(5 * plan.bus_bytes + 16), name="over_rest", reset_less=True)
    begun = list(_exits_of_runs(program, flow))
    entry = length.entry
    if entry is None or not begun:
        return over_rest, Const(0, Ring(plan).bits)
    sizes, rests = [], []
    columns: dict[str, list[Value]] = {}
    for taken, counted, to in begun:
        sizes.append((taken, distance_to(plan, to) + counted.has_nul))
        shift = counted.item_bytes.bit_length() - 1
        rests.append((taken, Value.cast(entry[counted.rest]) << shift))
        columns.setdefault(counted.next_last_at(to), []).append(taken)
    total = named(m, "begun_size", pick(sizes, len(over_rest))) + named(
        m, "begun_rest", pick(rests, len(over_rest))
    )
    with m.If(begins_run):
        m.d.sync += over_rest.eq(total)
    cases = [(any_of(on), Value.cast(entry[name])) for name, on in columns.items()]
    if len(cases) == 1:
        return over_rest, cases[0][1]
    return over_rest, named(m, "last_at_after_items", pick(cases, Ring(plan).bits))


def _exits_of_runs(
    program: DeserializerProgram, flow: Flow[DeserializerState]
) -> Iterator[tuple[Value, Length, NextMap]]:
    """Yield the exits of states that begin a run: taken, length, and the map that follows."""
    for each in flow.exits:
        length, to = program.lengths.get(each.state), each.way.to
        if length is not None and length.level is None and to is not None:
            state = program.states[to]
            yield each.taken, length, NextMap(state.align, state.last_offset)
