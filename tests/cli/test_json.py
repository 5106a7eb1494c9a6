"""``--json``: one object on standard output, with the errors, and nothing else there."""

from __future__ import annotations

import json

import pytest

from firm_hdl.cli import main
from firm_hdl.export.build import BuildError
from tests.frontend.workspace import make_files

FILES = {
    "src/p/msg/A.msg": "uint8 a",
    "src/p/msg/Bad.msg": "uint8 a\nuint8 a",
    "src/p/srv/S.srv": "---\n",
    "n.yaml": "node: n\nclock_mhz: 1\npublish:\n"
    "  /a: {type: std_msgs.msg.String, rate_hz: 1000000}\n",
    "bad.yaml": "node: n\nnonsense: 1\n",
}


@pytest.fixture
def said(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(make_files(tmp_path, FILES))

    def run(*words, status=0):
        assert main([*words, "--json"]) == status
        found = json.loads(capsys.readouterr().out)
        assert found.pop("format") == 1
        return found

    return run


DUPLICATE = {
    "message": "field 'a' is already declared in line 1",
    "file": "src/p/msg/Bad.msg",
    "line": 2,
    "column": 7,
}


def test_list(said):
    found = said("list", "--path", "src", "--only-path", "--distro", "humble")
    assert found == {
        "command": "list",
        "distro": "humble",
        "types": [
            {"name": "p/msg/A", "kind": "msg"},
            {"name": "p/msg/Bad", "kind": "msg"},
            {"name": "p/srv/S", "kind": "srv"},
        ],
        "errors": [],
    }
    assert {"name": "std_msgs/msg/String", "kind": "msg"} in said("list", "--path", "src")["types"]


def test_info_has_the_figures_of_the_manifest(said):
    (message,) = said("info", "p/msg/A", "--path", "src", "--bus-bytes", "4")["messages"]
    assert (message["name"], message["wire"], message["bus_bytes"]) == ("p/msg/A", "cdr", 4)
    assert message["timing"]["shortest_packet"]["bytes"] == 5
    assert {*message["estimates"]} == {"deserializer", "serializer"}


@pytest.mark.parametrize("command", ["info", "metrics", "verify"])
def test_errors_are_there_with_their_places(said, command):
    assert said(command, "p/msg/Bad", "--path", "src", status=1)["errors"] == [DUPLICATE]


def test_figures_of_good_types_come_with_the_errors_of_others(said):
    found = said("metrics", "p/msg/Bad", "p/msg/A", "--path", "src", status=1)
    assert [each["name"] for each in found["messages"]] == ["p/msg/A"]
    assert found["errors"] == [DUPLICATE]


def test_info_of_a_node(said):
    found = said("node", "info", "n.yaml")
    assert found["command"] == "node info"
    assert [each["type"] for each in found["topics"]] == ["std_msgs/msg/String"]
    assert any("needs a clock of" in each for each in found["warnings"])
    members = said("node", "info", "n.yaml", "--members")["members"]
    assert [each["member"] for each in members] == ["publish.a.data.length", "publish.a.data.items"]
    (error,) = said("node", "info", "bad.yaml", status=1)["errors"]
    assert (error["file"], error["line"]) == ("bad.yaml", 2)


def test_verify_has_each_test_with_its_verdict(said):
    words = ["--path", "src", "--systems", "ts2"]
    found = said("verify", "p/msg/A", *words)
    assert (found["verdict"], found["failure"], found["counts"]["passed"]) == ("passed", None, 1)
    (test,) = found["tests"]
    assert (test["system"], test["type"], test["verdict"]) == ("ts2", "p/msg/A", "passed")
    found = said("verify", "--all", *words, status=1)
    assert (found["verdict"], found["errors"]) == ("failed", [DUPLICATE])
    (error,) = said("verify", "p/msg/No", "--systems", "ts2", status=1)["errors"]
    assert "p/msg/No" in error["message"]


def test_wrong_arguments_have_no_object(capsys):
    for words in (["list", "--only-path"], ["metrics"], ["verify"], ["info"]):
        with pytest.raises(SystemExit, match="2"):
            main([*words, "--json"])
        out, err = capsys.readouterr()
        assert out == "" and err.startswith(f"usage: firm-hdl {words[0]}")


def test_errors_of_every_kind_are_there(said, monkeypatch):
    for raised, told in (
        (BuildError("no"), "no"),
        (MemoryError(), "there is not enough memory for this"),
        (OSError(28, "No space left on device"), "[Errno 28] No space left on device"),
    ):

        def fail(*_, error=raised, **__):
            raise error

        monkeypatch.setattr("firm_hdl.cli.reading.library_of", fail)
        assert said("list", status=1)["errors"] == [
            {"message": told, "file": None, "line": None, "column": None}
        ]
