"""Payloads as bits, and packets as beats."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.gateware.signatures import leaf_shape
from firm_hdl.plan import Leaf
from firm_hdl.sim.payloads import (
    PacketCollector,
    beats_of,
    decoder_of,
    encoder_of,
    packet_beats,
)


@pytest.mark.parametrize(
    ("leaf", "payload", "value"),
    [
        (Leaf(path=("a",), kind="scalar", type="int16", signed=True), -2, -2),
        (Leaf(path=("a",), kind="scalar", type="uint16", signed=False), 65534, 65534),
        (Leaf(path=("a",), kind="scalar", type="byte", signed=True), -128, -128),
        (Leaf(path=("a",), kind="scalar", type="float32", signed=False), 0xFFC00001, 0xFFC00001),
        (Leaf(path=("a",), kind="scalar", type="bool", signed=False), 1, 1),
        (
            Leaf(path=("a",), kind="items", type="int16", signed=True, lanes=2),
            ((-1, 5), True),
            {"data": [-1, 5], "last": 1},
        ),
        (
            Leaf(path=("a",), kind="items", type="bool", signed=False, lanes=4),
            ((1, 0, 0, 1), False),
            {"data": [1, 0, 0, 1], "last": 0},
        ),
        (
            Leaf(path=("a",), kind="items", type="uint8", signed=False, lanes=64),
            (tuple(range(1, 65)), True),
            {"data": [*range(1, 65)], "last": 1},
        ),
    ],
)
def test_bits_are_those_of_the_stream(leaf, payload, value):
    shape = leaf_shape(leaf)
    bits = encoder_of(leaf)(payload)
    if leaf.kind == "items":
        assert bits == shape.const(value).as_bits()
    else:
        assert bits == value & ((1 << shape.width) - 1)
    assert decoder_of(leaf)(bits) == payload
    # The simulator returns a signed signal in this form.
    assert leaf.kind == "items" or decoder_of(leaf)(value) == payload


@given(packets=st.lists(st.binary(max_size=40)), bus_bytes=st.sampled_from([1, 2, 8, 64]))
def test_packets_come_together_from_their_beats(packets, bus_bytes):
    collector = PacketCollector(bus_bytes)
    for packet in packets:
        ends = [collector.take(beat) for beat in packet_beats(packet, bus_bytes)]
        assert ends == [False] * (beats_of(len(packet), bus_bytes) - 1) + [True]
    assert collector.packets == packets
    assert collector.partial == b""
    assert collector.beats == sum(beats_of(len(packet), bus_bytes) for packet in packets)
