"""The control flow of a plan, common to both directions: step, counters, exits."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.positions import any_of, pick
from firm_hdl.plan import RUN_COUNTER, BeginLoop, BeginRun, Jump, Plan, RunStep, Step

__all__ = ["Counter", "Flow", "exceeds"]


def exceeds(value: Value, limit: int) -> Value:
    """Return whether a number is above a constant, as plain logic: no carry chain."""
    result: Value = Const(0, 1)
    for k in range(len(value)):
        result = (value[k] & result) if limit >> k & 1 else (value[k] | result)
    return result if limit >> len(value) == 0 else Const(0, 1)


class Counter:
    """A counter of words or elements that tells a cycle ahead that one is left.

    The number itself follows a cycle later, so that nothing wide depends on a late decision.

    Attributes
    ----------
    value, less : Signal
        `value - less` words or elements are left, of which one is subtracted if `pending`.
    last : Signal
        One is left.
    """

    def __init__(self, bits: int, name: str, count: int | None = None):
        start = {} if count is None else {"init": count}
        self.value = Signal(max(bits, 3), name=f"{name}_value", reset_less=count is None, **start)
        self.less = Signal(name=f"{name}_less")
        self.last = Signal(name=f"{name}_last", init=count in (None, 1))
        # Without a start value, the counter is loaded before it counts: it needs no reset.
        self.pending = Signal(name=f"{name}_pending", reset_less=count is None)

    def add_logic(self, m: Module) -> None:
        m.d.sync += self.pending.eq(0)
        with m.If(self.pending):
            m.d.sync += self.value.eq(self.value - 1)

    def load(self, m: Module, value: Value | int, last: Value | int, less: Value | int = 0) -> None:
        m.d.sync += [self.value.eq(value), self.last.eq(last), self.less.eq(less)]

    def down(self, m: Module) -> None:
        """Count one, in a cycle in which the enclosing condition holds."""
        high = self.value[3:].any()
        two, three, four = (~high & (self.value[:3] == k) for k in (2, 3, 4))
        m.d.sync += [
            self.pending.eq(1),
            self.last.eq(
                Mux(self.pending, Mux(self.less, four, three), Mux(self.less, three, two))
            ),
        ]


class Flow:
    """Step, counters and jumps of a plan. Not a component: logic of one module.

    What a circuit has to know of a step is a *trait*: a field of the state, written together with
    the step, so that it is known at the start of a cycle.

    Parameters
    ----------
    plan : Plan
    count_bits : int
        Width of the counters.
    fields : mapping of str to int
        Traits and their widths.
    traits : function
        Gives the traits of the step with an index; `None` is the end of the packet.
    has_end : bool
        The end of the packet is a state of its own.

    Attributes
    ----------
    state : View
    step : Signal
        One bit per step.
    exits : list of (Value, int, Jump)
        Each exit: that its step takes it if it is done, its step, and the jump. At most one of the
        conditions is high.
    exit_state, body_state : Value
        The state behind the exit, and in the body of the run or loop that the step begins.
    words : Counter
    levels : list of Counter
    """

    def __init__(
        self,
        m: Module,
        plan: Plan,
        count_bits: int,
        fields: Mapping[str, int],
        traits: Callable[[int | None], Mapping[str, int]],
        *,
        has_end: bool,
    ):
        self.m, self.plan = m, plan
        steps = plan.steps
        self.layout = data.StructLayout({"step": len(steps) + has_end, **fields})
        self._traits, self._has_end = traits, has_end
        self.start = self.encode(plan.start.step)
        self.state = Signal(self.layout, init=self.layout.from_bits(self.start), name="state")
        self.step = self.state.step
        init = {counter: self._counted(plan.start, counter) for counter, _ in plan.start.enter}
        self.words = Counter(count_bits, "words", init.get(RUN_COUNTER))
        self.levels = [
            Counter(count_bits, f"level_{level}", init.get(level)) for level in range(plan.levels)
        ]
        for counter in (self.words, *self.levels):
            counter.add_logic(m)
        self.exits = list(self._exits())
        width = self.layout.size
        self.exit_state = pick(
            [(taken, self.encode(jump.step)) for taken, _, jump in self.exits], width
        )
        self.exit_ends = any_of([taken for taken, _, jump in self.exits if jump.step is None])
        self.body_state = pick(
            [
                (self.step[i], self.encode(i if s.begin is None else s.begin.body.step))
                for i, s in enumerate(steps)
                if isinstance(s, RunStep) or s.begin is not None
            ],
            width,
        )

    def encode(self, index: int | None) -> int:
        """Return the state of a step, as bits."""
        number = len(self.plan.steps) if index is None else index
        fields = {"step": 1 << number if index is not None or self._has_end else 0}
        fields |= self._traits(index)
        bits = 0
        for name, value in fields.items():
            field = self.layout[name]
            bits |= (int(value) & ((1 << field.width) - 1)) << field.offset
        return bits

    def on(self, test: Callable[[Step], bool]) -> Value:
        """Return whether a test holds for the step."""
        return any_of([self.step[i] for i, s in enumerate(self.plan.steps) if test(s)])

    def rest_bytes(self, rest: Value) -> Value:
        """Return the bytes of the items of the rest that the step takes.

        Parameters
        ----------
        rest : Value
            Number of these items.
        """
        units: dict[int, list[Value]] = {}
        for i, s in enumerate(self.plan.steps):
            if s.rest is not None:
                units.setdefault(self.plan.item_bytes(s.rest), []).append(self.step[i])
        cases = [(any_of(on), rest << (unit.bit_length() - 1)) for unit, on in units.items()]
        return cases[0][1] if len(cases) == 1 else pick(cases, self.plan.bus_bytes.bit_length())

    def _exits(self) -> Iterator[tuple[Value, int, Jump]]:
        for i, s in enumerate(self.plan.steps):
            free: Value = self.step[i]
            for level, jump in s.exits.repeats:
                again = Signal(name=f"again_{i}_{level}")
                self.m.d.comb += again.eq(free & ~self.levels[level].last)
                yield again, i, jump
                free = free & self.levels[level].last
            leaves = Signal(name=f"leaves_{i}")
            self.m.d.comb += leaves.eq(free)
            yield leaves, i, s.exits.default

    def leave(self) -> None:
        """Count and load the counters of the exit that is taken, in a cycle that takes one."""
        taken: dict[int, list[Value]] = {}
        exits = iter(self.exits)
        for s in self.plan.steps:
            for level, _ in s.exits.repeats:
                taken.setdefault(level, []).append(next(exits)[0])
            next(exits)
        for level, conditions in taken.items():
            with self.m.If(any_of(conditions)):
                self.levels[level].down(self.m)
        for condition, _, jump in self.exits:
            if jump.enter and jump.step is not None:
                with self.m.If(condition):
                    self.enter(jump)

    def go_into_body(self) -> None:
        """Load the counters of constant count in a body, in a cycle that goes there."""
        for i, s in enumerate(self.plan.steps):
            if s.begin is not None and s.begin.body is not None and s.begin.body.enter:
                with self.m.If(self.step[i]):
                    self.enter(s.begin.body)

    def enter(self, jump: Jump) -> None:
        for counter, _ in jump.enter:
            count = self._counted(jump, counter)
            target = self.words if counter == RUN_COUNTER else self.levels[int(counter)]
            target.load(self.m, count, int(count == 1))

    def _counted(self, jump: Jump, counter: int | str) -> int:
        """Return the words or elements that a jump begins to count."""
        count = dict(jump.enter)[counter]
        if counter != RUN_COUNTER:
            return count
        assert jump.step is not None
        step = self.plan.steps[jump.step]
        assert isinstance(step, RunStep)
        return count // self.plan.leaves[self.plan.runs[step.run].items].lanes

    def load_levels(self, count: Value, one: Value) -> None:
        """Load the counter of a loop that the step may begin.

        It is not in use before, so that this may happen in every cycle of the step.
        """
        for level, counter in enumerate(self.levels):
            chosen = [
                self.step[i]
                for i, s in enumerate(self.plan.steps)
                if isinstance(s.begin, BeginLoop) and s.begin.level == level
            ]
            if chosen:
                with self.m.If(any_of(chosen)):
                    counter.load(self.m, count, one)

    def load_words(self, count: Value, single: Value, *, nul_counts: bool) -> None:
        """Load the counter of words of a run that the step may begin; as `load_levels`.

        Of n items in words of w, (n - 1) // w words are taken in front of the rest.
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
            with self.m.If(any_of(chosen)):
                self.words.load(self.m, value, single, less)
