"""A node that is a participant itself, in Verilator, with real nodes of ROS 2: no host between."""

from __future__ import annotations

import os
import random
import socket
import subprocess
import time

import pytest

from firm_hdl.rtps import Guid, Qos
from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import PUBLICATIONS_WRITER, SPDP_WRITER, SUBSCRIPTIONS_WRITER
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.submessages import Data, DataFrag, NackFrag, NumberSet
from tests.live.boards import build_board
from tests.live.nodes import PACKAGES
from tests.live.peer import Peer

pytestmark = pytest.mark.live

RELEASES = pytest.mark.parametrize("release", ["jazzy", "kilted"])

BLOCK = "firm_hdl::msg::dds_::Block_"
NODE = f"""\
node: mirror
namespace: /fpga
distro: jazzy
paths: [{PACKAGES}]
clock_mhz: 1
bus_bytes: 2
link: {{kind: rtps, address: 127.0.0.1, participant: 50}}
accelerator: tests.live.nodes:Loop
subscribe:
  /text_in: {{type: std_msgs/msg/String, memory_bytes: 256}}
  /imu_in: {{type: sensor_msgs/msg/Imu, memory_bytes: 8192}}
  /twist_in: {{type: geometry_msgs/msg/Twist}}
  /scan_in: {{type: sensor_msgs/msg/LaserScan, memory_bytes: 2048}}
publish:
  /text_out: {{type: std_msgs/msg/String, memory_bytes: 2048, history: keep_all}}
  /imu_out: {{type: sensor_msgs/msg/Imu, memory_bytes: 8192, history: keep_all}}
  /twist_out: {{type: geometry_msgs/msg/Twist, memory_bytes: 2048, history: keep_all}}
  /scan_out: {{type: sensor_msgs/msg/LaserScan, memory_bytes: 16384, history: keep_all}}
serve:
  /mode: {{type: std_srvs/srv/SetBool, memory_bytes: 256}}
"""


SECOND = """\
node: second
namespace: /fpga
distro: jazzy
clock_mhz: 1
link: {kind: rtps, address: 127.0.0.1, participant: 51}
accelerator: firm_hdl.node.loop:Loop
subscribe: {/text_out: {type: std_msgs/msg/String, memory_bytes: 256}}
publish: {/text_back: {type: std_msgs/msg/String, memory_bytes: 256}}
"""

LARGE = """\
node: clouds
namespace: /fpga
distro: jazzy
paths: [packages]
clock_mhz: 1
bus_bytes: 2
link: {kind: rtps, address: 127.0.0.1, participant: 52}
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /text_in: {type: std_msgs/msg/String, memory_bytes: 256}
  /cloud_in: {type: sensor_msgs/msg/PointCloud2, memory_bytes: 32768}
  /block_in: {type: firm_hdl/msg/Block, memory_bytes: 32768}
publish:
  /text_out: {type: std_msgs/msg/String, memory_bytes: 2048}
  /cloud_out: {type: sensor_msgs/msg/PointCloud2, memory_bytes: 32768}
  /block_out: {type: firm_hdl/msg/Block, memory_bytes: 32768}
"""

FILES = {"packages/firm_hdl/msg/Block.msg": "int64 number\nuint8[] data\n"}


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """Build the node of large messages as a process."""
    return build_board(tmp_path_factory.mktemp("large"), "rtps", "clouds", LARGE, FILES)


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """Build the node as a process."""
    return build_board(tmp_path_factory.mktemp("participant"), "rtps", "mirror", NODE)


@pytest.fixture
def start(program):
    """Start the board; its processes end with the test."""
    started = []

    def begin(faults=0, program=program, port=7510):
        # Slower than the clock says, so that a busy machine keeps up.
        arguments = ["127.0.0.1", "1000000", "7400", str(port), str(port + 1)]
        process = subprocess.Popen(
            [program, *arguments],
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "FAULTS": str(faults)},
        )
        started.append(process)
        assert process.stdout.readline() == "ready\n"
        return process

    yield begin
    for process in started:
        process.kill()
        process.communicate()


def fragments(rng):
    """Return a DATA_FRAG and a NACK_FRAG, right or wrong, of endpoints that `flood` announces."""
    sizes = {
        "first": rng.choice((0, 1, 1, 2, 3, 1 << 31)),
        "count": rng.choice((0, 1, 1, 2, 0xFFFF)),
        "fragment_bytes": rng.choice((0, 1, 16, 16, 64, 0xFFFF)),
        "sample_bytes": rng.choice((0, 1, 40, 40, 100, 1 << 15, 1 << 31)),
    }
    ends = {"reader": 0, "writer": 0x303, "sequence_number": rng.randrange(1, 3)}
    part = DataFrag(**ends, **sizes, payload=rng.randbytes(rng.choice((0, 16, 32, 40))))
    ends = {"reader": 0x404, "writer": 0, "sequence_number": rng.randrange(4)}
    base = rng.choice((0, 1, 2, 1 << 31))
    missing = NumberSet.of(base, rng.sample(range(base, base + 256), 9))
    return part, NackFrag(**ends, missing=missing, count=rng.randrange(99))


def flood(port, seconds, seed=1):
    """Send invented participants and endpoints, damaged or not, and bytes that are no datagrams."""
    rng, end, prefixes = random.Random(seed), time.monotonic() + seconds, [bytes(12)]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        while time.monotonic() < end:
            prefix = rng.choice(prefixes)
            if rng.random() < 0.4:
                prefix = b"\x01\x0f" + rng.randbytes(10)
                prefixes = [*prefixes[-30:], prefix]
                nowhere = (Address("127.0.0.1", 9),)
                peer = ParticipantData(prefix=prefix, discovery=nowhere, user=nowhere, lease=1e6)
                payload, writer, number = peer.encode(), SPDP_WRITER, 1
            else:
                topic, type_name = rng.choice(
                    (("text", "std_msgs::msg::dds_::String_"), ("block", BLOCK))
                )
                endpoint = EndpointData(
                    guid=Guid(prefix, rng.choice((0x303, 0x404))),
                    topic=f"rt/{topic}_{rng.choice(('in', 'out'))}",
                    type_name=type_name,
                    qos=Qos(),
                )
                writer = rng.choice((PUBLICATIONS_WRITER, SUBSCRIPTIONS_WRITER))
                payload, number = endpoint.encode(), rng.randrange(1, 4)
            sample = Data(reader=0, writer=writer, sequence_number=number, payload=payload)
            some = rng.choices((sample, *fragments(rng)), (3, 1, 1), k=rng.randrange(1, 4))
            datagram = bytearray(message.write(prefix, some))
            if rng.random() < 0.3:
                datagram[rng.randrange(len(datagram))] ^= 1 << rng.randrange(8)
            if rng.random() < 0.2:
                del datagram[rng.randrange(1, len(datagram)) :]
            out.sendto(datagram, ("127.0.0.1", port + rng.choice((0, 1))))
            time.sleep(0.03)


TEXT = {"type": "string", "to": "/text_in", "back": "/text_out"}
TOPICS = [
    TEXT,
    {"type": "imu", "to": "/imu_in", "back": "/imu_out"},
    {"type": "twist", "to": "/twist_in", "back": "/twist_out"},
    {"type": "scan", "to": "/scan_in", "back": "/scan_out"},
]


def check_trips(release, topics, count, **options):
    """Let messages of several topics go to a node and back, at once."""
    options = {"count": count, "period": 0.1, "depth": 1000, **options}
    topics = [{**each, **options} for each in topics]
    # Seconds of the board take many of a busy machine.
    with Peer(release, "trip", topics=topics, patience=300, linger=60) as peer:
        assert peer.next(330) == {"begins": True}
        assert peer.result(1200)["numbers"] == [list(range(count))] * len(topics)


@RELEASES
def test_messages_come_back_in_order(release, start):
    start()
    check_trips(release, TOPICS, 1000)


def test_a_bad_network_loses_nothing_of_reliable_topics(start):
    start(faults=5)
    check_trips("kilted", TOPICS, 300)


def test_peers_come_and_go(start):
    start()
    options = {"to": "/text_in", "back": "/text_out", "patience": 60}
    with Peer("kilted", "come_and_go", count=100, **options) as peer:
        assert peer.result(1800) == {"back": 100}


def test_two_nodes_talk_to_each_other(start, tmp_path):
    """What the first one publishes is what the second one takes; rclpy is at both ends."""
    start()
    start(program=build_board(tmp_path, "rtps", "second", SECOND), port=7512)
    check_trips("kilted", [{**TEXT, "back": "/text_back"}], 200)


@RELEASES
def test_clouds_in_fragments_come_back(release, start, large):
    start(program=large, port=7514)
    options = {"bytes": 20_000, "count": 10, "period": 1.5, "depth": 20, "linger": 30}
    topic = {"type": "cloud", "to": "/cloud_in", "back": "/cloud_out", **options}
    with Peer(release, "trip", topics=[topic]) as peer:
        assert peer.next(90) == {"begins": True}
        assert peer.result(300)["numbers"] == [list(range(10))]


def test_blocks_of_cyclone_come_back_in_fragments(start, large):
    start(program=large, port=7514)
    options = {"type": "block", "bytes": 20_000, "count": 10, "patience": 120}
    with Peer("cyclone", "subscribe", topic="rt/block_out", **options) as back:
        time.sleep(5)
        with Peer("cyclone", "publish", topic="rt/block_in", period=1.5, **options):
            assert back.result(300)["numbers"] == list(range(10))


def test_a_burst_waits_for_the_accelerator(start):
    start()
    # More than the memory of the topic, sent at once; the writer keeps all until they are there.
    check_trips("kilted", [TEXT], 200, period=0)


@RELEASES
def test_the_node_is_in_the_graph_with_its_topics_and_services(release, start):
    start()
    wanted = {"node": "mirror", "namespace": "/fpga", "publishers": 4, "topics": ["/text_out"]}
    with Peer(release, "graph", own="watcher", **wanted) as peer:
        result = peer.result()
    assert ["mirror", "/fpga"] in result["nodes"] and result["owners"] == [["mirror", "/fpga"]]
    topics = ("imu", "scan", "text", "twist")
    assert [name for name, _ in result["publishers"]] == [f"/{each}_out" for each in topics]
    assert [name for name, _ in result["subscriptions"]] == [f"/{each}_in" for each in topics]
    assert [name for name, _ in result["services"]] == ["/mode"]


@RELEASES
def test_four_clients_of_a_service_at_once(release, start):
    start()
    clients = [Peer(release, "call", name="/mode", count=50, own=f"c{n}") for n in range(4)]
    try:
        answers = [each.result(120)["answers"] for each in clients]
    finally:
        for each in clients:
            each.kill()
    assert answers == [[[bool(n & 1), "ok"] for n in range(50)]] * 4


def test_a_flood_of_invented_peers_neither_disturbs_nor_keeps_out(start, large):
    start(program=large, port=7514)
    check_trips("kilted", [TEXT], 50)
    flood(7514, 5)
    check_trips("kilted", [TEXT], 50)


def test_a_board_that_starts_again_is_found_again(start):
    for _ in range(2):
        process = start()
        check_trips("kilted", [TEXT], 20)
        process.kill()
        process.wait()
