"""Descriptions of recorded messages, and packets that are equivalent."""

from __future__ import annotations

import dataclasses
import struct
from types import SimpleNamespace

import numpy as np
import pytest

from firm_hdl import load_message
from firm_hdl.cases.damage import stalls_for
from firm_hdl.cases.effort import MAX_MESSAGE_BYTES
from firm_hdl.cases.make import Case
from firm_hdl.cases.oracle import distro_oracle
from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.plan import build_plan
from firm_hdl.plan.interpret import decode
from firm_hdl.verify.systems.options import Options
from firm_hdl.verify.ts3 import acceptance, replay
from firm_hdl.verify.ts3.recording import Selection
from firm_hdl.wire import lay_out
from tests.verify.robot import write


def case(what, given=b"", status="OK"):
    return Case(what=what, value=None, packet=b"", transfers={}, given=given, status=status)


PACKET = b"\0\1\0\0\1\0\0\0"


@pytest.mark.parametrize(
    ("packet", "words"),
    [
        (PACKET, ""),
        (b"\0\1\0\3\1\0\0\0", "with option bits"),
        (PACKET + b"\0", "with bytes after the message"),
        (b"\0\1\0\0\1\0\0\2", "with padding that is not zero, or a bool that is neither 0 nor 1"),
        (
            b"\0\1\0\3\1\0\0\2\0",
            "with option bits, bytes after the message, padding that is not zero, or a bool that "
            "is neither 0 nor 1",
        ),
        # Missing padding at the end.
        (PACKET[:-1], "with padding that is not zero, or a bool that is neither 0 nor 1"),
    ],
)
def test_differences_of_packets_that_mean_the_same(packet, words):
    assert replay._difference(packet, PACKET, 4) == words


@pytest.mark.parametrize(
    ("packet", "name"),
    [
        (b"", "the representation of an empty packet"),
        (b"\0", "the representation 00"),
        (b"\0\0\0\0", "big-endian CDR"),
        (b"\0\2", "a big-endian parameter list"),
        (b"\0\3\0\0", "a parameter list"),
        (b"\0\6", "big-endian XCDR2"),
        (b"\0\7", "XCDR2"),
        (b"\0\x08", "big-endian delimited XCDR2"),
        (b"\0\x09", "delimited XCDR2"),
        (b"\0\x0a", "a big-endian parameter list of XCDR2"),
        (b"\0\x0b", "a parameter list of XCDR2"),
        (b"\0\4\0", "the representation 0004"),
        (b"\1\0\0", "the representation 0100"),
        (b"\1\7", "the representation 0107"),
    ],
)
def test_representations_have_names(packet, name):
    assert replay._representation(packet) == f"in {name}, which get the status ENCAPSULATION"


def selection(count, total, **more):
    known = {"topics": 1, "too_long": (), "sparse": False}
    return Selection(messages=(None,) * count, total=total, **{**known, **more})


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (selection(2, 3), ["2 of 3 messages of 1 topic replayed"]),
        (selection(1, 1, topics=2), ["1 of 1 messages of 2 topics replayed"]),
        (
            selection(2, 9, sparse=True),
            ["2 of 9 messages of 1 topic replayed", "more would take long, --cases N takes N"],
        ),
        (
            selection(2, 5, too_long=(70, 90, 80)),
            [
                "2 of 5 messages of 1 topic replayed",
                "3 left out, of more than 64 bytes (up to 90): --max-message-bytes N takes longer "
                "ones",
            ],
        ),
    ],
)
def test_messages_are_counted(found, words):
    assert replay._counts(found, Options(longest=64)) == words


def test_kinds_are_counted_with_the_first_of_each():
    judged = [
        replay._Judged(case=case(what), kind=kind)
        for what, kind in (("a", ""), ("b", "x"), ("c", "y"), ("d", "x"), ("e", ""))
    ]
    assert replay._kinds(judged) == ["2 x (first: b)", "1 y (first: c)"]
    assert replay._kinds(judged[:1]) == []


def test_messages_that_do_not_fit_are_reported_with_size_and_status():
    output = replay._misfit(case("message 3", given=b"12345", status="TRUNCATED"), "why")
    assert output == ("message 3: its 5 bytes do not fit the definition: status TRUNCATED; why")


@pytest.mark.parametrize(
    ("longest", "room"),
    [
        (0, MAX_MESSAGE_BYTES),
        (MAX_MESSAGE_BYTES, MAX_MESSAGE_BYTES),
        (MAX_MESSAGE_BYTES + 1, 2 * MAX_MESSAGE_BYTES),
        (2 * MAX_MESSAGE_BYTES, 2 * MAX_MESSAGE_BYTES),
        (5 * MAX_MESSAGE_BYTES, 8 * MAX_MESSAGE_BYTES),
    ],
)
def test_room_is_a_power_of_two(longest, room):
    assert replay._room(longest) == room


def plan_of(name):
    message = load_message(name, distro="lyrical")
    return build_plan(lay_out(message, message.wire), bus_bytes=8, max_message_bytes=1 << 12)


def test_bytes_of_texts_lose_their_highest_bit_and_signed_ones_do_not():
    text = plan_of("std_msgs/msg/String")
    # More than a bus word, so that there are two transfers, and the first is not the last.
    streams = decode(text, b"\0\1\0\0\x0c\0\0\0\xe9\x41\xff" + b"x" * 8 + b"\0").streams
    (leaf,) = (number for number, each in enumerate(text.leaves) if each.kind == "items")
    found = replay._changed(text, streams, replay._in_ascii)
    before = [item for items, _ in streams[leaf] for item in items]
    after = [item for items, _ in found[leaf] for item in items]
    assert before[:3] == [0xE9, 0x41, 0xFF] and after[:3] == [0x69, 0x41, 0x7F]
    assert [last for _, last in found[leaf]] == [False, True]
    assert {n: v for n, v in found.items() if n != leaf} == {
        n: v for n, v in streams.items() if n != leaf
    }
    wide = plan_of("std_msgs/msg/UInt32")
    streams = decode(wide, b"\0\1\0\0\xff\xff\xff\xff").streams
    assert replay._changed(wide, streams, replay._in_ascii) == streams
    signed = plan_of("std_msgs/msg/Int8")
    streams = decode(signed, b"\0\1\0\0\xff").streams
    assert replay._changed(signed, streams, replay._in_ascii) == streams


@pytest.mark.parametrize(
    ("name", "code", "signalling"),
    [
        ("std_msgs/msg/Float64", "<Q", 0x7FF0000000000001),
        ("std_msgs/msg/UInt64", "<Q", 0x7FF0000000000001),
        ("std_msgs/msg/UInt32", "<I", 0x7F800001),
    ],
)
def test_floats_that_python_keeps(name, code, signalling):
    plan = plan_of(name)
    for bits in (0, 1, signalling):
        streams = decode(plan, b"\0\1\0\0" + struct.pack(code, bits)).streams
        kept = replay._changed(plan, streams, replay._in_python)
        # Doubles pass as they are, and so do integers.
        assert kept == {number: list(each) for number, each in streams.items()}


def test_a_signalling_single_becomes_a_quiet_one():
    plan = plan_of("std_msgs/msg/Float32")
    for bits, kept in ((0x7F800001, 0x7FC00001), (0x7FC00000, 0x7FC00000), (0x3F800000,) * 2):
        streams = decode(plan, b"\0\1\0\0" + struct.pack("<I", bits)).streams
        assert list(replay._changed(plan, streams, replay._in_python).values()) == [[kept]]


def test_topics_of_another_definition_are_named(monkeypatch):
    def topic(name, digest, type_="p/A"):
        return SimpleNamespace(name=name, digest=digest, type=type_, encoding="cdr")

    topics = {
        "one": [topic("/a", ""), topic("/b", "x"), topic("/z", "x", "p/B")],
        "two": [topic("/c", "y"), topic("/d", "x"), topic("/bad", "x", "")],
    }
    monkeypatch.setattr(replay, "topics_of", topics.__getitem__)

    def message(name):
        if not name:
            raise DefinitionError([Diagnostic(message="it cannot be used")])
        return SimpleNamespace(name=name)

    library = SimpleNamespace(message=message)
    found, left = replay._topics(SimpleNamespace(name="p/A", wire="cdr"), library, ["one", "two"])
    assert [each.name for each in found] == ["/a", "/b", "/d"]
    assert left == ["/c left out: its definition is another one (y)"]


@pytest.mark.parametrize(
    ("error", "output"),
    [
        (ValueError(" first\nsecond"), "first"),
        (KeyError(3), "3"),
        (OverflowError(), "OverflowError"),
    ],
)
def test_errors_of_rosbags_are_reported_in_one_line(error, output):
    here = case("message 3", given=b"12345", status="TRUNCATED")
    found = replay._refused(None, None, here, SimpleNamespace(status="TRUNCATED"), error)
    assert found.finding == replay._misfit(here, f"rosbags says: {output.strip()}")
    assert (found.case, found.kind) == (here, "")


@pytest.mark.parametrize(
    ("name", "is_text"), [("UInt8MultiArray", True), ("Int8MultiArray", False)]
)
def test_items_with_a_sign_keep_their_highest_bit(name, is_text):
    plan = plan_of(f"std_msgs/msg/{name}")
    # No dimensions, no offset, and two elements.
    decoded = decode(plan, b"\0\1\0\0" + bytes(8) + b"\2\0\0\0\xff\x80")
    assert decoded.status == "OK"
    found = replay._changed(plan, decoded.streams, replay._in_ascii)
    assert (found != decoded.streams) is is_text


@pytest.mark.parametrize(
    ("packet", "finding"),
    [
        (
            b"\0\1\0\0\7",
            "its 5 bytes do not fit the definition: status ENCAPSULATION; rosbags reads",
        ),
        (
            b"\0\1\0\0",
            "its 4 bytes do not fit the definition: status ENCAPSULATION; rosbags says: ",
        ),
        # Only of these packets is the status right, and rosbags is not asked.
        (b"\0\0\0\0\7", ""),
    ],
)
def test_a_model_that_refuses_the_header_of_little_endian_cdr_is_found(
    monkeypatch, packet, finding
):
    def refuses(plan, packet):
        return dataclasses.replace(decode(plan, packet), status="ENCAPSULATION")

    monkeypatch.setattr(replay, "decode", refuses)
    plan, oracle = plan_of("std_msgs/msg/UInt8"), distro_oracle("lyrical")
    judge = SimpleNamespace(oracle=oracle, name="std_msgs/msg/UInt8")
    message = SimpleNamespace(bag="b", data=packet)
    judged = replay._judge(plan, judge, message, with_bag=False)
    assert finding in judged.finding and bool(judged.finding) is bool(finding)
    assert bool(judged.kind) is not bool(finding)


@pytest.mark.parametrize("wrong", ["", "packet", "transfers", "error"])
def test_a_similar_packet_has_to_have_the_same_bytes_and_transfers(monkeypatch, wrong):
    plan = plan_of("std_msgs/msg/UInt8")
    packet = b"\0\1\0\0\7"
    decoded = decode(plan, packet)
    (path,) = replay._by_path(plan, decoded.streams)

    def ask(plan, judge, given):
        assert given == packet
        if wrong == "error":
            raise LookupError("nothing")
        return packet + b"\0" * (wrong == "packet"), {path: [8 if wrong == "transfers" else 7]}

    monkeypatch.setattr(replay, "_ask", ask)
    here = case("message 3", given=packet)
    found = replay._judged_by_substitute(plan, None, here, decoded, "of a kind", "rosbags is odd")
    if wrong:
        assert (found.kind, found.finding) == ("", replay._misfit(here, "rosbags is odd"))
    else:
        assert (found.kind, found.finding) == ("of a kind", "")


@pytest.mark.parametrize(
    ("options", "most", "most_bytes"),
    [
        # A string has few leaves, which count as 8: a beat of 8 bytes is 8 of the work of 1000.
        ({}, 3, 1000),
        ({"bus_bytes": 4}, 3, 500),
        # Whoever asks for a number gets it, more or fewer, however long they are.
        ({"most_cases": 2}, 2, None),
        ({"most_cases": 70}, 70, None),
    ],
)
def test_how_many_messages_are_asked_for(monkeypatch, options, most, most_bytes):
    asked = []

    def select(topics, **limits):
        asked.append((topics, limits))
        return SimpleNamespace(total=1, messages=("a message",))

    monkeypatch.setattr(replay, "select", select)
    monkeypatch.setattr(replay, "MOST_MESSAGES", 3)
    monkeypatch.setattr(replay, "MOST_WORK", 1000)
    given = Options(longest=99, **options)
    replay._select(load_message("std_msgs/msg/String"), ["topics"], given)
    assert asked == [(["topics"], {"most": most, "longest": 99, "most_bytes": most_bytes})]


def test_bools_are_plain_wherever_they_are():
    """NumPy keeps the byte that was read, which is not always 0 or 1."""
    kind = dataclasses.make_dataclass("Kind", ["flags", "one", "many", "number"], frozen=True)

    def made(one=None, many=()):
        flags = np.frombuffer(b"\7\0\1\x80", dtype=np.bool_)
        number = np.frombuffer(b"\7\0", dtype=np.uint8)
        return kind(flags=flags, one=one, many=list(many), number=number)

    parts = [made(), made(), made()]
    value = made(parts[0], parts[1:])
    replay._make_bools_plain(value)
    for each in (value, *parts):
        assert (each.flags.tobytes(), each.number.tobytes()) == (b"\1\0\1\1", b"\7\0")


UINT8 = "std_msgs/msg/UInt8"


@pytest.mark.parametrize(
    ("given", "is_large", "runs"),
    [
        ({}, False, [[0, 1, 2, 3, 4, 5], [0, 1, 2, 3, 4, 5]]),
        # Of a large type, one message in four is stalled.
        ({}, True, [[0, 1, 2, 3, 4, 5], [0, 4]]),
        ({"stalled": False}, False, [[0, 1, 2, 3, 4, 5]]),
    ],
)
def test_messages_are_sent_without_stalls_and_with_those_of_the_seed(
    monkeypatch, tmp_path, given, is_large, runs
):
    sent = []

    class Sent:
        """In place of a circuit: nothing comes back."""

        def __init__(self, *given):
            pass

        def send(self, where, packets, stalls):
            sent.append(([packet[-1] for packet in packets], stalls))

        def crosscheck(self):
            sent.append("replayed")

    def judge_of(message, *more, **options):
        return dataclasses.replace(original(message, *more, **options), note="a remark")

    original = acceptance.judge_of
    monkeypatch.setattr(acceptance, "judge_of", judge_of)
    monkeypatch.setattr(acceptance, "Circuit", Sent)
    monkeypatch.setattr(replay, "is_large", lambda plan, cases: is_large)
    messages = [("/a", UINT8, number, b"\0\1\0\0" + bytes([number])) for number in range(6)]
    bags = (str(write(tmp_path / "run", "mcap", messages)),)
    result = replay.replay("lyrical", UINT8, Options(bags=bags, seed=5, **given))
    stalls = [None, stalls_for(f"5/{UINT8}")]
    assert sent == [*zip(runs, stalls, strict=False), "replayed"]
    assert result.failures == []
    assert result.note == "6 of 6 messages of 1 topic replayed; a remark"
