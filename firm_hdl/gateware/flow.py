"""The control flow of a plan, common to both directions: step, counters, exits."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Generic

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from firm_hdl.gateware.counter import Counter
from firm_hdl.gateware.positions import any_of, pick
from firm_hdl.program import AnyState, Program, Transition

__all__ = ["Flow", "exceeds", "last_word"]

REGISTER_BITS = 32
"""Most bits of a register with an initial value, and of a constant that a register is loaded with.

GHDL 2.0 writes longer constants other than 0 as strings in the Verilog of ``ghdl --synth``.
"""


def last_word(items: Value, lanes: int) -> Value:
    """Return the number of items in the last word of a run that has at least one item."""
    low = items[: lanes.bit_length() - 1]
    return Mux(low.any(), low, lanes) if len(low) else Const(lanes)


def exceeds(value: Value, limit: int) -> Value:
    """Return whether an unsigned number is above a constant, as plain logic: no carry chain."""
    if limit >> len(value):
        return Const(0, 1)
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
    """An exit of a state.

    Attributes
    ----------
    taken : Signal(1)
        The state, once done, takes this exit.
    state : int
        Number of the state.
    way : Transition
    """

    taken: Signal
    state: int
    way: Transition


@dataclass(frozen=True, slots=True)
class _Register:
    """A register that is written together with the number of the state: its value by state."""

    signal: Signal
    values: Sequence[int]
    if_ended: int

    def at(self, state: int | None) -> int:
        """Return the value at a state; `None` is the end of the packet."""
        return self.if_ended if state is None else self.values[state]


class Flow(Generic[AnyState]):
    """State, counters and transitions of a program. Not a component: logic of one module.

    A constant of the states is a register of its own, written together with the state's number. So
    it is valid at the start of a cycle. One that is the same in all states is a `Const`.

    Parameters
    ----------
    m : Module
        Module to which the logic is added.
    program : Program

    Attributes
    ----------
    step : list of Value(1)
        Whether the circuit is in a state, by number.
    traits : SimpleNamespace of Signal or Const
        The constants of the state, by name.
    exits : list of Exit
        All exits of all states; at most one of them is taken.
    exit_ends : Value(1)
        The exit that is taken ends the packet.
    words : Counter
        Counts the words of a run.
    levels : list of Counter
        Count the elements of loops, by level.
    """

    def __init__(self, m: Module, program: Program[AnyState]):
        self.m, self.program = m, program
        self.traits = SimpleNamespace()
        count, most = len(program.states), REGISTER_BITS
        self._steps: list[_Register] = []
        for low in range(0, count, most):
            name = "step" if count <= most else f"step_{low}"
            one_hot = [1 << number >> low & ((1 << most) - 1) for number in range(count)]
            self._steps.append(self._register(name, min(most, count - low), one_hot))
        self._registers = list(self._steps)
        self.step: list[Value] = [bit for each in self._steps for bit in each.signal]

    def _register(self, name: str, bits: int, values: Sequence[int]) -> _Register:
        start, end = self.program.start.to, self.program.end
        assert start is not None
        signal = Signal(bits, init=values[start], name=name)
        return _Register(signal, values, 0 if end is None else values[end])

    def register(
        self, name: str, bits: int, of: Callable[[AnyState], int], *, written: bool = False
    ) -> None:
        """Add a constant of the states to `traits`.

        Parameters
        ----------
        bits : int
            At most 32.
        of : function
            Returns the constant of a state; negative numbers are in two's complement.
        written : bool
            The caller writes the register, too.
        """
        values = [of(state) & ((1 << bits) - 1) for state in self.program.states]
        if written or any(value != values[0] for value in values[1:]):
            self._registers.append(self._register(name, bits, values))
            setattr(self.traits, name, self._registers[-1].signal)
        else:
            setattr(self.traits, name, Const(values[0], bits))

    def add_exits(self) -> None:
        """Add the counters, and the logic that decides which exit is taken."""
        program = self.program
        init = {load.level: load.number for load in program.start.loads}
        self.words = Counter(program.most_words, "words", init.get(None))
        self.levels = [
            Counter(most, f"level_{level}", init.get(level))
            for level, most in enumerate(program.most_elements)
        ]
        self.exits = list(self._exits())
        self.exit_ends = any_of([each.taken for each in self.exits if each.way.to is None])

    def go(self, *, ends: Value, done: Value, aborts: Value | None = None) -> None:
        """Go to the next state; the caller's `m.If` says when.

        Parameters
        ----------
        ends : Value
            To the start of the next packet.
        aborts : Value or None
            Else, to the end of the packet.
        done : Value
            Else, through an exit if `done`, and into the body that the state begins if not.
        """
        exits = [(each.taken, each.way.to) for each in self.exits]
        bodies = [
            (self.step[state.number], state.body.to)
            for state in self.program.states
            if state.body is not None
        ]
        m, sync = self.m, self.m.d.sync
        with m.If(ends):
            sync += [each.signal.eq(each.at(self.program.start.to)) for each in self._registers]
        if aborts is not None:
            with m.Elif(aborts):
                sync += [each.signal.eq(each.at(None)) for each in self._registers]
        for condition, ways in ((m.Elif(done), exits), (m.Else(), bodies)):
            with condition:
                for each in self._registers:
                    choices = [(on, each.at(to)) for on, to in ways]
                    sync += each.signal.eq(pick(choices, len(each.signal)))

    def go_to(self, states: Mapping[int, Value]) -> None:
        """Change the state, but none of its constants: to the state whose value is high."""
        bits = Cat(states.get(i, Const(0, 1)) for i in range(len(self.step)))
        for k, each in enumerate(self._steps):
            self.m.d.sync += each.signal.eq(bits[REGISTER_BITS * k :])

    def on(self, test: Callable[[AnyState], bool]) -> Value:
        """Return, as one bit, whether a test holds for the current state."""
        return any_of([self.step[each.number] for each in self.program.states if test(each)])

    def rest_bytes(self, rest: Value) -> Value:
        """Return the size in bytes of the rest that the state takes, without the NUL.

        Parameters
        ----------
        rest : Value
            Number of items in the rest.
        """
        units: dict[int, list[Value]] = {}
        for state in self.program.states:
            if state.takes_rest:
                units.setdefault(state.rest_unit, []).append(self.step[state.number])
        cases = [(any_of(on), rest << (unit.bit_length() - 1)) for unit, on in units.items()]
        if len(cases) == 1:
            return cases[0][1]
        return pick(cases, self.program.plan.bus_bytes.bit_length())

    def _exits(self) -> Iterator[Exit]:
        for state in self.program.states:
            no_repeat: Value = self.step[state.number]
            for way in state.exits:
                if way.level is None:
                    taken = Signal(name=f"default_{state.number}")
                    self.m.d.comb += taken.eq(no_repeat)
                else:
                    last = self.levels[way.level].last
                    taken = Signal(name=f"again_{state.number}_{way.level}")
                    self.m.d.comb += taken.eq(no_repeat & ~last)
                    no_repeat = no_repeat & last
                yield Exit(taken=taken, state=state.number, way=way)

    def count(
        self,
        *,
        moves: Value,
        ends: Value,
        done: Value,
        count: Value,
        single: Value,
        double: Value | None = None,
        nul: bool,
    ) -> None:
        """Add the logic that loads and decrements the counters.

        Parameters
        ----------
        moves, ends, done : Value
            The state is executed in this cycle (`moves`). If `ends`, the packet ends with it.
            Otherwise, the state is left through an exit if `done`, else into its body.
        count : Value
            The length of the current state. If `double` is given: of that of the cycle before.
        single, double : Value
            `single`: at most one pass of the body of the run or loop.
            `double`: two passes; valid only if `single` is 0.
        nul : bool
            Whether the count of a string includes the NUL.
        """
        to_exit, to_body = Signal(name="step_to_exit"), Signal(name="step_to_body")
        self.m.d.comb += [to_exit.eq(moves & ~ends & done), to_body.eq(moves & ~ends & ~done)]
        self._load_constants(moves & ends, to_exit, to_body)
        self._load_levels(count, single, double)
        self._load_words(count, single, double, nul)
        for each in self.exits:
            if each.way.level is not None:
                self.levels[each.way.level].down(to_exit & each.taken)
        self.words.down(to_body & self.on(lambda state: state.is_words))
        for counter in (self.words, *self.levels):
            counter.add_logic(self.m)

    def _load_constants(self, starts: Value, to_exit: Value, to_body: Value) -> None:
        """Load counters where a run or loop of a constant count starts."""
        ways = [(starts, self.program.start)]
        ways += [(to_exit & each.taken, each.way) for each in self.exits]
        ways += [
            (to_body & self.step[state.number], state.body)
            for state in self.program.states
            if state.body is not None
        ]
        loads: dict[tuple[int | None, int], list[Value]] = {}
        for on, way in ways:
            for load in way.loads:
                loads.setdefault((load.level, load.number), []).append(on)
        for (level, number), on in loads.items():
            counter = self.words if level is None else self.levels[level]
            counter.load(any_of(on), number)

    def _load_levels(self, count: Value, single: Value, double: Value | None) -> None:
        """Load the counter of a loop that the state may begin.

        The counter is not in use before the loop, so every cycle of the state may load it.
        """
        for level, counter in enumerate(self.levels):
            lengths = self.program.lengths.items()
            chosen = [self.step[number] for number, length in lengths if length.level == level]
            if chosen:
                counter.preload(any_of(chosen), count, single, double)

    def _load_words(
        self, count: Value, single: Value, double: Value | None, nul_counts: bool
    ) -> None:
        """Load the counter of words of a run that the state may begin, like `_load_levels`.

        Of n items in words of w, (n - 1) // w words are taken before the rest.
        """
        groups: dict[tuple[int, int], list[Value]] = {}
        for number, length in self.program.lengths.items():
            if length.level is None:
                key = length.lanes.bit_length() - 1, int(length.has_nul and nul_counts)
                groups.setdefault(key, []).append(self.step[number])
        for (shift, nul), chosen in groups.items():
            less = ~exceeds(count[:shift], nul) if shift else Const(1)
            value = count - 1 if nul and not shift else count[shift:]
            self.words.preload(any_of(chosen), value, single, double, less)
