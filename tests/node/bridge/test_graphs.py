"""The ways to graphs of ROS: names, lines of JSON, our own participant."""

from __future__ import annotations

import io
import json
import os
import sys
import threading
import time
from pathlib import Path
from types import ModuleType

import pytest

from firm_hdl.errors import UserError
from firm_hdl.identity import type_hash
from firm_hdl.node import read_description_text
from firm_hdl.node.graphs import GraphError, graph_of, rtps
from firm_hdl.node.graphs.lines import LinesGraph
from firm_hdl.node.graphs.mismatch import qos_of
from firm_hdl.node.graphs.ros1 import definitions
from firm_hdl.node.graphs.ros2 import RclpyGraph, has_rclpy
from firm_hdl.node.graphs.rtps import RtpsGraph
from firm_hdl.rtps import Durability, HistoryFullError, Participant, Qos, Reliability
from firm_hdl.rtps.ros import Node, names
from firm_hdl.rtps.ros.graph import TYPE_HASH
from tests.node.accelerators import echo_text
from tests.node.bridge.fakes import CAL, ECHO, HEARD, SAID, STAMP, bridge_of, run_until
from tests.node.samples import read

# One that no other test has.
DOMAIN = 100 + os.getpid() % 60
OPTIONS = {"domain": DOMAIN, "interface": "lo"}
STRING = "std_msgs/msg/String"


def wait(condition, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def test_lines_are_messages():
    rows = [
        {"topic": "/heard", "packet": "00 01"},
        {"topic": "/cal", "packet": "", "call": [1]},
        {"topic": "/said", "packet": ""},
        {"topic": "/heard", "packet": "0"},
        {"topic": "/heard"},
        {"topic": "/heard", "packet": 10},
        [],
    ]
    deep = "[" * 100_000
    text = "\n".join([*map(json.dumps, rows), "", "no JSON", deep, '{"topic": ["/heard"]}'])
    sink, got = io.StringIO(), []
    graph = LinesGraph(ECHO, io.StringIO(text), sink)
    assert not graph.has_ended
    graph.open(lambda *message: got.append(message))
    assert wait(lambda: graph.has_ended)
    assert got == [(HEARD, b"\0\1", None), (CAL, b"", [1])]
    # The board publishes `/said`, so nobody sends it there.
    assert graph.counters == {
        "a line that is no object of JSON": 3,
        "a line without the name of a subscription or a service": 2,
        "a line without a packet in hexadecimal": 3,
    }
    assert graph.publish(SAID, b"\1") and graph.respond(CAL, [1], b"\2")
    assert [json.loads(line) for line in sink.getvalue().splitlines()] == [
        {"topic": "/said", "packet": "01"},
        {"topic": "/cal", "packet": "02", "call": [1]},
    ]


def test_names_of_graphs(monkeypatch):
    assert isinstance(graph_of("none", ECHO), LinesGraph)
    assert isinstance(graph_of("rtps", ECHO, domain=3), RtpsGraph)
    assert isinstance(graph_of(None, ECHO), RclpyGraph if has_rclpy() else RtpsGraph)
    # An interface is what rclpy cannot choose.
    assert isinstance(graph_of("ros2", ECHO, interface="lo"), RtpsGraph)
    ours = graph_of("rtps", ECHO, domain=3, interface="lo")
    assert (ours._options["domain"], ours._options["interface"]) == (3, "lo")
    monkeypatch.setitem(sys.modules, "rclpy", ModuleType("rclpy"))
    theirs = graph_of(None, ECHO, domain=4)
    assert isinstance(theirs, RclpyGraph) and theirs._domain == 4
    assert isinstance(graph_of("ros2", ECHO, interface="lo"), RtpsGraph)
    assert isinstance(graph_of("rtps", ECHO), RtpsGraph)
    with pytest.raises(UserError, match="which the graph 'ros1' does not carry"):
        graph_of("ros1", ECHO)
    old = read_description_text(
        "node: n\ndistro: noetic\nsubscribe:\n  /a: {type: std_msgs/Bool}\n"
    )
    with pytest.raises(UserError, match="noetic are those of ros1, which the graph 'rtps'"):
        graph_of("rtps", old)
    monkeypatch.setitem(sys.modules, "rospy", None)
    with pytest.raises(UserError, match="needs rospy, which this Python does not have"):
        graph_of(None, old)


def test_the_domain_of_the_environment(monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert RtpsGraph(ECHO)._options["domain"] == 7
    # What the caller says counts more, also if that is 0.
    assert RtpsGraph(ECHO, domain=0)._options["domain"] == 0
    monkeypatch.setenv("ROS_DOMAIN_ID", "")
    assert RtpsGraph(ECHO)._options["domain"] == 0
    for wrong in ("seven", "-1", "\N{SUPERSCRIPT TWO}", "233", "9" * 5000):
        monkeypatch.setenv("ROS_DOMAIN_ID", wrong)
        message = f"ROS_DOMAIN_ID is '{wrong}', and should be a number from 0 to 232"
        for graph in (RtpsGraph, RclpyGraph):
            with pytest.raises(UserError, match=message):
                graph(ECHO)
            with pytest.raises(UserError, match="the domain is '233', and should"):
                graph(ECHO, domain=233)


@pytest.mark.parametrize(
    ("options", "policies"),
    [
        ("", (2, 0, 10)),
        (", reliability: best_effort, depth: 3", (1, 0, 3)),
        (", durability: transient_local, depth: 1", (2, 1, 1)),
        # All samples are kept, whatever the depth is.
        (", history: keep_all, depth: 7", (2, 0, 0)),
    ],
)
def test_policies_of_a_topic_are_those_of_its_endpoints(options, policies):
    text = f"node: n\npublish: {{a: {{type: std_msgs/msg/Bool{options}}}}}\n"
    (topic,) = read_description_text(text).topics
    found = qos_of(topic)
    assert (found.reliability, found.durability, found.depth) == policies


def test_our_own_participant():
    description = read(echo_text())
    _, said, _, cal = description.topics
    got, heard_by_peer = [], []
    graph = RtpsGraph(description, **OPTIONS)
    graph.open(lambda topic, packet, caller: got.append((topic.name, packet, caller)))
    try:
        with Node("peer", **OPTIONS) as peer:
            writer = peer.publisher("/heard", STRING, Qos(depth=0))
            peer.subscription("/said", STRING, lambda s: heard_by_peer.append(s.payload))
            client = peer.client("/cal", "robot_msgs/srv/Calibrate")
            assert peer.context.wait_for_node("echo")
            assert writer.wait_for_match() and client.wait_for_service()
            assert peer.context.type_hashes("/said") == {
                "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
            }
            for number in range(20):
                writer.write(b"%04d" % number)
            assert wait(lambda: len(got) == 20)
            assert got == [("/heard", b"%04d" % number, None) for number in range(20)]
            assert wait(lambda: graph._writers[said.id].matched)
            assert graph.publish(said, b"hello")
            assert wait(lambda: heard_by_peer == [b"hello"])
            # A message that the board has damaged is no sample.
            assert not graph.publish(said, b"")
            calls = [client.call_async(b"%04d" % number) for number in range(3)]
            assert wait(lambda: len(got) == 23)
            graph.abandon(cal, got[22][2])
            for _, packet, caller in got[20:22]:
                assert graph.respond(cal, caller, packet + b"!")
            assert [call.result(20) for call in calls[:2]] == [b"0000!", b"0001!"]
            assert not graph.respond(cal, got[22][2], b"late") and not calls[2].done()
            graph.check()
            assert not +graph.counters
    finally:
        graph.close()
    with pytest.raises(GraphError, match="the participant is closed"):
        graph.publish(said, b"")


def test_peers_that_do_not_fit_are_named_once():
    made, said = bridge_of(graph=RtpsGraph(ECHO, **OPTIONS))
    best_effort = Qos(reliability=Reliability.BEST_EFFORT)
    lasting = Qos(durability=Durability.TRANSIENT_LOCAL)
    other = "RIHS01_" + 64 * "0"
    try:
        with Node("peer", "/p", **OPTIONS) as peer, Participant(**OPTIONS) as stranger:
            peer.publisher("/heard", "std_msgs/msg/Bool")
            peer.publisher("/said", "std_msgs/msg/Byte")
            peer.publisher("/heard", STRING, best_effort)
            peer.publisher("/heard", STRING, type_hash=other)
            peer.subscription("/said", STRING, print, lasting)
            # These fit.
            peer.publisher("/heard", STRING, lasting)
            peer.subscription("/said", STRING, print, best_effort)
            peer.publisher("/said", STRING, best_effort)
            peer.client("/cal", "robot_msgs/srv/Other")
            peer.client("/cal", "robot_msgs/srv/Calibrate")
            stranger.writer("rt/heard", "a\nb\x1b")
            stranger.writer("rt/heard", "a\nb\x1b")
            assert run_until(made, lambda: len(said) >= 9), said
            begin = made.graph.counters.copy()
            run_until(made, lambda: False, seconds=2.5)
    finally:
        made.close()
    own = type_hash(SAID.stores[0][1].message)
    assert not begin["lost"] and said[:2] == ["board fake: ready", "graph rtps: joined"]
    unfit = "it with a QoS that does not fit, so no messages pass:"
    assert sorted(said[2:]) == sorted(
        f"graph rtps: {line}"
        for line in (
            "/heard: node /p/peer publishes 'std_msgs/msg/Bool', and the type here is "
            "'std_msgs/msg/String'; no messages pass",
            "/said: node /p/peer publishes 'std_msgs/msg/Byte', and the type here is "
            "'std_msgs/msg/String'; no messages pass",
            f"/heard: node /p/peer publishes {unfit} reliability (best_effort is offered, and "
            "reliable asked for)",
            f"/heard: node /p/peer publishes another definition of '{STRING}': its type hash is "
            f"{other}, and that of the description is {own}",
            f"/said: node /p/peer subscribes to {unfit} durability (volatile is offered, and "
            "transient_local asked for)",
            "/cal: node /p/peer calls 'robot_msgs/srv/Other', and the type here is "
            "'robot_msgs/srv/Calibrate'; no messages pass",
            "/heard: a peer publishes 'a\\nb\\x1b', and the type here is 'std_msgs/msg/String'; "
            "no messages pass",
        )
    )


def test_a_peer_with_many_types_is_not_named_for_ever():
    graph = RtpsGraph(ECHO, **OPTIONS)
    for number in range(1000):
        graph.tell(str(number))
    assert len(graph.news()) == 101 and not graph.news()
    graph.tell("again")
    assert not graph.news()


def test_endpoints_of_a_service_have_the_hashes_of_its_messages():
    """As rmw_fastrtps of Kilted announces them for SetBool."""
    packages = Path(__file__).parents[3] / "examples" / "nodes" / "packages"
    serve = "{/mode: {type: std_srvs/srv/SetBool, memory_bytes: 64}}"
    text = f"node: n\ndistro: jazzy\npaths: {packages}\nserve: {serve}\n"
    graph = RtpsGraph(read_description_text(text), **OPTIONS)
    graph.open(lambda *message: None)
    try:
        with Node("peer", **OPTIONS) as peer:
            there = peer.context.participant
            assert wait(lambda: len([*there.remotes(True), *there.remotes(False)]) == 4)
            hashes = {
                each.topic: names.type_hash_of(each.user_data)
                for is_writer in (True, False)
                for each in there.remotes(is_writer)
            }
    finally:
        graph.close()
    assert hashes == {
        "rr/modeReply": "RIHS01_d0814e7f7b4880ab77e9c57426c7aa1562ab69f11eef8e2e968812f9cbd0b059",
        "rq/modeRequest": "RIHS01_c62fbb99d94e1b25e8ef9e109f9581956bb1b3361a45a4e5810c36a90d29932e",
        "ros_discovery_info": TYPE_HASH,
    }


def test_a_dead_reader_does_not_hold_up_others():
    description = read(echo_text().replace("/said: {", "/said: {history: keep_all, "))
    said = description.topics[1]
    graph = RtpsGraph(description, **OPTIONS)
    graph.open(lambda *message: None)
    try:
        graph._full.add(said.id)
        begin = time.monotonic()
        # Nobody reads, so there is room again at once.
        assert graph.publish(said, b"1234") and said.id not in graph._full
        assert time.monotonic() - begin < 5
    finally:
        graph.close()


class Writer:
    """A writer without room, which notes how long each message may wait for it."""

    def __init__(self):
        self.is_full, self.patience, self.overwritten = True, [], 0

    def write(self, packet, timeout):
        self.patience.append(timeout)
        if self.is_full:
            raise HistoryFullError


def test_messages_that_give_way_before_a_reader_has_them_are_counted():
    graph, release = RtpsGraph(ECHO, **OPTIONS), threading.Event()
    graph.open(lambda *message: None)
    with Node("peer", **OPTIONS) as peer:
        peer.subscription("/said", STRING, lambda sample: release.wait(60))
        assert wait(lambda: graph._writers[SAID.id].matched)
        # The thread of the peer is busy with the first one, and the depth is 10.
        for number in range(40):
            assert graph.publish(SAID, b"%04d" % number)
        graph.check()
        overwritten = graph.counters["overwritten"]
        assert 29 <= overwritten <= 30
        # It is counted once, also when the graph is joined again.
        graph.close()
        graph.open(lambda *message: None)
        graph.check()
        assert graph.counters["overwritten"] == overwritten
        graph.close()
        release.set()


def test_only_the_first_message_waits_for_room():
    graph, writer, other = RtpsGraph(ECHO, **OPTIONS), Writer(), Writer()
    graph._writers = {SAID.id: writer, STAMP.id: other}
    assert [graph.publish(SAID, b"") for _ in range(3)] == [False] * 3
    # Each topic has a reader of its own.
    assert not graph.publish(STAMP, b"")
    writer.is_full = False
    assert [graph.publish(SAID, b"") for _ in range(2)] == [True] * 2
    assert not graph.publish(STAMP, b"")
    room = rtps._ROOM_SECONDS
    assert writer.patience == [room, 0.0, 0.0, 0.0, room] and other.patience == [room, 0.0]
    assert room > 0
    writer.is_full = True
    graph.publish(SAID, b"")
    graph.close()
    graph._writers = {SAID.id: writer}
    graph.publish(SAID, b"")
    assert writer.patience[-1] == room


def test_definitions_of_ros_1():
    description = read_description_text(
        "node: n\ndistro: noetic\nsubscribe:\n  /a: {type: std_msgs/Header}\n"
    )
    (topic,) = description.topics
    text = definitions(topic.store("in").message)
    assert "uint32 seq" in text and "=" * 80 not in text
    nested = read_description_text(
        "node: n\ndistro: noetic\nsubscribe:\n  /a: {type: geometry_msgs/Twist}\n"
    )
    text = definitions(nested.topics[0].store("in").message)
    assert text.split("\n" + "=" * 80 + "\n")[1].startswith("MSG: geometry_msgs/Vector3\n")
