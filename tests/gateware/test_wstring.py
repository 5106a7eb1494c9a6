# amaranth: UnusedElaboratable=no
"""Wide strings through the circuits: the bytes of ROS 2's own type support, bounds, and arrays.

rosbags has no `wstring`, so the bytes are those that ROS 2 (humble, Fast CDR 1.0.26) wrote, and
what follows from them: a count of UTF-16 units, four bytes for each, no NUL.
"""

from __future__ import annotations

import pytest

from firm_hdl import Status
from firm_hdl.plan import build_plan, decode
from firm_hdl.sim import Stalls, encode, loopback
from firm_hdl.sim.values import from_transfers
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.strategies import make

WIDTHS = by_depth((1, 16), (1, 2, 4, 8, 16, 64))
TEXT = make("ros2", {"w": "wstring"})
BETWEEN = make("ros2", {"x": "uint8", "w": "wstring", "y": "uint8"})
BOUNDED = make("ros2", {"w": "wstring<=3", "y": "uint8"})
MANY = make("ros2", {"a": "wstring<=2[2]", "q": "wstring[<=2]", "d": "float64"})

# Message, value, bytes. The first four are reference bytes of ROS 2.
CASES = {
    "text": (TEXT, {"w": "aé"}, "02000000 61000000 e9000000"),
    "empty": (TEXT, {"w": ""}, "00000000"),
    "astral": (TEXT, {"w": "\U0001f600"}, "02000000 3dd80000 00de0000"),
    "between octets": (
        BETWEEN, {"x": 1, "w": "a", "y": 2}, "01000000 01000000 61000000 02",
    ),
    "at its bound": (BOUNDED, {"w": "abc", "y": 9}, "03000000 61000000 62000000 63000000 09"),
    "in arrays": (
        MANY,
        {"a": ["", "ab"], "q": ["c"], "d": 1.0},
        "00000000 02000000 61000000 62000000 01000000 01000000 63000000 00000000 000000000000f03f",
    ),
    "in an empty sequence": (
        MANY,
        {"a": ["", ""], "q": [], "d": 1.0},
        "00000000 00000000 00000000 00000000 000000000000f03f",
    ),
}  # fmt: skip


def packet(text: str) -> bytes:
    return bytes.fromhex("00010000" + text)


@pytest.mark.parametrize(
    ("message", "bus_bytes"),
    by_depth(
        [(TEXT, 16), (BETWEEN, 8), (BOUNDED, 4), (MANY, 1)],
        [(message, bus) for message in (TEXT, BETWEEN, BOUNDED, MANY) for bus in WIDTHS],
    ),
    ids=str,
)
@pytest.mark.sampled(4)
def test_circuits_write_and_read_the_bytes_of_ros_2(message, bus_bytes):
    # All cases of a message in one run: building the circuits takes most of the time.
    cases = [case[1:] for case in CASES.values() if case[0] is message]
    values = [value for value, _ in cases]
    want = [packet(text) for _, text in cases]
    assert encode(message, values, bus_bytes=bus_bytes).packets == want
    stalls = Stalls(probability=0.5, seed=bus_bytes)
    back = loopback(message, want * 2, bus_bytes=bus_bytes, stalls=stalls)
    assert (back.packets, back.statuses) == (want * 2, [Status.OK] * 2 * len(want))
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    for value, each in zip(values, want, strict=True):
        assert from_transfers(plan, message, decode(plan, each).streams) == value


@pytest.mark.parametrize("bus_bytes", WIDTHS)
@pytest.mark.sampled(2)
def test_a_wide_string_over_its_bound_is_empty_and_ends_it(bus_bytes):
    good = packet(CASES["at its bound"][2])
    long = packet("04000000" + "61000000" * 4 + "09")
    back = loopback(BOUNDED, [good, long, good], bus_bytes=bus_bytes)
    assert back.statuses == [Status.OK, Status.LENGTH, Status.OK]
    assert back.packets == [good, packet("00000000 00"), good]


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", WIDTHS)
def test_a_wide_string_over_its_bound_is_sent_as_promised_and_marked(bus_bytes):
    lanes = max(1, bus_bytes // 4)
    units = [0x61, 0x62, 0x63, 0x64, *[0] * (-4 % lanes)]
    words = [tuple(units[i : i + lanes]) for i in range(0, len(units), lanes)]
    items = [(word, n == len(words) - 1) for n, word in enumerate(words)]
    sent = encode(BOUNDED, [{0: [4], 1: items, 2: [9]}], bus_bytes=bus_bytes)
    assert (sent.statuses, sent.packet_errors) == ([Status.LENGTH], [True])
    assert sent.packets == [packet("04000000 61000000 62000000 63000000 64000000 09")]
