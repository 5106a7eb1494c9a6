"""Control flow that both converters share: step number, counters, runs, and exits.

Both converters transcribe the same plan. So both have one step number, the loop counters, and the
count of a run's items. They differ only in where a length comes from and in what they do with the
bytes.
"""

from __future__ import annotations

from amaranth.hdl import Const, Module, Mux, Signal, Value

from firm_hdl.plan import RUN_COUNTER, BeginLoop, Exits, Jump, Plan, RunStep, Step, Take

__all__ = ["Control"]


class Control:
    """Registers and decisions of a plan's control flow. Not a component: adds logic to a module.

    Parameters
    ----------
    plan : Plan
    count_bits : int or None
        Width of the counters. `None`: as wide as the limits of the plan need, which is enough for a
        deserializer.

    Attributes
    ----------
    step : Signal
        Number of the step.
    levels : list of Signal
        Elements left of each loop, including the current one.
    run_left : Signal
        Items left of the run, including a terminator, in the body of the run.
    count : Signal
        Set by the user in a step that begins a run or a loop: the number of items or elements, as
        on the wire (including a terminator). Don't care if `some` is 0.
    some : Signal
        Set by the user in such a step: `count` is non-zero and was decoded without error.
    left : Signal
        Items of the run, including a terminator, that are left before this cycle.
    final : Signal
        The run ends in this cycle. Don't care in a step without a run.
    run_bytes : Signal
        Bytes of the run in this cycle; 0 in a step without a run.
    has_items : Signal
        These bytes contain items, not only a terminator.
    last_items : Signal
        No items follow those of this cycle.
    lane_used : Signal
        Bit k: lane k of the transfer is an item.
    base : Signal
        Bytes of the step in front of the run, including the gap if the run or loop is not empty.
    done : Signal
        The step is left through its exits when it completes.
    ends : Signal
        The packet ends with this step.
    align : Signal
        Alignment of the next step: mask of the low bits of a position that must be zero.
    """

    def __init__(self, plan: Plan, *, count_bits: int | None = None):
        self.plan = plan
        limits = [plan.most(step.begin) for step in plan.steps if step.begin is not None]
        limits += [count for jump in plan.jumps() for _, count in jump.enter]
        bits = max(limits, default=1).bit_length()
        if count_bits is not None and plan.counted:
            bits = max(bits, count_bits)
        self.bits = bits
        # At least one bit: Yosys writes a signal of width 0 as a signal of width 2.
        self.step = Signal(range(max(2, len(plan.steps))), init=plan.start.step or 0)
        init = dict(plan.start.enter)
        self.levels = [
            Signal(bits, name=f"level_{level}", init=init.get(level, 0))
            for level in range(plan.levels)
        ]
        self.run_left = Signal(bits, init=init.get(RUN_COUNTER, 0))
        self.count = Signal(bits)
        self.some = Signal()
        bus = plan.bus_bytes
        self.left = Signal(bits)
        self.most_items = Signal(range(bus + 2))
        self.unit_log2 = Signal(range(7))
        self.terminated = Signal()
        self.running = Signal()
        self.allowed = Signal()
        self.final = Signal()
        self.run_bytes = Signal(range(bus + 2))
        self.has_items = Signal()
        self.last_items = Signal()
        self.lane_used = Signal(bus)
        most = max(step.bytes + step.gap for step in plan.steps)
        self.base = Signal(range(most + 1))
        self.done = Signal()
        self.ends = Signal()
        self.align = Signal(3)
        self.next_step = Signal.like(self.step)

    def add_run_logic(self, m: Module) -> None:
        """Add the logic that all runs share: how many items and bytes this cycle takes."""
        bus = self.plan.bus_bytes
        terminator = self.terminated
        small = Signal(range(bus + 2))
        m.d.comb += [
            small.eq(self.left),
            # A wide comparison would be slow, and this is on the longest path.
            self.final.eq(~self.left[len(small) :].any() & (small <= self.most_items)),
            self.has_items.eq(self.allowed & (self.left > terminator)),
        ]
        with m.If(self.running):
            m.d.comb += self.run_bytes.eq(Mux(self.final, small << self.unit_log2, bus))
        for unit in range(4):
            lanes = bus >> unit
            if not lanes:
                break
            with m.If(self.unit_log2 == unit):
                m.d.comb += self.last_items.eq(self.left <= lanes + terminator)
        for lane in range(bus):
            m.d.comb += self.lane_used[lane].eq(self.left > lane + terminator)

    def add_step(self, m: Module, step: Step) -> None:
        """Add the decisions of a step, inside the case that selects it."""
        m.d.comb += self.base.eq(step.bytes)
        begin = step.begin
        if isinstance(step, RunStep):
            self._run(m, step.take, self.run_left)
            m.d.comb += [self.done.eq(self.final), self.allowed.eq(1)]
        elif begin is None:
            m.d.comb += self.done.eq(1)
        else:
            if step.gap:
                m.d.comb += self.base.eq(step.bytes + Mux(self.count.any(), step.gap, 0))
            m.d.comb += self.done.eq(~self.some)
            if step.take is not None:
                self._run(m, step.take, self.count)
                m.d.comb += [self.allowed.eq(self.some), self.done.eq(~self.some | self.final)]
        # The next step and its alignment. The counters change only when the step completes.
        with m.If(self.done):
            self._exits(m, step.exits)
        if begin is not None and begin.body is not None:
            with m.Else():
                self._goto(m, begin.body)
        elif isinstance(step, RunStep):
            with m.Else():
                m.d.comb += self.next_step.eq(self.step)

    def add_counters(self, m: Module, step: Step) -> None:
        """Add the changes of counters when the step completes, inside its case."""
        begin = step.begin
        if isinstance(step, RunStep):
            m.d.sync += self.run_left.eq(self.run_left - self._lanes(step.run))
        with m.If(self.done):
            waiting = Const(1)
            for level, jump in step.exits.repeats:
                again = self.levels[level] > 1
                with m.If(waiting & again):
                    m.d.sync += self.levels[level].eq(self.levels[level] - 1)
                    self._enter(m, jump)
                waiting = waiting & ~again
            with m.If(waiting):
                self._enter(m, step.exits.default)
                if step.exits.default.step is None:
                    self._enter(m, self.plan.start)
        if begin is not None and begin.body is not None:
            with m.Else():
                if isinstance(begin, BeginLoop):
                    m.d.sync += self.levels[begin.level].eq(self.count)
                elif begin.head:
                    m.d.sync += self.run_left.eq(self.count - self._lanes(begin.run))
                else:
                    m.d.sync += self.run_left.eq(self.count)
                self._enter(m, begin.body)

    def _lanes(self, run: int) -> int:
        return self.plan.leaves[self.plan.runs[run].items].lanes

    def _run(self, m: Module, take: Take, left: Value) -> None:
        unit = self.plan.item_bytes(take.run)
        m.d.comb += [
            self.running.eq(1),
            self.left.eq(left),
            self.most_items.eq(take.head // unit),
            self.unit_log2.eq(unit.bit_length() - 1),
            self.terminated.eq(self.plan.runs[take.run].terminated),
        ]

    def _enter(self, m: Module, jump: Jump) -> None:
        for counter, count in jump.enter:
            target = self.run_left if counter == RUN_COUNTER else self.levels[int(counter)]
            m.d.sync += target.eq(count)

    def _goto(self, m: Module, jump: Jump) -> None:
        if jump.step is None:
            m.d.comb += [self.ends.eq(1), self.next_step.eq(self.plan.start.step or 0)]
        else:
            align = self.plan.steps[jump.step].align
            m.d.comb += [self.next_step.eq(jump.step), self.align.eq(align - 1)]

    def _exits(self, m: Module, exits: Exits) -> None:
        self._goto(m, exits.default)
        # Later statements win, so the innermost loop comes last.
        for level, jump in reversed(exits.repeats):
            with m.If(self.levels[level] > 1):
                m.d.comb += self.ends.eq(0)
                m.d.comb += self.align.eq(0)
                self._goto(m, jump)
