# amaranth: UnusedElaboratable=no
"""Headers with numbers of all their bits, and cuts of messages that are longer than 64 KiB."""

from __future__ import annotations

import struct

import pytest

from firm_hdl.node.gateware.fragmenter import Fragmenter
from firm_hdl.node.gateware.header import HeaderInsert, HeaderStrip
from tests.gateware.packets.bench import PacketBench, beats
from tests.node.traffic import link_output

BUS = 8
TOPIC, TAG, LENGTH = 0xFEDC, 0x89AB_CDEF, 0xA1B2_C3D4
SIDE = TOPIC | TAG << 16 | LENGTH << 48


def header(flags, length, *, sequence=0, fragment=0, topic=TOPIC, tag=TAG):
    """Return a header, written down after docs/reference/frame.md."""
    return struct.pack("<BBHIIHH", 0xF1, flags, topic, length, tag, sequence, fragment)


def test_a_header_has_all_bits_of_its_numbers():
    """The first message says that the sender has started, also if it has no bytes."""
    part = HeaderInsert(BUS)
    bench = PacketBench(part, {"i": part.i}, {"o": (part.frames, BUS, part.topic)})
    packets = [b"", b"abc", b"", b"x" * 20]
    seen = bench.run({"i": list(beats(packets, BUS, [SIDE] * 4))}, {"o": 4})
    assert seen.packets["o"] == [
        header(3 if number == 0 else 1, LENGTH, sequence=number) + packet
        for number, packet in enumerate(packets)
    ]
    assert seen.sides["o"] == [{TOPIC}] * 4


def test_all_bits_of_a_header_are_read():
    part = HeaderStrip(BUS)
    events = {name: (getattr(part, name), getattr(part, name)) for name in ("passes", "malformed")}
    bench = PacketBench(part, {"i": part.frames}, {"o": link_output(part.o, BUS)}, events=events)
    packets = [b"", b"abc", b"x" * 20]
    frames = [header(0xFF, LENGTH, sequence=7) + packet for packet in packets]
    # What is no header, or not that of a whole message.
    wrong = [header(0xFE, 3) + b"abc", header(1, 3, fragment=1) + b"abc", header(0xFE, 0)]
    wrong += [header(1, 0)[:15], header(1, 0, fragment=256), b""]
    mixed = [frame for pair in zip(wrong, [*frames, *frames], strict=True) for frame in pair]
    seen = bench.run({"i": list(beats(mixed, BUS))}, {"o": 6})
    assert seen.packets["o"] == packets * 2 and seen.sides["o"] == [{SIDE}] * 6
    assert len(seen.events["passes"]) == len(seen.events["malformed"]) == 6


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
