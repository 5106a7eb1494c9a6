"""The decisions of a plan, and that packets are seen to take them."""

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


def test_a_fixed_type_leaves_nothing_to_the_packet_but_the_way_through():
    twist = plan("geometry_msgs/msg/Twist")
    assert edges(twist) == {Edge(index, "next") for index in range(7)}


def test_a_string_may_be_empty_long_and_bare():
    string_plan = plan("std_msgs/msg/String")
    all_of_them = {Edge(0, "body"), Edge(0, "next"), Edge(1, "again"), Edge(1, "next")}
    assert edges(string_plan) == all_of_them
    took = [
        decode(string_plan, HEADER + string(text)).edges for text in (b"", b"seven..", b"eight...")
    ]
    assert took[0] == took[1] == {Edge(0, "body"), Edge(1, "next")}
    assert took[2] == {Edge(0, "body"), Edge(1, "next"), Edge(1, "again")}
    # A length of 0 on the wire: no NUL either.
    bare = decode(string_plan, HEADER + bytes(4))
    assert bare.status == "OK"
    assert bare.edges == {Edge(0, "next")}


def test_paddings_are_those_that_can_be():
    # Behind a string anything goes; behind the length of `points`, which is aligned to 4, it does
    # not.
    found = edges(plan("geometry_msgs/msg/PoseArray"))
    paddings = sorted(edge for edge in found if edge.way.startswith("padding"))
    assert [edge.way for edge in paddings if edge.step == 3] == [f"padding {n}" for n in range(4)]
    assert [edge.way for edge in paddings if edge.step == 4] == ["padding 0", "padding 4"]


@pytest.mark.parametrize(("count", "again"), [(1, False), (2, True)])
def test_a_loop_that_cannot_turn_again_has_no_such_decision(tmp_path, count, again):
    folder = tmp_path / "demo" / "msg"
    folder.mkdir(parents=True)
    (folder / "Outer.msg").write_text(f"Inner[<={count}] inner\n")
    (folder / "Inner.msg").write_text("string text\n")
    message = load_message("demo/msg/Outer", paths=[tmp_path])
    found = edges(build_plan(lay_out(message)))
    assert any(edge.way == "loop 0 again" for edge in found) == again


def test_what_limits_forbid_is_no_decision():
    name = "std_msgs/msg/String"
    assert Edge(1, "again") in edges(plan(name))
    # 8 bytes of header and length leave 8 for text and NUL: one bus word.
    assert Edge(1, "again") not in edges(plan(name, max_message_bytes=16))


@pytest.mark.parametrize(("bound", "ways"), [("<=1", {0}), ("<=2", {0, 3}), ("", {0, 3})])
def test_paddings_count_on_bounds(tmp_path, bound, ways):
    # Three bytes of padding stand in front of the second element alone.
    folder = tmp_path / "demo" / "msg"
    folder.mkdir(parents=True)
    (folder / "Outer.msg").write_text(f"Inner[{bound}] inner\n")
    (folder / "Inner.msg").write_text("int32 number\nbool flag\n")
    built = build_plan(lay_out(load_message("demo/msg/Outer", paths=[tmp_path])))
    found = {edge.way for edge in edges(built) if edge.way.startswith("padding")}
    assert found == {f"padding {count}" for count in ways}


@pytest.mark.parametrize("bound", [1, 3])
def test_paddings_count_on_bounds_of_runs(tmp_path, bound):
    folder = tmp_path / "demo" / "msg"
    folder.mkdir(parents=True)
    (folder / "Outer.msg").write_text(f"uint8[<={bound}] items\nstring text\n")
    built = build_plan(lay_out(load_message("demo/msg/Outer", paths=[tmp_path])), bus_bytes=1)
    found = {edge.way for edge in edges(built) if edge.way.startswith("padding")}
    assert found == {f"padding {-count % 4}" for count in range(bound + 1)}
