"""What the check says of each fault: every sentence that it has, and nothing besides."""

from __future__ import annotations

import dataclasses
from dataclasses import replace
from typing import Any

import pytest

from firm_hdl.plan import Exits, Fixed, Jump, MapStep, Pad, Part, build_plan, check
from firm_hdl.wire import lay_out
from tests.strategies import make

from .test_check import RICH


def plan_of(fields, bus_bytes=8, dialect="ros1"):
    return build_plan(lay_out(make(dialect, fields)), bus_bytes=bus_bytes)


PLANS = {
    "rich": build_plan(lay_out(RICH), bus_bytes=8),
    # A string and items wider than the bus, which are a loop.
    "narrow": plan_of({"m": "float32[7]", "s": "string"}, 1),
    "trigger": plan_of({"a": "uint8", "e": make("ros1", {}, "E")}),
    # A run of constant count: begun by a step, and loaded by a jump.
    "begun": plan_of({"a": "uint8[21]"}, 8, "ros2"),
    "entered": plan_of({"b": "uint8[24]"}),
    # A transfer in two steps.
    "cut": plan_of({"b": "uint64"}, 4),
    "last": plan_of({"a": "uint8", "b": "uint8", "c": "uint8"}),
    "side": plan_of({"a": "uint8", "b": "uint64"}, 16),
}


def damaged(node: Any, path: list[str], new: Any) -> Any:
    """Return a plan with another value at a path of attributes and indexes."""
    if not path:
        return new
    if isinstance(node, tuple):
        index = int(path[0])
        return (*node[:index], damaged(node[index], path[1:], new), *node[index + 1 :])
    assert path[0] in {field.name for field in dataclasses.fields(node)}
    return replace(node, **{path[0]: damaged(getattr(node, path[0]), path[1:], new)})


def problems_of(which, changes):
    plan = PLANS[which]
    for path, new in changes.items():
        plan = damaged(plan, path.split("."), new)
    return check(plan)


PLAIN = Exits(default=Jump(step=None))
BYTE = Part(at=4, bytes=1, leaf=0, first=0, size=1)
X = PLANS["rich"].steps[5].slices[0]
MARKS = "has too few or too many marks of its end"
RULE = "a length must be complete in the step that starts what it counts, and in no other"
JOIN = "the parts of a transfer do not join"

# Which plan, what is changed in it, and what is said of that.
CASES: list[tuple[str, dict[str, Any], list[str]]] = [
    # Tables.
    ("rich", {"bus_bytes": 3}, ["a bus cannot have 3 bytes"]),
    ("rich", {"header_bytes": 0}, ["header or slack is not that of cdr"]),
    ("rich", {"slack_bytes": 0}, ["header or slack is not that of cdr"]),
    ("rich", {"wire": "ros1"}, ["header or slack is not that of ros1"]),
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
    ("rich", {"runs.3.items": 2}, ["two runs have the same items"]),
    ("rich", {"runs.1.items": 0}, ["run 1: its leaf is not of kind 'items'"]),
    ("rich", {"runs.1.items": 15}, ["run 1: its leaf is not of kind 'items'"]),
    ("rich", {"runs.1.items": -1}, ["run 1: its leaf is not of kind 'items'"]),
    ("narrow", {"runs.0.items": 0}, ["run 0: items are wider than the bus"]),
    ("rich", {"runs.0.terminated": True}, ["run 0: a NUL follows items that are not bytes"]),
    # Steps.
    ("rich", {"steps": ()}, ["there are no steps"]),
    ("rich", {"steps.3.align": 3}, ["step 3: alignment to 3"]),
    ("rich", {"steps.3.align": 16}, ["step 3: alignment to 16"]),
    ("rich", {"steps.2.run": 4}, ["step 2: there is no run 4"]),
    ("rich", {"steps.2.run": -1}, ["step 2: there is no run -1"]),
    ("rich", {"steps.2.head": 7}, ["step 2: 7 bytes of q.items per cycle do not fit words of 8"]),
    ("rich", {"steps.2.head": 9}, ["step 2: 9 bytes of q.items per cycle do not fit words of 8"]),
    ("rich", {"steps.8.head": 9}, []),
    (
        "rich",
        {"steps.8.head": 10},
        ["step 8: 10 bytes of ps.item.s.items per cycle do not fit words of 8"],
    ),
    ("rich", {"steps.3.slices.0.leaf": 15}, ["step 3: there is no leaf 15"]),
    ("rich", {"steps.3.slices.0.leaf": -1}, ["step 3: there is no leaf -1"]),
    ("rich", {"steps.12.slices.0.size": 12}, ["step 12: a transfer of m.items has 12 bytes"]),
    (
        "rich",
        {"steps.12.slices.0.size": 0},
        ["step 12: a transfer of m.items has 0 bytes", "step 12: m.items has no bytes 0 to 3"],
    ),
    ("trigger", {"steps.0.slices.1.size": 1}, ["step 0: a transfer of e.trigger has 1 bytes"]),
    ("rich", {"steps.3.slices.0.first": -1}, ["step 3: b has no bytes -1 to 6"]),
    ("rich", {"steps.3.slices.0.first": 1}, ["step 3: b has no bytes 1 to 8"]),
    ("rich", {"steps.3.slices.0.bytes": 9}, ["step 3: b has no bytes 0 to 8"]),
    ("rich", {"steps.3.slices.0.bytes": 0}, ["step 3: b has no bytes 0 to -1"]),
    ("rich", {"steps.12.slices.0.last": False}, [f"step 12: m.items {MARKS}"]),
    ("rich", {"steps.12.slices.0.last_level": 0}, [f"step 12: m.items {MARKS}"]),
    ("rich", {"steps.3.slices.0.last": True}, [f"step 3: b {MARKS}"]),
    ("rich", {"steps.3.slices.0.last_level": 0}, [f"step 3: b {MARKS}"]),
    ("rich", {"steps.0.slices.3": Pad(at=5, bytes=0)}, ["step 0: the slice at byte 5 is empty"]),
    ("rich", {"steps.0.slices.1.data": b""}, ["step 0: the slice at byte 2 is empty"]),
    ("rich", {"steps.3.bytes": 9}, ["step 3: the map has 8 bytes, the step 9"]),
    ("rich", {"steps.12.slices.0.size": 8}, ["step 12: m.items is cut by the next part"]),
    (
        "side",
        {"steps.0.slices.1.first": 1, "steps.0.slices.1.bytes": 7, "steps.0.bytes": 8},
        ["step 0: b continues behind other bytes"],
    ),
    # What a step begins.
    ("rich", {"steps.1.begin": None}, [f"step 1: {RULE}"]),
    ("rich", {"steps.3.begin": PLANS["rich"].steps[1].begin}, [f"step 3: {RULE}"]),
    (
        "rich",
        {
            "steps.1.slices": (*PLANS["rich"].steps[1].slices, Pad(at=4, bytes=1)),
            "steps.1.bytes": 5,
        },
        [f"step 1: {RULE}"],
    ),
    ("rich", {"steps.4.begin.limit": -1}, ["step 4: a count has the limit -1"]),
    ("rich", {"steps.4.begin.limit": 0}, []),
    ("begun", {"steps.0.begin.count": 0}, ["step 0: a constant count cannot be 0"]),
    ("begun", {"steps.0.begin.count": 1}, []),
    ("rich", {"steps.1.begin.run": 4}, ["step 1: there is no run 4"]),
    ("rich", {"steps.1.begin.run": -1}, ["step 1: there is no run -1"]),
    ("begun", {"runs.0.terminated": True}, ["step 0: a constant run counts a NUL"]),
    (
        "rich",
        {"steps.1.begin.head": 7},
        ["step 1: 7 bytes of q.items per cycle do not fit words of 8"],
    ),
    ("rich", {"steps.1.begin.gap": 8}, ["step 1: a gap cannot have 8 bytes"]),
    ("rich", {"steps.1.begin.gap": -1}, ["step 1: a gap cannot have -1 bytes"]),
    # The header.
    ("rich", {"steps.0.slices.0.data": b"\0\0"}, ["the header is not that of cdr"]),
    ("rich", {"steps.0.slices.0.check": False}, ["the header is not that of cdr"]),
    ("rich", {"steps.0.slices.1.check": True}, ["the header is not that of cdr"]),
    ("rich", {"steps.0.slices.1.data": b"\0\1"}, ["the header is not that of cdr"]),
    (
        "rich",
        {"steps.5.slices": (X, Fixed(at=1, data=b"x", check=False)), "steps.5.bytes": 2},
        ["fixed bytes follow the header", "the header is not that of cdr"],
    ),
    # Transfers.
    (
        "rich",
        {"steps.3.slices.0.leaf": 6},
        [
            "leaf ps.item.d is out of order",
            "leaf ps.length is out of order",
            "leaf b: 0 transfers and 0 runs",
            "leaf ps.item.d: 2 transfers and 0 runs",
        ],
    ),
    (
        "rich",
        {
            "steps.0.slices": (
                *PLANS["rich"].steps[0].slices[:3],
                replace(BYTE, at=5),
                Pad(at=6, bytes=2),
            )
        },
        ["leaf a: 2 transfers and 0 runs"],
    ),
    ("rich", {"runs.2.last": True}, ["leaf m.items: its run and its tail disagree about its end"]),
    ("rich", {"runs.0.last": False}, ["leaf q.items: its run and its tail disagree about its end"]),
    (
        "rich",
        {"steps.12.slices.0.last": False, "steps.12.slices.0.last_level": 0},
        ["leaf m.items: the tail of a run is in a loop"],
    ),
    (
        "last",
        {"steps.0.slices.1.leaf": 2, "steps.0.slices.2.leaf": 1},
        ["leaf c is out of order", "leaf b is out of order"],
    ),
    (
        "last",
        {"steps.0.slices.2.leaf": 0},
        [
            "leaf a is out of order",
            "leaf a: 2 transfers and 0 runs",
            "leaf c: 0 transfers and 0 runs",
        ],
    ),
    # What is cut at the end of a step.
    ("cut", {"steps.1.align": 4}, [f"step 1: {JOIN}"]),
    (
        "cut",
        {"steps.1.slices.0.first": 3},
        ["leaf b: 0 transfers and 0 runs", f"step 1: {JOIN}", "the last transfer is cut"],
    ),
    ("cut", {"steps.0.exits.repeats": ((0, Jump(step=0)),)}, [f"step 1: {JOIN}"]),
    ("cut", {"steps.0.slices.0.bytes": 3, "steps.0.bytes": 3}, [f"step 1: {JOIN}"]),
    ("cut", {"steps.0.slices": (), "steps.0.bytes": 0}, [f"step 1: {JOIN}"]),
    ("narrow", {"steps.1.slices.0.last_level": 1}, [f"step 1: {JOIN}", f"step 2: {JOIN}"]),
    (
        "narrow",
        {"steps.1.slices.0.last_level": None, "steps.1.slices.0.last": True},
        [f"step 1: {JOIN}", f"step 2: {JOIN}"],
    ),
    # The flow.
    ("rich", {"start.step": 1}, ["start: goes to step 1, not 0"]),
    ("rich", {"start.step": None}, ["start: goes to step 15, not 0"]),
    (
        "rich",
        {"start.enter": (("run", 1),)},
        ["step 0: the counter of the run is not loaded, or needlessly loaded"],
    ),
    ("rich", {"levels": 2}, ["2 loop counters, of which 1 are used"]),
    ("rich", {"levels": 0}, ["step 4, next: loop 0 inside 0 loops"]),
    ("rich", {"steps.4.exits.default.enter": ((0, 0),)}, ["step 4, next: loads a count of 0"]),
    ("rich", {"steps.4.exits.default.enter": ((0, 5),)}, ["step 7, next: loads a count of 6"]),
    ("rich", {"steps.7.exits.default.enter": ((0, 5),)}, ["step 7, next: loads a count of 5"]),
    (
        "rich",
        {"steps.4.exits.default.enter": ()},
        ["step 10: loop 0 ends inside 0 loops"],
    ),
    ("rich", {"steps.4.exits.default.enter": ((1, 6),)}, ["step 4, next: loop 1 inside 0 loops"]),
    (
        "rich",
        {"steps.10.exits.default.enter": (("run", 6), ("run", 6))},
        ["step 10, next: the counter of the run is loaded twice"],
    ),
    (
        "rich",
        {"steps.10.exits.default.enter": ()},
        ["step 11: the counter of the run is not loaded, or needlessly loaded"],
    ),
    (
        "rich",
        {"steps.9.exits.default.enter": (("run", 6),)},
        ["step 10: the counter of the run is not loaded, or needlessly loaded"],
    ),
    ("entered", {"runs.0.terminated": True}, ["step 0: a constant run counts a NUL"]),
    (
        "rich",
        {"steps.14.exits.default.enter": (("run", 1),)},
        ["step 14, next: ends within a loop or a run"],
    ),
    (
        "narrow",
        {"steps.8.exits.default": Jump(step=9), "steps.7.exits.default": Jump(step=9)},
        ["step 7, next: there is no step 9"],
    ),
    (
        "rich",
        {"steps.8.exits.default.enter": ()},
        ["step 8, next: step 9 is also reached with other open loops"],
    ),
    ("rich", {"steps.14.exits.default.step": 15}, ["step 14, next: there is no step 15"]),
    ("rich", {"steps.13.exits.default.step": 15}, ["step 13, next: goes to step 15, not 14"]),
    ("rich", {"steps.4.begin.level": 1}, ["step 4: loop 1 inside 0 loops"]),
    ("rich", {"steps.4.begin.body.step": 6}, ["step 4, body: goes to step 6, not 5"]),
    (
        "rich",
        {"steps.7.exits.repeats.0": (1, Jump(step=5))},
        ["step 7: loop 1 ends inside 1 loops"],
    ),
    (
        "rich",
        {"steps.10.exits.repeats.0.1.step": 10},
        ["step 10, loop 0 again: goes to step 10, not 9"],
    ),
    (
        "narrow",
        {f"steps.{n}.slices.0.last_level": 1 for n in range(4)},
        ["step 0: loop 1 is not the innermost"],
    ),
    (
        "trigger",
        {"steps": (*PLANS["trigger"].steps, MapStep(exits=PLAIN))},
        ["step 0, next: goes to step 2, not 1"],
    ),
]


@pytest.mark.parametrize(("which", "changes", "said"), CASES)
def test_fault_is_said_in_so_many_words(which, changes, said):
    assert problems_of(which, changes) == said


RICH_STEPS = PLANS["rich"].steps
PLANS["gap"] = plan_of({"a": "uint8[]", "d": "float64[]"}, 8, "ros2")


def missing(step, leaf, offsets):
    """What is said of a leaf without its padding, at each offset."""
    return {
        f"step {step}: {leaf} has {got} bytes of padding in front, not {need}, at offset {offset} "
        "modulo 8"
        for offset, got, need in offsets
    }


# Where leaves stand. Each place modulo 8 that a packet can have is told of.
OFFSETS: list[tuple[str, dict[str, Any], set[str]]] = [
    (
        "rich",
        {"steps.0.slices.3": Pad(at=5, bytes=2), "steps.0.bytes": 7},
        missing(1, "q.length", [(1, 2, 3)]) | missing(1, "q.items", [(7, 0, 1)]),
    ),
    (
        "rich",
        {"steps.0.slices.3": Pad(at=5, bytes=7), "steps.0.bytes": 12},
        missing(1, "q.length", [(1, 7, 3)]),
    ),
    (
        "rich",
        {"steps.0.slices.3": Pad(at=5, bytes=8), "steps.0.bytes": 13},
        missing(1, "q.length", [(1, 7, 3)]) | {"step 0: 8 padding bytes or more"},
    ),
    ("rich", {"steps.9.align": 2}, {"step 9: grid.item.row.items is aligned to 2, not 1"}),
    ("rich", {"steps.11.align": 8}, {"step 11: m.items is aligned to 8, not 4"}),
    (
        "rich",
        {"steps.0.align": 4},
        {"step 0: alignment that no value follows", "step 0: is aligned already"},
    ),
    ("rich", {"steps.2.align": 2}, {"step 2: is aligned already"}),
    ("rich", {"steps.1.begin.gap": 1}, missing(1, "q.items", [(0, 1, 0)])),
    (
        "rich",
        {"steps.2.align": 2, "steps.1.begin.head": 8},
        {
            "step 1: q.items starts here and in an aligned step, too",
            "step 2: is aligned already",
        },
    ),
    (
        "gap",
        {"steps.3.align": 8, "steps.2.begin.gap": 4},
        {"step 2: d.items starts here and in an aligned step, too"},
    ),
    ("gap", {"steps.3.align": 1}, missing(2, "d.items", [(4, 0, 4)])),
    # An item of 2 bytes behind 3 bytes, in each round of a loop.
    (
        "rich",
        {"steps.10.align": 1},
        missing(10, "grid.item.t", [(offset, 0, 1) for offset in (1, 3, 5, 7)]),
    ),
    (
        "rich",
        {"steps.5.slices": (X, Pad(at=1, bytes=1)), "steps.5.bytes": 2},
        {"step 6: padding that no value follows"},
    ),
    (
        "rich",
        {"steps.9.slices": (*RICH_STEPS[9].slices, Pad(at=3, bytes=1)), "steps.9.bytes": 4},
        {"step 10: padding that no value follows"},
    ),
    (
        "rich",
        {"steps.10.slices": (*RICH_STEPS[10].slices, Pad(at=2, bytes=1)), "steps.10.bytes": 3},
        missing(9, "grid.item.row.items", [(offset, 1, 0) for offset in (0, 2, 4, 6)])
        | {"step 11: padding that no value follows"},
    ),
    (
        "rich",
        {"steps.3.slices": (*RICH_STEPS[3].slices, Pad(at=8, bytes=1)), "steps.3.bytes": 9},
        missing(4, "ps.length", [(0, 1, 0)]),
    ),
    (
        "side",
        {
            "steps.0.slices": (
                PLANS["side"].steps[0].slices[0],
                Pad(at=1, bytes=1),
                replace(PLANS["side"].steps[0].slices[1], at=2),
            ),
            "steps.0.bytes": 10,
        },
        missing(0, "b", [(1, 1, 0)]),
    ),
]


@pytest.mark.parametrize(("which", "changes", "said"), OFFSETS)
def test_fault_in_padding_is_said_for_each_offset(which, changes, said):
    found = problems_of(which, changes)
    assert set(found) == said and len(found) == len(said)
