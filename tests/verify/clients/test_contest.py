"""Contests of test libraries: counts, differences and verdicts."""

from __future__ import annotations

import pytest

from firm_hdl.verify.clients.divergences import Finding, KnownDivergence
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
)
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from tests.verify.clients.twins import compared


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


VALUES = [{"a": 1}, {"a": 7}, {"a": 200}]


def contest(message, codec, right=None, values=VALUES):
    library, reference = CodecClient("mine", codec), CodecClient("right", right or Bytes())
    return compared(library, reference, message, values)


def test_refusals_of_the_reference_are_compared_but_are_no_answers(message):
    # Both refuse one of the values, so no packet of it is decoded.
    two = contest(message, Bytes(), Bytes(most=100), VALUES[:2])
    three = contest(message, Bytes(most=100), Bytes(most=100))
    assert three.verdict == Passed(two.verdict.cases + 1)
    none = contest(message, Bytes(most=0), Bytes(most=0))
    assert none.record.cases == len(VALUES)
    assert none.verdict == NotJudged("right had no answer to anything")


def test_each_value_is_written_and_read(message):
    trial = contest(message, Bytes())
    cases = trial.record.cases
    assert cases > 2 * len(VALUES) and trial.verdict == Passed(cases)
    more = contest(message, Bytes(), values=[*VALUES, {"a": 3}])
    assert more.record.cases == cases + 2


def test_the_first_difference_of_each_kind_is_shown(message):
    failures = contest(message, Wrong()).failures
    lines = ["decode differs from right", "uint8 a", "value: a: 7", "packet: 0001000007"]
    assert "\n".join([*lines, "right: a: 7", "mine: a: 8"]) in failures
    assert len({text.partition("\n")[0] for text in failures}) == len(failures) > 1


def test_a_codec_that_cannot_be_opened_is_not_judged_or_fails(message):
    for error, reason in (
        (UnsupportedError("no such type"), "no such type"),
        (UnsupportedError(), "the type is not supported"),
    ):
        assert contest(message, error).verdict == NotJudged(reason)
    assert contest(message, ClientDiedError("it died")).verdict == Failed(("it died",))
    for ours, theirs, name in ((("ros1",), None, "mine"), (None, ("ros1",), "right")):
        both = CodecClient("mine", Bytes(), ours), CodecClient("right", Bytes(), theirs)
        found = compared(*both, message, VALUES)
        assert found.verdict == NotJudged(f"{name} does not speak cdr")


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
