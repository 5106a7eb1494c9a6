"""Faults of deliberately broken libraries are found and shown."""

from __future__ import annotations

import pytest

from firm_hdl.cases.values import shown
from firm_hdl.verify.clients.unusual import UNUSUAL_CASES, unusual_packets
from firm_hdl.verify.references.client import Refusal
from firm_hdl.verify.results.verdict import NotJudged
from tests.verify.clients.twins import Same, Twin, compared
from tests.verify.judged import assert_known, assert_passed

TEXT = "uint8 a\nfloat64 b\nuint16 c\nuint16 d\nstring s\nB[] list\nbool t\n"
NESTED = "int8 x\nint64 y\n"
VALUES = [
    {"a": 1, "b": 2, "c": 3, "d": 4, "s": b"ab", "list": [{"x": 1, "y": 2}], "t": True},
    {"a": 0, "b": 0, "c": 7, "d": 7, "s": b"", "list": [], "t": False},
]


class WithoutPadding(Same):
    """Leaves out all padding, so packets with padding are too short."""

    def encode(self, value):
        packet = super().encode(value)
        return packet.replace(b"\1\0\0\0\0\0\0\0\2", b"\1\2")


class SwappedFields(Same):
    """Decodes two neighbouring fields in the wrong order."""

    def decode(self, packet):
        value = super().decode(packet)
        if "c" in value and "d" in value:
            value["c"], value["d"] = value["d"], value["c"]
        return value


class AcceptsTruncated(Same):
    """Accepts a truncated packet."""

    def decode(self, packet):
        try:
            return super().decode(packet)
        except Refusal:
            return super().decode(packet + b"\0" * (-len(packet) % 4 or 1))


@pytest.fixture
def contest(library_here):
    """Compare a broken library with rosbags, which is correct."""
    right = library_here("rosbags")
    return lambda fault, message: compared(Twin(right, fault), right, message, VALUES)


@pytest.fixture
def message(make_message):
    return make_message(TEXT, B=NESTED)


def test_equal_libraries_have_no_differences(contest, message):
    trial = contest(Same, message)
    assert assert_passed(trial) == trial.record.cases > 30


@pytest.mark.parametrize(
    ("fault", "what"),
    [(WithoutPadding, "encode"), (SwappedFields, "decode"), (AcceptsTruncated, "cut-1")],
)
def test_faults_are_found_and_shown_with_a_small_value(contest, message, fault, what):
    trial = contest(fault, message)
    (text,) = (text for text in trial.failures if text.startswith(f"{what} differs from rosbags"))
    # Only the value that is not the smallest shows that two fields are swapped.
    value = VALUES[0 if fault in (SwappedFields, WithoutPadding) else 1]
    assert f"\nvalue: {shown(message, value)}\n" in text


def test_a_type_that_a_library_lacks_is_not_judged(library_here, make_message):
    both = library_here("cyclonedds"), library_here("rosbags")
    trial = compared(*both, make_message("wstring w\n"), [])
    assert trial.verdict == NotJudged("cyclonedds has no wstring")
    wide = compared(*both, make_message("uint8[<=65536] w\n"), [])
    assert wide.verdict == NotJudged("cyclonedds has no bound of 65536 elements")
    trial = compared(*both, make_message("uint8[<=65535] w\n"), [{"w": [1]}])
    assert_known(trial, "cyclonedds-cut", "rosbags-trailing")
    # No library was asked.
    none = compared(*both, make_message("uint8[<=65535] w\n"), [])
    assert none.verdict == NotJudged("rosbags had no answer to anything")
    trial = compared(*both, make_message("int8 w\n"), [], "ros1")
    assert trial.verdict == NotJudged("cyclonedds does not speak ros1")


def test_irregular_packets_have_their_irregularity(make_message):
    message = make_message("uint8 a\nuint32 n\nstring<=2 s\nstring e\nbool t\nuint8[<=1] l\n")
    value = {"a": 1, "n": 2, "s": b"xy", "e": b"", "t": True, "l": [5]}
    plain = "00010000 01000000 02000000 03000000 78790000 01000000 00 01 0000 01000000 05"
    packets = {odd: packet.hex() for odd, _, packet in unusual_packets(message, "cdr", [value])}
    assert sorted(packets) == sorted(n for n, o in UNUSUAL_CASES.items() if "cdr" in o)
    right = bytes.fromhex(plain)
    assert bytes.fromhex(packets["pad-3"]) == right + bytes(3)
    assert bytes.fromhex(packets["cut-1"]) == right[:-1]
    assert packets["cut-header"] == "0001"
    assert bytes.fromhex(packets["bool-2"]) == right[:25] + b"\2" + right[26:]
    assert bytes.fromhex(packets["bare-string"]) == right[:20] + bytes(4) + bytes.fromhex(
        "01 000000 01000000 05"
    )
    assert packets["big-endian"].startswith("0000000001000000000000020000000378790000")
    assert packets["dirty-padding"].startswith("0001000001ffffff")
    assert packets["options"].startswith("00010003")
    assert packets["bound-items"].endswith("020000000500")
    assert "04000000787978" in packets["bound-text"]
