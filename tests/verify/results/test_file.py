"""Result files: complete and correct after a crash, and bound to one run."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from firm_hdl.verify.results.file import FORMAT, ResultsError, ResultsWriter, read_results
from firm_hdl.verify.results.records import Record, to_json
from firm_hdl.verify.results.verdict import Failed
from tests.verify.judged import without_times
from tests.verify.report.samples import a_record, a_test

HEADER, BOOL = a_test(), a_test("std_msgs/msg/Bool")
OPTIONS = {"seed": 0, "paths": []}


def written(path, *records, options=OPTIONS, planned=(HEADER, BOOL)):
    with ResultsWriter(path, options=options, planned=planned, session={"Python": "3"}) as writer:
        for record in records:
            writer.add(record)
    return path


def test_records_are_read_as_they_were_written(tmp_path):
    failed = a_record(BOOL, verdict=Failed(("a\nb", "ü")), same_as="x", note="y")
    path = written(tmp_path / "new" / "r.jsonl", a_record(), failed)
    found = read_results(path)
    assert found.options == OPTIONS and found.planned == (HEADER, BOOL) and not found.missing
    assert found.records == {HEADER.key: a_record(), BOOL.key: failed}
    assert found.sessions == ({"Python": "3"},)


def test_the_failure_of_the_last_session_counts(tmp_path):
    path = tmp_path / "r.jsonl"
    more = {"options": OPTIONS, "planned": (HEADER, BOOL), "session": {"a": "b"}}
    for failure in ("it is wrong", "", "again"):
        with ResultsWriter(path, **more) as writer:
            # A session that has not ended is neither a failure nor a success.
            assert read_results(path).failure is None
            writer.conclude(failure)
        assert read_results(path).failure == failure


def test_last_of_two_records_of_a_test_counts(tmp_path):
    path = written(tmp_path / "r.jsonl", a_record(), a_record(verdict=Failed(("later",))))
    assert read_results(path).records[HEADER.key].verdict == Failed(("later",))
    again = written(tmp_path / "again.jsonl", a_record(verdict=Failed(("first",))), a_record())
    assert read_results(again).records == {HEADER.key: a_record()}


def test_keys_differ_for_different_tests():
    others = [
        a_test("std_msgs/msg/Bool"),
        a_test(system="ts2"),
        a_test(simulator="ghdl"),
        a_test(distro="humble"),
        a_test(wire="ros1"),
        a_test(bus_bytes=4),
        a_test(options="seed=1"),
    ]
    assert len({test.key for test in [HEADER, *others]}) == 8
    assert HEADER.key == "ts3 python lyrical std_msgs/msg/Header cdr/8 seed=0"
    assert a_test(same=("lyrical",)).key == HEADER.key


@pytest.mark.parametrize(
    ("more", "output"),
    [
        ({"verdict": None}, r"^What became of a test must be a verdict, not None$"),
        ({"verdict": "passed"}, r"^What became of a test must be a verdict, not 'passed'$"),
    ],
)
def test_records_without_a_verdict_are_refused(more, output):
    with pytest.raises(ValueError, match=output):
        a_record(**more)


@pytest.mark.parametrize("cut", [1, 2, 20, -1])
def test_torn_last_line_is_dropped_and_replaced(tmp_path, cut):
    path = written(tmp_path / "r", a_record())
    whole = path.read_bytes()
    line = json.dumps({"record": to_json(a_record(BOOL))}).encode()
    path.write_bytes(whole + line[:cut])
    assert list(read_results(path).records) == [HEADER.key]
    written(path, a_record(BOOL))
    found = read_results(path)
    assert list(found.records) == [HEADER.key, BOOL.key] and len(found.sessions) == 2


def test_torn_first_line_is_no_run_yet(tmp_path):
    path = written(tmp_path / "r")
    path.write_bytes(path.read_bytes()[:30])
    assert read_results(path).planned == ()
    assert read_results(written(path, a_record())).missing == (BOOL,)


def test_damage_elsewhere_is_an_error_that_names_the_line(tmp_path):
    path = written(tmp_path / "r", a_record(), a_record(BOOL))
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join([*lines[:2], b'{"record": {"status": "pass"}}\n', *lines[3:]]))
    with pytest.raises(ResultsError, match=r"^'.*', line 3: Test must be an object, not nothing$"):
        read_results(path)


@pytest.mark.parametrize(
    "content",
    [
        *(b"hello", b"hello\n", b"{}\n", b"[]\n"),
        # With and without a line end: only the start of our own first line is torn.
        *(b'{"format": "other"}\n', b'{"format": "other"', b'{"of": "mine"}'),
    ],
)
def test_other_files_are_refused_and_left_alone(tmp_path, content):
    path = tmp_path / "mine"
    path.write_bytes(content)
    with pytest.raises(ResultsError, match=r"^'.*' has no results of firm-hdl verify$"):
        written(path)
    assert path.read_bytes() == content


@pytest.mark.parametrize(
    ("change", "output"),
    [
        ({"options": {"seed": 1, "paths": []}}, "seed was 0, and is 1"),
        ({"options": {"paths": []}}, "seed was 0, and is not given"),
        ({"planned": (HEADER,)}, f"1 test is only in it, such as '{BOOL.key}'"),
        (
            {"planned": (HEADER, BOOL, a_test("a/msg/B"), a_test("a/msg/C"))},
            f"2 tests are not in it, such as '{a_test('a/msg/B').key}'",
        ),
    ],
)
def test_other_runs_are_refused(tmp_path, change, output):
    path = written(tmp_path / "r", a_record())
    before = path.read_bytes()
    with pytest.raises(ResultsError) as caught:
        written(path, **change)
    assert str(caught.value) == (
        f"'{path}' is of another run: {output}; name another file, or remove it"
    )
    assert path.read_bytes() == before


def test_file_has_one_writer_at_a_time(tmp_path):
    path = tmp_path / "r"
    with (
        ResultsWriter(path, options=OPTIONS, planned=[HEADER]),
        pytest.raises(ResultsError, match=r"^'.*' is being written by another run$"),
    ):
        ResultsWriter(path, options=OPTIONS, planned=[HEADER])


FAKE = """
import sys, time
from tests.verify.report.samples import a_record, a_test
from firm_hdl.jobs.executors import run_each
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.verdict import Failed, Passed

def work(number):
    time.sleep(0.01)
    verdict = Failed(("it is odd",)) if number % 7 == 3 else Passed(1)
    return a_record(a_test(f"p/msg/T{number}"), verdict=verdict, cycles=number)

if __name__ == "__main__":
    tests = {number: a_test(f"p/msg/T{number}") for number in range(100)}
    with ResultsWriter(sys.argv[1], options={}, planned=list(tests.values())) as writer:
        missing = {test.key for test in writer.before.missing}
        left = [(n, (n,)) for n, test in tests.items() if test.key in missing]
        print("ready", flush=True)
        for _, record in run_each(work, left, jobs=2):
            writer.add(record)
"""


def outcomes(path: Path) -> dict[str, Record]:
    return {key: without_times(record) for key, record in read_results(path).records.items()}


def ended(processes: set[int]) -> bool:
    return not any(Path(f"/proc/{process}").exists() for process in processes)


def test_run_that_was_killed_goes_on_and_ends_the_same(tmp_path):
    script = tmp_path / "fake.py"
    script.write_text(FAKE)
    root = Path(__file__).parents[3]
    command = [sys.executable, str(script)]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    subprocess.run([*command, str(tmp_path / "whole")], env=environment, check=True)
    seed = random.randrange(1 << 32)
    print(f"seed {seed}")
    rng = random.Random(seed)
    path = tmp_path / "killed"
    kills = counts = 0
    while True:
        process = subprocess.Popen(
            [*command, str(path)], env=environment, stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        process.stdout.readline()
        if kills < 3:
            time.sleep(rng.uniform(0, 0.4))
            process.send_signal(signal.SIGKILL)
            kills += 1
        done_well = process.wait() == 0
        process.stdout.close()
        assert len(outcomes(path)) >= counts, "results were lost"
        counts = len(outcomes(path))
        if done_well:
            break
    assert outcomes(path) == outcomes(tmp_path / "whole") and counts == 100


def test_workers_end_with_a_run_that_was_killed(tmp_path):
    script = tmp_path / "fake.py"
    script.write_text(
        FAKE.replace(
            "time.sleep(0.01)", "time.sleep(0.2); os.write(1, b'pid %d\\n' % os.getpid())"
        ).replace("import sys", "import os, sys")
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])}
    process = subprocess.Popen(
        [sys.executable, str(script), str(tmp_path / "r")],
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    workers = set()
    while len(workers) < 2:
        word, _, number = process.stdout.readline().partition(" ")
        workers |= {int(number)} if word == "pid" else set()
    process.kill()
    process.wait()
    process.stdout.close()
    for _ in range(100):
        if ended(workers):
            return
        time.sleep(0.1)
    raise AssertionError(f"workers {workers} are still there")


def changed(**values: object) -> str:
    return json.dumps({"record": {**to_json(a_record()), **values}})


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        # Python's own message about list indices would not help readers.
        ("[]", "it is damaged"),
        ("{}", "it is damaged"),
        ("3", "it is damaged"),
        ("{", "it is damaged"),
        ('{"record": {"test": {"age": 3}}}', "it is damaged"),
        ('{"record": {"test": {"system": "x"}}}', "it is damaged"),
        ('{"record": []}', "A record must be an object, not a list"),
        ('{"record": {"test": 3}}', "Test must be an object, not a number"),
        # Python reads such numbers, but reports cannot write them.
        ('{"session": NaN}', "A number must be finite, not NaN"),
        ('{"session": -Infinity}', "A number must be finite, not -Infinity"),
        ('{"session": 1e999}', "A number must be finite, not 1e999"),
        (f'{{"session": {"9" * 5000}}}', "A number must have at most 1000 digits, not 5000"),
        ('{"session": ' + "[" * 9999 + "]" * 9999 + "}", "it is damaged"),
        (changed(cycles=True), "Record: cycles must be of another type"),
        (changed(cycles=-1), "A number must be from 0 to 1e+100, not -1"),
        (changed(cpu_seconds=-0.5), "A number must be from 0 to 1e+100, not -0.5"),
        (
            changed(seconds={"testing": 10**400}),
            f"A number must be from 0 to 1e+100, not 1{'0' * 19}... (401 characters)",
        ),
        (
            changed(metrics={"depth": 1e300}),
            "A number must be from 0 to 1e+100, not 1e+300",
        ),
        (
            changed(verdict={"verdict": "v" * 9999}),
            "A verdict must be one of failed, not judged, known difference, passed, not "
            f"{{'verdict': '{'v' * 187}... (10014 characters)",
        ),
        ('{"session": 7}', "A session must be an object of texts"),
        ('{"session": {"started": 7}}', "A session must be an object of texts"),
        ('{"failure": 7}', "A failure must be a text"),
    ],
)
def test_an_invalid_line_is_reported_with_the_reason(tmp_path, line, reason):
    path = written(tmp_path / "r.jsonl", a_record())
    with path.open("a") as file:
        file.write(f"{line}\n")
    number = len(path.read_text().splitlines())
    with pytest.raises(ResultsError) as error:
        read_results(path)
    assert str(error.value) == f"'{path}', line {number}: {reason}"


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ('"options": 7, "planned": []', "The options must be an object"),
        ('"options": {"seed": NaN}, "planned": []', "A number must be finite, not NaN"),
        ('"options": {}, "planned": [{"system": 1}]', "Test: system must be of another type"),
        ('"options": {}, "planned": 7', "it is damaged"),
    ],
)
def test_an_invalid_first_line_is_reported_with_the_reason(tmp_path, more, reason):
    path = tmp_path / "r.jsonl"
    path.write_text(f'{{"format": "{FORMAT}", {more}}}\n')
    with pytest.raises(ResultsError) as error:
        read_results(path)
    assert str(error.value) == f"'{path}', line 1: {reason}"


def test_a_line_that_would_fill_the_memory_is_not_read(tmp_path):
    path = written(tmp_path / "r.jsonl", a_record())
    with path.open("a") as file:
        file.write(f'{{"record": [{"[]," * (12 << 20)}[]]}}\n')
    with pytest.raises(ResultsError, match="line 4: A line must have at most 33554432 bytes, not"):
        read_results(path)
