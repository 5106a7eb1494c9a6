"""Lanes of a bus word in which steps of plans may start, worked out by hand and seen in packets."""

from __future__ import annotations

from itertools import product

import pytest

from firm_hdl.plan import build_plan, decode, encode
from firm_hdl.plan.geometry import (
    Place,
    first_step,
    geometry,
    may_end_empty,
    most_beats,
    only_ends,
)
from firm_hdl.plan.ir import RunStep
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import make

TRIPLE = make("ros2", {"x": "uint32", "y": "uint32", "z": "uint32"}, "Triple")
TEXT = make("ros2", {"x": "uint16", "s": "string"}, "Text")
ANY = tuple(range(8))


def needs(fields, wire, bus_bytes):
    return geometry(build_plan(lay_out(make("ros2", fields), wire), bus_bytes=bus_bytes))


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
    assert (found.item_lanes, found.map_lanes) == (items, maps)


@pytest.mark.parametrize(
    ("fields", "wire", "bus_bytes", "items", "maps"),
    [
        ({"a": "uint64"}, "ros1", 8, 8, 8),
        # 20 bytes: a bus word, then one of 12 bytes.
        ({"a": "uint32", "b": "uint64", "c": "uint64"}, "ros1", 8, 8, 4),
        # Starts are multiples of 4 bytes, and items have 2.
        ({"a": "uint16[]", "b": "uint16"}, "cdr", 4, 2, 2),
        ({"a": "uint64[]"}, "cdr", 8, 4, 8),
        ({"s": "string", "n": "uint32"}, "cdr", 8, 1, 4),
        ({"s": "string", "n": "uint8"}, "cdr", 8, 1, 1),
        ({"p": (TRIPLE, "[]")}, "ros1", 8, 4, 4),
    ],
)
def test_lanes_that_are_only_written_together(fields, wire, bus_bytes, items, maps):
    found = needs(fields, wire, bus_bytes)
    assert (found.item_unit, found.map_unit) == (items, maps)


def test_places_of_a_rest_and_of_the_map_after_it():
    found = needs({"s": "string", "n": "uint32"}, "cdr", 8)
    # The steps: header and length; words of text; rest of the text, padding and `n`.
    assert found.places == (Place((0,), (0,)), Place((0,), (0,)), Place((0,), (0, 4)))


def test_places_in_a_loop_are_those_of_all_turns():
    found = needs({"t": (TEXT, "[]")}, "ros1", 8)
    # The steps: the length; rest of the previous text and `x`; words of text; the last rest.
    start, turn, words, end = found.places
    assert start == Place((0,), (0,))
    # The second step follows the length or a text.
    assert turn == Place(ANY, ANY)
    assert (words, end) == (Place(ANY, ANY), Place(ANY, ANY))


def visited(plan, packet):
    """Return the step of each cycle, and the lane where its own word starts."""
    for visit in decode(plan, packet).steps:
        step = plan.steps[visit.step]
        taken = visit.bytes if isinstance(step, RunStep) else step.bytes
        yield visit.step, (visit.end - taken) % plan.bus_bytes


@pytest.mark.parametrize("bus_bytes", [2, 8, 16])
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@pytest.mark.parametrize("after", ["uint8", "uint64", "uint8[33]"])
def test_packets_start_their_steps_in_these_lanes_and_no_others(after, wire, bus_bytes):
    message = make("ros2", {"s": "string", "a": "uint64[]", "b": "uint16[]", "c": after})
    plan = build_plan(lay_out(message, wire), bus_bytes=bus_bytes)
    places = geometry(plan).places
    found = set()
    for text, large, small in product(range(1, 18), (0, 3), (0, 1, 3, 9)):
        value = {"s": "x" * text, "a": [0] * large, "b": [0] * small}
        value["c"] = [0] * 33 if after.endswith("]") else 0
        packet, status = encode(plan, to_transfers(plan, message, value))
        assert status == "OK"
        found.update(visited(plan, packet))
    want = {(index, lane) for index, place in enumerate(places) for lane in place.map}
    assert found == want


def test_padding_that_is_computed():
    assert needs({"s": "string", "n": "uint32"}, "cdr", 8).aligns
    assert not needs({"s": "string", "n": "uint32"}, "ros1", 8).aligns
    assert needs({"a": "uint64[]"}, "cdr", 4).aligns
    # Only the items of a run.
    assert needs({"a": "uint64[]"}, "cdr", 8).aligns


def test_an_empty_run_ends_before_the_padding_of_items():
    # `b` follows the length at once, or follows items.
    found = needs({"a": "uint64[]", "b": "uint8"}, "cdr", 8)
    assert found.places[-1] == Place((0, 4), (0, 4))


def test_items_start_after_their_padding():
    found = needs({"a": "uint64[]"}, "cdr", 8)
    # The steps: header and length; words of items, after 4 bytes of padding; the rest, if any.
    assert found.places == (Place((0,), (0,)), Place((4,), (4,)), Place((0, 4), (0, 4)))


WIDE = make("ros2", {"x": "uint64", "s": "string"}, "Wide")
EMPTY = make("ros2", {}, "Empty")


@pytest.mark.parametrize(
    ("fields", "wire", "bus_bytes", "first", "ends", "is_empty"),
    [
        ({"a": "uint64"}, "ros1", 8, 0, [], False),
        # The header is a step of its own.
        ({"a": "uint64"}, "cdr", 4, 1, [], False),
        ({"a": "uint64"}, "cdr", 2, 2, [], False),
        # A run is a leaf's.
        ({"a": "uint8[24]"}, "ros1", 8, 0, [], False),
        # The last step takes the rest of the text, and ends the packet.
        ({"s": "string"}, "ros1", 8, 0, [2], False),
        ({"t": (TEXT, "[]")}, "ros1", 8, 0, [3], False),
        # The last step takes the rest, and a byte.
        ({"s": "string", "n": "uint8"}, "ros1", 8, 0, [], False),
        # The last step takes the rest, and may be followed by another turn.
        ({"w": (WIDE, "[]")}, "ros1", 8, 0, [], True),
        # The last step is a trigger.
        ({"e": (EMPTY, "[]")}, "ros1", 8, 0, [], True),
    ],
)
def test_steps_before_the_first_leaf_and_at_the_end(fields, wire, bus_bytes, first, ends, is_empty):
    plan = build_plan(lay_out(make("ros2", fields), wire), bus_bytes=bus_bytes)
    assert first_step(plan) == first
    assert [index for index, step in enumerate(plan.steps) if only_ends(step)] == ends
    assert may_end_empty(plan) == is_empty


@pytest.mark.parametrize(
    ("fields", "wire", "bus_bytes", "beats"),
    [
        # A byte in the last lane, and as many bytes as follow it.
        ({"a": "uint8"}, "ros1", 8, 1),
        ({"a": "uint16"}, "ros1", 8, 2),
        ({"a": "uint64", "b": "uint16"}, "ros1", 8, 3),
        ({"e": (EMPTY, "[2]")}, "ros1", 8, 1),
        ({"e": (EMPTY, "[2]")}, "ros1", 1, 1),
        # A word of a run.
        ({"a": "uint8[24]"}, "ros1", 8, 2),
        # The rest of a text, its NUL on CDR, and a byte.
        ({"s": "string", "b": "uint8"}, "ros1", 8, 2),
        ({"s": "string", "b": "uint8"}, "cdr", 8, 3),
        # Also 7 bytes of padding.
        ({"s": "string", "b": "float64"}, "cdr", 8, 4),
        # A header of 4 bytes, the length, and 7 bytes of padding before the items.
        ({"a": "uint64[]"}, "cdr", 8, 3),
    ],
)
def test_beats_that_a_step_touches(fields, wire, bus_bytes, beats):
    assert most_beats(build_plan(lay_out(make("ros2", fields), wire), bus_bytes=bus_bytes)) == beats
