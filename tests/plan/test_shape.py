"""Plans without names, and their constructs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl import load_message
from firm_hdl.plan import build_plan, check
from firm_hdl.plan.shape import constructs, shape
from firm_hdl.plan.tree import Step
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
    assert "run of 1 bytes, counted, aligned to 1, NUL" in found
    assert "leaf items float64" in found
    items = (replace(i, align=1) if isinstance(i, Step) else i for i in imu.items)
    assert found - constructs(replace(imu, items=tuple(items))) == {"align 8"}


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
start of packet then step
step then step
step then end of packet
align 1
map of two words
leaf scalar uint64
first part of scalar, 8 bytes each
part of scalar, 8 bytes each
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
start of packet then step
step then run, counted
run, counted then step
step then loop, constant count
start of loop, constant count then loop, constant count
start of loop, constant count then step
step then end of loop, constant count
loop, constant count then end of loop, constant count
loop, constant count then run, constant count
run, constant count then step
step then end of packet
align 1
fixed bytes, checked
fixed bytes, ignored
rest of a run alone
leaf length uint32
whole of length, 4 bytes each
leaf items uint8
run of 1 bytes, counted, aligned to 1, NUL
run of 1 bytes, constant count, aligned to 1, with tail
whole of items, 1 bytes each, last always
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
start of packet then step
step then step
step then loop, counted
start of loop, counted then step
step then end of loop, counted
loop, counted then end of loop, counted
loop, counted then run, constant count
run, constant count then step
step then end of packet
align 1
align 8
map of two words
padding of 3
fixed bytes, checked
fixed bytes, ignored
leaf length uint32
whole of length, 4 bytes each
leaf items float64
whole of items, 8 bytes each, last in loop
leaf items float32
run of 4 bytes, constant count, aligned to 1
leaf scalar uint8
leaf scalar byte
whole of scalar, 1 bytes each
""",
    ),
    (
        # A loop whose elements are runs.
        make("ros1", {"a": "uint8", "g": (BYTES, "[2]")}),
        "ros1",
        8,
        """\
wire ros1
1 loop levels
start of packet then step
step then loop, constant count
start of loop, constant count then run, constant count
run, constant count then end of loop, constant count
loop, constant count then end of packet
align 1
leaf scalar uint8
whole of scalar, 1 bytes each
leaf items uint8
run of 1 bytes, constant count, aligned to 1
""",
    ),
]


@pytest.mark.parametrize(("message", "wire", "bus_bytes", "found"), CONSTRUCTS)
def test_constructs_by_hand(message, wire, bus_bytes, found):
    planned = build_plan(lay_out(message, wire), bus_bytes=bus_bytes)
    assert constructs(planned) == {*found.splitlines()}
