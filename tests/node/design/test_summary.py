"""The summary of a node: figures that follow from its description, written down by hand."""

from __future__ import annotations

import pytest

from firm_hdl.estimates import estimates_of
from firm_hdl.node import read_description_text
from firm_hdl.node.summary import facts_of, summary
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.node.samples import read

ROS_1 = """\
node: n
distro: noetic
bus_bytes: 4
clock_mhz: 62.5
link: udp
subscribe:
  /a: {type: geometry_msgs/Vector3, rate_hz: 1000000}
  /b: {type: geometry_msgs/Vector3, rate_hz: 2000000}
publish:
  /c: {type: geometry_msgs/Vector3}
"""


def rows_of(text):
    return [line.split() for line in text.splitlines() if line[:1].isdigit()]


def test_the_head_of_a_node_of_ros_1():
    # 9 counters of the link, 3 of the node, 11 of each subscription and 6 of the publication.
    lines = summary(read_description_text(ROS_1)).splitlines()
    assert lines[0] == "/n: noetic, ros1, 32-bit bus, 62.5 MHz"
    assert lines[1] == (
        "link udp: memory_bytes 1024, packets 16, datagram_bytes 1472, data_bytes 1, port 7411, "
        "host_port 7411"
    )
    assert lines[2].startswith("fingerprint ") and lines[2].endswith(", 40 counters")
    host = ROS_1.replace("link: udp", "link: {kind: udp, host: 10.0.0.7, host_port: 9}")
    assert (
        summary(read_description_text(host))
        .splitlines()[1]
        .endswith(", port 7411, host 10.0.0.7, host_port 9")
    )
    stream = ROS_1.replace("link: udp", "namespace: /r")
    assert summary(read_description_text(stream)).splitlines()[:2] == [
        "/r/n: noetic, ros1, 32-bit bus, 62.5 MHz",
        "link stream",
    ]


def test_rates_add_up_to_a_clock():
    text = summary(read_description_text(ROS_1))
    # Three numbers of 8 bytes are 6 beats of 4 bytes, and as many cycles.
    common = ["geometry_msgs/Vector3", "24", "64"]
    assert rows_of(text) == [
        ["1", "subscribe", "/a", *common, "drop", "6", "1e+06", "Hz", "6", "MHz"],
        ["2", "subscribe", "/b", *common, "drop", "6", "2e+06", "Hz", "12", "MHz"],
        ["3", "publish", "/c", *common, "wait", "6", "-", "-"],
    ]
    assert "clock for all stated rates on one link: 18 MHz\n" in text


def test_sizes_of_messages():
    sizes = {(row[0], row[1]): row[4] for row in rows_of(summary(read()))}
    assert sizes == {
        ("1", "subscribe"): "52",
        ("2", "subscribe"): "9-",
        ("3", "publish"): "28",
        ("4", "request"): "28-",
        ("4", "response"): "12-76",
    }


def test_a_clock_is_that_of_cycles_not_of_beats():
    (topic,) = facts_of(
        read("node: n\nsubscribe: {/a: {type: std_msgs/msg/UInt8MultiArray, rate_hz: 10}}\n")
    )["topics"]
    store = topic["packets"]["in"]
    # An array without elements has three lengths in two beats.
    assert store["cycles"]["cycles"] > store["cycles"]["beats"]
    assert store["clock_hz"] == 10 * store["cycles"]["cycles"]


def test_packets_are_no_longer_than_the_limit_of_the_topic():
    text = "node: n\nsubscribe: {/a: {type: std_msgs/msg/String, max_message_bytes: 20}}\n"
    store = facts_of(read(text))["topics"][0]["packets"]["in"]
    assert store["cycles"]["bytes"] <= 20 and store["max_message_bytes"] == 20


def test_areas_are_those_of_the_converter_of_each_direction():
    text = "node: n\n{}: {{/a: {{type: geometry_msgs/msg/Twist}}}}\n"
    for kind, part in (("subscribe", "deserializer"), ("publish", "serializer")):
        description = read(text.format(kind))
        ((_, made),) = description.topics[0].stores
        plan = build_plan(
            lay_out(made.message, "cdr"), bus_bytes=8, max_message_bytes=made.max_message_bytes
        )
        wanted, (topic,) = estimates_of(plan)[part], facts_of(description)["topics"]
        (store,) = topic["packets"].values()
        assert (store["estimate"]["lut"], store["estimate"]["ff"]) == (wanted.lut, wanted.ff)


BEYOND = """\
node: n
link: {kind: KIND}
clock_mhz: 2
subscribe:
  /a: {type: geometry_msgs/msg/Twist, rate_hz: 200}
  /b: {type: geometry_msgs/msg/Twist, rate_hz: 300000}
  /c: {type: std_msgs/msg/String, memory_bytes: 64}
publish:
  /d: {type: builtin_interfaces/msg/Time, rate_hz: 1}
serve:
  /e: {type: robot_msgs/srv/Calibrate, memory_bytes: 64}
"""


@pytest.mark.parametrize(
    ("kind", "link"),
    [
        # Frames have a header of 16 bytes, and on a line 7 bytes more.
        ("uart, baud: 100000", "22,515,000 bytes/s to the node, and the link carries 10,000 (100"),
        ("udp", "20,413,600 bytes/s to the node, and the link carries 2,000,000 (1 bytes per"),
        ("udp, data_bytes: 16", ""),
        ("stream", "20,413,600 bytes/s to the node, and the link carries 16,000,000 (8 bytes"),
    ],
)
def test_what_a_node_cannot_carry_is_a_warning(kind, link):
    found = summary(read(BEYOND.replace("KIND", kind))).splitlines()
    warnings = [line.removeprefix("warning: ") for line in found if line.startswith("warning: ")]
    assert warnings.pop(0) == "/b: a rate of 300000 Hz needs a clock of 2.1 MHz"
    if link:
        assert f"/a at 200 Hz, /b at 300000 Hz: at least {link}" in warnings.pop(0)
    assert warnings == [
        "/e (out): a message has up to 76 bytes, and the memory has room for 64; larger ones are "
        "dropped",
        "larger messages are dropped, and the types set no limit: /c over 64 bytes, /e (in) over "
        "64 bytes",
    ]


def test_a_memory_of_the_link_limits_what_comes():
    link = "{kind: udp, memory_bytes: 64}"
    text = summary(read(BEYOND, link=link))
    assert "/a: a message has up to 52 bytes, and the link has room for 48" in text
    assert "/c over 48 bytes" in text
    # A message has 65,536 frames at most.
    few = "{kind: udp, datagram_bytes: 32}"
    large = "node: n\nsubscribe: {/a: {type: std_msgs/msg/String, memory_bytes: 4194304}}\n"
    assert "/a over 1048576 bytes" in summary(read(large, link=few))


WRITTEN_OUT = """\
node: tiny
namespace: /r
distro: jazzy
bus_bytes: 4
clock_mhz: 62.5
link: {kind: uart, baud: 500000, packets: 3, memory_bytes: 2048}
accelerator: a.b:C
subscribe:
  in: {type: std_msgs/msg/String, port: p, reliability: best_effort, history: keep_all, depth: 7,
    durability: transient_local, memory_bytes: 512, packets: 5, max_message_bytes: 300, rate_hz: 20}
publish:
  /out: {type: std_msgs/msg/UInt16, when_full: drop}
"""
OF_THE_NODE = {
    "node": "tiny",
    "namespace": "/r",
    "distro": "jazzy",
    "wire": "cdr",
    "bus_bytes": 4,
    "clock_hz": 62.5e6,
    "link": {"kind": "uart", "memory_bytes": 2048, "packets": 3, "baud": 500_000},
    "accelerator": "a.b:C",
}
HEADER = [(1, "version"), (1, "flags"), (2, "topic"), (4, "length"), (4, "tag")]
HEADER += [(2, "sequence"), (2, "fragment")]
OF_TOPICS = [
    {
        "id": 1,
        "kind": "subscribe",
        "name": "/r/in",
        "type": "std_msgs/msg/String",
        "port": "p",
        "rate_hz": 20.0,
        "qos": {
            "reliability": "best_effort",
            "durability": "transient_local",
            "history": "keep_all",
            "depth": 7,
        },
    },
    {
        "id": 2,
        "kind": "publish",
        "name": "/out",
        "type": "std_msgs/msg/UInt16",
        "port": "out",
        "rate_hz": None,
        "qos": {
            "reliability": "reliable",
            "durability": "volatile",
            "history": "keep_last",
            "depth": 10,
        },
    },
]
OF_PACKETS = [
    # 4 bytes of encapsulation, a length, and the 0 at the end of the text.
    {
        "message": "std_msgs/msg/String",
        "min_bytes": 9,
        "max_bytes": None,
        "memory_bytes": 512,
        "stored_packets": 5,
        "when_full": "drop",
        "max_message_bytes": 300,
    },
    {
        "message": "std_msgs/msg/UInt16",
        "min_bytes": 6,
        "max_bytes": 6,
        "memory_bytes": 64,
        "stored_packets": 16,
        "when_full": "drop",
        "max_message_bytes": 64,
    },
]


def part(whole, like):
    return {key: whole[key] for key in like}


def test_what_a_host_has_to_know_of_a_node():
    """The manifest has the same."""
    description = read(WRITTEN_OUT)
    facts = facts_of(description)
    assert part(facts, OF_THE_NODE) == OF_THE_NODE
    assert len(facts["fingerprint"]) == 16
    assert int(facts["fingerprint"], 16) == description.fingerprint
    assert facts["frame"]["version"] == 0xF1
    assert [(each["bytes"], each["name"]) for each in facts["frame"]["header"]] == HEADER
    for found, topic, packets, way in zip(
        facts["topics"], OF_TOPICS, OF_PACKETS, ("in", "out"), strict=True
    ):
        assert part(found, topic) == topic
        assert list(found["packets"]) == [way]
        assert part(found["packets"][way], packets) == packets
    hashes = [topic.definition_hash for topic in description.topics]
    assert [each["definition_sha256"] for each in facts["topics"]] == hashes
    numbered = {
        each["number"]: (each["owner"], each["part"], each["name"]) for each in facts["registers"]
    }
    # Nine counters of the link and three of the node lie before those of topics.
    assert numbered[1] == ("node", "identity", "fingerprint_low")
    assert numbered[16 + 9] == ("node", "node", "unknown")
    assert numbered[16 + 12 + 1] == ("/r/in", "in", "truncated")
    assert numbered[16 + 12 + 11 + 1] == ("/out", "out", "aborted")
