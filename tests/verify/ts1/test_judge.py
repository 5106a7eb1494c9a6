"""Verdicts of TS1: each kind of fault in the front end must be found."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import pytest

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.model import Primitive, Sequence, String
from firm_hdl.verify.results.records import OracleVerdict
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.ts1 import judge as judging
from firm_hdl.verify.ts1.judge import compare, judge, record_of
from firm_hdl.verify.ts1.known import Known
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Oracle, Refused
from tests.verify.judged import assert_passed
from tests.verify.report.samples import a_test

GOOD = {
    "p/msg/A.msg": "int8 LOW=-1\nstring<=8 name\nuint16[<=4] codes\nB b\n",
    "p/msg/B.msg": "float64[3] x\n",
}
ROS1 = {"p/msg/A.msg": "int8 LOW=-1\nstring name\nuint16[] codes\nB b\n", "p/msg/B.msg": "int8 x\n"}


class FixedOracle(Oracle):
    """An oracle with a given answer, which takes the time of a process."""

    name = "genmsg"
    languages: ClassVar = {"ros1": {"msg"}, "ros2": {"msg"}}
    spent = 0.0

    def __init__(self, answer, name="genmsg", seconds=0.0):
        self.answer, self.name, self.seconds = answer, name, seconds

    def missing(self):
        return None

    def judge(self, case):
        FixedOracle.spent += self.seconds
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer

    def cpu_seconds(self):
        return FixedOracle.spent


def outcome(court, ours, answer, files=ROS1):
    here = court("lyrical" if files is GOOD else "noetic", files)
    (case,) = here.universe.select(["p/A"])
    ours = here.universe.interface(case) if ours is None else ours
    return judge(here.universe, FixedOracle(answer), case, ours)


def refusal():
    return DefinitionError([Diagnostic(message="it is wrong")])


ACCEPTED = Accepted(
    {"structure": {"p/A": {"fields": [{"name": n} for n in ("name", "codes", "b")]}}}
)


@pytest.mark.parametrize(
    ("ours", "answer", "verdict"),
    [
        (refusal(), Refused("no"), Passed(1)),
        (None, ACCEPTED, Passed(3)),
        (refusal(), ACCEPTED, "verdict: firm-hdl refuses: it is wrong; oracle accepts"),
        (None, Refused("no"), "verdict: firm-hdl accepts; oracle refuses: no"),
        (RecursionError("deep"), Refused("no"), "verdict: firm-hdl raised RecursionError: deep"),
        (RecursionError("deep"), ACCEPTED, "verdict: firm-hdl raised RecursionError: deep"),
        (refusal(), NotJudged("it slept"), NotJudged("it slept")),
        (None, ValueError("broken"), "the oracle raised ValueError: broken"),
        # An oracle that accepts a definition without any facts has not judged.
        (None, Accepted({}), NotJudged),
        (None, Accepted({"structure": {}}), NotJudged),
        (None, Accepted({"structure": {"p/A": {}}, "md5": {}}), NotJudged),
        # What an oracle must not answer.
        (None, None, Failed),
    ],
)
def test_the_verdict_follows_from_both_readings(court, ours, answer, verdict):
    found = outcome(court, ours, answer)
    expected = Failed((verdict,)) if isinstance(verdict, str) else verdict
    assert (
        isinstance(found.verdict, expected)
        if isinstance(expected, type)
        else (found.verdict == expected)
    )
    assert found.is_refused is (isinstance(answer, Refused) and isinstance(ours, DefinitionError))


def test_one_oracle_that_judges_is_enough_and_none_is_too_few():
    def common(*verdicts):
        each = [
            OracleVerdict(oracle=name, verdict=v) for name, v in zip("abc", verdicts, strict=False)
        ]
        return record_of(a_test("p/msg/A"), "msg", each)

    silent, known = NotJudged("it slept"), KnownDifference(("a-key",), 2)
    assert common().verdict == NotJudged("no oracle that was asked reads .msg files")
    assert common(silent, NotJudged("it left")).verdict == NotJudged("a: it slept; b: it left")
    assert common(silent, Passed(3), Passed(4)).verdict == Passed(7)
    assert common(Passed(3), known, silent).verdict == KnownDifference(("a-key",), 5)
    assert common(Passed(3), known).note == "known difference from b: a-key"
    assert common(Passed(3), known, Failed(("no",))).verdict == Failed(("c: no",))


def test_a_part_that_we_cannot_compute_is_a_difference(court):
    found = outcome(court, None, Accepted({"md5": {"p/msg/A": "0"}}), GOOD)
    assert isinstance(found.verdict, Failed) and "raises ValueError" in found.verdict.failures[0]


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
def test_every_mistake_is_caught(court, oracle):
    is_ros1 = oracle == "genmsg"
    here = court("noetic", ROS1) if is_ros1 else court("lyrical", GOOD)
    (case,) = here.universe.select(["p/A"])
    answer, model = here.answer(oracle, "p/A"), here.universe.library.message("p/A")

    def verdict(ours):
        return compare(here.universe, here.oracle(oracle), case, ours, answer)

    assert_passed(verdict(model))
    verdicts = {name: verdict(change(model)) for name, change in MISTAKES.items()}
    missed = {name for name, found in verdicts.items() if not isinstance(found, Failed)}
    if is_ros1:  # This dialect has neither bounds nor defaults.
        assert "a field is dropped" not in missed and "a constant has another value" not in missed
        missed -= {name for name in missed if "bound" in name or "default" in name}
    if oracle == "rosbags":
        missed -= {"a default is invented"}  # rosbags keeps no defaults.
    assert missed == set()


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
    found = here.outcome(oracle, "p/A")
    assert (found.verdict, found.is_refused) == (Passed(1), True)
    good = here.universe.library.message("p/Good")
    monkeypatch.setattr(judging, "read", lambda universe, case: good)
    found = here.outcome(oracle, "p/A")
    assert isinstance(found.verdict, Failed) and "firm-hdl accepts" in found.verdict.details[0]


def test_each_mistake_that_we_find_has_to_be_known(court, monkeypatch):
    source = Source(name="a.msg", text="odd")
    known = Diagnostic(message="odd", span=Span(source=source, start=0, end=3))
    rule = Known(key="odd", oracles="genmsg", why="it is", ours=("odd", "odd"))
    monkeypatch.setattr("firm_hdl.verify.ts1.judge.KNOWN", (rule,))
    for second, kind in ((known, KnownDifference), (Diagnostic(message="it is wrong"), Failed)):
        found = outcome(court, DefinitionError([known, second]), ACCEPTED)
        assert isinstance(found.verdict, kind)
