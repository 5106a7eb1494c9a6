"""Contests of test libraries: counts, differences and verdicts."""

from __future__ import annotations

import pytest

from firm_hdl.verify.clients.divergences import Finding, KnownDivergence
from firm_hdl.verify.clients.judge import LibraryComparison
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
)
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed


class Bytes(Codec):
    """A codec for messages of one byte: a header and the byte."""

    def __init__(self, most=255):
        self.most = most

    def encode(self, value):
        if value["a"] > self.most:
            raise Refusal("too large")
        return b"\0\1\0\0" + bytes([value["a"]])

    def decode(self, packet):
        if len(packet) != 5 or packet[4] > self.most:
            raise Refusal("no packet")
        return {"a": packet[4]}


class Wrong(Bytes):
    def decode(self, packet):
        found = super().decode(packet)
        return {"a": found["a"] + 1} if found["a"] > 2 else found


class CodecClient(Client):
    wires = frozenset({"cdr"})

    def __init__(self, name, codec, wires=None):
        self.name, self.codec = name, codec
        self.wires = self.wires if wires is None else frozenset(wires)

    def missing(self):
        return None

    def version(self):
        return "0"

    def open(self, message, wire):
        if isinstance(self.codec, Exception):
            raise self.codec
        return self.codec


@pytest.fixture
def message(make_message):
    return make_message("uint8 a\n")


def contest(codec, right=None):
    return LibraryComparison(
        CodecClient("mine", codec), CodecClient("right", right or Bytes()), "cdr"
    )


VALUES = [{"a": 1}, {"a": 7}, {"a": 200}]


def test_refusals_of_the_reference_are_compared_but_are_no_answers(message):
    # Both refuse one of the values, so no packet of it is decoded.
    trial = contest(Bytes(), Bytes(most=100)).judge(message, VALUES[:2])
    assert (trial.findings, trial.unknown) == ([], 0)
    all_answers = trial.answers
    trial = contest(Bytes(most=100), Bytes(most=100)).judge(message, VALUES)
    assert trial.unknown == 0
    # The library refused to encode the third value.
    assert trial.answers == all_answers
    none = contest(Bytes(most=0), Bytes(most=0)).judge(message, VALUES)
    assert none.answers == 0 and none.comparisons == len(VALUES)
    assert none.verdict == NotJudged("right had no answer to anything")


def test_each_value_is_written_and_read(message):
    trial = contest(Bytes()).judge(message, VALUES)
    assert 2 * len(VALUES) <= trial.answers < trial.comparisons
    assert trial.verdict == Passed(trial.comparisons)
    assert (trial.library, trial.reference, trial.type) == ("mine", "right", "p/msg/A")
    more = contest(Bytes()).judge(message, [*VALUES, {"a": 3}])
    assert more.answers == trial.answers + 2


def test_every_difference_is_counted_and_the_first_of_each_kind_kept(message):
    trial = contest(Wrong()).judge(message, VALUES)
    assert trial.unknown >= 2
    (finding,) = (each for each in trial.findings if each.what == "decode")
    assert (finding.value, finding.packet) == ({"a": 7}, b"\0\1\0\0\7")
    assert (finding.expected, finding.got) == ({"a": 7}, {"a": 8})
    assert (finding.library, finding.reference, finding.wire) == ("mine", "right", "cdr")
    assert len({each.what for each in trial.findings}) == len(trial.findings)
    lines = ["decode differs from right", "uint8 a", "value: a: 7", "packet: 0001000007"]
    assert "\n".join([*lines, "right: a: 7", "mine: a: 8"]) in trial.verdict.failures


def test_a_codec_that_cannot_be_opened_is_not_judged_or_fails(message):
    unsupported = contest(UnsupportedError("no such type"))
    assert unsupported.judge(message, VALUES).verdict == NotJudged("no such type")
    assert unsupported.ask(message, "encode", VALUES[0]) is None
    assert contest(UnsupportedError()).judge(message, VALUES).verdict == NotJudged(
        "the type is not supported"
    )
    died = contest(ClientDiedError("it died")).judge(message, VALUES)
    assert died.verdict == Failed(("it died",))
    for ours, theirs, name in ((("ros1",), None, "mine"), (None, ("ros1",), "right")):
        both = LibraryComparison(
            CodecClient("mine", Bytes(), ours), CodecClient("right", Bytes(), theirs), "cdr"
        )
        assert both.judge(message, VALUES).verdict == NotJudged(f"{name} does not speak cdr")


def finding_of(message, **more):
    known = {
        "library": "mine",
        "reference": "right",
        "wire": "cdr",
        "what": "odd",
        "message": message,
        "value": {"a": 1},
        "packet": b"",
        "expected": 1,
        "got": 2,
    }
    return Finding(**{**known, **more})


NO = Refusal("no")


@pytest.mark.parametrize("answer", ["takes", "refuses", None])
@pytest.mark.parametrize("is_mine", [True, False])
def test_a_known_difference_explains_its_own_answer_alone(message, answer, is_mine):
    entry = KnownDivergence(
        key="k",
        libraries=("mine",) if is_mine else ("right",),
        wires="cdr",
        text="",
        case_names=("odd", "other"),
        answer=answer,
    )
    explained = {
        (own, other)
        for own in (1, NO)
        for other in (2, NO)
        if entry.explains_answer(
            finding_of(message, got=own, expected=other)
            if is_mine
            else finding_of(message, got=other, expected=own)
        )
    }
    assert explained == {{"takes": (1, NO), "refuses": (NO, 2), None: (1, 2)}[answer]}
