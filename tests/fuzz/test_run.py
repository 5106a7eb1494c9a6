"""What the program says is judged; small types come through without a failure."""

from __future__ import annotations

import stat

import pytest

from firm_hdl.fuzz import Failure, command
from firm_hdl.fuzz.circuits import CIRCUITS
from firm_hdl.fuzz.command import main
from firm_hdl.fuzz.report import summary
from firm_hdl.fuzz.run import FuzzTask, Outcome, judged
from tests.depth import by_depth
from tests.fuzz.samples import EMPTY, STRING, need_tools, run


@pytest.fixture
def tools() -> None:
    need_tools()


@pytest.mark.usefixtures("tools")
def test_all_circuits_of_a_string_keep_all_rules():
    # Others compile the deserializer alone. A gate that drops has more parts than one that waits.
    circuits = by_depth(("loop", "gate-drop"), CIRCUITS)
    outcome = run(STRING, *circuits, packets=by_depth(4000, 100_000))
    assert outcome.failures == ()
    assert outcome.packets >= 4000 * len(circuits)
    assert 3 * outcome.bad > outcome.packets
    assert {"OK", "TRUNCATED", "TRAILING", "LENGTH", "ENCAPSULATION", "STRING"} < set(
        outcome.statuses
    )
    assert outcome.resets and outcome.discarded
    assert sum(outcome.statuses.values()) + outcome.discarded == outcome.packets
    assert all(outcome.damages.values())


@pytest.mark.usefixtures("tools")
def test_the_command_reports_and_writes_results(capsys, tmp_path):
    results = tmp_path / "new" / "results.jsonl"
    call = ["--types", EMPTY, "--bus-bytes", "1", "--circuits", "deserializer", "--jobs", "1"]
    assert main([*call, "--packets", "1000", "--results", str(results)]) == 0
    said = capsys.readouterr().out
    assert "through 1 circuits of 1 types on buses of 1 bytes" in said
    assert "no failures" in said
    (line,) = results.read_text().splitlines()
    assert '"type": "std_msgs/Empty"' in line and '"failures": []' in line


@pytest.mark.thorough
@pytest.mark.usefixtures("tools")
@pytest.mark.parametrize("bus_bytes", [1, 2, 32])
@pytest.mark.parametrize("name", ["fuzz_msgs/Deep", "fuzz_msgs/msg/Bounded", "fuzz_msgs/msg/Wide"])
def test_types_with_rare_features_keep_all_rules(name, bus_bytes):
    assert run(name, *CIRCUITS, bus_bytes=bus_bytes, packets=10_000).failures == ()


def test_without_a_compiler_nothing_has_passed(monkeypatch, capsys):
    monkeypatch.setenv("CXX", "no-such-compiler")
    assert main(["--types", EMPTY]) == 1
    assert "no-such-compiler" in capsys.readouterr().err


def test_without_verilator_nothing_has_passed(monkeypatch, capsys):
    monkeypatch.setenv("VERILATOR", "no-such-verilator")
    assert main(["--types", EMPTY]) == 1
    assert "no-such-verilator" in capsys.readouterr().err


def test_a_type_that_does_not_exist_is_an_error(capsys):
    need_tools()
    assert main(["--types", "std_msgs/msg/Nonsense"]) == 1
    assert "Nonsense" in capsys.readouterr().err


@pytest.mark.parametrize("status", [0, 1])
def test_a_verilator_that_says_nothing_has_not_passed(tmp_path, monkeypatch, capsys, status):
    need_tools()
    fake = tmp_path / "verilator"
    fake.write_text(f"#!/bin/sh\nexit {status}\n")
    fake.chmod(stat.S_IRWXU)
    monkeypatch.setenv("VERILATOR", str(fake))
    call = ["--types", EMPTY, "--bus-bytes", "1", "--circuits", "deserializer", "--jobs", "1"]
    assert main(call) == 1
    said = capsys.readouterr()
    assert "a tool failed" in said.out and "no packet was sent" in said.err


SAID = {
    "circuit": "deserializer",
    "packets": 256,
    "bad": 100,
    "discarded": 6,
    "resets": 1,
    "cycles": 1000,
    "transfers": 500,
    "seconds": 0.1,
    "statuses": {"OK": 150, "TRUNCATED": 100},
    "damages": {"cut": 128},
}


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({}, None),
        ({"statuses": {"OK": 150, "TRUNCATED": 99}}, "not every packet has exactly one status"),
        ({"packets": 128}, "too few packets were sent"),
        ({"statuses": {}}, "too few packets were sent"),
        ({"failure": {"rule": "a wrong value", "packet": 3}}, "a wrong value"),
    ],
)
def test_numbers_that_do_not_agree_are_a_failure(change, rule):
    task = FuzzTask(type=STRING, bus_bytes=4, room=300, seed=1, packets=200)
    outcome = judged(Outcome(task=task, wire="cdr"), [{**SAID, **change}])
    assert [failure.rule for failure in outcome.failures] == ([] if rule is None else [rule])


@pytest.mark.parametrize(
    ("options", "first", "packets"),
    [
        ([], 0, 10_000),
        (["--packets", "7"], 0, 7),
        (["--only-packet", "0"], 0, 1),
        (["--only-packet", "513"], 513, 1),
    ],
)
def test_one_packet_is_the_one_that_is_named(options, first, packets, monkeypatch):
    asked = []

    def run(task):
        asked.append(task)
        return judged(Outcome(task=task, wire="cdr"), [SAID])

    monkeypatch.setattr(command, "find_tools", lambda: None)
    monkeypatch.setattr(command, "run_task", run)
    call = ["--types", STRING, "--bus-bytes", "4", "--circuits", "loop", "--seed", "9"]
    main([*call, "--room", "77", "--jobs", "1", *options])
    assert asked == [
        FuzzTask(
            type=STRING,
            bus_bytes=4,
            room=77,
            seed=9,
            packets=packets,
            first=first,
            circuits=("loop",),
        )
    ]


def test_the_summary_counts_types_on_each_wire_and_every_circuit():
    outcomes = [
        judged(
            Outcome(
                task=FuzzTask(type=name, bus_bytes=bus, room=1, seed=1, packets=200), wire=wire
            ),
            [SAID] * 2,
        )
        for name, bus, wire in (
            *((STRING, 4, "cdr"), (STRING, 8, "cdr"), (STRING, 8, "ros1")),
            (EMPTY, 8, "ros1"),
        )
    ]
    text = summary(outcomes)
    assert text.startswith(
        "2,048 packets, 800 of them bad, through 8 circuits of 3 types on buses of 4, 8 bytes\n"
        "1,200 OK, 800 TRUNCATED; 48 lost in 8 resets\n8,000 cycles"
    )
    assert text.endswith("no failures")


@pytest.mark.parametrize(
    ("failure", "end"),
    [
        (Failure(rule="r"), " --packets 9"),
        (Failure(rule="r", circuit="gate"), " --circuits gate --packets 9"),
        # The first packet has the number 0.
        (Failure(rule="r", circuit="gate", packet=0), " --circuits gate --only-packet 0"),
        (Failure(rule="r", packet=7), " --only-packet 7"),
    ],
)
def test_a_failure_is_repeated_by_its_packet_if_it_has_one(failure, end):
    task = FuzzTask(type="p/msg/A", bus_bytes=2, room=30, seed=4, packets=9)
    head = "python -m firm_hdl.fuzz --types p/msg/A --bus-bytes 2 --room 30 --seed 4"
    assert task.command(failure) == head + end
