# amaranth: UnusedElaboratable=no
"""Readers of packets, compared with the interpreter at each place where damage can begin.

Random damage, as in `test_converters.py`, seldom meets the last byte before a boundary.
"""

from __future__ import annotations

import pytest

from firm_hdl import Deserializer, Parser
from firm_hdl.plan import decode
from firm_hdl.sim import Harness
from firm_hdl.sim.transfers import join_transfers
from tests.gateware.test_parser import agree, run
from tests.strategies import make

BUS_BYTES = 8
TEXT = make("ros2", {"x": "uint8", "s": "string"}, "Text")
ELEMENTS = make("ros2", {"e": (TEXT, "[]"), "y": "uint8"})
# The string has any length, so that the array does not begin with a beat.
ARRAY = make("ros1", {"s": "string", "p": "uint16", "a": "uint16[4]", "z": "uint8"})
WHOLE = {
    "elements": (
        ELEMENTS,
        "00010000 02000000 01000000 09000000 4142434445464748 00 02 0000 02000000 4100 55",
    ),
    "array": (ARRAY, "02000000 4142 0102 0304 0506 0708 090a 0b"),
}


def compare(message, packets, bus_bytes=BUS_BYTES):
    """Read packets in a deserializer and a parser; return the statuses."""
    rx = Deserializer(message, bus_bytes=bus_bytes)
    seen = Harness(rx, None).run_packets(packets)
    decoded = [decode(rx.plan, packet) for packet in packets]
    statuses = [str(one.status) for one in decoded]
    assert [status.name for status in seen.statuses] == statuses
    carried = {leaf: payloads for leaf, payloads in seen.transfers.items() if payloads}
    assert carried == join_transfers(one.streams for one in decoded)
    agree(rx.plan, packets, run(Parser(message, bus_bytes=bus_bytes), packets))
    return statuses


@pytest.mark.parametrize("name", WHOLE)
def test_a_packet_may_end_anywhere_and_the_next_one_is_read(name):
    message, text = WHOLE[name]
    whole = bytes.fromhex(text)
    parts = [whole[:size] for size in range(1, len(whole))]
    # The longest packet has more beats than the packet buffer.
    longer = [whole + bytes(size) for size in (4, BUS_BYTES, 50 * BUS_BYTES)]
    statuses = compare(message, [each for one in parts + longer for each in (one, whole)])
    assert statuses == ["TRUNCATED", "OK"] * len(parts) + ["TRAILING", "OK"] * len(longer)


def test_a_string_without_nul_keeps_its_other_characters():
    texts = [bytes(range(65, 65 + size)) for size in range(1, 2 * BUS_BYTES + 2)]
    packets = [bytes([0, 1, 0, 0, len(text), 0, 0, 0]) + text + b"\x55" for text in texts]
    message = make("ros2", {"s": "string", "x": "uint8"})
    assert compare(message, packets) == ["STRING"] * len(packets)


def test_the_last_transfer_of_an_array_in_elements_is_marked():
    """On a narrow bus, an array of wide items is a loop inside the loop of elements."""
    row = make("ros1", {"x": "uint8", "m": "float64[3]"}, "Row")
    packets = [bytes([rows, 0, 0, 0]) + bytes(range(25)) * rows for rows in range(4)]
    assert compare(make("ros1", {"r": (row, "[]")}), packets, bus_bytes=4) == ["OK"] * 4
