"""Check that a plan belongs to a layout: its leaves, bounds and constant counts."""

from __future__ import annotations

from firm_hdl.plan.ir import RUN_COUNTER, LoopEnd, Plan, RunStep
from firm_hdl.wire import (
    ConstantLength,
    Layout,
    LengthField,
    LoopNode,
    Path,
    RunNode,
    Scalar,
    Trigger,
    walk,
)

__all__ = ["against_layout"]

Row = tuple[tuple[str, ...], str, str]


def against_layout(plan: Plan, layout: Layout) -> list[str]:
    """Return the differences between a plan, which is sound by itself, and a layout."""
    comparison = _Comparison(plan)
    comparison.problems += (
        [f"the plan is of {plan.message} on {plan.wire}"]
        if (plan.message, plan.wire) != (layout.message.name, layout.rules.wire)
        else []
    )
    for node in walk(layout.nodes):
        match node:
            case Scalar():
                comparison.leaves.append((node.path, "scalar", node.type.name))
            case Trigger():
                comparison.leaves.append(((*node.path, "trigger"), "trigger", "bool"))
            case RunNode():
                comparison.run(node)
            case LoopNode(length=LengthField() as length):
                comparison.length(node.path, length, terminated=False)
            case LoopNode(length=ConstantLength(count=count)):
                comparison.counts.append(count)
    if comparison.leaves != [(leaf.path, leaf.kind, leaf.type) for leaf in plan.leaves]:
        comparison.problems.append("leaves are not those of the layout")
    if comparison.counts != _loop_counts(plan):
        comparison.problems.append("constant loops are not those of the layout")
    return comparison.problems


class _Comparison:
    def __init__(self, plan: Plan):
        self.plan = plan
        self.leaves: list[Row] = []
        self.counts: list[int] = []
        self.problems: list[str] = []
        self.totals = _totals(plan)
        self.begins = plan.begins
        self.loop_ends = {
            part.leaf for step in plan.steps for part in step.parts if isinstance(part.end, LoopEnd)
        }

    def length(self, path: Path, length: LengthField, *, terminated: bool) -> None:
        name, bound = ".".join(path), length.bound
        begin = self.begins.get(len(self.leaves))
        self.leaves.append(((*path, "length"), "length", "uint32"))
        if begin is None:
            self.problems.append(f"{name} has no length")
        elif bound is not None and begin.limit > bound:
            self.problems.append(f"{name} may have more than {bound} elements")
        elif self.plan.has_nul(begin) != terminated:
            self.problems.append(f"{name} must have a NUL in both plan and layout, or in neither")

    def run(self, node: RunNode) -> None:
        name = ".".join(node.path)
        # Items wider than the bus are planned as a loop over single items.
        is_loop = node.item.bytes > self.plan.bus_bytes
        match node.length:
            case LengthField() as length:
                self.length(node.path, length, terminated=node.terminated)
            case ConstantLength(count=count):
                is_loop &= count > 1
                self.counts += [count] if is_loop else []
                total = self.totals.get(len(self.leaves))
                if total != (1 if is_loop else count):
                    self.problems.append(f"{name} has {total} items, not {count}")
        if (len(self.leaves) in self.loop_ends) != is_loop:
            kind = "a loop" if is_loop else "an array"
            self.problems.append(f"the last item of {name} must be that of {kind}")
        self.leaves.append(((*node.path, "items"), "items", node.item.name))


def _loop_counts(plan: Plan) -> list[int]:
    """Return the counts of all loops of constant count, in wire order, outer ones first."""
    counts = {
        (jump.step, counter): count
        for jump in plan.jumps()
        for counter, count in jump.enter
        if isinstance(counter, int) and jump.step is not None
    }
    return [counts[key] for key in sorted(counts)]


def _totals(plan: Plan) -> dict[int, int]:
    """Return the number of items of each leaf with a constant one: of parts and constant runs."""
    totals: dict[int, int] = {}
    runs: dict[int, int] = {}
    for step in plan.steps:
        for part in step.parts:
            if part.completes and plan.leaves[part.leaf].kind == "items":
                count = part.size // plan.leaves[part.leaf].item_bytes
                totals[part.leaf] = totals.get(part.leaf, 0) + count
    for jump in plan.jumps():
        target = None if jump.step is None else plan.steps[jump.step]
        for counter, count in jump.enter:
            if counter == RUN_COUNTER and isinstance(target, RunStep):
                runs[target.run] = count
    for run, count in runs.items():
        totals[plan.runs[run].items] = totals.get(plan.runs[run].items, 0) + count
    return totals
