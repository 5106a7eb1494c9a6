"""Folders of rosbag2, and what is said of paths that are no recordings."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.recordings import Recording
from tests.frontend.workspace import make_files
from tests.recordings.files import Channel, messages, write_db3, write_mcap

KEY = "rosbag2_bagfile_information"


def folder(path: Path, metadata: str, **files: Channel) -> Path:
    """Write a folder with metadata, and a file for each channel."""
    path.mkdir()
    (path / "metadata.yaml").write_text(metadata)
    for name, channel in files.items():
        write_mcap(path / f"{name}.mcap", channel)
    return path


def refused(path: Path) -> str:
    with pytest.raises(DefinitionError) as caught:
        Recording(path)
    return str(caught.value)


def test_the_files_of_a_folder_are_those_of_its_metadata(tmp_path: Path) -> None:
    good = f"{KEY}:\n  relative_file_paths: [x/b.mcap, a.mcap, b.mcap]\n  ros_distro: humble\n"
    channels = {name: Channel(topic=f"/{name}", messages=((1, b"x"),)) for name in "abc"}
    path = folder(tmp_path / "r", good, **channels)
    recording = Recording(path)
    assert [topic.name for topic in recording.topics] == ["/b", "/a"]
    assert [topic.name for topic, _, _ in messages(path)] == ["/b", "/a"]
    alone = recording.messages(recording.topics[1:])
    assert [topic.name for topic, _, _ in alone] == ["/a"]
    assert recording.distro == "humble"


@pytest.mark.parametrize(
    ("metadata", "reason"),
    [
        (f"{KEY}: {{relative_file_paths: [a.mcap, no.mcap]}}", "No such file or directory"),
        (f"{KEY}: {{relative_file_paths: ['']}}", "it is a folder, not a regular file"),
        (f'{KEY}: {{relative_file_paths: ["a\\0"]}}', "no file has the name that it names"),
        (f"{KEY}: {{relative_file_paths: [[a]]}}", "its metadata.yaml is not that of a recording"),
        (f"{KEY}: 7", "its metadata.yaml is not that of a recording"),
        ("x: [", "its metadata.yaml is not that of a recording"),
        ("[" * 900 + "]" * 900, "its metadata.yaml is not that of a recording"),
        # Each line doubles what the one before has, if the loader merges.
        (
            "a0: &a0 {x: 1}\n"
            + "".join(f"a{n}: &a{n} {{<<: [*a{n - 1}, *a{n - 1}]}}\n" for n in range(1, 60))
            + f"{KEY}: *a59",
            "its metadata.yaml is not that of a recording",
        ),
        ("#" * (1 << 20) + "\n", "it has 1048577 bytes, and at most 1048576 are read"),
        (
            f"{KEY}: {{relative_file_paths: [a.mcap], compression_mode: FILE, "
            "compression_format: lz4}",
            "it is compressed by 'lz4', and only zstd is read",
        ),
    ],
)
def test_metadata_that_is_none_of_a_recording_is_refused(
    tmp_path: Path, metadata: str, reason: str
) -> None:
    path = folder(tmp_path / "r", metadata, a=Channel())
    assert refused(path).endswith(f": {reason}")


def test_paths_that_are_no_recordings_are_refused(tmp_path: Path) -> None:
    make_files(tmp_path, {"a.txt": "x", "a.bag": "", "folder/a.msg": ""})
    no_file = "it does not begin like a .bag, an .mcap or a .db3 file"
    reasons = {
        "a.txt": f"cannot be read as a recording: {no_file}",
        "a.bag": f"cannot be read as a recording: {no_file}",
        "folder": "cannot be read as a recording: it is a folder without metadata.yaml",
        "none.bag": "cannot be read: No such file or directory",
        "a\0.bag": "cannot be read as a recording: no file has the name that it names",
    }
    for name, reason in reasons.items():
        assert refused(tmp_path / name) == f"error: '{tmp_path / name}' {reason}".replace(
            "\0", "\\x00"
        )


def test_a_file_in_a_folder_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    path = folder(tmp_path / "r", f"{KEY}: {{relative_file_paths: [a.mcap]}}")
    os.mkfifo(path / "a.mcap")
    assert refused(path) == (
        f"error: '{path / 'a.mcap'}' cannot be read: it is a FIFO, not a regular file"
    )


@pytest.mark.parametrize("languages", ["1", "2", "12", ""])
def test_mcap_is_of_ros1_if_its_definitions_are(tmp_path: Path, languages: str) -> None:
    channels = [Channel(type=f"p/A{each}", language=f"ros{each}msg") for each in languages]
    recording = Recording(write_mcap(tmp_path / "x.mcap", *channels))
    assert recording.dialect == ("ros1" if languages == "1" else "ros2")


def test_definitions_of_each_file_of_a_recording_count_for_themselves(tmp_path: Path) -> None:
    long = [Channel(topic=f"/{n}", type=f"p/msg/A{n}", text="#" * (4 << 20)) for n in range(9)]
    metadata = f"{KEY}: {{relative_file_paths: [0.db3, 1.db3]}}"
    path = folder(tmp_path / "r", metadata)
    for name in ("0.db3", "1.db3"):
        write_db3(path / name, *long)
    assert len(Recording(path).schemas) == 9
    more = [Channel(type=f"p/msg/B{n}", text="#" * (4 << 20)) for n in range(9)]
    write_db3(tmp_path / "x.db3", *long, *more)
    assert "its definitions have more than 67108864 bytes" in refused(tmp_path / "x.db3")
