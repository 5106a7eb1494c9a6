"""The command of the fuzzer, its tasks, its sums and its texts, without a circuit."""

from __future__ import annotations

import gc
import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl.fuzz import Failure, FuzzTask, Outcome, command
from firm_hdl.fuzz import run as fuzz_run
from firm_hdl.fuzz.build import Program
from firm_hdl.fuzz.circuits import CIRCUITS, _Output, circuits_of
from firm_hdl.fuzz.command import main
from firm_hdl.fuzz.report import HEAD, failure_text, line, summary
from firm_hdl.fuzz.run import judged, run_task
from firm_hdl.fuzz.table import table_of
from firm_hdl.fuzz.types import message_of
from firm_hdl.gateware.packets import PacketGate
from firm_hdl.jobs.processes import ToolError
from tests.fuzz.samples import EMPTY, STRING
from tests.strategies import make

TASK = FuzzTask(type=STRING, bus_bytes=4, room=300, seed=9, packets=200, first=7)
SAID = {
    "circuit": "loop",
    "packets": 256,
    "bad": 100,
    "discarded": 6,
    "resets": 3,
    "cycles": 1000,
    "transfers": 500,
    "seconds": 0.5,
    "statuses": {"OK": 150, "LENGTH": 100},
    "damages": {"cut": 128, "bits": 5},
}
OTHER = {
    "circuit": "gate-wait",
    "packets": 512,
    "bad": 20,
    "discarded": 2,
    "resets": 1,
    "cycles": 30,
    "transfers": 4,
    "seconds": 0.25,
    "statuses": {"OK": 500, "FULL": 10},
    "damages": {"cut": 7, "longer": 1},
}


def outcome(*said, task=TASK, **more):
    return judged(Outcome(task=task, wire="cdr", **more), list(said))


def test_figures_of_all_circuits_are_added_up():
    found = outcome(SAID, OTHER, build_seconds=8.0)
    assert (found.packets, found.bad, found.discarded, found.resets) == (768, 120, 8, 4)
    assert (found.cycles, found.transfers) == (1030, 504)
    assert (found.run_seconds, found.build_seconds) == (0.75, 8.0)
    assert found.statuses == {"OK": 650, "LENGTH": 100, "FULL": 10}
    assert found.damages == {"cut": 135, "bits": 5, "longer": 1}
    assert found.by_circuit == [SAID, OTHER] and found.failures == ()


@pytest.mark.parametrize("number", [149, 151])
def test_a_status_too_few_or_too_many_is_a_failure_of_its_circuit(number):
    wrong = SAID | {"statuses": {"OK": number, "LENGTH": 100}}
    (failure,) = outcome(OTHER, wrong).failures
    assert (failure.circuit, failure.rule) == ("loop", "not every packet has exactly one status")
    assert (failure.expected, failure.came) == ("250", str(number + 100))


@pytest.mark.parametrize(("packets", "rules"), [(256, []), (257, ["too few packets were sent"])])
def test_as_many_packets_as_were_asked_for_are_enough(packets, rules):
    found = outcome(SAID, task=replace(TASK, packets=packets))
    assert [failure.rule for failure in found.failures] == rules


def test_every_circuit_has_a_failure_of_its_own():
    broken = {"failure": {"rule": "r", "packet": 0, "hex": "00", "cycle": 0}}
    assert outcome(SAID | broken, OTHER | {"packets": 100}, SAID).failures == (
        Failure(circuit="loop", rule="r", packet=0, hex="00", cycle=0),
        Failure(circuit="gate-wait", rule="too few packets were sent"),
    )


def test_a_line_has_each_figure_below_its_title():
    text = line(outcome(SAID, OTHER, build_seconds=100.0))
    assert text.split() == [
        *(STRING, "cdr", "4", "768", "120", "650", "0", "0", "100", "0", "0", "10", "0", "0"),
        # 768 packets in 0.75 s.
        *("1030", "1024"),
    ]
    assert len(text) == len(HEAD)
    for title, number in (("ok", "650"), ("length", "100"), ("full", "10")):
        assert text[: HEAD.index(f" {title} ") + 1 + len(title)].endswith(f" {number}")
    assert line(Outcome(task=TASK, wire="ros1")).split()[-2:] == ["0", "0"]


def test_a_failure_is_told_with_all_that_is_known():
    whole = Failure(
        rule="a wrong value", circuit="loop", packet=0, hex="0a", expected="1", came="2", cycle=0
    )
    head = f"FAILED: {STRING} (cdr), bus of 4 bytes"
    assert failure_text(outcome(SAID), whole).splitlines() == [
        f"{head}, loop",
        "    a wrong value",
        "    packet 0 of seed 9: 0a",
        "    expected: 1",
        "    came:     2",
        "    cycle 0 after the reset at the start of its episode",
        f"    repeat: {TASK.command(whole)}",
    ]
    assert failure_text(outcome(SAID), Failure(rule="r")).splitlines() == [
        head,
        "    r",
        f"    repeat: {TASK.command(Failure(rule='r'))}",
    ]
    for one in ({"expected": "x"}, {"came": "x"}):
        assert len(failure_text(outcome(SAID), Failure(rule="r", **one)).splitlines()) == 5


def test_the_summary_counts_every_failure():
    few = {"packets": 1}
    bad = outcome(SAID | few, OTHER | few)
    assert summary([bad, outcome(SAID)]).endswith("\n2 failures")
    assert summary([outcome(SAID | few), outcome(SAID)]).endswith("\n1 failure")
    assert " in 2 s of processor time, after 9 s to build\n" in summary(
        [outcome(SAID, SAID, build_seconds=4.0), outcome(SAID, SAID, build_seconds=5.0)]
    )


@pytest.fixture
def outcomes(monkeypatch):
    """What becomes of each task, by its type; an exception: its process failed."""
    found = {}
    monkeypatch.setattr(command, "find_tools", lambda: None)

    def in_processes(work, tasks, jobs):
        assert work is command.run_task
        found.setdefault("jobs", []).append(jobs)
        for key, (task,) in tasks:
            result = found[task.type]
            yield key, result if isinstance(result, Exception) else replace(result, task=task)

    monkeypatch.setattr(command, "in_processes", in_processes)
    return found


def test_any_failure_is_the_status_and_a_line_of_the_results(outcomes, tmp_path, capsys):
    file = tmp_path / "new" / "r.jsonl"
    outcomes[STRING] = outcome(SAID)
    outcomes[EMPTY] = outcome(OTHER | {"packets": 1})
    words = ["--bus-bytes", "4", "--results", str(file), "--jobs", "3", "--types"]
    assert main([*words, STRING]) == 0
    assert main([*words, STRING, EMPTY]) == 1
    assert capsys.readouterr().out.count("too few packets were sent") == 1
    outcomes[EMPTY] = RuntimeError("it was killed")
    assert main([*words, EMPTY, STRING]) == 1
    assert "the process failed: it was killed" in capsys.readouterr().out
    # Each call adds its lines.
    rows = [json.loads(row) for row in file.read_text().splitlines()]
    names = [STRING, STRING, EMPTY, EMPTY, STRING]
    assert [row["task"]["type"] for row in rows] == names
    assert [len(row["failures"]) for row in rows] == [0, 0, 1, 1, 0]
    assert rows[3]["wire"] == "ros1" and rows[4]["wire"] == "cdr"
    # One task needs no other process.
    assert outcomes["jobs"] == [1, 3, 3]


def test_a_run_without_packets_has_not_passed(outcomes, capsys):
    outcomes[STRING] = Outcome(task=TASK, wire="cdr")
    assert main(["--types", STRING, "--bus-bytes", "4"]) == 1
    assert capsys.readouterr().err.endswith("error: no packet was sent\n")


def test_a_type_that_does_not_exist_ends_the_run_before_it_begins(outcomes, capsys):
    assert main(["--types", STRING, "std_msgs/msg/Nonsense"]) == 1
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("error: ") and "Nonsense" in err
    assert "jobs" not in outcomes


def rows(*words):
    given = command._parser().parse_args(words)
    return command._tasks(given)


def test_tasks_have_all_types_then_other_widths_and_some_have_much_room():
    tasks = rows("--types", "a/A", "b/B", "c/C", "--bus-bytes", "1", "8", "4", "--seed", "5")
    assert [(task.type, task.bus_bytes) for task in tasks] == [
        *(("a/A", 1), ("b/B", 8), ("c/C", 4)),
        *(("a/A", 8), ("b/B", 4), ("c/C", 1)),
        *(("a/A", 4), ("b/B", 1), ("c/C", 8)),
    ]
    assert [task.room for task in tasks] == [512] * 6 + [4096] + [512] * 2
    assert {(task.seed, task.packets, task.first, task.circuits) for task in tasks} == {
        (5, 10_000, 0, CIRCUITS)
    }
    assert {task.room for task in rows("--room", "77")} == {77}
    assert {task.circuits for task in rows("--circuits", "loop")} == {("loop",)}
    assert {(task.packets, task.first) for task in rows("--only-packet", "0")} == {(1, 0)}


def test_numbers_have_63_bits(capsys):
    for option in ("--seed", "--only-packet"):
        for number in (0, (1 << 63) - 1):
            given = vars(command._parser().parse_args([option, str(number)]))
            assert given[option[2:].replace("-", "_")] == number
        for number in (-1, 1 << 63):
            with pytest.raises(SystemExit):
                command._parser().parse_args([f"{option}={number}"])


class Ran(Program):
    """A program that only remembers how it was called."""

    calls: list[object] = []  # noqa: RUF012 - one for the test.

    def run(self, circuits, **options):
        self.calls.append((circuits, options))
        return [SAID]


@pytest.mark.parametrize("name", [STRING, EMPTY])
def test_a_task_is_run_with_its_room_its_seed_and_its_packets(name, monkeypatch):
    seen = {}

    def circuits_of(message, table, *, max_message_bytes, names, alter):
        seen.update(message=message, table=table, most=max_message_bytes, names=names)
        return ["circuits"]

    def build(circuits, table, folder, tools):
        seen.update(built=(circuits, table, tools), folder=folder)
        assert folder.is_dir()
        return Ran(folder=folder)

    monkeypatch.setattr(fuzz_run, "circuits_of", circuits_of)
    monkeypatch.setattr(fuzz_run, "build", build)
    monkeypatch.setattr(fuzz_run, "find_tools", lambda: "tools")
    # The clock of the export and of the compilers stops before the program runs.
    monkeypatch.setattr(fuzz_run, "cpu_seconds", iter([3.0, 5.5]).__next__)
    Ran.calls.clear()
    found = run_task(replace(TASK, type=name, circuits=("loop",)))
    message = message_of(name)
    # A header and a length of four bytes each; nothing at all.
    most = {STRING: 8, EMPTY: 0}[name] + 300
    table = table_of(message, wire=message.wire, bus_bytes=4, max_message_bytes=most)
    assert (seen["message"], seen["most"], seen["names"]) == (message, most, ("loop",))
    assert seen["table"] == table and table.room == 300
    assert seen["built"] == (["circuits"], table, "tools")
    assert Ran.calls == [(("loop",), {"seed": 9, "first": 7, "packets": 200})]
    assert (found.wire, found.packets, found.failures) == (message.wire, 256, ())
    assert (found.build_seconds, found.run_seconds) == (2.5, 0.5)
    assert not seen["folder"].exists()


def test_a_tool_that_fails_is_a_failure(monkeypatch):
    def fail(*given, **options):
        raise ToolError("no room on the disk")

    monkeypatch.setattr(fuzz_run, "find_tools", lambda: None)
    monkeypatch.setattr(fuzz_run, "circuits_of", lambda *given, **options: [])
    monkeypatch.setattr(fuzz_run, "build", fail)
    (failure,) = run_task(TASK).failures
    assert failure == Failure(rule="a tool failed: no room on the disk")


@pytest.fixture
def program(tmp_path):
    """A program that says in JSON how it was called."""
    path = tmp_path / "fuzz"
    path.write_text(
        f"#!{sys.executable}\n"
        "import json, sys\n"
        "for name in sys.argv[5:]:\n"
        "    if name != 'gate-drop':\n"
        "        print(json.dumps({'circuit': name, 'words': sys.argv[1:5]}))\n"
    )
    path.chmod(0o755)
    return Program(folder=tmp_path)


def test_a_program_gets_the_table_the_numbers_and_the_circuits(program: Program):
    said = program.run(["loop", "gate-wait"], seed=1, first=2, packets=3)
    words = ["table.txt", "1", "2", "3"]
    assert said == [{"circuit": name, "words": words} for name in ("loop", "gate-wait")]


def test_a_program_has_to_say_something_of_each_circuit(program: Program):
    with pytest.raises(ToolError, match=r"^the program did not say something of each circuit$"):
        program.run(["loop", "gate-drop"], seed=1, first=2, packets=3)
    Path(program.folder, "fuzz").write_text("#!/bin/sh\necho no JSON\n")
    with pytest.raises(ToolError, match=r"^the program said: no JSON"):
        program.run(["loop"], seed=1, first=2, packets=3)


def test_values_of_an_output_are_whole_words():
    values = (("flags", 1), ("data", 40), ("full", 64), ("size", 32))
    output = _Output(name="x", index=0, values=values)
    assert output.words == 1 + 2 + 2 + 1
    assert output.parts == [
        ("flags", 31, 0),
        ("data", 95, 32),
        ("full", 159, 96),
        ("size", 191, 160),
    ]


def test_gates_have_little_memory_and_their_own_policy(monkeypatch):
    designs, asked = [], []

    class Gate(PacketGate):
        def __init__(self, message, **options):
            asked.append(options)
            super().__init__(message, **options)

    def convert(design, *, name):
        designs.append(design)
        return f"module {name}\n"

    # Yosys is slow.
    monkeypatch.setattr("firm_hdl.fuzz.circuits.convert", convert)
    monkeypatch.setattr("firm_hdl.fuzz.circuits.PacketGate", Gate)
    message = make("ros2", {"data": "float64[40]"})
    table = table_of(message, wire="cdr", bus_bytes=4, max_message_bytes=500)
    made = circuits_of(
        message,
        table,
        max_message_bytes=500,
        names=("gate-wait", "gate-drop"),
        alter=lambda module, text: f"{text}// altered {module}\n",
    )
    # Two of the shortest packets fit: of 4 and 320 bytes.
    assert [(each.drops, each.memory_bytes) for each in made] == [(False, 1024), (True, 1024)]
    assert designs[0] != designs[1]
    assert [(each["when_full"], each["max_message_bytes"]) for each in asked] == [
        ("wait", 500),
        ("drop", 500),
    ]
    assert {(each["wire"], each["bus_bytes"], each["packets"]) for each in asked} == {("cdr", 4, 8)}
    for each, module in zip(made, ("gate_wait", "gate_drop"), strict=True):
        assert each.files[f"{module}.v"] == f"module {module}\n// altered {module}\n"
        assert (each.name, each.counters, each.memory_packets) == (module.replace("_", "-"), 9, 8)
        assert each.module == f"fuzz_{module}" and f"fuzz_{module}.v" in each.files


def test_a_table_of_other_leaves_or_widths_is_refused(monkeypatch):
    monkeypatch.setattr("firm_hdl.fuzz.circuits.convert", lambda *given, **options: "")
    message = message_of(STRING)
    table = table_of(message, wire="cdr", bus_bytes=4, max_message_bytes=300)

    def deserializer(*leaves):
        other = replace(table, leaves=leaves)
        return circuits_of(message, other, max_message_bytes=300, names=("deserializer",))

    length, items = table.leaves
    assert [each.kind for each in deserializer(length, items)] == ["Deserializer"]
    with pytest.raises(ValueError, match="has other leaves than the table"):
        deserializer(length)
    for bits in (31, 33):
        with pytest.raises(ValueError, match=rf"has 32 bits, and the table says {bits}$"):
            deserializer(replace(length, bits=bits), items)
    # What nothing elaborated warns when it is collected.
    gc.collect()
