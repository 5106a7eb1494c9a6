"""The tool on a small project: killed mutants, survivors, and resumption of a run."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.depth import by_depth
from tools.mutation.__main__ import main
from tools.mutation.map.store import moved
from tools.mutation.mutants import identify
from tools.mutation.results import read
from tools.mutation.rules.python_rules import changes
from tools.mutation.targets import TARGETS, all_mutants, files, sample

ROOT = Path(__file__).parents[2]
MODULE = """
from functools import cache

LIMIT = 7


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


@cache
def table():
    return ["a"] * 3


def elsewhere(x):
    return x // 3


def hidden(x):
    return x ** 3


def deadly(x):
    return x & 2


def written(x):
    return x / 2


NAMES = dict.fromkeys("ab") | {}
"""
# Rules that apply to the toy project.
RULES = ["operator", "delete assignment", "comparison", "number + 1"]
HEAD = """
import os, signal, subprocess, sys
import pytest
from firm_hdl.wire import toy
"""
TESTS = f"""{HEAD}
def test_double():
    assert toy.double(3) == 6

@pytest.mark.parametrize("x", [0, 8])
def test_halve(x):
    assert toy.halve(x) == x / 2

def test_that_needs_the_table_first():
    toy.table()

def test_the_table():
    assert len(toy.table()) == 3

def test_the_limit():
    assert toy.LIMIT == 7

@pytest.mark.snapshot
def test_what_was_written():
    assert toy.written(6) == 3 and toy.double(3) == 6
"""
PROCESS_TESTS = f"""{HEAD}
def run(what):
    code = f"import sys, os; from firm_hdl.wire.toy import *; {{what}}"
    return subprocess.run([sys.executable, "-c", code]).returncode

def test_elsewhere():
    assert run("sys.exit(elsewhere(27))") == 9

def test_hidden():
    assert run("os._exit(hidden(3))") == 27

def test_deadly():
    if toy.deadly(3) != 2:
        os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture
def toy(tmp_path):
    """A repository with a small package, its tests, and the tool."""
    root = tmp_path / "toy"
    for name, text in {
        "firm_hdl/__init__.py": "",
        "firm_hdl/wire/__init__.py": "",
        "firm_hdl/wire/toy.py": MODULE,
        "tests/__init__.py": "",
        "pyproject.toml": '[tool.pytest.ini_options]\nmarkers = ["snapshot"]\n',
        "tests/wire/__init__.py": "",
        "tests/wire/test_toy.py": TESTS,
        "tests/test_processes.py": PROCESS_TESTS,
    }.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    shutil.copytree(ROOT / "tools", root / "tools", ignore=shutil.ignore_patterns("__pycache__"))
    return root


def run(toy, *more):
    """Run the command; return its results by scope and rule."""
    out = toy.parent / "out.jsonl"
    places = ["--root", str(toy), "--out", str(out), "--map", str(toy.parent / "map")]
    rules = [] if "--rule" in more else [word for rule in RULES for word in ("--rule", rule)]
    assert main([*places, "--first", "--least", "2", "--seed", "0", *rules, *more]) == 0
    return {(each.scope, each.rule): each for each in read(out).values()}


def parts(toy):
    """Return the files of the coverage map by the names of the test files."""
    found = {}
    for path in (toy.parent / "map").glob("*.json"):
        found[json.loads(path.read_text())["tests"][0]["name"].partition("::")[0]] = path
    return found


@pytest.mark.thorough
def test_just_the_tests_that_run_a_line_judge_it_and_runs_resume(toy, capsys):
    found = run(toy)
    lines = (toy.parent / "out.jsonl").read_bytes().splitlines(keepends=True)
    assert f"{len(lines)} to run" in capsys.readouterr().err
    assert (toy / "firm_hdl/wire/toy.py").read_text() == MODULE
    by = {place: run.by for place, each in found.items() for run in each.runs.values()}
    # A test whose process is not traced may kill it, besides the tests that run the line.
    double = found["double", "operator"]
    assert (double.status, double.tests) == ("killed", 3)
    assert by["double", "operator"] == "tests/wire/test_toy.py::test_double"
    # This mutant never ends; the running test is named.
    assert found["halve", "delete assignment"].killers == ["ts2"]
    assert found["halve", "delete assignment"].runs["ts2"].status == "timeout"
    assert by["halve", "delete assignment"] == "tests/wire/test_toy.py::test_halve[8]"
    assert (found["untested", "comparison"].status, found["untested", "comparison"].tests) == (
        "survived",
        1,
    )
    # The line ran before the test, or for another test.
    assert by["", "number + 1"] == "tests/wire/test_toy.py::test_the_limit"
    assert by["table", "number + 1"] == "tests/wire/test_toy.py::test_the_table"
    # The line ran in another process.
    assert by["elsewhere", "operator"] == "tests/test_processes.py::test_elsewhere"
    assert found["elsewhere", "operator"].killers == ["rest"]
    assert by["hidden", "operator"] == "tests/test_processes.py::test_hidden"
    # A snapshot test kills the mutant, but does not count.
    assert found["written", "operator"].status == "snapshot"
    assert by["written", "operator"] == "tests/wire/test_toy.py::test_what_was_written"
    # Python cannot load the mutant.
    assert found["", "operator"].status == "unloaded"
    # A killed process is no verdict on the mutant.
    assert found["deadly", "operator"].status == "error"

    # An interrupted run: its last result is half written. The coverage map is complete.
    complete_lines = [line for line in lines if b"error" not in line]
    errors = len(lines) - len(complete_lines)
    (toy.parent / "out.jsonl").write_bytes(b"".join(complete_lines[:-1]) + complete_lines[-1][:20])
    again = run(toy)
    printed = capsys.readouterr().err
    assert f"{errors + 1} to run" in printed and "map" not in printed
    assert {place: each.status for place, each in again.items()} == {
        place: each.status for place, each in found.items()
    }


def test_faults_written_by_hand_are_judged(toy, capsys):
    (toy / "tests/test_processes.py").unlink()
    given = toy.parent / "faults.yaml"
    fault = {"path": "firm_hdl/wire/toy.py"}
    faults = [
        {**fault, "old": "x + x", "new": "x + 1", "why": "no double"},
        {**fault, "old": "x + x", "new": "2 * x"},
    ]
    given.write_text(json.dumps(faults))
    found = run(toy, "--faults", str(given))
    assert {scope: each.status for (scope, _), each in found.items()} == {
        "no double": "killed",
        "": "survived",
    }
    assert f"Faults of {given}" in capsys.readouterr().out


@pytest.mark.thorough
def test_a_test_that_the_map_lacks_notices_nothing(toy, capsys):
    more = ["--count", "4", "--target", "wire"]
    (toy / "firm_hdl/wire/toy.py").write_text("def double(x):\n    return x + x\n")
    (toy / "tests/wire/test_toy.py").write_text(TESTS.partition("@")[0])
    (toy / "tests/test_processes.py").unlink()
    found = run(toy, *more)
    assert {each.status for each in found.values()} == {"killed"}
    (part,) = parts(toy).values()
    given = json.loads(part.read_text())
    part.write_text(json.dumps({**given, "lines": {}}))
    (toy.parent / "out.jsonl").unlink()
    assert {(each.status, each.tests) for each in run(toy, *more).values()} == {("survived", 0)}

    # A new file does not change this part; the file itself does, and outdates results.
    capsys.readouterr()
    (toy / "tests/wire/test_other.py").write_text("def test_it():\n    pass\n")
    run(toy, *more, "--keep")
    assert "0 to run" in capsys.readouterr().err
    run(toy, *more)
    printed = capsys.readouterr().err
    assert "1 to run" in printed and "test_other.py" in printed and "test_toy.py" not in printed
    with (toy / "tests/wire/test_toy.py").open("a") as file:
        file.write("\n")
    assert {each.status for each in run(toy, *more).values()} == {"killed"}


@pytest.mark.thorough
def test_mutant_that_not_all_tests_ran_stays_open(toy):
    (toy / "firm_hdl/wire/toy.py").write_text("def half(x):\n    return x // 2\n")
    test = "import pytest\nfrom firm_hdl.wire.toy import half\n\n"
    test += (
        "@pytest.mark.parametrize('x', [0, 8])\ndef test_half(x):\n    assert half(x) == x / 2\n"
    )
    (toy / "tests/wire/test_toy.py").write_text(test)
    (toy / "tests/test_processes.py").write_text("def test_it():\n    pass\n")
    # The parameter set that kills was not traced; it may run the lines of the other one.
    killed = run(toy, "--each", "1e-9")["half", "operator"]
    assert (killed.status, killed.runs["ts2"].by) == (
        "killed",
        "tests/wire/test_toy.py::test_half[8]",
    )
    (toy.parent / "out.jsonl").unlink()
    # The file with the killing test is left out.
    alone = ["--tests", "tests/test_processes.py", "--retry"]
    assert run(toy, *alone)["half", "operator"].status == "open"
    more = ["--tests", "tests/wire"]
    assert run(toy, *more)["half", "operator"].status == "open"
    assert run(toy, *more, "--retry")["half", "operator"].status == "killed"


@pytest.mark.thorough
def test_map_of_an_older_program_is_used(toy, capsys):
    (toy / "tests/test_processes.py").unlink()
    more = ["--rule", "comparison", "--retry"]
    assert run(toy, *more)["untested", "comparison"].status == "survived"
    # Lines move, and one is inserted.
    text = MODULE.replace("    return x < x", "    y = 1\n    return x < y")
    (toy / "firm_hdl/wire/toy.py").write_text(f"# A comment.\n{text}")
    capsys.readouterr()
    found = run(toy, "--rule", "operator", "--keep")
    err = capsys.readouterr().err
    assert "1 of 1 files as they were before" in err and "map: tests" not in err
    assert found["double", "operator"].status == "killed"
    run(toy, *more, "--fresh")
    assert "map: tests/wire/test_toy.py" in capsys.readouterr().err


def test_lines_are_found_again():
    before = "a\nb\nc\nd\ne\n"
    after = "new\na\nb\nB1\nB2\nd\nbehind\ne\n"
    masks = {"0": 0b000110, "1": 0b001000, "2": 0b110000}
    lines = {
        owner: [line for line in range(1, 10) if mask >> line & 1]
        for owner, mask in moved(masks, before, after).items()
    }
    # A replaced line belongs to the tests of the old one, a new line to those of the line before.
    assert lines == {"0": [2, 3], "1": [4, 5], "2": [6, 7, 8]}


def test_a_seed_is_drawn_and_named(toy, capsys):
    named = ["--root", str(toy), "--count", "9", "--list"]
    listed = []
    for seed in ([], ["--seed", "1"], ["--seed", "1"]):
        assert main([*named, *seed]) == 0
        captured = capsys.readouterr()
        assert captured.err.startswith("--seed ")
        listed.append(captured.out.splitlines())
    assert listed[1] == listed[2] and [len(each) for each in listed] == [9, 9, 9]
    # A drawn seed, when given, selects the same mutants again.
    assert main(named) == 0
    captured = capsys.readouterr()
    assert main([*named, "--seed", captured.err.split()[1]]) == 0
    assert capsys.readouterr().out == captured.out
    assert main([*named, "--rule", "operator"]) == 0
    assert {line.split(maxsplit=2)[2] for line in capsys.readouterr().out.splitlines()} == {
        "operator"
    }


def test_a_project_whose_tests_fail_is_not_judged(toy, capsys):
    (toy / "tests/wire/test_toy.py").write_text("def test_it():\n    assert False\n")
    out = str(toy.parent / "out.jsonl")
    options = ["--map", str(toy.parent / "map"), "--count", "1"]
    assert main(["--root", str(toy), "--out", out, *options]) == 1
    assert "fails without a fault: tests/wire/test_toy.py::test_it" in capsys.readouterr().err
    assert not Path(out).exists()
    assert main(["--root", str(toy), "--out", out, *options, "--tests", "tests/nowhere"]) == 1
    assert "error: no tests there" in capsys.readouterr().err


def test_test_that_cannot_be_traced_runs_for_every_mutant(toy):
    (toy / "firm_hdl/wire/toy.py").write_text("def half(x):\n    return x // 2\n")
    (toy / "tests/test_processes.py").unlink()
    (toy / "tests/wire/test_toy.py").write_text(
        "import sys\nfrom firm_hdl.wire.toy import half\n\n"
        "def test_half():\n    assert not sys.gettrace()\n    assert half(6) == 3\n\n"
        "def test_nothing():\n    pass\n"
    )
    found = run(toy)["half", "operator"]
    assert (found.status, found.tests) == ("killed", 1)


def test_keys_outlive_moved_lines():
    before = identify("a.py", "plan", MODULE, changes(MODULE))
    moved = "import this\n\n" + MODULE.replace("def halve", "def other(): ...\n\n\ndef halve")
    after = identify("a.py", "plan", moved, changes(moved))
    assert [each.key for each in before] == [each.key for each in after]
    assert [each.line for each in before] != [each.line for each in after]
    assert len({each.key for each in before}) == len(before)


def test_samples_are_spread_and_repeatable():
    mutants = all_mutants(ROOT, ["wire", "metrics"])
    chosen = sample(ROOT, mutants, 30, 1)
    assert chosen == sample(ROOT, mutants, 30, 1) != sample(ROOT, mutants, 30, 2)
    # The larger target has more mutants, but fewer than in proportion to its size.
    shares = [sum(each.target == name for each in chosen) for name in ("metrics", "wire")]
    assert sum(shares) == 30 and 10 <= shares[0] < shares[1]
    assert len({each.path for each in chosen}) >= 7
    assert len({each.change.rule for each in chosen}) >= 15


def test_the_targets_are_the_whole_program():
    found = [path for target in TARGETS for path in files(ROOT, target)]
    assert all(files(ROOT, target) for target in TARGETS)
    program = {path for kind in ("py", "lark") for path in (ROOT / "firm_hdl").rglob(f"*.{kind}")}
    assert len(found) == len(set(found)) and set(found) == program


def test_every_rule_finds_something_in_the_program():
    targets = ["gateware", "grammar", *by_depth([], ["sim", "plan"])]
    found = {mutant.change.rule for mutant in all_mutants(ROOT, targets)}
    assert len(found) > 40
    assert found >= {"swapped branches", "overridden assignment", "dropped clause", "wrong limit"}
    assert found >= {"swapped operand", "sticky flag", "missing reset", "wrong neighbour"}
    assert found >= {"dropped check", "dropped assignment", "ignored item", "default used"}
