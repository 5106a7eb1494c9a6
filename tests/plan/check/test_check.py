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
@pytest.mark.sampled(7)
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
@pytest.mark.sampled(7)
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
