"""Files of MCAP: definitions and messages, wherever they are in the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.recordings import MAX_TEXT_BYTES, MAX_TOPICS, Recording
from tests.recordings.files import Channel, mcap_record, messages, write_mcap

GOOD = Channel(messages=((1, b"\0\1\0\0"),))


def types(recording: Recording) -> list[str]:
    return [topic.type for topic in recording.topics]


@pytest.mark.parametrize("summary", [True, False])
@pytest.mark.parametrize("profile", ["ros2", "", "x"])
def test_definitions_are_found_with_and_without_a_summary(
    tmp_path: Path, profile: str, summary: bool
) -> None:
    other = Channel(topic="/t", type="p/msg/A", text="int8 a\n")
    path = write_mcap(tmp_path / "x.mcap", GOOD, other, profile=profile, summary=summary)
    recording = Recording(path)
    assert types(recording) == ["std_msgs/msg/String", "p/msg/A"]
    assert [schema.data for schema in recording.schemas] == [b"string data\n", b"int8 a\n"]
    assert [(topic.name, *rest) for topic, *rest in messages(path)] == [("/s", 1, b"\0\1\0\0")]


def test_a_summary_without_definitions_is_no_matter(tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "x.mcap", GOOD, summary=True)
    data = path.read_bytes()
    start = int.from_bytes(data[-28:-20], "little")
    end = data[-37:]
    for kept in (b"", mcap_record(4, b"\1\0\1\0" + bytes(12))):
        # Nothing, and a channel whose schema is elsewhere.
        path.write_bytes(data[:start] + kept + end)
        recording = Recording(path)
        assert types(recording) == ["std_msgs/msg/String"]
        assert len(messages(path)) == 1


@pytest.mark.parametrize("qos", ["- depth: x", "[" * 1_000_000, "&a [*a]", "\0"])
def test_qos_is_not_read_and_the_type_hash_is(tmp_path: Path, qos: str) -> None:
    metadata = {"offered_qos_profiles": qos, "topic_type_hash": "RIHS01_1"}
    path = write_mcap(tmp_path / "x.mcap", Channel(metadata=metadata))
    assert [topic.digest for topic in Recording(path).topics] == ["RIHS01_1"]


def test_metadata_of_a_channel_that_has_no_end_is_left_out(tmp_path: Path) -> None:
    path = write_mcap(
        tmp_path / "x.mcap", Channel(topic="/t", metadata={"topic_type_hash": "RIHS01_1"}), GOOD
    )
    data = path.read_bytes()
    path.write_bytes(data.replace(b"\x0f\0\0\0topic_type_hash", b"\xff\0\0\0topic_type_hash"))
    assert [topic.digest for topic in Recording(path).topics] == ["", ""]


def test_names_that_are_too_long_are_empty(tmp_path: Path) -> None:
    long = Channel(type="p/msg/" + "A" * 5000)
    assert types(Recording(write_mcap(tmp_path / "x.mcap", long, GOOD))) == [
        "",
        "std_msgs/msg/String",
    ]


def test_channels_without_a_schema_have_no_type(tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "x.mcap", GOOD, more=mcap_record(4, b"\7\0\0\0" + bytes(12)))
    assert types(Recording(path)) == ["", "std_msgs/msg/String"]


def test_definitions_that_are_too_long_are_left_out(tmp_path: Path) -> None:
    long = Channel(type="p/msg/A", text=b"#" * (MAX_TEXT_BYTES + 1))
    path = write_mcap(tmp_path / "x.mcap", long, GOOD)
    assert [schema.data for schema in Recording(path).schemas] == [None, b"string data\n"]


@pytest.mark.sampled(2)
@pytest.mark.parametrize("more", [0, 1])
def test_the_number_of_topics_has_a_limit(tmp_path: Path, more: int) -> None:
    channels = (Channel(topic=f"/{number}") for number in range(MAX_TOPICS + more))
    path = write_mcap(tmp_path / "x.mcap", *channels)
    if not more:
        assert len(Recording(path).topics) == MAX_TOPICS
        return
    with pytest.raises(DefinitionError, match=f"it has more than {MAX_TOPICS} topics$"):
        Recording(path)


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[:-1],
        lambda data: data[: len(data) // 2],
        lambda data: data[:-28] + b"\xff" * 8 + data[-20:],
        lambda data: data[:8] + b"\1" + b"\xff" * 8 + data[17:],
        lambda data: data[:8] + bytes(9) + data[8:],
        lambda data: data[:8],
    ],
)
def test_damaged_files_are_refused(tmp_path: Path, damage: object) -> None:
    path = write_mcap(tmp_path / "x.mcap", GOOD)
    path.write_bytes(damage(path.read_bytes()))  # type: ignore[operator]
    with pytest.raises(DefinitionError, match=r"it is (damaged|incomplete)"):
        messages(path)
