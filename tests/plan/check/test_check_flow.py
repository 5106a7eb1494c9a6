"""Messages of the check of plans: transfers, jumps, loops, and rests of runs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from firm_hdl.plan import (
    ArrayEnd,
    Exits,
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

from .broken_plans import PLANS, problems_of

PLAIN = Exits(default=Jump(step=None))
RICH_STEPS = PLANS["rich"].steps
PAIR_STEPS = PLANS["pair"].steps
BYTE = Part(at=4, bytes=1, leaf=0, first=0, size=1)
FIRST = "its first transfer is not a full word, or has a mark of its end"
JOIN = "the parts of a transfer do not join"
LOADED = "the counter of the run is not loaded, or needlessly loaded"

# The plan, its changes, and the messages of the check.
CASES: list[tuple[str, dict[str, Any], list[str]]] = [
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
    # Values that are cut at the end of a step.
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
    # The body has another run than the loaded one.
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
    # The first step of a loop's body takes the rest of the previous round.
    ("rich", {"steps.4.rest": None}, ["step 4: does not take the rest of ps.item.s.items"]),
    # Items of a constant count leave none.
    ("rich", {"steps.11.rest": 3}, ["step 11: w.items has no rest here"]),
]


@pytest.mark.parametrize(("which", "changes", "problems"), CASES)
def test_fault_has_exactly_these_messages(which, changes, problems):
    assert problems_of(which, changes) == problems


def without(plan: Plan, index: int) -> Plan:
    """Return a plan without a step: jumps to it go to its successor."""
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
    problems = ["the end: no step takes the rest of s.items"]
    assert check(without(plan, len(plan.steps) - 1)) == problems


def test_the_rests_of_two_runs_must_not_meet():
    plan = PLANS["texts"]
    assert [step.rest for step in plan.steps] == [None, None, 0, 1, None, 1]
    problems = ["step 2: does not take the rest of s.items"]
    assert check(without(plan, 2)) == problems


@pytest.mark.parametrize("count", range(2, 10))
def test_padding_after_a_constant_loop_is_that_of_its_last_round(count):
    """Rounds end at offsets 3, 7, 3, 7, ... modulo 8, after a start at offset 0."""
    pair = make("ros2", {"x": "uint16", "y": "uint8"}, "Pair")
    plan = build_plan(lay_out(make("ros2", {"e": (pair, f"[{count}]"), "z": "uint64"})))
    assert check(plan) == []
    padding, _ = plan.steps[-1].slices
    assert padding == Pad(at=0, bytes=5 if count % 2 else 1)


def test_a_run_has_one_transfer_behind_it():
    """The words of a run are all but the last transfer of its items."""
    plan = build_plan(lay_out(make("ros1", {"b": "uint8[21]"})))
    words, tail = plan.steps
    assert plan.start.enter == (("run", 16),) and tail.bytes == 5
    # A word less in the run, and a step for it before the tail.
    (part,) = tail.slices
    word = replace(part, bytes=8, size=8, end=None)
    more = replace(tail, bytes=8, slices=(word,), exits=Exits(default=Jump(step=2)))
    start = replace(plan.start, enter=(("run", 8),))
    problems = check(replace(plan, start=start, steps=(words, more, tail)))
    assert problems == ["leaf b.items: 2 transfers and 1 runs"]
