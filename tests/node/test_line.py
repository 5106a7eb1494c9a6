# amaranth: UnusedElaboratable=no
"""One link at line rate: eight topics, a beat per cycle through router, gates, FIFOs and arbiter.

`lab/bench/parts/standard.py` has the same node, to measure its clock rate.
"""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Signal

from firm_hdl.frontend import open_library
from firm_hdl.node import read_description_text
from firm_hdl.node.gateware import NodeCore
from firm_hdl.node.messages import NodeMessage
from firm_hdl.plan import build_plan
from firm_hdl.sim.payloads import beats_of
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.traffic import random_packets
from tests.node.test_core import CoreBench
from tests.node.traffic import messages_of

BUS = 8
EIGHT_TOPICS = """\
node: eight
clock_mhz: 156.25
subscribe:
  twist: {type: geometry_msgs/msg/Twist}
  imu: {type: sensor_msgs/msg/Imu, memory_bytes: 4096}
  scan: {type: sensor_msgs/msg/LaserScan}
  text: {type: std_msgs/msg/String, memory_bytes: 4096}
publish:
  twist_out: {type: geometry_msgs/msg/Twist}
  imu_out: {type: sensor_msgs/msg/Imu, memory_bytes: 4096}
  scan_out: {type: sensor_msgs/msg/LaserScan}
  text_out: {type: std_msgs/msg/String, memory_bytes: 4096}
"""
PASSED = 14
"""Cycles from the last beat of a packet on `received` to its first beat at a subscription."""
SENT = 7
"""Cycles from the last beat of a publication to its first beat on `sent`."""


def eight_topics():
    library = open_library("lyrical", (), ())
    return read_description_text(EIGHT_TOPICS, library=library)


def few_topics():
    """Return a description with two of the four topics in each direction."""
    lines = [each for each in EIGHT_TOPICS.splitlines() if "imu" not in each and "scan" not in each]
    return read_description_text("\n".join(lines), library=open_library("lyrical", (), ()))


@pytest.mark.thorough
def test_two_topics_have_a_beat_in_every_cycle_too():
    check_cycles(CoreBench(few_topics()), 2)


def good_packets(store, count):
    plan = build_plan(lay_out(store.message), bus_bytes=BUS)
    return random_packets(plan, count, sizes=(range(9, 10), range(20, 21)))


def traffic(description, count):
    """Return messages for all subscriptions in random order, and packets for all publications."""
    received = [
        NodeMessage(topic=topic.id, packet=packet)
        for topic, store in description.received()
        for packet in good_packets(store, count)
    ]
    random.Random(1).shuffle(received)
    return received, {t.port: good_packets(store, count) for t, store in description.sent()}


def run(bench, count, **options):
    """Send messages to all subscriptions, and from all publications; check what comes out."""
    received, published = traffic(bench.description, count)
    ports = [topic.port for topic, _ in bench.description.received()]
    seen = bench.run(
        received,
        {port: [(packet, 0, False) for packet in each] for port, each in published.items()},
        {"sent": count * len(published), **dict.fromkeys(ports, count)},
        **options,
    )
    for topic, _ in bench.description.received():
        mine = [message.packet for message in received if message.topic == topic.id]
        assert seen.packets[topic.port] == mine
    out = messages_of(seen, "sent")
    for topic, _ in bench.description.sent():
        mine = [message.packet for message in out if message.topic == topic.id]
        assert mine == published[topic.port]
    return received, published, seen


def check_cycles(bench, count, **options):
    """Check the cycle of every transfer in both directions, which are used at the same time."""
    description = bench.description
    received, published, seen = run(bench, count, **options)
    # From the link, a beat is taken per cycle.
    at = seen.times["received"][0]
    total = sum(beats_of(len(message.packet), BUS) for message in received)
    assert seen.times["received"] == list(range(at, at + total))
    # A packet leaves its gate a constant time after its last beat, a beat per cycle.
    expected = {topic.port: [] for topic, _ in description.received()}
    for message in received:
        beats = beats_of(len(message.packet), BUS)
        port = description.topics[message.topic - 1].port
        times, at = expected[port], at + beats
        first = at - 1 + PASSED
        assert not times or first > times[-1]
        times += range(first, first + beats)
    for port, times in expected.items():
        assert seen.times[port] == times
    # To the link, a beat leaves per cycle, as soon as the shortest packet is whole.
    sent = seen.times["sent"]
    shortest = min(beats_of(len(each[0]), BUS) for each in published.values())
    begin = seen.times[next(iter(published))][0] + shortest - 1 + SENT
    total = sum(beats_of(len(packet), BUS) for each in published.values() for packet in each)
    assert sent == list(range(begin, begin + total))


@pytest.mark.thorough
def test_every_cycle_of_eight_topics_carries_a_beat_in_both_directions():
    check_cycles(CoreBench(eight_topics()), by_depth(3, 6))


class _LosesACycleBetweenPackets(NodeCore):
    def _route(self, m, control):
        super()._route(m, control)
        pause, router = Signal(), m.submodules.router
        came = self.received
        m.d.sync += pause.eq(came.valid & came.ready & came.payload.beat.last)
        m.d.comb += [
            router.packets_in.valid.eq(came.valid & ~pause),
            came.ready.eq(router.packets_in.ready & ~pause),
        ]


class _LosesACycleToTheLink(NodeCore):
    def _collect(self, m, control):
        super()._collect(m, control)
        pause, out = Signal(), m.submodules.arbiter.packets_out
        m.d.sync += pause.eq(out.valid & out.ready & out.payload.last)
        m.d.comb += [
            self.sent.valid.eq(out.valid & ~pause),
            out.ready.eq(self.sent.ready & ~pause),
        ]


@pytest.mark.parametrize(
    "fault",
    [
        _LosesACycleBetweenPackets,
        pytest.param(_LosesACycleToTheLink, marks=pytest.mark.thorough),
    ],
)
def test_a_cycle_without_a_beat_is_found(fault):
    # Two topics in each direction are enough to see it, and take less time.
    description = by_depth(few_topics, eight_topics)()
    with pytest.raises(AssertionError):
        check_cycles(CoreBench(description, fault(description)), 2)
