"""What the program says is judged; small types come through without a failure."""

from __future__ import annotations

import pytest

from lab.fuzz.circuits import CIRCUITS
from lab.fuzz.command import main
from lab.fuzz.run import FuzzTask, Outcome, judged
from lab.tests.fuzz.samples import EMPTY, STRING, need_tools, run


@pytest.fixture
def tools() -> None:
    need_tools()


@pytest.mark.thorough
@pytest.mark.usefixtures("tools")
def test_all_circuits_of_a_string_keep_all_rules():
    outcome = run(STRING, *CIRCUITS, packets=100_000)
    assert outcome.failures == ()
    assert outcome.packets >= 100_000 * len(CIRCUITS)
    assert 3 * outcome.bad > outcome.packets
    assert {"OK", "TRUNCATED", "TRAILING", "LENGTH", "ENCAPSULATION", "STRING"} < set(
        outcome.statuses
    )
    assert outcome.resets and outcome.discarded
    assert sum(outcome.statuses.values()) + outcome.discarded == outcome.packets
    assert all(outcome.damages.values())


@pytest.mark.thorough
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


def test_without_verilator_nothing_has_passed(monkeypatch, capsys):
    monkeypatch.setenv("VERILATOR", "no-such-verilator")
    assert main(["--types", EMPTY]) == 1
    assert "no-such-verilator" in capsys.readouterr().err


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
