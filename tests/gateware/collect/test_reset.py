# amaranth: UnusedElaboratable=no
"""A reset of one cycle, at any time: the place and the bytes of the packet before are forgotten."""

from __future__ import annotations

import pytest

from firm_hdl import Serializer
from tests.gateware.test_reset import RIGHT, Bench, after_reset_of_writer, letters
from tests.strategies import make


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", [1, 2])
def test_padding_is_that_of_a_first_packet(bus_bytes):
    """On a narrow bus, padding depends on where in 8 bytes the packet before has ended."""
    message = make("ros2", {"a": "uint8[<=9]", "d": "uint64"})
    good = bytes.fromhex("00010000 02000000 0506 0000 0807060504030201")
    after = {0: [2], 1: letters(b"\5\6", bus_bytes), 2: [0x0102030405060708]}
    # A packet after this one begins 4 bytes later in 8 bytes than the first packet.
    longer = {0: [5], 1: letters(b"12345", bus_bytes), 2: [1]}
    bench = Bench(Serializer(message, bus_bytes=bus_bytes), good)
    for at in (5, 12, 20, 40):
        packets, *rest = after_reset_of_writer(bench, longer, after, at, at, 3)
        assert (packets, *rest) == ([good] * 2, *RIGHT[1:]), at


def test_a_beat_is_sent_only_after_a_byte_of_the_packet_after_the_reset():
    nothing = make("ros1", {}, "Nothing")
    message = make("ros1", {"e": (nothing, "[3]"), "x": "uint8", "f": (nothing, "[3]")})
    good, transfers = b"\1", {0: [1] * 3, 1: [1], 2: [1] * 3}
    bench = Bench(Serializer(message, bus_bytes=1), good)
    # Leaves are missing before the reset: so it comes in the middle of a packet.
    for offers in range(1, 4):
        for at in range(4, 12):
            packets, *rest = after_reset_of_writer(bench, transfers, transfers, at, at, offers)
            assert (packets, *rest) == ([good] * 2, *RIGHT[1:]), (at, offers)
