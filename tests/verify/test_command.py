"""``firm-hdl verify``: its arguments, its output, and its exit status."""

from __future__ import annotations

import os
from typing import ClassVar

import pytest

import firm_hdl.verify.run as run
from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError, Diagnostic, UserError
from firm_hdl.export.build import BuildError
from firm_hdl.jobs import ExecutorError, ProgramMissingError
from firm_hdl.verify.references.client import ClientMissingError
from firm_hdl.verify.results.file import ResultsError
from firm_hdl.verify.results.verdict import Failed, Passed
from firm_hdl.verify.systems.system import System
from firm_hdl.verify.systems.tasks import UnknownTypeError
from tests.depth import by_depth
from tests.verify.report.samples import a_record
from tests.verify.samples import own_package

BOOL = ["--distro", "lyrical", "--jobs", "1", "--cases", "2", "--reference", "none"]
BOOL += ["std_msgs/msg/Bool"]


@pytest.mark.parametrize("arguments", [["--simulator", "ghdl"], ["--systems", "bench"]])
def test_missing_ghdl_is_an_error_without_a_traceback(capsys, monkeypatch, tmp_path, arguments):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("GHDL", raising=False)
    assert main(["verify", *BOOL, *arguments]) == 1
    output = capsys.readouterr()
    assert output.err == "error: GHDL is not installed (Debian, Ubuntu: apt install ghdl-mcode)\n"
    assert output.out == ""


def test_unknown_types_and_folders_are_errors(capsys, tmp_path):
    assert main(["verify", "no_msgs/Such"]) == 1
    assert capsys.readouterr().err == "error: No distribution has no_msgs/msg/Such\n"
    own_package(tmp_path)
    assert main(["verify", "own_msgs/msg/Such", "--path", str(tmp_path)]) == 1
    assert capsys.readouterr().err.startswith("error: type 'Such' is not defined in package")
    assert main(["verify", "--all", "--path", str(tmp_path / "none")]) == 1
    assert capsys.readouterr().err == f"error: '{tmp_path / 'none'}' is not a folder\n"


def test_all_with_a_folder_is_all_in_the_folder(capsys, tmp_path, monkeypatch):
    own_package(tmp_path)
    for name in by_depth(("msg/Deep.msg", "msg/Middle.msg", "msg/Inner.msg", "srv/Ask.srv"), ()):
        (tmp_path / "own_msgs" / name).unlink()
    (tmp_path / "own_msgs" / "msg" / "Wide.msg").write_text("wstring text\n")
    arguments = ["verify", "--all", "--path", str(tmp_path), "--cases", "1", "--jobs", "1"]
    assert main([*arguments, "--no-stalls", "--no-broken", "--reference", "none"]) == 0
    output = capsys.readouterr()
    wide = "rosbags has no wstring, which own_msgs/msg/Wide.text is"
    assert f"not judged: own_msgs/msg/Wide (lyrical), ts3, 8-byte bus: {wide}\n" in output.out
    # Messages; request, response and event of a service; and one unjudged message.
    count = by_depth(1, 4 + 3)
    assert f"lyrical     {count} of    {count} types pass (8-byte bus)\n" in output.out
    assert f"\n1 of {count + 1} types not judged\n" in output.out


def test_one_wrong_definition_does_not_keep_the_others_of_a_folder(capsys, tmp_path):
    folder = tmp_path / "own_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Good.msg").write_text("int8 a\n")
    (folder / "Bad.msg").write_text("Such a\n")
    assert main(["verify", "--systems", "ts2", "--all", "--path", str(tmp_path)]) == 1
    output = capsys.readouterr()
    assert "lyrical     1 of    1 plans are sound" in output.out
    assert "Bad.msg:1:1: error: type 'Such' is not defined" in output.err
    # If the definition is named explicitly, the error is reported at once.
    assert main(["verify", "--systems", "ts2", "own_msgs/msg/Bad", "--path", str(tmp_path)]) == 1
    assert capsys.readouterr().out == ""


def test_the_active_workspace_is_searched(capsys, tmp_path, monkeypatch):
    files = {"a/share/a_msgs/msg/A.msg": "b_msgs/B b\n", "b/share/b_msgs/msg/B.msg": "uint8 x\n"}
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text(text)
    few = ["--jobs", "1", "--cases", "1", "--no-stalls", "--no-broken", "--reference", "none"]
    # The others take seconds to start; they get the same definitions.
    oracle = by_depth(["--oracle", "rosbags"], [])
    prefixes = os.pathsep.join([str(tmp_path / "a"), str(tmp_path / "b")])
    monkeypatch.setenv("AMENT_PREFIX_PATH", prefixes)
    systems = by_depth("ts1,ts2", "ts1,ts2,ts3")
    assert main(["verify", "--systems", systems, *few, *oracle, "a_msgs/msg/A"]) == 0
    assert "lyrical     1 of    1 plans are sound" in capsys.readouterr().out
    # The option `--path` has priority over the environment variable.
    assert main(["verify", *few, "--all", "--path", str(tmp_path / "a" / "share")]) == 0
    assert "lyrical     1 of    1 types pass (8-byte bus)\n" in capsys.readouterr().out
    # The types of the distributions are their own.
    (tmp_path / "a" / "share" / "std_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "a" / "share" / "std_msgs" / "msg" / "Bool.msg").write_text("uint64 data\n")
    assert main(["verify", "--systems", "ts2", *few, "std_msgs/msg/Bool"]) == 0
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    assert main(["verify", *few, "a_msgs/msg/A"]) == 1
    assert capsys.readouterr().err.endswith("error: No distribution has a_msgs/msg/A\n")


def test_every_system_runs_even_if_the_first_fails(monkeypatch):
    ran = []

    class FixedSystem(System):
        """A test system with a given result."""

        tests = ()
        options: ClassVar = {}

        def __init__(self, name, is_well):
            self.name, self.is_well = name, is_well

        def records(self, writer):
            ran.append(self.name)
            return [a_record(verdict=Passed(1) if self.is_well else Failed(("",)))]

    made = {name: FixedSystem(name, name != "ts1") for name in ("ts1", "ts3")}
    systems = {name: lambda given, name=name: [made[name]] for name in made}
    monkeypatch.setattr(run, "SYSTEMS", systems)
    assert main(["verify", "--all", "--systems", "ts1,ts3"]) == 1
    assert main(["verify", "--all", "--systems", "ts3"]) == 0
    assert ran == ["ts1", "ts3", "ts3"]


ERRORS = [
    BuildError("no room"),
    ClientMissingError("no room"),
    ExecutorError("no room"),
    ResultsError("no room"),
    ProgramMissingError("no room"),
    UnknownTypeError("no room"),
    UserError("no room"),
    DefinitionError([Diagnostic(message="no room")]),
]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_an_error_of_the_user_has_status_1_and_a_line_of_text(monkeypatch, capsys, error):
    def fails(work):
        raise error

    monkeypatch.setattr(run, "SYSTEMS", {"ts3": fails})
    assert main(["verify", "std_msgs/Bool"]) == 1
    assert capsys.readouterr() == ("", "error: no room\n")


def test_type_passes_and_the_cross_check_is_counted(ghdl, capsys):
    words = ["verify", *BOOL[:-1], "std_msgs/msg/Empty", "--no-stalls", "--no-broken"]
    assert main([*words, "--simulator", "ghdl"]) == 0
    output = capsys.readouterr().out
    assert "lyrical     1 of    1 types pass (8-byte bus)\n" in output
    assert "ghdl: replayed every cycle of 1 types, 1 pass" in output
