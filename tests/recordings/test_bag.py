"""Bags of ROS 1: what is read of them, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.recordings import MAX_TEXT_BYTES, MAX_TOPICS, Recording
from tests.recordings.files import Channel, messages, write_bag

GOOD = Channel(type="std_msgs/String", messages=((1_500_000_000, b"\1\0\0\0a"), (3, b"\0\0\0\0")))


def test_connections_and_messages_are_read_in_the_order_of_the_file(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "x.bag", GOOD, Channel(topic="/any", type="*"))
    recording = Recording(path)
    assert recording.dialect == "ros1"
    assert [(topic.name, topic.type) for topic in recording.topics] == [
        ("/s", "std_msgs/String"),
        ("/any", "*"),
    ]
    assert [(time, data) for _, time, data in messages(path)] == [*GOOD.messages]


def test_the_kind_of_a_file_is_in_its_first_bytes(tmp_path: Path) -> None:
    assert Recording(write_bag(tmp_path / "x.mcap", GOOD)).dialect == "ros1"


@pytest.mark.parametrize(
    ("header", "reason"),
    [
        ({"index_pos": bytes(8)}, "it has no index, which 'rosbag reindex' makes"),
        ({"index_pos": b"\xff" * 8}, "it is damaged or incomplete"),
        ({"index_pos": b""}, "it has no index, which 'rosbag reindex' makes"),
        ({"op": b"\2"}, "it is damaged or incomplete"),
        ({"encryptor": b"rosbag/AesCbcEncryptor"}, "it is encrypted"),
    ],
)
def test_bags_that_cannot_be_read_say_why(
    tmp_path: Path, header: dict[str, bytes], reason: str
) -> None:
    path = write_bag(tmp_path / "x.bag", GOOD, header=header)
    with pytest.raises(DefinitionError) as caught:
        Recording(path)
    assert str(caught.value) == f"error: '{path}' cannot be read as a recording: {reason}"


def test_bags_of_another_version_are_refused(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "x.bag", GOOD)
    path.write_bytes(path.read_bytes().replace(b"V2.0", b"V1.2"))
    with pytest.raises(DefinitionError, match=r"it is not of version 2\.0$"):
        Recording(path)


def test_the_number_of_connections_has_a_limit(tmp_path: Path) -> None:
    channels = [Channel(topic=f"/{number}") for number in range(MAX_TOPICS + 1)]
    assert len(Recording(write_bag(tmp_path / "x.bag", *channels[1:])).topics) == MAX_TOPICS
    with pytest.raises(DefinitionError, match=f"it has more than {MAX_TOPICS} connections$"):
        Recording(write_bag(tmp_path / "x.bag", *channels))


def test_definitions_that_are_too_long_are_left_out(tmp_path: Path) -> None:
    longs = [Channel(type="p/A", text=b"#" * (MAX_TEXT_BYTES + more)) for more in (1, 1000)]
    recording = Recording(write_bag(tmp_path / "x.bag", *longs, GOOD))
    assert {schema.type: schema.data for schema in recording.schemas} == {
        "p/A": None,
        "std_msgs/String": b"string data\n",
    }
