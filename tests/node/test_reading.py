"""Descriptions of nodes: what they mean, and the place of every mistake."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.node import TopicQos, read_description, read_description_text
from firm_hdl.node.names import expand
from tests.frontend.recordings import record
from tests.frontend.workspace import make_files
from tests.node.samples import LIBRARY, PACKAGES, WHEELS, read


def error_of(text, **options):
    with pytest.raises(DefinitionError) as caught:
        read_description_text(text, **({"library": LIBRARY} | options))
    return str(caught.value)


def body(**topics):
    lines = [f"  {name}: {{{options}}}" for name, options in topics.items()]
    return "\n".join(["node: n", "subscribe:", *lines, ""])


def test_a_description_is_completed():
    node = read()
    assert (node.node, node.namespace, node.distro, node.wire) == (
        "wheels",
        "/robot",
        "jazzy",
        "cdr",
    )
    assert (node.bus_bytes, node.clock_hz, node.accelerator) == (8, 100e6, "")
    assert [(t.id, t.kind, t.name, t.port) for t in node.topics] == [
        (1, "subscribe", "/cmd_vel", "cmd_vel"),
        (2, "subscribe", "/robot/names", "robot_names"),
        (3, "publish", "/robot/odom", "robot_odom"),
        (4, "serve", "/robot/wheels/calibrate", "robot_wheels_calibrate"),
    ]
    assert node.topics[1].qos == TopicQos(reliability="best_effort", depth=5)
    assert [topic.name for topic in node.of_kind("publish")] == ["/robot/odom"]
    assert [topic.id for topic, _ in node.received()] == [1, 2, 4]
    assert [store.message.base_name for _, store in node.sent()] == [
        "Vector3",
        "Calibrate_Response",
    ]


def test_ids_are_places_in_the_text():
    other = WHEELS.replace("publish:", "was:").replace("subscribe:", "publish:")
    turned = read(other.replace("was:", "subscribe:"))
    assert [(t.id, t.kind) for t in turned.topics[:3]] == [
        (1, "publish"),
        (2, "publish"),
        (3, "subscribe"),
    ]


def test_remapping_replaces_complete_names():
    node = read(remap="{odom: /wheel/odom}")
    assert [t.name for t in node.of_kind("publish")] == ["/wheel/odom"]
    assert node.of_kind("publish")[0].written == "odom"


def test_names_are_completed_as_ros_does():
    assert expand("a/b", "/", "n") == "/a/b"
    assert expand("~/b", "/r/s", "n") == "/r/s/n/b"
    assert expand("/b", "/r", "n") == "/b"
    assert expand("~/b", "/", "n") == "/n/b"
    assert expand("b", "/r", "n") == "/r/b"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "1:1: error: a description must not be empty"),
        ("- x", "1:1: error: a description must be a mapping of names to values, not a list"),
        ("a: [", "1:5: error: not YAML"),
        ("[" * 99_999, "1:101: error: not a description: nested too deep\n[[["),
        ('"\\UFFFFFFFF"', "1:4: error: not YAML: a number is out of range"),
        (f"%YAML {'1' * 5000}.1\n---\n", "1:7: error: not YAML: a number is out of range"),
        ("node: \x01", "1:7: error: not YAML: special characters are not allowed"),
        ("node: !!python/name:os.system ''", "1:7: error: 'node' must be text"),
        ("&a {node: *a}", "error: 'node' must be text, not a mapping"),
        ("node: n\n<<: {bus_bytes: 8}", "2:1: error: a key must be text, not a merge key; write"),
        ("nod: x", "1:1: error: a description has no 'nod'; did you mean 'node'?"),
        ("bus_bytes: 8", "1:1: error: a description needs a 'node'"),
        ("node: x", "1:1: error: a node needs a topic: subscribe, publish, serve"),
        ("bus_bytes: 8\nnode:", "2:1: error: 'node' must be text, not empty"),
        ("node: a-b", "1:7: error: the name of a node has letters, digits and '_' only, not '-'"),
        ("node: 3a", "1:7: error: the name of a node does not start with a digit"),
        ("node: a\nnamespace: x", "2:12: error: a namespace starts with '/'"),
        ("node: a\nnamespace: /x/", "2:12: error: a namespace does not end with '/'"),
        ("node: a\nbus_bytes: 32", "2:12: error: 'bus_bytes' must be 1, 2, 4, 8 or 16, not 32"),
        (
            "node: a\nregisters: axi",
            "2:12: error: 'registers' must be 'axi4lite' or 'csr', not 'axi'",
        ),
        ("node: a\nregisters: true", "2:12: error: 'registers' must be text, not a boolean"),
        ("node: a\nbus_bytes: 3", "2:12: error: 'bus_bytes' must be 1, 2, 4, 8 or 16, not 3"),
        ("node: a\nbus_bytes: 0", "2:12: error: 'bus_bytes' must be at least 1, not 0"),
        ("node: a\nbus_bytes: !!int ''", "2:12: error: 'bus_bytes' must be an integer, not ''"),
        ("node: a\nbus_bytes: !!int '-'", "2:12: error: 'bus_bytes' must be an integer, not '-'"),
        ("node: a\nbus_bytes: !!int x", "2:12: error: 'bus_bytes' must be an integer, not 'x'"),
        (f"node: a\nbus_bytes: 0x{'f' * 5000}", "2:12: error: 'bus_bytes' must be an integer, not"),
        (f"node: a\nbus_bytes: {'9' * 5000}", "2:12: error: 'bus_bytes' must be an integer, not"),
        (f"node: a\nclock_mhz: {'1:' * 999}1.0", "2:12: error: 'clock_mhz' must be a number, not"),
        ("node: a\nclock_mhz: !!float ''", "2:12: error: 'clock_mhz' must be a number, not ''"),
        ("node: a\nclock_mhz: !!binary QQ==", "must be a number, not a value with a tag"),
        (
            "node: a\nclock_mhz: !!timestamp x",
            "2:12: error: 'clock_mhz' must be a number, not a da",
        ),
        ('node: a\ndistro: "\\ud800"', "or 'lyrical', not '\\ud800'"),
        ("node: a\nnode: b", "2:1: error: 'node' is already in line 1"),
        ("node: a\ndistro: humbel", "did you mean 'humble'?"),
        ("node: a\nclock_mhz: 0", "2:12: error: 'clock_mhz' must be from 1 to 1000, not 0"),
        ("node: a\nlink: tcp", "'link' must be 'stream', 'axi_dma', 'udp', 'uart' or 'rtps'"),
        (
            "node: a\nlink: {baud: 1}",
            "2:1: error: 'link' needs a 'kind': stream, axi_dma, udp, uart, rtps",
        ),
        ("node: a\nlink: rtps", "2:1: error: a link of kind 'rtps' needs an 'address', the IPv4"),
        (
            "node: a\nlink: {kind: rtps, address: 224.0.0.1}",
            "2:29: error: '224.0.0.1' is no address of one host",
        ),
        (
            "node: a\nlink: {kind: rtps, address: 10.0.0.9, static_peers: [10.0.0.1, b]}",
            "error: 'b' is not an IPv4 address",
        ),
        (
            "node: a\nlink: {kind: rtps, address: 10.0.0.9, domain: 232, participant: 99}",
            "error: domain 232 has no UDP ports for participant 99",
        ),
        ("node: a\nlink: {kind: udp, baud: 1}", "a link of kind 'udp' has no 'baud'; keys are mem"),
        ("node: a\nlink: {kind: stream, baud: 1}", "a link of kind 'stream' has no 'baud'\nlink"),
        ("node: a\nlink: {kind: udp, host_port: 1}", "'host_port' counts only beside a 'host'"),
        ("node: a\nlink: {kind: udp, datagram_bytes: 1000}", "a multiple of 16, such as 992"),
        ("node: a\nclock_mhz: .nan", "2:12: error: 'clock_mhz' must be from 1 to 1000, not .nan"),
        ("node: a\nclock_mhz: .inf", "2:12: error: 'clock_mhz' must be from 1 to 1000, not .inf"),
        (
            "remap: {/scam: /c}\n" + body(**{"/scan": "type: std_msgs/msg/Bool"}),
            "1:9: error: no topic has the name '/scam'; did you mean '/scan'?",
        ),
        ("node: a\nremap: {/a//b: /b}", "2:9: error: the name of a topic has no '//'"),
        ("node: a\nsubscribe:", "'subscribe' must be a mapping of names to values, not empty"),
        (body(a=""), "3:3: error: 'a' has no 'type'"),
        (body(a="type: 3"), "3:13: error: 'type' must be text, not an integer (3)"),
        (body(a="type: std_msgs/msg/Strin"), "did you mean 'std_msgs/msg/String'"),
        (body(a="type: robot_msgs/srv/Calibrate"), "is a service, and a topic has a message; put"),
        (body(a="type: std_msgs/msg/Bool, dept: 3"), "'subscribe' has no 'dept'; did you mean"),
        (body(a="type: std_msgs/msg/Bool, reliability: reliabl"), "did you mean 'reliable'?"),
        (body(a="type: std_msgs/msg/Bool, memory_bytes: 8"), "from 16 to 67108864, not 8"),
        (body(a="type: nav_msgs/msg/Odometry, memory_bytes: 64"), "bytes at least, and the memory"),
        (body(a="type: std_msgs/msg/Bool, port: a__b"), "'a__b' cannot be the name of a port"),
        (body(**{"a/{node}": "type: std_msgs/msg/Bool"}), "has no substitutions"),
        (body(**{"~a": "type: std_msgs/msg/Bool"}), "'~' is followed by '/'"),
        ("node: a\nserve: {a: {type: std_msgs/msg/Bool}}", "is a message, and a service is served"),
    ],
)
def test_a_mistake_is_reported_at_its_place(text, message):
    text_of_error = error_of(text)
    assert message in text_of_error
    assert text_of_error.startswith("<description>:")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- x", "1:1: error: a description must be a mapping of names to values, not a list"),
        (
            "node: n\nsubscribe: {/a: std_msgs/msg/Bool}",
            "2:17: error: '/a' must be a mapping of names to values, such as "
            "{type: std_msgs/msg/Bool}, not text",
        ),
        ("node: n\npaths: ./nowhere\n" + body(a="type: x/y")[8:], "2:8: error: 'nowhere' is not a"),
        ('node: n\npaths: "\\0"', "2:8: error: '\\x00' is not a path"),
        ('node: n\nbags: ["\\ud800"]', "2:7: error: '\\ud800' is not a path"),
    ],
)
def test_a_mistake_has_one_message(text, message):
    found = error_of(text, library=None)
    assert found.count("error: ") == 1 and message in found


def test_many_names_and_remappings_take_no_minutes():
    text = body(**{f"/arm/of/robot/joint_{n}": "type: std_msgs/msg/Bool" for n in range(800)})
    remap = "".join(f"  /arm/of/robot/join_{n}: /x{n}\n" for n in range(1000))
    found = error_of(f"{text}remap:\n{remap}")
    assert found.count("no topic has the name '/arm/of/robot/join_") == 1000


def test_what_many_topics_share_is_not_reported_without_an_end():
    keys = ", ".join(f"key_{n}: 1" for n in range(1000))
    topics = ", ".join(f"t_{n}: *all" for n in range(1000))
    found = error_of(f"node: n\nserve: {{a: &all {{{keys}}}}}\npublish: {{{topics}}}")
    assert "too many errors; the rest of the description was not checked" in found
    assert found.count("has no 'key_") <= 1000


def test_a_message_is_short_whatever_it_quotes():
    name, number = "k" * 100_000, "1" * 100_000
    assert len(error_of(f"? {name}\n: *{name}")) < 2000
    assert len(error_of(f"node: n\n? {name}\n: 1\n")) < 2000
    assert len(error_of(f"node: {number}\n")) < 2000


def test_ros_1_has_rules_of_its_own():
    noetic = Library("noetic")
    topic = "subscribe: {a: {type: std_msgs/Bool, %s}}"
    text = error_of("node: _a\n" + topic % "reliability: reliable", library=noetic)
    assert "the name of a node starts with a letter in ROS 1" in text
    assert "ROS 1 has no 'reliability'" in text
    text = error_of("node: a\nnamespace: /_b\n" + topic % "depth: 3", library=noetic)
    assert "2:12: error: a namespace starts with a letter in ROS 1" in text
    node = read_description_text("node: a\n" + topic % "depth: 3", library=noetic)
    assert (node.wire, node.topics[0].qos.depth) == ("ros1", 3)


def test_all_mistakes_come_at_once_with_carets():
    text = WHEELS.replace("Twist", "Twits").replace("depth: 5", "depth: five")
    assert error_of(text).splitlines()[1::3] == [
        "  /cmd_vel: {type: geometry_msgs/msg/Twits, rate_hz: 50}",
        "  names: {type: std_msgs/msg/String, reliability: best_effort, depth: five, "
        "memory_bytes: 256}",
    ]


def test_a_mistake_in_a_definition_keeps_its_own_place(tmp_path):
    (tmp_path / "own" / "msg").mkdir(parents=True)
    (tmp_path / "own" / "msg" / "Bad.msg").write_text("int33 x\n")
    (tmp_path / "node.yaml").write_text(
        "node: a\npaths: [own]\npublish: {x: {type: own/msg/Bad}}\n"
    )
    with pytest.raises(DefinitionError, match=r"Bad\.msg:1:1: error: .*int33"):
        read_description(tmp_path / "node.yaml")


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(DefinitionError, match=r"cannot read '.*none\.yaml': No such file"):
        read_description(tmp_path / "none.yaml")
    with pytest.raises(DefinitionError, match="it is a folder, not a regular file"):
        read_description(tmp_path)
    (tmp_path / "latin.yaml").write_bytes(b"# \xc3\xa4\nnode: \xe4")
    with pytest.raises(DefinitionError, match=r"latin\.yaml:2:7: error: byte 0xe4 is not UTF-8"):
        read_description(tmp_path / "latin.yaml")
    (tmp_path / "wide.yaml").write_text("node: a\n", encoding="utf-16")
    with pytest.raises(DefinitionError, match=r"wide\.yaml:1:1: error: byte 0xff is not UTF-8"):
        read_description(tmp_path / "wide.yaml")
    (tmp_path / "marked.yaml").write_text("nod: a\n", encoding="utf-8-sig")
    with pytest.raises(
        DefinitionError, match=r"marked\.yaml:1:1: error: .*'nod'.*\nnod: a\n\^\^\^"
    ):
        read_description(tmp_path / "marked.yaml")
    (tmp_path / "far.yaml").write_text("node: a\npaths: [nowhere]\n")
    with pytest.raises(DefinitionError, match=r"far\.yaml:2:8: error: '.*nowhere' is not a folder"):
        read_description(tmp_path / "far.yaml")


def test_paths_are_relative_to_the_file(tmp_path):
    (tmp_path / "p").symlink_to(PACKAGES)
    (tmp_path / "node.yaml").write_text(
        "node: a\npaths: p\n" + "publish: {w: {type: robot_msgs/Wheel}}"
    )
    assert read_description(tmp_path / "node.yaml").topics[0].type == "robot_msgs/msg/Wheel"


def test_recordings_are_read_from_beside_the_file(tmp_path):
    record(tmp_path / "run.mcap", "own_msgs/msg/Level", "uint16 litres\n")
    file = tmp_path / "node.yaml"
    file.write_text("node: a\nbags: run.mcap\npublish: {x: {type: own_msgs/Level}}\n")
    (topic,) = read_description(file).topics
    assert [field.name for field in topic.store("out").message.fields] == ["litres"]
    # What a recording lacks comes from folders.
    more = "distro: jazzy\npublish: {x: {type: own_msgs/Level}, y: {type: robot_msgs/Wheel}}\n"
    file.write_text(f"node: a\nbags: run.mcap\n{more}")
    assert len(read_description(file, paths=[PACKAGES]).topics) == 2
    file.write_text(f"node: a\nbags: run.mcap\npaths: '{PACKAGES}'\n{more}")
    assert len(read_description(file).topics) == 2
    file.write_text(f"node: a\nbags: run.mcap\n{more}")
    hint = (
        r":4:48: error: package 'robot_msgs' .* lack it: name a folder that has it with 'paths'; "
    )
    with pytest.raises(DefinitionError, match=hint):
        read_description(file)
    file.write_text(f"node: a\nbags: run.mcap\npaths: far\n{more}")
    with pytest.raises(DefinitionError, match=r"node\.yaml:3:8: error: .*far' is not a folder"):
        read_description(file)
    file.write_text("node: a\npublish: {}\nbags: [run.mcap, far.mcap]\n")
    with pytest.raises(DefinitionError, match=r"node\.yaml:3:7: error: .*far\.mcap"):
        read_description(file)


def test_the_distribution_is_that_of_the_library():
    text = "node: n\npublish: {a: {type: std_msgs/msg/Bool}}\ndistro: "
    assert "3:9: error: the types are those of jazzy" in error_of(text + "humble")
    assert read_description_text(text + "jazzy", library=LIBRARY).distro == "jazzy"


@given(st.data())
def test_damaged_texts_give_errors_and_no_tracebacks(data):
    text = list(WHEELS)
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(text) - 1))
        text[at] = data.draw(
            st.sampled_from(["", "\t", ":", "{", "}", "'", "\n", "#", "0", "~", "&a ", "\x85"])
        )
    try:
        read_description_text("".join(text), library=LIBRARY)
    except DefinitionError as error:
        assert "error: " in str(error)


def test_the_page_quotes_a_description_that_is_right():
    docs = PACKAGES.parent
    text = (docs / "nodes" / "wheels.yaml").read_text(encoding="utf-8")
    assert f"```yaml\n{text}```" in (docs / "reference" / "node.md").read_text(encoding="utf-8")
    assert len(read_description(docs / "nodes" / "wheels.yaml").topics) == 4


@pytest.mark.parametrize(
    ("link", "topic", "memory"),
    [
        ("udp", "", 1024),
        ("udp", ", memory_bytes: 4096", 4096),
        ("{kind: udp, port: 77}", "", 1024),
        ("{kind: udp, port: 77}", ", memory_bytes: 4096", 4096),
        ("{kind: udp, memory_bytes: 64}", ", memory_bytes: 4096", 64),
    ],
)
def test_memory_of_a_link_is_that_of_the_largest_topic_behind_it(link, topic, memory):
    topics = body(a="type: std_msgs/msg/Bool", b=f"type: std_msgs/msg/Char{topic}")
    node = read_description_text(f"{topics}link: {link}", library=LIBRARY)
    assert node.link.memory_bytes == memory


def test_a_topic_has_packets_in_its_own_direction_alone():
    node = read()
    has = {t.kind: [t.has(way) for way in ("in", "out")] for t in node.topics}
    assert has == {"subscribe": [True, False], "publish": [False, True], "serve": [True, True]}
    # So a node that only publishes has no memory to hold what comes.
    published = "node: n\nlink: udp\npublish: {a: {type: std_msgs/msg/Bool}}"
    assert read_description_text(published, library=LIBRARY).link.memory_bytes == 1 << 14


@pytest.mark.parametrize("kind", ["stream", "axi_dma", "udp"])
def test_a_link_that_loses_nothing_can_be_held_by_a_subscription(kind):
    text = body(a="type: std_msgs/msg/Bool, when_full: wait") + f"link: {kind}"
    if kind == "udp":
        assert "cannot be held" in error_of(text)
        return
    (topic,) = read_description_text(text, library=LIBRARY).topics
    assert topic.store("in").when_full == "wait"


SUBSCRIBED = "subscribe: {a: {type: std_msgs/msg/Bool}}\n"


@pytest.mark.parametrize(
    ("kind", "name", "least", "most", "step"),
    [
        ("udp", "memory_bytes", 64, 1 << 26, 0),
        ("udp", "packets", 1, 4096, 1),
        ("udp", "datagram_bytes", 32, 65_504, 16),
        ("axi_dma", "buffer_bytes", 32, 65_520, 16),
        ("udp", "port", 1, 65_535, 1),
        ("uart", "packets", 1, 4096, 1),
    ],
)
def test_options_of_a_link(kind, name, least, most, step):
    def link(value):
        return described(f"node: n\nlink: {{kind: {kind}, {name}: {value}}}\n{SUBSCRIBED}").link

    for value in (least, most):
        assert getattr(link(value), name) == value
    for value in (least - step if step else least // 2, most + step if step else most * 2):
        with pytest.raises(DefinitionError, match=f":2:.*error: '{name}' must be"):
            link(value)


def test_a_host_of_a_link():
    text = "node: n\nlink: {kind: udp, host: 10.1.2.3, host_port: %s}\n" + SUBSCRIBED
    for port in (1, 65_535):
        link = described(text % port).link
        assert (link.host, link.host_port, link.port) == ("10.1.2.3", port, 7411)
    for port in (0, 65_536):
        with pytest.raises(DefinitionError, match="'host_port' must be from 1 to 65535"):
            described(text % port)


PINS = {
    "ethernet": "gmii",
    "mac": "'02:00:00:00:00:01'",
    "address": "192.168.1.50/24",
    "gateway": "192.168.1.1",
}


def ethernet(mhz=125, **options):
    """Return a description whose link has pins, with other options, or without those of `None`."""
    given = {name: value for name, value in {**PINS, **options}.items() if value is not None}
    text = ", ".join(f"{name}: {value}" for name, value in given.items())
    return f"node: n\nclock_mhz: {mhz}\nlink: {{kind: udp, {text}}}\n{SUBSCRIBED}"


def test_a_link_with_the_pins_of_a_phy():
    link = described(ethernet()).link
    assert (link.ethernet, link.mac) == ("gmii", "02:00:00:00:00:01")
    assert (link.address, link.gateway) == ("192.168.1.50/24", "192.168.1.1")
    assert link.has_ethernet
    assert described(ethernet(mhz=25, ethernet="mii", gateway=None)).link.gateway == ""
    none = dict.fromkeys(("mac", "address", "gateway"))
    assert not described(ethernet(mhz=100, ethernet="stream", **none)).link.has_ethernet


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"ethernet": "rgmi"}, "3:29: error: 'ethernet' must be 'stream', 'gmii', 'rgmii' or"),
        ({"ethernet": "stream"}, "'mac' counts only beside an 'ethernet' with pins"),
        ({"ethernet": None}, "'gateway' counts only beside an 'ethernet' with pins"),
        ({"mhz": 24}, "3:29: error: 'ethernet: gmii' needs a 'clock_mhz' of 25 at least"),
        ({"mac": None}, "3:19: error: 'ethernet: gmii' needs 'mac', such as"),
        ({"address": None}, "3:19: error: 'ethernet: gmii' needs 'address', such as"),
        ({"mac": "10:20:30:40:50:59"}, "'mac' must be text, not a"),
        ({"mac": "'02:00:00:00:01'"}, "'02:00:00:00:01' is no address of Ethernet"),
        ({"mac": "'03:00:00:00:00:01'"}, "is the address of a group"),
        ({"mac": "'00:00:00:00:00:00'"}, "is no address that a machine can have"),
        ({"address": "192.168.1.50"}, "does not say how many bits are the network's"),
        ({"address": "192.168.1.50/32"}, "does not say how many bits are the network's"),
        ({"address": "192.168.1/24"}, "'192.168.1' is not an IPv4 address"),
        ({"address": "192.168.1.255/24"}, "is the address of the whole network 192.168.1.0/24"),
        ({"address": "239.1.1.1/24"}, "no address that a machine on Ethernet can have"),
        ({"gateway": "10.0.0.1"}, "'10.0.0.1' is no other machine of 192.168.1.0/24"),
        ({"gateway": "192.168.1.50"}, "'192.168.1.50' is no other machine"),
        ({"data_bytes": 4}, "'data_bytes' is at most 1 with 'ethernet: gmii'"),
        ({"datagram_bytes": 1488}, "'datagram_bytes' is at most 1472 with 'ethernet: gmii'"),
    ],
)
def test_mistakes_of_a_link_with_pins(options, message):
    found = error_of(ethernet(**options))
    assert message in found, found


@pytest.mark.parametrize(("most", "key"), [(255, "node"), (245, "namespace"), (247, "topic")])
def test_lengths_of_names(most, key):
    """Those of rmw: 255 of a node, 245 of a namespace, 247 of a complete topic."""
    for length in (most, most + 1):
        given = {"node": "n", "namespace": "/", "topic": "/a"}
        given[key] = "x" * length if key == "node" else "/" + "x" * (length - 1)
        # A topic of its own, so that the namespace makes none too long.
        text = f"node: {given['node']}\nnamespace: {given['namespace']}\n"
        text += f"subscribe: {{{given['topic']}: {{type: std_msgs/msg/Bool, port: a}}}}\n"
        if length == most:
            assert described(text).topics[0].name == given["topic"]
            continue
        with pytest.raises(DefinitionError, match=f"at most {most} characters, not {length}"):
            described(text)


def test_a_fingerprint_depends_on_each_part_of_a_topic():
    first = read()
    others = [
        replace(first, topics=(replace(first.topics[0], **{name: value}), *first.topics[1:]))
        for name, value in (
            ("id", 9),
            ("kind", "publish"),
            ("name", "/other"),
            ("type", "geometry_msgs/msg/Twiste"),
            # The type has kept its name, and its fields are others.
            ("definition_hash", "0" * 64),
        )
    ]
    others.append(replace(first, topics=first.topics[:-1]))
    # The same topics on another wire format are other bytes.
    others.append(replace(first, wire="ros1"))
    assert len({each.fingerprint for each in (first, *others)}) == 8
    assert all(0 < each.fingerprint < 1 << 64 for each in others)
    # The host needs the same bytes, not the same queues.
    assert read(clock_mhz="50", link="uart").fingerprint == first.fingerprint
    same = replace(first.topics[0], port="other", rate_hz=1.0, written="x")
    assert replace(first, topics=(same, *first.topics[1:])).fingerprint == first.fingerprint


def test_limits_of_a_topic():
    def store(options, kind="subscribe", tail=""):
        text = f"node: n\n{kind}: {{a: {{type: geometry_msgs/msg/Vector3, {options}}}}}\n{tail}"
        (topic,) = described(text).topics
        return topic.stores[0][1]

    # 28 bytes are a Vector3: encapsulation, and three numbers of 8.
    assert store("max_message_bytes: 28").max_message_bytes == 28
    assert store("max_message_bytes: 4294967295").max_message_bytes == (1 << 32) - 1
    for wrong in (27, 1 << 32):
        with pytest.raises(DefinitionError, match="must be from 28 to 4294967295"):
            store(f"max_message_bytes: {wrong}")
    for packets in (1, 4096):
        assert store(f"packets: {packets}").packets == packets
    for wrong in (0, 4097):
        with pytest.raises(DefinitionError, match="'packets' must be from 1 to 4096"):
            store(f"packets: {wrong}")
    # What the node publishes may wait on any link; what it is sent, on a stream alone.
    for policy in ("wait", "drop"):
        assert store(f"when_full: {policy}", "publish", "link: udp\n").when_full == policy
    assert store("memory_bytes: 32").memory_bytes == 32


BOOL = "{type: std_msgs/msg/Bool}"


def names(text):
    return [topic.name for topic in described(text).topics]


@pytest.mark.parametrize("size", [262_144, 262_145])
def test_the_largest_file(size, tmp_path):
    text = f"node: n\npublish: {{/a: {BOOL}}}\n"
    path = tmp_path / "node.yaml"
    path.write_text(text + "#" * (size - len(text)))
    if size == 262_144:
        assert read_description(path, library=LIBRARY).node == "n"
        return
    with pytest.raises(DefinitionError, match="has 262145 bytes, and at most 262144 are read"):
        read_description(path, library=LIBRARY)


def test_a_remapping_is_not_remapped_again():
    text = f"node: n\nremap: {{/a: /b, /b: /c}}\nsubscribe: {{/a: {BOOL}, /b: {BOOL}}}\n"
    assert names(text) == ["/b", "/c"]
    assert names(text.replace("/c", "/a")) == ["/b", "/a"]
    # Without a topic of its own, the second one is of no use.
    with pytest.raises(DefinitionError, match=r":2:17: error: no topic has the name '/b'"):
        described(text.replace(f", /b: {BOOL}", ""))


def test_two_topics_that_a_remapping_makes_one_are_refused():
    text = f"node: n\nremap: {{/a: /b}}\nsubscribe:\n  /a: {BOOL}\n  /b: {BOOL}\n"
    with pytest.raises(DefinitionError, match=r":5:3: error: '/b' is already there, as '/a'"):
        described(text)
    # A node may hear what it says, in ports of one name.
    both = described(text.replace("  /b:", "publish:\n  /b:"))
    assert [(topic.kind, topic.name, topic.port) for topic in both.topics] == [
        ("subscribe", "/b", "b"),
        ("publish", "/b", "b"),
    ]


@pytest.mark.parametrize(
    ("first", "second", "more"),
    [
        ("/r/a", "/r/a", ""),
        ("a", "/r/a", ""),
        ("~/a", "n/a", ""),
        ("/r/n/a", "~/a", ""),
        ("/b", "a", "remap: {a: /b}\n"),
        ("c", "d", "remap: {c: /x, d: /x}\n"),
    ],
)
def test_a_topic_has_one_type_by_whatever_names(first, second, more):
    text = f"node: n\nnamespace: /r\n{more}publish:\n  {first}: {BOOL}\nsubscribe:\n"
    text += f"  {second}: {{depth: 1, type: std_msgs/Byte}}\n"
    with pytest.raises(DefinitionError) as caught:
        described(text)
    head, line, caret = str(caught.value).splitlines()
    row, column = text.count("\n"), text.splitlines()[-1].index("std_msgs") + 1
    assert head.startswith(f"<description>:{row}:{column}: error: the topic '/")
    wanted = f"has the type 'std_msgs/msg/Bool' already ('{first}' in line {row - 2}); a topic "
    assert wanted in head
    assert line == text.splitlines()[-1] and caret == " " * (column - 1) + "^" * 13
    # One type has many names; and a service is no topic.
    described(text.replace("std_msgs/Byte", "std_msgs/Bool"))
    served = text.replace("depth: 1, type: std_msgs/Byte", "type: robot_msgs/Calibrate")
    described(served.replace("subscribe", "serve"))


@pytest.mark.parametrize(
    ("name", "port"),
    [("/a_b", "a_b"), ("/a__b/c_", "a_b_c"), ("/_a/B/_/c1", "a_B_c1"), ("/a/b", "a_b")],
)
def test_a_port_has_the_words_of_the_complete_name(name, port):
    (topic,) = described(f"node: n\npublish: {{{name}: {BOOL}}}\n").topics
    assert topic.port == port


@pytest.mark.parametrize("word", ["signature", "metadata", "elaborate", "clk", "rst", "lambda"])
def test_words_that_are_no_ports(word):
    for topic in (f"/{word}: {BOOL}", f"/a: {BOOL[:-1]}, port: {word}}}"):
        with pytest.raises(DefinitionError, match="because Python or Amaranth use it"):
            described(f"node: n\npublish: {{{topic}}}\n")
    assert described(f"node: n\npublish: {{/a_{word}: {BOOL}}}\n").topics[0].port == f"a_{word}"


def test_a_port_belongs_to_the_first_topic_that_has_it():
    text = f"node: n\npublish:\n  /a/b: {BOOL}\n  /a_b: {BOOL}\n  /A__b: {BOOL}\n"
    with pytest.raises(DefinitionError) as caught:
        described(text)
    lines = str(caught.value).splitlines()[::3]
    assert [line.partition("; ")[0] for line in lines] == [
        f"<description>:{line}:3: error: the port '{port}' is already that of '/a/b'"
        for line, port in ((4, "a_b"), (5, "A_b"))
    ]


@pytest.mark.parametrize("name", ["a:B", "a.b_1:C", "a:B.C", "_a.b.c:_D"])
def test_names_of_accelerators(name):
    text = f"node: n\npublish: {{/a: {BOOL}}}\naccelerator: '{name}'\n"
    assert described(text).accelerator == name


@pytest.mark.parametrize(
    "name", ["a", "a:", ":B", "a.:B", "a.1b:C", "a:b-c", "a:B.", "a b:C", "a::B"]
)
def test_what_is_no_name_of_an_accelerator(name):
    with pytest.raises(DefinitionError, match=r":3:14: error: an accelerator is named as 'module:"):
        described(f"node: n\npublish: {{/a: {BOOL}}}\naccelerator: '{name}'\n")


TOPIC = "publish: {/a: {type: std_msgs/msg/Bool%s}}\n"


def described(text, library=LIBRARY):
    return read_description_text(text, library=library)


def mistakes(text, **options):
    """Return the messages of all mistakes, with their places."""
    with pytest.raises(DefinitionError) as caught:
        described(text, **options)
    lines = str(caught.value).splitlines()
    return [line.removeprefix("<description>:") for line in lines if ": error: " in line]


# Topics.


@pytest.mark.parametrize(
    ("fields", "memory"),
    [
        # 4 bytes are the encapsulation. There is room for two messages, and for 64 bytes.
        ("uint8 x", 64),
        ("uint8[28] x", 64),
        ("uint8[29] x", 128),
        ("uint8[60] x", 128),
        # Where most messages are smaller than the largest one, 16 KiB are enough.
        ("uint8[<=8000] x", 16_384),
        ("uint8[<=60000] x", 16_384),
        ("uint8[] x", 16_384),
        # Two of the smallest ones always have room, as far as 64 MiB go.
        ("uint8[10000] x", 32_768),
        ("uint8[40000000] x", 1 << 26),
    ],
)
def test_memory_of_a_topic(fields, memory, tmp_path):
    make_files(tmp_path, {"own/msg/A.msg": f"{fields}\n"})
    library = Library("jazzy", [tmp_path])
    text = "node: n\nbus_bytes: 16\npublish: {/a: {type: own/msg/A}}\n"
    (topic,) = described(text, library).topics
    made = topic.store("out")
    assert (made.memory_bytes, made.max_message_bytes, made.packets) == (memory, memory, 16)


@pytest.mark.parametrize(
    ("option", "values", "wrong"),
    [
        ("rate_hz", (0.001, 1, 1e9), ("0.00099", "1000000001", "0", "-1")),
        ("depth", (1, 1 << 20), ("0", "1048577")),
    ],
)
def test_numbers_of_a_topic(option, values, wrong):
    for value in values:
        (topic,) = described(f"node: n\n{TOPIC % f', {option}: {value}'}").topics
        assert value in (topic.rate_hz, topic.qos.depth)
    for value in wrong:
        (only,) = mistakes(f"node: n\n{TOPIC % f', {option}: {value}'}")
        assert only.startswith(f"2:{43 + len(option)}: error: '{option}' must be from ")


def test_a_service_is_refused_for_its_response(tmp_path):
    text = (
        "module own { module srv { struct Odd_Request { long a; };"
        " struct Odd_Response { long double b; }; }; };\n"
    )
    make_files(tmp_path, {"own/srv/Odd.idl": text})
    library = Library("jazzy", [tmp_path])
    with pytest.raises(DefinitionError, match=r"Odd\.idl:1:\d+: error: .*long double"):
        described("node: n\nserve: {/a: {type: own/srv/Odd}}\n", library)


# Links.


def linked(options, more=""):
    return f"node: n\nlink: {{{options}}}\n{more}{TOPIC % ''}"


FEW = "a bit takes 4 cycles at least, which {} MHz has not"


@pytest.mark.parametrize(
    ("mhz", "baud", "problem"),
    [
        (100, 9600, ""),
        # Four cycles, also of the usual rate, which is 1 Mbaud.
        (4, "", ""),
        (3.9, "", FEW.format("3.9")),
        (100, 25_000_000, ""),
        (100, 30_000_000, FEW.format("100")),
        # Eight cycles of 100 MHz are the nearest to each of these.
        (100, 12_240_000, "a clock of 100 MHz gives 12500000 baud, which is more than 2 % off"),
        (100, 12_260_000, ""),
        (100, 12_750_000, ""),
        (100, 12_760_000, "a clock of 100 MHz gives 12500000 baud, which is more than 2 % off"),
        (400, 100_000_000, ""),
        (400, 100_000_001, "'baud' must be from 1 to 100000000, not 100000001"),
    ],
)
def test_a_bit_is_nearly_a_number_of_cycles(mhz, baud, problem):
    options = f", baud: {baud}" if baud else ""
    text = linked(f"kind: uart{options}", f"clock_mhz: {mhz}\n")
    if not problem:
        assert described(text).link.baud == (baud or 1_000_000)
        return
    # What is wrong with a rate is said at its value.
    assert mistakes(text) == [f"2:{26 if baud else 7}: error: {problem}"]


# One message a mistake, in the order of the text.


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (
            "node: on\n" + TOPIC % "",
            "1:7: error: 'node' must be text, not a boolean (on); put it in quotes",
        ),
        ("node: [a]\n" + TOPIC % "", "1:7: error: 'node' must be text, not a list"),
        ("node:\n" + TOPIC % "", "1:1: error: 'node' must be text, not empty"),
        (
            "node: n\n" + TOPIC % ", depth: five",
            "2:48: error: 'depth' must be an integer, not text",
        ),
        (
            "node: n\n" + TOPIC % ", history: 3",
            "2:50: error: 'history' must be text, not an integer (3); put it in quotes",
        ),
        (
            linked("kind: udp, host: x, host_port: 1"),
            "2:25: error: 'x' is not an IPv4 address, such as 192.168.1.10",
        ),
        (
            "node: n\nserve: {/a: {type: robot_msgs/srv/Calibrate, memory_bytes: 100}}\n",
            "2:60: error: 'memory_bytes' must be a power of two, not 100",
        ),
    ],
)
def test_a_mistake_is_said_once(text, wanted):
    assert mistakes(text) == [wanted]


def test_a_caret_stays_in_the_line_and_in_the_text():
    for text, at in (
        ("{node: [a, b], link: udp, subscribe: {a: {type: std_msgs/msg/Bool}}}\n", 7),
        # The text has no end of a line.
        (TOPIC % "" + "node: [a, b]", 6),
    ):
        with pytest.raises(DefinitionError) as caught:
            described(text)
        place, line, caret = str(caught.value).splitlines()[:3]
        assert place.endswith("error: 'node' must be text, not a list")
        assert caret == " " * at + "^" * len("[a, b]") and line in text


# Names.


@pytest.mark.parametrize("name", ["/_a", "a/_b/c__d", "~/_", "A1/b2"])
def test_names_that_ros_2_has(name):
    text = f"node: _n\npublish: {{{name}: {{type: std_msgs/msg/Bool, port: p}}}}\n"
    (topic,) = described(text).topics
    assert topic.written == name


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("/a/3b", "does not start with a digit; '3b' does not fit"),
        ("3b", "does not start with a digit"),
        ("/a/b-c", "has letters, digits, '_' and '/' only, not '-'"),
        ("~/a//b", "has no '//'"),
        ("~/", "does not end with '/'"),
        ("/", "does not end with '/'"),
    ],
)
def test_names_that_ros_2_has_not(name, problem):
    found = mistakes(f"node: n\npublish: {{{name}: {{type: std_msgs/msg/Bool, port: p}}}}\n")
    assert found == [f"2:11: error: the name of a topic {problem}"]


def test_a_participant_is_one_of_ros_2():
    text = "node: a\ndistro: noetic\nlink: {kind: rtps, address: 10.0.0.9}\n"
    with pytest.raises(DefinitionError, match="3:7: error: a link of kind 'rtps' is for ROS 2"):
        read_description_text(text + "subscribe: {/a: {type: std_msgs/Bool}}")
