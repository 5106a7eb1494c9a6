"""The control flow of a program, common to both directions: state, counters, transitions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from firm_hdl.gateware.counter import Counter
from firm_hdl.gateware.positions import any_of, named, pick
from firm_hdl.names.attributes import REMARK
from firm_hdl.program import AnyState, Program, Transition, state_remark

__all__ = ["Flow", "exceeds", "last_word"]


def last_word(items: Value, lanes: int) -> Value:
    """Return the number of items in the last word of a run that has at least one item."""
    low = items[: lanes.bit_length() - 1]
    return Mux(low.any(), low, lanes) if len(low) else Const(lanes)


def exceeds(value: Value, limit: int) -> Value:
    """Return whether an unsigned number is above a constant, as plain logic: no carry chain."""
    if limit >> len(value):
        return Const(0, 1)
    # From the lowest bit on: `result` says whether the bits so far are above those of the limit.
    # Where the limit has a 1, a number must have a 1 to stay above; where it has a 0, a 1 is
    # enough.
    result: Value = Const(0, 1)
    start = 0
    while start < len(value):
        # Bits of the limit that are equal are compared together.
        is_one = limit >> start & 1
        end = start
        while end < len(value) and limit >> end & 1 == is_one:
            end += 1
        bits = value[start:end]
        result = bits.all() & result if is_one else bits.any() | result
        start = end
    return result


@dataclass(frozen=True, slots=True, kw_only=True)
class Exit:
    """An exit of a state."""

    taken: Value  # The state, once done, takes this exit.
    state: int  # Number of the state.
    way: Transition


@dataclass(frozen=True, slots=True)
class _Register:
    """A register that is written together with the state: its value by state, and at the end."""

    signal: Signal
    values: Sequence[int]
    if_ended: int

    def at(self, state: int | None) -> int:
        return self.if_ended if state is None else self.values[state]


class Flow(Generic[AnyState]):
    """State, counters and transitions of a program. Not a component: logic of one module.

    Declare constants by :meth:`register`, then add the transitions by :meth:`advance`, once.

    * `m`: module to which the logic is added.
    """

    def __init__(self, m: Module, program: Program[AnyState]):
        self.m, self.program = m, program
        # Everything of a state is a register that is written when the state is chosen. So nothing
        # but the choice itself, by a late bit of a length, comes between two states:
        #
        #   step, constants --> table read at `last_at` --> skips --> choice --> step, constants
        #
        # One-hot, because a choice is then an AND-OR of bits without a decoder before it.
        self._registers: list[_Register] = []
        self._is_complete = False
        numbers = range(len(program.states))
        self._steps = [
            self._add(
                f"step_{each.name}",
                1,
                [int(number == each.number) for number in numbers],
                attrs={REMARK: state_remark(program, each)},
            )
            for each in program.states
        ]
        self.bits = Cat(self._steps)  # All of `step`.
        # Whether the circuit is in a state, by number. The state is one-hot, so each is a register.
        self.step: list[Value] = list(self._steps)
        init = {load.level: load.number for load in program.start.loads}
        # Counts the words of a run.
        self.words = Counter(program.most_loaded(None), "words", init.get(None))
        # Count the elements of loops, by level.
        self.levels = [
            Counter(program.most_loaded(level), f"level_{level}", init.get(level))
            for level in range(program.plan.levels)
        ]
        self.exits = list(self._exits())  # All exits of all states; at most one of them is taken.
        self.exit_ends: Value = Const(0, 1)  # The exit that is taken ends the packet.
        if ending := [each.taken for each in self.exits if each.way.to is None]:
            self.exit_ends = named(m, "exit_ends", any_of(ending))

    def _add(
        self, name: str, bits: int, values: Sequence[int], attrs: Mapping[str, str] | None = None
    ) -> Signal:
        start, end = self.program.start.to, self.program.end
        assert start is not None
        assert not self._is_complete, "the register would keep its initial value"
        signal = Signal(bits, init=values[start], name=name, attrs=attrs)
        self._registers.append(_Register(signal, values, 0 if end is None else values[end]))
        return signal

    def _exits(self) -> Iterator[Exit]:
        for state in self.program.states:
            no_repeat: Value = self.step[state.number]
            for way in state.exits:
                taken = no_repeat
                if way.level is not None:
                    last = self.levels[way.level].last
                    taken = Signal(name=f"again_{state.name}_{way.level}")
                    self.m.d.comb += taken.eq(no_repeat & ~last)
                    no_repeat = no_repeat & last
                elif len(state.exits) > 1:
                    taken = Signal(name=f"leaves_loop_after_{state.name}")
                    self.m.d.comb += taken.eq(no_repeat)
                yield Exit(taken=taken, state=state.number, way=way)

    def register(
        self,
        name: str,
        bits: int,
        of: Callable[[AnyState], int],
        *,
        written: bool = False,
        remark: str = "",
    ) -> Signal | Const:
        """Return a constant of the current state.

        It is a register that is written together with the state, and so is valid at the start of a
        cycle: no logic from the state's number comes before it. A constant that is the same in all
        states is no register.

        * `of`: returns the constant of a state; negative numbers are in two's complement.
        * `written`: the caller writes the register, too.
        * `remark`: a comment on the register in the circuit's text.
        """
        values = [of(state) & ((1 << bits) - 1) for state in self.program.states]
        if written or any(value != values[0] for value in values[1:]):
            return self._add(name, bits, values, {REMARK: remark} if remark else None)
        return Const(values[0], bits)

    def select(self, bits: int, of: Callable[[AnyState], int]) -> Value:
        """Return a constant of the current state, as logic from the state's number."""
        return pick([(self.step[each.number], int(of(each))) for each in self.program.states], bits)

    def on(self, test: Callable[[AnyState], object]) -> Value:
        """Return, as one bit, whether a test holds for the current state."""
        return any_of([self.step[each.number] for each in self.program.states if test(each)])

    def rest_bytes(self, rest: Value) -> Value:
        """Return the size in bytes of the rest that the state takes, without the NUL.

        * `rest`: number of items in the rest.
        """
        units: dict[int, list[Value]] = {}
        for state in self.program.states:
            if state.takes_rest:
                units.setdefault(state.rest_unit, []).append(self.step[state.number])
        cases = [(any_of(on), rest << (unit.bit_length() - 1)) for unit, on in units.items()]
        if len(cases) == 1:
            return cases[0][1]
        return named(self.m, "rest_bytes", pick(cases, self.program.plan.bus_bytes.bit_length()))

    def advance(
        self,
        *,
        moves: Value,
        ends: Value,
        done: Value,
        count: Value,
        single: Value,
        double: Value | None = None,
        nul: bool,
        aborts: Value | None = None,
    ) -> None:
        """Add the logic that goes to the next state, and loads and decrements the counters.

        * `moves`: the state is executed in this cycle.
        * `ends`: the packet ends with the state: the next one is the first one of a packet.
        * `aborts`: else, it is the end of the packet.
        * `done`: else, the state is left through an exit if `done`, and into its body if not.
        * `count`: the length of the current state. If `double` is given: of that of the cycle
          before.
        * `single`, `double`: `single`: at most one pass of the body of the run or loop. `double`:
          two passes; valid only if `single` is 0.
        * `nul`: whether the count of a string includes the NUL.
        """
        m, program, self._is_complete = self.m, self.program, True
        to_exit, to_body = Signal(name="to_exit"), Signal(name="to_body")
        moves_on = named(m, "moves_on", moves & ~ends)
        m.d.comb += [to_exit.eq(moves_on & done), to_body.eq(moves_on & ~done)]
        # At most one exit is taken, and at most one state has a body: each way is one AND, and the
        # next value of a register is an OR of them (`pick`).
        exits = [(each.taken, each.way) for each in self.exits]
        bodies = [(self.step[s.number], s.body) for s in program.states if s.body is not None]
        # Ways that load the same number into the same counter share its logic.
        loads: dict[tuple[int | None, int], list[Value]] = {}
        for when, ways in (
            (moves & ends, [(Const(1, 1), program.start)]),
            (to_exit, exits),
            (to_body, bodies),
        ):
            for taken, way in ways:
                for load in way.loads:
                    loads.setdefault((load.level, load.number), []).append(when & taken)
        for (level, number), on in loads.items():
            (self.words if level is None else self.levels[level]).load(any_of(on), number)
        self._load_lengths(count, single, double, nul)
        for each in self.exits:
            if each.way.level is not None:
                self.levels[each.way.level].down(to_exit & each.taken)
        self.words.down(to_body & self.on(lambda state: state.is_words))
        for counter in (self.words, *self.levels):
            counter.add_logic(m)
        with m.If(moves):
            with m.If(ends):
                m.d.sync += [each.signal.eq(each.at(program.start.to)) for each in self._registers]
            if aborts is not None:
                with m.Elif(aborts):
                    m.d.sync += [each.signal.eq(each.at(None)) for each in self._registers]
            for condition, ways in ((m.Elif(done), exits), (m.Else(), bodies)):
                with condition:
                    for register in self._registers:
                        cases = [(taken, register.at(way.to)) for taken, way in ways]
                        m.d.sync += register.signal.eq(pick(cases, len(register.signal)))

    def go_to(self, states: Mapping[int, Value]) -> None:
        """Change the state, but none of its constants: to the state whose value is high."""
        for number, step in enumerate(self._steps):
            self.m.d.sync += step.eq(states.get(number, 0))

    def _load_lengths(self, count: Value, single: Value, double: Value | None, nul: bool) -> None:
        """Load the counter of the loop or run that the state may begin.

        The counter is not in use before, so every cycle of the state may load it.
        """
        lengths = self.program.lengths.items()
        for level, counter in enumerate(self.levels):
            chosen = [self.step[number] for number, length in lengths if length.level == level]
            if chosen:
                counter.preload(any_of(chosen), count, single, double)
        # Of n items in words of w, (n - 1) // w words are taken before the rest. With a NUL, n is
        # one less than the length on the wire. The division is a shift; what it rounds away is the
        # bit `less`, so that no subtraction of wide numbers comes before the counter.
        groups: dict[tuple[int, bool], list[Value]] = {}
        for number, length in lengths:
            if length.level is None:
                key = length.lanes.bit_length() - 1, length.has_nul and nul
                groups.setdefault(key, []).append(self.step[number])
        for (shift, has_nul), chosen in groups.items():
            less = ~exceeds(count[:shift], int(has_nul)) if shift else Const(1)
            value = count - 1 if has_nul and not shift else count[shift:]
            on = named(self.m, f"begins_words_of_{1 << shift}", any_of(chosen))
            self.words.preload(on, value, single, double, less)
