"""Options of topics and links: what holds without them, their limits, and one message a mistake."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.node import read_description_text
from tests.frontend.workspace import make_files
from tests.node.samples import LIBRARY

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


@pytest.mark.parametrize(("mhz", "fits"), [(4, True), (3.9, False)])
def test_a_uart_needs_four_cycles_for_a_bit_also_of_the_usual_1_mbaud(mhz, fits):
    text = f"node: n\nlink: uart\nclock_mhz: {mhz}\n{TOPIC % ''}"
    if fits:
        assert described(text).link.baud == 1_000_000
        return
    assert mistakes(text) == [
        "2:7: error: a bit takes 4 cycles at least, which 3.9 MHz has not",
    ]


def test_the_fastest_uart():
    clock = "clock_mhz: 400\n"
    assert described(linked("kind: uart, baud: 100000000", clock)).link.baud == 100_000_000
    assert mistakes(linked("kind: uart, baud: 100000001", clock)) == [
        "2:26: error: 'baud' must be from 1 to 100000000, not 100000001"
    ]
    # What is wrong with it is said at its value.
    assert mistakes(linked("kind: uart, baud: 30000000")) == [
        "2:26: error: a bit takes 4 cycles at least, which 100 MHz has not"
    ]


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


def test_a_caret_reaches_the_end_of_a_text_without_an_end_of_line():
    with pytest.raises(DefinitionError) as caught:
        described((TOPIC % "") + "node: [a, b]")
    assert str(caught.value).splitlines()[1:] == ["node: [a, b]", "      ^^^^^^"]


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
