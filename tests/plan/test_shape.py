"""Plans without names, and their constructs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl import load_message
from firm_hdl.plan import build_plan, check
from firm_hdl.plan.shape import constructs, shape
from firm_hdl.wire import lay_out
from tests.strategies import make


def plan(name, **options):
    return build_plan(lay_out(load_message(name)), **options)


def test_types_that_differ_in_names_only_have_one_shape():
    assert shape(plan("geometry_msgs/msg/Point")) == shape(plan("geometry_msgs/msg/Vector3"))
    assert shape(plan("geometry_msgs/msg/Twist")) == shape(plan("geometry_msgs/msg/Wrench"))


def test_types_that_differ_in_more_have_another():
    shapes = [
        shape(plan(name))
        for name in ("std_msgs/msg/Int32", "std_msgs/msg/UInt32", "std_msgs/msg/Float32")
    ]
    assert len(set(shapes)) == 3
    assert shape(plan("geometry_msgs/msg/Point", bus_bytes=4)) not in shapes


def test_a_shape_is_a_plan():
    for name in ("sensor_msgs/msg/Imu", "rcl_interfaces/msg/ParameterEvent", "std_msgs/msg/Empty"):
        assert check(shape(plan(name))) == []


def test_constructs_follow_the_plan():
    imu = plan("sensor_msgs/msg/Imu")
    found = constructs(imu)
    assert "begin run, counted by a length, NUL" in found
    assert "leaf items float64" in found
    unaligned = replace(imu, steps=tuple(replace(step, align=1) for step in imu.steps))
    assert found - constructs(unaligned) == {"align 8"}


EMPTY = make("ros1", {}, "Empty")


PAIRS = make("ros2", {"p": (make("ros2", {"x": "int8"}, "X"), "[2]")}, "Pairs")


BYTES = make("ros1", {"r": "uint8[24]"}, "Bytes")


INNER = make("ros2", {"d": "float64[]"}, "Inner")


# The message, its wire and bus width, and what its plan has.
CONSTRUCTS = [
    (
        make("ros1", {"b": "uint64", "e": EMPTY}),
        "ros1",
        2,
        """\
wire ros1
0 loop levels
0 loops may repeat
start goes on
next goes on
next ends the packet
align 1
map of two words
leaf scalar uint64
first part of scalar, 8 bytes each
inner part of scalar, 8 bytes each
last part of scalar, 8 bytes each
leaf trigger bool
whole of trigger, 0 bytes each
""",
    ),
    (
        # One step of a length and two words of a run; then loops in a loop, and another run.
        make("ros2", {"s": "string", "grid": (PAIRS, "[3]"), "m": "uint8[21]"}),
        "cdr",
        8,
        """\
wire cdr
2 loop levels
0 loops may repeat
2 loops may repeat
start goes on
next goes on
next ends the packet
body goes on
repeat goes on
repeat enters 1 loops
next enters 2 loops
next enters a run
align 1
fixed bytes, checked
fixed bytes, ignored
begin run, counted by a length, NUL
words of a run
rest of a run alone
leaf length uint32
whole of length, 4 bytes each
leaf items uint8
run of 1 bytes, counted, NUL
run of 1 bytes, constant count, with tail
whole of items, 1 bytes each, last
leaf scalar signed int8
whole of scalar, 1 bytes each
""",
    ),
    (
        # Items wider than the bus are a loop.
        make("ros2", {"a": "uint8", "i": (INNER, "[]"), "m": "float32[3]", "t": "byte"}),
        "cdr",
        4,
        """\
wire cdr
2 loop levels
0 loops may repeat
1 loops may repeat
2 loops may repeat
start goes on
next goes on
next enters a run
next ends the packet
body goes on
repeat goes on
align 1
align 8
map of two words
padding of 3
fixed bytes, checked
fixed bytes, ignored
begin loop, counted by a length
words of a run
leaf length uint32
whole of length, 4 bytes each
leaf items float64
whole of items, 8 bytes each, last by its loop
leaf items float32
run of 4 bytes, constant count
leaf scalar uint8
leaf scalar byte
whole of scalar, 1 bytes each
""",
    ),
    (
        # A loop whose elements are runs: the jump into it loads both counters.
        make("ros1", {"a": "uint8", "g": (BYTES, "[2]")}),
        "ros1",
        8,
        """\
wire ros1
1 loop levels
0 loops may repeat
1 loops may repeat
start goes on
next goes on
next enters 1 loops
next enters a run
repeat goes on
repeat enters a run
next ends the packet
align 1
words of a run
leaf scalar uint8
whole of scalar, 1 bytes each
leaf items uint8
run of 1 bytes, constant count
""",
    ),
]


@pytest.mark.parametrize(("message", "wire", "bus_bytes", "found"), CONSTRUCTS)
def test_constructs_by_hand(message, wire, bus_bytes, found):
    planned = build_plan(lay_out(message, wire), bus_bytes=bus_bytes)
    assert constructs(planned) == {*found.splitlines()}
