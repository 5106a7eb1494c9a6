"""What all test systems share: the times, records and commands of tests, and their shares."""

from __future__ import annotations

from dataclasses import replace
from itertools import count

import pytest

from firm_hdl.cases import NotJudgedError
from firm_hdl.jobs.executors import ExecutorError
from firm_hdl.verify.results.file import ResultsWriter, read_results
from firm_hdl.verify.results.records import MOST_FAILURES, Seconds
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems import system
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import (
    Recorder,
    Stopwatch,
    TypesSystem,
    failure_of,
    judged,
    kept,
    recorded,
    run_shares,
    run_tests,
    shares_of,
    wire_of,
)
from firm_hdl.verify.systems.tasks import TypeUnderTest
from tests.verify.report.samples import a_record, a_test


@pytest.fixture
def clock(monkeypatch):
    """Clocks that go on by 1 s of elapsed time, and by 100 s of processor time, at each look."""
    elapsed, processor = count(1000), count(5000, 100)
    monkeypatch.setattr(system.time, "perf_counter", lambda: float(next(elapsed)))
    monkeypatch.setattr(system, "cpu_seconds", lambda: float(next(processor)))


def test_stages_have_their_times_also_if_they_come_again(clock):
    watch = Stopwatch()
    for stage in ("simulation", "testing", "simulation"):
        watch.enter(stage)
    assert watch.stop() == (Seconds(generation=1, simulation=2, testing=1), 100.0)


def test_a_record_has_its_times_and_an_exception_becomes_its_verdict(clock):
    test = a_test()
    found = recorded(test, lambda watch: a_record(test, verdict=Passed(7)))
    assert found == a_record(
        test, verdict=Passed(7), seconds=Seconds(generation=1), cpu_seconds=100.0
    )

    def fail(watch, error):
        watch.enter("testing")
        raise error

    for error, verdict in (
        (NotJudgedError("nobody knows"), NotJudged("nobody knows")),
        (NotJudgedError(), NotJudged("NotJudgedError")),
    ):
        found = recorded(test, lambda watch, error=error: fail(watch, error))
        assert found.verdict == verdict
        assert found.seconds == Seconds(generation=1, testing=1)
    found = recorded(test, lambda watch: fail(watch, KeyError("x")))
    assert isinstance(found.verdict, Failed) and "KeyError" in found.verdict.failures[0]


def test_all_failures_are_printed_and_nothing_else():
    assert list(failure_of("it", a_record(verdict=Failed(("one", "two"))))) == [
        "FAIL it\n    one\n    two"
    ]
    assert not [*failure_of("it", a_record())]
    assert not [*failure_of("it", a_record(verdict=NotJudged("nobody knows")))]


class Types(TypesSystem):
    """A system that only has tests and commands."""

    name = "own"
    tests = ()
    options = {}  # noqa: RUF012

    def run(self, recorder):
        return []


def test_tests_and_commands_have_what_results_depend_on():
    task = TypeUnderTest(distro="jazzy", name="p/msg/A", same=("humble", "jazzy"))
    request = Request(paths=("a", "b c"), wire="ros1", widths=(2, 4))
    test = Types([task], request)._test(task, 4, "ghdl")
    assert test.key == "own ghdl jazzy p/msg/A ros1/4 path=a,path=b c"
    assert test.same == ("humble", "jazzy")
    command = "firm-hdl verify --systems own --distro jazzy --path a --path 'b c' --wire ros1"
    assert Types([task], request)._command(test) == f"{command} --bus-bytes 4 p/msg/A"
    assert Types([task], request)._command(test, golden="g") == f"{command} --golden g p/msg/A"
    assert Types([task], Request())._test(task, 2).key == "own jazzy p/msg/A cdr/2"
    assert (wire_of("noetic", None), wire_of("jazzy", None)) == ("ros1", "cdr")
    assert wire_of("noetic", "cdr") == "cdr"


def test_the_verdict_that_counts_is_that_of_the_circuit():
    one = a_record(a_test("p/A"), verdict=Failed(("no",)))
    twin = a_record(a_test("p/B"), same_as=one.test.key)
    names = [(each.what, each.verdict.name) for each in judged([one, twin])]
    suffix = "(kilted, lyrical), ts3, 8-byte bus"
    assert names == [(f"p/A {suffix}", "failed"), (f"p/B {suffix}", "failed")]


TESTS = {name: a_test(f"p/{name}") for name in "ABC"}


def test_records_are_kept_in_a_file_and_are_not_made_again(tmp_path, capsys):
    path, made = tmp_path / "r.jsonl", []

    def run(left):
        made.append(list(left))
        # Two at once, in another order than the tests.
        yield [(key, a_record(TESTS[key]), [f"line of {key}"]) for key in reversed(left)]

    def again(tests):
        with ResultsWriter(path, options={}, planned=list(TESTS.values())) as writer:
            return kept(tests, Recorder(writer), run, label="", unit="thing")

    first = {key: TESTS[key] for key in "AB"}
    assert list(again(first)) == ["A", "B"] and made == [["A", "B"]]
    assert len(read_results(path).records) == 2
    assert capsys.readouterr().out == "line of B\nline of A\n"
    assert list(again(TESTS)) == ["A", "B", "C"] and made == [["A", "B"], ["C"]]
    assert capsys.readouterr().out == f"2 of 3 things have a result in {path}\nline of C\n"
    # Without a file, all are made.
    assert list(kept(TESTS, Recorder(), run, label="")) == ["A", "B", "C"]
    assert made[2:] == [["A", "B", "C"]]


def test_the_progress_counts_the_tests_of_earlier_sessions_and_those_of_each_share(
    tmp_path, monkeypatch
):
    shown = []

    class Bar:
        def __init__(self, *, total, initial, unit, desc, disable):
            # Without a terminal, there is no bar.
            shown.append((total, initial, unit, desc, disable))

        def __enter__(self):
            return self

        def __exit__(self, *error):
            shown.append("closed")

        def update(self, count):
            shown.append(count)

    monkeypatch.setattr(system, "tqdm", Bar)

    def run(left):
        for share in (left[:2], left[2:]):
            yield [(key, a_record(TESTS[key]), []) for key in share]

    with ResultsWriter(tmp_path / "r", options={}, planned=list(TESTS.values())) as writer:
        writer.add(a_record(TESTS["B"]))
    with ResultsWriter(tmp_path / "r", options={}, planned=list(TESTS.values())) as writer:
        kept(TESTS, Recorder(writer), run, label="4-byte bus", unit="thing")
    kept(TESTS, Recorder(), run, label="4-byte bus")
    assert shown == [
        *((3, 1, "thing", "4-byte bus", None), 2, 0, "closed"),
        *((3, 0, "type", "4-byte bus", None), 2, 1, "closed"),
    ]


def run_with(results, monkeypatch, **options):
    """Run the tests `A` to `C` in shares of two, with given results of shares."""
    asked = []

    def shares(work, context, given, **more):
        asked.append((list(given), more))
        yield from zip(given, results, strict=True)

    monkeypatch.setattr(system, "run_shares", shares)
    monkeypatch.setattr(system, "shares_of", lambda items, most: [tuple(items[:2]), (items[2],)])
    command = lambda test: f"again {test.type}"  # noqa: E731
    lines = lambda record: [record.command]  # noqa: E731
    found = list(run_tests(len, None, list(TESTS.values()), command, lines, most=2, **options))
    return found, asked


def test_each_test_of_a_share_has_its_record_and_its_command(monkeypatch):
    long = Failed(("no",) * (MOST_FAILURES + 2))
    one, two, three = (a_record(test, command="") for test in TESTS.values())
    given = [[one, replace(two, verdict=long)], ExecutorError("it died")]
    found, asked = run_with(given, monkeypatch, executor="dask://host:1", jobs=3)
    a, b, c = TESTS.values()
    assert asked == [([(a, b), (c,)], {"executor": "dask://host:1", "jobs": 3})]
    assert [[(key, lines) for key, _, lines in share] for share in found] == [
        [(a, ["again p/A"]), (b, ["again p/B"])],
        [(c, ["again p/C"])],
    ]
    assert found[0][0][1] == replace(one, command="again p/A")
    assert found[0][1][1].verdict.failures[-1] == "and 2 more"
    assert found[1][0][1].verdict == Failed(("ExecutorError: it died",))
    died, _ = run_with([ExecutorError("it died"), [three]], monkeypatch)
    assert [record.verdict.name for share in died for _, record, _ in share] == [
        *("failed", "failed", "passed"),
    ]


@pytest.mark.parametrize(
    ("items", "most", "parts", "sizes"),
    [
        (0, 4, 2, []),
        (1, 4, 2, [1]),
        (7, 4, 2, [3, 3, 1]),
        (9, 4, 2, [4, 4, 1]),
        (40, 4, 2, [4] * 10),
        (3, 1, 1, [1, 1, 1]),
    ],
)
def test_shares_have_all_items_in_their_order(items, most, parts, sizes):
    found = shares_of(range(items), most, parts)
    assert [len(share) for share in found] == sizes
    assert [item for share in found for item in share] == list(range(items))


def test_only_a_dead_process_is_tried_again_and_where_it_ran(monkeypatch):
    asked = []

    def answer(work, tasks, **options):
        asked.append((list(tasks), options))
        for share, _ in tasks:
            error = ExecutorError("it died") if 1 in share else ValueError("wrong")
            yield share, error

    monkeypatch.setattr(system, "run_each", answer)
    options = {"executor": "dask://host:1", "jobs": 3}
    found = list(run_shares(len, "context", [(1, 2), (3, 4)], **options))
    assert [share for share, _ in found] == [(3, 4), (1,), (2,)]
    assert asked == [
        ([((1, 2), ("context", (1, 2))), ((3, 4), ("context", (3, 4)))], options),
        ([((1,), ("context", (1,))), ((2,), ("context", (2,)))], options),
    ]
