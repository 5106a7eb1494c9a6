"""What a plan tells of itself, beside its steps: runs, counts, jumps and transfers."""

from __future__ import annotations

import pytest

from firm_hdl.plan import Jump, Leaf, build_plan
from firm_hdl.plan.transfers import repeated_leaves, transfers
from firm_hdl.wire import lay_out
from tests.strategies import make

LIST = make("ros2", {"a": "uint8[]"}, "List")
TEXT = make("ros2", {"t": "string"}, "Text")
EMPTY = make("ros2", {}, "Empty")
PAIR = make("ros2", {"x": "uint64", "y": "uint32"}, "Pair")


def plan_of(fields, wire="ros1", bus_bytes=8):
    return build_plan(lay_out(make("ros2", fields), wire), bus_bytes=bus_bytes)


@pytest.mark.parametrize(
    ("fields", "lanes", "has_claims"),
    [
        # Arrays of up to two transfers are no runs.
        ({"a": "uint8[3]"}, 1, False),
        ({"a": "uint8[3]", "q": "uint32[]"}, 2, False),
        ({"q": "uint32[]", "p": "uint16[]"}, 4, False),
        ({"q": "uint32[]", "l": (LIST, "[]")}, 8, True),
    ],
)
def test_runs_and_claims(fields, lanes, has_claims):
    plan = plan_of(fields)
    assert (plan.max_run_lanes, plan.has_claims) == (lanes, has_claims)


@pytest.mark.parametrize(("wire", "nul"), [("ros1", 0), ("cdr", 1)])
def test_counts_on_the_wire_include_the_nul(wire, nul):
    plan = plan_of({"s": "string<=5", "q": "uint16[<=5]"}, wire)
    text, items = (plan.begins[leaf] for leaf in (0, 2))
    assert [plan.has_nul(begin) for begin in (text, items)] == [bool(nul), False]
    assert [plan.max_count(begin) for begin in (text, items)] == [5 + nul, 5]
    assert [plan.word(run) for run in (0, 1)] == [8 + nul, 4]
    assert [plan.item_bytes(run) for run in (0, 1)] == [1, 2]
    assert str(plan.items_leaf(1)) == "q.items"


def test_jumps_are_listed_from_the_start_and_in_the_order_in_which_they_are_tried():
    inner = make("ros2", {"x": "uint8"}, "Inner")
    outer = make("ros2", {"i": (inner, "[2]")}, "Outer")
    plan = plan_of({"o": (outer, "[3]"), "z": "uint8"})
    start = Jump(enter=((0, 3), (1, 2)), step=0)
    again = (Jump(step=0), Jump(enter=((1, 2),), step=0), Jump(step=1))
    assert plan.steps[0].exits.jumps == again
    assert list(plan.jumps()) == [start, *again, Jump(step=None)]


def test_a_leaf_of_a_wrong_plan_has_the_size_of_its_type_whatever_its_sign():
    for signed in (False, True):
        sizes = [
            Leaf(path=("x",), kind="scalar", type=name, signed=signed).item_bytes
            for name in ("bool", "int16", "uint32", "float64")
        ]
        assert sizes == [1, 2, 4, 8]


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
