"""Descriptions of nodes: what they mean, and the place of every mistake."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.node import Qos, read_description, read_description_text
from firm_hdl.node.names import expand
from tests.frontend.recordings import record
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
    assert node.topics[1].qos == Qos(reliability="best_effort", depth=5)
    assert [topic.name for topic in node.of_kind("publish")] == ["/robot/odom"]
    assert [topic.id for topic, _ in node.received()] == [1, 2, 4]
    assert [store.message.base_name for _, store in node.sent()] == [
        "Vector3",
        "Calibrate_Response",
    ]


def test_memory_has_room_for_two_of_the_largest_messages():
    stores = {topic.port: store for topic, store in (*read().received(), *read().sent())}
    # 52, 28 and any number of bytes.
    assert stores["cmd_vel"].memory_bytes == 128
    assert stores["robot_odom"].memory_bytes == 64
    assert stores["robot_names"].memory_bytes == 256
    assert [stores[port].when_full for port in ("cmd_vel", "robot_odom")] == ["drop", "wait"]


def test_ids_are_places_in_the_text():
    other = WHEELS.replace("publish:", "was:").replace("subscribe:", "publish:")
    turned = read(other.replace("was:", "subscribe:"))
    assert [(t.id, t.kind) for t in turned.topics[:3]] == [
        (1, "publish"),
        (2, "publish"),
        (3, "subscribe"),
    ]


def test_the_fingerprint_is_that_of_the_topics():
    first = read()
    assert read(clock_mhz="50", link="uart").fingerprint == first.fingerprint
    for old, new in (("/cmd_vel", "/cmd"), ("Twist", "Accel"), ("names:", "heard:")):
        assert read(WHEELS.replace(old, new)).fingerprint != first.fingerprint
    assert 0 < first.fingerprint < 1 << 64
    # The same topics on another wire format are other bytes.
    assert replace(first, wire="ros1").fingerprint != first.fingerprint


def test_a_publication_answers_one_subscription():
    def topics(*names):
        return "".join(f"  {name}: {{type: std_msgs/msg/{kind}}}\n" for name, kind in names)

    subscribed = topics(("/a", "Bool"), ("/b", "Bool"), ("/c", "String"), ("/d", "Bool"))
    published = topics(("/w", "Char"), ("/x", "Bool"), ("/y", "String"), ("/z", "Bool"))
    node = read(f"node: n\ndistro: jazzy\nsubscribe:\n{subscribed}publish:\n{published}")
    pairs = [(one.name, other.name) for one, other in node.loops()]
    assert pairs == [("/a", "/x"), ("/b", "/z"), ("/c", "/y")]


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
        ("node: on", "1:7: error: 'node' must be text, not a boolean (on); put it in quotes"),
        ("node: a-b", "1:7: error: the name of a node has letters, digits and '_' only, not '-'"),
        ("node: 3a", "1:7: error: the name of a node does not start with a digit"),
        (f"node: {'x' * 256}", "the name of a node has at most 255 characters, not 256"),
        ("node: a\nnamespace: x", "2:12: error: a namespace starts with '/'"),
        ("node: a\nnamespace: /x/", "2:12: error: a namespace does not end with '/'"),
        ("node: a\nbus_bytes: 32", "2:12: error: 'bus_bytes' must be 1, 2, 4, 8 or 16, not 32"),
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
        ("node: a\naccelerator: x.Y", "an accelerator is named as 'module:Class'"),
        ("node: a\nlink: tcp", "2:7: error: 'link' must be 'stream', 'udp' or 'uart', not 'tcp'"),
        ("node: a\nlink: {baud: 1}", "2:1: error: 'link' needs a 'kind': stream, udp, uart"),
        ("node: a\nlink: {kind: udp, baud: 1}", "a link of kind 'udp' has no 'baud'; keys are mem"),
        ("node: a\nlink: {kind: stream, baud: 1}", "a link of kind 'stream' has no 'baud'\nlink"),
        ("node: a\nlink: {kind: udp, host: x}", "'x' is not an IPv4 address"),
        ("node: a\nlink: {kind: udp, host_port: 1}", "'host_port' counts only beside a 'host'"),
        ("node: a\nlink: {kind: udp, datagram_bytes: 1000}", "a multiple of 16, such as 992"),
        ("node: a\nlink: {kind: uart, baud: 90000000}", "a bit takes 4 cycles at least"),
        (
            "node: a\nlink: {kind: uart, baud: 12000000}",
            "gives 12500000 baud, which is more than 2 %",
        ),
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
        (body(a="type: std_msgs/msg/Bool, depth: 0"), "'depth' must be from 1 to 1048576, not 0"),
        (body(a="type: std_msgs/msg/Bool, reliability: reliabl"), "did you mean 'reliable'?"),
        (body(a="type: std_msgs/msg/Bool, memory_bytes: 100"), "must be a power of two, not 100"),
        (body(a="type: std_msgs/msg/Bool, memory_bytes: 8"), "from 16 to 67108864, not 8"),
        (body(a="type: nav_msgs/msg/Odometry, memory_bytes: 64"), "bytes at least, and the memory"),
        (body(a="type: std_msgs/msg/Bool, port: a__b"), "'a__b' cannot be the name of a port"),
        (body(**{"/from": "type: std_msgs/msg/Bool"}), "because Python or Amaranth use it"),
        (
            body(**{"/a": "type: std_msgs/msg/Bool", "/A": "type: std_msgs/msg/Bool"}),
            "4:3: error: the port 'A' is already that of '/a'; name one with 'port'",
        ),
        (
            body(**{"/a": "type: std_msgs/msg/Bool", "a": "type: std_msgs/msg/Bool"}),
            "4:3: error: '/a' is already there, as '/a'",
        ),
        (body(**{"a/{node}": "type: std_msgs/msg/Bool"}), "has no substitutions"),
        (body(**{"~a": "type: std_msgs/msg/Bool"}), "'~' is followed by '/'"),
        (body(**{f"/{'x' * 250}": "type: std_msgs/msg/Bool"}), "at most 247 characters, not 251"),
        ("node: a\nserve: {a: {type: std_msgs/msg/Bool}}", "is a message, and a service is served"),
        (
            body(a="type: std_msgs/msg/Bool, when_full: wait") + "link: udp",
            "a link of kind 'udp' cannot be held; use 'drop'",
        ),
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


@pytest.mark.parametrize("baud", [9600, 921_600, 10_100_000, 14_200_000, 25_000_000])
def test_a_baud_is_accepted_if_a_whole_number_of_cycles_is_near(baud):
    # 100 MHz is 9.9, 7.1 and 4 cycles of the last three.
    text = body(a="type: std_msgs/msg/Bool") + f"link: {{kind: uart, baud: {baud}}}"
    assert read_description_text(text).link.baud == baud


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
    has = {t.kind: [t.store(way) is not None for way in ("in", "out")] for t in node.topics}
    assert has == {"subscribe": [True, False], "publish": [False, True], "serve": [True, True]}
    # So a node that only publishes has no memory to hold what comes.
    published = "node: n\nlink: udp\npublish: {a: {type: std_msgs/msg/Bool}}"
    assert read_description_text(published, library=LIBRARY).link.memory_bytes == 1 << 14


@pytest.mark.parametrize("kind", ["stream", "udp"])
def test_a_stream_alone_can_be_held_by_a_subscription(kind):
    text = body(a="type: std_msgs/msg/Bool, when_full: wait") + f"link: {kind}"
    if kind != "stream":
        assert "cannot be held" in error_of(text)
        return
    (topic,) = read_description_text(text, library=LIBRARY).topics
    assert topic.store("in").when_full == "wait"
