"""The command ``metrics``: its formats, and its errors for wrong types."""

from __future__ import annotations

import csv
import io
import json

import pytest

from firm_hdl.cli import main

from ..frontend.workspace import make_files

DEFINITIONS = {
    "p/msg/A.msg": "int32 a\nstring s\n",
    "p/msg/B.msg": "int32 a\n",
    "p/srv/S.srv": "int8 a\n---\nA[] b\n",
}


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    make_files(tmp_path, DEFINITIONS)
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        status = main(["metrics", *arguments, "--path", "."])
        return status, *capsys.readouterr()

    return run


def test_table(run):
    assert run("p/A", "p/msg/B") == (
        0,
        "name     depth  types  leaves  fixed  dynamic  min  max  aligned  padded  shifting  "
        "features\n"
        "p/msg/A      1      1       2      1        1   13    -        2       0         0  "
        "strings\n"
        "p/msg/B      1      1       1      1        0    8    8        1       0         0  -\n",
        "",
    )


def test_service_has_a_row_for_each_message(run):
    status, out, err = run("p/srv/S", "p/srv/S_Request", "--format", "json", "--distro", "foxy")
    assert (status, err) == (0, "")
    assert [row["name"] for row in json.loads(out)] == ["p/srv/S_Request", "p/srv/S_Response"]


def test_csv_and_json_say_the_same(run):
    texts = {form: run("p/A", "p/B", "--format", form)[1] for form in ("csv", "json")}
    rows = list(csv.DictReader(io.StringIO(texts["csv"])))
    for row, want in zip(rows, json.loads(texts["json"]), strict=True):
        want["features"] = " ".join(want["features"])
        want["max_bytes"] = "" if want["max_bytes"] is None else want["max_bytes"]
        assert row == {key: str(value) for key, value in want.items()}
    assert rows[0]["max_bytes"] == "" and rows[1]["max_bytes"] == "8"


def test_all_are_all_messages_of_the_folder_or_of_the_distribution(run, capsys):
    words = ["--all", "--format", "csv", "--distro", "noetic", "--wire", "cdr"]
    status, out, err = run(*words)
    assert (status, err) == (0, "")
    names = [row["name"] for row in csv.DictReader(io.StringIO(out))]
    assert sorted(names) == ["p/A", "p/B", "p/SRequest", "p/SResponse"]
    assert main(["metrics", *words]) == 0
    names = [row["name"] for row in csv.DictReader(io.StringIO(capsys.readouterr().out))]
    assert "sensor_msgs/Imu" in names and len(names) == len({*names}) > 160


def test_types_that_are_wrong_do_not_hide_the_others(run, tmp_path):
    make_files(tmp_path, {"p/msg/Bad.msg": "int33 a\n", "p/srv/Bad.srv": "int34 a\n---\n"})
    status, out, err = run("p/msg/Bad", "p/B", "p/srv/Bad", "--format", "csv")
    assert status == 1
    assert [row["name"] for row in csv.DictReader(io.StringIO(out))] == ["p/msg/B"]
    assert "'int33'" in err and "'int34'" in err


@pytest.mark.parametrize("arguments", [(), ("p/A", "--all")])
def test_either_types_or_all(run, capsys, arguments):
    with pytest.raises(SystemExit) as caught:
        run(*arguments)
    assert caught.value.code == 2
    assert "name either types or --all" in capsys.readouterr().err
