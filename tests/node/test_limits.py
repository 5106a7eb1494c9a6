"""Limits of descriptions, on both sides, and what a part of one means for another part."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.node import read_description_text
from tests.node.samples import LIBRARY, read

TOPIC = "subscribe: {a: {type: std_msgs/msg/Bool}}\n"


def described(text, **options):
    return read_description_text(text, **({"library": LIBRARY} | options))


@pytest.mark.parametrize(
    ("kind", "name", "least", "most", "step"),
    [
        ("udp", "memory_bytes", 64, 1 << 26, 0),
        ("udp", "packets", 1, 4096, 1),
        ("udp", "datagram_bytes", 32, 65_504, 16),
        ("udp", "port", 1, 65_535, 1),
        ("uart", "packets", 1, 4096, 1),
    ],
)
def test_options_of_a_link(kind, name, least, most, step):
    def link(value):
        return described(f"node: n\nlink: {{kind: {kind}, {name}: {value}}}\n{TOPIC}").link

    for value in (least, most):
        assert getattr(link(value), name) == value
    for value in (least - step if step else least // 2, most + step if step else most * 2):
        with pytest.raises(DefinitionError, match=f":2:.*error: '{name}' must be"):
            link(value)


def test_a_host_of_a_link():
    text = "node: n\nlink: {kind: udp, host: 10.1.2.3, host_port: %s}\n" + TOPIC
    for port in (1, 65_535):
        link = described(text % port).link
        assert (link.host, link.host_port, link.port) == ("10.1.2.3", port, 7411)
    for port in (0, 65_536):
        with pytest.raises(DefinitionError, match="'host_port' must be from 1 to 65535"):
            described(text % port)


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
    assert len({each.fingerprint for each in (first, *others)}) == 7
    # The host needs the same bytes, not the same queues.
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


def test_a_caret_stays_below_its_own_value():
    """Of a list or a mapping, within its own line, and no further than its end."""
    with pytest.raises(DefinitionError) as caught:
        described("{node: [a, b], link: udp, subscribe: {a: {type: std_msgs/msg/Bool}}}\n")
    place, line, caret = str(caught.value).splitlines()[:3]
    assert place.startswith("<description>:1:8: error: 'node' must be text, not a list")
    assert caret == " " * 7 + "^" * len("[a, b]")
    assert line.startswith("{node: [a, b], link")


LINK = "node: n\nlink: {%s}\n" + TOPIC


@pytest.mark.parametrize(
    ("baud", "fits"),
    [(12_240_000, False), (12_260_000, True), (12_750_000, True), (12_760_000, False)],
)
def test_a_baud_is_2_percent_off_at_most_in_both_directions(baud, fits):
    """8 cycles of 100 MHz are the nearest to each of these."""
    text = LINK % f"kind: uart, baud: {baud}"
    if fits:
        assert described(text).link.baud == baud
        return
    with pytest.raises(DefinitionError, match="gives 12500000 baud, which is more than 2 % off"):
        described(text)
