"""The invariants of every plan, checked without knowing how the plan was built.

A plan that passes can be transcribed without further checks: each transfer is whole, each length
counts what follows it, and the rest of each run is taken. :mod:`firm_hdl.plan.offsets` checks the
offsets in the packet. Problems are sentences for people; an empty list means a good plan.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from firm_hdl.model import PRIMITIVE_OF
from firm_hdl.plan.conform import against_layout
from firm_hdl.plan.limits import BUS_BYTES
from firm_hdl.plan.offsets import check_offsets
from firm_hdl.plan.tree import (
    Fixed,
    Item,
    Leaf,
    Length,
    Loop,
    Part,
    Plan,
    Run,
    Slice,
    Step,
    numbered,
)
from firm_hdl.wire import RULES, Layout

__all__ = ["check"]


def check(plan: Plan, layout: Layout | None = None) -> list[str]:
    """Return the problems of a plan: by itself and, if a layout is given, as a plan of it."""
    # Each stage relies on the invariants that the stages before it have checked.
    for stage in (_tables, _items, _neighbours, _header, _transfers, _rests, check_offsets):
        problems = list(stage(plan))
        if problems:
            return problems
    return [] if layout is None else against_layout(plan, layout)


def _tables(plan: Plan) -> Iterator[str]:
    if plan.bus_bytes not in BUS_BYTES:
        yield f"a bus cannot have {plan.bus_bytes} bytes"
        return
    if len({leaf.path for leaf in plan.leaves}) != len(plan.leaves):
        yield "two leaves have one path"
    for leaf in plan.leaves:
        yield from (f"leaf {leaf}: {problem}" for problem in _leaf(leaf, plan.bus_bytes))


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
    lanes = max(1, bus_bytes // leaf.primitive.bytes) if leaf.kind == "items" else 1
    if leaf.lanes != lanes:
        yield f"{leaf.lanes} lanes, not {lanes}"


# Each step, run and loop by itself.


def _items(plan: Plan) -> Iterator[str]:
    if not plan.items:
        yield "there are no steps"
    for index, _, item in _in_order(plan.items, 0):
        problems: Iterator[str] = iter(())
        match item:
            case Step():
                problems = _step(plan, item)
            case Run():
                problems = _run(plan, item)
            case Loop():
                problems = _loop(item)
        yield from (f"step {index}: {problem}" for problem in problems)


def _in_order(items: Sequence[Item], first: int) -> Iterator[tuple[int, Item | None, Item | None]]:
    """Yield each item with its number and the item before it in the same body, if any.

    The end of a body is an item, too: `None`, with the number of the last item.
    """
    index, before = first, None
    for index, item in numbered(items, first):
        yield index, before, item
        if isinstance(item, Loop):
            yield from _in_order(item.body, index)
        before = item
    yield index, before, None


def _step(plan: Plan, step: Step) -> Iterator[str]:
    wrong = [problem for item in step.slices for problem in _slice(plan, item)]
    if wrong:
        yield from wrong
        return
    if step.align not in (1, 2, 4, 8):
        yield f"alignment to {step.align}"
    words = 2  # The converters move two words a cycle; a rest is one of them.
    if step.rest is not None:
        words = 1
        if step.rest not in range(len(plan.leaves)) or plan.leaves[step.rest].kind != "items":
            yield f"there are no items {step.rest} to have a rest"
    elif not step.slices:
        yield "there is nothing to do"
    if step.bytes > words * plan.bus_bytes:
        yield f"the map has {step.bytes} bytes, more than {words} bus words"
    for before, part in pairwise(step.parts):
        if not before.completes:
            yield f"{plan.leaves[before.leaf]} is cut by the next part"
        elif before.leaf == part.leaf:
            yield f"two transfers of {plan.leaves[part.leaf]} are in one cycle"
    for item in step.slices[1:]:
        if isinstance(item, Part) and item.first:
            yield f"{plan.leaves[item.leaf]} continues after other bytes"


def _slice(plan: Plan, item: Slice) -> Iterator[str]:
    if not isinstance(item, Part):
        if item.bytes < 1:
            yield "a slice is empty"
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
    if item.last is not None and leaf.kind != "items":
        yield f"{leaf} has a mark of its end, which only items have"


def _run(plan: Plan, run: Run) -> Iterator[str]:
    if run.leaf not in range(len(plan.leaves)) or plan.leaves[run.leaf].kind != "items":
        yield f"leaf {run.leaf} of a run is not of kind 'items'"
        return
    leaf = plan.leaves[run.leaf]
    if leaf.item_bytes > plan.bus_bytes:
        yield f"{leaf} are wider than the bus"
    if run.align not in (1, 2, 4, 8):
        yield f"alignment to {run.align}"
    if run.count.nul and leaf.item_bytes != 1:
        yield f"a NUL follows {leaf}, which are not bytes"
    if isinstance(run.count, Length):
        yield from _limit(run.count)
        if run.has_tail:
            yield f"{leaf} are counted, and have a tail"
    elif run.count.number < 1 or run.count.number % leaf.lanes:
        yield f"{run.count.number} items do not fill words of {leaf.lanes}"


def _loop(loop: Loop) -> Iterator[str]:
    if not loop.body:
        yield "a loop without a body"
    if loop.count.nul:
        yield "a NUL follows a loop"
    if isinstance(loop.count, Length):
        yield from _limit(loop.count)
    elif loop.count.number < 1:
        yield f"a loop of {loop.count.number} elements"


def _limit(length: Length) -> Iterator[str]:
    if length.limit < 0:
        yield f"a count has the limit {length.limit}"


# What two items in a row have to agree about.


def _neighbours(plan: Plan) -> Iterator[str]:
    for index, before, item in _in_order(plan.items, 0):
        where = f"step {index}" if item is not None else f"the end of step {index}"
        problems = [*_length(plan, before, item), *_joint(plan, before, item)]
        yield from (f"{where}: {problem}" for problem in problems)


def _length(plan: Plan, before: Item | None, item: Item | None) -> Iterator[str]:
    """Check that a length is complete where what it counts starts, and nowhere else."""
    last = before.slices[-1:] if isinstance(before, Step) else ()
    complete = [part.leaf for part in last if isinstance(part, Part) and _is_length(plan, part)]
    counted = []
    if not isinstance(item, Step | None) and isinstance(item.count, Length):
        counted = [item.count.leaf]
    if complete != counted:
        yield "a length is complete at the end of the step before what it counts, and only there"
    if isinstance(item, Step) and any(
        _is_length(plan, part) for part in item.slices[:-1] if isinstance(part, Part)
    ):
        yield "a length is complete in the middle of a step"


def _is_length(plan: Plan, part: Part) -> bool:
    return part.completes and plan.leaves[part.leaf].kind == "length"


def _joint(plan: Plan, before: Item | None, item: Item | None) -> Iterator[str]:
    """Check that a transfer that a step's end cuts continues in the next step and only there."""
    last = before.slices[-1:] if isinstance(before, Step) else ()
    first = item.slices[:1] if isinstance(item, Step) else ()
    cut = [part for part in last if isinstance(part, Part) and not part.completes]
    goes_on = [part for part in first if isinstance(part, Part) and part.first]
    # The next part goes on at the byte where this one stopped; only its size is free.
    wanted = [replace(part, first=part.first + part.bytes) for part in cut]
    if wanted != [replace(part, bytes=cut[0].bytes if cut else 0) for part in goes_on]:
        yield "the parts of a transfer do not join"
    elif goes_on and isinstance(item, Step) and (item.align != 1 or item.rest is not None):
        yield "a transfer is interrupted"
    if isinstance(before, Run) and before.has_tail:
        tail = [part.leaf for part in first if isinstance(part, Part)]
        if tail != [before.leaf]:
            yield f"the tail of {plan.leaves[before.leaf]} does not follow"


def _header(plan: Plan) -> Iterator[str]:
    rules = RULES[plan.wire]
    slices = [each for step in plan.steps if isinstance(step, Step) for each in step.slices]
    fixed = [item for item in slices if isinstance(item, Fixed)]
    if fixed != slices[: len(fixed)]:
        yield "fixed bytes follow the header"
    got = [(byte, item.check) for item in fixed for byte in item.data]
    want = [(byte, True) for byte in rules.encapsulation] + [(0, False)] * rules.option_bytes
    if got != want:
        yield f"the header is not that of {plan.wire}"


# The transfers of each leaf.


def _transfers(plan: Plan) -> Iterator[str]:
    transfers: dict[int, list[Run | Part]] = {}
    order: list[int] = []
    for step in plan.steps:
        found: Sequence[Run | Part] = [step] if isinstance(step, Run) else step.parts
        for each in found:
            if isinstance(each, Part) and not each.completes:
                continue
            order.append(each.leaf)
            transfers.setdefault(each.leaf, []).append(each)
    for now, after in pairwise([-1, *order]):
        if after not in (now, now + 1):
            yield f"leaf {plan.leaves[after]} is out of order"
    for index, leaf in enumerate(plan.leaves):
        given = transfers.get(index, [])
        yield from (f"leaf {leaf}: {problem}" for problem in _ends(leaf, given))
    if any(
        part.last == "in loop"
        for item in plan.items
        if isinstance(item, Step)
        for part in item.parts
    ):
        yield "an item is the last of a loop, and in none"


def _ends(leaf: Leaf, transfers: Sequence[Run | Part]) -> Iterator[str]:
    """Check the transfers of a leaf: one, or the full words of an array and its tail."""
    if not 1 <= len(transfers) <= 1 + (leaf.kind == "items"):
        yield f"{len(transfers)} transfers"
        return
    *words, last = transfers
    if isinstance(last, Run):
        if words or last.has_tail:
            yield "its last transfer is not marked"
    elif leaf.kind == "items" and (last.last is None or (words and last.last != "always")):
        yield "its last transfer is not marked"
    for word in words:
        if isinstance(word, Part) and (word.last or word.size != leaf.lanes * leaf.item_bytes):
            yield "its first transfer is not a full word, or is marked as the last one"
        elif isinstance(word, Run) and not word.has_tail:
            yield "its run has no tail, and a part follows"


# The rests of runs.

NO_REST = -1
"""In place of the leaf of a run: no run has left a rest."""


def _rests(plan: Plan) -> Iterator[str]:
    """Check that the step after a run takes its rest, and no other step does."""
    problems: dict[str, None] = {}

    def follow(items: Sequence[Item], first: int, left: set[int]) -> set[int]:
        for index, item in numbered(items, first):
            rest = item.rest if isinstance(item, Step) and item.rest is not None else NO_REST
            if rest not in {*left, NO_REST}:
                problems[f"step {index}: {plan.leaves[rest]} has no rest here"] = None
            if isinstance(item, Loop):
                # A body starts after what comes before the loop, or after another element. Every
                # step takes the rests that it finds. So the last item alone decides what an element
                # leaves, and one pass over the body is enough.
                after = follow(item.body, index, left | _left(item.body[-1]))
                # A loop that a length counts may have no element.
                left = left | after if isinstance(item.count, Length) else after
                continue
            for run in left - {NO_REST, rest}:
                problems[f"step {index}: does not take the rest of {plan.leaves[run]}"] = None
            left = _left(item)
        return left

    for run in follow(plan.items, 0, {NO_REST}) - {NO_REST}:
        problems[f"the end: no step takes the rest of {plan.leaves[run]}"] = None
    yield from problems


def _left(item: Item) -> set[int]:
    """Return the runs whose rest may be left after an item, by their leaves."""
    if isinstance(item, Loop):
        return _left(item.body[-1]) | ({NO_REST} if isinstance(item.count, Length) else set())
    if isinstance(item, Run) and isinstance(item.count, Length):
        return {item.leaf}
    return {NO_REST}
