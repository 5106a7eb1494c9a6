# amaranth: UnusedElaboratable=no
"""Frames become messages again: the rules of docs/reference/frame.md, by frames written by hand."""

from __future__ import annotations

import struct

import pytest

from firm_hdl.node.gateware.fragments import Reassembler
from firm_hdl.sim import Stalls
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.node.traffic import counters_of

BUS = 8
DAMAGED = "damaged"


@pytest.fixture(scope="module")
def bench():
    part = Reassembler(BUS)
    names = part.counters.shape().members
    return PacketBench(
        part,
        {"i": with_side(part.i, part.bad)},
        {"o": (part.o, BUS, part.abort & part.o.payload.last)},
        final={"lost": part.lost, **{name: part.counters[name] for name in names}},
    )


def frame(
    sequence, payload=b"", *, fragment=0, last=True, start=False, length=None, topic=1, version=0xF1
):
    size = len(payload) if length is None else length
    flags = last | start << 1
    header = struct.pack("<BBHIIHH", version, flags, topic, size, 0, sequence % 65536, fragment)
    return header + payload


def whole(bench, frames, **options):
    """Return the numbers of the messages that are whole, and the counters."""
    pairs = [each if isinstance(each, tuple) else (each, "") for each in frames]
    packets = [packet for packet, _ in pairs]
    sides = [(lambda last, what=what: (what == DAMAGED) & last) for _, what in pairs]
    source = list(beats(packets, BUS, sides))
    seen = bench.run({"i": source}, {"i": len(source)}, settle=20, **options)
    found = []
    for packet, aborted in zip(seen.packets["o"], seen.sides["o"], strict=True):
        if 1 not in aborted:
            _, flags, _, length, _, sequence, fragment = struct.unpack("<BBHIIHH", packet[:16])
            # It is a single frame, with all of its bytes.
            assert flags & 1 and fragment == 0 and length == len(packet) - 16
            found.append(sequence)
    return found, counters_of(bench)


# A message of 20 bytes, in frames of 16.
FIRST, SECOND = {"last": False, "length": 20}, {"fragment": 1, "length": 20}
A, B = bytes(range(16)), b"abcd"


@pytest.mark.parametrize(
    ("frames", "passed", "counters"),
    [
        # Damage in a frame that has no byte behind its header, and in one that has 20.
        ([frame(0), (frame(1), DAMAGED), frame(2)], [0, 2], {"cut": 1, "lost": 1}),
        ([frame(0), (frame(1, A + B), DAMAGED), frame(2)], [0, 2], {"cut": 1, "lost": 1}),
        # It is the last word of a frame alone that says so.
        (
            [frame(0), (frame(1, A, **FIRST), DAMAGED), frame(1, B, **SECOND), frame(2)],
            [0, 2],
            {"cut": 1, "stray": 1, "lost": 1},
        ),
        # More or fewer bytes than the header says.
        ([frame(0, length=5), frame(1, B)], [1], {"cut": 1}),
        ([frame(0, A, length=15), frame(1, A, length=17), frame(2, A)], [2], {"cut": 2}),
        ([frame(0, A + B, length=4), frame(1, A + A, length=16), frame(2)], [2], {"cut": 2}),
        # A fragment that is not the last one has whole beats.
        (
            [frame(0, A[:15], **FIRST), frame(0, B, **SECOND), frame(1)],
            [1],
            {"cut": 1, "stray": 1},
        ),
        # No header, or another version, with and without bytes behind it.
        (
            [frame(0)[:size] for size in (0, 1, 7, 8, 9, 15)] + [frame(0)],
            [0],
            {"malformed": 6},
        ),
        ([frame(0, version=0xF0), frame(1, A, version=0xF2), frame(2)], [2], {"malformed": 2}),
        # A frame of another version between two of a message changes nothing.
        (
            [frame(0, A, **FIRST), frame(0, A, version=0), frame(0, B, **SECOND)],
            [0],
            {"malformed": 1},
        ),
        # 64 numbers back are late, and more are those of a sender that has started again.
        ([frame(1000), frame(937), frame(1001)], [1000, 1001], {"late": 1}),
        ([frame(1000, A), frame(937, A), frame(1001)], [1000, 1001], {"late": 1}),
        ([frame(1000), frame(936), frame(937)], [1000, 937], {"late": 1, "lost": 1}),
        (
            [frame(1000), *map(frame, (200, 201, 203))],
            [1000, 201, 203],
            {"late": 1, "lost": 2},
        ),
        ([frame(1000), frame(999, start=True), frame(1000)], [1000, 999, 1000], {}),
        ([frame(0), frame(1000, start=True), frame(1002)], [0, 1000, 1002], {"lost": 1}),
        # A number that is more than 64 away is believed when the next one follows.
        ([frame(9), frame(10 + 64)], [9, 10 + 64], {"lost": 64}),
        ([frame(9), frame(10 + 65), frame(11)], [9, 11], {"late": 1, "lost": 1}),
        (
            [*map(frame, (0, 1, 2, 0x4003, 4, 0x4004, 6, 0xC007, 8))],
            [0, 1, 2, 4, 6, 8],
            {"late": 3, "lost": 3},
        ),
        # Whatever was doubted before.
        ([*map(frame, (9, 500, 900, 501, 901, 902))], [9, 902], {"late": 4, "lost": 892}),
        # One that is damaged confirms nothing, and no more do late ones.
        (
            [frame(9), frame(500), (frame(501), DAMAGED), frame(501)],
            [9, 501],
            {"cut": 1, "late": 1, "lost": 491},
        ),
        ([*map(frame, (1000, 990, 991, 992))], [1000], {"late": 3}),
        # All of its frames are dropped.
        (
            [
                frame(9),
                *(frame(500, A, **FIRST), frame(500, B, **SECOND)),
                *(frame(501, A, **FIRST), frame(501, B, **SECOND)),
                frame(502),
            ],
            [9, 501, 502],
            {"late": 1, "stray": 1, "lost": 491},
        ),
        # Up to 32,767 messages may be missing; further ahead is back.
        ([*map(frame, (9, 32776, 32777))], [9, 32777], {"late": 1, "lost": 32767}),
        ([*map(frame, (9, 32777, 32778))], [9, 32778], {"late": 1, "lost": 1}),
        ([frame(65534), frame(65537), frame(65538)], [65534, 1, 2], {"lost": 2}),
        # Another message cuts the one under way, also if it is late or a part of one.
        (
            [frame(0, A, **FIRST), frame(1, A), frame(0, B, **SECOND), frame(2)],
            [1, 2],
            {"cut": 1, "stray": 1},
        ),
        (
            [frame(8), frame(9, A, **FIRST), frame(5), frame(9, B, **SECOND), frame(10)],
            [8, 10],
            {"cut": 1, "late": 1, "stray": 1, "lost": 1},
        ),
        (
            [frame(0, A, **FIRST), frame(0, A, **FIRST), frame(0, B, **SECOND)],
            [0],
            {"cut": 1},
        ),
        (
            [frame(0, A, **FIRST), frame(0, A, **FIRST | {"fragment": 2}), frame(0, B, **SECOND)],
            [],
            {"cut": 1, "stray": 2},
        ),
        (
            [frame(0, A, **FIRST), frame(0, B, **SECOND, topic=2), frame(1)],
            [1],
            {"cut": 1, "stray": 1},
        ),
    ],
)
def test_which_messages_are_whole(bench, frames, passed, counters):
    assert whole(bench, frames) == (passed, counters)


def test_a_fragment_without_bytes_is_no_part_of_its_message(bench):
    frames = [frame(0, A, **FIRST), frame(0, **SECOND), frame(0, B, **SECOND), frame(1)]
    assert whole(bench, frames) == ([0, 1], {"stray": 1})


def test_a_message_that_is_cut_counts_once_however_long_its_end_waits(bench):
    frames = [frame(0, A, **FIRST), frame(1, A, **FIRST), frame(2)]
    late = {"o": Stalls.bits("0000001")}
    assert whole(bench, frames, stalls=late) == ([2], {"cut": 2})
