"""Notes beside the steps in a plan's text: the place in all packets, and the loops around it.

An engineer finds a byte of a captured packet in the plan by these notes. Places are worked out by
hand: header, fields at multiples of their sizes, the words of an array after the earlier fields.
"""

from __future__ import annotations

import re

import pytest

from firm_hdl.plan import build_plan, to_yaml
from firm_hdl.wire import lay_out
from tests.strategies import make

POINT = make("ros2", {"x": "uint8", "name": "string"}, "Point")
PAIR = make("ros2", {"x": "uint64", "y": "uint64"}, "Pair")
PAIRS = make("ros2", {"p": (PAIR, "[2]")}, "Pairs")
TWICE, POINTS = "in loop 0 (2 times)", "in loop 0 (p.length)"


@pytest.mark.parametrize(
    ("dialect", "fields", "bus_bytes", "notes"),
    [
        # A run in the middle of a chain: two words of 8 bytes, and a tail of 5.
        (
            "ros2",
            {"a": "uint8", "b": "uint8[21]", "c": "uint16"},
            8,
            ["packet bytes 0..4", "packet bytes 5..20", "packet bytes 21..27"],
        ),
        # A run that begins at the start of the plan.
        (
            "ros1",
            {"b": "uint8[24]", "c": "uint16"},
            8,
            ["packet bytes 0..23", "packet bytes 24..25"],
        ),
        # A run with padding before the first item.
        (
            "ros2",
            {"a": "uint8", "b": "float64[3]", "c": "uint8"},
            8,
            ["packet bytes 0..11", "packet bytes 12..35", "packet byte 36"],
        ),
        # A single byte is called "byte".
        ("ros1", {"a": "uint8", "c": "uint8[2]"}, 1, ["packet bytes 0..1", "packet byte 2"]),
        # No step after a text or a loop has a fixed place.
        ("ros2", {"s": "string", "b": "uint8[21]"}, 8, ["packet bytes 0..7", "", "", "", ""]),
        ("ros2", {"q": (PAIR, "[2]"), "b": "uint8"}, 8, ["packet bytes 0..3", TWICE, ""]),
        # Items wider than the bus are a loop, whose count is not in the packet.
        ("ros1", {"b": "float32[3]", "c": "uint8"}, 2, ["in loop 0 (3 times)", ""]),
        # Loops in loops, outer ones first.
        (
            "ros2",
            {"q": (PAIRS, "[3]")},
            8,
            ["packet bytes 0..3", "in loop 0 (3 times), in loop 1 (2 times)"],
        ),
        # Loops are found after steps that start something else.
        (
            "ros2",
            {"n": "string", "q": (PAIR, "[2]"), "p": (POINT, "[]")},
            8,
            ["packet bytes 0..7", "", "", TWICE, "", POINTS, POINTS, POINTS, ""],
        ),
    ],
)
def test_steps_have_their_places_and_loops(dialect, fields, bus_bytes, notes):
    text = to_yaml(build_plan(lay_out(make(dialect, fields)), bus_bytes=bus_bytes))
    assert re.findall(r"^  step \d+:(?:  # (.*))?$", text, re.MULTILINE) == notes
