"""Frames on the host: what is written is read; what is damaged, lost or late is counted."""

from __future__ import annotations

import random
import struct
import zlib
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from firm_hdl.node.bytestream import ByteStreamReader, write_frame
from firm_hdl.node.frame import (
    HEADER,
    HEADER_BYTES,
    FrameError,
    Header,
    decode_header,
    encode_header,
)
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage
from tests.depth import by_depth
from tests.node import cobs
from tests.node.samples import PACKAGES

packets = st.one_of(st.binary(max_size=80), st.integers(0, 400).map(bytes))
some = settings(max_examples=by_depth(30, 100))
messages = st.lists(
    st.builds(
        NodeMessage,
        topic=st.integers(0, 65535),
        packet=packets,
        tag=st.integers(0, (1 << 32) - 1),
    ),
    max_size=8,
)


def frames_of(sent, frame_bytes=None, sequence=0):
    sender = MessageSender(frame_bytes, sequence=sequence)
    return [sender.frames(message) for message in sent]


def frame_of(sequence, *, start=False):
    return encode_header(Header(topic=1, length=0, sequence=sequence, start=start))


def received(frames, **options):
    receiver = MessageReceiver(**options)
    out = [message for frame in frames if (message := receiver.take(frame)) is not None]
    return out, receiver.counters


def test_the_header_is_the_documented_one():
    header = Header(
        topic=0x0102, length=0x03040506, tag=0x0708090A, sequence=0x0B0C, fragment=0x0D0E
    )
    assert encode_header(header).hex(" ") == "f1 01 02 01 06 05 04 03 0a 09 08 07 0c 0b 0e 0d"
    # By struct, which shares nothing with the codec.
    fields = struct.unpack("<BBHIIHH", encode_header(header))
    assert fields == (0xF1, 1, 0x0102, 0x03040506, 0x0708090A, 0x0B0C, 0x0D0E)
    assert sum(each.bytes for each in HEADER) == HEADER_BYTES == 16
    page = (PACKAGES.parent / "reference" / "frame.md").read_text(encoding="utf-8")
    at = 0
    for each in HEADER:
        assert f"\n| {at} | {each.bytes} | `{each.name}` | {each.meaning} |\n" in page
        at += each.bytes


@some
@given(
    st.builds(
        Header,
        topic=st.integers(0, 65535),
        length=st.integers(0, 2**32 - 1),
        tag=st.integers(0, 2**32 - 1),
        sequence=st.integers(0, 65535),
        fragment=st.integers(0, 65535),
        last=st.booleans(),
        start=st.booleans(),
    ),
    st.binary(max_size=4),
)
def test_a_header_comes_back(header, rest):
    assert decode_header(encode_header(header) + rest) == header


def test_what_is_no_header_is_refused():
    with pytest.raises(FrameError, match=r"^a frame has 16 bytes at least, not 15$"):
        decode_header(bytes(15))
    with pytest.raises(FrameError, match=r"^version is 0x00, not 0xf1$"):
        decode_header(bytes(16))
    with pytest.raises(ValueError, match=r"^topic must fit into 2 bytes, not 65536$"):
        encode_header(Header(topic=65536, length=0))


@some
@given(messages, st.sampled_from([None, 32, 48, 1472]), st.integers(0, 70000))
def test_messages_come_back_whole_and_in_order(sent, frame_bytes, sequence):
    frames = frames_of(sent, frame_bytes, sequence)
    assert all(len(frame) <= (frame_bytes or 1 << 32) for each in frames for frame in each)
    out, counters = received(frame for each in frames for frame in each)
    assert out == sent
    assert (counters.passed, counters.lost, counters.late, counters.cut) == (len(sent), 0, 0, 0)


@some
@given(messages, st.randoms(use_true_random=False), st.floats(0, 1))
def test_a_lost_fragment_loses_one_message_and_nothing_else(sent, rng, rate):
    frames = frames_of(sent, 32)
    kept = [[frame for frame in each if rng.random() >= rate] for each in frames]
    whole = [m for m, each, all_of in zip(sent, kept, frames, strict=True) if each == all_of]
    out, counters = received(frame for each in kept for frame in each)
    assert out == whole
    if whole and kept and kept[0] == frames[0]:
        last = max(k for k, each in enumerate(kept) if each == frames[k])
        assert counters.lost == last + 1 - len(whole)


@some
@given(messages, st.randoms(use_true_random=False))
def test_fragments_of_a_message_may_change_their_order(sent, rng):
    frames = frames_of(sent, 48)
    for each in frames:
        rng.shuffle(each)
    assert received(frame for each in frames for frame in each)[0] == sent


@some
@given(messages, st.randoms(use_true_random=False))
def test_messages_never_change_their_order(sent, rng):
    numbered = [replace(message, tag=number) for number, message in enumerate(sent)]
    # The first message of a sender may come again at any time: it would mean a new start.
    first, *others = frames_of([NodeMessage(topic=1, packet=b"first"), *numbered], 48)
    # Each frame twice, as a network may do.
    frames = [frame for each in others for frame in each for _ in range(2)]
    rng.shuffle(frames)
    out, counters = received([*first, *frames])
    tags = [message.tag for message in out[1:]]
    assert tags == sorted(set(tags)) and set(out[1:]) <= set(numbered)
    assert counters.passed == len(out)


@some
@given(st.lists(st.binary(max_size=60)), messages)
def test_garbage_between_frames_is_dropped(garbage, sent):
    frames = [frame for each in frames_of(sent) for frame in each]
    mixed = [x for pair in zip(garbage, frames, strict=False) for x in pair] + frames[
        len(garbage) :
    ]
    out, _ = received(x for x in mixed if x in frames or x[:1] != b"\xf1")
    assert out == sent


@some
@given(messages, st.data())
def test_a_flipped_bit_never_raises_and_memory_is_bounded(sent, data):
    frames = [bytearray(frame) for each in frames_of(sent, 32) for frame in each]
    for frame in frames:
        if data.draw(st.booleans()):
            frame[data.draw(st.integers(0, len(frame) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    receiver = MessageReceiver(max_bytes=100, max_open=2)
    for frame in frames:
        message = receiver.take(bytes(frame))
        assert message is None or len(message.packet) <= 100
        assert len(receiver._open) <= 2
        # 100 bytes, and the fragment that is one too many.
        assert all(each.size <= 116 for each in receiver._open.values())


@pytest.mark.parametrize(
    ("expected", "comes", "passed", "lost"),
    [
        (6, 9, 2, 3),
        (6, 6, 2, 0),
        (65534, 2, 2, 4),
        (None, 9, 2, 0),
        (6, 70, 2, 64),
        # Further ahead, the next number has to follow.
        (6, 71, 1, 66),
        (6, 0x8004, 1, 0x7FFF),
        # Behind is a sender that has started again, of which the first one here is missing.
        (6, 0x8006, 1, 1),
        (100, 35, 1, 1),
    ],
)
def test_what_is_lost_before_a_message_unless_its_sender_begins(expected, comes, passed, lost):
    """The numbers are expected and found; as many as 32,767 may be missing."""
    before = [] if expected is None else [frame_of(expected - 1)]
    both = [frame_of(comes), frame_of(comes + 1)]
    out, counters = received([*before, *both])
    assert len(out) == counters.passed == len(before) + passed
    assert (counters.lost, counters.late) == (lost, 2 - passed)
    out, counters = received([*before, frame_of(comes, start=True), both[1]])
    assert len(out) == len(before) + 2
    assert (counters.lost, counters.late) == (0, 0)


def test_a_number_that_is_damaged_adds_no_more_than_what_is_lost():
    """Each tenth message has any number; all others come, and what is not passed on is lost."""
    for seed in range(by_depth(6, 20)):
        rng = random.Random(seed)
        numbers = [n if n % 10 or not n else rng.randrange(1 << 16) for n in range(3000)]
        out, counters = received(frame_of(number) for number in [*numbers, *range(3000, 3100)])
        assert counters.lost == 3100 - len(out), seed
        assert counters.lost < 500


def test_a_message_beyond_the_limit_is_counted():
    frames = frames_of([NodeMessage(topic=1, packet=bytes(101))], 48)
    out, counters = received(frames[0], max_bytes=100)
    assert (out, counters.large, counters.stray) == ([], 1, 3)


@pytest.mark.parametrize(
    ("back", "passes"), [(2, False), (63, False), (64, False), (65, True), (1000, True)]
)
def test_as_many_as_64_numbers_back_are_late(back, passes):
    """A sender whose number is further back has started again, and its first message was lost."""
    old = frames_of([NodeMessage(topic=1, packet=b"a")], sequence=30)[0]
    new = frames_of([NodeMessage(topic=1, packet=b"b")] * 3, sequence=31 - back - 1)[1:]
    out, counters = received(frame for each in (old, *new) for frame in each)
    assert [each.packet for each in out] == [b"a", b"b"][: 1 + passes]
    assert counters.late == 2 - passes


blocks = st.one_of(
    st.binary(max_size=300),
    st.lists(st.sampled_from([b"\0", b"\1", b"\xff" * 253, b"\1" * 254]), max_size=6).map(b"".join),
)


@some
@given(blocks)
def test_byte_streams_are_cobs_with_the_crc_of_ethernet(frame):
    written = write_frame(frame)
    assert written[0] == written[-1] == 0 and 0 not in written[1:-1]
    data = frame + struct.pack("<I", zlib.crc32(frame))
    assert cobs.decode(written[1:-1]) == data
    assert cobs.encode(data) == written[1:-1]


@some
@given(st.lists(st.tuples(st.binary(max_size=20), blocks), max_size=5), st.data())
def test_a_reader_finds_the_next_frame_after_any_garbage(pairs, data):
    reader = ByteStreamReader()
    stream = b"".join(garbage + write_frame(frame) for garbage, frame in pairs)
    out = []
    while stream:
        size = data.draw(st.integers(1, len(stream)))
        out += reader.feed(stream[:size])
        stream = stream[size:]
    assert [frame for _, frame in pairs] == out
    assert reader.counters.passed == len(pairs)


@some
@given(blocks, st.data())
def test_no_damaged_frame_passes(frame, data):
    written = bytearray(write_frame(frame))
    at = data.draw(st.integers(1, len(written) - 2))
    written[at] ^= 1 << data.draw(st.integers(0, 7))
    reader = ByteStreamReader()
    assert reader.feed(bytes(written)) in ([], [frame])
    assert reader.feed(write_frame(b"next")) == [b"next"]


@pytest.mark.parametrize("most", [1, 249, 250, 251, 503, 504, 505, 2000])
def test_the_largest_frame_passes_however_many_bytes_its_stuffing_adds(most):
    for frame in (bytes(most), b"\1" * most, b"\1" * (most - 1) + b"\0"):
        reader = ByteStreamReader(max_bytes=most)
        assert reader.feed(write_frame(frame)) == [frame]
        assert reader.feed(write_frame(b"\1" * (most + 2))) == []
        found = reader.counters
        assert (found.passed, found.large, found.damaged) == (1, 1, 0)


def test_a_reader_that_skips_the_check_is_found(monkeypatch):
    """The twin: with a CRC that is always right, damage passes."""
    monkeypatch.setattr(zlib, "crc32", lambda data: 0)
    rng = random.Random(1)
    passed = 0
    for _ in range(50):
        written = bytearray(write_frame(b"abcdefgh"))
        written[rng.randrange(2, 9)] ^= 2
        passed += ByteStreamReader().feed(bytes(written)) != []
    assert passed


def test_the_oldest_open_message_gives_way_to_one_too_many():
    sender, receiver = MessageSender(32), MessageReceiver(max_open=2)
    for _ in range(3):
        receiver.take(sender.frames(NodeMessage(topic=1, packet=bytes(40)))[0])
    assert receiver.counters.cut == 1
