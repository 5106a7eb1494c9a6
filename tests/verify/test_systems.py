"""Results of all test systems: recorded correctly, resumed after a kill, and never invented."""

from __future__ import annotations

import multiprocessing
import os
import random
import signal
import sys
from collections import Counter

import pytest

from firm_hdl.cli import main
from firm_hdl.frontend import Library
from firm_hdl.verify.results.file import ResultsWriter, read_results
from firm_hdl.verify.results.records import Record, from_json, to_json
from firm_hdl.verify.results.verdict import NotJudged, Passed
from firm_hdl.verify.systems.system import run_tests
from firm_hdl.verify.ts1 import system as ts1_system
from tests.frontend.workspace import make_files
from tests.verify.judged import assert_known, assert_passed, without_times
from tests.verify.report.samples import a_test

BOOL, CHAR = "std_msgs/msg/Bool", "std_msgs/msg/Char"
# rosbags is always installed.
FAST = ["--jobs", "1", "--distro", "lyrical", "--oracle", "rosbags", "--cases", "2"]
FAST += ["--reference", "none"]
ALL = ["--systems", "ts1,ts2,ts3"]


def verify(*arguments):
    return main(["verify", *FAST, *map(str, arguments)])


def records_of(path):
    return {key: without_times(record) for key, record in read_results(path).records.items()}


def written(path):
    """Count the lines that each test has in a file."""
    found = Counter()
    for line in path.read_bytes().splitlines(keepends=True):
        if line.startswith(b'{"record"') and line.endswith(b"\n"):
            found[line[: line.index(b'"verdict"')]] += 1
    return found


def test_every_system_has_a_record_of_each_type_that_can_be_read_back(tmp_path):
    path = tmp_path / "r.jsonl"
    assert verify(*ALL, "--bus-bytes", 4, "--results", path, BOOL, CHAR) == 0
    found = read_results(path)
    assert not found.missing and found.options["systems"] == ["ts1", "ts2", "ts3"]
    records = found.records.values()
    assert Counter(record.test.system for record in records) == {"ts1": 2, "ts2": 2, "ts3": 2}
    assert [test.key for test in found.planned if test.type == BOOL] == [
        f"ts1 lyrical {BOOL} oracle=rosbags",
        f"ts2 lyrical {BOOL} cdr/4",
        f"ts3 python lyrical {BOOL} cdr/4 seed=0,cases=2,references=",
    ]
    for record in records:
        if record.test.system == "ts1" and record.test.type == CHAR:
            assert_known(record, "rosbags-char-hash")
        else:
            assert_passed(record)
        assert record.cpu_seconds > 0 and record.metrics
        assert min(record.seconds.generation, record.seconds.testing) > 0
        assert bool(record.seconds.simulation) == (record.test.system == "ts3")
        assert bool(record.shape) == (record.test.system != "ts1") == (not record.verdicts)
        assert from_json(Record, to_json(record)) == record
    # `test_request` runs their commands.
    assert all(record.command.startswith("firm-hdl verify ") for record in records)


def test_definition_that_no_oracle_reads_is_not_judged_for_a_reason(tmp_path, capsys):
    text = "module p { module msg { struct A { long a; }; }; };"
    make_files(tmp_path, {"src/p/msg/A.idl": text})
    path, page = tmp_path / "r.jsonl", tmp_path / "r.html"
    command = ["--systems", "ts1", "--all", "--path", tmp_path / "src", "--results", path]
    assert verify(*command, "--report", page) == 1
    (record,) = read_results(path).records.values()
    assert record.verdict == NotJudged("no oracle that was asked reads .idl files")
    assert record.verdict.reason in page.read_text()


def test_definitions_that_are_refused_are_tests_of_ts1_and_named(tmp_path, capsys):
    make_files(tmp_path, {"src/p/msg/A.msg": "int8 x\n", "src/p/msg/Bad.msg": "int8[ x\n"})
    path, page = tmp_path / "r.jsonl", tmp_path / "r.html"
    command = ["--systems", "ts1,ts2", "--all", "--path", tmp_path / "src", "--results", path]
    assert verify(*command, "--report", page) == 1
    found = read_results(path)
    assert sorted(key.split()[0] + key.split()[2] for key in found.records) == [
        "ts1p/msg/A",
        "ts1p/msg/Bad",
        "ts2p/msg/A",
    ]
    (output,) = (r.verdicts for r in found.records.values() if r.test.type == "p/msg/Bad")
    assert output[0].is_refused
    assert found.sessions[0]["definitions that are refused"].startswith("1: ")
    assert "definitions that are refused: 1: " in page.read_text()


def test_golden_plans_have_records_of_their_own(tmp_path, capsys):
    golden, path = tmp_path / "golden", tmp_path / "r.jsonl"
    name = "sensor_msgs/msg/Imu"
    assert main(["golden", "add", "--distro", "lyrical", str(golden), name]) == 0
    command = ["--systems", "ts2", "--golden", golden, name]
    assert verify(*command, "--results", path) == 0
    plan, kept = read_results(path).records.values()
    assert plan.shape and not kept.shape and f"golden={golden}" in kept.test.options
    (file,) = golden.glob("*/*.yaml")
    file.write_text(file.read_text().replace("align: 8", "align: 4"))
    assert verify(*command, "--results", tmp_path / "new.jsonl") == 1
    verdicts = [r.verdict.name for r in read_results(tmp_path / "new.jsonl").records.values()]
    assert verdicts == ["passed", "failed"]


@pytest.mark.sampled(2)
@pytest.mark.parametrize("system", ["ts1", "ts2"])
@pytest.mark.parametrize("changed", ["src/p/msg/A.msg", "src/q/msg/B.msg"])
def test_other_definitions_are_another_run(tmp_path, capsys, system, changed):
    texts = {"src/p/msg/A.msg": "q/B b\n", "src/q/msg/B.msg": "int8 x\n"}
    source, path = str(make_files(tmp_path, texts) / "src"), tmp_path / "r.jsonl"
    arguments = ["--systems", system, "--path", source, "--results", path, "p/msg/A"]
    assert verify(*arguments) == 0
    assert verify(*arguments) == 0
    (tmp_path / changed).write_text("int16 y\n")
    assert verify(*arguments) == 1
    assert "is of another run: inputs was" in capsys.readouterr().err


def run_until_killed(command, calls):
    """Run the command, and end this process after `calls` calls of `add`."""
    add, left = ResultsWriter.add, iter(range(calls))

    def counted(writer, *records):
        add(writer, *records)
        if next(left, None) is None:
            os.kill(os.getpid(), signal.SIGKILL)

    ResultsWriter.add = counted
    sys.exit(verify(*command))


@pytest.mark.sampled(2)
@pytest.mark.parametrize("system", ["ts1", "ts2"])
def test_system_that_was_killed_goes_on_and_ends_the_same(tmp_path, system):
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    names = [name for name in Library("lyrical").interfaces() if name.startswith("sensor_msgs/msg")]
    command = ["--systems", system, *names]
    assert verify(*command, "--results", whole) == 0
    seed = random.randrange(1 << 32)
    print(f"seed {seed}")
    rng = random.Random(seed)
    kills = before = 0
    while True:
        arguments = ([*command, "--results", killed], rng.randint(2, 12))
        process = multiprocessing.Process(target=run_until_killed, args=arguments)
        process.start()
        process.join()
        found = records_of(killed)
        assert len(found) >= before, "results were lost"
        before = len(found)
        if process.exitcode != -signal.SIGKILL:
            break
        kills += 1
    assert process.exitcode == 0 and kills >= 2
    assert found == records_of(whole) and len(found) == len(names)
    assert set(written(killed).values()) == {1}, "something ran twice"


def passed_unless_13(context, test):
    if test.type == "p/msg/T13":
        os.kill(os.getpid(), signal.SIGKILL)
    return Record(test=test, verdict=Passed(context))


def test_share_that_ends_its_process_blames_one_test():
    tests = [a_test(f"p/msg/T{number}") for number in range(140)]
    shares = list(run_tests(passed_unless_13, 7, tests, lambda test: test.type, most=8, jobs=2))
    # Two in each, but those that ran again one by one.
    assert sorted(map(len, shares)) == [1, 1, *[2] * 69]
    records = [record for share in shares for record in share]
    assert sorted(record.command for record in records) == sorted(test.type for test in tests)
    failed = [record for record in records if record.verdict != Passed(7)]
    assert [record.test.type for record in failed] == ["p/msg/T13"]
    assert "died" in failed[0].failures[0]


def test_definition_that_ends_our_process_is_the_only_one_that_fails(tmp_path, monkeypatch):
    judge_case = ts1_system.judge_case

    def dies(universe, oracles, case, test):
        if case.name == "B":
            os.kill(os.getpid(), signal.SIGKILL)
        return judge_case(universe, oracles, case, test)

    monkeypatch.setattr(ts1_system, "judge_case", dies)
    texts = {f"src/p/msg/{name}.msg": "int8 x\n" for name in "ABC"}
    source, path = str(make_files(tmp_path, texts) / "src"), tmp_path / "r.jsonl"
    command = ["--systems", "ts1", "--all", "--path", source, "--results", path, "--jobs", "2"]
    assert verify(*command) == 1
    records = {record.test.type: record for record in read_results(path).records.values()}
    verdicts = [records[f"p/msg/{name}"].verdict.name for name in "ABC"]
    assert verdicts == ["passed", "failed", "passed"]
    assert "died" in records["p/msg/B"].verdict.failures[0]
