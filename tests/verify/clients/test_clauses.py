"""Each condition for a known difference, an irregular packet, or an accepted answer."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest

from firm_hdl.cases.values import as_float, bits_of, changed, is_nan
from firm_hdl.model import PRIMITIVES, Array, Field, Message, Sequence, String
from firm_hdl.verify.clients.divergences import KNOWN
from firm_hdl.verify.clients.finding import Finding, KnownDivergence
from firm_hdl.verify.clients.known import known_keys
from firm_hdl.verify.clients.unusual import (
    plain_packet,
    unusual_packet,
    unusual_value,
    unusual_values,
)
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


@pytest.mark.usefixtures("one_entry")
def test_both_refusing_the_plain_value_explains_nothing():
    finding = a_finding("encode", expected=b"x", got=b"y", value={"f0": 0x81})
    refuses = RuleCodec(lambda value: REFUSED)
    assert list(known_keys(finding, refuses, refuses)) == []


def test_changes_reach_every_number_and_text():
    inner = a_message(UINT8, String(), name="p/msg/B")
    time = Message(name="time", dialect="ros1", fields=a_message(UINT8).fields)
    message = a_message(
        UINT8, inner, Array(element=inner, count=2), Sequence(element=UINT8),
        Sequence(element=String()), UINT8, time,
    )  # fmt: skip
    b = {"f0": 1, "f1": b"x"}
    value = {
        "f0": 1, "f1": b, "f2": [b, b], "f3": [1, 1], "f4": [b"x"], "f5": 1, "f6": {"f0": 1}
    }  # fmt: skip
    seen = []

    def record(kind, item):
        seen.append(str(kind))
        if isinstance(item, int | bytes):
            return item * 2
        return {"f0": 9} if kind is time else item

    twice = {"f0": 2, "f1": b"xx"}
    assert changed(message, value, record) == {
        "f0": 2, "f1": twice, "f2": [twice] * 2, "f3": [2, 2], "f4": [b"xx"], "f5": 2,
        # A message is changed before its fields.
        "f6": {"f0": 18},
    }  # fmt: skip
    wholes = {"p/msg/A": 1, "p/msg/B": 3, "p/msg/B[2]": 1, "uint8[]": 1, "string[]": 1, "time": 1}
    assert Counter(seen) == {"uint8": 8, "string": 4, **wholes}
    assert value["f1"] == b


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

ODD_TEXT = (
    "uint8 a\nuint32 n\nstring<=3 s\nstring e\nbool t\nbool u\nuint8[<=2] l\nuint16[<=2] m\n"
    "string z"
)
ODD_VALUE = {
    "a": 1, "n": 2, "s": b"xy", "e": b"", "t": True, "u": True, "l": [5], "m": [6], "z": b"q"
}  # fmt: skip
PLAIN = (
    "00010000 01000000 02000000 03000000 787900 00 01000000 00 01 01 00 01000000 05 000000 "
    "01000000 0600 0000 02000000 7100"
)
ODD = {
    "bare-string": PLAIN.replace("787900 00 01000000 00 01 01 00", "787900 00 00000000 01 01 0000"),
    "no-nul": PLAIN.replace("03000000 787900 00", "02000000 6162 0000"),
    "bool-2": PLAIN.replace("01000000 00 01 01", "01000000 00 02 01"),
    "options": PLAIN.replace("00010000", "00010003"),
    "dirty-padding": PLAIN.replace("00010000 01000000", "00010000 01ffffff"),
    "pad-1": PLAIN + "00",
    "pad-2": PLAIN + "0000",
    "pad-3": PLAIN + "000000",
    "trailing-4": PLAIN + "00000000",
    "cut-1": PLAIN[:-2],
    "cut-all": "",
    "cut-header": "0001",
    "bound-items": PLAIN.replace("01000000 05 000000 0100", "03000000 050000 00 0100"),
    "long-text": PLAIN.replace("03000000 7879", "70110100 7879"),
    "long-items": PLAIN.replace("01000000 05 00", "70110100 05 00"),
    "not-utf8": PLAIN.replace("03000000 787900 00", "03000000 c32800 00"),
}


@pytest.mark.parametrize("name", ODD)
def test_an_irregular_packet_is_changed_at_its_first_place_only(make_message, name):
    message = make_message(ODD_TEXT)
    assert plain_packet(message, "cdr", ODD_VALUE) == bytes.fromhex(PLAIN)
    packet = unusual_packet(message, "cdr", ODD_VALUE, name)
    assert packet == bytes.fromhex(ODD[name]), packet.hex()


def test_alignment_counts_from_the_end_of_the_header(make_message):
    message = make_message("uint8 a\nuint64 b\nuint8 c\nuint16 d")
    value = {"a": 1, "b": 2, "c": 3, "d": 4}
    want = "00010000 01 00000000000000 0200000000000000 03 00 0400"
    assert plain_packet(message, "cdr", value) == bytes.fromhex(want)
    assert plain_packet(message, "ros1", value) == bytes.fromhex("01 0200000000000000 03 0400")


def test_half_a_packet_is_its_first_half(make_message):
    message = make_message("uint8[6] a")
    value = {"a": [1, 2, 3, 4, 5, 6]}
    packet = plain_packet(message, "cdr", value)
    assert unusual_packet(message, "cdr", value, "cut-half") == packet[:5]
    assert plain_packet(message, "ros1", value) == packet[4:]


def test_bounds_are_exceeded_by_one_and_one_thing_at_a_time(make_message):
    message = make_message("string<=3 s\nuint8[<=2] l\nwstring<=2 w\nB[<=1] b", B="string<=3 s")
    value = {"s": b"xy", "l": [5], "w": [1], "b": []}
    found = dict(unusual_values(message, [value]))
    assert len(found["bound-text"]["s"]) == 4 and found["bound-text"]["s"].startswith(b"xy")
    assert {k: v for k, v in found["bound-text"].items() if k != "s"} == {
        k: v for k, v in value.items() if k != "s"
    }
    assert found["bound-items"]["l"] == [5, 0, 0] and found["bound-items"]["b"] == []
    assert found["nul-inside"]["s"].count(0) == 1
    with pytest.raises(UnicodeDecodeError):
        found["not-utf8"]["s"].decode()
    assert unusual_value(make_message("uint8 a"), {"a": 1}, "bound-items") is None
