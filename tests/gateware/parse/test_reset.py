# amaranth: UnusedElaboratable=no
"""A reset of one cycle, at any time: no place, budget or error of the packet before is left."""

from __future__ import annotations

import struct

import pytest
from amaranth.hdl import Const

from firm_hdl import Deserializer, Parser, Status
from firm_hdl.sim.payloads import all_beats
from tests.gateware.packets import test_reset as parts
from tests.gateware.test_reset import Bench, after_reset_of_reader, letters
from tests.strategies import make

# On a narrow bus, padding depends on where in 8 bytes the packet before has ended.
PADDED = make("ros2", {"a": "uint8[<=9]", "d": "uint64"}, "Padded")


# One or two bytes are the rest of the run, behind the length; three bytes begin with a word.
@pytest.mark.parametrize(("bus_bytes", "items"), [(1, b"\5"), (2, b"\5\6"), (2, b"\5\6\7")])
@pytest.mark.sampled(4)
def test_padding_is_that_of_a_first_packet(bus_bytes, items):
    number = bytes((8, 7, 6, 5, 4, 3, 2, 1))
    good = bytes((0, 1, 0, 0, len(items), 0, 0, 0)) + items.ljust(4, b"\0") + number
    # A packet after this one begins 4 bytes later in 8 bytes than the first packet.
    longer = bytes.fromhex("00010000 05000000 0102030405 000000 00000000 ffffffffffffffff")
    count, carried = [len(items)] * 2, letters(items, bus_bytes) * 2
    right = {0: count, 1: carried, 2: [0x0102030405060708] * 2}
    bench = Bench(Deserializer(PADDED, bus_bytes=bus_bytes), good)
    beats = len(longer) // bus_bytes
    for at in (beats - 3, beats + 1, beats + 4, beats + 9, 2 * beats + 6):
        found = after_reset_of_reader(bench, longer, at, -1)
        assert found == (right, [Status.OK] * 2), at


# The lengths of this packet claim too much together: they are refused when both have been read.
NESTED = make("ros1", {"e": (make("ros1", {"s": "uint8[]"}, "Element"), "[]"), "z": "uint8"})
REFUSED = struct.pack("<2I", 80, 800) + bytes(40)
GOOD = struct.pack("<2I", 1, 2) + b"ab\7"
MOST = 1024


def test_a_length_that_is_checked_during_the_reset_is_forgotten():
    bench = Bench(Deserializer(NESTED, bus_bytes=4, max_message_bytes=MOST), GOOD)
    right = {0: [1] * 2, 1: [2] * 2, 2: letters(b"ab", 4) * 2, 3: [7] * 2}
    for at in range(3, 16):
        found = after_reset_of_reader(bench, REFUSED, at, -1)
        assert found == (right, [Status.OK] * 2), at


def test_a_parser_forgets_a_length_that_is_checked_during_the_reset():
    parser = Parser(NESTED, bus_bytes=4, max_message_bytes=MOST)
    given = [(parser.packets, list(all_beats([GOOD, REFUSED], 4)))]
    bench = parts.Bench(parser, given, [(parser.status, parser.sizes)], Const(0, 1))
    at_first = bench.run(0, 0)
    assert [status for *_, status, _ in at_first[0]] == [Status.OK, Status.LENGTH]
    for at in range(8, 13):
        assert bench.run(at, at + 1) == at_first, at
