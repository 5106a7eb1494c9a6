"""What the check says of each fault: every sentence that it has, and nothing besides."""

from __future__ import annotations

import dataclasses
from dataclasses import replace
from typing import Any

import pytest

from firm_hdl.plan import (
    ArrayEnd,
    Exits,
    Fixed,
    Jump,
    LoopEnd,
    MapStep,
    Pad,
    Part,
    Plan,
    Step,
    build_plan,
    check,
)
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
    # A run of constant count, which the start loads.
    "entered": plan_of({"b": "uint8[24]"}),
    # A transfer in three steps.
    "cut": plan_of({"b": "uint64"}, 2),
    "last": plan_of({"a": "uint8", "b": "uint8", "c": "uint8"}),
    "side": plan_of({"a": "uint8", "b": "uint64"}, 16),
    # An array of two transfers.
    "pair": plan_of({"a": "uint32", "t": "uint32[3]"}),
    # A run whose rest nothing follows.
    "text": plan_of({"s": "string"}),
    # A run before a loop that ends in a run.
    "texts": plan_of({"s": "string", "ts": (make("ros1", {"t": "string"}, "T"), "[2]")}),
    # Padding of items only, before the first one.
    "gap": plan_of({"a": "uint8[]", "d": "float64[]"}, 8, "ros2"),
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
RICH_STEPS = PLANS["rich"].steps
PAIR_STEPS = PLANS["pair"].steps
BYTE = Part(at=4, bytes=1, leaf=0, first=0, size=1)
X = RICH_STEPS[4].slices[0]
MARK = "has a mark of its end, which only items have"
FIRST = "its first transfer is not a full word, or has a mark of its end"
RULE = "a length must be complete in the step that starts what it counts, and in no other"
JOIN = "the parts of a transfer do not join"
LOADED = "the counter of the run is not loaded, or needlessly loaded"
CONSTANT = "has a constant count, which neither begins nor has a rest"

# Which plan, what is changed in it, and what is said of that.
CASES: list[tuple[str, dict[str, Any], list[str]]] = [
    # Tables.
    ("rich", {"bus_bytes": 3}, ["a bus cannot have 3 bytes"]),
    ("rich", {"header_bytes": 0}, ["header or trailing bytes are not those of cdr"]),
    ("rich", {"max_trailing_bytes": 0}, ["header or trailing bytes are not those of cdr"]),
    ("rich", {"wire": "ros1"}, ["header or trailing bytes are not those of ros1"]),
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
    ("entered", {"runs.0.terminated": True}, ["run 0: a NUL follows items of a constant count"]),
    # Steps.
    ("rich", {"steps": ()}, ["there are no steps"]),
    ("rich", {"steps.2.align": 3}, ["step 2: alignment to 3"]),
    ("rich", {"steps.2.align": 16}, ["step 2: alignment to 16"]),
    ("rich", {"steps.10.align": 3}, ["step 10: alignment to 3"]),
    ("rich", {"steps.1.run": 4}, ["step 1: there is no run 4"]),
    ("rich", {"steps.1.run": -1}, ["step 1: there is no run -1"]),
    ("rich", {"steps.2.rest": 4}, ["step 2: there is no run 4"]),
    ("rich", {"steps.2.rest": -1}, ["step 2: there is no run -1"]),
    ("rich", {"steps.2.rest": 2}, [f"step 2: m.items {CONSTANT}"]),
    ("rich", {"runs.0.counted": False}, [f"step {n}: q.items {CONSTANT}" for n in (0, 2)]),
    ("rich", {"steps.3.slices.0.leaf": 15}, ["step 3: there is no leaf 15"]),
    ("rich", {"steps.3.slices.0.leaf": -1}, ["step 3: there is no leaf -1"]),
    ("rich", {"steps.11.slices.0.size": 12}, ["step 11: a transfer of m.items has 12 bytes"]),
    (
        "rich",
        {"steps.11.slices.0.size": 0},
        ["step 11: a transfer of m.items has 0 bytes", "step 11: m.items has no bytes 0 to 3"],
    ),
    ("trigger", {"steps.0.slices.1.size": 1}, ["step 0: a transfer of e.trigger has 1 bytes"]),
    ("rich", {"steps.2.slices.0.first": -1}, ["step 2: b has no bytes -1 to 6"]),
    ("rich", {"steps.2.slices.0.first": 1}, ["step 2: b has no bytes 1 to 8"]),
    ("rich", {"steps.2.slices.0.bytes": 9}, ["step 2: b has no bytes 0 to 8"]),
    ("rich", {"steps.2.slices.0.bytes": 0}, ["step 2: b has no bytes 0 to -1"]),
    ("rich", {"steps.2.slices.0.end": ArrayEnd()}, [f"step 2: b {MARK}"]),
    ("rich", {"steps.2.slices.0.end": LoopEnd(level=0)}, [f"step 2: b {MARK}"]),
    ("rich", {"steps.0.slices.3": Pad(at=5, bytes=0)}, ["step 0: the slice at byte 5 is empty"]),
    ("rich", {"steps.0.slices.1.data": b""}, ["step 0: the slice at byte 2 is empty"]),
    ("rich", {"steps.2.bytes": 7}, ["step 2: the map has 8 bytes, the step 7"]),
    (
        "rich",
        {"steps.0.slices.3.at": 6},
        [f"step 0: byte {n} is not mapped exactly once" for n in (5, 8)],
    ),
    ("rich", {"steps.11.slices.0.size": 8}, ["step 11: m.items is cut by the next part"]),
    (
        "side",
        {"steps.0.slices.1.first": 1, "steps.0.slices.1.bytes": 7, "steps.0.bytes": 8},
        ["step 0: b continues after other bytes"],
    ),
    (
        "trigger",
        {"steps.0.slices": (Pad(at=0, bytes=17),), "steps.0.bytes": 17},
        ["step 0: the map has 17 bytes, more than two bus words"],
    ),
    (
        "rich",
        {"steps.2.slices.0": Pad(at=0, bytes=9), "steps.2.bytes": 9},
        ["step 2: the map after a rest has 9 bytes, more than a bus word"],
    ),
    (
        "trigger",
        {"steps": (*PLANS["trigger"].steps, MapStep(exits=PLAIN))},
        ["step 1: there is nothing to do"],
    ),
    # What a step begins.
    ("rich", {"steps.0.begin": None}, [f"step 0: {RULE}"]),
    ("rich", {"steps.2.begin": RICH_STEPS[0].begin}, [f"step 2: {RULE}"]),
    (
        "rich",
        {
            "steps.3.slices": (*RICH_STEPS[3].slices, Pad(at=4, bytes=1)),
            "steps.3.bytes": 5,
        },
        [f"step 3: {RULE}"],
    ),
    ("rich", {"steps.3.begin.limit": -1}, ["step 3: a count has the limit -1"]),
    ("rich", {"steps.3.begin.limit": 0}, []),
    ("rich", {"steps.0.begin.limit": -1}, ["step 0: a count has the limit -1"]),
    ("rich", {"steps.0.begin.limit": 0}, []),
    ("rich", {"steps.0.begin.run": 4}, ["step 0: there is no run 4"]),
    ("rich", {"steps.0.begin.run": -1}, ["step 0: there is no run -1"]),
    ("rich", {"steps.0.begin.run": 2}, [f"step 0: m.items {CONSTANT}"]),
    ("rich", {"steps.0.begin.align": 3}, ["step 0: alignment of items to 3"]),
    ("rich", {"steps.0.begin.align": 16}, ["step 0: alignment of items to 16"]),
    ("rich", {"steps.0.begin.body.step": None}, ["step 0, body: goes to step 14, not 1"]),
    # The header.
    ("rich", {"steps.0.slices.0.data": b"\0\0"}, ["the header is not that of cdr"]),
    ("rich", {"steps.0.slices.0.check": False}, ["the header is not that of cdr"]),
    ("rich", {"steps.0.slices.1.check": True}, ["the header is not that of cdr"]),
    ("rich", {"steps.0.slices.1.data": b"\0\1"}, ["the header is not that of cdr"]),
    (
        "rich",
        {"steps.4.slices": (X, Fixed(at=1, data=b"x", check=False)), "steps.4.bytes": 2},
        ["fixed bytes follow the header", "the header is not that of cdr"],
    ),
    # Transfers.
    (
        "rich",
        {"steps.2.slices.0.leaf": 6},
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
                *RICH_STEPS[0].slices[:3],
                replace(BYTE, at=5),
                Pad(at=6, bytes=2),
                RICH_STEPS[0].slices[4],
            )
        },
        ["step 0: two transfers of a are in one cycle"],
    ),
    (
        "pair",
        {
            "steps": (
                replace(
                    PAIR_STEPS[1],
                    bytes=16,
                    slices=(*PAIR_STEPS[0].slices, replace(PAIR_STEPS[1].slices[0], at=12)),
                ),
            )
        },
        ["step 0: two transfers of t.items are in one cycle"],
    ),
    (
        "pair",
        {
            "steps": (
                PAIR_STEPS[0],
                replace(PAIR_STEPS[1], exits=Exits(default=Jump(step=2))),
                PAIR_STEPS[1],
            )
        },
        ["leaf t.items: 3 transfers and 0 runs"],
    ),
    (
        "rich",
        {"steps.11.slices.0.end": None},
        ["leaf m.items: its last transfer has no mark of its end"],
    ),
    (
        "pair",
        {"steps.1.slices.0.end": None},
        ["leaf t.items: its last transfer has no mark of its end"],
    ),
    (
        "pair",
        {"steps.1.slices.0.end": LoopEnd(level=0)},
        ["leaf t.items: the last of several transfers is in a loop"],
    ),
    ("pair", {"steps.0.slices.1.end": ArrayEnd()}, [f"leaf t.items: {FIRST}"]),
    ("pair", {"steps.0.slices.1.end": LoopEnd(level=0)}, [f"leaf t.items: {FIRST}"]),
    (
        "pair",
        {"steps.0.slices.1.size": 4, "steps.0.slices.1.bytes": 4, "steps.0.bytes": 8},
        [f"leaf t.items: {FIRST}"],
    ),
    ("rich", {"runs.2.last": True}, ["leaf m.items: its run and its tail disagree about its end"]),
    ("rich", {"runs.0.last": False}, ["leaf q.items: its run and its tail disagree about its end"]),
    (
        "rich",
        {"steps.11.slices.0.end": LoopEnd(level=0)},
        ["leaf m.items: the last of several transfers is in a loop"],
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
    ("cut", {"steps.1.align": 2}, [f"step 1: {JOIN}"]),
    (
        "cut",
        {"steps.2.slices.0.first": 3},
        ["leaf b: 0 transfers and 0 runs", f"step 2: {JOIN}", "the last transfer is cut"],
    ),
    ("cut", {"steps.0.exits.repeats": ((0, Jump(step=0)),)}, [f"step 1: {JOIN}"]),
    ("cut", {"steps.0.slices.0.bytes": 1, "steps.0.bytes": 1}, [f"step 1: {JOIN}"]),
    ("cut", {"steps.0.slices": (Pad(at=0, bytes=2),)}, [f"step 1: {JOIN}"]),
    ("narrow", {"steps.1.slices.0.end": LoopEnd(level=1)}, [f"step 1: {JOIN}", f"step 2: {JOIN}"]),
    (
        "narrow",
        {"steps.1.slices.0.end": ArrayEnd()},
        [f"step 1: {JOIN}", f"step 2: {JOIN}"],
    ),
    # The flow.
    ("rich", {"start.step": 1}, ["start: goes to step 1, not 0"]),
    ("rich", {"start.step": None}, ["start: goes to step 14, not 0"]),
    ("rich", {"start.enter": (("run", 1),)}, [f"step 0: {LOADED}"]),
    ("rich", {"levels": 2}, ["2 loop counters, of which 1 are used"]),
    ("rich", {"levels": 0}, ["step 7, next: loop 0 inside 0 loops"]),
    ("rich", {"steps.7.exits.default.enter": ((0, 0),)}, ["step 7, next: loads a count of 0"]),
    ("rich", {"steps.7.exits.default.enter": ()}, ["step 9: loop 0 ends inside 0 loops"]),
    ("rich", {"steps.7.exits.default.enter": ((1, 6),)}, ["step 7, next: loop 1 inside 0 loops"]),
    (
        "rich",
        {"steps.9.exits.default.enter": (("run", 6), ("run", 6))},
        ["step 9, next: the counter of the run is loaded twice"],
    ),
    ("rich", {"steps.9.exits.default.enter": (("run", 0),)}, ["step 9, next: loads a count of 0"]),
    (
        "rich",
        {"steps.9.exits.default.enter": (("run", 5),)},
        ["step 10: 5 items do not fill words of 2"],
    ),
    ("rich", {"steps.9.exits.default.enter": ()}, [f"step 10: {LOADED}"]),
    ("rich", {"steps.8.exits.default.enter": (("run", 6),)}, [f"step 9: {LOADED}"]),
    # The run of the body is not the one that was loaded.
    (
        "rich",
        {"steps.1.run": 1},
        ["leaf ps.item.s.items is out of order", "leaf b is out of order"],
    ),
    ("rich", {"runs.2.counted": True}, [f"step 10: {LOADED}"]),
    (
        "rich",
        {"steps.13.exits.default.enter": (("run", 1),)},
        ["step 13, next: ends within a loop or a run"],
    ),
    (
        "narrow",
        {"steps.8.exits.default": Jump(step=9)},
        ["step 8, next: there is no step 9"],
    ),
    (
        "narrow",
        {"steps.2.exits.default": Jump(step=None)},
        ["step 2, next: goes to step 9, not 3"],
    ),
    (
        "rich",
        {"steps.6.exits.default.enter": ((0, 6),)},
        ["step 6, next: step 7 is also reached with other open loops"],
    ),
    (
        "rich",
        {"steps.6.exits.repeats": ()},
        ["step 3, next: goes to step 7, not 6"],
    ),
    ("rich", {"steps.13.exits.default.step": 14}, ["step 13, next: there is no step 14"]),
    ("rich", {"steps.11.exits.default.step": 14}, ["step 11, next: goes to step 14, not 13"]),
    ("rich", {"steps.3.begin.level": 1}, ["step 3: loop 1 inside 0 loops"]),
    ("rich", {"steps.3.begin.body.step": 5}, ["step 3, body: goes to step 5, not 4"]),
    ("rich", {"steps.0.begin.body.step": 2}, ["step 0, body: goes to step 2, not 1"]),
    (
        "rich",
        {"steps.5.exits.repeats.0": (1, Jump(step=4))},
        ["step 5: loop 1 ends inside 1 loops"],
    ),
    (
        "rich",
        {"steps.9.exits.repeats.0.1.step": 9},
        ["step 9, loop 0 again: goes to step 9, not 8"],
    ),
    (
        "narrow",
        {f"steps.{n}.slices.0.end": LoopEnd(level=1) for n in range(3)},
        ["step 0: loop 1 is not the innermost"],
    ),
    (
        "trigger",
        {
            "steps": (
                *PLANS["trigger"].steps,
                MapStep(bytes=1, slices=(Pad(at=0, bytes=1),), exits=PLAIN),
            )
        },
        ["step 0, next: goes to step 2, not 1"],
    ),
    # Rests of runs.
    ("rich", {"steps.2.rest": None}, ["step 2: does not take the rest of q.items"]),
    ("rich", {"steps.3.rest": 0}, ["step 3: q.items has no rest here"]),
    ("text", {"steps.0.rest": 0}, ["step 0: s.items has no rest here"]),
    (
        "rich",
        {"steps.2.rest": 1},
        [
            "step 2: ps.item.s.items has no rest here",
            "step 2: does not take the rest of q.items",
        ],
    ),
    # The first step of a loop's body, which the loop repeats.
    ("rich", {"steps.4.rest": None}, ["step 4: does not take the rest of ps.item.s.items"]),
    # Items of a constant count leave none.
    ("rich", {"steps.11.rest": 3}, ["step 11: w.items has no rest here"]),
]


@pytest.mark.parametrize(("which", "changes", "said"), CASES)
def test_fault_is_said_in_so_many_words(which, changes, said):
    assert problems_of(which, changes) == said


def without(plan: Plan, index: int) -> Plan:
    """Return a plan without a step: jumps to it go where it goes."""
    after = plan.steps[index].exits.default

    def jump(old: Jump) -> Jump:
        new = after if old.step == index else old
        return new if new.step is None or new.step < index else replace(new, step=new.step - 1)

    def step(old: Step) -> Step:
        repeats = tuple((level, jump(each)) for level, each in old.exits.repeats)
        exits = Exits(repeats=repeats, default=jump(old.exits.default))
        if old.begin is None or old.begin.body is None:
            return replace(old, exits=exits)
        return replace(old, exits=exits, begin=replace(old.begin, body=jump(old.begin.body)))

    steps = (step(old) for number, old in enumerate(plan.steps) if number != index)
    return replace(plan, start=jump(plan.start), steps=tuple(steps))


def test_the_rest_at_the_end_of_a_packet_must_be_taken():
    plan = PLANS["text"]
    assert (plan.steps[-1].rest, plan.steps[-1].bytes) == (0, 0)
    said = ["the end: no step takes the rest of s.items"]
    assert check(without(plan, len(plan.steps) - 1)) == said


def test_the_rests_of_two_runs_must_not_meet():
    plan = PLANS["texts"]
    assert [step.rest for step in plan.steps] == [None, None, 0, 1, None, 1]
    said = ["step 2: does not take the rest of s.items"]
    assert check(without(plan, 2)) == said


def missing(step, leaf, offsets):
    """What is said of a leaf without its padding, at each offset."""
    return {
        f"step {step}: {leaf} has {got} bytes of padding before it, not {need}, at offset {offset} "
        "modulo 8"
        for offset, got, need in offsets
    }


# Where leaves stand. Each place modulo 8 that a packet can have is told of.
OFFSETS: list[tuple[str, dict[str, Any], set[str]]] = [
    (
        "rich",
        {"steps.0.slices.3": Pad(at=5, bytes=2), "steps.0.slices.4.at": 7, "steps.0.bytes": 11},
        missing(0, "q.length", [(1, 2, 3)]) | missing(0, "q.items", [(7, 0, 1)]),
    ),
    (
        "rich",
        {"steps.0.slices.3": Pad(at=5, bytes=7), "steps.0.slices.4.at": 12, "steps.0.bytes": 16},
        missing(0, "q.length", [(1, 7, 3)]),
    ),
    (
        "side",
        {
            "steps.0.slices": (
                PLANS["side"].steps[0].slices[0],
                Pad(at=1, bytes=8),
                replace(PLANS["side"].steps[0].slices[1], at=9),
            ),
            "steps.0.bytes": 17,
        },
        missing(0, "b", [(1, 7, 0)]) | {"step 0: 8 padding bytes or more"},
    ),
    ("rich", {"steps.8.align": 2}, {"step 8: grid.item.row.items is aligned to 2, not 1"}),
    ("rich", {"steps.10.align": 8}, {"step 10: m.items is aligned to 8, not 4"}),
    (
        "rich",
        {"steps.0.align": 4},
        {"step 0: alignment that no value follows", "step 0: is aligned already"},
    ),
    (
        "rich",
        {"steps.7.align": 4},
        {"step 7: alignment that no value follows", "step 10: is aligned already"},
    ),
    # Items of a run, which only the step that starts it aligns.
    ("rich", {"steps.0.begin.align": 2}, {"step 0: q.items is aligned already"}),
    (
        "rich",
        {"steps.0.begin.align": 8},
        {"step 0: q.items is aligned to 8, not 2", "step 0: q.items is aligned already"},
    ),
    (
        "rich",
        {"steps.1.align": 2},
        {"step 1: is aligned within a run", "step 1: is aligned already"},
    ),
    ("gap", {"steps.2.begin.align": 1}, missing(2, "d.items", [(4, 0, 4)])),
    (
        "gap",
        {"steps.2.begin.align": 4},
        {"step 2: d.items is aligned to 4, not 8", "step 2: d.items is aligned already"},
    ),
    # An item of 2 bytes after 3 bytes, in each round of a loop.
    (
        "rich",
        {"steps.9.align": 1},
        missing(9, "grid.item.t", [(offset, 0, 1) for offset in (1, 3, 5, 7)]),
    ),
    (
        "rich",
        {"steps.4.slices": (X, Pad(at=1, bytes=1)), "steps.4.bytes": 2},
        {"step 5: padding that no value follows"},
    ),
    (
        "rich",
        {"steps.8.slices": (*RICH_STEPS[8].slices, Pad(at=3, bytes=1)), "steps.8.bytes": 4},
        {"step 9: padding that no value follows"},
    ),
    (
        "rich",
        {"steps.9.slices": (*RICH_STEPS[9].slices, Pad(at=2, bytes=1)), "steps.9.bytes": 3},
        missing(8, "grid.item.row.items", [(offset, 1, 0) for offset in (0, 2, 4, 6)])
        | {"step 10: padding that no value follows"},
    ),
    (
        "rich",
        {"steps.9.slices": (*RICH_STEPS[9].slices, Pad(at=2, bytes=2)), "steps.9.bytes": 4},
        missing(8, "grid.item.row.items", [(offset, 2, 0) for offset in (0, 2, 4, 6)])
        | {"step 10: padding that no value follows"},
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
