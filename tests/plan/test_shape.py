"""Plans without names, and their constructs."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl import load_message
from firm_hdl.plan import build_plan, check
from firm_hdl.plan.shape import constructs, shape
from firm_hdl.wire import lay_out


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
