"""Verdicts of TS1: each kind of fault in the front end must be found."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.model import Primitive, Sequence, String
from firm_hdl.verify.results.records import OracleVerdict
from firm_hdl.verify.results.records import Test as Tested
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.ts1 import judge as judging
from firm_hdl.verify.ts1.judge import compare, judge, judge_case, record_of
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Refused
from tests.verify.judged import assert_passed
from tests.verify.report.samples import a_test

GOOD = {
    "p/msg/A.msg": "int8 LOW=-1\nstring<=8 name\nuint16[<=4] codes\nB b\n",
    "p/msg/B.msg": "float64[3] x\n",
}
ROS1 = {"p/msg/A.msg": "int8 LOW=-1\nstring name\nuint16[] codes\nB b\n", "p/msg/B.msg": "int8 x\n"}


class FixedOracle:
    """An oracle with given answers."""

    name = "genmsg"

    def alike(self, case):
        return {}


def verdict(court, ours, answer):
    case = court("noetic", ROS1).universe.select(["p/A"])[0]
    return compare(FixedOracle(), case, ours, answer)


def refusal():
    return DefinitionError([Diagnostic(message="it is wrong")])


def test_both_refuse(court):
    outcome = verdict(court, refusal(), Refused("no"))
    assert (outcome.verdict, outcome.is_refused) == (Passed(1), True)


def test_only_we_refuse(court):
    outcome = verdict(court, refusal(), Accepted({}))
    assert isinstance(outcome.verdict, Failed)
    assert outcome.verdict.details == ("verdict: firm-hdl refuses: it is wrong; oracle accepts",)


def test_only_the_oracle_refuses(court):
    model = court("noetic", ROS1).universe.library.message("p/A")
    outcome = verdict(court, model, Refused("no"))
    assert outcome.verdict.details == ("verdict: firm-hdl accepts; oracle refuses: no",)


@pytest.mark.parametrize("answer", [Refused("no"), Accepted({})])
def test_an_exception_that_is_no_refusal_is_a_difference(court, answer):
    outcome = verdict(court, RecursionError("deep"), answer)
    assert outcome.verdict.details == ("verdict: firm-hdl raised RecursionError: deep",)


def test_unjudged_definitions_are_neither_passed_nor_failed(court):
    outcome = verdict(court, refusal(), NotJudged("it slept"))
    assert outcome.verdict == NotJudged("it slept")


def test_one_oracle_that_judges_is_enough_and_none_is_too_few():
    def common(*verdicts):
        each = [
            OracleVerdict(oracle=name, verdict=v) for name, v in zip("abc", verdicts, strict=False)
        ]
        return record_of(a_test("p/msg/A"), "msg", each).verdict

    silent, known = NotJudged("it slept"), KnownDifference(("a-key",), 2)
    assert common() == NotJudged("no oracle that was asked reads .msg files")
    assert common(silent, NotJudged("it left")) == NotJudged("a: it slept; b: it left")
    assert common(silent, Passed(3), Passed(4)) == Passed(7)
    assert common(Passed(3), known, silent) == KnownDifference(("a-key",), 5)
    assert common(Passed(3), known, Failed(("no",))) == Failed(("c: no",))


def test_an_accepting_oracle_without_facts_has_not_judged(court):
    model = court("noetic", ROS1).universe.library.message("p/A")
    for facts in ({}, {"structure": {}}, {"structure": {model.name: {}}, "md5": {}}):
        assert isinstance(verdict(court, model, Accepted(facts)).verdict, NotJudged)


def test_comparisons_are_counted(court):
    model = court("noetic", ROS1).universe.library.message("p/A")
    part = {"fields": [{"name": name} for name in ("name", "codes", "b")]}
    facts = {"structure": {model.name: part}}
    assert assert_passed(verdict(court, model, Accepted(facts))) == 3


@pytest.mark.parametrize("answers", [[], [Refused("no")] * 2, [Refused("no")] * 3])
def test_an_oracle_without_one_answer_per_question_fails(court, answers):
    here = court("noetic", ROS1)
    oracle = FixedOracle()
    oracle.languages, oracle.judges_changes = {"ros1": {"msg"}}, True
    oracle.judge = lambda cases: iter(answers)
    found = judge(here.universe, oracle, here.universe.select(["p/A"])[0])
    why = f"the oracle gave {len(answers)} answers to 1 question"
    assert found.verdict == Failed((why,))


def test_an_invalid_answer_fails(court):
    here = court("noetic", ROS1)
    oracle = FixedOracle()
    oracle.languages, oracle.judges_changes = {"ros1": {"msg"}}, True
    oracle.cpu_seconds = lambda: 0.0
    oracle.judge = lambda cases: [None]
    (case,) = here.universe.select(["p/A"])
    test = Tested(system="ts1", distro="noetic", type="p/A")
    (output,) = judge_case(here.universe, [oracle], case, test).verdicts
    assert isinstance(output.verdict, Failed) and "not None" in output.verdict.failures[0]


def test_a_part_that_we_cannot_compute_is_a_difference(court):
    model = court("lyrical", GOOD).universe.library.message("p/A")
    outcome = compare(FixedOracle(), None, model, Accepted({"md5": {model.name: "0"}}))
    assert "raises ValueError" in outcome.verdict.details[0]


MISTAKES = {
    "a field is dropped": lambda m: replace(m, fields=m.fields[:-1]),
    "two fields are swapped": lambda m: replace(m, fields=m.fields[::-1]),
    "a field has another name": lambda m: _with(m, 0, name="nam"),
    "a text has another bound": lambda m: _with(m, 0, type=String(bound=9)),
    "a text has no bound": lambda m: _with(m, 0, type=String()),
    "a sequence has another bound": lambda m: _with(m, 1, type=Sequence(element=_u16(m), bound=5)),
    "a sequence has a wider element": lambda m: _with(
        m, 1, type=Sequence(element=replace(_u16(m), name="uint32"), bound=4)
    ),
    "another message is meant": lambda m: _with(m, 2, type=replace(m.fields[2].type, name="q/B")),
    "a default is invented": lambda m: _with(m, 0, default="x"),
    "a constant is dropped": lambda m: replace(m, constants=()),
    "a constant has another value": lambda m: replace(
        m, constants=(replace(m.constants[0], value=1),)
    ),
}


def _u16(message) -> Primitive:
    return message.fields[1].type.element


def _with(message, index, **changes):
    fields = list(message.fields)
    fields[index] = replace(fields[index], **changes)
    return replace(message, fields=tuple(fields))


@pytest.mark.parametrize("oracle", ["rosidl_adapter", "rosidl_parser", "rosbags", "genmsg"])
def test_every_mistake_is_caught(court, oracle, monkeypatch):
    is_ros1 = oracle == "genmsg"
    here = court("noetic", ROS1) if is_ros1 else court("lyrical", GOOD)
    case = here.universe.select(["p/A"])[0]
    (answer,) = here.oracle(oracle).judge([case])
    model = here.universe.library.message("p/A")

    def outcome(ours):
        return compare(here.oracle(oracle), case, ours, answer, here.universe)

    assert_passed(outcome(model))
    verdicts = {name: outcome(change(model)).verdict for name, change in MISTAKES.items()}
    missed = {name for name, found in verdicts.items() if not isinstance(found, Failed)}
    if is_ros1:  # This dialect has neither bounds nor defaults.
        assert "a field is dropped" not in missed and "a constant has another value" not in missed
        missed -= {name for name in missed if "bound" in name or "default" in name}
    if oracle == "rosbags":
        missed -= {"a default is invented"}  # rosbags keeps no defaults.
    assert missed == set()


def test_sums_and_hashes_catch_mistakes_by_themselves(court):
    for distro, files, oracle, part in [
        ("noetic", ROS1, "genmsg", "md5"),
        ("lyrical", GOOD, "rosbags", "hash"),
    ]:
        here = court(distro, files)
        facts = here.answer(oracle, "p/A").facts
        model = here.universe.library.message("p/A")
        only = Accepted({part: facts[part]})
        assert_passed(compare(FixedOracle(), None, model, only))
        outcome = compare(FixedOracle(), None, replace(model, fields=()), only)
        assert isinstance(outcome.verdict, Failed)


def _inject(monkeypatch, mistake):
    read = judging.read
    monkeypatch.setattr(judging, "read", lambda universe, case: mistake(read(universe, case)))


WRONG = {
    "lyrical": [
        "int32 Bad\n",
        "int32 a__b\n",
        "int32 a_\n",
        "Bad a\n",
        "int32[0] a\n",
        "int8 A=128\n",
    ],
    "noetic": ["int32 a-b\n", "Bad a\n", "int8 A=128\n", "int8 a\nint8 a\n", "int8[][] a\n"],
}


@pytest.mark.parametrize(
    ("distro", "oracle", "text"),
    [
        (distro, oracle, text)
        for distro, oracle in [("lyrical", "rosidl_adapter"), ("noetic", "genmsg")]
        for text in WRONG[distro]
    ],
)
def test_a_front_end_that_accepts_too_much_is_caught(court, distro, oracle, text, monkeypatch):
    here = court(distro, {"p/msg/A.msg": text, "p/msg/Good.msg": "int8 x\n"})
    outcome = here.outcome(oracle, "p/A")
    assert (outcome.verdict, outcome.is_refused) == (Passed(1), True)
    good = here.universe.library.message("p/Good")
    monkeypatch.setattr(judging, "read", lambda universe, case: good)
    outcome = here.outcome(oracle, "p/A")
    assert isinstance(outcome.verdict, Failed) and "firm-hdl accepts" in outcome.verdict.details[0]


@pytest.mark.parametrize(
    ("distro", "oracle"), [("lyrical", "rosidl_adapter"), ("noetic", "genmsg")]
)
def test_a_front_end_that_accepts_too_little_is_caught(court, distro, oracle, monkeypatch):
    here = court(distro, {"p/msg/A.msg": "int8 x\n"})
    monkeypatch.setattr(judging, "read", lambda universe, case: refusal())
    outcome = here.outcome(oracle, "p/A")
    assert isinstance(outcome.verdict, Failed) and "oracle accepts" in outcome.verdict.details[0]


def test_an_oracle_judges_only_the_languages_that_it_reads(court):
    here = court("lyrical", {"p/srv/S.srv": "---\n"})
    (case,) = here.universe.select(["p/srv/S"])
    assert judge(here.universe, here.oracle("rosbags"), case) is None
