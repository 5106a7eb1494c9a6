# amaranth: UnusedElaboratable=no
"""What a description says of the memory of a topic, in the core: sizes, numbers and policies."""

from __future__ import annotations

import struct

import pytest

from firm_hdl.frontend import Library
from firm_hdl.node import Node, read_description_text
from firm_hdl.node.messages import NodeMessage
from firm_hdl.sim import Stalls
from tests.gateware.packets.bench import PacketBench, beats
from tests.node.samples import read
from tests.node.test_core import CoreBench
from tests.node.traffic import frames_of, messages_of, received_by_host

TEXT = """\
node: n
distro: jazzy
subscribe:
  /held: {type: std_msgs/msg/UInt16, packets: 2, when_full: wait}
  /lost: {type: std_msgs/msg/UInt16, packets: 2}
  /short: {type: std_msgs/msg/String, memory_bytes: 64, max_message_bytes: 12}
publish:
  /kept: {type: std_msgs/msg/UInt16, packets: 2}
  /lossy: {type: std_msgs/msg/UInt16, packets: 2, when_full: drop}
"""
HELD, LOST, SHORT, KEPT, LOSSY = range(1, 6)
COUNT = 12
LATE = Stalls.bits("0" * 80 + "1" * 1000)


@pytest.fixture(scope="module")
def bench():
    return CoreBench(read(TEXT))


def numbers(count=COUNT):
    return [b"\0\1\0\0" + struct.pack("<H", number) for number in range(count)]


def string(text):
    return b"\0\1\0\0" + struct.pack("<I", len(text) + 1) + text + b"\0"


def test_a_subscription_that_waits_holds_the_link_and_loses_nothing(bench):
    # More than it and what lies before it can hold.
    sent = [NodeMessage(topic=HELD, packet=packet) for packet in numbers(60)]
    sent.append(NodeMessage(topic=SHORT, packet=string(b"abc")))
    seen = bench.run(sent, want={"held": 60, "short": 1}, stalls={"held": LATE}, deadline=400)
    assert seen.packets["held"] == numbers(60) and seen.packets["short"] == [string(b"abc")]
    assert bench.counters(HELD, "in") == {"passed": 60, "bytes_low": 6 * 60}
    # The one behind came after the subscription was taken from.
    assert seen.times["short"][0] > seen.times["held"][0] >= 80


def test_a_subscription_that_drops_keeps_as_many_as_its_memory_may_have(bench):
    sent = [NodeMessage(topic=LOST, packet=packet) for packet in numbers()]
    seen = bench.run(sent, want={"lost": 2}, stalls={"lost": LATE}, deadline=400, settle=40)
    found = seen.packets["lost"]
    # Besides those two, some are on their way to the output.
    assert found == sorted(found) and 2 <= len(set(found)) <= 5 and set(found) <= {*numbers()}
    assert bench.counters(LOST, "in") == {
        "passed": len(found),
        "full": COUNT - len(found),
        "bytes_low": 6 * len(found),
    }


@pytest.mark.parametrize(("topic", "drops"), [(KEPT, False), (LOSSY, True)])
def test_publications_wait_or_are_dropped(bench, topic, drops):
    port = {KEPT: "kept", LOSSY: "lossy"}[topic]
    packets = {port: [(packet, 0, False) for packet in numbers()]}
    seen = bench.run(
        sent=packets, want={"sent": 2, port: COUNT}, stalls={"sent": LATE}, deadline=400, settle=60
    )
    found = [message.packet for message in messages_of(seen, "sent")]
    counters = bench.counters(topic, "out")
    if drops:
        assert found == sorted(found) and 2 <= len(set(found)) <= 6 and set(found) <= {*numbers()}
        assert counters.pop("full") == COUNT - len(found)
        # The publication was not held.
        assert seen.times[port][-1] < 80
    else:
        assert found == numbers() and seen.times[port][-1] >= 80
    assert counters == {"passed": len(found), "bytes_low": 6 * len(found)}


ROS_1 = """\
node: n
bus_bytes: 4
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /a: {type: std_msgs/String, memory_bytes: 64}
publish:
  /b: {type: std_msgs/String, memory_bytes: 64}
"""


def string_of_ros_1(text):
    """Return a String of ROS 1: no encapsulation, and no zero at its end."""
    return struct.pack("<I", len(text)) + text


def test_messages_of_ros_1_pass_through_gates_and_converters():
    description = read_description_text(ROS_1, library=Library("noetic"))
    node = Node(description)
    bench = PacketBench(node, {"in": node.link.frames_in}, {"out": (node.link.frames_out, 4, None)})
    good = [string_of_ros_1(text) for text in (b"", b"abcde", b"xyz")]
    # One of ROS 2 is none of ROS 1: it claims more bytes than there are.
    packets = [good[0], string(b"abc"), *good[1:]]
    sent = frames_of(NodeMessage(topic=1, packet=packet) for packet in packets)
    seen = bench.run({"in": list(beats(sent, 4))}, {"out": 3}, settle=30)
    out, _ = received_by_host(seen.packets["out"])
    assert out == [NodeMessage(topic=2, packet=packet) for packet in good]
