# amaranth: UnusedElaboratable=no
"""Headers with numbers of all their bits, and cuts of messages that are longer than 64 KiB."""

from __future__ import annotations

import struct

import pytest

from firm_hdl.node.gateware.fragments import Fragmenter
from tests.gateware.packets.bench import PacketBench, beats

BUS = 8
TOPIC, TAG, LENGTH = 0xFEDC, 0x89AB_CDEF, 0xA1B2_C3D4


def header(flags, length, *, sequence=0, fragment=0, topic=TOPIC, tag=TAG):
    """Return a header, written down after docs/reference/frame.md."""
    return struct.pack("<BBHIIHH", 0xF1, flags, topic, length, tag, sequence, fragment)


@pytest.mark.parametrize("length", [65_536, 65_544, 0x0100_0008, 0xFFFF_FFFF])
def test_fragments_of_a_long_message_are_planned_by_all_bits_of_its_length(length):
    part = Fragmenter(BUS, 48)
    bench = PacketBench(part, {"i": part.i}, {"o": (part.frames, BUS, part.size)})
    # Its first bytes are enough.
    packet = header(3, length) + bytes(range(72))
    seen = bench.run({"i": list(beats([packet], BUS))}, {"o": 3})
    assert [frame[:16] for frame in seen.packets["o"]] == [
        header(2, length, fragment=number) for number in range(3)
    ]
    assert [len(frame) for frame in seen.packets["o"]] == [48, 48, 24]
    assert seen.sides["o"] == [{48}] * 3


def test_sizes_of_fragments():
    for size in (32, 48, 65_520):
        assert Fragmenter(BUS, size).room == size - 16
    for size in (0, 16, 24, 40, 65_536, 65_552):
        with pytest.raises(ValueError, match=f"16 and a multiple of 16 bytes, not {size}$"):
            Fragmenter(BUS, size)
