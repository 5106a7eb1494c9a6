"""The control flow of a plan, common to both directions: step, counters, exits."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import SimpleNamespace

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from firm_hdl.gateware.counter import Counter
from firm_hdl.gateware.positions import any_of, pick
from firm_hdl.plan import RUN_COUNTER, BeginLoop, BeginRun, Jump, Plan, RunStep, Step

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
    """An exit of a step.

    Attributes
    ----------
    taken : Signal(1)
        The step, once done, takes this exit.
    step : int
        Index of the step.
    jump : Jump
    level : int or None
        The loop that the exit repeats; `None` for the default exit.
    """

    taken: Signal
    step: int
    jump: Jump
    level: int | None


class Flow:
    """Step, counters and jumps of a plan. Not a component: logic of one module.

    A *trait* is what a circuit has to know of a step. Each trait is a register of its own, written
    together with the step. So traits are valid at the start of a cycle. A trait that is the same at
    all steps is a constant.

    Parameters
    ----------
    m : Module
        Module to which the logic is added.
    plan : Plan
    limit : function
        Returns the largest count of a run or loop that a length begins.
    widths : mapping of str to int
        Widths of the traits in bits, by name; at most 32.
    traits : function
        Returns the traits of the step with an index; `None` is the end of the packet. Traits that
        it leaves out are 0.
    has_end : bool
        The end of the packet is a state of its own.
    written : str
        A trait that the caller writes, too.

    Attributes
    ----------
    step : list of Value(1)
        Whether the circuit is at a step, by index. One more at the end if `has_end`.
    traits : SimpleNamespace of Signal or Const
        The traits of the step, by name.
    exits : list of Exit
        All exits of all steps; at most one of them is taken.
    exit_ends : Value(1)
        The exit that is taken ends the packet.
    words : Counter
        Counts the words of a run.
    levels : list of Counter
        Count the elements of loops, by level.
    """

    def __init__(
        self,
        m: Module,
        plan: Plan,
        limit: Callable[[BeginRun | BeginLoop], int],
        widths: Mapping[str, int],
        traits: Callable[[int | None], Mapping[str, int]],
        *,
        has_end: bool,
        written: str = "",
    ):
        self.m, self.plan = m, plan
        self._traits, self._has_end = traits, has_end
        self._widths = self._step_widths() | dict(widths)
        start = self._state(plan.start.step)
        others = [self._state(i) for i in [*range(len(plan.steps)), *([None] if has_end else [])]]
        self._registers = {
            name: Signal(width, init=start[name], name=name)
            for name, width in self._widths.items()
            if name not in widths or name == written or any(s[name] != start[name] for s in others)
        }
        self.step: list[Value] = [
            bit for name in self._step_widths() for bit in self._registers[name]
        ]
        self.traits = SimpleNamespace(
            **{
                name: self._registers.get(name, Const(start[name], width))
                for name, width in widths.items()
            }
        )
        init = {
            counter: self._words_or_elements(plan.start, counter) for counter, _ in plan.start.enter
        }
        most = self._most(limit)
        self.words = Counter(most[RUN_COUNTER], "words", init.get(RUN_COUNTER))
        self.levels = [
            Counter(most[level], f"level_{level}", init.get(level)) for level in range(plan.levels)
        ]
        self.exits = list(self._exits())
        self.exit_ends = any_of([each.taken for each in self.exits if each.jump.step is None])

    def _step_widths(self) -> dict[str, int]:
        """Return the registers of the step, which is one-hot: their names and widths."""
        count, most = len(self.plan.steps) + self._has_end, REGISTER_BITS
        if count <= most:
            return {"step": count}
        return {f"step_{k}": min(most, count - k) for k in range(0, count, most)}

    def _state(self, index: int | None) -> dict[str, int]:
        """Return the values of all registers at a step; `None` is the end of the packet."""
        number = len(self.plan.steps) if index is None else index
        one_hot = 1 << number if index is not None or self._has_end else 0
        state = dict.fromkeys(self._widths, 0)
        for k, (name, width) in enumerate(self._step_widths().items()):
            state[name] = one_hot >> REGISTER_BITS * k & ((1 << width) - 1)
        for name, value in self._traits(index).items():
            state[name] = int(value) & ((1 << self._widths[name]) - 1)
        return state

    def go(self, *, ends: Value, done: Value, aborts: Value | None = None) -> None:
        """Go to the next step; the caller's `m.If` says when.

        Parameters
        ----------
        ends : Value
            To the start of the next packet.
        aborts : Value or None
            Else, to the end of the packet.
        done : Value
            Else, through an exit if `done`, and into the body that the step begins if not.
        """
        start, end = self._state(self.plan.start.step), self._state(None)
        exits = [(each.taken, self._state(each.jump.step)) for each in self.exits]
        bodies = [
            (self.step[i], self._state(i if s.begin is None else s.begin.body.step))
            for i, s in enumerate(self.plan.steps)
            if isinstance(s, RunStep) or s.begin is not None
        ]
        registers = self._registers.items()
        m, sync = self.m, self.m.d.sync
        with m.If(ends):
            sync += [register.eq(start[name]) for name, register in registers]
        if aborts is not None:
            with m.Elif(aborts):
                sync += [register.eq(end[name]) for name, register in registers]
        for condition, cases in ((m.Elif(done), exits), (m.Else(), bodies)):
            with condition:
                for name, register in registers:
                    choices = [(on, state[name]) for on, state in cases]
                    sync += register.eq(pick(choices, len(register)))

    def go_to(self, steps: Mapping[int, Value]) -> None:
        """Change the step, but no trait: to the step whose value is high."""
        bits = Cat(steps.get(i, Const(0, 1)) for i in range(len(self.step)))
        for k, name in enumerate(self._step_widths()):
            self.m.d.sync += self._registers[name].eq(bits[REGISTER_BITS * k :])

    def on(self, test: Callable[[Step], bool]) -> Value:
        """Return, as one bit, whether a test holds for the current step."""
        return any_of([self.step[i] for i, s in enumerate(self.plan.steps) if test(s)])

    def rest_bytes(self, rest: Value) -> Value:
        """Return the size in bytes of the rest that the step takes, without the NUL.

        Parameters
        ----------
        rest : Value
            Number of items in the rest.
        """
        units: dict[int, list[Value]] = {}
        for i, s in enumerate(self.plan.steps):
            if s.rest is not None:
                units.setdefault(self.plan.item_bytes(s.rest), []).append(self.step[i])
        cases = [(any_of(on), rest << (unit.bit_length() - 1)) for unit, on in units.items()]
        return cases[0][1] if len(cases) == 1 else pick(cases, self.plan.bus_bytes.bit_length())

    def _exits(self) -> Iterator[Exit]:
        for i, s in enumerate(self.plan.steps):
            no_repeat: Value = self.step[i]
            for level, jump in s.exits.repeats:
                again = Signal(name=f"again_{i}_{level}")
                self.m.d.comb += again.eq(no_repeat & ~self.levels[level].last)
                yield Exit(taken=again, step=i, jump=jump, level=level)
                no_repeat = no_repeat & self.levels[level].last
            default = Signal(name=f"default_{i}")
            self.m.d.comb += default.eq(no_repeat)
            yield Exit(taken=default, step=i, jump=s.exits.default, level=None)

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
            The step is executed in this cycle (`moves`). If `ends`, the packet ends with it.
            Otherwise, the step is left through an exit if `done`, else into its body.
        count : Value
            The length of the current step. If `double` is given: of the step in the cycle before.
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
            if each.level is not None:
                self.levels[each.level].down(to_exit & each.taken)
        self.words.down(to_body & self.on(lambda step: isinstance(step, RunStep)))
        for counter in (self.words, *self.levels):
            counter.add_logic(self.m)

    def _load_constants(self, starts: Value, to_exit: Value, to_body: Value) -> None:
        """Load counters where a jump enters a run or loop of a constant count."""
        jumps = [(starts, self.plan.start)]
        jumps += [
            (to_exit & each.taken, each.jump) for each in self.exits if each.jump.step is not None
        ]
        jumps += [
            (to_body & self.step[i], step.begin.body)
            for i, step in enumerate(self.plan.steps)
            if step.begin is not None
        ]
        loads: dict[tuple[int | str, int], list[Value]] = {}
        for on, jump in jumps:
            for counter, _ in jump.enter:
                loads.setdefault((counter, self._words_or_elements(jump, counter)), []).append(on)
        for (counter, number), on in loads.items():
            target = self.words if counter == RUN_COUNTER else self.levels[int(counter)]
            target.load(any_of(on), number)

    def _most(self, limit: Callable[[BeginRun | BeginLoop], int]) -> dict[int | str, int]:
        """Return the largest number that each counter is loaded with."""
        plan = self.plan
        most: dict[int | str, int] = dict.fromkeys([RUN_COUNTER, *range(plan.levels)], 1)
        for jump in plan.jumps():
            for counter, _ in jump.enter:
                most[counter] = max(most[counter], self._words_or_elements(jump, counter))
        for step in plan.steps:
            if isinstance(step.begin, BeginRun):
                lanes = plan.items_leaf(step.begin.run).lanes
                most[RUN_COUNTER] = max(most[RUN_COUNTER], limit(step.begin) // lanes)
            elif step.begin is not None:
                most[step.begin.level] = max(most[step.begin.level], limit(step.begin))
        return most

    def _words_or_elements(self, jump: Jump, counter: int | str) -> int:
        """Return the number of words or elements that a jump loads into a counter."""
        count = dict(jump.enter)[counter]
        if counter != RUN_COUNTER:
            return count
        assert jump.step is not None
        step = self.plan.steps[jump.step]
        assert isinstance(step, RunStep)
        return count // self.plan.items_leaf(step.run).lanes

    def _load_levels(self, count: Value, single: Value, double: Value | None) -> None:
        """Load the counter of a loop that the step may begin.

        The counter is not in use before the loop, so every cycle of the step may load it.
        """
        for level, counter in enumerate(self.levels):
            chosen = [
                self.step[i]
                for i, s in enumerate(self.plan.steps)
                if isinstance(s.begin, BeginLoop) and s.begin.level == level
            ]
            if chosen:
                counter.preload(any_of(chosen), count, single, double)

    def _load_words(
        self, count: Value, single: Value, double: Value | None, nul_counts: bool
    ) -> None:
        """Load the counter of words of a run that the step may begin, like `_load_levels`.

        Of n items in words of w, (n - 1) // w words are taken before the rest.
        """
        plan = self.plan
        groups: dict[tuple[int, int], list[Value]] = {}
        for i, s in enumerate(plan.steps):
            if isinstance(s.begin, BeginRun):
                run = plan.runs[s.begin.run]
                shift = plan.leaves[run.items].lanes.bit_length() - 1
                groups.setdefault((shift, int(run.terminated and nul_counts)), []).append(
                    self.step[i]
                )
        for (shift, nul), chosen in groups.items():
            less = ~exceeds(count[:shift], nul) if shift else Const(1)
            value = count - 1 if nul and not shift else count[shift:]
            self.words.preload(any_of(chosen), value, single, double, less)
