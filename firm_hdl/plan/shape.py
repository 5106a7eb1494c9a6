"""The shape of a plan, which types can share, and the constructs in it.

Gateware transcribes a plan, and the name of a leaf only names its ports. So plans that are equal
except for names give equal circuits, and verifying one of them verifies all.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

from firm_hdl.plan.tree import (
    Constant,
    Count,
    Fixed,
    Item,
    Leaf,
    Loop,
    Pad,
    Part,
    Plan,
    Run,
    Slice,
    Step,
)

__all__ = ["constructs", "shape"]


def shape(plan: Plan) -> Plan:
    """Return the plan without names: equal for types whose converters are the same circuit."""
    leaves = []
    for index, leaf in enumerate(plan.leaves):
        # The last part of a path is the kind of the leaf; `check` compares it.
        end = () if leaf.kind == "scalar" else (leaf.kind,)
        leaves.append(replace(leaf, path=(f"leaf{index}", *end)))
    return replace(plan, message="", leaves=tuple(leaves))


def constructs(plan: Plan) -> frozenset[str]:
    """Name the constructs of a plan, for choosing types that cover all constructs."""
    found = {f"wire {plan.wire}", f"{min(plan.levels, 3)} loop levels"}
    for leaf in plan.leaves:
        found.add(f"leaf {leaf.kind} {'signed ' if leaf.signed else ''}{leaf.type}")
    found.update(_block(plan, plan.items, "packet"))
    return frozenset(found)


def _block(plan: Plan, items: Sequence[Item], around: str) -> Iterator[str]:
    """Name the constructs of items, and what is first, last and next to each other."""
    names = [f"start of {around}", *(_name(item) for item in items), f"end of {around}"]
    yield from map(" then ".join, itertools.pairwise(names))
    for item in items:
        match item:
            case Step():
                yield from _step(plan, item)
            case Run():
                yield _run(plan.leaves[item.leaf], item)
            case Loop():
                yield from _block(plan, item.body, _name(item))


def _name(item: Item) -> str:
    match item:
        case Step():
            return "step"
        case Run():
            return f"run, {_count(item.count)}"
        case Loop():
            return f"loop, {_count(item.count)}"


def _count(count: Count) -> str:
    return "constant count" if isinstance(count, Constant) else "counted"


def _run(leaf: Leaf, run: Run) -> str:
    words = [f"run of {leaf.item_bytes} bytes", _count(run.count), f"aligned to {run.align}"]
    words += ["NUL"] if run.count.nul else []
    words += ["with tail"] if run.has_tail else []
    return ", ".join(words)


def _step(plan: Plan, step: Step) -> Iterator[str]:
    yield f"align {step.align}"
    if step.rest is not None:
        yield f"rest of a run{'' if step.slices else ' alone'}"
    if step.bytes > plan.bus_bytes:
        yield "map of two words"
    yield from (_slice(plan, item) for item in step.slices)


def _slice(plan: Plan, item: Slice) -> str:
    match item:
        case Pad():
            return f"padding of {item.bytes}"
        case Fixed():
            return f"fixed bytes, {'checked' if item.check else 'ignored'}"
        case Part():
            leaf = plan.leaves[item.leaf]
            which = "first part" if not item.first else "last part" if item.completes else "part"
            if item.bytes == item.size:
                which = "whole"
            text = f"{which} of {leaf.kind}, {leaf.item_bytes} bytes each"
            return f"{text}, last {item.last}" if item.last else text
