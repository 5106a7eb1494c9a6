"""Messages of the check of plans: tables, steps, the header, and padding."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from firm_hdl.plan import ArrayEnd, Exits, Fixed, Jump, LoopEnd, MapStep, Pad

from .broken_plans import PLANS, problems_of

PLAIN = Exits(default=Jump(step=None))
RICH_STEPS = PLANS["rich"].steps
X = RICH_STEPS[4].slices[0]
MARK = "has a mark of its end, which only items have"
RULE = "a length must be complete in the step that starts what it counts, and in no other"
CONSTANT = "has a constant count, which neither begins nor has a rest"

NESTED = PLANS["nested"].steps
A, NONE = "a.item.t.length", "claims nothing"
PLACE = "has a budget, or renews it, at the wrong place"
UNCOUNTED = {"steps.0.begin.claim": None, "steps.1.begin.claim": None}
SAVED = {f"steps.{step}.begin.claim.saved": 14 for step in (0, 1)}
SEVEN = {f"steps.{step}.begin.claim.saved": 7 for step in (0, 1)}
THOUSAND = {"steps.0.begin.limit": 1000}


def budget(name, size):
    return f"step 0: {name}.length has a budget of {size} bytes"


# The plan, its changes, and the messages of the check.
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
    # They need not be equal runs.
    ("rich", {"runs.2.items": 2}, ["two runs have the same items"]),
    ("rich", {"runs.1.items": 0}, ["run 1: its leaf is not of kind 'items'"]),
    ("rich", {"runs.1.items": 15}, ["run 1: its leaf is not of kind 'items'"]),
    ("rich", {"runs.1.items": -1}, ["run 1: its leaf is not of kind 'items'"]),
    ("narrow", {"runs.0.items": 0}, ["run 0: items are wider than the bus"]),
    ("rich", {"runs.0.terminated": True}, ["run 0: a NUL follows items that are not bytes"]),
    # Of two reasons, the one about the items.
    ("rich", {"runs.2.terminated": True}, ["run 2: a NUL follows items that are not bytes"]),
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
    # Items of 4 bytes: no transfer has one and a half, or half of one.
    ("rich", {"steps.11.slices.0.size": 6}, ["step 11: a transfer of m.items has 6 bytes"]),
    (
        "rich",
        {"steps.11.slices.0.size": 2, "steps.11.slices.0.bytes": 2, "steps.11.bytes": 2},
        ["step 11: a transfer of m.items has 2 bytes"],
    ),
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
    ("text", {"steps.0.slices.0.end": ArrayEnd()}, [f"step 0: s.length {MARK}"]),
    ("trigger", {"steps.0.slices.1.end": ArrayEnd()}, [f"step 0: e.trigger {MARK}"]),
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
    # Beginnings of runs and loops.
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
    # What lengths claim.
    ("nested", UNCOUNTED, [f"step 1: {A} {NONE}"]),
    ("nested", {"steps.0.begin.claim": None}, [f"step 0: a.length {NONE}", f"step 1: {A} {PLACE}"]),
    ("nested", {"steps.1.begin.claim": None}, [f"step 0: a.length {PLACE}", f"step 1: {A} {NONE}"]),
    ("nested", {"steps.1.begin.claim.bytes": 4}, [f"step 1: {A} claims 4 bytes for each item"]),
    ("nested", {"steps.0.begin.claim.bytes": 0}, ["step 0: a.length claims 0 bytes for each item"]),
    ("nested", {"steps.1.begin.claim.least": 2047}, [f"step 1: {A} is counted from 2047"]),
    ("nested", {"steps.1.begin.claim.least": 2049}, [f"step 1: {A} is counted from 2049"]),
    ("nested", {"steps.1.begin.claim.saved": 14}, ["lengths save 0, 14 bytes"]),
    ("nested", {"steps.1.begin.claim.total": 9}, [f"step 1: {A} {PLACE}"]),
    ("nested", {"steps.0.begin.claim.total": None}, [f"step 0: a.length {PLACE}"]),
    ("nested", {"steps.0.begin.claim.total": 1 << 24}, []),
    ("nested", {"steps.0.begin.claim.total": (1 << 24) + 1}, [budget("a", (1 << 24) + 1)]),
    # All elements of 4 bytes that a packet has room for, besides the two lengths outside.
    ("nested", {"steps.0.begin.claim.total": (1 << 24) - 8}, []),
    ("nested", {"steps.0.begin.claim.total": (1 << 24) - 9}, [budget("a", (1 << 24) - 9)]),
    ("nested", SAVED, ["lengths save 14 bytes"]),
    # Padding of 14 bytes may be saved, and need not be in the budget of 1,000 elements.
    ("saving", THOUSAND | {"steps.0.begin.claim.total": 1000 * 8 - 14}, []),
    ("saving", THOUSAND | {"steps.0.begin.claim.total": 7985}, [budget("a", 7985)]),
    # In CDR, the header is no room for elements.
    ("saving", {"steps.0.begin.claim.total": (1 << 24) - 4}, []),
    ("saving", {"steps.0.begin.claim.total": (1 << 24) - 3}, [budget("a", (1 << 24) - 3)]),
    ("saving", {"steps.1.begin.claim.saved": 7}, ["lengths save 7, 14 bytes"]),
    ("saving", THOUSAND | SEVEN, ["lengths save 7 bytes"]),
    # Fewer than 4,096 bytes are not counted.
    ("nested", UNCOUNTED | {"steps.1.begin.limit": 2047}, []),
    ("nested", UNCOUNTED | {"steps.1.begin.limit": 2048}, [f"step 1: {A} {NONE}"]),
    ("nested", {"steps.3.begin.claim": NESTED[1].begin.claim}, [f"step 3: b.length {PLACE}"]),
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
]


@pytest.mark.parametrize(("which", "changes", "problems"), CASES)
def test_fault_has_exactly_these_messages(which, changes, problems):
    assert problems_of(which, changes) == problems


def wrong_padding(step, leaf, offsets):
    """Return the messages for a leaf with wrong padding, at each offset."""
    return {
        f"step {step}: {leaf} has {got} bytes of padding before it, not {need}, at offset {offset} "
        "modulo 8"
        for offset, got, need in offsets
    }


# Faults in padding. Every offset modulo 8 that a packet can have is reported.
OFFSETS: list[tuple[str, dict[str, Any], set[str]]] = [
    (
        "rich",
        {"steps.0.slices.3": Pad(at=5, bytes=2), "steps.0.slices.4.at": 7, "steps.0.bytes": 11},
        wrong_padding(0, "q.length", [(1, 2, 3)]) | wrong_padding(0, "q.items", [(7, 0, 1)]),
    ),
    (
        "rich",
        {"steps.0.slices.3": Pad(at=5, bytes=7), "steps.0.slices.4.at": 12, "steps.0.bytes": 16},
        wrong_padding(0, "q.length", [(1, 7, 3)]),
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
        wrong_padding(0, "b", [(1, 7, 0)]) | {"step 0: 8 padding bytes or more"},
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
    # Items of a run are aligned only by the step that starts the run.
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
    ("gap", {"steps.2.begin.align": 1}, wrong_padding(2, "d.items", [(4, 0, 4)])),
    (
        "gap",
        {"steps.2.begin.align": 4},
        {"step 2: d.items is aligned to 4, not 8", "step 2: d.items is aligned already"},
    ),
    # An item of 2 bytes after 3 bytes, in each round of a loop.
    (
        "rich",
        {"steps.9.align": 1},
        wrong_padding(9, "grid.item.t", [(offset, 0, 1) for offset in (1, 3, 5, 7)]),
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
        wrong_padding(8, "grid.item.row.items", [(offset, 1, 0) for offset in (0, 2, 4, 6)])
        | {"step 10: padding that no value follows"},
    ),
    (
        "rich",
        {"steps.9.slices": (*RICH_STEPS[9].slices, Pad(at=2, bytes=2)), "steps.9.bytes": 4},
        wrong_padding(8, "grid.item.row.items", [(offset, 2, 0) for offset in (0, 2, 4, 6)])
        | {"step 10: padding that no value follows"},
    ),
    # A byte after each of three elements: before the second one, the third one and the next field.
    (
        "rows",
        {
            "steps.0.slices": (*PLANS["rows"].steps[0].slices, Pad(at=3, bytes=1)),
            "steps.0.bytes": 4,
        },
        wrong_padding(0, "r.item.x", [(3, 1, 0), (7, 1, 0)]) | wrong_padding(1, "y", [(3, 1, 0)]),
    ),
    # The right padding for the next element, but within the loop: after the last one, it is none.
    (
        "elements",
        {
            "steps.1.slices": (*PLANS["elements"].steps[1].slices, Pad(at=5, bytes=3)),
            "steps.1.bytes": 8,
            "steps.1.align": 1,
        },
        {"step 2: padding that no value follows"},
    ),
    # The right padding for the first element, but outside the loop.
    (
        "pairs",
        {
            "steps.0.slices": (*PLANS["pairs"].steps[0].slices, Pad(at=5, bytes=1)),
            "steps.0.bytes": 6,
            "steps.1.align": 1,
        },
        {"step 1: padding that no value follows"},
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
        wrong_padding(0, "b", [(1, 1, 0)]),
    ),
]


@pytest.mark.parametrize(("which", "changes", "problems"), OFFSETS)
def test_fault_in_padding_is_reported_for_each_offset(which, changes, problems):
    found = problems_of(which, changes)
    assert set(found) == problems and len(found) == len(problems)
