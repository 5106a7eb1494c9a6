"""Each condition for a known difference, an irregular packet, or an accepted answer."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.cases.values import as_float, bits_of, is_nan
from firm_hdl.model import PRIMITIVES, Field, Message, String
from firm_hdl.verify.clients.divergences import KNOWN
from firm_hdl.verify.clients.finding import Finding, KnownDivergence
from firm_hdl.verify.clients.known import known_keys
from firm_hdl.verify.references.client import Codec, Refusal

UINT8 = PRIMITIVES["ros2"]["uint8"]
REFUSED = Refusal("no")


def a_message(*kinds, dialect="ros2", name="p/msg/A"):
    fields = tuple(Field(name=f"f{n}", type=kind) for n, kind in enumerate(kinds))
    return Message(name=name, dialect=dialect, fields=fields)


def a_finding(what="decode", expected=None, got=None, **more):
    known = {
        "library": "mine", "reference": "right", "wire": "cdr", "what": what,
        "message": a_message(UINT8), "value": {"f0": 1}, "packet": b"", "expected": expected,
        "got": got,
    }  # fmt: skip
    return Finding(**{**known, **more})


class RuleCodec(Codec):
    """A codec whose packets follow a rule, and that refuses to decode."""

    def __init__(self, rule):
        self.rule = rule

    def encode(self, value):
        answer = self.rule(value)
        if isinstance(answer, Refusal):
            raise answer
        return answer

    def decode(self, packet):
        raise REFUSED


# Known divergences.

ENTRY = KnownDivergence(
    key="k", libraries=("mine",), wires="cdr", text="", case_names=("bool-2",), answer="takes"
)


@pytest.mark.parametrize(
    ("answer", "mine", "other", "explains"),
    [
        ("takes", {"f0": 1}, REFUSED, True),
        ("takes", REFUSED, {"f0": 1}, False),
        ("takes", {"f0": 1}, {"f0": 2}, False),
        ("takes", REFUSED, REFUSED, False),
        ("refuses", REFUSED, {"f0": 1}, True),
        ("refuses", {"f0": 1}, REFUSED, False),
        ("refuses", REFUSED, REFUSED, False),
        ("refuses", {"f0": 1}, {"f0": 2}, False),
        (None, {"f0": 1}, {"f0": 2}, True),
        (None, REFUSED, {"f0": 1}, False),
        (None, {"f0": 1}, REFUSED, False),
    ],
)
def test_an_answer_is_explained_by_who_gives_it(answer, mine, other, explains):
    entry = replace(ENTRY, answer=answer)
    assert entry.explains_answer(a_finding("bool-2", got=mine, expected=other)) is explains
    # Swapped, if the entry is about the reference.
    swapped = a_finding("bool-2", got=other, expected=mine, library="x", reference="mine")
    assert entry.explains_answer(swapped) is explains
    for change in ({"wire": "ros1"}, {"library": "x"}, {"what": "bool-22"}, {"what": "bool"},
                   {"what": "encode bool-2"}, {"what": "decode"}):  # fmt: skip
        finding = a_finding(**{"what": "bool-2", "got": mine, "expected": other, **change})
        assert not entry.explains_answer(finding), change


def without_highest_bit(kind, value):
    return value & 0x7F if isinstance(value, int) else value


@pytest.fixture
def one_entry(monkeypatch):
    """A single known divergence: the highest bit of numbers."""
    entry = KnownDivergence(
        key="k",
        libraries=("mine",),
        wires="cdr",
        text="",
        take_out=without_highest_bit,
        same=without_highest_bit,
    )
    monkeypatch.setattr("firm_hdl.verify.clients.known.KNOWN", (entry,))
    return entry


@pytest.mark.usefixtures("one_entry")
@pytest.mark.parametrize(
    ("expected", "got", "keys"),
    [
        ({"f0": 0x81}, {"f0": 0x01}, ["k"]),
        ({"f0": 0x01}, {"f0": 0x81}, ["k"]),
        ({"f0": 0x81}, {"f0": 0x02}, []),
        ({"f0": 0x01}, {"f0": 0x02}, []),
        (REFUSED, {"f0": 0x81}, []),
        ({"f0": 0x81}, REFUSED, []),
    ],
)
def test_a_decode_difference_is_known_if_nothing_else_differs(expected, got, keys):
    finding = a_finding(expected=expected, got=got)
    assert list(known_keys(finding, RuleCodec(bytes), RuleCodec(bytes))) == keys
    other = a_finding(expected=expected, got=got, wire="ros1")
    assert list(known_keys(other, RuleCodec(bytes), RuleCodec(bytes))) == []


def byte(value):
    return bytes([value["f0"]])


@pytest.mark.usefixtures("one_entry")
@pytest.mark.parametrize(
    ("value", "theirs", "keys"),
    [
        # Without the highest bit, both write the same.
        ({"f0": 0x81}, lambda v: byte({"f0": v["f0"] & 0x7F}), ["k"]),
        # The packets differ in another bit, too.
        ({"f0": 0x81}, lambda v: byte({"f0": v["f0"] ^ 1}), []),
        # The value does not have the highest bit.
        ({"f0": 0x01}, lambda v: byte({"f0": v["f0"] ^ 1}), []),
        ({"f0": 0x01}, byte, []),
        # Both refuse every value.
        ({"f0": 0x81}, lambda v: REFUSED, []),
    ],
)
def test_an_encode_difference_is_known_if_nothing_else_differs(value, theirs, keys):
    finding = a_finding("encode", expected=b"x", got=b"y", value=value)
    assert list(known_keys(finding, RuleCodec(theirs), RuleCodec(byte))) == keys


def entry_of(key):
    return next(entry for entry in KNOWN if entry.key == key)


ROS1, ROS2 = PRIMITIVES["ros1"], PRIMITIVES["ros2"]
TIME = Message(name="time", dialect="ros1", fields=())
DURATION = Message(name="duration", dialect="ros1", fields=())


@pytest.mark.parametrize(
    ("key", "how", "kind", "value", "want"),
    [
        ("python-signalling-nan", "same", ROS2["float32"], 0x7F800001, 0x7FC00001),
        ("python-signalling-nan", "same", ROS2["float32"], 0xFF812345, 0xFFC12345),
        ("python-signalling-nan", "same", ROS2["float32"], 0x7F800000, 0x7F800000),
        ("python-signalling-nan", "same", ROS2["float32"], 0x3F800000, 0x3F800000),
        ("python-signalling-nan", "same", ROS2["float64"], 0x7FF0000000000001, 0x7FF0000000000001),
        ("python-signalling-nan", "take_out", ROS2["uint32"], 0x7F800001, 0x7F800001),
        ("rosbags-byte-signed", "take_out", ROS2["byte"], 0xFE, 0x7E),
        ("rosbags-byte-signed", "same", ROS2["byte"], -2, 0xFE),
        ("rosbags-byte-signed", "take_out", ROS2["uint8"], 0xFE, 0xFE),
        ("rosbags-byte-signed", "take_out", ROS2["char"], 0xFE, 0xFE),
        ("rosbags-byte-signed", "take_out", ROS1["byte"], -2, -2),
        ("mcap-ros2-char-signed", "same", ROS2["char"], -56, 200),
        ("mcap-ros2-char-signed", "same", ROS2["byte"], 200, 200),
        ("rosbags-time-signs", "same", TIME, {"secs": -1, "nsecs": 5},
         {"secs": 0xFFFFFFFF, "nsecs": 5}),
        ("rosbags-time-signs", "same", DURATION, {"secs": -1, "nsecs": 0xFFFFFFFF},
         {"secs": -1, "nsecs": -1}),
        ("rosbags-time-signs", "take_out", TIME, {"secs": 1 << 31, "nsecs": 5},
         {"secs": 0, "nsecs": 5}),
        ("rosbags-time-signs", "take_out", DURATION, {"secs": 3, "nsecs": -1},
         {"secs": 3, "nsecs": 0x7FFFFFFF}),
        ("fastcdr-cut-at-nul", "take_out", String(), b"ab\0c\0", b"ab"),
        ("fastcdr-cut-at-nul", "take_out", String(), b"ab", b"ab"),
        ("fastcdr-cut-at-nul", "take_out", String(wide=True), [1, 2, 0, 3, 0], [1, 2]),
        ("fastcdr-cut-at-nul", "take_out", String(wide=True), [1, 2], [1, 2]),
        ("genpy-time-normalized", "same", TIME, {"secs": 1, "nsecs": 2_500_000_000},
         {"secs": 3, "nsecs": 500_000_000}),
        ("genpy-time-normalized", "same", TIME, {"secs": 1, "nsecs": 999_999_999},
         {"secs": 1, "nsecs": 999_999_999}),
        ("genpy-time-normalized", "same", TIME, {"secs": 0xFFFFFFFF, "nsecs": 1_000_000_000},
         {"secs": 0, "nsecs": 0}),
        ("genpy-time-normalized", "same", DURATION, {"secs": -1, "nsecs": -1},
         {"secs": -2, "nsecs": 999_999_999}),
        ("genpy-not-utf8", "same", String(), b"a\xffb", "a\N{REPLACEMENT CHARACTER}b".encode()),
        ("genpy-not-utf8", "same", String(), "é".encode(), "é".encode()),
    ],
)  # fmt: skip
def test_a_change_removes_the_difference_of_its_entry(key, how, kind, value, want):
    assert getattr(entry_of(key), how)(kind, value) == want


@pytest.mark.parametrize(
    ("bits", "size", "nan"),
    [
        (0x7F800000, 4, False), (0xFF800000, 4, False), (0x7F800001, 4, True),
        (0x7FC00000, 4, True), (0xFFFFFFFF, 4, True), (0x7F7FFFFF, 4, False), (0, 4, False),
        # 1.5 and -1.5: of the exponent, only the highest bit is 0.
        (0x3FC00000, 4, False), (0xBFC00000, 4, False), (0x3FF8000000000000, 8, False),
        (0x7FF0000000000000, 8, False), (0x7FF0000000000001, 8, True),
        (0xFFF8000000000000, 8, True), (0x7FEFFFFFFFFFFFFF, 8, False),
    ],
)  # fmt: skip
def test_nan_is_that_of_ieee_754(bits, size, nan):
    assert is_nan(bits, size) is nan
    number = as_float(bits, size)
    assert (number != number) is nan
    if not nan:
        assert bits_of(number, size) == bits


# Irregular packets.
