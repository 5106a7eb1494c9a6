"""The control flow of a plan, common to both directions: step, counters, exits."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from amaranth.hdl import Const, Module, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.counter import Counter
from firm_hdl.gateware.positions import any_of, pick
from firm_hdl.plan import RUN_COUNTER, BeginLoop, BeginRun, Jump, Plan, RunStep, Step

__all__ = ["Flow", "exceeds"]


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


class Flow:
    """Step, counters and jumps of a plan. Not a component: logic of one module.

    What a circuit has to know of a step is a *trait*: a field of the state, written together with
    the step, so that it is known at the start of a cycle.

    Parameters
    ----------
    m : Module
        Gets the logic.
    plan : Plan
    limit : function
        Gives the largest number that a length may have which begins a run or a loop.
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
    start : int
        The state in which a packet starts, as bits.
    exits : list of (Value, int, Jump)
        Each exit: that its step takes it if it is done, its step, and the jump. At most one of the
        conditions is high.
    exit_state, body_state : Value
        The state after the exit, and in the body of the run or loop that the step begins.
    words : Counter
    levels : list of Counter
    """

    def __init__(
        self,
        m: Module,
        plan: Plan,
        limit: Callable[[BeginRun | BeginLoop], int],
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
        most = self._most(limit)
        self.words = Counter(most[RUN_COUNTER], "words", init.get(RUN_COUNTER))
        self.levels = [
            Counter(most[level], f"level_{level}", init.get(level))
            for level in range(plan.levels)
        ]
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
        """Return the state of a step, as bits; `None` is the end of the packet."""
        number = len(self.plan.steps) if index is None else index
        fields = {"step": 1 << number if index is not None or self._has_end else 0}
        fields |= self._traits(index)
        bits = 0
        for name, value in fields.items():
            field = self.layout[name]
            bits |= (int(value) & ((1 << field.width) - 1)) << field.offset
        return bits

    def on(self, test: Callable[[Step], bool]) -> Value:
        """Return, as one bit, whether a test holds for the step of this cycle."""
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
        """Count and load the counters.

        Parameters
        ----------
        moves, ends, done : Value
            The step is executed in this cycle. Then the packet ends; else the step is left through
            an exit (`done`), or goes on in its body.
        count : Value
            The length that the step has, as its run or loop counts it. With `double`, the one that
            the step of the cycle before has.
        single, double : Value
            The body of the run or loop is executed once, if at all; if it is executed more than
            once, it is so twice.
        nul : bool
            The count includes the NUL of a string.
        """
        leaves, stays = Signal(name="step_leaves"), Signal(name="step_stays")
        self.m.d.comb += [leaves.eq(moves & ~ends & done), stays.eq(moves & ~ends & ~done)]
        self._load_constants(moves & ends, leaves, stays)
        self._load_levels(count, single, double)
        self._load_words(count, single, double, nul)
        exits = iter(self.exits)
        for step in self.plan.steps:
            for level, _ in step.exits.repeats:
                self.levels[level].down(leaves & next(exits)[0])
            next(exits)
        self.words.down(stays & self.on(lambda step: isinstance(step, RunStep)))
        for counter in (self.words, *self.levels):
            counter.add_logic(self.m)

    def _load_constants(self, starts: Value, leaves: Value, stays: Value) -> None:
        """Load counters where a jump enters a run or loop of a constant count."""
        jumps = [(starts, self.plan.start)]
        jumps += [(leaves & taken, jump) for taken, _, jump in self.exits if jump.step is not None]
        jumps += [
            (stays & self.step[i], step.begin.body)
            for i, step in enumerate(self.plan.steps)
            if step.begin is not None and step.begin.body is not None
        ]
        loads: dict[tuple[int | str, int], list[Value]] = {}
        for on, jump in jumps:
            for counter, _ in jump.enter:
                loads.setdefault((counter, self._counted(jump, counter)), []).append(on)
        for (counter, number), on in loads.items():
            target = self.words if counter == RUN_COUNTER else self.levels[int(counter)]
            target.load(any_of(on), number)

    def _most(self, limit: Callable[[BeginRun | BeginLoop], int]) -> dict[int | str, int]:
        """Return the largest number that each counter is loaded with."""
        plan = self.plan
        most: dict[int | str, int] = dict.fromkeys([RUN_COUNTER, *range(plan.levels)], 1)
        for jump in plan.jumps():
            for counter, _ in jump.enter:
                most[counter] = max(most[counter], self._counted(jump, counter))
        for step in plan.steps:
            if isinstance(step.begin, BeginRun):
                lanes = plan.leaves[plan.runs[step.begin.run].items].lanes
                most[RUN_COUNTER] = max(most[RUN_COUNTER], limit(step.begin) // lanes)
            elif step.begin is not None:
                most[step.begin.level] = max(most[step.begin.level], limit(step.begin))
        return most

    def _counted(self, jump: Jump, counter: int | str) -> int:
        """Return the words or elements that a jump begins to count."""
        count = dict(jump.enter)[counter]
        if counter != RUN_COUNTER:
            return count
        assert jump.step is not None
        step = self.plan.steps[jump.step]
        assert isinstance(step, RunStep)
        return count // self.plan.leaves[self.plan.runs[step.run].items].lanes

    def _load_levels(self, count: Value, single: Value, double: Value | None) -> None:
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
                counter.load_by_default(any_of(chosen), count, single, double)

    def _load_words(
        self, count: Value, single: Value, double: Value | None, nul_counts: bool
    ) -> None:
        """Load the counter of words of a run that the step may begin; as `_load_levels`.

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
            self.words.load_by_default(any_of(chosen), value, single, double, less)
