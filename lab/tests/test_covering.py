"""The branches that code takes, and types that take them all."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from lab.covering import branches, main, traced

HERE = Path(__file__).parent
# Modules inside of converters, and one inside of another one.
INNER = ("parse/buffer.py", "parse/sequencer.py", "mover.py")


def choose(flag):
    if flag:
        return 1
    return 2


def test_each_way_is_a_branch_of_its_own():
    yes = traced(lambda: choose(True), [HERE])
    no = traced(lambda: choose(False), [HERE])
    assert any("choose" in branch for branch in yes - no)
    assert any("choose" in branch for branch in no - yes)
    assert yes & no


def count(most):
    found = 0
    while found < most:
        found += 1
    return found


@pytest.mark.parametrize(
    ("function", "argument", "steps"),
    [
        (choose, True, [(0, 1), (1, 2)]),
        (choose, False, [(0, 1), (1, 3)]),
        (count, 0, [(0, 1), (1, 2), (2, 4)]),
        (count, 2, [(0, 1), (1, 2), (2, 3), (3, 2), (2, 4)]),
    ],
)
def test_a_branch_is_named_by_file_function_and_both_of_its_lines(function, argument, steps):
    first = function.__code__.co_firstlineno
    found = traced(lambda: function(argument), [HERE])
    head = f"test_covering.py {function.__name__}:"
    assert {name for name in found if name.startswith(head)} == {
        f"{head}{first + start}->{first + end}" for start, end in steps
    }


def test_other_folders_are_not_traced():
    # "cover" is no folder around this one, although the names begin alike.
    for other in ("verify", "cover"):
        assert traced(lambda: choose(True), [HERE.parent / other]) == frozenset()


def test_work_that_fails_ends_the_tracing():
    before = sys.gettrace()
    with pytest.raises(ZeroDivisionError):
        traced(lambda: 1 // 0, [HERE])
    assert sys.gettrace() is before


@pytest.mark.thorough
def test_types_differ_by_what_the_generator_does_for_them():
    found = {}
    for name in ("std_msgs/msg/Bool", "std_msgs/msg/String"):
        message = load_message(name)
        found[name] = branches(message, build_plan(lay_out(message)))
    string, boolean = found["std_msgs/msg/String"], found["std_msgs/msg/Bool"]
    assert any(branch.startswith("gateware/") for branch in string - boolean)
    # Also of modules inside of a converter.
    for inner in INNER:
        assert any(branch.startswith(f"gateware/{inner} elaborate:") for branch in boolean)
    assert boolean == branches(
        load_message("std_msgs/msg/Bool"), build_plan(lay_out(load_message("std_msgs/msg/Bool")))
    )


@pytest.mark.thorough
def test_the_chosen_types_take_all_branches_and_fewer_do_not(tmp_path, capsys):
    names = ["std_msgs/msg/Bool", "std_msgs/msg/Int8", "std_msgs/msg/String"]
    file = tmp_path / "chosen.txt"
    assert main([*names, "--out", str(file)]) == 0
    assert "std_msgs/msg/String\n" in file.read_text()
    assert main([*names, "--check", str(file)]) == 0
    file.write_text("std_msgs/msg/Bool\n")
    assert main([*names, "--check", str(file)]) == 1
    assert "branch: gateware/" in capsys.readouterr().out
