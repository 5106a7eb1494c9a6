"""Link a plan for gateware: where the control flow goes from each step.

The circuits are made from steps with jumps between them. A jump says which counters of constant
runs and loops are loaded on the way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from firm_hdl.plan import tree
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    ArrayEnd,
    BeginLoop,
    BeginRun,
    Claim,
    Exits,
    Fixed,
    Jump,
    LoopEnd,
    MapStep,
    Pad,
    Part,
    Run,
    RunStep,
    Slice,
    Step,
)
from firm_hdl.plan.ir.plan import Linked

__all__ = ["link"]


def link(plan: tree.Plan) -> Linked:
    """Link the steps of a plan."""
    linker = _Linker(plan)
    end = Exits(default=Jump(step=None))
    linker.block(plan.items, 0, 0, end)
    return Linked(
        plan=plan,
        runs=tuple(linker.runs),
        start=_enter(plan.items, 0, 0),
        steps=tuple(linker.steps),
    )


def _enter(items: Sequence[tree.Item], index: int, level: int) -> Jump:
    """Return the jump to the first step of items."""
    first = items[0]
    loads: list[tuple[int | str, int]] = []
    while isinstance(first, tree.Loop):
        assert isinstance(first.count, tree.Constant)
        loads.append((level, first.count.number))
        level += 1
        first = first.body[0]
    if isinstance(first, tree.Run):
        assert isinstance(first.count, tree.Constant)
        loads.append((RUN_COUNTER, first.count.number))
    return Jump(enter=tuple(loads), step=index)


@dataclass(slots=True)
class _Linker:
    plan: tree.Plan
    runs: list[Run] = field(default_factory=list)
    # Index of each run by the leaf of its items.
    numbers: dict[int, int] = field(init=False)
    steps: list[Step] = field(default_factory=list)

    def __post_init__(self) -> None:
        runs = [item for item in tree.walk(self.plan.items) if isinstance(item, tree.Run)]
        self.numbers = {run.leaf: number for number, run in enumerate(runs)}
        self.runs = [
            Run(
                items=run.leaf,
                counted=isinstance(run.count, tree.Length),
                terminated=run.count.nul,
                last=not run.has_tail,
            )
            for run in runs
        ]

    def block(self, items: Sequence[tree.Item], index: int, level: int, after: Exits) -> None:
        """Link items inside `level` loops; `after` are the exits behind the last one."""
        for place, item in enumerate(items):
            rest = items[place + 1 :]
            exits = after
            if rest:
                following = rest[0]
                is_counted = not isinstance(following, tree.Step) and isinstance(
                    following.count, tree.Length
                )
                if not is_counted:
                    exits = Exits(default=_enter(rest, index + item.steps, level))
                elif rest[1:]:
                    number = index + item.steps + following.steps
                    exits = Exits(default=_enter(rest[1:], number, level))
            match item:
                case tree.Step():
                    begin = self.begin(rest[0], index + 1, level) if rest else None
                    self.steps.append(self.step(item, level, begin, exits))
                case tree.Run():
                    align = item.align if isinstance(item.count, tree.Constant) else 1
                    run = self.numbers[item.leaf]
                    self.steps.append(RunStep(align=align, run=run, exits=exits))
                case tree.Loop():
                    again = (level, _enter(item.body, index, level + 1))
                    around = Exits(repeats=(again, *exits.repeats), default=exits.default)
                    self.block(item.body, index, level + 1, around)
            index += item.steps

    def begin(self, item: tree.Item, index: int, level: int) -> BeginRun | BeginLoop | None:
        if isinstance(item, tree.Step) or isinstance(item.count, tree.Constant):
            return None
        count = item.count
        claim = None
        if charge := count.charge:
            claim = Claim(
                bytes=charge.bytes,
                least=charge.charged_from,
                saved=charge.padding_credit,
                total=charge.budget,
            )
        length, limit = count.leaf, count.limit
        if isinstance(item, tree.Loop):
            body = _enter(item.body, index, level + 1)
            return BeginLoop(length=length, limit=limit, level=level, claim=claim, body=body)
        return BeginRun(
            length=length,
            limit=limit,
            run=self.numbers[item.leaf],
            align=item.align,
            claim=claim,
            body=Jump(step=index),
        )

    def step(
        self, step: tree.Step, level: int, begin: BeginRun | BeginLoop | None, exits: Exits
    ) -> MapStep:
        slices: list[Slice] = []
        for at, item in step.places:
            match item:
                case tree.Pad():
                    slices.append(Pad(at=at, bytes=item.bytes))
                case tree.Fixed():
                    slices.append(Fixed(at=at, data=item.data, check=item.check))
                case tree.Part():
                    end: ArrayEnd | LoopEnd | None = None
                    if item.last:
                        end = ArrayEnd() if item.last == "always" else LoopEnd(level=level - 1)
                    slices.append(
                        Part(
                            at=at,
                            bytes=item.bytes,
                            leaf=item.leaf,
                            first=item.first,
                            size=item.size,
                            end=end,
                        )
                    )
        return MapStep(
            rest=None if step.rest is None else self.numbers[step.rest],
            align=step.align,
            bytes=step.bytes,
            slices=tuple(slices),
            begin=begin,
            exits=exits,
        )
