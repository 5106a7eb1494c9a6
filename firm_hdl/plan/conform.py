"""Check that a plan belongs to a layout: its leaves, bounds and counts, and what lengths claim."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import TypeAlias

from firm_hdl.plan.limits import charged_from
from firm_hdl.plan.tree import Charge, Constant, Item, Plan, Run, Step
from firm_hdl.wire import Layout, LengthField, LoopNode, Node, Path, RunNode, Scalar, Trigger, walk

__all__ = ["against_layout"]

Number: TypeAlias = "int | tuple[int | None, bool]"
"""A constant count; or for a length its limit, `None` for none, and whether it counts a NUL."""


@dataclass(slots=True)
class _Row:
    """A leaf, items or a loop."""

    what: str  # A leaf with its kind and type; or "loop".
    count: Number | None = None  # Number of items or elements.
    body: list[_Row] | None = None  # The element of a loop.


def against_layout(plan: Plan, layout: Layout) -> list[str]:
    """Return the differences between a plan, which is sound by itself, and a layout."""
    if (plan.message, plan.wire) != (layout.message.name, layout.rules.wire):
        return [f"the plan is of {plan.message} on {plan.wire}"]
    wanted = list(_of_layout(layout.nodes, plan.bus_bytes))
    return list(_compare(_of_plan(plan, plan.items), wanted)) or list(_charges(plan, layout))


def _leaf(path: Path, kind: str, of: str, last: str = "") -> str:
    return f"{'.'.join(path)} ({kind}, {of}{last})"


def _of_plan(plan: Plan, items: Sequence[Item]) -> list[_Row]:
    rows: list[_Row] = []
    for item in items:
        if isinstance(item, Step):
            for part in item.parts:
                leaf = plan.leaves[part.leaf]
                what = _leaf(leaf.path, leaf.kind, leaf.type)
                if not part.completes:
                    continue
                if leaf.kind != "items":
                    rows.append(_Row(what))
                    continue
                count = part.size // leaf.item_bytes
                if part.last == "in loop":
                    rows.append(_Row(_leaf(leaf.path, leaf.kind, leaf.type, " of a loop"), count))
                elif rows and rows[-1].what == what and isinstance(rows[-1].count, int):
                    # The last transfer of an array, after others.
                    rows[-1].count += count
                else:
                    rows.append(_Row(what, count))
            continue
        given = item.count
        number: Number
        number = given.number if isinstance(given, Constant) else (given.limit, given.nul)
        if isinstance(item, Run):
            leaf = plan.leaves[item.leaf]
            rows.append(_Row(_leaf(leaf.path, leaf.kind, leaf.type), number))
        else:
            rows.append(_Row("loop", number, _of_plan(plan, item.body)))
    return rows


def _of_layout(nodes: Sequence[Node], bus_bytes: int) -> Iterator[_Row]:
    for node in nodes:
        match node:
            case Scalar():
                yield _Row(_leaf(node.path, "scalar", node.type.name))
                continue
            case Trigger():
                yield _Row(_leaf((*node.path, "trigger"), "trigger", "bool"))
                continue
        count: Number
        if isinstance(node.length, LengthField):
            yield _Row(_leaf((*node.path, "length"), "length", "uint32"))
            count = (node.length.bound, isinstance(node, RunNode) and node.terminated)
        else:
            count = node.length.count
        if isinstance(node, LoopNode):
            yield _Row("loop", count, list(_of_layout(node.body, bus_bytes)))
            continue
        path = (*node.path, "items")
        # Items wider than the bus are planned as a loop over single items.
        if node.item.bytes > bus_bytes and count != 1:
            item = _Row(_leaf(path, "items", node.item.name, " of a loop"), 1)
            yield _Row("loop", count, [item])
        else:
            yield _Row(_leaf(path, "items", node.item.name), count)


def _compare(rows: Sequence[_Row], wanted: Sequence[_Row]) -> Iterator[str]:
    before = "the start"
    for row, want in zip_longest(rows, wanted):
        if row is None or want is None or row.what != want.what:
            have, lacks = (each.what if each else "nothing" for each in (row, want))
            yield f"after {before}: {have}, not {lacks}"
            return
        where = before if want.what == "loop" else want.what
        match row.count, want.count:
            case (limit, nul), (bound, wants_nul):
                if bound is not None and limit is not None and limit > bound:
                    yield f"{where}: may have {limit} elements, more than {bound}"
                if nul != wants_nul:
                    yield f"{where}: a NUL must be in both plan and layout, or in neither"
            case count, wants if count != wants:
                yield f"{where}: {count} elements, not {wants}"
        yield from _compare(row.body or (), want.body or ())
        before = want.what


def _charges(plan: Plan, layout: Layout) -> Iterator[str]:
    """Compare what lengths claim with the layout: paths tell which length is inside which.

    The claims are derived anew, and not by `limits.charges_of`: a mistake there must show here.
    """
    nodes = {
        node.path: node
        for node in walk(layout.nodes)
        if isinstance(node, RunNode | LoopNode) and isinstance(node.length, LengthField)
    }
    loops = {path: node for path, node in nodes.items() if isinstance(node, LoopNode)}
    is_padded = any(node.repeated_bytes > node.min_body_bytes for node in loops.values())
    credit = 2 * (layout.rules.max_align - 1) if is_padded else 0
    least_bytes = charged_from(plan.max_message_bytes)

    def charge(node: RunNode | LoopNode, budget: int | None = None) -> Charge:
        each = max(1, node.item.bytes if isinstance(node, RunNode) else node.repeated_bytes)
        start = -(-least_bytes // each)
        return Charge(bytes=each, charged_from=start, padding_credit=credit, budget=budget)

    lengths = {plan.leaves[leaf].path[:-1]: length for leaf, length in plan.lengths.items()}
    wanted: dict[Path, Charge] = {}
    for path, length in lengths.items():
        around = [loop for loop in loops if loop == path[: len(loop)] and loop != path]
        inner = charge(nodes[path])
        if around and length.most >= inner.charged_from:
            wanted[path] = inner
            outermost = min(around, key=len)
            budget = plan.max_message_bytes - layout.least_bytes
            wanted[outermost] = charge(loops[outermost], budget)
    for path, length in lengths.items():
        if length.charge != wanted.get(path):
            yield f"{'.'.join(path)} claims other bytes than in the layout"
