"""A run as a whole: what it prints, and what its file of results says of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import ClassVar

import pytest

from firm_hdl.verify import run
from firm_hdl.verify.request import Workload
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.records import Test as Planned
from firm_hdl.verify.results.verdict import NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import Judged, System


class Fake(System):
    """A system with one test that is not recorded."""

    tests: ClassVar = ()
    options: ClassVar = {}

    def __init__(self, name, verdict):
        self.name, self.verdict = name, verdict
        self.tests = [Planned(system=name, distro="iron", type="p/A")]
        self.options = {name: "chosen"}

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return None

    def run(self, recorder):
        return [Judged(what=f"{self.name} of p/A", verdict=self.verdict)]


@pytest.fixture
def run_of(monkeypatch):
    """A function that runs two systems, of which the second one does not judge."""
    systems = {"ts1": Fake("ts1", Passed(1)), "ts2": Fake("ts2", NotJudged("nobody can"))}
    monkeypatch.setattr(run, "SYSTEMS", {n: lambda _, one=one: one for n, one in systems.items()})

    def run_workload(*problems, **asked):
        request = Request(systems=("ts1", "ts2"), **asked)
        found = {text: SimpleNamespace() for text in problems}
        return run.run_workload(Workload(request=request, tasks=(), problems=found))

    return run_workload


def test_what_was_not_judged_is_printed_and_problems_are_errors(run_of, capsys):
    assert run_of() == 0
    said = capsys.readouterr()
    assert said.out.splitlines() == [
        "not judged: ts2 of p/A: nobody can",
        "1 of 2 tests was not judged",
    ]
    assert said.err == ""
    assert run_of("p/B.msg:1:1: error: no", "p/A.msg:2:1: error: no") == 1
    said = capsys.readouterr()
    assert "error" not in said.out
    assert said.err == "p/B.msg:1:1: error: no\np/A.msg:2:1: error: no\n"


def test_a_file_of_results_has_the_options_of_all_systems(run_of, tmp_path):
    file, node = tmp_path / "r.jsonl", tmp_path / "node.yaml"
    node.write_text("topics: {}\n")
    asked = {"results": str(file), "wire": "cdr", "node": str(node)}
    run_of("p/B is bad", "p/A is bad", **asked)
    found = read_results(file)
    options = dict(found.options)
    assert (options["ts1"], options["ts2"], options["wire"]) == ("chosen", "chosen", "cdr")
    assert [test.system for test in found.planned] == ["ts1", "ts2"]
    assert '"definitions that are refused": "2: p/A is bad"' in file.read_text()
    assert found.failure == (
        "1 of 2 tests was not judged, although named; 2 definitions are refused"
    )
    # The node is an input: another one makes another run.
    node.write_text("topics: {a: 1}\n")
    other = tmp_path / "other.jsonl"
    run_of(**{**asked, "results": str(other)})
    assert read_results(other).options["inputs"] != options["inputs"]
    usual = tmp_path / "usual.jsonl"
    run_of(results=str(usual))
    assert read_results(usual).failure == ""
