"""Result files: complete and correct after a crash, and bound to one run."""

from __future__ import annotations

import json

import pytest

from firm_hdl.verify.results.file import FORMAT, ResultsError, ResultsWriter, read_results
from firm_hdl.verify.results.records import to_json
from firm_hdl.verify.results.verdict import Failed
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
    with pytest.raises(ResultsError, match=r"^'.*', line 3: it is damaged$"):
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


def changed(**values: object) -> str:
    return json.dumps({"record": {**to_json(a_record()), **values}})


@pytest.mark.parametrize(
    "line",
    [
        *("[]", "{}", "3", "{", '{"record": []}', '{"record": {"test": 3}}'),
        '{"record": {"test": {"system": "x"}}}',
        '{"session": ' + "[" * 9999 + "]" * 9999 + "}",
        *('{"session": 7}', '{"session": {"started": 7}}', '{"failure": 7}'),
        # Python reads such numbers, but reports cannot write them.
        *('{"session": NaN}', '{"session": -Infinity}', '{"session": 1e999}'),
        *(changed(cycles=-1), changed(cpu_seconds=-0.5), changed(seconds={"testing": 10**400})),
        changed(metrics={"depth": 1e300}),
        # Values of other types, and what no record has.
        *(changed(cycles=True), changed(cases=1.5), changed(written_by=[True]), changed(age=3)),
        *(changed(metrics={"steps": None}), changed(coverage={"taken": 1})),
        *(changed(verdict={"verdict": "good"}), changed(verdict={"verdict": "passed", "cases": 0})),
        changed(verdicts=[{"oracle": 7, "verdict": "passed", "cases": 1}]),
        # It would take thirty times its size.
        f'{{"record": [{"[]," * (12 << 20)}[]]}}',
    ],
    ids=lambda line: line[:40],
)
def test_a_damaged_line_is_named(tmp_path, line):
    path = written(tmp_path / "r.jsonl", a_record())
    with path.open("a") as file:
        file.write(f"{line}\n")
    number = len(path.read_text().splitlines())
    with pytest.raises(ResultsError) as error:
        read_results(path)
    assert str(error.value) == f"'{path}', line {number}: it is damaged"


@pytest.mark.parametrize(
    "more",
    [
        '"options": 7, "planned": []',
        '"options": {"seed": NaN}, "planned": []',
        '"options": {}, "planned": [{"system": 1}]',
        '"options": {}, "planned": 7',
    ],
)
def test_a_damaged_first_line_is_named(tmp_path, more):
    path = tmp_path / "r.jsonl"
    path.write_text(f'{{"format": "{FORMAT}", {more}}}\n')
    with pytest.raises(ResultsError, match=r"^'.*', line 1: it is damaged$"):
        read_results(path)
