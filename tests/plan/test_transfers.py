"""The transfers of each step, and the leaves that may transfer in two cycles in a row, by hand."""

from __future__ import annotations

import pytest

from firm_hdl.plan import build_plan
from firm_hdl.plan.transfers import repeated_leaves, transfers
from firm_hdl.wire import lay_out
from tests.strategies import make

TEXT = make("ros2", {"t": "string"}, "Text")
EMPTY = make("ros2", {}, "Empty")
PAIR = make("ros2", {"x": "uint64", "y": "uint32"}, "Pair")


def plan_of(fields, wire, bus_bytes):
    return build_plan(lay_out(make("ros2", fields), wire), bus_bytes=bus_bytes)


@pytest.mark.parametrize(
    ("fields", "wire", "bus_bytes", "repeated"),
    [
        # A packet of one step is followed by the next packet.
        ({"a": "uint32"}, "ros1", 8, "a"),
        ({"a": "uint64", "b": "uint64"}, "ros1", 8, "a b"),
        # Other steps come in between, even if they are only the header's.
        ({"a": "uint64", "b": "uint64", "c": "uint64"}, "ros1", 8, ""),
        ({"a": "uint16"}, "cdr", 8, "a"),
        ({"a": "uint16"}, "cdr", 2, ""),
        # Both transfers of an array, and the words of a longer one.
        ({"a": "uint64[2]", "b": "uint8"}, "ros1", 8, "a.items"),
        ({"a": "uint8[24]", "b": "uint64"}, "ros1", 8, "a.items"),
        # The words of a text and its rest; its length comes once in a packet.
        ({"s": "string"}, "ros1", 8, "s.items"),
        # An item of two bus words is one step, and a wider one takes several.
        ({"a": "uint64[]", "b": "uint64"}, "ros1", 4, "a.items"),
        ({"a": "uint64[]", "b": "uint64"}, "ros1", 2, ""),
        # A short text is done in the step of the next one's length.
        ({"e": (TEXT, "[]"), "z": "uint64"}, "ros1", 8, "e.item.t.length e.item.t.items"),
        ({"e": (TEXT, "[2]"), "z": "uint64"}, "ros1", 8, "e.item.t.length e.item.t.items"),
        # A number of elements that is 0 ends the packet, and the next one starts with it.
        ({"e": (EMPTY, "[]")}, "ros1", 8, "e.length e.item.trigger"),
        ({"e": (PAIR, "[]")}, "ros1", 16, "e.length e.item.x e.item.y"),
        ({"a": "uint64", "e": (PAIR, "[]")}, "ros1", 4, ""),
    ],
)
def test_leaves_that_may_transfer_in_two_steps_in_a_row(fields, wire, bus_bytes, repeated):
    plan = plan_of(fields, wire, bus_bytes)
    found = {str(plan.leaves[leaf]) for leaf in repeated_leaves(plan)}
    assert found == set(repeated.split())


def test_a_step_completes_its_transfers_in_the_order_of_the_wire():
    plan = plan_of({"s": "string", "a": "uint16", "b": "uint64", "c": "uint8[24]"}, "ros1", 8)
    found = [
        [(str(plan.leaves[leaf]), part and part.at) for leaf, part in transfers(plan, step)]
        for step in plan.steps
    ]
    assert found == [
        [("s.length", 0)],
        [("s.items", None)],
        # The rest of the text, and the number that follows it.
        [("s.items", None), ("a", 0)],
        [("b", 0)],
        [("c.items", None)],
    ]
