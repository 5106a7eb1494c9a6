"""The invariants of every plan, checked without knowing how the plan was built.

A plan that passes can be transcribed without further checks: each byte is mapped once, every jump
is sound, each loop ends at the level where it starts, and the rest of each run is taken.
:mod:`firm_hdl.plan.offsets` checks the offsets in the packet. Problems are sentences for people; an
empty list means a good plan.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

from firm_hdl.model import PRIMITIVE_OF
from firm_hdl.plan.conform import against_layout, check_claims
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    Begin,
    BeginLoop,
    BeginRun,
    Fixed,
    IntoBody,
    Jump,
    Leaf,
    LoopAgain,
    LoopEnd,
    MapStep,
    Next,
    Pad,
    Part,
    Plan,
    RunStep,
    Slice,
    successors,
)
from firm_hdl.plan.limits import BUS_BYTES
from firm_hdl.plan.offsets import Span, check_offsets, loop_spans
from firm_hdl.wire import RULES, Layout

__all__ = ["check"]


def check(plan: Plan, layout: Layout | None = None) -> list[str]:
    """Return the problems of a plan: by itself and, if a layout is given, as a plan of it."""
    problems: list[str] = []
    # Each stage relies on the invariants that the stages before it have checked.
    for stage in (_tables, _steps, _header, _transfers, _flow, _rests, check_claims, check_offsets):
        problems.extend(stage(plan))
        if problems:
            return problems
    return [] if layout is None else list(against_layout(plan, layout))


def _tables(plan: Plan) -> Iterator[str]:
    if plan.bus_bytes not in BUS_BYTES:
        yield f"a bus cannot have {plan.bus_bytes} bytes"
        return
    rules = RULES[plan.wire]
    wanted = (rules.header_bytes, rules.max_trailing_bytes)
    if (plan.header_bytes, plan.max_trailing_bytes) != wanted:
        yield f"header or trailing bytes are not those of {plan.wire}"
    if len({leaf.path for leaf in plan.leaves}) != len(plan.leaves):
        yield "two leaves have one path"
    for leaf in plan.leaves:
        yield from (f"leaf {leaf}: {problem}" for problem in _leaf(leaf, plan.bus_bytes))
    if len({run.items for run in plan.runs}) != len(plan.runs):
        yield "two runs have the same items"
    for index, run in enumerate(plan.runs):
        if run.items not in range(len(plan.leaves)) or plan.leaves[run.items].kind != "items":
            yield f"run {index}: its leaf is not of kind 'items'"
        elif plan.leaves[run.items].item_bytes > plan.bus_bytes:
            yield f"run {index}: items are wider than the bus"
        elif run.terminated and plan.leaves[run.items].item_bytes != 1:
            yield f"run {index}: a NUL follows items that are not bytes"
        elif run.terminated and not run.counted:
            yield f"run {index}: a NUL follows items of a constant count"


def _leaf(leaf: Leaf, bus_bytes: int) -> Iterator[str]:
    if not any((leaf.type, signed) in PRIMITIVE_OF for signed in (False, True)):
        yield f"type {leaf.type!r} is not a primitive"
        return
    if (leaf.type, leaf.signed) not in PRIMITIVE_OF:
        yield f"signedness is not that of {leaf.type}"
        return
    suffix = leaf.path[-1] if leaf.path else None
    if leaf.kind != "scalar" and suffix != leaf.kind:
        yield f"path does not end in {leaf.kind!r}"
    special = {"length": "uint32", "trigger": "bool"}.get(leaf.kind, leaf.type)
    if leaf.type != special:
        yield f"a {leaf.kind} is of type {special}, not {leaf.type}"
    item = leaf.primitive
    lanes = max(1, bus_bytes // item.bytes) if leaf.kind == "items" else 1
    if leaf.lanes != lanes:
        yield f"{leaf.lanes} lanes, not {lanes}"


# Each step by itself.


def _steps(plan: Plan) -> Iterator[str]:
    if not plan.steps:
        yield "there are no steps"
    for index, step in enumerate(plan.steps):
        problems = _run(plan, step.run) if isinstance(step, RunStep) else _map(plan, step)
        yield from (f"step {index}: {problem}" for problem in problems)
        if step.align not in (1, 2, 4, 8):
            yield f"step {index}: alignment to {step.align}"


def _header(plan: Plan) -> Iterator[str]:
    rules = RULES[plan.wire]
    slices = [item for step in plan.steps for item in step.slices]
    fixed = [item for item in slices if isinstance(item, Fixed)]
    if fixed != slices[: len(fixed)]:
        yield "fixed bytes follow the header"
    got = [(byte, item.check) for item in fixed for byte in item.data]
    want = [(byte, True) for byte in rules.encapsulation] + [(0, False)] * rules.option_bytes
    if got != want:
        yield f"the header is not that of {plan.wire}"


def _run(plan: Plan, run: int, *, counted: bool = False) -> Iterator[str]:
    if run not in range(len(plan.runs)):
        yield f"there is no run {run}"
    elif counted and not plan.runs[run].counted:
        yield f"{_items(plan, run)} has a constant count, which neither begins nor has a rest"


def _items(plan: Plan, run: int) -> Leaf:
    return plan.items_leaf(run)


def _map(plan: Plan, step: MapStep) -> Iterator[str]:
    wrong = [problem for item in step.slices for problem in _slice(plan, item)]
    if wrong:
        yield from wrong
        return
    at = 0
    for item in step.slices:
        if item.at != at:
            yield f"byte {min(at, item.at)} is not mapped exactly once"
        at = item.at + item.bytes
    if at != step.bytes:
        yield f"the map has {at} bytes, the step {step.bytes}"
    if step.rest is not None:
        yield from _run(plan, step.rest, counted=True)
        if step.bytes > plan.bus_bytes:
            yield f"the map after a rest has {step.bytes} bytes, more than a bus word"
    elif not step.slices:
        yield "there is nothing to do"
    if step.bytes > 2 * plan.bus_bytes:
        yield f"the map has {step.bytes} bytes, more than two bus words"
    for before, part in pairwise(step.parts):
        if not before.completes:
            yield f"{plan.leaves[before.leaf]} is cut by the next part"
        elif before.leaf == part.leaf:
            yield f"two transfers of {plan.leaves[part.leaf]} are in one cycle"
    for item in step.slices[1:]:
        if isinstance(item, Part) and item.first:
            yield f"{plan.leaves[item.leaf]} continues after other bytes"
    lengths = [part.leaf for part in step.parts if plan.leaves[part.leaf].kind == "length"]
    done = [part.leaf for part in step.parts if part.completes and part.leaf in lengths]
    counted = [] if step.begin is None else [step.begin.length]
    if done != counted or (done and step.slices[-1] is not step.parts[-1]):
        yield "a length must be complete in the step that starts what it counts, and in no other"
    if step.begin is not None:
        yield from _begin(plan, step.begin)


def _slice(plan: Plan, item: Slice) -> Iterator[str]:
    if isinstance(item, Pad | Fixed):
        if item.bytes < 1:
            yield f"the slice at byte {item.at} is empty"
        return
    if item.leaf not in range(len(plan.leaves)):
        yield f"there is no leaf {item.leaf}"
        return
    leaf = plan.leaves[item.leaf]
    size = leaf.item_bytes
    sizes = range(size, size * leaf.lanes + 1, size) if size else range(1)
    if item.size not in sizes:
        yield f"a transfer of {leaf} has {item.size} bytes"
    if item.first < 0 or item.first + item.bytes > item.size or (size and item.bytes < 1):
        yield f"{leaf} has no bytes {item.first} to {item.first + item.bytes - 1}"
    if item.end is not None and leaf.kind != "items":
        yield f"{leaf} has a mark of its end, which only items have"


def _begin(plan: Plan, begin: Begin) -> Iterator[str]:
    if begin.limit < 0:
        yield f"a count has the limit {begin.limit}"
    if isinstance(begin, BeginLoop):
        return
    yield from _run(plan, begin.run, counted=True)
    if begin.align not in (1, 2, 4, 8):
        yield f"alignment of items to {begin.align}"


# The transfers of each leaf.


def _transfers(plan: Plan) -> Iterator[str]:
    order: list[int] = []
    parts: dict[int, list[Part]] = {}
    runs: dict[int, set[int]] = {}
    for step in plan.steps:
        for part in step.parts:
            order.append(part.leaf)
            if part.completes:
                parts.setdefault(part.leaf, []).append(part)
        owner = step if isinstance(step, RunStep) else step.begin
        if isinstance(owner, RunStep | BeginRun):
            order.append(plan.runs[owner.run].items)
            runs.setdefault(plan.runs[owner.run].items, set()).add(owner.run)
    for now, leaf in zip([-1, *order], order, strict=False):
        if leaf not in (now, now + 1):
            yield f"leaf {plan.leaves[leaf]} is out of order"
    for index, path in enumerate(plan.leaves):
        ends = _ends(plan, index, parts.get(index, []), sorted(runs.get(index, ())))
        yield from (f"leaf {path}: {problem}" for problem in ends)
    yield from _joints(plan)


def _ends(plan: Plan, leaf: int, parts: list[Part], runs: list[int]) -> Iterator[str]:
    """Check the transfers of a leaf: parts, each of a whole transfer, after at most one run."""
    most = 2 if plan.leaves[leaf].kind == "items" and not runs else 1
    if len(parts) > most or len(runs) > 1 or not (parts or runs):
        yield f"{len(parts)} transfers and {len(runs)} runs"
        return
    if runs and plan.runs[runs[0]].last != (not parts):
        yield "its run and its tail disagree about its end"
    if plan.leaves[leaf].kind != "items" or not parts:
        return
    first, last = parts[0], parts[-1]
    if last.end is None:
        yield "its last transfer has no mark of its end"
    elif isinstance(last.end, LoopEnd) and (runs or len(parts) > 1):
        yield "the last of several transfers is in a loop"
    if len(parts) > 1:
        word = plan.leaves[leaf].lanes * plan.leaves[leaf].item_bytes
        if first.end is not None or first.size != word:
            yield "its first transfer is not a full word, or has a mark of its end"


def _joints(plan: Plan) -> Iterator[str]:
    """Check that a transfer that a step's end cuts continues in the next step and only there."""
    for index, step in enumerate(plan.steps):
        first = step.slices[0] if step.slices else None
        before = plan.steps[index - 1] if index else None
        cut = before.slices[-1] if before is not None and before.slices else None
        open_cut = isinstance(cut, Part) and not cut.completes
        goes_on = isinstance(first, Part) and first.first > 0
        if open_cut or goes_on:
            assert before is not None or not open_cut
            straight = before is not None and before.exits.repeats == () and before.begin is None
            fits = (
                isinstance(cut, Part)
                and isinstance(first, Part)
                and (cut.leaf, cut.size, cut.end) == (first.leaf, first.size, first.end)
                and cut.first + cut.bytes == first.first
                and step.align == 1
            )
            if not straight or not fits:
                yield f"step {index}: the parts of a transfer do not join"
    last = plan.steps[-1].slices[-1:]
    if any(isinstance(item, Part) and not item.completes for item in last):
        yield "the last transfer is cut"


# Control flow.

State = tuple[int, ...]


@dataclass(slots=True)
class _Walk:
    """Follow all jumps. A state is the first steps of the open loops, outermost first."""

    plan: Plan
    states: dict[int, State] = field(default_factory=dict)
    # For the body of a run: what loaded the counter, a jump ("constant") or the start of a run.
    loaded: dict[int, int | str | None] = field(default_factory=dict)
    counts: dict[tuple[int | str, int | None], int] = field(default_factory=dict)
    todo: list[int] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)

    def jump(
        self, jump: Jump, state: State, expected: int, where: str, run: int | None = None
    ) -> None:
        """Follow a jump from a state, and check that it leads to the expected step."""
        loaded: int | str | None = run
        for counter, count in jump.enter:
            if count < 1 or count != self.counts.setdefault((counter, jump.step), count):
                self.problems.append(f"{where}: loads a count of {count}")
            if counter == RUN_COUNTER:
                if loaded is not None:
                    self.problems.append(f"{where}: the counter of the run is loaded twice")
                loaded = "constant"
            elif counter != len(state) or len(state) >= self.plan.levels:
                self.problems.append(f"{where}: loop {counter} inside {len(state)} loops")
            else:
                state = (*state, expected)
        target = len(self.plan.steps) if jump.step is None else jump.step
        if target != expected:
            self.problems.append(f"{where}: goes to step {target}, not {expected}")
        elif jump.step is None:
            if state or loaded is not None:
                self.problems.append(f"{where}: ends within a loop or a run")
        elif target >= len(self.plan.steps):
            self.problems.append(f"{where}: there is no step {target}")
        elif target not in self.states:
            self.states[target] = state
            self.loaded[target] = loaded
            self.todo.append(target)
        elif (state, loaded) != (self.states[target], self.loaded[target]):
            self.problems.append(f"{where}: step {target} is also reached with other open loops")

    def step(self, index: int, spans: dict[Span, int]) -> None:
        step, state, where = self.plan.steps[index], self.states[index], f"step {index}"
        loads: int | str | None = None
        if isinstance(step, RunStep):
            loads = step.run if self.plan.runs[step.run].counted else "constant"
        if self.loaded[index] != loads:
            problem = "the counter of the run is not loaded, or needlessly loaded"
            self.problems.append(f"{where}: {problem}")
        elif isinstance(step, RunStep) and loads == "constant":
            count, leaf = self.counts[RUN_COUNTER, index], _items(self.plan, step.run)
            if count % leaf.lanes:
                self.problems.append(f"{where}: {count} items do not fill words of {leaf.lanes}")
        for part in step.parts:
            if isinstance(part.end, LoopEnd) and part.end.level != len(state) - 1:
                self.problems.append(f"{where}: loop {part.end.level} is not the innermost")
        after = index + 1
        for way, jump in successors(step):
            match way:
                case IntoBody(begin=BeginLoop(level=level)):
                    if level != len(state):
                        self.problems.append(f"{where}: loop {level} inside {len(state)} loops")
                    self.jump(jump, (*state, after), after, f"{where}, body")
                    after = spans.get((len(state), after), after) + 1
                case IntoBody(begin=BeginRun(run=run)):
                    self.jump(jump, state, after, f"{where}, body", run)
                    after += 1
                case LoopAgain(level=level):
                    if level != len(state) - 1:
                        problem = f"{where}: loop {level} ends inside {len(state)} loops"
                        self.problems.append(problem)
                        return
                    self.jump(jump, state, state[-1], f"{where}, loop {level} again")
                    state = state[:-1]
                case Next():
                    self.jump(jump, state, after, f"{where}, next")


def _flow(plan: Plan) -> list[str]:
    walker = _Walk(plan)
    spans = loop_spans(plan)
    walker.jump(plan.start, (), 0, "start")
    while walker.todo and not walker.problems:
        walker.step(walker.todo.pop(), spans)
    if walker.problems:
        return walker.problems
    missed = [index for index in range(len(plan.steps)) if index not in walker.states]
    depth = max(map(len, walker.states.values()))
    if depth != plan.levels:
        walker.problems.append(f"{plan.levels} loop counters, of which {depth} are used")
    return walker.problems + [f"step {index}: is never reached" for index in missed]


def _rests(plan: Plan) -> Iterator[str]:
    """Check that the step after a run takes its rest, and no other step does."""
    # The runs whose rest may be left at each step. `None`: the start, or no run.
    left: dict[int | None, set[int | None]] = {plan.start.step: {None}}
    for step in plan.steps:
        run: int | None = None
        if isinstance(step, RunStep):
            run = step.run if plan.runs[step.run].counted else None
        elif isinstance(step.begin, BeginRun):
            run = step.begin.run
        for way, jump in successors(step):
            # Only the step that starts a run leads to the body of the run.
            if run is None or not isinstance(way, IntoBody):
                left.setdefault(jump.step, set()).add(run)
    for index, step in enumerate(plan.steps):
        runs = left.get(index, set())
        if step.rest is not None and step.rest not in runs:
            yield f"step {index}: {_items(plan, step.rest)} has no rest here"
        for run in sorted(run for run in runs if run not in (None, step.rest)):
            yield f"step {index}: does not take the rest of {_items(plan, run)}"
    for run in sorted(run for run in left.get(None, ()) if run is not None):
        yield f"the end: no step takes the rest of {_items(plan, run)}"
