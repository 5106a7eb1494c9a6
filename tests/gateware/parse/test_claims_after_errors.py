# amaranth: UnusedElaboratable=no
"""A length that claims too much, after another error of its packet: the first one is reported."""

from __future__ import annotations

import pytest

from firm_hdl import Parser
from tests.gateware.test_parser import run
from tests.gateware.test_status_table import every_bus
from tests.strategies import make

MOST = 1024
"""Largest packet: 60 elements and 900 items have no room in it, each of them alone has."""

# What comes between a string and the length that claims too much: with the string in one step, or
# in a step of its own; and the size to which it is aligned.
BETWEEN = {"nothing": ({}, 4), "a number": ({"d": "uint64"}, 8)}


def packet(text, end, size, items):
    """Return a packet that ends after a length of items."""
    body = (60).to_bytes(4, "little") + (len(text) + 1).to_bytes(4, "little") + text + end
    body += bytes(-len(body) % size) + bytes(8 if size == 8 else 0)
    return b"\0\1\0\0" + body + items.to_bytes(4, "little")


@pytest.mark.parametrize("between", BETWEEN)
@every_bus
@pytest.mark.sampled(6)
def test_a_missing_nul_is_reported_and_not_the_claim_after_it(bus_bytes, between):
    fields, size = BETWEEN[between]
    element = make("ros2", {"s": "string", **fields, "q": "uint8[]"}, "Element")
    message = make("ros2", {"e": (element, "[]")})
    rows = []
    for text in (b"", b"abc", b"abcdefghi"):
        rows += [
            (packet(text, b"\0", size, 900), "LENGTH"),
            (packet(text, b"x", size, 900), "STRING"),
            (packet(text, b"x", size, 1), "STRING"),
            (packet(text, b"\0", size, 1), "TRUNCATED"),
        ]
    parser = Parser(message, bus_bytes=bus_bytes, max_message_bytes=MOST)
    seen = run(parser, [each for each, _ in rows])
    assert [status.name for status in seen.statuses] == [status for _, status in rows]
