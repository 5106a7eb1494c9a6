"""What all test systems share: the times, records and commands of tests, and their shares."""

from __future__ import annotations

from itertools import count

import pytest

from firm_hdl.cases import NotJudgedError
from firm_hdl.verify.results.file import ResultsWriter, read_results
from firm_hdl.verify.results.records import MOST_FAILURES, Seconds
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems import system
from firm_hdl.verify.systems.system import (
    Trial,
    counted,
    run_and_record,
    run_tests,
)
from tests.verify.report.samples import a_record, a_test


@pytest.fixture
def clock(monkeypatch):
    """Clocks that go on by 1 s of elapsed time, and by 100 s of processor time, at each look."""
    elapsed, processor = count(1000), count(5000, 100)
    monkeypatch.setattr(system.time, "perf_counter", lambda: float(next(elapsed)))
    monkeypatch.setattr(system, "cpu_seconds", lambda: float(next(processor)))


def test_a_record_has_its_times_and_an_exception_becomes_its_verdict(clock):
    test = a_test()
    with Trial.of(test) as trial:
        trial.judged = 7
    found = trial.end()
    assert (found.test, found.verdict) == (test, Passed(7))
    assert (found.seconds, found.cpu_seconds) == (Seconds(generation=1), 100.0)
    for error, verdict in (
        (NotJudgedError("nobody knows"), NotJudged("nobody knows")),
        (NotJudgedError(), NotJudged("NotJudgedError")),
        (KeyError("x"), Failed(("KeyError: 'x'",))),
    ):
        with Trial.of(test) as trial:
            trial.watch.enter("testing")
            raise error
        found = trial.end()
        assert found.verdict == verdict
        assert found.seconds == Seconds(generation=1, testing=1)


SILENT = NotJudged("nobody knows")


@pytest.mark.parametrize(
    ("given", "verdict"),
    [
        ({"judged": 3}, Passed(3)),
        ({"judged": 3, "known": ("k",)}, KnownDifference(("k",), 3)),
        ({"judged": 3, "known": ("k",), "obstacle": SILENT}, SILENT),
        ({"judged": 3, "failures": ["a", "b"], "obstacle": SILENT}, Failed(("a", "b"))),
        ({"judged": 3, "failures": ["a"], "known": ("k",)}, Failed(("a",))),
        ({}, NotJudged("nothing was compared with an oracle")),
        ({"known": ("k",)}, NotJudged("nothing was compared with an oracle")),
    ],
)
def test_the_worst_that_is_known_is_the_verdict(given, verdict):
    trial = Trial.of(a_test())
    for name, value in given.items():
        setattr(trial, name, value)
    assert trial.end().verdict == verdict


def test_the_verdict_that_counts_is_that_of_the_circuit():
    one = a_record(a_test("p/A"), verdict=Failed(("no",)))
    twin = a_record(a_test("p/B"), same_as=one.test.key)
    names = [(each.test.title, each.verdict.name) for each in counted([one, twin])]
    suffix = "(kilted, lyrical), ts3, 8-byte bus"
    assert names == [(f"p/A {suffix}", "failed"), (f"p/B {suffix}", "failed")]


TESTS = [a_test(f"p/{name}") for name in "ABC"]


def test_records_are_kept_in_a_file_and_are_not_made_again(tmp_path, capsys):
    path, made = tmp_path / "r.jsonl", []

    def run(left):
        made.append(list(left))
        # Two at once, in another order than the tests.
        yield [a_record(test) for test in reversed(left)]

    def lines_of(record):
        return [f"line of {record.test.type}"]

    def again(tests):
        with ResultsWriter(path, options={}, planned=TESTS) as writer:
            found = run_and_record(tests, writer, run, lines_of, label="", unit="thing")
            assert [record.test for record in found] == tests

    again(TESTS[:2])
    assert made == [TESTS[:2]] and len(read_results(path).records) == 2
    assert capsys.readouterr().out == "line of p/B\nline of p/A\n"
    again(TESTS)
    assert made == [TESTS[:2], TESTS[2:]]
    assert capsys.readouterr().out == f"2 of 3 things have a result in {path}\nline of p/C\n"
    # Without a file, all are made.
    assert len(run_and_record(TESTS, None, run, lines_of, label="")) == 3 and made[2:] == [TESTS]


def fails_often(context, test):
    trial = Trial.of(test)
    trial.failures += ["no"] * (MOST_FAILURES + 3)
    return trial.end()


def test_of_many_failures_the_first_are_kept_and_the_others_counted():
    ((record,),) = run_tests(fails_often, None, [a_test()], lambda test: "again", jobs=1)
    assert record.failures == (*["no"] * MOST_FAILURES, "and 3 more")
    assert record.command == "again"
