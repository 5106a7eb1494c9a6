# amaranth: UnusedElaboratable=no
"""Lengths of one message that mean nearly the same: each is decoded in its own way."""

from __future__ import annotations

import pytest

from firm_hdl import Parser
from tests.gateware.test_parser import run
from tests.strategies import make

# Types of the fields of messages in which two lengths differ only in what the name says.
TWINS = {
    "padding before items": (
        "float64[] uint32 uint64 uint32 float64[] uint32",
        "uint32 float64[] uint32 float64[] uint32",
    ),
    "padding after items": (
        "uint8[] uint8 uint8 uint8 uint8 uint8 uint8[] uint32 uint8",
        "uint8[] uint32 uint8 uint8[] uint8 uint8 uint8 uint8 uint8",
    ),
    "bytes of the next step": (
        "uint8[] uint8 uint8[] uint8 uint8",
        "uint8[] uint8 uint8 uint8[] uint8",
    ),
    "bytes of an item": ("uint8[] uint32 uint32[] uint32", "uint32[] uint32 uint8[] uint32"),
    "a NUL": ("string uint32 uint8[] uint32", "uint8[] uint32 string uint32"),
    "the limit": ("uint8[<=20] uint32 uint8[<=30] uint32", "uint8[<=30] uint32 uint8[<=20] uint32"),
}
BYTES = {"uint8": 1, "uint32": 4, "uint64": 8, "float64": 8, "string": 1}
MOST = 4
"""Largest number of items; for a sequence with a limit, this limit."""


def packet_of(types, counts):
    """Return a packet of which each byte of a value tells its place."""
    body = b""

    def put(size):
        nonlocal body
        body += bytes(-len(body) % size)
        body += bytes((len(body) + k) % 251 + 1 for k in range(size))

    for type_ in types:
        item, _, bound = type_.partition("[")
        if not bound and item != "string":
            put(BYTES[item])
            continue
        count, limit = counts.pop(), bound.strip("<=]")
        if limit and count == MOST:
            count = int(limit)
        body += bytes(-len(body) % 4)
        body += (count + (item == "string")).to_bytes(4, "little")
        for _ in range(count):
            put(BYTES[item])
        body += b"\0" * (item == "string")
    return b"\0\1\0\0" + body


@pytest.mark.sampled(6)
@pytest.mark.parametrize("kind", TWINS)
def test_a_length_is_decoded_for_its_own_sequence(kind):
    for text in TWINS[kind]:
        types = text.split()
        fields = {f"f{number}": type_ for number, type_ in enumerate(types)}
        counts = [(0, 1), (1, 0), (2, 3), (3, 2), (4, 4), (0, 0), (1, 4)]
        packets = [packet_of(types, list(each)) for each in counts]
        # Without its last byte, a packet is cut: so the parser does not end too early, either.
        packets += [packet[:-1] for packet in packets]
        seen = run(Parser(make("ros2", fields), bus_bytes=8), packets)
        names = [status.name for status in seen.statuses]
        assert names == ["OK"] * len(counts) + ["TRUNCATED"] * len(counts)
