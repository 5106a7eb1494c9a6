"""The table is that of the contract; the standard set has what it claims."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import firm_hdl.fuzz.table
from firm_hdl.fuzz.command import main
from firm_hdl.fuzz.table import table_of
from firm_hdl.fuzz.types import BUS_BYTES, TYPES, message_of
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make


def table(message, bus_bytes=8, most=1000):
    return table_of(message, wire=message.wire, bus_bytes=bus_bytes, max_message_bytes=most)


def test_the_text_of_a_table():
    inner = make("ros2", {"flag": "bool", "names": "string<=5[2]"})
    message = make("ros2", {"a": "uint8", "few": "float64[<=3]", "w": "wstring", "m": inner})
    # The shortest packet has 4 + 1 + 4 + 4 + 1 + 2 * 4 bytes.
    assert table(message).text() == (
        "table 1 8 8 978 256 0\n"
        "a 8 1\nfew.length 32 1\nfew.items 64 1\nw.length 32 1\nw.items 32 2\n"
        "m.flag 1 1\nm.names.item.length 32 1\nm.names.item.items 8 8\n"
        "scalar 0 1 0\n"
        "run 1 2 8 0 0 0 3 3\n"
        "run 3 4 4 0 0 0 0 244\n"
        "scalar 5 1 1\n"
        "loop -1 4 2 0 0\nrun 6 7 1 0 1 0 5 5\nend\n"
    )


@pytest.mark.parametrize("name", TYPES)
def test_leaves_and_limits_are_those_of_the_plan(name):
    message = message_of(name)
    made = table(message, bus_bytes=4, most=3000)
    plan = build_plan(lay_out(message), bus_bytes=4, max_message_bytes=3000)
    assert [(leaf.path, leaf.lanes) for leaf in made.leaves] == [
        (leaf.path, leaf.lanes) for leaf in plan.leaves
    ]
    limits = {
        int(line.split()[1]): int(line.split()[-1])
        for line in made.lines
        if line.startswith(("run", "loop")) and line.split()[1] != "-1"
    }
    assert limits == {leaf: begin.limit for leaf, begin in plan.begins.items()}


@pytest.mark.parametrize("room", [0, 1, 7, 8, 15, 16, 40, 100])
def test_limits_of_padded_elements_are_those_of_the_plan_in_any_room(room):
    inner = make("ros2", {"x": "uint8", "d": "float64"})
    small = make("ros2", {"a": "uint16", "b": "uint8"})
    message = make("ros2", {"f": "uint8", "e": (inner, "[]"), "s": (small, "[<=5]"), "t": "string"})
    most = table(message, most=0).least_bytes + room
    plan = build_plan(lay_out(message), bus_bytes=8, max_message_bytes=most)
    limits = [
        int(line.split()[-1])
        for line in table(message, most=most).lines
        if line.startswith(("run", "loop")) and line.split()[1] != "-1"
    ]
    assert limits == [begin.limit for begin in plan.begins.values()]


def test_the_table_is_made_from_the_model_alone():
    text = Path(firm_hdl.fuzz.table.__file__).read_text(encoding="utf-8")
    imports = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ImportFrom)]
    assert [node.module for node in imports if "firm_hdl" in str(node.module)] == ["firm_hdl.model"]
    assert not any(isinstance(node, ast.Import) for node in ast.walk(ast.parse(text)))


def test_the_standard_set_has_50_types_and_five_widths(capsys):
    assert len(set(TYPES)) == 50
    assert len(set(BUS_BYTES)) == 5
    assert main(["--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(set(lines)) == 250
    # A run that is stopped early has had all types, and all widths.
    assert {line.split()[0] for line in lines[:50]} == set(TYPES)
    assert {line.split()[2] for line in lines[:5]} == {str(width) for width in BUS_BYTES}
