"""The command ``firm-hdl golden``."""

from __future__ import annotations

import re

import pytest

from firm_hdl.cli import main
from tests.frontend.recordings import make_recording
from tests.frontend.workspace import make_files

TYPES = ["sensor_msgs/msg/Imu", "std_msgs/msg/String"]


@pytest.fixture
def folder(tmp_path, capsys):
    assert main(["golden", "add", str(tmp_path), *TYPES]) == 0
    capsys.readouterr()
    return tmp_path


def test_unchanged_plans_pass(folder, capsys):
    assert main(["golden", "check", str(folder)]) == 0
    assert capsys.readouterr().out == "2 golden plans, 0 differ\n"


def test_a_change_fails_until_it_is_accepted(folder, capsys):
    paths = sorted((folder / "lyrical").iterdir())
    for path in paths:
        path.write_text(re.sub(r"limit: 1677\d+", "limit: 9", path.read_text()))
    before = [path.read_text() for path in paths]
    assert main(["golden", "check", str(folder)]) == 1
    assert capsys.readouterr().out == (
        f"{paths[0]}: sensor_msgs/msg/Imu\n"
        "    plan[run of header.frame_id.items].limit: 9 -> 16776903\n"
        f"{paths[1]}: std_msgs/msg/String\n"
        "    plan[run of data.items].limit: 9 -> 16777207\n"
        "   2 types: plan[*].limit\n"
        "2 golden plans, 2 differ\n"
    )
    assert [path.read_text() for path in paths] == before
    assert main(["golden", "accept", str(folder), TYPES[0]]) == 0
    assert [path.read_text() == old for path, old in zip(paths, before, strict=True)] == [
        False,
        True,
    ]
    assert main(["golden", "accept", str(folder)]) == 0
    assert main(["golden", "check", str(folder)]) == 0


@pytest.mark.parametrize("place", ["lyrical", "lyrical/std_msgs_msg_String_cdr_8.yaml"])
def test_no_plan_is_written_through_a_link(folder, capsys, place):
    """The user names the folder, and others may have filled it."""
    (folder / "a").mkdir()
    (folder / place).rename(folder / "a" / "b")
    (folder / place).symlink_to(folder / "a" / "b")
    for path in (folder / "lyrical").iterdir():
        path.write_text(re.sub(r"limit: 1677\d+", "limit: 9", path.read_text()))
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    for does in ("accept", "add"):
        assert main(["golden", does, str(folder), "std_msgs/msg/String"]) == 1
        assert f"{place}' is a link; golden plans are not written" in capsys.readouterr().err
    assert before == {path: path.read_bytes() for path in before}


def test_a_removed_type_cannot_be_accepted(folder, capsys):
    path = sorted((folder / "lyrical").iterdir())[1]
    text = path.read_text().replace("std_msgs/msg/String", "std_msgs/msg/Strung")
    path.write_text(text)
    assert main(["golden", "accept", str(folder)]) == 1
    assert f"not accepted: {path}" in capsys.readouterr().err
    assert path.read_text() == text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["check", "."], "error: '{folder}/.' has no golden plans"),
        (["check", "lyrical"], "error: '{folder}/lyrical' has no golden plans"),
        (["check", "", "std_msgs/msg/Int8"], "error: '{folder}' has no plan of std_msgs/msg/Int8"),
        # One of two types is there.
        (
            ["check", "", TYPES[0], "std_msgs/msg/Int8"],
            "error: '{folder}' has no plan of std_msgs/msg/Int8",
        ),
        (["add", ""], "error: name the types to add"),
    ],
)
def test_wrong_calls_are_explained(tmp_path, capsys, arguments, message):
    if arguments[1] == "":
        assert main(["golden", "add", str(tmp_path), TYPES[0]]) == 0
    do, where, *types = arguments
    where = f"{tmp_path}/{where}".rstrip("/")
    assert main(["golden", do, where, *types]) == 1
    assert capsys.readouterr().err == message.format(folder=tmp_path) + "\n"


def test_plans_of_recorded_types_are_kept_and_checked(tmp_path, capsys):
    bag = ["--bag", str(make_recording(tmp_path, "mcap"))]
    folder = str(tmp_path / "golden")
    assert main(["golden", "add", folder, "my_msgs/msg/Wheel", *bag]) == 0
    assert main(["golden", "check", folder, *bag]) == 0
    # No other source has the type.
    assert main(["golden", "check", folder]) == 1
    assert "package 'my_msgs'" in capsys.readouterr().out


def test_types_need_the_same_folders_and_keep_their_limit(tmp_path, capsys):
    texts = {"own/p/msg/A.msg": "q/B b\nstring s\n", "other/q/msg/B.msg": "int8 x\n"}
    make_files(tmp_path, texts)
    folder = str(tmp_path / "golden")
    own = ["--path", str(tmp_path / "own")]
    both = [*own, "--depends", str(tmp_path / "other")]
    assert main(["golden", "add", folder, "p/msg/A", *both, "--max-message-bytes", "999"]) == 0
    (path,) = (tmp_path / "golden").glob("*/*.yaml")
    assert "max_message_bytes: 999\n" in path.read_text()
    assert main(["golden", "check", folder, *both]) == 0
    assert main(["golden", "check", folder, *own]) == 1
    assert "package 'q'" in capsys.readouterr().out
