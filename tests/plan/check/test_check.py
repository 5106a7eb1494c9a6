"""The check of plans finds faults: faults made by hand with their messages, and mutations."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from firm_hdl.plan import (
    BUS_BYTES,
    ArrayEnd,
    Begin,
    BeginLoop,
    BeginRun,
    Exits,
    Fixed,
    Jump,
    Leaf,
    LoopEnd,
    MapStep,
    Pad,
    Part,
    Plan,
    Run,
    Step,
    build_plan,
    check,
)
from firm_hdl.wire import lay_out
from tests.strategies import make

INNER = make("ros2", {"x": "uint8", "d": "float64", "s": "string<=9"}, "I")
RICH = make(
    "ros2",
    {
        "a": "uint8",
        "q": "uint16[]",
        "b": "uint64",
        "ps": (INNER, "[<=4]"),
        "grid": (make("ros2", {"row": "uint8[3]", "t": "uint16"}, "R"), "[6]"),
        "m": "float32[7]",
        "w": "wstring",
        "z": "uint8",
    },
)
PACKED = make("ros1", {"a": "uint8", "s": "string", "e": make("ros1", {}, "E"), "d": "float64[5]"})
LAYOUTS = [lay_out(RICH), lay_out(RICH, "ros1"), lay_out(PACKED), lay_out(PACKED, "cdr")]
PLANS = [
    (layout, build_plan(layout, bus_bytes=width, max_message_bytes=4000))
    for layout in LAYOUTS
    for width in BUS_BYTES
]


@pytest.mark.parametrize("bus_bytes", BUS_BYTES)
@pytest.mark.parametrize("middle", ["uint8", "uint16", "uint32", "uint8[9]"])
def test_plans_with_fields_before_a_run_are_sound(middle, bus_bytes):
    """Fields of several steps: the last one starts the run."""
    layout = lay_out(make("ros2", {"a": "uint8", "b": "float64", "c": middle, "s": "string"}))
    assert check(build_plan(layout, bus_bytes=bus_bytes), layout) == []


def test_good_plans_pass():
    for layout, plan in PLANS:
        assert check(plan) == []
        assert check(plan, layout) == []


def mutations(node: Any) -> Iterator[tuple[str, Any]]:
    """Yield all values that differ from a part of a plan in one number, flag, name or element."""
    if isinstance(node, bool):
        yield "flag", not node
    elif isinstance(node, int):
        yield "more", node + 1
        yield "less", node - 1
    elif isinstance(node, tuple):
        # Pairs of a counter and something keep their form.
        pair = len(node) == 2 and isinstance(node[0], int | str) and not isinstance(node[1], str)
        for index, item in enumerate(node):
            rest = node[:index], node[index + 1 :]
            if not pair:
                yield f"[{index}] gone", rest[0] + rest[1]
                yield f"[{index}] twice", (*rest[0], item, item, *rest[1])
            for name, changed in mutations(item):
                yield f"[{index}].{name}", (*rest[0], changed, *rest[1])
    elif isinstance(node, NODES):
        for field in dataclasses.fields(node):
            if (type(node), field.name) not in HARMLESS:
                if getattr(node, field.name) is None and (type(node), field.name) in NUMBERS:
                    yield f"{field.name}.some", replace(node, **{field.name: 0})
                for name, changed in mutations(getattr(node, field.name)):
                    yield f"{field.name}.{name}", replace(node, **{field.name: changed})
                if (type(node), field.name) == (Part, "end"):
                    for end in {None, ArrayEnd(), LoopEnd(level=0)} - {node.end}:
                        yield f"end.{end}", replace(node, end=end)


NODES = Plan | Step | Begin | Jump | Exits | Part | LoopEnd | Pad | Fixed | Run | Leaf

# Changes that leave a plan sound: limits within the bound, and the size of packets.
HARMLESS = {
    (BeginLoop, "limit"),
    (BeginRun, "limit"),
    (Plan, "max_message_bytes"),
}


# Attributes that are a number or `None`.
NUMBERS = {
    (MapStep, "rest"),
    (Jump, "step"),
}


@pytest.mark.parametrize("index", range(len(PLANS)))
@pytest.mark.sampled(2)
def test_every_small_change_of_a_plan_is_found(index):
    layout, plan = PLANS[index]
    tried = 0
    for name, changed in mutations(plan):
        tried += 1
        assert check(changed, layout), name
    assert tried > 100


@pytest.fixture
def plan() -> Plan:
    return build_plan(lay_out(RICH), bus_bytes=8)


def with_step(plan: Plan, index: int, **changes: Any) -> Plan:
    steps = list(plan.steps)
    steps[index] = replace(steps[index], **changes)
    return replace(plan, steps=tuple(steps))


def find(plan: Plan, path: str) -> tuple[int, int]:
    """Return step and slice of a leaf."""
    for index, step in enumerate(plan.steps):
        for place, item in enumerate(step.slices):
            if isinstance(item, Part) and str(plan.leaves[item.leaf]) == path:
                return index, place
    raise AssertionError(path)


def test_a_byte_with_two_meanings_is_named(plan):
    index, place = find(plan, "q.length")
    slices = list(plan.steps[index].slices)
    slices[place] = replace(slices[place], at=slices[place].at - 1)
    problems = check(with_step(plan, index, slices=tuple(slices)))
    assert f"step {index}: byte {slices[place].at} is not mapped exactly once" in problems


def test_a_missing_alignment_is_named(plan):
    index, _ = find(plan, "b")
    assert plan.steps[index].align == 8
    first, *_ = check(with_step(plan, index, align=1))
    assert first.startswith(f"step {index}: b has 0 bytes of padding before it, not ")


def test_the_wrong_alignment_is_named(plan):
    index, _ = find(plan, "b")
    first, *_ = check(with_step(plan, index, align=4))
    assert first == f"step {index}: b is aligned to 4, not 8"


def test_the_wrong_alignment_of_items_is_named_where_they_are():
    after_a_string = build_plan(lay_out(make("ros2", {"s": "string", "q": "uint64[]"})))
    index, begin = length_step(after_a_string, "q.length")
    assert begin.align == 8
    first, *_ = check(with_step(after_a_string, index, begin=replace(begin, align=4)))
    assert first == f"step {index}: q.items is aligned to 4, not 8"


def test_a_needless_alignment_is_named(plan):
    index, _ = find(plan, "w.length")
    assert plan.steps[index].align == 1
    slices = plan.steps[index].slices
    assert str(plan.leaves[slices[0].leaf]) == "m.items"
    assert check(with_step(plan, index, align=4)) == [f"step {index}: is aligned already"]


@pytest.mark.parametrize("fields", ["q r", "r q"])
def test_a_needless_alignment_of_items_is_named_beside_a_needed_one(fields):
    # A length of 4 bytes ends at a multiple of 4, where items of 4 bytes may start.
    kinds = {"q": "uint64[]", "r": "uint32[]"}
    message = make("ros2", {"s": "string"} | {name: kinds[name] for name in fields.split()})
    plan = build_plan(lay_out(message))
    index, begin = length_step(plan, "r.length")
    assert (begin.align, length_step(plan, "q.length")[1].align) == (1, 8)
    assert check(plan) == []
    changed = with_step(plan, index, begin=replace(begin, align=4))
    assert check(changed) == [f"step {index}: r.items is aligned already"]


def test_padding_before_nothing_is_named():
    plan = build_plan(lay_out(make("ros2", {"a": "uint8"})))
    step = plan.steps[0]
    slices = (*step.slices, Pad(at=5, bytes=1))
    problems = check(with_step(plan, 0, slices=slices, bytes=6))
    assert problems == ["the end: padding that no value follows"]


def test_a_map_that_is_too_large_for_a_cycle_is_named():
    plan = build_plan(lay_out(make("ros1", {f"x{n}": "uint64" for n in range(4)})), bus_bytes=16)
    assert [step.bytes for step in plan.steps] == [32]
    narrow = replace(plan, bus_bytes=8)
    assert check(narrow) == ["step 0: the map has 32 bytes, more than two bus words"]


def test_a_map_of_two_words_after_a_rest_is_named():
    fields = {"s": "string", "x": "uint64", "y": "uint64"}
    plan = build_plan(lay_out(make("ros1", fields)), bus_bytes=8)
    *others, first, second = plan.steps
    assert (first.rest, first.bytes, second.bytes) == (0, 8, 8)
    slices = (*first.slices, *(replace(item, at=item.at + 8) for item in second.slices))
    both = replace(first, slices=slices, bytes=16, exits=second.exits)
    expected_problem = (
        f"step {len(others)}: the map after a rest has 16 bytes, more than a bus word"
    )
    assert check(replace(plan, steps=(*others, both))) == [expected_problem]


@pytest.mark.parametrize("bus_bytes", BUS_BYTES)
@pytest.mark.parametrize("head", ["uint8", "uint64", "uint8[20]", "uint64[3]"])
@pytest.mark.parametrize("text", ["string", "uint16[]"])
def test_the_rest_of_a_loop_has_room_wherever_it_ends(head, text, bus_bytes):
    """The first step of the body takes the rest of the body's last run, or none does so."""
    inner = make("ros2", {"head": head, "text": text}, "I")
    outer = make("ros2", {"inner": (inner, "[]"), "pair": (inner, "[2]")}, "O")
    message = make("ros2", {"before": "string", "pair": (outer, "[3]"), "after": (outer, "[]")})
    for wire in ("ros1", "cdr"):
        layout = lay_out(message, wire)
        assert check(build_plan(layout, bus_bytes=bus_bytes), layout) == []


def test_a_jump_to_the_wrong_step_is_named(plan):
    exits = plan.steps[2].exits
    changed = replace(exits, default=replace(exits.default, step=4))
    assert "step 2, next: goes to step 4, not 3" in check(with_step(plan, 2, exits=changed))


def test_a_step_that_nothing_leads_to_is_named(plan):
    steps = (*plan.steps, plan.steps[-1])
    problems = check(replace(plan, steps=steps))
    assert problems
    *others, last = plan.steps
    ends = replace(last, exits=Exits(default=Jump(step=len(others))))
    assert check(replace(plan, steps=(*others, ends)))


def test_a_loop_that_is_not_closed_is_named(plan):
    index = next(n for n, step in enumerate(plan.steps) if step.exits.repeats)
    exits = replace(plan.steps[index].exits, repeats=())
    assert check(with_step(plan, index, exits=exits))


def test_leaves_out_of_order_are_named():
    plan = build_plan(lay_out(make("ros1", {"a": "uint8", "b": "uint8"})))
    (step,) = plan.steps
    slices = tuple(replace(item, leaf=1 - item.leaf) for item in step.slices)
    problems = check(with_step(plan, 0, slices=slices))
    assert problems[:1] == ["leaf b is out of order"]


def test_all_leaves_out_of_order_are_named():
    plan = build_plan(lay_out(make("ros1", {"a": "uint8", "b": "uint8", "c": "uint8"})))
    (step,) = plan.steps
    slices = tuple(replace(item, leaf=2 - item.leaf) for item in step.slices)
    problems = check(with_step(plan, 0, slices=slices))
    assert problems[:3] == [f"leaf {leaf} is out of order" for leaf in "cba"]


def test_a_plan_of_another_layout_is_named(plan):
    other = lay_out(make("ros2", {"a": "uint8"}))
    assert "leaves are not those of the layout" in check(plan, other)


def with_leaf(plan, name, **changes):
    """Change one leaf of a plan."""
    leaves = [replace(leaf, **changes) if str(leaf) == name else leaf for leaf in plan.leaves]
    assert tuple(leaves) != plan.leaves
    return replace(plan, leaves=tuple(leaves))


@pytest.mark.parametrize(
    ("leaf", "changes", "expected_problem"),
    [
        ("a", {"type": "uint7"}, "type 'uint7' is not a primitive"),
        ("a", {"type": "int8"}, "signedness is not that of int8"),
        ("q.length", {"type": "uint16"}, "a length is of type uint32, not uint16"),
        ("q.length", {"path": ("q", "size")}, "path does not end in 'length'"),
    ],
)
def test_impossible_leaf_is_named(plan, leaf, changes, expected_problem):
    assert any(expected_problem in problem for problem in check(with_leaf(plan, leaf, **changes)))


def test_a_plan_without_steps_is_named(plan):
    assert "there are no steps" in check(replace(plan, steps=()))


def length_step(plan, name):
    """Return the number of the step that takes a length, and its `begin`."""
    number = next(n for n, leaf in enumerate(plan.leaves) if str(leaf) == name)
    for index, step in enumerate(plan.steps):
        if isinstance(step.begin, BeginLoop | BeginRun) and step.begin.length == number:
            return index, step.begin
    raise AssertionError(name)


@pytest.mark.parametrize(
    ("count", "expected_problem"),
    [
        (0, "step 0, next: loads a count of 0"),
        (-8, "step 0, next: loads a count of -8"),
        (12, "step 1: 12 items do not fill words of 8"),
    ],
)
def test_impossible_constant_count_is_named(count, expected_problem):
    plan = build_plan(lay_out(make("ros2", {"a": "uint8[21]"})), bus_bytes=8)
    exits = plan.steps[0].exits
    assert exits.default.enter == (("run", 16),)
    changed = replace(exits, default=replace(exits.default, enter=(("run", count),)))
    assert check(with_step(plan, 0, exits=changed)) == [expected_problem]


def test_padding_that_no_alignment_needs_is_named():
    plan = build_plan(lay_out(make("ros2", {"a": "uint8"})), bus_bytes=16)
    step = plan.steps[0]
    slices = (*step.slices, Pad(at=5, bytes=8))
    problems = check(with_step(plan, 0, slices=slices, bytes=13))
    assert "step 0: 8 padding bytes or more" in problems


def test_a_bound_that_is_not_that_of_the_type_is_named(plan):
    index, begin = length_step(plan, "ps.length")
    assert begin.limit == 4
    problems = check(with_step(plan, index, begin=replace(begin, limit=5)), LAYOUTS[0])
    assert problems == ["ps may have more than 4 elements"]
    # Fewer are legal: `max_message_bytes` may leave room for no more.
    assert check(with_step(plan, index, begin=replace(begin, limit=3)), LAYOUTS[0]) == []


@pytest.mark.parametrize("sequence", ["uint8[]", "string"])
def test_a_sequence_of_another_kind_is_named(sequence):
    other = {"uint8[]": "string", "string": "uint8[]"}[sequence]
    plan = build_plan(lay_out(make("ros2", {"a": sequence})))
    problem = "a must have a NUL in both plan and layout, or in neither"
    assert problem in check(plan, lay_out(make("ros2", {"a": other})))


def test_a_length_that_nothing_counts_by_is_named():
    plan = build_plan(lay_out(make("ros2", {"a": "uint8"})))
    assert "a has no length" in check(plan, lay_out(make("ros2", {"a": "string"})))


def test_a_mark_of_the_wrong_end_is_named():
    row = make("ros1", {"a": "uint8[3]"}, "R")
    layout = lay_out(make("ros1", {"rows": (row, "[2]"), "wide": "uint64[3]"}))
    plan = build_plan(layout, bus_bytes=4)
    (index,) = (
        n for n, step in enumerate(plan.steps) if any(p.end == ArrayEnd() for p in step.parts)
    )
    slices = tuple(replace(part, end=LoopEnd(level=0)) for part in plan.steps[index].parts)
    problem = "the last item of rows.item.a must be that of an array"
    assert check(with_step(plan, index, slices=slices), layout) == [problem]
    for index, step in enumerate(plan.steps):
        if any(part.end == LoopEnd(level=0) for part in step.parts):
            slices = tuple(replace(part, end=ArrayEnd()) for part in step.parts)
            plan = with_step(plan, index, slices=slices)
    assert check(plan, layout) == ["the last item of wide must be that of a loop"]
