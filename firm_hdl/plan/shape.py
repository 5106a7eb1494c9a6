"""The shape of a plan, which types can share, and the constructs in it.

Gateware transcribes a plan, and the name of a leaf only names its ports. So plans that are equal
except for names give equal circuits, and verifying one of them verifies all.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from firm_hdl.plan.ir import (
    RUN_COUNTER,
    ArrayEnd,
    Begin,
    BeginLoop,
    Fixed,
    IntoBody,
    Jump,
    LoopAgain,
    LoopEnd,
    Next,
    Pad,
    Part,
    Plan,
    RunStep,
    Step,
    successors,
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
    found = {f"wire {plan.wire}", f"{min(plan.levels, 3)} loop levels", *_jump("start", plan.start)}
    for leaf in plan.leaves:
        found.add(f"leaf {leaf.kind} {'signed ' if leaf.signed else ''}{leaf.type}")
    for run in plan.runs:
        size = plan.leaves[run.items].item_bytes
        words = [f"run of {size} bytes", "counted" if run.counted else "constant count"]
        words += ["NUL"] if run.terminated else []
        words += [] if run.last else ["with tail"]
        found.add(", ".join(words))
    for step in plan.steps:
        found.update(_step(plan, step))
    return frozenset(found)


def _step(plan: Plan, step: Step) -> Iterator[str]:
    yield f"align {step.align}"
    if step.rest is not None:
        yield f"rest of a run{'' if step.slices else ' alone'}"
    if isinstance(step, RunStep):
        yield "words of a run"
    elif step.bytes > plan.bus_bytes:
        yield "map of two words"
    for item in step.slices:
        match item:
            case Pad():
                yield f"padding of {item.bytes}"
            case Fixed():
                yield f"fixed bytes, {'checked' if item.check else 'ignored'}"
            case Part():
                yield _part(plan, item)
    if step.begin is not None:
        yield _begin(plan, step.begin)
    yield f"{min(len(step.exits.repeats), 3)} loops may repeat"
    for way, jump in successors(step):
        yield from _jump({IntoBody: "body", LoopAgain: "repeat", Next: "next"}[type(way)], jump)


def _part(plan: Plan, part: Part) -> str:
    leaf = plan.leaves[part.leaf]
    if part.bytes == part.size:
        which = "whole"
    else:
        which = "first part" if not part.first else "last part" if part.completes else "inner part"
    text = f"{which} of {leaf.kind}, {leaf.item_bytes} bytes each"
    match part.end:
        case ArrayEnd():
            return f"{text}, last"
        case LoopEnd():
            return f"{text}, last by its loop"
        case None:
            return text


def _begin(plan: Plan, begin: Begin) -> str:
    if isinstance(begin, BeginLoop):
        return "begin loop, counted by a length"
    words = ["run, counted by a length"]
    words += ["NUL"] if plan.has_nul(begin) else []
    words += [f"aligned to {begin.align}"] if begin.align != 1 else []
    return f"begin {', '.join(words)}"


def _jump(what: str, jump: Jump) -> Iterator[str]:
    yield f"{what} {'ends the packet' if jump.step is None else 'goes on'}"
    loops = sum(counter != RUN_COUNTER for counter, _ in jump.enter)
    if loops:
        yield f"{what} enters {loops} loops"
    if loops < len(jump.enter):
        yield f"{what} enters a run"
