"""What TS1 tells of its verdicts: printed lines, records, commands, and the options of a run."""

from __future__ import annotations

from types import SimpleNamespace
from typing import ClassVar

import pytest

from firm_hdl.jobs.executors import ExecutorError
from firm_hdl.model import Message, Service
from firm_hdl.verify.results.records import OracleVerdict
from firm_hdl.verify.results.records import Test as Tested
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import Recorder
from firm_hdl.verify.ts1 import command, judge
from firm_hdl.verify.ts1 import run as running
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.command import Ts1
from firm_hdl.verify.ts1.judge import judge_case, record_of
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Oracle, Refused
from firm_hdl.verify.ts1.run import Ts1Run
from tests.frontend.workspace import make_files


def case_of(name, text="int8 x\n", before=None, language="msg"):
    return DefinitionCase(
        dialect="ros2", package="p", kind="msg", name=name, language=language, text=text,
        before=before,
    )  # fmt: skip


class Run:
    """A run whose verdicts are given; `verdicts` has those of each definition."""

    distro = "iron"

    def __init__(self, *verdicts, cases=None, **asked):
        self.request = Request(distros=("iron",), types=("p/A",), **asked)
        self.cases = cases or [case_of(f"A{number}") for number in range(len(verdicts))]
        self.versions = {"one": "1.0", "two": "2"}
        self.missing = {"three": "it is not there"}
        self.digest = "1234"
        first = self.request.seed if self.request.mutations else 0
        self.numbers = range(first, first + len(verdicts))
        self.verdicts = dict(zip(self.numbers, verdicts, strict=True))

    @property
    def total(self):
        return len(self.numbers)

    def case(self, number):
        return self.cases[number - self.numbers[0]]

    def test(self, number):
        return Tested(system="ts1", distro="iron", type=self.case(number).spelled_name)

    def judgements(self, left):
        yield [(number, self.record(number)) for number in left]

    def record(self, number):
        found = [
            OracleVerdict(oracle=name, verdict=verdict, is_refused=name == "two")
            for name, verdict in self.verdicts[number].items()
        ]
        return record_of(self.test(number), "msg", found)


def judged(run):
    return Ts1([]).judge(run, Recorder())


AGAIN = "firm-hdl verify --systems ts1 --distro iron"


def test_a_difference_is_printed_with_its_first_details(capsys):
    details = tuple(f"detail {number}" for number in range(9))
    judged(Run({"one": Failed(details[:8]), "two": Passed(1)}, {"two": Failed(details)}))
    lines = capsys.readouterr().out.splitlines()
    first = lines.index("DIFFERS p/msg/A0.msg, one")
    assert lines[first + 1 : first + 10] == [
        *(f"    {detail}" for detail in details[:8]),
        f"    again: {AGAIN} p/msg/A0",
    ]
    second = lines.index("DIFFERS p/msg/A1.msg, two")
    assert lines[second + 1 : second + 11] == [
        *(f"    {detail}" for detail in details[:8]),
        "    and 1 more",
        f"    again: {AGAIN} p/msg/A1",
    ]
    assert sum(line.startswith("DIFFERS") for line in lines) == 2
    assert lines[-1].startswith("2 definitions, ") and lines[-1].endswith(" 2 differences")


def test_a_difference_of_a_mutation_is_printed_with_the_change(capsys):
    text = "int8 a\nint8 b\nint8 c\nint8 d\n"
    case = case_of("A", text.replace("8 a", "9 a").replace("8 d", "8"), before=text)
    run = Run({"one": Failed(("no",))}, cases=[case], mutations=1, seed=7)
    (found,) = judged(run)
    output = capsys.readouterr().out
    assert (
        "DIFFERS p/msg/A.msg, one\n    -int8 a\n    +int9 a\n    -int8 d\n    +int8\n    no\n"
        f"    again: {AGAIN} --mutations 1 --seed 7 p/A\n"
    ) in output
    assert "\n1 mutation, " in output and found.verdict == Failed(("one: no",))
    # An unchanged definition has no changes to print.
    judged(Run({"one": Failed(("no",))}))
    assert "DIFFERS p/msg/A0.msg, one\n    no\n" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("count", "asked", "what"),
    [
        (1, {}, "1 definition"),
        (2, {}, "2 definitions"),
        # The seed is for mutations, and may be 0.
        (1, {"seed": 5}, "1 definition"),
        (1, {"mutations": 1}, "1 mutation"),
        (3, {"mutations": 3, "seed": 5}, "3 mutations"),
    ],
)
def test_what_was_judged_is_counted_by_its_name(capsys, count, asked, what):
    judged(Run(*[{"one": Passed(1)}] * count, **asked))
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith(f"{what}, ") and last.endswith(" s, 0 differences")


def test_verdicts_are_counted_in_rows_and_details_below(capsys):
    judged(
        Run(
            {"one": Passed(3), "two": Passed(1)},
            {"one": KnownDifference(("k", "l"), 2), "two": NotJudged("it slept")},
            {"one": KnownDifference(("k",), 2), "two": Passed(2)},
            {"one": Failed(("no",)), "two": NotJudged("it slept")},
        )
    )
    lines = capsys.readouterr().out.splitlines()
    head = next(n for n, line in enumerate(lines) if line.startswith("oracle "))
    assert lines[head].split() == ["oracle", "agree", "known", "differ", "not", "judged"]
    assert lines[head + 1].split() == ["one", "1.0", "1", "2", "1", "0"]
    assert lines[head + 2].split() == [
        "two", "2", "2", "0", "0", "2", "(4", "refused", "by", "both)"
    ]  # fmt: skip
    assert lines[head + 3].split(maxsplit=1) == ["three", "is not available: it is not there"]
    assert lines[head + 4 : head + 7] == [
        "known, one: k: 2",
        "known, one: l: 1",
        "not judged, two: it slept: 2",
    ]
    assert "p/msg/A1  one  known: k; l" in lines and "p/msg/A0  one  agrees" in lines
    assert "p/msg/A1  two  not judged: both refuse" in lines


@pytest.mark.parametrize(("count", "is_short"), [(20, True), (21, False)])
def test_few_definitions_are_listed_one_by_one(capsys, count, is_short):
    judged(Run(*[{"one": Passed(1)}] * count))
    assert ("p/msg/A0  one  agrees\n" in capsys.readouterr().out) is is_short
    judged(Run(*[{"one": Passed(1)}] * 2, mutations=2))
    assert "p/msg/A0  one  agrees\n" not in capsys.readouterr().out


def test_an_oracle_that_is_missing_fails_only_if_it_was_named(capsys):
    failed = Failed(("is not available: it is not there",))
    (one,) = judged(Run({"one": Passed(1)}))
    assert (one.what, one.verdict) == ("p/msg/A0 (iron), ts1", Passed(1))
    one, other = judged(Run({"one": Passed(1)}, oracles=("one", "three")))
    assert (other.what, other.verdict) == ("oracle three", failed)


def test_records_have_the_command_with_the_named_oracles_and_short_texts():
    run = Run({"one": Failed(("x" * 100_000,))}, oracles=("one", "two"), mutations=1, seed=3)
    record = command._kept(run, 3, run.record(3))
    assert record.command == (f"{AGAIN} --oracle one --oracle two --mutations 1 --seed 3 p/A")
    (each,) = record.verdicts
    assert len(each.verdict.failures[0]) < 10_000 > len(record.verdict.failures[0])
    assert each.oracle == "one"


def test_options_name_each_oracle_once_and_what_is_mutated():
    system = Ts1([])
    system._runs = [Run(), Run()]
    assert system.options == {"oracles": ["one 1.0", "two 2"]}
    runs = system._runs = [Run(mutations=1), Run(mutations=1), Run()]
    runs[0].distro, runs[1].distro, runs[1].digest = "foxy", "humble", "5678"
    runs[1].versions = {"one": "1.1", "own": ""}
    assert system.options == {
        "oracles": ["one 1.0", "one 1.1", "own", "two 2"],
        "mutated": {"foxy": "1234", "humble": "5678"},
    }


# One definition.


class Fake(Oracle):
    """An oracle that takes the time of a process that it shares with others."""

    languages: ClassVar = {"ros2": frozenset({"msg"})}
    spent = 0.0

    def __init__(self, name, answer, seconds):
        self.name, self.answer, self.seconds = name, answer, seconds

    def missing(self):
        return None

    def judge(self, cases):
        Fake.spent += self.seconds
        if isinstance(self.answer, Exception):
            raise self.answer
        return [self.answer] * len(cases)

    def cpu_seconds(self):
        return Fake.spent


def test_all_oracles_judge_and_their_time_counts_once(court, monkeypatch):
    files = {"p/msg/A.msg": "B b\nint8 x\n", "p/msg/B.msg": "int8 y\nstring s\nint8 z\n"}
    here = court("lyrical", files)
    (case,) = here.universe.select(["p/A"])
    monkeypatch.setattr(judge.Stopwatch, "stop", lambda self: (SimpleNamespace(), 100.0))
    oracles = [
        Fake("one", Accepted({"names": ["p/msg/A"]}), 1.0),
        Fake("two", ValueError("broken"), 2.0),
        Fake("three", NotJudged("it slept"), 4.0),
    ]
    record = judge_case(here.universe, oracles, case, Tested(system="ts1", distro="x", type="p/A"))
    assert record.cpu_seconds == 107.0
    assert [(each.oracle, each.verdict) for each in record.verdicts] == [
        ("one", Passed(1)),
        ("two", Failed(("the oracle raised ValueError: broken",))),
        ("three", NotJudged("it slept")),
    ]
    assert record.verdict == Failed(("two: the oracle raised ValueError: broken",))
    assert record.metrics == {"characters": 11.0, "fields": 2.0, "depth": 2.0}


def test_figures_of_a_service_are_of_both_of_its_messages(court):
    files = {"p/srv/S.srv": "int8 a\n---\nB b\nint8 c\n", "p/msg/B.msg": "int8 y\n"}
    here = court("foxy", files)
    (case,) = here.universe.select(["p/S"])
    service = here.universe.interface(case)
    assert isinstance(service, Service)
    assert judge._metrics(case, service) == {"characters": 22.0, "fields": 3.0, "depth": 2.0}
    assert judge._metrics(case, ValueError()) == {"characters": 22.0}


def test_changed_definitions_are_only_for_oracles_that_judge_them(court):
    here = court("lyrical", {"p/msg/A.msg": "int8 x\n"})
    (case,) = here.universe.select(["p/A"])
    mutant = case_of("A", "int8\n", before="int8 x\n")
    oracle = Fake("one", Refused("no"), 0)
    assert judge.judge(here.universe, oracle, mutant).verdict == Passed(1)
    oracle.judges_changes = False
    assert judge.judge(here.universe, oracle, mutant) is None
    assert isinstance(judge.judge(here.universe, oracle, case).verdict, Failed)
    oracle.languages = {"ros1": frozenset({"msg"})}
    assert judge.judge(here.universe, oracle, case) is None
    # A reading that is given is not made again.
    oracle.languages = Fake.languages
    own = Message(name="p/msg/A", dialect="ros2", fields=())
    oracle.answer = Accepted({"structure": {"p/msg/A": {"fields": []}}})
    assert judge.judge(here.universe, oracle, case, own).verdict == Passed(1)


def test_known_differences_are_noted_with_their_oracles():
    known = [
        OracleVerdict(oracle=name, verdict=KnownDifference(keys, 2))
        for name, keys in (("a", ("k", "l")), ("b", ("k",)))
    ]
    passed = OracleVerdict(oracle="c", verdict=Passed(3))
    record = record_of(Tested(system="ts1", distro="x", type="p/A"), "msg", [*known, passed])
    texts = [("a", "k"), ("a", "l"), ("b", "k")]
    assert record.note == "; ".join(f"known difference from {who}: {key}" for who, key in texts)
    assert record.verdict == KnownDifference(("k", "l"), 7)


# Shares of a run.


def test_long_definitions_come_first_and_shares_have_limits(monkeypatch):
    cases = [case_of("A", "x" * size) for size in (5, 9, 1, 9, 2, 8, 0)]
    monkeypatch.setattr(running, "_LEAST_SHARES", 2)
    assert running._shares(cases, range(7)) == [(1, 3, 5), (0, 4, 2), (6,)]
    assert running._shares(cases, [6, 5, 0, 2]) == [(5, 0), (2, 6)]
    monkeypatch.setattr(running, "_MOST_CASES", 2)
    assert running._shares(cases, range(7)) == [(1, 3), (5, 0), (4, 2), (6,)]
    monkeypatch.setattr(running, "_MOST_CHARACTERS", 9)
    assert running._shares(cases, range(7)) == [(1,), (3,), (5, 0), (4, 2), (6,)]
    monkeypatch.setattr(running, "_LEAST_SHARES", 64)
    assert running._shares(cases, [2, 1]) == [(1,), (2,)]
    assert running._shares(cases, []) == []


@pytest.fixture
def request_of(tmp_path):
    files = {"src/p/msg/A.msg": "int8 x\n", "src/p/msg/B.msg": "int16 y\n"}
    path = str(make_files(tmp_path, files) / "src")

    def request(**more):
        known = {"distros": ("lyrical",), "paths": (path,), "oracles": ("rosbags",), "jobs": 1}
        return Request(**{**known, **more})

    return request


def test_a_process_that_dies_fails_its_definition_and_other_errors_end_the_run(
    request_of, monkeypatch
):
    def run_shares(work, key, shares, *, jobs):
        assert jobs == 1
        yield (1,), ExecutorError("it was killed")
        yield (0,), work(key, (0,))
        yield (0,), OSError("no disk")

    monkeypatch.setattr(running, "run_shares", run_shares)
    with Ts1Run(request_of()) as run:
        found = run.judgements()
        ((number, record),) = next(found)
        assert (number, record.test.type) == (1, "p/msg/B")
        assert record.verdict == Failed(("its process: it was killed",))
        ((number, record),) = next(found)
        assert (number, record.verdict.name) == (0, "passed")
        with pytest.raises(OSError, match="no disk"):
            next(found)


def test_a_run_keeps_nothing_and_ends_its_oracles(request_of, monkeypatch):
    opened, closed = [], []

    class Closing(Fake):
        def __init__(self, universe):
            opened.append(type(self).name)
            super().__init__(type(self).name, Refused("no"), 0)

        def missing(self):
            return "it is not there" if self.name == "three" else None

        def close(self):
            closed.append(self.name)

    kinds = {name: type(name, (Closing,), {"name": name}) for name in ("one", "two", "three")}
    kinds["other"] = type("other", (Closing,), {"name": "other", "languages": {"ros1": {"msg"}}})
    monkeypatch.setattr(running, "ORACLES", kinds)
    with Ts1Run(request_of(oracles=())) as run:
        assert (list(run.versions), run.missing) == (["one", "two"], {"three": "it is not there"})
        # Those that were only asked whether they are there have ended.
        assert closed == ["one", "two", "three"]
        judgements = [each for share in run.judgements() for each in share]
        assert [number for number, _ in sorted(judgements, key=lambda each: each[0])] == [0, 1]
        assert closed == ["one", "two", "three"] and running._sessions
    # All definitions are judged by the same ones.
    assert closed[3:] == ["one", "two"] and opened == closed and not running._sessions


def test_tests_differ_in_all_that_was_asked_for(request_of):
    def options(**more):
        with Ts1Run(request_of(**more)) as run:
            return run.test(run.numbers[-1]).options, run.numbers, run.total

    path = f"path={request_of().paths[0]}"
    assert options() == (f"{path},oracle=rosbags", range(2), 2)
    # The seed is the first number of mutations, and of nothing else.
    assert options(seed=5)[1:] == (range(2), 2)
    asked = {"types": ("p/A", "p/B"), "mutations": 3, "seed": 5}
    assert options(**asked) == (
        f"{path},oracle=rosbags,of=p/A,of=p/B,mutation=7", range(5, 8), 3
    )  # fmt: skip
