"""Check that a plan belongs to a layout: its leaves, bounds and constant counts, and its claims."""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.plan.ir import RUN_COUNTER, BeginLoop, BeginRun, Claim, LoopEnd, Plan, RunStep
from firm_hdl.plan.limits import counted_from
from firm_hdl.plan.offsets import loop_spans
from firm_hdl.wire import (
    RULES,
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

__all__ = ["against_layout", "check_claims"]

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
    if not comparison.problems:
        comparison.problems += _claims(plan, layout)
    return comparison.problems


def check_claims(plan: Plan) -> Iterator[str]:
    """Check what the lengths of a plan claim, as far as this follows from the plan alone."""
    least_bytes = counted_from(plan.max_message_bytes)
    outer = _outermost(plan)
    begins = {index: step.begin for index, step in enumerate(plan.steps) if step.begin is not None}
    saved = {begin.claim.saved for begin in begins.values() if begin.claim}
    if len(saved) > 1 or not saved <= {0, 2 * (RULES[plan.wire].max_align - 1)}:
        yield f"lengths save {', '.join(map(str, sorted(saved)))} bytes"
    shared = {outer[index] for index, begin in begins.items() if begin.claim and index in outer}
    for index, begin in begins.items():
        claim, most = begin.claim, plan.max_count(begin)
        item = plan.item_bytes(begin.run) if isinstance(begin, BeginRun) else 0
        where = f"step {index}: {plan.leaves[begin.length]}"
        if claim is None:
            if index in shared or (index in outer and most * item >= least_bytes):
                yield f"{where} claims nothing"
            continue
        if claim.bytes < 1 or item not in (0, claim.bytes):
            yield f"{where} claims {claim.bytes} bytes for each item"
        elif claim.least != -(-least_bytes // claim.bytes):
            yield f"{where} is counted from {claim.least}"
        is_inside = index in outer and begins[outer[index]].claim is not None
        is_outermost = index in shared
        if is_inside is is_outermost or is_outermost is (claim.total is None):
            yield f"{where} has a budget, or renews it, at the wrong place"
        elif claim.total is not None:
            room = plan.max_message_bytes - plan.header_bytes
            if not most * claim.bytes - claim.saved <= claim.total <= room:
                yield f"{where} has a budget of {claim.total} bytes"


def _outermost(plan: Plan) -> dict[int, int]:
    """Return, for each step inside a sequence of messages, the step that begins the outermost."""
    spans, outer = loop_spans(plan), dict[int, int]()
    for index, step in enumerate(plan.steps):
        if isinstance(step.begin, BeginLoop) and index not in outer:
            first = step.begin.body.step or 0
            last = spans.get((step.begin.level, first), first)
            outer.update(dict.fromkeys(range(first, last + 1), index))
    return outer


def _claims(plan: Plan, layout: Layout) -> Iterator[str]:
    """Compare what lengths claim with the layout: paths tell which length is inside which."""
    nodes = {
        node.path: node
        for node in walk(layout.nodes)
        if isinstance(node, RunNode | LoopNode) and isinstance(node.length, LengthField)
    }
    loops = {path: node for path, node in nodes.items() if isinstance(node, LoopNode)}
    is_padded = any(node.repeated_bytes > node.min_body_bytes for node in loops.values())
    saved = 2 * (layout.rules.max_align - 1) if is_padded else 0
    least_bytes = counted_from(plan.max_message_bytes)
    wanted: dict[Path, Claim] = {}
    for leaf, begin in plan.begins.items():
        path = plan.leaves[leaf].path[:-1]
        node = nodes[path]
        each = max(1, node.item.bytes if isinstance(node, RunNode) else node.repeated_bytes)
        around = [loop for loop in loops if loop == path[: len(loop)] and loop != path]
        least = -(-least_bytes // each)
        if not around or plan.max_count(begin) < least:
            continue
        outermost = min(around, key=len)
        wanted[path] = Claim(bytes=each, least=least, saved=saved)
        each = max(1, loops[outermost].repeated_bytes)
        total = plan.max_message_bytes - layout.min_bytes
        least = -(-least_bytes // each)
        wanted[outermost] = Claim(bytes=each, least=least, saved=saved, total=total)
    for leaf, begin in plan.begins.items():
        path = plan.leaves[leaf].path[:-1]
        if begin.claim != wanted.get(path):
            yield f"{'.'.join(path)} claims other bytes than in the layout"


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
