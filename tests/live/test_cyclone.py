"""Participants of ours with Cyclone DDS."""

from __future__ import annotations

import struct
import time

import pytest

from firm_hdl.rtps import Qos
from tests.live import samples
from tests.live.peer import Peer
from tests.live.test_ros import STRING, wait, write_all

pytestmark = pytest.mark.live

KEEP_ALL = Qos(depth=0)
BLOCK = "firm_hdl/msg/Block"


def block(number: int, size: int) -> bytes:
    """Return a Block of the peer: its number, and about `size` bytes."""
    data = samples.block(number, size)[samples.BLOCK_HEAD :]
    return b"\0\1\0\0" + struct.pack("<qI", number, len(data)) + data


def test_samples_from_cyclone(node):
    got = []
    node.subscription("/chatter", STRING, got.append, KEEP_ALL)
    with Peer("cyclone", "publish", type="string", topic="rt/chatter", count=1000, period=0.001):
        assert wait(lambda: len(got) == 1000)
    expected = [b"m%d" % n for n in range(1000)]
    assert [each.payload[8:].split(b"\0")[0] for each in got] == expected


def test_samples_to_cyclone(node):
    writer = node.publisher("/chatter", STRING, KEEP_ALL)
    with Peer("cyclone", "subscribe", type="string", topic="rt/chatter", count=1000) as peer:
        assert writer.wait_for_match()
        write_all(writer, [samples.string(f"m{n}") for n in range(1000)], 0.001)
        assert peer.result()["numbers"] == list(range(1000))


def test_a_megabyte_both_ways(node):
    got = []
    node.subscription("/to_us", BLOCK, got.append, KEEP_ALL)
    writer = node.publisher("/from_us", BLOCK, KEEP_ALL)
    options = {"type": "block", "count": 3, "bytes": 1_000_000}
    with (
        Peer("cyclone", "publish", topic="rt/to_us", **options),
        Peer("cyclone", "subscribe", topic="rt/from_us", **options) as peer,
    ):
        assert writer.wait_for_match()
        write_all(writer, [block(n, 1_000_000) for n in range(3)], 0.1)
        assert peer.result()["numbers"] == [0, 1, 2]
        assert wait(lambda: len(got) == 3)
    size = len(block(0, 1_000_000))
    assert [each.payload[:size] for each in got] == [block(n, 1_000_000) for n in range(3)]


def test_cyclone_is_killed_and_started_again(node):
    writer = node.publisher("/chatter", STRING, KEEP_ALL)
    options = {"type": "string", "topic": "rt/chatter"}
    with Peer("cyclone", "subscribe", count=10_000, **options) as peer:
        assert writer.wait_for_match()
        writer.write(samples.string("m0"))
        peer.kill()
    first = {each.guid for each in writer.matched}
    with Peer("cyclone", "subscribe", count=20, **options) as peer:
        assert wait(lambda: any(each.guid not in first for each in writer.matched))
        time.sleep(0.2)
        for number in range(20):
            writer.write(samples.string(f"m{number}"))
        assert peer.result()["numbers"] == list(range(20))
