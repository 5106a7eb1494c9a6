"""Every option of the command reaches its use, and every failure sets the exit status."""

from __future__ import annotations

import importlib
import json
import os

import pytest

from firm_hdl.cli import main
from firm_hdl.equivalence import command as prove_command
from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.export.build import BuildError
from firm_hdl.export.options import Options
from firm_hdl.export.top import DIRECTIONS
from firm_hdl.frontend import Library
from firm_hdl.frontend.names import TypeName
from firm_hdl.plan import build_plan, to_yaml
from firm_hdl.plan.compare import head_of
from firm_hdl.wire import lay_out
from tests.frontend.recordings import make_recording
from tests.frontend.workspace import make_files

# The name `build` is also that of a function in a package.
BUILD = importlib.import_module("firm_hdl.export.build")
RUN = {
    "verify": "firm_hdl.verify.command",
    "golden": "firm_hdl.verify.ts2.golden",
    "cover": "firm_hdl.covering.command",
    "report": "firm_hdl.verify.report.formats",
    "prove": "firm_hdl.equivalence.command",
    "bench": "firm_hdl.bench.command",
}
FILES = {
    "p/msg/A.msg": "uint8 a\nuint32 b\nstring c",
    "p/srv/S.srv": "uint8 a\n---\nuint8 b",
    "p/action/D.action": "uint8 a\n---\nuint8 b\n---\nuint8 c",
}
OPTIONS = {"wire": "ros1", "bus_bytes": 4, "max_message_bytes": 777}
WORDS = ["--wire", "ros1", "--bus-bytes", "4", "--max-message-bytes", "777"]


@pytest.fixture
def workdir(tmp_path, monkeypatch):
    monkeypatch.chdir(make_files(tmp_path, FILES))
    return tmp_path


def planned(name, **options):
    message = Library("lyrical", ["."]).message(name)
    wire = options.pop("wire", None)
    return build_plan(lay_out(message, wire), **options)


@pytest.mark.parametrize("left_out", [None, "wire", "bus_bytes", "max_message_bytes"])
def test_plans_are_made_with_all_options(workdir, capsys, left_out):
    options = {name: value for name, value in OPTIONS.items() if name != left_out}
    words = [
        word
        for name, value in options.items()
        for word in (f"--{name.replace('_', '-')}", str(value))
    ]
    known = {"bus_bytes": 8, **options}
    assert main(["plan", "p/A", "--path", ".", *words]) == 0
    plan = planned("p/A", **known)
    assert capsys.readouterr().out == to_yaml(plan)
    assert (plan.wire, plan.bus_bytes) == (known.get("wire", "cdr"), known["bus_bytes"])
    assert main(["info", "p/A", "--path", ".", *words]) == 0
    head = capsys.readouterr().out.splitlines()[0]
    wire = {"ros1": "ROS 1", "cdr": "CDR, as in ROS 2"}[plan.wire]
    assert head == f"p/msg/A ({wire}) on a bus of {plan.bus_bytes} bytes per clock cycle"


def test_build_is_given_all_options(workdir, monkeypatch):
    given = {}
    monkeypatch.setattr(BUILD, "build", lambda types, out, **options: given.update(
        options, types=types, out=out) or [])  # fmt: skip
    words = [*WORDS, "--out", "there", "--ports", "flat", "--force", "--distro", "iron"]
    words += ["--jobs", "3"]
    assert main(["build", "p/A", "p/srv/S", "--path", ".", *words]) == 0
    assert given["types"] == ["p/A", "p/srv/S"] and given["out"] == "there"
    assert given["options"] == Options(**OPTIONS, ports="flat") and given["force"] is True
    assert given["jobs"] == 3
    assert given["library"].distro == "iron" and "p/msg/A" in given["library"].names()
    assert main(["build", "p/A", "--path", "."]) == 0
    assert (given["options"], given["force"]) == (Options(), False)
    assert given["out"] == "vhdl_out"
    assert (Options().wire, Options().bus_bytes, Options().ports) == (None, 8, "records")


def proof_tasks(monkeypatch, arguments, status=0):
    """The tasks that `prove` starts."""
    seen = {}

    def run_proofs(tasks, jobs, *, with_summary):
        seen.update(tasks=list(tasks), jobs=jobs, with_summary=with_summary)
        return status

    monkeypatch.setattr(prove_command, "run_proofs", run_proofs)
    assert main(["prove", *arguments]) == status
    return seen


@pytest.mark.parametrize("status", [0, 1])
def test_prove_is_given_all_options_and_gives_its_status(workdir, monkeypatch, status):
    words = [*WORDS, "--timeout", "7", "--jobs", "3", "--distro", "iron"]
    seen = proof_tasks(monkeypatch, ["p/A", "p/srv/S", "--path", ".", *words], status)
    assert seen["jobs"] == 3 and seen["with_summary"] is False
    names = ["p/msg/A", "p/srv/S_Request", "p/srv/S_Response", "p/srv/S_Event"]
    assert [(t.name, t.direction) for t in seen["tasks"]] == [
        (name, direction) for name in names for direction in DIRECTIONS
    ]
    for task in seen["tasks"]:
        assert (task.wire, task.bus_bytes, task.max_message_bytes) == tuple(OPTIONS.values())
        assert (task.timeout, task.distro, task.paths) == (7.0, "iron", (".",))


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_prove_all_is_of_all_messages(workdir, monkeypatch, distro):
    make_files(workdir, {"src/p/msg/Bad.msg": "int33 a\n", "more/q/msg/A.msg": ""})
    make_files(workdir / "src", FILES)
    words = ["--path", "src", "--depends", "more", "--distro", distro]
    seen = proof_tasks(monkeypatch, ["--all", *words])
    assert seen["with_summary"] is True
    library = Library(distro, ["src"])
    names = [name for name in library.interfaces() if name[:2] == "p/" and "Bad" not in name]
    messages = {each.name for name in names for each in library.interface(name).messages}
    messages |= {str(TypeName("p", "msg", "Bad", library.dialect))}
    assert {t.name for t in seen["tasks"]} == messages
    assert len(seen["tasks"]) == 2 * len(messages)
    assert {(t.paths, t.depends) for t in seen["tasks"]} == {(("src",), ("more",))}


def test_list_has_services_and_actions_and_paths_in_their_order(workdir, capsys):
    assert main(["list", "--path", "."]) == 0
    assert capsys.readouterr().out.split() == Library("lyrical", ["."]).interfaces()
    make_files(workdir, {"one/q/msg/Q.msg": "int8 one", "two/q/msg/Q.msg": "int8 two"})
    # What cannot be used is told, too.
    assert main(["list", "--path", "."]) == 1
    out, err = capsys.readouterr()
    assert out.split() == Library("lyrical", ["."]).interfaces()
    assert "q/msg/Q" in out and "'./one/q', './two/q'" in err
    for paths, word in ((("one", "two"), "one"), (("two", "one"), "two")):
        words = [word for path in paths for word in ("--path", path)]
        assert main(["show", "q/Q", *words]) == 0
        assert capsys.readouterr().out == f"int8 {word}\n"
    # The folder of a file comes before all paths.
    for word, path in (("one", "two"), ("two", "one")):
        assert main(["show", f"{word}/q/msg/Q.msg", "--path", path]) == 0
        assert capsys.readouterr().out == f"int8 {word}\n"


@pytest.mark.parametrize(
    ("number", "is_good"),
    [("0", False), ("1", False), ("4294967295", True), ("4294967296", False), ("0x400", True)],
)
def test_sizes_of_messages_have_32_bits(workdir, capsys, number, is_good):
    # One byte is a legal limit, but too small for the type.
    words = ["plan", "p/A", "--path", ".", "--max-message-bytes", number]
    if is_good:
        assert main(words) == 0
        assert head_of(capsys.readouterr().out).max_message_bytes == int(number, 0)
    elif number == "1":
        assert main(words) == 1
    else:
        with pytest.raises(SystemExit, match="2"):
            main(words)


def test_plans_of_several_messages_are_kept_apart(workdir, capsys):
    assert main(["plan", "p/srv/S", "--path", "."]) == 0
    texts = capsys.readouterr().out.split("---\n")
    assert [head_of(text).message for text in texts] == [
        "p/srv/S_Request", "p/srv/S_Response", "p/srv/S_Event"
    ]  # fmt: skip


def test_sums_are_of_noetic_unless_a_recording_says_otherwise(workdir, capsys):
    bag, mcap = make_recording(workdir, "bag"), make_recording(workdir, "mcap")
    assert main(["md5", "p/A", "--path", "."]) == 0
    assert main(["md5", "my_msgs/Wheel", "--bag", str(bag)]) == 0
    capsys.readouterr()
    assert main(["md5", "my_msgs/Wheel", "--bag", str(mcap)]) == 1
    assert "md5 sums are for ROS 1" in capsys.readouterr().err
    assert main(["md5", "p/A", "--path", ".", "--distro", "iron"]) == 1


@pytest.mark.parametrize(
    ("error", "status", "stderr"),
    [
        (DefinitionError([Diagnostic(message="wrong")]), 1, "error: wrong\n"),
        (BuildError("no"), 1, "error: no\n"),
        (OSError(28, "No space left on device", "x"), 1, "error: 'x': No space left on device\n"),
        (OSError(28, "No space left on device"), 1, "error: No space left on device\n"),
        (PermissionError(13, "Permission denied", "y"), 1, "error: 'y': Permission denied\n"),
        (OSError("odd"), 1, "error: odd\n"),
        (MemoryError(), 1, "error: there is not enough memory for this\n"),
        (RecursionError("deep"), 1, "error: the input nests too deeply\n"),
        (KeyboardInterrupt(), 130, "interrupted\n"),
    ],
)
def test_every_exception_sets_the_exit_status(workdir, capsys, monkeypatch, error, status, stderr):
    def fail(*args, **options):
        raise error

    monkeypatch.setattr(BUILD, "build", fail)
    assert main(["build", "p/A", "--path", "."]) == status
    assert capsys.readouterr() == ("", stderr)


@pytest.mark.parametrize("command", ["verify", "golden", "cover", "report", "prove", "bench"])
@pytest.mark.parametrize(("returned", "status"), [(None, 0), (0, 0), (1, 1), (3, 3)])
def test_command_returns_the_status_of_its_function(monkeypatch, command, returned, status):
    module = importlib.import_module(RUN[command])
    monkeypatch.setattr(module, f"run_{command}", lambda given: returned)
    words = {"golden": ["check", "x"], "report": ["x"]}.get(command, ["std_msgs/msg/Bool"])
    assert main([command, *words]) == status


def test_proto_has_quotes_unless_told_otherwise(workdir, capsys):
    assert main(["proto", "p/srv/S", "--path", "."]) == 0
    assert capsys.readouterr().out == '"a: 0\n"\n'
    assert main(["proto", "p/srv/S", "--path", ".", "--no-quotes"]) == 0
    assert capsys.readouterr().out == "a: 0\n\n"


def test_figures_are_of_the_wire_and_in_the_form_that_were_asked_for(workdir, capsys):
    assert main(["metrics", "p/A", "--path", ".", "--wire", "ros1", "--format", "json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["wire"], row["min_bytes"]) == ("ros1", 9)


def test_the_environment_is_searched_after_paths(workdir, capsys, monkeypatch):
    make_files(workdir / "ws", {"share/q/msg/Q.msg": "int8 workspace"})
    make_files(workdir / "dir", {"q/msg/Q.msg": "int8 path"})
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.fspath(workdir / "ws"))
    assert main(["show", "q/Q"]) == 0
    assert capsys.readouterr().out == "int8 workspace\n"
    assert main(["show", "q/Q", "--path", "dir"]) == 0
    assert capsys.readouterr().out == "int8 path\n"


def test_no_arguments_are_not_those_of_the_process(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["firm-hdl", "--version"])
    for called, status, streams in (
        ([], 2, ["", "the following arguments are required: COMMAND"]),
        ((), 2, ["", "the following arguments are required: COMMAND"]),
        (None, 0, ["firm-hdl ", ""]),
    ):
        with pytest.raises(SystemExit) as ended:
            main(called)
        found = capsys.readouterr()
        assert ended.value.code == status
        assert all(text in each for each, text in zip(found, streams, strict=True))
        assert [bool(each) for each in found] == [bool(text) for text in streams]
