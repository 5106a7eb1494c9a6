"""Nodes of ours in a graph with real nodes of ROS 2: rclpy on Fast DDS."""

from __future__ import annotations

import json
import queue
import struct
import time

import pytest

from firm_hdl.rtps import Durability, Qos, Reliability
from firm_hdl.rtps.ros import graph
from tests.live import samples
from tests.live.lossy import LossyTransport
from tests.live.peer import Peer

pytestmark = pytest.mark.live

RELEASES = pytest.mark.parametrize("release", ["jazzy", "kilted"])
IMU, BLOCK, STRING = "sensor_msgs/msg/Imu", "std_msgs/msg/UInt8MultiArray", "std_msgs/msg/String"
SET_BOOL = "std_srvs/srv/SetBool"
STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
SET_BOOL_HASHES = (
    "RIHS01_c62fbb99d94e1b25e8ef9e109f9581956bb1b3361a45a4e5810c36a90d29932e",
    "RIHS01_d0814e7f7b4880ab77e9c57426c7aa1562ab69f11eef8e2e968812f9cbd0b059",
)
KEEP_ALL = Qos(depth=0)


def wait(condition, timeout=20.0):
    """Wait for what another thread does."""
    end = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


def write_all(writer, payloads, period):
    at = time.monotonic()
    for each in payloads:
        writer.write(each, timeout=20)
        at += period
        time.sleep(max(0.0, at - time.monotonic()))
    assert writer.wait_for_acknowledgments(20)


@RELEASES
def test_samples_at_1_khz_from_a_peer(release, node):
    got = []
    node.subscription("/imu", IMU, got.append, KEEP_ALL)
    with Peer(release, "publish", type="imu", topic="/imu", count=3000, period=0.001, depth=0):
        assert wait(lambda: len(got) == 3000)
    assert [samples.number_of_imu(each.payload) for each in got] == list(range(3000))
    assert [each.sequence_number for each in got] == list(range(1, 3001))
    assert abs(got[-1].source_timestamp / 1e9 - time.time()) < 60


@RELEASES
def test_samples_at_1_khz_to_a_peer(release, node):
    writer = node.publisher("/imu", IMU, KEEP_ALL)
    with Peer(release, "subscribe", type="imu", topic="/imu", count=3000, depth=0) as peer:
        assert writer.wait_for_match()
        write_all(writer, [samples.imu(n) for n in range(3000)], 0.001)
        assert peer.result()["numbers"] == list(range(3000))


@RELEASES
def test_samples_of_20_kb(release, node):
    got = []
    node.subscription("/to_us", BLOCK, got.append)
    writer = node.publisher("/from_us", BLOCK, KEEP_ALL)
    options = {"type": "block", "count": 300, "bytes": 20_000, "depth": 0}
    with (
        Peer(release, "publish", topic="/to_us", period=0.02, own="one", **options),
        Peer(release, "subscribe", topic="/from_us", own="two", **options) as peer,
    ):
        assert writer.wait_for_match()
        write_all(writer, [samples.block(n, 20_000) for n in range(300)], 0.02)
        assert peer.result()["numbers"] == [n & 0xFF for n in range(300)]
        assert wait(lambda: len(got) == 300)
    assert [each.payload for each in got] == [samples.block(n, 20_000) for n in range(300)]


@RELEASES
def test_a_megabyte(release, node):
    got = []
    node.subscription("/to_us", BLOCK, got.append)
    writer = node.publisher("/from_us", BLOCK)
    options = {"type": "block", "count": 3, "bytes": 1_000_000}
    with (
        Peer(release, "publish", topic="/to_us", period=0.2, own="one", **options),
        Peer(release, "subscribe", topic="/from_us", own="two", **options) as peer,
    ):
        assert writer.wait_for_match()
        write_all(writer, [samples.block(n, 1_000_000) for n in range(3)], 0.2)
        assert peer.result()["numbers"] == [0, 1, 2]
        assert wait(lambda: len(got) == 3)
    assert [each.payload for each in got] == [samples.block(n, 1_000_000) for n in range(3)]


@RELEASES
def test_calls_of_our_service(release, node):
    count = []

    def handle(request):
        count.append(request)
        return b"\0\1\0\0" + struct.pack("<B3x", request[4]) + samples.string(str(len(count)))[4:]

    node.service("/mode", SET_BOOL, handle)
    with Peer(release, "call", name="/mode", count=200) as peer:
        answers = peer.result()["answers"]
    assert answers == [[bool(n & 1), str(n + 1)] for n in range(200)]


@RELEASES
def test_calls_of_a_peers_service(release, node):
    client = node.client("/mode", SET_BOOL)
    with Peer(release, "serve", name="/mode", count=200) as peer:
        answers = [client.call(samples.set_bool(bool(n & 1))) for n in range(200)]
        assert peer.result() == {"served": 200}
    text = [f"{bool(n & 1)} {n + 1}" for n in range(200)]
    assert [each[4] for each in answers] == [n & 1 for n in range(200)]
    assert [each[12:].split(b"\0")[0].decode() for each in answers] == text


@RELEASES
def test_a_peer_sees_our_node_by_name_and_we_see_its(release, node):
    node.publisher("chatter", STRING, type_hash=STRING_HASH)
    node.publisher("~/imu", IMU)
    node.subscription("/scan", BLOCK, print)
    hashes = {"request_hash": SET_BOOL_HASHES[0], "response_hash": SET_BOOL_HASHES[1]}
    node.service("mode", SET_BOOL, lambda request: request, **hashes)
    node.client("/other", SET_BOOL)
    topics = ["/fpga/chatter", "rq/fpga/modeRequest", "rr/fpga/modeReply", graph.TOPIC]
    wanted = {"node": "board", "namespace": "/fpga", "publishers": 2, "topics": topics}
    with Peer(release, "graph", own="watcher", **wanted) as peer:
        assert node.context.wait_for_node("watcher")
        seen = peer.result()
    assert ["board", "/fpga"] in seen["nodes"]
    assert seen["publishers"] == [["/fpga/board/imu", [IMU]], ["/fpga/chatter", [STRING]]]
    assert seen["subscriptions"] == [["/scan", [BLOCK]]]
    assert seen["services"] == [["/fpga/mode", [SET_BOOL]]]
    assert seen["clients"] == [["/other", [SET_BOOL]]]
    # The participant's own topic has a writer and a reader of ours, which belong to no node there.
    assert seen["hashes"][:3] == [STRING_HASH, *SET_BOOL_HASHES]
    assert seen["owners"][:3] == [["board", "/fpga"]] * 3
    assert set(seen["hashes"][3:]) == {graph.TYPE_HASH}


@RELEASES
def test_loss_of_a_twentieth_of_all_datagrams(release, make_node):
    transport = LossyTransport(0, "127.0.0.1", loss=0.05, seed=1)
    node = make_node(transport=transport)
    got = []
    node.subscription("/to_us", IMU, got.append, KEEP_ALL)
    writer = node.publisher("/from_us", IMU, KEEP_ALL)
    options = {"type": "imu", "count": 1000, "depth": 0, "patience": 40}
    with (
        Peer(release, "publish", topic="/to_us", period=0.002, own="one", linger=20, **options),
        Peer(release, "subscribe", topic="/from_us", own="two", **options) as peer,
    ):
        assert writer.wait_for_match(timeout=20)
        write_all(writer, [samples.imu(n) for n in range(1000)], 0.002)
        assert peer.result()["numbers"] == list(range(1000))
        assert wait(lambda: len(got) == 1000, 40)
    assert [samples.number_of_imu(each.payload) for each in got] == list(range(1000))
    # Or the test would show nothing.
    assert transport.lost > 50


@RELEASES
def test_large_samples_and_loss(release, make_node):
    transport = LossyTransport(0, "127.0.0.1", loss=0.05, seed=2)
    node = make_node(transport=transport)
    got = []
    node.subscription("/to_us", BLOCK, got.append, KEEP_ALL)
    writer = node.publisher("/from_us", BLOCK, KEEP_ALL)
    options = {"type": "block", "count": 5, "bytes": 200_000, "depth": 0, "patience": 50}
    with (
        Peer(release, "publish", topic="/to_us", period=0.1, own="one", linger=20, **options),
        Peer(release, "subscribe", topic="/from_us", own="two", **options) as peer,
    ):
        assert writer.wait_for_match(timeout=20)
        write_all(writer, [samples.block(n, 200_000) for n in range(5)], 0.1)
        assert peer.result()["numbers"] == list(range(5))
        assert wait(lambda: len(got) == 5, 50)
    assert [each.payload for each in got] == [samples.block(n, 200_000) for n in range(5)]
    assert transport.lost > 10


@RELEASES
def test_a_peer_that_is_killed_and_started_again(release, node):
    writer = node.publisher("/chatter", STRING, KEEP_ALL)
    options = {"type": "string", "topic": "/chatter", "depth": 0}
    with Peer(release, "subscribe", count=10_000, **options) as peer:
        assert writer.wait_for_match()
        write_all(writer, [samples.string(f"m{n}") for n in range(10)], 0.01)
        peer.kill()
    first = {each.guid for each in writer.matched}
    with Peer(release, "subscribe", count=20, **options) as peer:
        assert wait(lambda: any(each.guid not in first for each in writer.matched))
        for number in range(20):
            writer.write(samples.string(f"m{number}"))
        # A volatile writer sends nothing old to the new one, and waits for nothing of the dead one.
        assert peer.result()["numbers"] == list(range(20))


def test_the_lease_of_a_killed_peer(make_node):
    events = []
    node = make_node(on_event=events.append)
    with Peer("kilted", "subscribe", type="string", topic="/x", count=1):
        assert wait(lambda: node.context.participant.peers)
    assert wait(lambda: [type(each).__name__ for each in events][-1] == "PeerLost", 40)
    assert events[-1].expired
    assert not node.context.participant.peers


@RELEASES
def test_we_are_started_again(release, make_node):
    got = []
    options = {"type": "string", "topic": "/chatter", "count": 20, "depth": 0}
    with Peer(release, "subscribe", **options) as peer:
        for half in (range(10), range(10, 20)):
            node = make_node()
            writer = node.publisher("/chatter", STRING, KEEP_ALL)
            assert writer.wait_for_match()
            write_all(writer, [samples.string(f"m{n}") for n in half], 0)
            node.close()
        got = peer.result()["numbers"]
    assert got == list(range(20))


@RELEASES
def test_a_peer_sees_our_farewell_and_our_lease(release, make_node):
    with Peer(release, "gone", node="board", namespace="/fpga") as peer:
        node = make_node()
        assert peer.next() == {"there": True}
        node.close()
        assert peer.result() == {"there": False}
    with Peer(release, "gone", node="board", namespace="/fpga") as peer:
        silent = LossyTransport(0, "127.0.0.1", loss=0, seed=1)
        make_node(transport=silent, lease=3.0)
        assert peer.next() == {"there": True}
        # Longer than the lease: announcements are what keeps it.
        with pytest.raises(queue.Empty):
            peer.next(timeout=5)
        silent.loss = 1
        assert peer.result() == {"there": False}


@RELEASES
def test_policies_that_do_not_fit_are_reported(release, node):
    refused = []
    writer = node.publisher(
        "/chatter",
        STRING,
        Qos(reliability=Reliability.BEST_EFFORT),
        on_incompatible=lambda remote, policies: refused.append((remote.topic, policies)),
    )
    with Peer(release, "subscribe", type="string", topic="/chatter", count=1, transient_local=True):
        assert wait(lambda: refused)
    assert refused == [("rt/chatter", ("RELIABILITY", "DURABILITY"))]
    assert not writer.matched


@RELEASES
def test_late_readers_get_what_is_durable(release, node):
    durable = Qos(durability=Durability.TRANSIENT_LOCAL, depth=5)
    writer = node.publisher("/durable", STRING, durable)
    volatile = node.publisher("/volatile", STRING, KEEP_ALL)
    for number in range(20):
        writer.write(samples.string(f"m{number}"))
        volatile.write(samples.string(f"m{number}"))
    options = {"type": "string", "patience": 4, "transient_local": True}
    with Peer(release, "subscribe", topic="/durable", count=5, **options) as peer:
        assert peer.result()["numbers"] == list(range(15, 20))
    options["transient_local"] = False
    with Peer(release, "subscribe", topic="/volatile", count=5, **options) as peer:
        assert volatile.wait_for_match()
        volatile.write(samples.string("m99"))
        assert peer.result()["numbers"] == [99]


@RELEASES
def test_durable_samples_of_a_peer(release, node):
    options = {"type": "string", "topic": "/durable", "count": 20, "depth": 5}
    with Peer(release, "publish", wait=0, transient_local=True, linger=20, **options):
        time.sleep(2)
        got = []
        durable = Qos(durability=Durability.TRANSIENT_LOCAL, depth=5)
        node.subscription("/durable", STRING, got.append, durable)
        assert wait(lambda: len(got) == 5)
    assert [each.payload[8:].split(b"\0")[0] for each in got] == [b"m%d" % n for n in range(15, 20)]


@RELEASES
def test_domains_are_apart(release, make_node):
    here, elsewhere = make_node(domain=42), make_node(domain=41)
    writers = [each.publisher("/chatter", STRING) for each in (here, elsewhere)]
    options = {"type": "string", "topic": "/chatter", "count": 1}
    with Peer(release, "subscribe", domain=42, **options) as peer:
        assert writers[0].wait_for_match()
        assert not writers[1].matched
        writers[0].write(samples.string("m7"))
        assert peer.result()["numbers"] == [7]


@RELEASES
@pytest.mark.parametrize("multicast", [True, False], ids=["multicast", "unicast"])
@pytest.mark.parametrize("scope", ["LOCALHOST", "SUBNET"])
def test_discovery_that_is_limited(release, scope, multicast, make_node):
    lost = []
    node = make_node(
        multicast=multicast,
        peers=() if multicast else ("127.0.0.1",),
        on_event=lambda event: lost.append(type(event).__name__),
        lease=2.0,
    )
    writer = node.publisher("/chatter", STRING)
    variables = {"ROS_AUTOMATIC_DISCOVERY_RANGE": scope}
    options = {"type": "string", "topic": "/chatter", "count": 2}
    with Peer(release, "subscribe", variables=variables, **options) as peer:
        assert writer.wait_for_match()
        writer.write(samples.string("m0"))
        # The peer keeps us for longer than our lease.
        time.sleep(4)
        writer.write(samples.string("m1"))
        assert peer.result()["numbers"] == [0, 1]
    assert "PeerLost" not in lost[:1]


def test_a_peer_that_is_not_there_is_said_so():
    """The twin of all tests here: a peer that gets nothing says so."""
    with Peer("kilted", "subscribe", type="string", topic="/x", count=1, patience=1) as peer:
        assert json.dumps(peer.result()) == '{"numbers": []}'
