"""Cycles of packets, counted by hand: limited by beats, by steps, or by a full ring."""

from __future__ import annotations

import pytest

from firm_hdl.plan import build_plan
from firm_hdl.timing.cycles import (
    cycles_between,
    deserializer_cycles,
    packet_of,
    serializer_cycles,
)
from firm_hdl.timing.rings import may_end_empty
from firm_hdl.wire import lay_out
from tests.strategies import make

TEXT = make("ros1", {"s": "string"}, "Text")
WIDE = make("ros1", {"x": "uint64", "y": "uint32"}, "Wide")
EMPTY = make("ros1", {}, "Empty")


def packet_for(fields, data, bus_bytes=8, dialect="ros1"):
    plan = build_plan(lay_out(make(dialect, fields)), bus_bytes=bus_bytes)
    return packet_of(plan, data)


def both_cycles(packets):
    return deserializer_cycles(packets), serializer_cycles(packets)


def texts(*values):
    """Return the bytes of a sequence of strings in ROS 1."""
    parts = [len(value).to_bytes(4, "little") + value for value in values]
    return len(values).to_bytes(4, "little") + b"".join(parts)


def test_a_beat_per_cycle():
    packet = packet_for({"a": "uint64", "b": "uint64", "c": "uint64[2]"}, bytes(32))
    # The two items of the array are a step each, as a leaf has one transfer per cycle.
    assert [visit.bytes for visit in packet.visits] == [8, 16, 8]
    assert both_cycles([packet] * 3) == ([3, 7, 11],) * 2
    assert cycles_between(packet) == 4


def test_a_step_of_two_beats_is_done_with_the_second_one():
    packet = packet_for({"a": "uint32", "b": "uint64"}, bytes(12))
    assert (packet.beats, len(packet.visits)) == (2, 1)
    # The serializer takes the leaves at once, and sends both beats.
    assert both_cycles([packet] * 3) == ([1, 3, 5],) * 2


def test_a_step_per_cycle():
    # Three lengths in two beats are four steps; the last one only takes the rest, if any.
    packet = packet_for({"a": "string", "b": "string", "c": "string"}, bytes(12))
    assert (packet.beats, len(packet.visits)) == (2, 4)
    # The third length ends in the second beat. The serializer decodes the first length in a cycle
    # of its own, and leaves out the last step.
    assert deserializer_cycles([packet] * 3) == [3, 7, 11]
    assert serializer_cycles([packet] * 3) == [3, 6, 9]
    assert cycles_between(packet) == 4


def test_the_same_length_again_costs_the_serializer_a_cycle():
    packet = packet_for({"t": (TEXT, "[]")}, texts(b"", b"", b"", b""))
    assert len(packet.visits) == 6
    assert deserializer_cycles([packet]) == [5]
    # The number of texts, then a text in two cycles; the step after them is left out.
    assert serializer_cycles([packet]) == [1 + 1 + 2 * 3]


def test_a_length_of_zero_that_ends_the_packet_costs_the_deserializer_a_cycle():
    packet = packet_for({"a": "uint8", "w": (WIDE, "[]")}, b"\7\0\0\0\0")
    assert (packet.beats, len(packet.visits)) == (1, 1)
    assert deserializer_cycles([packet] * 3) == [1, 3, 5]
    # For the serializer, the length of the next packet is the same length again.
    assert serializer_cycles([packet] * 3) == [1, 3, 5]


@pytest.mark.parametrize(
    ("count", "reads", "writes"),
    [
        # Two texts are one beat, two elements are three beats: as many beats as steps.
        (8, 18, 16 + 12 + 1),
        # The bus waits during the texts; the elements wait for the bus.
        (100, 100 + 150 - 2, 200 + 150 + 1),
    ],
)
def test_ring_fills_where_steps_or_beats_are_slower_for_long(count, reads, writes):
    data = texts(*[b""] * count) + count.to_bytes(4, "little") + bytes(12 * count)
    packet = packet_for({"t": (TEXT, "[]"), "w": (WIDE, "[]")}, data)
    assert (packet.beats, len(packet.visits)) == (2 * count + 1, 2 * count + 2)
    assert both_cycles([packet]) == ([reads], [writes])
    assert cycles_between(packet) == writes - 1


def test_a_full_beat_waits_where_it_may_be_the_last_one():
    # A trigger is a step without bytes.
    packet = packet_for({"a": "uint32", "e": (EMPTY, "[]")}, b"\7\0\0\0\3\0\0\0")
    assert may_end_empty(packet.plan)
    assert [visit.bytes for visit in packet.visits] == [8, 0, 0, 0]
    assert both_cycles([packet]) == ([3], [1 + 3])


@pytest.mark.parametrize(
    ("kind", "bus_bytes", "beats", "steps"),
    [("uint8", 1, 5, 4), ("uint16", 2, 3, 2), ("uint32", 2, 4, 3)],
)
def test_beats_of_the_header_wait_for_the_first_leaf(kind, bus_bytes, beats, steps):
    """Their steps are done before the leaf is offered, so the beats follow each other."""
    size = bus_bytes * beats - 4
    packet = packet_for({"a": kind}, b"\0\1\0\0" + bytes(size), bus_bytes, "ros2")
    # The last step takes two beats.
    assert (packet.beats, len(packet.visits)) == (beats, steps)
    assert both_cycles([packet] * 2) == ([beats - 1, 2 * beats - 1],) * 2


@pytest.mark.parametrize(("count", "held"), [(4095, 0), (4096, 3)])
def test_a_length_whose_claim_is_checked_costs_the_deserializer_three_cycles(count, held):
    row = make("ros1", {"a": "uint8[]"}, "Row")
    data = b"\1\0\0\0" + count.to_bytes(4, "little") + bytes(count)
    packet = packet_for({"rows": (row, "[]")}, data)
    # Two lengths, and the words of the row.
    steps = 2 + 512
    assert (packet.beats, len(packet.visits)) == (1 + 512, steps)
    assert deserializer_cycles([packet] * 2) == [steps - 1 + held, 2 * (steps + held) - 1]
    assert cycles_between(packet) == steps + held
