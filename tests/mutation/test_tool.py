"""The tool on a small project: what is noticed, what is not, and going on after an interruption."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.mutation.__main__ import main
from tests.mutation.explained import Explanation, explain, read_explanations
from tests.mutation.mutants import identify
from tests.mutation.python_rules import changes
from tests.mutation.report import markdown
from tests.mutation.results import Record, append, read
from tests.mutation.systems import SYSTEMS, mirrored, rest, stages
from tests.mutation.targets import TARGETS, all_mutants, files, sample
from tests.mutation.workshop import Run

ROOT = Path(__file__).parents[2]
MODULE = """
def double(x):
    return x + x


def halve(x):
    y = 0
    while x:
        x -= 2
        y = y.__add__(len("a"))
    return y


def untested(x):
    return x < x
"""
TESTS = """
from firm_hdl.wire.toy import double, halve

def test_double():
    assert double(3) == 6

def test_halve():
    assert halve(8) == 4
"""


@pytest.fixture
def toy(tmp_path):
    root = tmp_path / "toy"
    for name, text in {
        "firm_hdl/__init__.py": "",
        "firm_hdl/wire/__init__.py": "",
        "firm_hdl/wire/toy.py": MODULE,
        "tests/__init__.py": "",
        "tests/wire/__init__.py": "",
        "tests/wire/test_toy.py": TESTS,
    }.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    shutil.copytree(Path(__file__).parent, root / "tests" / "mutation")
    return root


def run(toy, *more):
    out = toy.parent / "out.jsonl"
    options = ["--root", str(toy), "--out", str(out), "--first", "--trust", "2", *more]
    assert main(options) == 0
    return out, read(out)


def test_mutants_are_killed_or_survive_or_time_out_and_runs_resume(toy, capsys):
    out, found = run(toy)
    assert f"{len(found)} to run" in capsys.readouterr().err
    records = {(each.scope, each.rule): each for each in found.values()}
    assert records["double", "operator"].status == "killed"
    assert records["double", "operator"].runs["ts2"].by == "tests/wire/test_toy.py::test_double"
    # It never ends.
    assert records["halve", "delete assignment"].runs["ts2"].status == "timeout"
    assert records["untested", "comparison"].status == "survived"
    assert (toy / "firm_hdl/wire/toy.py").read_text() == MODULE

    # An interrupted run: the last line is half there.
    lines = out.read_bytes().splitlines(keepends=True)
    out.write_bytes(b"".join(lines[:-1]) + lines[-1][:20])
    _, again = run(toy)
    assert "1 to run" in capsys.readouterr().err
    assert {key: each.status for key, each in again.items()} == {
        key: each.status for key, each in found.items()
    }


def test_a_project_whose_tests_fail_is_not_judged(toy, capsys):
    (toy / "tests/wire/test_toy.py").write_text("def test_it():\n    assert False\n")
    out = str(toy.parent / "out.jsonl")
    assert main(["--root", str(toy), "--out", out, "--count", "1"]) == 1
    assert "fails without a fault: tests/wire/test_toy.py::test_it" in capsys.readouterr().err
    assert not Path(out).exists()


def test_keys_outlive_moved_lines():
    before = identify("a.py", "plan", MODULE, changes(MODULE))
    moved = "import this\n\n" + MODULE.replace("def halve", "def other(): ...\n\n\ndef halve")
    after = identify("a.py", "plan", moved, changes(moved))
    assert [each.key for each in before] == [each.key for each in after]
    assert [each.line for each in before] != [each.line for each in after]
    assert len({each.key for each in before}) == len(before)


def test_samples_are_spread_and_repeatable():
    mutants = all_mutants(ROOT, ["layout", "plan"])
    chosen = sample(ROOT, mutants, 30, 1)
    assert chosen == sample(ROOT, mutants, 30, 1) != sample(ROOT, mutants, 30, 2)
    assert [sum(each.target == name for each in chosen) for name in ("layout", "plan")] == [15, 15]
    assert len({each.path for each in chosen}) >= 5


def test_all_targets_and_test_files_exist():
    for target in TARGETS:
        assert files(ROOT, target), target
    for system, groups in SYSTEMS.items():
        for group in groups:
            for pattern in group:
                assert list(ROOT.glob(pattern)), (system, pattern)


def test_what_mirrors_a_module_comes_first_and_every_test_once():
    path = "firm_hdl/frontend/idl/values.py"
    assert mirrored(path) == "tests/frontend/idl"
    groups = stages(ROOT, "ts1", path)
    assert groups[0][0] == "tests/frontend/idl/test_values.py"
    assert all(name.startswith("tests/frontend/idl") for name in groups[0][:3])
    met = {name for group in groups for name in group}
    others = rest(ROOT, path, met)
    assert met.isdisjoint(others)
    assert not any(name.startswith("tests/mutation") for name in others)


def test_an_explanation_is_of_one_change_wherever_it_is(tmp_path):
    out = tmp_path / "out.jsonl"
    (mutant, *_) = identify("firm_hdl/wire/toy.py", "layout", MODULE, changes(MODULE))
    record = Record.of(mutant, {"rest": Run(status="passed", by="", cpu_seconds=1.0)})
    append(out, record)
    assert list(read(out).values()) == [record]
    given = {name: getattr(record, name) for name in ("path", "scope", "rule", "old", "new")}
    known = [Explanation(**given, kind="cost", why="It is as good.")]
    assert explain(record, known) is known[0]
    assert "Survivors with" in markdown([record], known)
    other = [Explanation(**{**given, "new": "return 1"}, kind="cost", why="It is as good.")]
    assert explain(record, other) is None
    assert "Survivors without" in markdown([record], other)


def test_explanations_are_of_what_is_there():
    for each in read_explanations():
        target = next(name for name in TARGETS if ROOT / each.path in files(ROOT, name))
        mutants = [m for m in all_mutants(ROOT, [target]) if m.path == each.path]
        there = {(m.change.scope, m.change.rule, m.place.old, m.place.new) for m in mutants}
        assert (each.scope, each.rule, each.old, each.new) in there, each
        assert each.why
