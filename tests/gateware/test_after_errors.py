# amaranth: UnusedElaboratable=no
"""Converters and errors: the first error counts, what came before stays, the next packet is right.

Random damage, as in `test_converters.py`, seldom meets the last byte before a boundary. So packets
are damaged at each place here.
"""

from __future__ import annotations

from itertools import product

import pytest

from firm_hdl import Deserializer, Parser, Serializer
from firm_hdl.plan import decode, encode
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


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", WHOLE)
def test_a_packet_may_end_anywhere_and_the_next_one_is_read(name):
    message, text = WHOLE[name]
    whole = bytes.fromhex(text)
    parts = [whole[:size] for size in range(1, len(whole))]
    # CDR pads a packet to a multiple of 4 bytes, so that up to 3 bytes more are no error.
    # The longest packet has more beats than the packet buffer.
    padded = whole + bytes(3 if message is ELEMENTS else 0)
    longer = [padded + bytes(size) for size in (1, BUS_BYTES, 50 * BUS_BYTES)]
    packets = [*parts, *longer, padded]
    statuses = compare(message, [each for one in packets for each in (one, whole)])
    errors = ["TRUNCATED"] * len(parts) + ["TRAILING"] * len(longer) + ["OK"]
    assert statuses == [each for error in errors for each in (error, "OK")]


def test_a_string_without_nul_keeps_its_other_characters():
    texts = [bytes(range(65, 65 + size)) for size in range(1, 2 * BUS_BYTES + 2)]
    packets = [bytes([0, 1, 0, 0, len(text), 0, 0, 0]) + text + b"\x55" for text in texts]
    message = make("ros2", {"s": "string", "x": "uint8"})
    assert compare(message, packets) == ["STRING"] * len(packets)


# On a narrow bus, an array of wide items is a loop inside the loop of elements. The last transfer
# of five items has lanes without items, after a transfer with values in all lanes.
@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("kind", "size", "bus_bytes"), [("float64[3]", 24, 4), ("uint16[5]", 10, 8)]
)
def test_the_last_transfer_of_an_array_in_elements(kind, size, bus_bytes):
    message = make("ros1", {"r": (make("ros1", {"x": "uint8", "m": kind}, "Row"), "[]")})
    row = bytes(range(1, size + 2))
    packets = [bytes([rows, 0, 0, 0]) + row * rows for rows in range(4)]
    assert compare(message, packets, bus_bytes) == ["OK"] * 4


@pytest.mark.sampled(3)
@pytest.mark.parametrize("bus_bytes", [1, 2, 4])
def test_padding_is_right_after_a_message_with_an_error(bus_bytes):
    """On narrow buses, padding depends on where in 8 bytes the packet before has ended."""
    message = make("ros2", {"a": "uint8[<=9]", "d": "float64", "b": "uint8[]"})
    tx = Serializer(message, bus_bytes=bus_bytes)
    lanes = next(leaf.lanes for leaf in tx.plan.leaves if leaf.kind == "items")
    leaves = {str(leaf): number for number, leaf in enumerate(tx.plan.leaves)}

    def items(count, is_wrong=False):
        words = [tuple(range(1, lanes + 1))] * -(-count // lanes)
        return [(word, (at == len(words) - 1) ^ is_wrong) for at, word in enumerate(words)]

    messages = [
        {
            leaves["a.length"]: [first],
            leaves["a.items"]: items(first),
            leaves["d"]: [0x0102030405060708],
            leaves["b.length"]: [last],
            # One message in two has an error at its end.
            leaves["b.items"]: items(last, is_wrong=number % 2 == 0),
        }
        for number, (first, last) in enumerate(product((1, 2, 4, 9), (1, 2, 3, 4, 6, 7)))
    ]
    want = [encode(tx.plan, each) for each in messages]
    assert {status for _, status in want} == {"OK", "ITEMS"}
    seen = Harness(None, tx, message=message).run_messages(messages)
    assert seen.packets == [packet for packet, _ in want]
    assert [status.name for status in seen.statuses] == [status for _, status in want]


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_the_first_error_in_wire_order_is_the_status(bus_bytes):
    """The items of one field and the length of the next one may be taken in one step."""
    message = make("ros2", {"s": "uint8[<=9]", "t": "uint8[<=3]", "u": "uint8[<=9]"})
    tx = Serializer(message, bus_bytes=bus_bytes)
    leaves = {str(leaf): number for number, leaf in enumerate(tx.plan.leaves)}

    def field(name, count, is_wrong=False):
        words = -(-count // bus_bytes)
        items = [((1,) * bus_bytes, (at == words - 1) ^ is_wrong) for at in range(words)]
        return {leaves[f"{name}.length"]: [count], leaves[f"{name}.items"]: items}

    flags = list(product((False, True), repeat=3))
    messages = [
        field("s", 2, wrong) | field("t", 4 if is_over else 3) | field("u", 2, last_wrong)
        for wrong, is_over, last_wrong in flags
    ]
    errors = ("ITEMS", "LENGTH", "ITEMS")
    want = [next((e for e, on in zip(errors, each, strict=True) if on), "OK") for each in flags]
    seen = Harness(None, tx, message=message).run_messages(messages)
    assert [status.name for status in seen.statuses] == want
