"""Contests of test libraries: counts, differences and verdicts."""

from __future__ import annotations

from collections import Counter

import pytest

from firm_hdl.verify.clients.finding import Finding, KnownDivergence
from firm_hdl.verify.clients.judge import LibraryComparison, LibraryResult
from firm_hdl.verify.clients.unusual import unusual_packets
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
)
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed


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
    assert "decode differs from right" in trial.verdict.failures


class Otherwise(Bytes):
    """Writes one value otherwise than our own writer."""

    def encode(self, value):
        return b"\0\1\0\0\x08" if value == {"a": 7} else super().encode(value)


class Lenient(Bytes):
    """Ignores what follows, and notes what it reads."""

    def __init__(self):
        super().__init__()
        self.packets = []

    def decode(self, packet):
        self.packets.append(packet)
        return super().decode(packet[:5])


def test_unusual_packets_are_made_of_values_that_the_reference_writes_as_we_do(message):
    library = Lenient()
    made = contest(library, Otherwise())
    made.judge(message, [{"a": 7}, {"a": 1}])
    plain = [b"\0\1\0\0\x08", b"\0\1\0\0\1"]
    unusual = [packet for _, _, packet in unusual_packets(message, "cdr", [{"a": 1}])]
    # Neither library reads big-endian packets.
    unusual.remove(b"\0\0\0\0\1")
    assert library.packets == plain + unusual and len(unusual) > 5
    # The same holds for one question.
    found = made.again(message, "trailing-4", {"a": 1})
    assert (found.what, found.packet) == ("trailing-4", plain[1] + bytes(4))
    assert (found.expected, found.got) == (Refusal("no packet"), {"a": 1})
    assert made.again(message, "trailing-4", {"a": 7}) is None
    assert contest(Lenient(), Bytes()).again(message, "trailing-4", {"a": 7}) is not None
    # A usual packet is that of the reference, however it writes the value.
    assert made.ask(message, "decode", {"a": 7}) is None
    assert library.packets[-1] == plain[0]


def test_a_codec_that_cannot_be_opened_is_not_judged_or_fails(message):
    unsupported = contest(UnsupportedError("no such type"))
    assert unsupported.judge(message, VALUES).verdict == NotJudged("no such type")
    assert unsupported.again(message, "encode", VALUES[0]) is None
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


def trial(**more):
    return LibraryResult(library="mine", reference="right", type="p/A", **more)


def test_verdicts_of_trials():
    assert trial(comparisons=3, answers=1).verdict == Passed(3)
    known = trial(comparisons=3, answers=1, known=Counter({"b": 1, "a": 2}))
    assert known.verdict == KnownDifference(("a", "b"), 3)
    assert trial(answers=1, unknown=2).verdict == Failed(("2 differences",))
    obstacle = NotJudged("x")
    assert trial(answers=1, obstacle=obstacle).verdict == obstacle
    # A difference found before the library failed counts.
    assert trial(unknown=1, obstacle=obstacle).verdict == Failed(("1 differences",))
    assert LibraryResult(library="x", reference="", type="y").verdict == NotJudged(
        "the reference had no answer to anything"
    )


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


def test_a_known_difference_is_about_its_libraries_wires_and_oddities(message):
    entry = KnownDivergence(
        key="k", libraries=("mine", "yours"), wires="cdr", text="", case_names=("odd",)
    )
    assert entry.is_about(finding_of(message)) == "mine"
    assert entry.is_about(finding_of(message, library="x", reference="yours")) == "yours"
    assert entry.is_about(finding_of(message, library="x")) is None
    assert entry.is_about(finding_of(message, wire="ros1")) is None
    both = KnownDivergence(
        key="k", libraries=("mine",), wires="ros1 cdr", text="", case_names=("odd",)
    )
    assert both.is_about(finding_of(message, wire="ros1")) == "mine"
    assert entry.explains_answer(finding_of(message))
    assert not entry.explains_answer(finding_of(message, what="other"))
    assert not entry.explains_answer(finding_of(message, library="x"))
