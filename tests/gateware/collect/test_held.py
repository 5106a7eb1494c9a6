# amaranth: UnusedElaboratable=no
"""A last length that is taken while `status` waits is still that of its own message."""

from __future__ import annotations

import pytest

from firm_hdl import Serializer
from firm_hdl.sim import Harness, RunOptions, Stalls
from tests.gateware.test_reset import letters
from tests.strategies import make

COUNTS = [0, 0, 5, 0, 1, 0, 19, 0, 0, 2, 0, 8]
# Fields after a number; whether there is a NUL.
LAST = {
    "a rest": ("ros1", {"s": "string"}),
    "a rest and a NUL": ("ros2", {"s": "string"}),
    "wide items": ("ros1", {"s": "uint32[]"}),
    "elements": ("ros1", {"s": (make("ros1", {"b": "uint8"}, "Row"), "[]")}),
    "a rest of an element": (
        "ros1",
        {"e": (make("ros1", {"b": "uint8", "s": "uint8[]"}, "Row"), "[1]")},
    ),
}


def sent(kind, count, number, bus_bytes):
    """Return the transfers of a message after its number, and its bytes."""
    texts = bytes(range(1, count + 1))
    start, head = [count], bytes((number, count, 0, 0, 0))
    match kind:
        case "a rest":
            return [start, letters(texts, bus_bytes)], head + texts
        case "a rest and a NUL":
            head = bytes((0, 1, 0, 0, number, 0, 0, 0, count + 1, 0, 0, 0))
            return [start, letters(texts, bus_bytes)], head + texts + b"\0"
        case "wide items":
            lanes = max(1, bus_bytes // 4)
            words = [texts[at : at + lanes] for at in range(0, count, lanes)]
            items = [
                (tuple(word.ljust(lanes, b"\0")), at == len(words) - 1)
                for at, word in enumerate(words)
            ]
            return [start, items], head + b"".join(bytes((b, 0, 0, 0)) for b in texts)
        case "elements":
            return [start, list(texts)], head + texts
    return [[9], start, letters(texts, bus_bytes)], bytes((number, 9)) + head[1:] + texts


@pytest.mark.parametrize(
    ("kind", "bus_bytes"),
    # Each kind on one bus, the first one on both.
    [
        pytest.param(kind, bus, marks=[] if number == 0 or is_its_own else [pytest.mark.thorough])
        for number, kind in enumerate(LAST)
        for bus in (1, 8)
        for is_its_own in [bus == (8, 1)[number % 2]]
    ],
)
@pytest.mark.sampled(6)
def test_the_last_length_is_that_of_its_message_however_long_status_waits(kind, bus_bytes):
    dialect, fields = LAST[kind]
    tx = Serializer(make(dialect, {"x": "uint8", **fields}), bus_bytes=bus_bytes)
    messages, packets = [], []
    for number, count in enumerate(COUNTS):
        leaves, packet = sent(kind, count, number, bus_bytes)
        messages.append(dict(enumerate([[number], *leaves])))
        packets.append(packet)
    options = RunOptions(stalls={"status": Stalls.bits("0" * 25 + "1")})
    seen = Harness(None, tx).run_messages(messages, options)
    assert seen.packets == packets
    assert [status.name for status in seen.statuses] == ["OK"] * len(COUNTS)
