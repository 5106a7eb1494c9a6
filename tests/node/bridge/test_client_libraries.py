"""What graphs ask rclpy and rospy for: both are played here by lists of calls."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from enum import Enum
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node import read_description_text
from firm_hdl.node.graphs import GraphError, graph_of, ros1
from firm_hdl.node.graphs.ros2 import RclpyGraph
from tests.frontend.workspace import make_files
from tests.live.peer import python_of
from tests.node.samples import LIBRARY

ROOT = Path(__file__).parents[3]

ROS2 = """\
node: echo
namespace: /robot
publish:
  said: {type: std_msgs/msg/String, reliability: best_effort, depth: 3}
  kept: {type: std_msgs/msg/String, durability: transient_local, depth: 1}
subscribe:
  heard: {type: std_msgs/msg/String, history: keep_all, depth: 7}
serve:
  cal: {type: robot_msgs/srv/Calibrate}
"""


def wait(condition, seconds=5.0):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.002)
    return condition()


class Policy(Enum):
    """The policies of rclpy, whose names are in capitals."""

    KEEP_LAST, KEEP_ALL, RELIABLE, BEST_EFFORT, VOLATILE, TRANSIENT_LOCAL = range(6)


class Context:
    """A context of rclpy."""

    def __init__(self):
        self.is_up, self.ends = False, 0

    def ok(self):
        return self.is_up

    def shutdown(self):
        self.is_up, self.ends = False, self.ends + 1


class Service:
    """A service of rclpy, which notes its responses."""

    def __init__(self, kind, sent):
        self.srv_type, self.sent = kind, sent

    def send_response(self, response, header):
        self.sent.append((response, header))


class Rclpy(ModuleType):
    """The module rclpy, with one node: it notes what is made, and what is sent."""

    def __init__(self):
        super().__init__("rclpy")
        self.context = SimpleNamespace(Context=Context)
        self.calls, self.made, self.sent, self.services = [], {}, [], {}
        self.executor_ends, self.destroyed = [], 0
        # What the graph has, by name and whether that is one on the wire.
        self.publishers, self.subscriptions = {}, {}

    def get_publishers_info_by_topic(self, name, no_mangle):
        return self.publishers.get((name, no_mangle), [])

    def get_subscriptions_info_by_topic(self, name, no_mangle):
        return self.subscriptions.get((name, no_mangle), [])

    def init(self, *, context, domain_id, signal_handler_options):
        context.is_up = True
        self.calls.append((domain_id, signal_handler_options))

    def create_node(self, name, *, context, **options):
        assert context.is_up
        self.calls.append((name, options))
        return self

    def create_publisher(self, kind, name, qos):
        self.made[name] = (kind, qos)
        return SimpleNamespace(publish=lambda packet: self.sent.append((name, packet)))

    def create_subscription(self, kind, name, take, qos, *, raw):
        self.made[name] = (kind, qos)
        self.take, self.is_raw = take, raw

    def create_service(self, kind, name, keep, *, qos_profile):
        self.keep = keep
        self.services[name] = Service(kind, self.sent)
        return self.services[name]

    def destroy_node(self):
        self.destroyed += 1

    def SingleThreadedExecutor(self, *, context):
        return SimpleNamespace(
            add_node=self.calls.append,
            spin_once=lambda timeout_sec: time.sleep(0.001),
            shutdown=lambda timeout_sec: self.executor_ends.append(timeout_sec),
        )


def module(name, **members):
    made = ModuleType(name)
    vars(made).update(members)
    return made


@pytest.fixture
def rclpy(monkeypatch):
    made = Rclpy()
    qos = {f"{name}Policy": Policy for name in ("History", "Reliability", "Durability")}
    calibrate = SimpleNamespace(Request="asked", Response="answer")
    modules = [
        made,
        module("rclpy.qos", QoSProfile=lambda **given: given, **qos),
        module("rclpy.executors", SingleThreadedExecutor=made.SingleThreadedExecutor),
        module(
            "rclpy.serialization",
            serialize_message=lambda message: message.encode(),
            deserialize_message=lambda packet, kind: (packet, kind),
        ),
        module("std_msgs.msg", String="String"),
        module("robot_msgs.srv", Calibrate=calibrate),
    ]
    for each in modules:
        monkeypatch.setitem(sys.modules, each.__name__, each)
    return made


def profile(history, depth, reliability, durability):
    policies = (history, reliability, durability)
    names = ("history", "reliability", "durability")
    return dict(zip(names, (Policy[each] for each in policies), strict=True)) | {"depth": depth}


def test_endpoints_of_rclpy_have_the_policies_of_their_topics(rclpy):
    graph = RclpyGraph(read_description_text(ROS2, library=LIBRARY), domain=0)
    graph.open(lambda *message: None)
    try:
        assert rclpy.made == {
            "/robot/said": ("String", profile("KEEP_LAST", 3, "BEST_EFFORT", "VOLATILE")),
            "/robot/kept": ("String", profile("KEEP_LAST", 1, "RELIABLE", "TRANSIENT_LOCAL")),
            # What comes waits for rclpy's thread.
            "/robot/heard": ("String", profile("KEEP_ALL", 4096, "RELIABLE", "VOLATILE")),
        }
        assert list(rclpy.services) == ["/robot/cal"]
        # Domain 0 is asked for, and signals stay those of the process.
        assert rclpy.calls[0] == (0, None)
        name, options = rclpy.calls[1]
        assert (name, options["namespace"]) == ("echo", "/robot")
        assert rclpy.calls[2] is rclpy
    finally:
        graph.close()


BURST = """\
import sys, time
import rclpy
from std_msgs.msg import String
from firm_hdl.node import read_description_text
from firm_hdl.node.graphs.ros2 import RclpyGraph

domain, got = int(sys.argv[1]), []
topics = "node: echo\\nsubscribe: {heard: {type: std_msgs/msg/String}}\\n"
graph = RclpyGraph(read_description_text(topics), domain=domain)
graph.open(lambda topic, packet, caller: got.append(packet))
rclpy.init(domain_id=domain)
publisher = rclpy.create_node("peer").create_publisher(String, "/heard", 1000)
while not publisher.get_subscription_count():
    time.sleep(0.01)
for number in range(500):
    publisher.publish(String(data=str(number)))
end = time.monotonic() + 30
while len(got) < 500 and time.monotonic() < end:
    time.sleep(0.01)
print(len(got))
graph.close()
"""


def test_a_burst_in_rclpy_comes_whole():
    """With rclpy itself, whose thread gets no time while the other side publishes."""
    folders = [str(ROOT), *(path for path in sys.path if path.endswith("site-packages"))]
    discovery = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    done = subprocess.run(
        [python_of("kilted"), "-c", BURST, str(os.getpid() % 200)],
        env={**os.environ, **discovery, "PYTHONPATH": os.pathsep.join(folders)},
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
    )
    assert done.stdout == "500\n", done.stderr


def test_messages_pass_rclpy_as_bytes_and_answers_find_their_callers(rclpy):
    got = []
    description = read_description_text(ROS2, library=LIBRARY)
    said, kept, heard, cal = description.topics
    graph = RclpyGraph(description)
    graph.open(lambda *message: got.append(message))
    try:
        assert graph.publish(kept, b"\1") and graph.publish(said, b"\2")
        assert rclpy.sent == [("/robot/kept", b"\1"), ("/robot/said", b"\2")]
        assert rclpy.is_raw
        rclpy.take(bytearray(b"\3"))
        # What the executor does for a request: the response comes later.
        service = rclpy.services["/robot/cal"]
        service.send_response(rclpy.keep("request", "response"), "header")
        assert got == [(heard, b"\3", None), (cal, b"request", "header")]
        assert graph.respond(cal, "header", b"\4")
        assert rclpy.sent[2:] == [((b"\4", "answer"), "header")]
        graph.check()
    finally:
        graph.close()
    assert (rclpy.destroyed, len(rclpy.executor_ends)) == (1, 1)
    with pytest.raises(GraphError, match=r"^rclpy was shut down$"):
        graph._call(print)
    graph.close()
    assert rclpy.destroyed == 1


def endpoint(kind, type_name, node="peer", **given):
    """What rclpy tells of an endpoint; words are policies."""
    forever = SimpleNamespace(nanoseconds=(1 << 63) - 1)
    policies = {"reliability": "RELIABLE", "durability": "VOLATILE", "liveliness": "AUTOMATIC"}
    policies |= {key: given.pop(key) for key in list(given) if key in policies}
    words = {key: SimpleNamespace(name=word) for key, word in policies.items()}
    return SimpleNamespace(
        endpoint_type=SimpleNamespace(name=kind),
        topic_type=type_name,
        node_name=node,
        node_namespace="/",
        endpoint_gid=[1, 2],
        qos_profile=SimpleNamespace(
            **words,
            deadline=given.pop("deadline", forever),
            liveliness_lease_duration=forever,
        ),
        **given,
    )


def test_peers_that_rclpy_finds_and_that_do_not_fit_are_told_once(rclpy):
    string, other = "std_msgs/msg/String", f"RIHS01_{64 * '0'}"
    rclpy.publishers = {
        ("/robot/heard", False): [
            endpoint("PUBLISHER", "std_msgs/msg/Bool"),
            endpoint("PUBLISHER", string),
            endpoint("PUBLISHER", string, reliability="BEST_EFFORT"),
            endpoint("PUBLISHER", string, topic_type_hash=other),
            # Its policies are not known.
            endpoint("PUBLISHER", string, reliability="UNKNOWN", topic_type_hash="INVALID"),
        ],
        ("rq/robot/calRequest", True): [
            endpoint("PUBLISHER", "a::srv::dds_::B_Request_", "_NODE_NAME_UNKNOWN_")
        ],
    }
    second = SimpleNamespace(nanoseconds=10**9)
    rclpy.subscriptions = {
        ("/robot/said", False): [
            endpoint("SUBSCRIPTION", string),
            endpoint("SUBSCRIPTION", string, durability="TRANSIENT_LOCAL", deadline=second),
        ],
    }
    graph = RclpyGraph(read_description_text(ROS2, library=LIBRARY))
    graph.open(lambda *message: None)
    try:
        graph.check()
        found = graph.news()
        unfit = "it with a QoS that does not fit, so no messages pass:"
        best_effort = "(best_effort is offered, and reliable asked for)"
        assert [line for line in found if "its type hash" not in line] == [
            f"/robot/said: node /peer subscribes to {unfit} reliability {best_effort}",
            f"/robot/said: node /peer subscribes to {unfit} reliability {best_effort}, durability "
            "(volatile is offered, and transient_local asked for), deadline",
            "/robot/heard: node /peer publishes 'std_msgs/msg/Bool', and the type here is "
            "'std_msgs/msg/String'; no messages pass",
            f"/robot/heard: node /peer publishes {unfit} reliability {best_effort}",
        ]
        (line,) = set(found) - {line for line in found if "its type hash" not in line}
        assert f"publishes another definition of '{string}': its type hash is {other}, " in line
        # Its node may be known soon.
        graph.check()
        assert graph.news() == [
            "/robot/cal: a peer calls 'a/srv/B', and the type here is 'robot_msgs/srv/Calibrate'; "
            "no messages pass"
        ]
        graph.check()
        assert not graph.news()
        # Not every middleware can tell.
        del rclpy.publishers
        graph.check()
    finally:
        graph.close()


def test_rclpy_that_ends_or_fails_is_told(rclpy, monkeypatch):
    description = read_description_text(ROS2, library=LIBRARY)
    said = description.topics[0]
    graph = RclpyGraph(description)
    graph.check()
    graph.open(lambda *message: None)
    graph._publishers[said.id] = SimpleNamespace(publish=lambda packet: 1 // 0)
    with pytest.raises(GraphError, match=r"^rclpy: .*division"):
        graph.publish(said, b"")
    graph._context.shutdown()
    assert wait(lambda: not graph._thread.is_alive())
    with pytest.raises(GraphError, match=r"^rclpy has ended$"):
        graph.check()
    with pytest.raises(GraphError, match=r"^rclpy was shut down$"):
        graph.publish(said, b"")
    graph.close()
    monkeypatch.setitem(sys.modules, "std_msgs.msg", module("std_msgs.msg"))
    with pytest.raises(UserError, match=r"no 'std_msgs/msg/String', which '/robot/said' needs; "):
        graph.open(lambda *message: None)
    graph.close()
    monkeypatch.setattr(rclpy, "create_node", None)
    with pytest.raises(GraphError, match=r"^rclpy: "):
        graph.open(lambda *message: None)
    graph.close()


ROS1 = """\
node: echo
namespace: /robot
distro: noetic
publish:
  said: {type: std_msgs/String, depth: 3}
  kept: {type: std_msgs/String, durability: transient_local, depth: 1}
subscribe:
  heard: {type: std_msgs/UInt8}
serve:
  reset: {type: std_srvs/SetBool}
"""
SET_BOOL = "bool data\n---\nbool success\nstring message\n"
# What `rosmsg md5` and `rossrv md5` print.
MD5 = {
    "std_msgs/String": "992ce8a1687cec8c8bd883ec73ca41d1",
    "std_msgs/UInt8": "7c8164229e7d2c17eb95e9231617fdee",
    "std_srvs/SetBool": "09fb03525b03e7ea1fd3992bafd87e16",
}


class Endpoint:
    """A publisher, subscriber or service of rospy."""

    def __init__(self, name, data_class, *handler, **options):
        self.name, self.data_class, self.options = name, data_class, options
        self.handler, self.sent, self.is_gone = handler, [], False
        if isinstance(data_class, type) and "_request_class" in vars(data_class):
            self.uri = "rosrpc://"

    def publish(self, message):
        self.sent.append(message._buff)

    def unregister(self):
        assert not hasattr(self, "uri")
        self.is_gone = True

    def shutdown(self, reason):
        self.is_gone = True


@pytest.fixture(scope="module")
def ros1_echo(tmp_path_factory):
    """The description of a node of ROS 1."""
    folder = make_files(tmp_path_factory.mktemp("src"), {"std_srvs/srv/SetBool.srv": SET_BOOL})
    return read_description_text(ROS1, paths=[folder])


@pytest.fixture
def rospy(monkeypatch):
    monkeypatch.setenv("ROS_NAMESPACE", "")
    monkeypatch.setattr(ros1, "_WATCH_SECONDS", 0.005)
    master = SimpleNamespace(pid=7, is_online=True, asked=0, types=[])
    made = []

    def process():
        master.asked += 1
        return master.pid

    def endpoint(*given, **options):
        made.append(Endpoint(*given, **options))
        return made[-1]

    rospy = module(
        "rospy",
        AnyMsg=type("AnyMsg", (), {"__slots__": ["_buff"]}),
        Publisher=endpoint,
        Subscriber=endpoint,
        Service=endpoint,
        ROSException=type("ROSException", (Exception,), {}),
        ServiceException=type("ServiceException", (Exception,), {}),
        get_name=lambda: "/robot/echo",
        names=[],
        endpoints=made,
        master=master,
    )
    rospy.init_node = lambda name, **options: rospy.names.append((name, options))
    rosgraph = module(
        "rosgraph",
        is_master_online=lambda: master.is_online,
        get_master_uri=lambda: "http://here",
        Master=lambda name: SimpleNamespace(getPid=process, getTopicTypes=lambda: master.types),
    )
    monkeypatch.setitem(sys.modules, "rospy", rospy)
    monkeypatch.setitem(sys.modules, "rosgraph", rosgraph)
    return rospy


def test_endpoints_of_rospy_have_the_policies_and_the_sums_of_their_topics(rospy, ros1_echo):
    graph = graph_of("ros1", ros1_echo)
    assert os.environ["ROS_NAMESPACE"] == "/robot"
    graph.open(lambda *message: None)
    graph.open(lambda *message: None)
    # A process can name its node once; whatever was made before is gone.
    assert rospy.names == [("echo", {"argv": [""], "disable_signals": True})]
    assert [each.is_gone for each in rospy.endpoints] == [True] * 4 + [False] * 4
    said, kept, heard, reset = rospy.endpoints[4:]
    names = [each.name for each in (said, kept, heard, reset)]
    assert names == [f"/robot/{name}" for name in ("said", "kept", "heard", "reset")]
    assert said.options == {"queue_size": 3, "latch": False, "tcp_nodelay": True}
    assert kept.options == {"queue_size": 1, "latch": True, "tcp_nodelay": True}
    assert heard.options == {"tcp_nodelay": True}
    for each in (said, kept, heard, reset):
        assert MD5[each.data_class._type] == each.data_class._md5sum
    parts = [reset.data_class._request_class, reset.data_class._response_class]
    kind = "std_srvs/SetBool"
    assert [each._type for each in parts] == [f"{kind}Request", f"{kind}Response"]
    graph.close()
    assert all(each.is_gone for each in rospy.endpoints)


def test_rospy_is_imported_when_its_namespace_is_set(rospy, ros1_echo, monkeypatch):
    # rospy reads the variable when it is imported, and never again.
    seen = []

    def import_module(name):
        seen.append((name, os.environ["ROS_NAMESPACE"]))
        return sys.modules[name]

    monkeypatch.setattr(ros1, "import_module", import_module)
    graph_of("ros1", ros1_echo)
    assert seen == [("rospy", "/robot"), ("rosgraph", "/robot")]


def test_messages_pass_rospy_as_bytes(rospy, ros1_echo):
    description = ros1_echo
    got = []
    graph = graph_of("ros1", description)
    graph.open(lambda *message: got.append(message))
    said, kept, heard, reset = rospy.endpoints
    assert graph.publish(description.topics[1], b"\1") and kept.sent == [b"\1"] and not said.sent
    heard.handler[0](SimpleNamespace(_buff=b"\2"))
    assert got.pop() == (description.topics[2], b"\2", None)

    def answer(topic, packet, caller):
        got.append((topic, packet))
        graph.respond(topic, caller, packet + b"!")

    graph.open(answer)
    reset = rospy.endpoints[-1]
    assert reset.handler[0](SimpleNamespace(_buff=b"\3"))._buff == b"\3!"
    assert got == [(description.topics[3], b"\3")]
    graph.close()
    with pytest.raises(GraphError, match=r"^rospy was shut down$"):
        graph.publish(description.topics[0], b"")


def test_a_board_without_an_answer_is_an_error_of_the_service(rospy, ros1_echo, monkeypatch):
    monkeypatch.setattr(ros1, "_ANSWER_SECONDS", 0.01)
    graph = graph_of("ros1", ros1_echo)
    for take in (lambda *message: None, lambda topic, packet, caller: graph.abandon(topic, caller)):
        graph.open(take)
        with pytest.raises(rospy.ServiceException, match=r"^the board did not answer$"):
            rospy.endpoints[-1].handler[0](SimpleNamespace(_buff=b""))
    graph.close()


def test_a_topic_that_others_have_with_another_type_is_told(rospy, ros1_echo):
    graph = graph_of("ros1", ros1_echo)
    # `*` is what a master has of a subscription to any type.
    rospy.master.types = [["/robot/said", "a/B"], ["/robot/kept", "*"], ["/robot/reset", "a/B"]]
    graph.open(lambda *message: None)
    try:
        assert wait(lambda: rospy.master.asked > 1)
        assert graph.news() == [
            "/robot/said: another node has it with the type 'a/B', and the type here is "
            "'std_msgs/String'; no messages pass"
        ]
    finally:
        graph.close()


def test_a_master_that_is_gone_or_another_is_told(rospy, ros1_echo):
    graph, master = graph_of("ros1", ros1_echo), rospy.master
    master.is_online = False
    with pytest.raises(GraphError, match=r"^no master at http://here$"):
        graph.open(lambda *message: None)
    master.is_online = True
    for pid, problem in ((8, "has started again"), (None, "does not answer")):
        graph.open(lambda *message: None)
        asked = master.asked
        assert wait(lambda start=asked: master.asked > start + 1)
        graph.check()
        if pid is None:
            del master.pid
        else:
            master.pid = pid
        assert wait(lambda: graph._problem)
        with pytest.raises(GraphError, match=f"^the master {problem}"):
            graph.check()
    graph.close()
