"""Selection of tests: the lines of a change, and the order of tests."""

from __future__ import annotations

from pathlib import Path

import pytest

from tools.mutation.map.coverage_map import SHARED, CoverageMap, Part, Test
from tools.mutation.map.selection import BATCH_SECONDS, batches, changed_lines, judges
from tools.mutation.mutants import Change, identify
from tools.mutation.rules.grammar_rules import changes as grammar_changes
from tools.mutation.systems import REST, SYSTEMS, mirrors, system_of, test_files

ROOT = Path(__file__).parents[2]
PATH = "firm_hdl/wire/layout.py"
TEXT = """
LIMIT = (
    1 + 1
)

@cache
def choose(x,
           y=2):
    if (x and
            y):
        return [
            x,
            y + 1,
        ]
    match x:
        case 1:
            y += 1
        case 2:
            y += 2
    try:
        y -= 1
    except Error:
        return 3
    else:
        return 4
"""


def mutant_at(path, text, line):
    start = sum(map(len, text.splitlines(keepends=True)[: line - 1]))
    change = Change(start=start, end=start, new="", rule="rule", scope="")
    (mutant,) = identify(path, "layout", text, [change])
    return mutant


@pytest.mark.parametrize(
    ("what", "wanted"),
    {
        "1 + 1": {2, 3, 4},
        "y=2": {7, 8},
        "x and": {9, 10},
        "y + 1": {11, 12, 13, 14},
        # The line of a case alone does not show that the case is tried.
        "case 2": {15, 18},
        "y += 2": {19},
        "except": {22},
        "return 4": {25},
    }.items(),
)
def test_a_change_needs_its_statement_without_the_body(tmp_path, what, wanted):
    path = tmp_path / PATH
    path.parent.mkdir(parents=True)
    path.write_text(TEXT)
    line = next(n for n, text in enumerate(TEXT.splitlines(), 1) if what in text)
    mutant = mutant_at(PATH, TEXT, line)
    assert changed_lines(tmp_path, mutant) == [(PATH, frozenset(wanted))]


@pytest.mark.parametrize("name", ["ros1_msg", "ros2_msg", "idl/idl"])
def test_a_grammar_needs_the_line_that_loads_it(name):
    path = f"firm_hdl/frontend/{name}.lark"
    text = (ROOT / path).read_text()
    (mutant, *_) = identify(path, "grammar", text, grammar_changes(text))
    ((module, lines),) = changed_lines(ROOT, mutant)
    loading = [(ROOT / module).read_text().splitlines()[line - 1] for line in lines]
    assert [("joinpath" in line, ".lark" in line) for line in loading] == [(True, True)]


def test_tests_that_run_the_line_come_first_and_others_are_left_out(tmp_path):
    tests = [
        Test(name=f"tests/wire/test_layout.py::test_it[{n}]", cpu_seconds=3.0 - n, opaque=False)
        for n in range(3)
    ]
    tests.append(Test(name="tests/wire/test_layout.py::test_other", cpu_seconds=2.5, opaque=False))
    line = 19
    here = 1 << line
    parts = [
        Part(tests=tests, lines={PATH: dict.fromkeys("0123", here)}),
        Part(
            tests=[
                Test(name="tests/a.py::test_that_uses_a_fixture", cpu_seconds=0.1, opaque=False),
                Test(name="tests/a.py::test_beside", cpu_seconds=0.0, opaque=False),
            ],
            lines={PATH: {SHARED: here, "0": 2}},
        ),
        Part(
            tests=[
                Test(name="tests/b.py::test_of_another_line", cpu_seconds=0.0, opaque=False),
                Test(name="tests/b.py::test_that_nobody_sees", cpu_seconds=0.0, opaque=True),
            ],
            lines={PATH: {"0": here << 1, SHARED: here << 1}},
        ),
    ]
    found = CoverageMap(parts=parts, complete=True, tree="")
    path = tmp_path / PATH
    path.parent.mkdir(parents=True)
    path.write_text(TEXT)
    found_judges = judges(tmp_path, found, mutant_at(PATH, TEXT, line))
    assert [test.name.partition("::test_")[2] for test in found_judges] == [
        "it[2]",
        "it[1]",
        "other",
        "it[0]",
        "that_uses_a_fixture",
        "beside",
        "that_nobody_sees",
    ]


def test_runs_are_short_at_first_and_keep_files_together():
    def test(name, seconds):
        return Test(name=name, cpu_seconds=seconds, opaque=False)

    first = [test("a::1", 1), test("b::1", 1), test("a::2", 1), test("b::2", BATCH_SECONDS[0] - 3)]
    second = [test("a::3", 1), test("a::4", BATCH_SECONDS[1] - 1)]
    assert [[each.name for each in batch] for batch in batches([*first, *second])] == [
        ["a::1", "a::2", "b::1", "b::2"],
        ["a::3", "a::4"],
    ]
    # A test that is too long for any run has a run of its own.
    (long,) = batches([test("a::1", 1e6)])
    assert len(long) == 1
    assert batches([]) == []


def test_every_test_file_is_of_one_system_or_of_the_rest():
    names = test_files(ROOT)
    assert {system_of(name) for name in names} == {*SYSTEMS, REST}
    assert not any(name.startswith("tests/mutation") for name in names)
    assert system_of("tests/frontend/idl/test_read.py::test_it[1]") == "ts1"
    assert system_of("tests/export/vhdl/test_bench.py") == "ghdl"
    assert system_of("tests/cli/test_cli.py") == "rest"
    assert test_files(ROOT, ["tests/wire"]) == [name for name in names if "tests/wire/" in name]
    assert mirrors("tests/frontend/idl/test_parse.py", "firm_hdl/frontend/idl/idl.lark")
    assert not mirrors("tests/frontend/test_parse.py", "firm_hdl/frontend/idl/idl.lark")
    assert mirrors("tests/frontend/hostile/test_fuzz.py", "firm_hdl/frontend/fuzz.py")
