"""Plans of all constructs, and plans with changed values."""

from __future__ import annotations

import dataclasses
from dataclasses import replace
from typing import Any

from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make

__all__ = ["PLANS", "RICH", "damaged"]

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


def plan_of(fields, bus_bytes=8, dialect="ros1"):
    return build_plan(lay_out(make(dialect, fields)), bus_bytes=bus_bytes)


PLANS = {
    "rich": build_plan(lay_out(RICH)),
    # A string and items wider than the bus, which are a loop.
    "narrow": plan_of({"m": "float32[7]", "s": "string"}, 1),
    "trigger": plan_of({"a": "uint8", "e": make("ros1", {}, "E")}),
    # A transfer in four steps.
    "cut": plan_of({"b": "uint64"}, 2),
    "last": plan_of({"a": "uint8", "b": "uint8", "c": "uint8"}),
    "side": plan_of({"a": "uint8", "b": "uint64"}, 16),
    # An array of two transfers.
    "pair": plan_of({"a": "uint32", "t": "uint32[3]"}),
    # A run whose rest is the end of the packet.
    "text": plan_of({"s": "string"}),
    # A run before a loop that ends in a run.
    "texts": plan_of({"s": "string", "ts": (make("ros1", {"t": "string"}, "T"), "[2]")}),
    # Lengths that share a budget.
    "nested": plan_of({"a": (make("ros1", {"t": "uint16[]"}, "T"), "[]"), "b": "uint16[]"}),
    # A loop of constant count that begins at the start.
    "rows": plan_of({"r": (make("ros1", {"x": "uint8", "w": "uint16"}, "R"), "[3]"), "y": "uint8"}),
    # Elements with padding before each but the first one.
    "elements": plan_of(
        {"p": (make("ros2", {"x": "uint32", "y": "uint8"}, "P"), "[]"), "z": "uint32"}, 8, "ros2"
    ),
    # Padding of items only, before the first one.
    "gap": plan_of({"a": "uint8[]", "d": "float64[]"}, 8, "ros2"),
    # Padding of the first of two elements only.
    "pairs": plan_of(
        {"a": "uint8", "p": (make("ros2", {"x": "uint16", "y": "uint16"}, "P"), "[2]")}, 8, "ros2"
    ),
}


def damaged(node: Any, changes: dict[str, Any]) -> Any:
    """Return a plan with new values at paths of attributes and indexes."""
    for path, new in changes.items():
        node = _damaged(node, path.split("."), new)
    return node


def _damaged(node: Any, path: list[str], new: Any) -> Any:
    if not path:
        return new
    if isinstance(node, tuple):
        index = int(path[0])
        return (*node[:index], _damaged(node[index], path[1:], new), *node[index + 1 :])
    assert path[0] in {field.name for field in dataclasses.fields(node)}
    return replace(node, **{path[0]: _damaged(getattr(node, path[0]), path[1:], new)})
