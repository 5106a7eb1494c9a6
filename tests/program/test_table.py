"""Programs of small messages, as they are printed: each file was reviewed by a person."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.plan import build_plan
from firm_hdl.program.table import program_text
from firm_hdl.wire import lay_out
from tests.strategies import make

GOLDEN = Path(__file__).parent / "golden"
ROW = make("ros2", {"x": "uint8", "cells": "string[]"}, "Row")
POINT = make("ros2", {"x": "float32", "y": "float64"}, "Point")


@pytest.mark.parametrize(
    ("name", "fields", "wire", "bus_bytes"),
    [
        # A string, and the padding after it.
        ("tag", {"name": "string", "id": "uint16"}, "cdr", 8),
        # Nested loops with a budget, and an array; alignment does not count from a constant.
        ("rows", {"rows": (ROW, "[]"), "grid": "int16[7]"}, "cdr", 2),
        # Items that are aligned, and a loop of constant count.
        ("points", {"a": "uint64[]", "p": (POINT, "[3]")}, "cdr", 8),
    ],
)
def test_programs_are_printed_one_line_a_state(name, fields, wire, bus_bytes):
    layout = lay_out(make("ros2", fields, name.title()), wire)
    plan = build_plan(layout, bus_bytes=bus_bytes, max_message_bytes=400)
    assert program_text(plan) == (GOLDEN / f"{name}.txt").read_text()
