"""The check of plans finds faults: faults made by hand with their messages, and mutations."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from firm_hdl.plan import BUS_BYTES, build_plan, check
from firm_hdl.plan.tree import (
    Charge,
    Constant,
    Fixed,
    Leaf,
    Length,
    Loop,
    Pad,
    Part,
    Plan,
    Run,
    Step,
)
from firm_hdl.wire import lay_out
from tests.plan.broken_plans import PLANS, RICH, damaged
from tests.strategies import make

PACKED = make("ros1", {"a": "uint8", "s": "string", "e": make("ros1", {}, "E"), "d": "float64[5]"})
LAYOUTS = [lay_out(RICH), lay_out(RICH, "ros1"), lay_out(PACKED), lay_out(PACKED, "cdr")]
MADE = [
    (layout, build_plan(layout, bus_bytes=width, max_message_bytes=4000))
    for layout in LAYOUTS
    for width in BUS_BYTES
]


def test_good_plans_pass():
    for layout, plan in MADE:
        assert check(plan) == []
        assert check(plan, layout) == []


@pytest.mark.parametrize("bus_bytes", BUS_BYTES)
@pytest.mark.parametrize("middle", ["uint8", "uint16", "uint32", "uint8[9]"])
@pytest.mark.sampled(7)
def test_plans_with_fields_before_a_run_are_sound(middle, bus_bytes):
    """Fields of several steps: the last one is that of the length."""
    layout = lay_out(make("ros2", {"a": "uint8", "b": "float64", "c": middle, "s": "string"}))
    assert check(build_plan(layout, bus_bytes=bus_bytes), layout) == []


@pytest.mark.parametrize("bus_bytes", BUS_BYTES)
@pytest.mark.parametrize("head", ["uint8", "uint64", "uint8[20]", "uint64[3]"])
@pytest.mark.parametrize("text", ["string", "uint16[]"])
@pytest.mark.sampled(7)
def test_the_rest_of_a_loop_has_room_wherever_it_ends(head, text, bus_bytes):
    """The first step of the body takes the rest of the body's last run, or none does so."""
    inner = make("ros2", {"head": head, "text": text}, "I")
    outer = make("ros2", {"inner": (inner, "[]"), "pair": (inner, "[2]")}, "O")
    message = make("ros2", {"before": "string", "pair": (outer, "[3]"), "after": (outer, "[]")})
    for wire in ("ros1", "cdr"):
        layout = lay_out(message, wire)
        assert check(build_plan(layout, bus_bytes=bus_bytes), layout) == []


NODES = Plan | Step | Run | Loop | Constant | Length | Charge | Part | Pad | Fixed | Leaf

# Changes that leave a plan sound: limits within the bound, and the size of packets.
HARMLESS = {(Length, "limit"), (Plan, "max_message_bytes")}


def mutations(node: Any) -> Iterator[tuple[str, Any]]:
    """Yield all values that differ from a part of a plan in one number, flag, name or element."""
    if isinstance(node, bool):
        yield "flag", not node
    elif isinstance(node, int):
        yield "more", node + 1
        yield "less", node - 1
    elif isinstance(node, tuple):
        for index, item in enumerate(node):
            before, after = node[:index], node[index + 1 :]
            yield f"[{index}] gone", before + after
            yield f"[{index}] twice", (*before, item, item, *after)
            for name, changed in mutations(item):
                yield f"[{index}].{name}", (*before, changed, *after)
    elif isinstance(node, NODES):
        for field in dataclasses.fields(node):
            if (type(node), field.name) in HARMLESS:
                continue
            value = getattr(node, field.name)
            if (type(node), field.name) == (Step, "rest") and value is None:
                yield "rest.some", replace(node, rest=0)
            if isinstance(node, Part) and field.name == "last":
                for last in {None, "always", "in loop"} - {value}:
                    yield f"last.{last}", replace(node, last=last)
            for name, changed in mutations(value):
                yield f"{field.name}.{name}", replace(node, **{field.name: changed})


@pytest.mark.parametrize("index", range(len(MADE)))
@pytest.mark.sampled(7)
def test_every_small_change_of_a_plan_is_found(index):
    layout, plan = MADE[index]
    tried = 0
    for name, changed in mutations(plan):
        tried += 1
        assert check(changed, layout), name
    assert tried > 100


RICH_ITEMS = PLANS["rich"].items
X = RICH_ITEMS[4].body[0].slices[0]
PAIR = PLANS["pair"].items
A, B = PLANS["side"].items[0].slices
BYTE = Part(bytes=1, leaf=0, first=0, size=1)
MARK = "has a mark of its end, which only items have"
COUNTED = "a length is complete at the end of the step before what it counts, and only there"
JOIN = "the parts of a transfer do not join"
UNMARKED = "its last transfer is not marked"
FIRST = "its first transfer is not a full word, or is marked as the last one"

# The plan, its changes, and the messages of the check.
CASES: list[tuple[str, dict[str, Any], list[str]]] = [
    # Leaves.
    ("rich", {"bus_bytes": 3}, ["a bus cannot have 3 bytes"]),
    ("rich", {"leaves.6.path": ("ps", "item", "x")}, ["two leaves have one path"]),
    ("rich", {"leaves.0.type": "uint7"}, ["leaf a: type 'uint7' is not a primitive"]),
    ("rich", {"leaves.0.signed": True}, ["leaf a: signedness is not that of uint8"]),
    ("rich", {"leaves.0.lanes": 2}, ["leaf a: 2 lanes, not 1"]),
    ("rich", {"leaves.2.lanes": 3}, ["leaf q.items: 3 lanes, not 4"]),
    ("rich", {"leaves.2.path": ("q", "item")}, ["leaf q.item: path does not end in 'items'"]),
    ("rich", {"leaves.2.path": ()}, ["leaf : path does not end in 'items'"]),
    (
        "rich",
        {"leaves.1.type": "uint16"},
        ["leaf q.length: a length is of type uint32, not uint16"],
    ),
    (
        "trigger",
        {"leaves.1.type": "uint8"},
        ["leaf e.trigger: a trigger is of type bool, not uint8"],
    ),
    # Slices.
    ("rich", {"items.3.slices.0.leaf": 15}, ["step 3: there is no leaf 15"]),
    ("rich", {"items.3.slices.0.leaf": -1}, ["step 3: there is no leaf -1"]),
    ("rich", {"items.8.slices.0.size": 12}, ["step 11: a transfer of m.items has 12 bytes"]),
    # Items of 4 bytes: no transfer has one and a half.
    ("rich", {"items.8.slices.0.size": 6}, ["step 11: a transfer of m.items has 6 bytes"]),
    (
        "rich",
        {"items.8.slices.0.size": 0},
        ["step 11: a transfer of m.items has 0 bytes", "step 11: m.items has no bytes 0 to 3"],
    ),
    ("trigger", {"items.0.slices.1.size": 1}, ["step 0: a transfer of e.trigger has 1 bytes"]),
    ("rich", {"items.2.slices.0.first": -1}, ["step 2: b has no bytes -1 to 6"]),
    ("rich", {"items.2.slices.0.bytes": 9}, ["step 2: b has no bytes 0 to 8"]),
    ("rich", {"items.2.slices.0.bytes": 0}, ["step 2: b has no bytes 0 to -1"]),
    ("rich", {"items.2.slices.0.last": "always"}, [f"step 2: b {MARK}"]),
    ("text", {"items.0.slices.0.last": "in loop"}, [f"step 0: s.length {MARK}"]),
    ("rich", {"items.0.slices.3": Pad(bytes=0)}, ["step 0: a slice is empty"]),
    ("rich", {"items.0.slices.1.data": b""}, ["step 0: a slice is empty"]),
    # Steps, runs and loops.
    ("rich", {"items": ()}, ["there are no steps"]),
    ("rich", {"items.2.align": 3}, ["step 2: alignment to 3"]),
    ("rich", {"items.7.align": 16}, ["step 10: alignment to 16"]),
    ("rich", {"items.2.rest": 15}, ["step 2: there are no items 15 to have a rest"]),
    ("rich", {"items.2.rest": 0}, ["step 2: there are no items 0 to have a rest"]),
    ("rich", {"items.8.slices.0.size": 8}, ["step 11: m.items is cut by the next part"]),
    (
        "side",
        {"items.0.slices.1.first": 1, "items.0.slices.1.bytes": 7},
        ["step 0: b continues after other bytes"],
    ),
    (
        "trigger",
        {"items.0.slices": (Pad(bytes=17),)},
        ["step 0: the map has 17 bytes, more than 2 bus words"],
    ),
    (
        "rich",
        {"items.2.slices.0": Pad(bytes=9)},
        ["step 2: the map has 9 bytes, more than 1 bus words"],
    ),
    (
        "pair",
        {"items": (Step(slices=(*PAIR[0].slices, *PAIR[1].slices)),)},
        ["step 0: two transfers of t.items are in one cycle"],
    ),
    ("trigger", {"items": (*PLANS["trigger"].items, Step())}, ["step 1: there is nothing to do"]),
    ("rich", {"items.1.leaf": 15}, ["step 1: leaf 15 of a run is not of kind 'items'"]),
    ("rich", {"items.1.leaf": 0}, ["step 1: leaf 0 of a run is not of kind 'items'"]),
    ("narrow", {"items.5.leaf": 0}, ["step 7: m.items are wider than the bus"]),
    ("rich", {"items.1.count.nul": True}, ["step 1: a NUL follows q.items, which are not bytes"]),
    ("rich", {"items.4.count.nul": True}, ["step 4: a NUL follows a loop"]),
    ("rich", {"items.1.has_tail": True}, ["step 1: q.items are counted, and have a tail"]),
    ("rich", {"items.7.count": Constant(7)}, ["step 10: 7 items do not fill words of 2"]),
    ("rich", {"items.7.count": Constant(0)}, ["step 10: 0 items do not fill words of 2"]),
    ("rich", {"items.6.count": Constant(0)}, ["step 8: a loop of 0 elements"]),
    ("rich", {"items.6.body": ()}, ["step 8: a loop without a body"]),
    ("rich", {"items.1.count.limit": -1}, ["step 1: a count has the limit -1"]),
    ("rich", {"items.4.count.limit": -1}, ["step 4: a count has the limit -1"]),
    ("rich", {"items.4.count.limit": 0}, []),
    # Lengths and what they count.
    ("rich", {"items.1.count.leaf": 4}, [f"step 1: {COUNTED}"]),
    ("rich", {"items.1.count": Constant(4)}, [f"step 1: {COUNTED}"]),
    ("rich", {"items.7.count": Length(leaf=1, limit=6)}, [
        "step 10: m.items are counted, and have a tail",
    ]),
    ("text", {"items": PLANS["text"].items[:1]}, [f"the end of step 0: {COUNTED}"]),
    (
        "rich",
        {"items.3.slices": (*RICH_ITEMS[3].slices, Pad(bytes=1))},
        ["step 3: a length is complete in the middle of a step", f"step 4: {COUNTED}"],
    ),
    # Transfers in several steps.
    ("cut", {"items.1.slices.0.first": 3}, [f"step 1: {JOIN}", f"step 2: {JOIN}"]),
    ("cut", {"items.2.align": 2}, ["step 2: a transfer is interrupted"]),
    ("cut", {"items": PLANS["cut"].items[:2]}, [f"the end of step 1: {JOIN}"]),
    ("cut", {"items": PLANS["cut"].items[1:]}, [f"step 0: {JOIN}"]),
    ("cut", {"items": (*PLANS["cut"].items[:1], PLANS["cut"].items[2])}, [f"step 1: {JOIN}"]),
    (
        "cut",
        {"items.2": Loop(count=Constant(2), body=(PLANS["cut"].items[2],))},
        [f"step 2: {JOIN}", f"step 2: {JOIN}"],
    ),
    # The header.
    ("rich", {"wire": "ros1"}, ["the header is not that of ros1"]),
    ("rich", {"items.0.slices.0.data": b"\0\0"}, ["the header is not that of cdr"]),
    ("rich", {"items.0.slices.0.check": False}, ["the header is not that of cdr"]),
    ("rich", {"items.0.slices.1.check": True}, ["the header is not that of cdr"]),
    (
        "rich",
        {"items.4.body.0.slices": (X, Fixed(data=b"x", check=False))},
        ["fixed bytes follow the header", "the header is not that of cdr"],
    ),
    # The transfers of each leaf.
    (
        "last",
        {"items.0.slices.1.leaf": 2, "items.0.slices.2.leaf": 1},
        ["leaf c is out of order", "leaf b is out of order"],
    ),
    ("last", {"items.0.slices": (BYTE,)}, ["leaf b: 0 transfers", "leaf c: 0 transfers"]),
    ("pair", {"items": (*PAIR, PAIR[1])}, ["leaf t.items: 3 transfers"]),
    ("rich", {"items.8.slices.0.last": None}, [f"leaf m.items: {UNMARKED}"]),
    ("pair", {"items.1.slices.0.last": None}, [f"leaf t.items: {UNMARKED}"]),
    ("pair", {"items.1.slices.0.last": "in loop"}, [
        f"leaf t.items: {UNMARKED}", "an item is the last of a loop, and in none",
    ]),
    ("pair", {"items.0.slices.1.last": "always"}, [f"leaf t.items: {FIRST}"]),
    (
        "pair",
        {"items.0.slices.1.size": 4, "items.0.slices.1.bytes": 4},
        [f"leaf t.items: {FIRST}"],
    ),
    ("rich", {"items.7.has_tail": False}, [
        "leaf m.items: its run has no tail, and a part follows"
    ]),
    # The rests of runs.
    ("text", {"items": PLANS["text"].items[:2]}, ["the end: no step takes the rest of s.items"]),
    ("rich", {"items.2.rest": None}, ["step 2: does not take the rest of q.items"]),
    ("rich", {"items.3.rest": 2}, ["step 3: q.items has no rest here"]),
    ("rich", {"items.4.body.0.rest": None}, ["step 4: does not take the rest of ps.item.s.items"]),
    ("rich", {"items.6.body.0.rest": 8}, ["step 8: ps.item.s.items has no rest here"]),
    (
        "texts",
        {"items.2.rest": 3},
        ["step 2: ts.item.t.items has no rest here", "step 2: does not take the rest of s.items"],
    ),
]  # fmt: skip


@pytest.mark.parametrize(("which", "changes", "problems"), CASES)
def test_fault_has_exactly_these_messages(which, changes, problems):
    assert check(damaged(PLANS[which], changes)) == problems


def wrong_padding(step, leaf, offsets):
    """Return the messages for a leaf with wrong padding, at each offset."""
    return {
        f"step {step}: {leaf} has {got} bytes of padding before it, not {need}, at offset {offset} "
        "modulo 8"
        for offset, got, need in offsets
    }


ROW, T = (step.slices for step in RICH_ITEMS[6].body)

# Faults in padding. Every offset modulo 8 that a packet can have is reported.
OFFSETS: list[tuple[str, dict[str, Any], set[str]]] = [
    (
        "rich",
        {"items.0.slices.3.bytes": 2},
        wrong_padding(0, "q.length", [(1, 2, 3)]) | wrong_padding(1, "q.items", [(7, 0, 1)]),
    ),
    ("rich", {"items.0.slices.3.bytes": 7}, wrong_padding(0, "q.length", [(1, 7, 3)])),
    ("side", {"items.0.slices": (A, Pad(bytes=1), B)}, wrong_padding(0, "b", [(1, 1, 0)])),
    (
        "side",
        {"items.0.slices": (A, Pad(bytes=8), B)},
        wrong_padding(0, "b", [(1, 7, 0)]) | {"step 0: 8 padding bytes or more"},
    ),
    ("rich", {"items.6.body.0.align": 2}, {"step 8: grid.item.row.items is aligned to 2, not 1"}),
    ("rich", {"items.7.align": 8}, {"step 10: m.items is aligned to 8, not 4"}),
    (
        "rich",
        {"items.0.align": 4},
        {"step 0: alignment that no value follows", "step 0: is aligned already"},
    ),
    (
        "rich",
        {"items.6.body.0.align": 4},
        {"step 8: grid.item.row.items is aligned to 4, not 1"},
    ),
    ("rich", {"items.1.align": 2}, {"step 1: is aligned already"}),
    ("gap", {"items.3.align": 1}, wrong_padding(3, "d.items", [(4, 0, 4)])),
    (
        "gap",
        {"items.3.align": 4},
        {"step 3: d.items is aligned to 4, not 8", "step 3: is aligned already"}
        | wrong_padding(3, "d.items", [(4, 0, 4)]),
    ),
    # An item of 2 bytes after 3 bytes, in each round of a loop.
    (
        "rich",
        {"items.6.body.1.align": 1},
        wrong_padding(9, "grid.item.t", [(offset, 0, 1) for offset in (1, 3, 5, 7)]),
    ),
    (
        "rich",
        {"items.4.body.0.slices": (X, Pad(bytes=1))},
        {"step 5: padding that no value follows"},
    ),
    (
        "rich",
        {"items.6.body.1.slices": (*T, Pad(bytes=1))},
        wrong_padding(8, "grid.item.row.items", [(offset, 1, 0) for offset in (0, 2, 4, 6)])
        | {"step 10: padding that no value follows"},
    ),
    # A byte after each of three elements: before the second one, the third one and the next field.
    (
        "rows",
        {"items.0.body.0.slices": (*PLANS["rows"].items[0].body[0].slices, Pad(bytes=1))},
        wrong_padding(0, "r.item.x", [(3, 1, 0), (7, 1, 0)]) | wrong_padding(1, "y", [(3, 1, 0)]),
    ),
    # The right padding for the next element, but within the loop: after the last one, it is none.
    (
        "elements",
        {
            "items.1.body.0.slices": (*PLANS["elements"].items[1].body[0].slices, Pad(bytes=3)),
            "items.1.body.0.align": 1,
        },
        {"step 2: padding that no value follows"},
    ),
    # The right padding for the first element, but outside the loop.
    (
        "pairs",
        {
            "items.0.slices": (*PLANS["pairs"].items[0].slices, Pad(bytes=1)),
            "items.1.body.0.align": 1,
        },
        {"step 1: padding that no value follows"},
    ),
    (
        "last",
        {"items.0.slices": (*PLANS["last"].items[0].slices, Pad(bytes=1))},
        {"the end: padding that no value follows"},
    ),
]


@pytest.mark.parametrize(("which", "changes", "problems"), OFFSETS)
def test_fault_in_padding_is_reported_for_each_offset(which, changes, problems):
    found = check(damaged(PLANS[which], changes))
    assert set(found) == problems and len(found) == len(problems)


# Plans that are sound, but not those of the layout.


def of_rows(kind):
    """Return the layout of a sequence of rows, each with one field."""
    return lay_out(make("ros2", {"rows": (make("ros2", {"x": kind}, "Row"), "[]")}))


@pytest.mark.parametrize(
    "layout",
    # Another type with the same fields, and another wire format with the same leaves.
    [
        lay_out(make("ros2", {"a": "uint8"}, "Other")),
        lay_out(make("ros2", {"a": "uint8"}), "ros1"),
    ],
)
def test_a_plan_of_another_type_or_wire_format_is_named(layout):
    own = lay_out(make("ros2", {"a": "uint8"}))
    plan = build_plan(own)
    assert check(plan, own) == []
    assert check(plan, layout) == ["the plan is of p/msg/T on cdr"]


@pytest.mark.parametrize(
    ("planned", "wanted", "problem"),
    [
        ("uint8", "uint16", "after the start: x (scalar, uint8), not x (scalar, uint16)"),
        ("uint8", "uint8[]", "after the start: x (scalar, uint8), not x.length (length, uint32)"),
        ("uint8[3]", "uint8[4]", "x.items (items, uint8): 3 elements, not 4"),
        # More than two words: a run with a tail.
        ("uint8[23]", "uint8[24]", "x.items (items, uint8): 23 elements, not 24"),
        ("uint8[<=5]", "uint8[<=4]", "x.items (items, uint8): may have 5 elements, more than 4"),
        (
            "string",
            "uint8[]",
            "x.items (items, uint8): a NUL must be in both plan and layout, or in neither",
        ),
    ],
)
def test_a_field_of_another_kind_is_named(planned, wanted, problem):
    plan, layout = (lay_out(make("ros2", {"x": kind})) for kind in (planned, wanted))
    assert check(build_plan(plan), layout) == [problem]


@pytest.mark.parametrize("bus_bytes", [1, 2, 4])
@pytest.mark.parametrize("count", [2, 3])
def test_an_array_of_items_wider_than_the_bus_is_a_loop_of_as_many(count, bus_bytes):
    layout = lay_out(make("ros2", {"w": f"uint64[{count}]"}))
    assert check(build_plan(layout, bus_bytes=bus_bytes), layout) == []
    more = build_plan(lay_out(make("ros2", {"w": f"uint64[{count + 1}]"})), bus_bytes=bus_bytes)
    assert check(more, layout) == [f"the start: {count + 1} elements, not {count}"]


def test_a_sequence_of_one_wide_item_is_no_array():
    element = make("ros2", {"w": "uint64[1]"}, "E")
    plan = build_plan(lay_out(make("ros2", {"w": "uint64[2]"})), bus_bytes=4)
    items = "w.items (items, uint64 of a loop)"
    assert check(plan, lay_out(make("ros2", {"w": (element, "[2]")}))) == [
        f"after the start: {items}, not w.item.w.items (items, uint64)"
    ]


def test_counts_of_loops_are_compared_in_wire_order():
    """The loop after a sequence may follow its length at once, before the loops in its elements."""
    row = make("ros1", {"x": "uint8", "s": "string"}, "Row")

    def layout_of(*counts):
        first, second, third = (f"[{count}]" for count in counts)
        element = make("ros1", {"m": (row, first), "n": (row, second)}, "Element")
        return lay_out(make("ros1", {"e": (element, "[]"), "f": (row, third)}))

    layout = layout_of(2, 5, 3)
    assert check(build_plan(layout), layout) == []
    assert check(build_plan(layout_of(2, 3, 5)), layout) == [
        "loop: 3 elements, not 5",
        "loop: 5 elements, not 3",
    ]
    assert check(build_plan(layout_of(5, 2, 3)), layout) == [
        "the start: 5 elements, not 2",
        "loop: 2 elements, not 5",
    ]


@pytest.mark.parametrize(
    ("kind", "charged"),
    # Lengths that may claim 4,096 bytes are charged; the NUL is one of them.
    [
        *(("string<=4095", True), ("string<=4094", False)),
        *(("uint8[<=4096]", True), ("uint8[<=4095]", False)),
        *(("float64[<=512]", True), ("float64[<=511]", False)),
    ],
)
def test_charges_are_those_of_the_layout(kind, charged):
    layout = of_rows(kind)
    plan = build_plan(layout)
    assert [length.charge is not None for length in plan.lengths.values()] == [charged] * 2
    assert check(plan, layout) == []


@pytest.mark.parametrize(
    "change",
    [
        {"items.1.count.charge.bytes": 9},
        {"items.1.count.charge.budget": 9},
        {"items.1.count.charge.padding_credit": 14},
        {"items.1.count.charge": None},
    ],
)
def test_a_charge_that_the_layout_does_not_have_is_named(change):
    layout = of_rows("uint8[<=4096]")
    plan = damaged(build_plan(layout), change)
    assert check(plan) == []
    assert check(plan, layout) == ["rows claims other bytes than in the layout"]
