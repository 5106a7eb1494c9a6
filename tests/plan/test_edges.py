"""The decisions of a plan, and the decisions that packets take."""

from __future__ import annotations

import struct

import pytest

from firm_hdl import load_message
from firm_hdl.plan import Edge, build_plan, decode
from firm_hdl.plan.edges import edges
from firm_hdl.wire import lay_out

HEADER = b"\0\1\0\0"


def plan(name, **options):
    return build_plan(lay_out(load_message(name)), **options)


def string(text):
    return struct.pack("<I", len(text) + 1) + text + b"\0"


def test_fixed_type_has_no_decision():
    twist = plan("geometry_msgs/msg/Twist")
    assert edges(twist) == {Edge(index, "next") for index in range(6)}


def test_decisions_of_a_string():
    string_plan = plan("std_msgs/msg/String")
    start, words, rest = 0, 1, 2
    assert edges(string_plan) == {
        *(Edge(start, way) for way in ("body", "next")),
        *(Edge(words, way) for way in ("again", "next")),
        *(Edge(rest, way) for way in ("rest", "no rest", "next")),
    }
    end = {Edge(rest, "rest"), Edge(rest, "next")}
    taken = {
        size: decode(string_plan, HEADER + string(bytes(size))).edges
        for size in (0, 1, 8, 9, 16, 17)
    }
    # The rest has up to a bus word and the NUL.
    assert taken[0] == taken[1] == taken[8] == {Edge(start, "next"), *end}
    assert taken[9] == taken[16] == {Edge(start, "body"), Edge(words, "next"), *end}
    assert taken[17] == {*taken[16], Edge(words, "again")}
    # A length of 0 on the wire: the NUL is missing, too.
    bare = decode(string_plan, HEADER + bytes(4))
    assert bare.status == "OK"
    assert bare.edges == {Edge(start, "next"), Edge(rest, "no rest"), Edge(rest, "next")}


def test_the_first_step_of_a_loop_has_a_rest_from_the_second_turn_on():
    strings = plan("rcl_interfaces/msg/ListParametersResult")
    found = edges(strings)
    first = strings.items[0].steps
    assert {Edge(first, way) for way in ("rest", "no rest", "loop 0 again")} <= found
    none = HEADER + bytes(8)
    one = HEADER + struct.pack("<I", 1) + string(b"abc") + bytes(4)
    two = HEADER + struct.pack("<I", 2) + string(b"abc") * 2 + bytes(4)
    ways = [
        {edge.way for edge in decode(strings, packet).edges if edge.step == first}
        for packet in (none, one, two)
    ]
    assert [decode(strings, packet).status for packet in (none, one, two)] == ["OK"] * 3
    assert ways[0] == set()
    assert ways[1] == {"no rest", "padding 0", "next"}
    assert ways[2] == {*ways[1], "rest", "loop 0 again"}


def test_paddings_are_the_possible_ones():
    # After a string, any padding may occur; after the length of `points`, which is aligned to 4,
    # it may not.
    poses = plan("geometry_msgs/msg/PoseArray")
    found = edges(poses)
    paddings = sorted(edge for edge in found if edge.way.startswith("padding"))
    ways = {4: [f"padding {n}" for n in range(4)], 8: ["padding 0", "padding 4"]}
    assert sorted({step.align for step in poses.steps}) == [1, 4, 8]
    for index, step in enumerate(poses.steps):
        assert [e.way for e in paddings if e.step == index] == ways.get(step.align, [])


@pytest.mark.parametrize(("count", "again"), [(1, False), (2, True)])
def test_a_loop_that_cannot_turn_again_has_no_such_decision(tmp_path, count, again):
    folder = tmp_path / "demo" / "msg"
    folder.mkdir(parents=True)
    (folder / "Outer.msg").write_text(f"Inner[<={count}] inner\n")
    (folder / "Inner.msg").write_text("string text\n")
    message = load_message("demo/msg/Outer", paths=[tmp_path])
    found = edges(build_plan(lay_out(message)))
    assert any(edge.way == "loop 0 again" for edge in found) == again
