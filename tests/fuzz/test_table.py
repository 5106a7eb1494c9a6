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


PADDED = {"x": "uint8", "d": "float64"}


@pytest.mark.parametrize(
    ("dialect", "kind", "leaves", "lines"),
    [
        # A packet of 100 bytes, on a bus of 4. Runs: length, items, bytes, bool, NUL, count, bound
        # and limit; loops: length, bytes of an element, count, bound and limit.
        ("ros2", "bool", "v 1 1", "scalar 0 1 1"),
        ("ros2", "bool[]", "v.length 32 1 v.items 1 4", "run 0 1 1 1 0 0 0 92"),
        ("ros2", "bool[3]", "v.items 1 4", "run -1 0 1 1 0 3 0 0"),
        ("ros1", "bool[]", "v.length 32 1 v.items 1 4", "run 0 1 1 1 0 0 0 96"),
        ("ros2", "uint16[3]", "v.items 16 2", "run -1 0 2 0 0 3 0 0"),
        ("ros2", "uint8[0]", "v.items 8 4", "run -1 0 1 0 0 0 0 0"),
        ("ros2", "int64[]", "v.length 32 1 v.items 64 1", "run 0 1 8 0 0 0 0 11"),
        ("ros2", "float32[<=300]", "v.length 32 1 v.items 32 1", "run 0 1 4 0 0 0 300 23"),
        ("ros2", "string", "v.length 32 1 v.items 8 4", "run 0 1 1 0 1 0 0 91"),
        ("ros1", "string", "v.length 32 1 v.items 8 4", "run 0 1 1 0 0 0 0 96"),
        ("ros2", "wstring<=9", "v.length 32 1 v.items 32 1", "run 0 1 4 0 0 0 9 9"),
        (
            "ros2",
            "string[]",
            "v.length 32 1 v.item.length 32 1 v.item.items 8 4",
            "loop 0 4 0 0 23 run 1 2 1 0 1 0 0 91 end",
        ),
        # A message without fields has a byte, or a trigger and none.
        (
            "ros2",
            ({}, "[]"),
            "v.length 32 1 v.item.structure_needs_at_least_one_member 8 1",
            "loop 0 1 0 0 92 scalar 1 1 0 end",
        ),
        ("ros1", ({}, "[]"), "v.length 32 1 v.item.trigger 1 1", "loop 0 1 0 0 96 trigger 1 end"),
        # Elements of 9 bytes; on CDR each but the first begins after 7 bytes of padding.
        (
            "ros2",
            (PADDED, "[]"),
            "v.length 32 1 v.item.x 8 1 v.item.d 64 1",
            "loop 0 16 0 0 6 scalar 1 1 0 scalar 2 8 0 end",
        ),
        (
            "ros2",
            (PADDED, "[4]"),
            "v.item.x 8 1 v.item.d 64 1",
            "loop -1 16 4 0 0 scalar 0 1 0 scalar 1 8 0 end",
        ),
        (
            "ros1",
            (PADDED, "[]"),
            "v.length 32 1 v.item.x 8 1 v.item.d 64 1",
            "loop 0 9 0 0 10 scalar 1 1 0 scalar 2 8 0 end",
        ),
        # Only the first item of an array has padding before it: 3 bytes here, in each element.
        (
            "ros2",
            ({"x": "uint8", "d": "uint32[2]"}, "[]"),
            "v.length 32 1 v.item.x 8 1 v.item.d.items 32 1",
            "loop 0 12 0 0 8 scalar 1 1 0 run -1 2 4 0 0 2 0 0 end",
        ),
        # What has no bytes has no padding before it, either.
        (
            "ros2",
            ({"none": "float64[0]", "x": "uint8"}, "[]"),
            "v.length 32 1 v.item.none.items 64 1 v.item.x 8 1",
            "loop 0 1 0 0 92 run -1 1 8 0 0 0 0 0 scalar 2 1 0 end",
        ),
        (
            "ros1",
            ({"e": "Empty", "x": "uint16"}, "[]"),
            "v.length 32 1 v.item.e.trigger 1 1 v.item.x 16 1",
            "loop 0 2 0 0 48 trigger 1 scalar 2 2 0 end",
        ),
    ],
)
def test_what_the_decoder_knows_of_each_kind_of_field(dialect, kind, leaves, lines):
    if isinstance(kind, tuple):
        fields = {n: make(dialect, {}, "Empty") if k == "Empty" else k for n, k in kind[0].items()}
        kind = (make(dialect, fields, "Inner"), kind[1])
    _, *said = table(make(dialect, {"v": kind}), bus_bytes=4, most=100).text().splitlines()
    assert " ".join(said) == f"{leaves} {lines}"


@pytest.mark.parametrize("bus_bytes", [1, 2, 4, 8, 16, 32, 64])
def test_a_transfer_has_the_items_of_a_bus_word_and_at_least_one(bus_bytes):
    sizes = {"uint8": 1, "bool": 1, "uint16": 2, "float32": 4, "float64": 8}
    fields = {f"x{n}": f"{kind}[]" for n, kind in enumerate(sizes)}
    message = make("ros2", {**fields, "s": "string", "w": "wstring"})
    found = [leaf.lanes for leaf in table(message, bus_bytes).leaves if leaf.has_last]
    # Bytes of an item on the wire; those of text are 1 and 4.
    whole = [bus_bytes / size for size in (*sizes.values(), 1, 4)]
    assert found == [each if each > 1 else 1 for each in whole]


@pytest.mark.parametrize(
    ("most", "claim_bytes"),
    [(100, 256), (4111, 256), (4112, 257), (65_535, 4095), (65_536, 4096), (1 << 20, 4096)],
)
def test_lengths_that_claim_less_than_a_16th_of_a_packet_are_not_counted(most, claim_bytes):
    made = table(make("ros2", {"v": "string[]"}), most=most)
    assert (made.claim_bytes, made.saved_bytes, made.room) == (claim_bytes, 0, most - 8)


@pytest.mark.parametrize(
    ("dialect", "fields", "saved_bytes"),
    [
        ("ros2", PADDED, 14),
        ("ros1", PADDED, 0),
        # There is no padding between these.
        ("ros2", {"d": "float64", "e": "float64"}, 0),
    ],
)
def test_only_where_elements_have_padding_may_some_of_it_be_saved(dialect, fields, saved_bytes):
    for suffix in ("[]", "[<=3]")[: 1 + (dialect == "ros2")]:
        # A field after the sequence does not change it.
        message = make(dialect, {"v": (make(dialect, fields, "Inner"), suffix), "last": "uint8[]"})
        assert table(message).saved_bytes == saved_bytes


def test_a_packet_that_has_no_room_for_the_shortest_message_has_no_length():
    made = table(make("ros2", {"few": "uint8[<=3]", "many": "uint8[]"}), most=9)
    assert (made.least_bytes, made.room) == (12, 0)
    assert [line.split()[-2:] for line in made.lines] == [["3", "0"], ["0", "0"]]


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
