"""Tracing of the branches that code takes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import firm_hdl.covering.branches
from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.covering.branches import branches, traced
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out

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
    head = f"test_branches.py {function.__name__}:"
    assert {name for name in found if name.startswith(head)} == {
        f"{head}{first + start}->{first + end}" for start, end in steps
    }


def test_branches_of_all_folders_are_found():
    for folders in ([HERE, HERE.parent / "verify"], [HERE.parent / "verify", HERE]):
        assert traced(lambda: choose(True), folders) == traced(lambda: choose(True), [HERE])


def test_other_folders_are_not_traced():
    # "cover" is no folder around this one, although the names begin alike.
    for other in ("verify", "cover"):
        assert traced(lambda: choose(True), [HERE.parent / other]) == frozenset()


def test_earlier_trace_function_is_restored():
    def tracer(frame, event, argument):
        return None

    before = sys.gettrace()
    sys.settrace(tracer)
    try:
        traced(lambda: choose(True), [HERE])
        after = sys.gettrace()
    finally:
        sys.settrace(before)
    assert after is tracer


def test_work_that_fails_ends_the_tracing():
    before = sys.gettrace()
    with pytest.raises(ZeroDivisionError):
        traced(lambda: 1 // 0, [HERE])
    assert sys.gettrace() is before


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


def test_the_converters_that_are_traced_have_the_plan_s_width_and_limit(monkeypatch):
    made = []

    def keep(kind):
        def keeping(*arguments, **options):
            made.append(kind(*arguments, **options))
            return made[-1]

        return keeping

    for kind in (build_plan, Deserializer, Serializer):
        monkeypatch.setattr(firm_hdl.covering.branches, kind.__name__, keep(kind))
    message = load_message("std_msgs/msg/String")
    plan = build_plan(lay_out(message, "ros1"), bus_bytes=2, max_message_bytes=100)
    branches(message, plan)
    planned, *converters = made
    assert planned == plan
    assert [type(converter) for converter in converters] == [Deserializer, Serializer]
    assert [converter.plan for converter in converters] == [plan, plan]
