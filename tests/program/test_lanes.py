"""Lanes of a bus word in which steps of plans may start, worked out by hand and seen in packets."""

from __future__ import annotations

from itertools import product

import pytest

from firm_hdl.plan import Run, build_plan, decode, encode
from firm_hdl.program import deserializer_program, start_lanes
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import make

TRIPLE = make("ros2", {"x": "uint32", "y": "uint32", "z": "uint32"}, "Triple")
ANY = tuple(range(8))


def needs(fields, wire, bus_bytes):
    return deserializer_program(
        build_plan(lay_out(make("ros2", fields), wire), bus_bytes=bus_bytes)
    )


@pytest.mark.parametrize(
    ("fields", "wire", "bus_bytes", "items", "maps"),
    [
        # Maps are whole bus words, or two of them.
        ({"a": "uint64"}, "ros1", 8, (0,), (0,)),
        ({"a": "uint32", "b": "uint64", "c": "uint32"}, "ros1", 8, (0,), (0,)),
        ({"a": "uint8[3]", "b": "uint32"}, "ros1", 4, (0,), (0,)),
        # Items start after a length of four bytes, which CDR has after a header of four.
        ({"s": "string"}, "ros1", 4, (0,), (0,)),
        ({"s": "string"}, "ros1", 8, (4,), (0,)),
        ({"s": "string"}, "cdr", 8, (0,), (0,)),
        # Items after four bytes of padding, which an empty sequence does not have.
        ({"a": "uint64[]"}, "cdr", 8, (0, 4), (0,)),
        # A map after text starts at any lane, a map after items at the lanes in which items end.
        ({"s": "string", "n": "uint8"}, "ros1", 8, (4,), ANY),
        ({"s": "string", "n": "uint8"}, "cdr", 8, (0,), ANY),
        ({"s": "string", "n": "uint32"}, "cdr", 8, (0,), (0, 4)),
        ({"a": "uint16[]", "b": "uint16"}, "cdr", 4, (0,), (0, 2)),
        ({"s": "string", "n": "uint8"}, "ros1", 16, (4,), tuple(range(16))),
        # A map of one bus word takes nothing from where items are.
        ({"s": "string", "n": "uint64"}, "ros1", 8, (4,), ANY),
        # The items start at byte 12 of the packet, and end half a bus word later or not.
        ({"a": "uint8", "q": "uint64[]", "b": "uint64"}, "cdr", 16, (12,), (0, 4, 12)),
        # The words of an array are as static as a map.
        ({"a": "uint8[20]"}, "cdr", 8, (0,), (0, 4)),
        ({"a": "uint8[24]"}, "cdr", 8, (0,), (0, 4)),
        # A map of two words takes the first one from where items are.
        ({"p": (TRIPLE, "[]")}, "ros1", 8, (0, 4), (0, 4)),
    ],
)
def test_lanes_where_items_and_maps_start(fields, wire, bus_bytes, items, maps):
    found = needs(fields, wire, bus_bytes)
    assert (found.items.lanes, found.map.lanes) == (items, maps)


def visited(plan, packet):
    """Return the step of each cycle, and the lane where its own word starts."""
    for visit in decode(plan, packet).steps:
        step = plan.steps[visit.step]
        taken = visit.bytes if isinstance(step, Run) else step.bytes
        yield visit.step, (visit.end - taken) % plan.bus_bytes


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", [2, 8, 16])
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@pytest.mark.parametrize("after", ["uint8", "uint64", "uint8[33]"])
def test_packets_start_their_steps_in_these_lanes_and_no_others(after, wire, bus_bytes):
    message = make("ros2", {"s": "string", "a": "uint64[]", "b": "uint16[]", "c": after})
    plan = build_plan(lay_out(message, wire), bus_bytes=bus_bytes)
    starts = start_lanes(plan)
    found = set()
    for text, large, small in product(range(1, 18), (0, 3), (0, 1, 3, 9)):
        value = {"s": "x" * text, "a": [0] * large, "b": [0] * small}
        value["c"] = [0] * 33 if after.endswith("]") else 0
        packet, status = encode(plan, to_transfers(plan, message, value))
        assert status == "OK"
        found.update(visited(plan, packet))
    want = {(index, lane) for index, place in enumerate(starts) for lane in place.map}
    assert found == want
