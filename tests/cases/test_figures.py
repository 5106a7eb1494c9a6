"""Figures of types and plans, and digests that find equal circuits."""

from __future__ import annotations

from firm_hdl.cases.effort import digest, figures
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make


def plan_of(message, wire, bus_bytes=8):
    return build_plan(lay_out(message, wire), bus_bytes=bus_bytes)


def test_figures_are_of_the_type_its_plan_and_all_packets(make_message):
    message = make_message("uint8 a\nB[] list\nB one\n", B="uint32 x\nstring s\n")
    found = figures(message, plan_of(message, "cdr"), [bytes(5), bytes(7), bytes(1)])
    # a, the length of the list, and for its elements and `one`: x, the length and the text of s.
    assert found["streams"] == 1 + 1 + 3 + 3
    assert found["leaves"] == 5
    assert (found["depth"], found["types"], found["loop_levels"]) == (2, 2, 1)
    assert found["case_bytes"] == 13
    assert found["steps"] == len(plan_of(message, "cdr").steps)
    assert found["decisions"] > found["steps"] / 2
    # The header, a, padding, the lengths of the list and of s, x, and a NUL.
    assert found["min_bytes"] == 4 + 1 + 3 + 4 + 4 + 4 + 1
    ros1 = figures(message, plan_of(message, "ros1"), [b""])
    assert (ros1["min_bytes"], ros1["case_bytes"]) == (1 + 4 + 4 + 4, 0)
    assert all(type(name) is str for name in found) and len(found) == 11


def test_equal_circuits_have_equal_digests():
    def of(fields, bus_bytes=8, wire="cdr"):
        return digest(plan_of(make("ros2", fields), wire, bus_bytes))

    one = of({"a": "uint8", "b": "uint16"})
    assert one == of({"x": "uint8", "y": "uint16"}) and len(one) == 16
    others = [
        of({"a": "uint8", "b": "uint16"}, bus_bytes=4),
        of({"a": "uint8", "b": "uint16"}, wire="ros1"),
        of({"a": "uint16", "b": "uint8"}),
        of({"a": "uint8", "b": "uint32"}),
        of({"a": "uint8", "b": "uint16[]"}),
        of({"a": "uint8", "b": "uint16[<=3]"}),
        of({"a": "uint8", "b": "uint16[3]"}),
        of({"a": "uint8"}),
    ]
    assert len({one, *others}) == 9
