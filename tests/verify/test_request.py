"""The types of a request, the run of a workload, and what its results are bound to."""

from __future__ import annotations

import os
import shlex
from dataclasses import fields, replace
from typing import ClassVar

import pytest

import firm_hdl.verify.run as run
from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.verify.command import Workload, resolve
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.verdict import Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import System
from firm_hdl.verify.systems.tasks import UnknownTypeError
from tests.frontend.recordings import make_recording
from tests.frontend.workspace import make_files
from tests.verify.report.samples import a_record, a_test
from tests.verify.robot import robot, write


def names_of(work):
    return [(task.distro, task.name) for task in work.tasks]


def test_types_of_several_packages_of_the_workspace_are_found(tmp_path, monkeypatch):
    texts = {"a/share/a_msgs/msg/A.msg": "int8 x\n", "b/share/b_msgs/msg/B.msg": "int8 x\n"}
    make_files(tmp_path, texts)
    prefixes = [str(tmp_path / name) for name in "ab"]
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join(prefixes))
    work = resolve(Request(types=("a_msgs/A", "b_msgs/B")))
    assert names_of(work) == [("lyrical", "a_msgs/msg/A"), ("lyrical", "b_msgs/msg/B")]
    assert {os.path.commonpath([path, tmp_path]) for path in work.request.paths} == {str(tmp_path)}
    assert len(work.request.paths) == 2
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    with pytest.raises(DefinitionError):
        resolve(Request(types=("b_msgs/B",), paths=(f"{prefixes[0]}/share",)))


def test_of_names_that_are_partly_unknown_the_others_are_tested():
    work = resolve(Request(types=("std_msgs/Bool", "no_msgs/Such"), distros=("lyrical",)))
    assert names_of(work) == [("lyrical", "std_msgs/msg/Bool")]
    assert list(work.problems) == ["error: no distribution has no_msgs/msg/Such"]


def test_own_types_are_read_by_the_rules_of_each_distribution(tmp_path):
    texts = {"own/p/msg/A.msg": "q/B b\n", "own/p/msg/Bad.msg": "int8\n", "more/q/msg/B.msg": ""}
    make_files(tmp_path, texts)
    own, more = str(tmp_path / "own"), str(tmp_path / "more")
    request = Request(paths=(own,), depends=(more,), distros=("noetic", "lyrical"))
    work = resolve(request)
    assert sorted(names_of(work)) == [("lyrical", "p/msg/A"), ("noetic", "p/A")]
    assert work.request == request and work.problems
    for depends in (more, own):
        # The same folder may be named twice.
        found = names_of(resolve(Request(paths=(own,), depends=(more, depends))))
        assert found == [("lyrical", "p/msg/A")]


def test_types_that_others_depend_on_are_not_judged_and_commands_name_their_folder(
    tmp_path, monkeypatch, capsys
):
    make_files(tmp_path, {"own/p/msg/A.msg": "q/B b\n", "more/q/msg/B.msg": "int8 x\n"})
    monkeypatch.chdir(tmp_path)
    words = ["verify", "--path", "own", "--depends", "more", "--jobs", "1", "--results", "r.jsonl"]
    words += ["--systems", "ts1,ts2,ts3", "--cases", "1", "--no-stalls", "--oracle", "rosbags"]
    assert main([*words, "--all"]) == 0
    found = read_results("r.jsonl")
    assert [(test.system, test.type) for test in found.planned] == [
        (system, "p/msg/A") for system in ("ts1", "ts2", "ts3")
    ]
    for record in found.records.values():
        program, *again = shlex.split(record.command)
        assert program == "firm-hdl" and "--path own --depends more" in record.command
        if record.test.system == "ts1":
            assert main([*again, "--jobs", "1"]) == 0
    # A folder without definitions has nothing to judge.
    (tmp_path / "own/p/msg/A.msg").unlink()
    assert main(["verify", "--systems", "ts1", "--all", *words[1:7]]) == 1
    assert "no test was judged" in capsys.readouterr().out


def test_a_recording_has_one_wire(tmp_path):
    bag = str(make_recording(tmp_path, "mcap"))
    assert ("lyrical", "my_msgs/msg/Wheel") in names_of(resolve(Request(bags=(bag,), wire="cdr")))
    with pytest.raises(UnknownTypeError, match="has messages of cdr, not of ros1"):
        resolve(Request(bags=(bag,), wire="ros1"))


def test_types_that_a_recording_has_no_topic_of_are_looked_up_nowhere_else(tmp_path, monkeypatch):
    make_files(tmp_path, {"a/share/std_msgs/msg/Header.msg": "int8 x\n"})
    bag = str(write(tmp_path / "run", "mcap", robot("mcap")))
    # It is a part of a recorded type. The distribution and the workspace have it, too.
    request = Request(types=("std_msgs/Header",), distros=("lyrical",))
    assert names_of(resolve(request)) == [("lyrical", "std_msgs/msg/Header")]
    for variable in ("AMENT_PREFIX_PATH", "NO_PREFIX_PATH"):
        monkeypatch.setenv(variable, str(tmp_path / "a"))
        with pytest.raises(UnknownTypeError, match=r"^There is no topic of std_msgs/msg/Header, "):
            resolve(replace(request, bags=(bag,)))
        monkeypatch.delenv(variable)


class FixedSystem(System):
    """A test system with one test and a given verdict."""

    tests: ClassVar = []
    options: ClassVar = {}

    def __init__(self, name, verdict):
        self.name, self.verdict = name, verdict
        self.tests = [a_test(system=name)]
        self.options = {f"of {name}": 1}

    def records(self, writer):
        record = a_record(self.tests[0], verdict=self.verdict)
        writer.add(record)
        return [record]


@pytest.fixture
def fixed(monkeypatch):
    """Replace the test systems by those with the given verdicts, by their names."""

    def fix(**verdicts):
        made = {
            name: lambda work, name=name, each=each: [FixedSystem(name, each)]
            for name, each in verdicts.items()
        }
        monkeypatch.setattr(run, "SYSTEMS", made)

    return fix


def workload(problems=None, **options):
    return Workload(request=Request(**options), tasks=(), problems=problems or {})


def test_results_are_bound_to_all_inputs(tmp_path, fixed):
    fixed(ts1=Passed(1), ts3=Passed(1))
    inputs = "src/p/msg/A.msg", "golden/x.yaml", "node.yaml", "b.bag", "more/q/msg/B.msg"
    make_files(tmp_path, dict.fromkeys(inputs, ""))
    source, golden, node, bag, more = (
        str(tmp_path / n) for n in ("src", "golden", "node.yaml", "b.bag", "more")
    )
    given = {"paths": (source,), "golden": golden, "node": node, "bags": (bag,), "wire": "cdr"}
    given |= {"depends": (more,)}
    given |= {"systems": ("ts3", "ts1"), "widths": (4, 8), "results": str(tmp_path / "r.jsonl")}
    assert run.run_workload(workload(**given)) == 0
    found = read_results(tmp_path / "r.jsonl")
    assert (found.options["of ts3"], found.options["of ts1"]) == (1, 1)
    assert [test.system for test in found.planned] == ["ts3", "ts1"] and not found.missing
    assert "definitions that are refused" not in found.sessions[0]
    for number, name in enumerate(inputs):
        before = (tmp_path / name).read_text()
        times = os.stat(tmp_path / name)
        (tmp_path / name).write_text(f"changed {number}")
        with pytest.raises(UserError, match="is of another run: inputs was"):
            run.run_workload(workload(**given))
        (tmp_path / name).write_text(before)
        os.utime(tmp_path / name, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert run.run_workload(workload(**given)) == 0


# Types are in the keys of the tests; results do not depend on the others.
FREE = {"types", "jobs", "results", "report", "vcd", "silent_seconds"}
# Libraries under test have no file of results.
FREE |= {"bus_bytes", "simulated", "libraries"}


def other_value(usual, name, tmp_path):
    """Return another value of an option."""
    value = getattr(usual, name)
    if name in ("paths", "depends", "bags", "golden", "node"):
        other = str(make_files(tmp_path / "other", {"p/msg/A.msg": ""}))
        return (other,) if isinstance(value, tuple) else other
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    others = {"widths": (2,), "systems": ("ts3", "ts3"), "share_circuits": False, "most_cases": 7}
    return others.get(name, ("x",) if isinstance(value, tuple) or name == "references" else "x")


def test_results_are_bound_to_each_option(tmp_path, fixed):
    fixed(ts3=Passed(1))
    usual = Request(results=str(tmp_path / "r.jsonl"))
    work = Workload(request=usual, tasks=(), problems={})
    assert run.run_workload(work) == run.run_workload(work) == 0
    for name in {each.name for each in fields(Request)} - {*FREE}:
        request = replace(usual, **{name: other_value(usual, name, tmp_path)})
        try:
            run.run_workload(replace(work, request=request))
        except UserError as error:
            assert "is of another run: " in str(error), name
        else:
            pytest.fail(f"results do not depend on {name}")


def test_a_board_without_a_node_sends_the_named_types_back():
    types = ("std_msgs/Bool", "std_msgs/msg/Int8")
    given = {"board": "sim", "systems": ("board",), "distros": ("lyrical",), "types": types}
    work = resolve(Request(**given))
    assert names_of(work) == [("lyrical", "std_msgs/msg/Bool"), ("lyrical", "std_msgs/msg/Int8")]
    assert len(work.board.loops()) == 2
    assert resolve(Request(types=types)).board is None
