"""``firm-hdl golden`` and ``firm-hdl cover``, as users call them."""

from __future__ import annotations

import pytest

from firm_hdl.cli import main

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
        path.write_text(path.read_text().replace("terminated: true", "terminated: false"))
    before = [path.read_text() for path in paths]
    assert main(["golden", "check", str(folder)]) == 1
    assert capsys.readouterr().out == (
        f"{paths[0]}: sensor_msgs/msg/Imu\n"
        "    steps[header.stamp.nanosec].begin.terminated: False -> True\n"
        f"{paths[1]}: std_msgs/msg/String\n"
        "    steps[data.length].begin.terminated: False -> True\n"
        "   2 types: steps[*].begin.terminated\n"
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


def test_a_type_that_is_gone_cannot_be_accepted(folder, capsys):
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


def test_cover_prints_types_and_what_they_add(capsys):
    names = ["geometry_msgs/msg/Point", "geometry_msgs/msg/Vector3", "std_msgs/msg/Bool"]
    assert main(["cover", *names]) == 0
    out, err = capsys.readouterr()
    assert [line.partition(":")[0] for line in out.splitlines()] == [names[0], names[2]]
    assert "field bool" in out
    assert err.startswith("2 of 3 types have all of the ")
    assert err.endswith(" features; 2 different circuits\n")
