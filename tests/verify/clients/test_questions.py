"""Which questions a contest asks both libraries, and whose answers count."""

from __future__ import annotations

import pytest

from firm_hdl.verify.clients.finding import KnownDivergence
from firm_hdl.verify.references.client import Codec, Refusal
from tests.verify.clients.test_contest import VALUES, Bytes, Wrong, contest


class Recorder(Codec):
    """Notes what it is asked; writes a text and its length, and reads nothing."""

    def __init__(self, refused=None):
        self.refused, self.written, self.read = refused, [], []

    def encode(self, value):
        self.written.append(value)
        if value == self.refused:
            raise Refusal("no text")
        return b"\0\1\0\0" + (len(value["s"]) + 1).to_bytes(4, "little") + value["s"] + b"\0"

    def decode(self, packet):
        self.read.append(packet)
        raise Refusal("no packet")


@pytest.fixture
def message(make_message):
    return make_message("uint8 a\n")


@pytest.fixture
def text(make_message):
    return make_message("string<=2 s\n")


def test_unusual_values_are_written_by_both_even_if_the_usual_one_is_refused(text):
    value = {"s": b"z"}
    library, reference = Recorder(), Recorder(refused=value)
    trial = contest(library, reference).judge(text, [value])
    # The reference was asked for the packet first.
    unusual = [{"s": each} for each in (b"a\0b", b"\xc3(", b"zxx")]
    assert library.written == [value, *unusual]
    assert reference.written == [value, *library.written]
    # Of a value without a packet, no packet is read.
    assert library.read == reference.read == []
    assert (trial.comparisons, trial.answers, trial.unknown) == (4, 3, 1)


def test_an_empty_packet_is_read_and_not_written(text):
    value = {"s": b"z"}
    library, reference = Recorder(), Recorder()
    trial = contest(library, reference).judge(text, [value])
    assert library.read == reference.read
    assert library.read[0] == b"\0\1\0\0\2\0\0\0z\0" and b"" in library.read
    assert len(library.written) == 4
    assert trial.comparisons == len(library.written) + len(library.read)


def test_the_answers_of_the_reference_count(message):
    both = contest(Bytes()).judge(message, VALUES)
    refusing = contest(Bytes(most=0)).judge(message, VALUES)
    assert refusing.answers == both.answers >= 2 * len(VALUES)
    assert refusing.comparisons == both.comparisons
    # Each answer of the reference is a difference: the library refuses everything.
    assert refusing.unknown == both.answers


class WritesMore(Bytes):
    def encode(self, value):
        return super().encode({"a": value["a"] + 1})


def test_a_case_without_a_place_is_not_asked_about(message, text):
    made = contest(WritesMore())
    assert made.again(message, "encode", {"a": 1}).got == b"\0\1\0\0\2"
    assert made.again(message, "encode nul-inside", {"a": 1}) is None
    library, reference = Recorder(refused={"s": b"a\0b"}), Recorder()
    found = contest(library, reference).again(text, "encode nul-inside", {"s": b"z"})
    assert (found.what, found.value) == ("encode nul-inside", {"s": b"a\0b"})
    assert (found.got, found.expected[-4:]) == (Refusal("no text"), b"a\0b\0")
    assert library.written == reference.written == [{"s": b"a\0b"}]


def test_a_known_difference_is_named_and_is_none_that_is_asked_again(message, monkeypatch):
    made = contest(Wrong())
    finding, keys = made.ask(message, "decode", {"a": 9})
    assert (finding.got, list(keys)) == ({"a": 10}, [])
    assert made.again(message, "decode", {"a": 9}) == finding
    known = KnownDivergence(
        key="k", libraries=("mine",), wires="cdr", text="", case_names=("decode",)
    )
    monkeypatch.setattr("firm_hdl.verify.clients.known.KNOWN", (known,))
    assert made.ask(message, "decode", {"a": 9}) == (finding, ["k"])
    assert made.again(message, "decode", {"a": 9}) is None
    trial = made.judge(message, [{"a": 9}])
    # A difference in an unusual packet is another one.
    assert trial.known == {"k": 1} and trial.unknown == 1
    assert [each.what for each in trial.findings] == ["options"]
