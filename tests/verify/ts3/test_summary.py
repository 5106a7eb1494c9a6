"""The summary that TS3 prints: passed types, times, references, and failures."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl.jobs.executors import ExecutorError
from firm_hdl.jobs.programs import ProgramMissingError
from firm_hdl.verify.results.records import Seconds
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.simulators.crosscheck import Comparison
from firm_hdl.verify.systems.options import Options, Request
from firm_hdl.verify.systems.system import Recorder
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3 import system
from firm_hdl.verify.ts3.result import Result, command_of
from tests.verify.report.samples import a_record, a_test


def result(name, took, **more):
    return Result(distro="lyrical", name=name, seconds=Seconds(testing=took), **more)


PYTHON = SimpleNamespace(simulator="python")


def test_an_empty_run_has_no_summary(capsys):
    system._summarize([], PYTHON)
    assert capsys.readouterr().out == ""


def test_times_are_those_of_the_types_and_the_slowest_come_first(capsys):
    results = [
        result(f"T{n}", took, packets=10, simulated_cycles=100, cases=1)
        for n, took in enumerate([0.25, 4, 1, 3, 2, 0.5, 0.75])
    ]
    system._summarize(results, PYTHON)
    assert capsys.readouterr().out.splitlines() == [
        "7 different types, 70 packets, 700 cycles; seconds per type: median 1.00, most 4.0, "
        "12 in total",
        "slowest: T1 4.0 s, T3 3.0 s, T4 2.0 s, T2 1.0 s, T6 0.8 s",
        "wire bytes: rosbags 7 types",
    ]


def test_references_are_counted_by_types(capsys):
    results = [
        result("A", 1, cases=2, written_by=("genpy", "fastcdr")),
        result("B", 1, cases=1, written_by=("genpy",)),
        result("C", 1, cases=0, written_by=("genpy",)),
    ]
    system._summarize(results, PYTHON)
    output = capsys.readouterr().out.splitlines()[-1]
    assert output == "wire bytes: rosbags 2 types, genpy 2 types, fastcdr 1 types"
    system._summarize([result("C", 1)], PYTHON)
    assert capsys.readouterr().out.splitlines()[-1] == "wire bytes: no library wrote any"


def test_another_simulator_is_summed_up(capsys):
    def compared(*failures, cycles=5):
        return Comparison(
            failures=failures, cycles=cycles, packets=2, transfers=3, statuses=4, seconds=1.5
        )

    results = [
        result("A", 1, comparison=compared()),
        result("B", 1, comparison=compared("no")),
        result("C", 1, comparison=compared(cycles=0)),
        result("D", 1),
    ]
    system._summarize(results, SimpleNamespace(simulator="ghdl"))
    assert capsys.readouterr().out.splitlines()[-1] == (
        "ghdl: 1 of 3 types the same in every cycle; 10 cycles, 6 packets, 9 leaf transfers and "
        "12 statuses seen there, in 4 s"
    )


def test_notes_that_many_types_share_are_counted_once(capsys):
    system._repeat({"no genpy": 3, "alone": 1, "": 9, "two": 2})
    assert capsys.readouterr().out.splitlines() == [
        "note: 2 more types: no genpy",
        "note: 1 more types: two",
    ]


@pytest.mark.parametrize(("count", "more"), [(8, []), (9, ["    and 1 more"])])
def test_eight_failures_are_printed_with_the_command_to_repeat_them(count, more):
    task = SimpleNamespace(name="a/B", same=("kilted", "lyrical"))
    failures = tuple(f"failure {n}" for n in range(count))
    told = system._describe(task, result("a/B", 1, command="firm-hdl verify"), Failed(failures))
    assert told.splitlines() == [
        "FAIL a/B (kilted, lyrical)",
        *(f"    failure {n}" for n in range(8)),
        *more,
        "    again: firm-hdl verify",
    ]


def test_long_failures_are_cut():
    assert system.clipped("x" * 600, system.MOST_CHARACTERS) == "x" * 600
    assert system.clipped("x" * 601, system.MOST_CHARACTERS) == "x" * 600 + "... (601 characters)"


def test_types_are_counted_for_each_of_their_distributions(capsys):
    """A type with the circuit of another has passed only if the other has."""
    failed = a_record(a_test("p/Failed"), verdict=Failed(("no",)), shape="1")
    silent = a_record(a_test("p/Silent"), verdict=NotJudged("nobody knows"), shape="2")
    records = [
        (a_record(a_test("p/Good")), ("kilted", "lyrical")),
        (a_record(a_test("p/Known"), verdict=KnownDifference(("z", "y"), 1)), ("lyrical",)),
        (a_record(a_test("p/Other"), verdict=KnownDifference(("y",), 1)), ("kilted",)),
        (failed, ("kilted", "lyrical")),
        (silent, ("lyrical",)),
        (a_record(a_test("p/Twin"), same_as=failed.test.key, shape="1"), ("lyrical",)),
        (a_record(a_test("p/Twin2"), same_as=silent.test.key, shape="2"), ("lyrical",)),
    ]
    tasks = {
        TypeUnderTest(distro=same[-1], name=record.test.type, same=same): record
        for record, same in records
    }
    system._count(tasks, SimpleNamespace(bus_bytes=4))
    assert capsys.readouterr().out.splitlines() == [
        "kilted      2 of    3 types pass (4-byte bus)",
        "lyrical     2 of    4 types pass (4-byte bus)",
        "2 of them with a known difference between libraries: y, z",
        "2 of 7 types not judged",
        "2 of 7 types have the circuit of another, which was simulated",
    ]


def test_a_type_that_ends_its_process_fails_with_the_command_to_repeat_it(monkeypatch):
    task = TypeUnderTest(distro="lyrical", name="p/A", same=("lyrical",))

    def die(work, tasks, **options):
        yield from ((each, ExecutorError("it died")) for each, _ in tasks)

    monkeypatch.setattr(system, "run_each", die)
    options = Options(bus_bytes=4)
    ((found, failed),) = system.run_tasks([task], options)
    assert found is task and isinstance(failed.verdict, Failed)
    assert "it died" in failed.verdict.failures[0]
    assert failed.command == command_of(options, "lyrical", "p/A")


def test_only_tasks_without_a_circuit_of_their_own_are_not_simulated(monkeypatch):
    asked = []

    def note(work, tasks, **options):
        asked.append((work, [(key.name, given[2].simulated) for key, given in tasks], options))
        return iter(())

    monkeypatch.setattr(system, "run_each", note)
    one, two = (TypeUnderTest(distro="lyrical", name=n, same=("lyrical",)) for n in "AB")
    assert not [*system.run_tasks([one, two], Options(), 3, golden_only={two})]
    assert not [*system.run_tasks([one], Options(bags=("x",)), executor="dask://host:1")]
    assert asked == [
        (system.accept, [("A", True), ("B", False)], {"executor": "processes", "jobs": 3}),
        (system.replay, [("A", True)], {"executor": "dask://host:1", "jobs": None}),
    ]


def test_results_are_bound_to_the_options_of_the_cases():
    request = Request(
        simulator="ghdl",
        seed=2,
        most_cases=3,
        stalled=False,
        bags=("x",),
        longest=4,
        references=("genpy",),
        types=("p/A",),
    )
    assert system.Ts3([], request).options == {
        "simulator": "ghdl",
        "seed": 2,
        "cases": 3,
        "stalls": False,
        "broken": True,
        "share_circuits": False,
        "bags": ["x"],
        "longest": 4,
        "references": ["genpy"],
    }
    usual = system.Ts3([], Request()).options
    assert usual["references"] is None and usual["share_circuits"] is True


def test_results_of_another_version_of_a_simulator_are_those_of_another_run(monkeypatch):
    tool = SimpleNamespace(version="GHDL 7")
    monkeypatch.setattr(system, "simulator", {"ghdl": tool, "python": None}.get)
    for name, text in (("ghdl", "ghdl GHDL 7"), ("python", "python")):
        with system.Ts3([], Request(simulator=name)) as entered:
            assert entered.options["simulator"] == text


def test_each_type_is_a_test_on_each_bus():
    tasks = [TypeUnderTest(distro="lyrical", name=n, same=("lyrical",)) for n in ("p/A", "p/B")]
    tests = system.Ts3(tasks, Request(widths=(2, 4))).tests
    assert [test.key for test in tests] == [
        f"ts3 python lyrical {name} cdr/{width} seed=0"
        for width in (2, 4)
        for name in ("p/A", "p/B")
    ]


def test_libraries_confirm_cases_and_no_recordings(monkeypatch, capsys):
    monkeypatch.setattr(
        system, "find_references", lambda wanted, wires: [f"{wanted} for {','.join(wires)}"]
    )
    task = TypeUnderTest(distro="noetic", name="p/A", same=("noetic",))
    with system.Ts3([task], Request(references=("genpy",))):
        assert capsys.readouterr().out == "('genpy',) for ros1\n"
    with system.Ts3([task], Request(bags=("x",))):
        assert capsys.readouterr().out == ""


def test_a_simulator_that_is_not_there_ends_the_run_before_it_begins(monkeypatch):
    def missing(name):
        assert name == "ghdl"
        raise ProgramMissingError("no GHDL")

    monkeypatch.setattr(system, "simulator", missing)
    with (
        pytest.raises(ProgramMissingError, match="no GHDL"),
        system.Ts3([], Request(simulator="ghdl")),
    ):
        pass


ONE, TWIN = (TypeUnderTest(distro="lyrical", name=f"p/{n}", same=("lyrical",)) for n in "AB")


@pytest.mark.parametrize(
    ("given", "twins", "notes"),
    [
        ({}, ["p/B"], ["note: p/A (lyrical): odd", "note: 1 more types: odd"]),
        # The note of a replay says how many messages there were, of each type.
        ({"bags": ("x",)}, [], ["note: p/A (lyrical): odd", "note: p/B (lyrical): odd"]),
    ],
)
def test_a_twin_is_not_simulated_and_notes_are_printed(monkeypatch, capsys, given, twins, notes):
    asked = []

    def run_tasks(left, options, jobs, *, executor, golden_only):
        alike = [task.name for task in left if task in golden_only]
        asked.append(([task.name for task in left], options.bus_bytes, jobs, executor, alike))
        for task in left:
            cycles = 0 if task.name in alike else 50
            more = {"judged": 3, "packets": 7, "simulated_cycles": cycles, "shape": "s"}
            yield task, result(task.name, 1, note="odd", **more)

    monkeypatch.setattr(system, "same_circuits", lambda tasks, options: {TWIN: ONE})
    monkeypatch.setattr(system, "run_tasks", run_tasks)
    request = Request(widths=(4,), jobs=2, executor="dask://host:1", **given)
    found = system.Ts3([ONE, TWIN], request).run(Recorder())
    assert asked == [(["p/A", "p/B"], 4, 2, "dask://host:1", twins)]
    assert [each.verdict for each in found] == [Passed(3)] * 2
    printed = capsys.readouterr().out.splitlines()
    assert [line for line in printed if line.startswith("note: ")] == notes
    # Only what was simulated counts for the figures of the simulation.
    count = 2 - len(twins)
    (figures,) = (line for line in printed if "different types" in line)
    assert figures.startswith(
        f"{count} different types, {7 * count} packets, {50 * count} cycles; "
    )
    shared = [line for line in printed if "have the circuit of another" in line]
    assert len(shared) == len(twins) and printed[-1].endswith(" s, 0 failures")
