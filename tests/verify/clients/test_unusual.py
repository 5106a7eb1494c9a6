"""The table of irregular packets: their places, their number, and their largest size."""

from __future__ import annotations

import pytest

from firm_hdl.verify.clients.unusual import (
    plain_packet,
    unusual_packet,
    unusual_packets,
    unusual_value,
)

ROS1 = "01 02000000 02000000 7879 00000000 01 01000000 05"
ROS1_ODD = {
    "nul-inside": ROS1.replace("02000000 7879", "03000000 610062"),
    "not-utf8": ROS1.replace("02000000 7879", "02000000 c328"),
    "bool-2": ROS1.replace("00000000 01 01", "00000000 02 01"),
    "trailing-1": f"{ROS1} 00",
    "trailing-4": f"{ROS1} 00000000",
    "cut-1": ROS1[:-3],
    "cut-half": "01 02000000 02000000 78",
    "cut-all": "",
    "bound-text": ROS1.replace("02000000 7879", "03000000 787978"),
    "bound-items": ROS1.replace("01000000 05", "02000000 05 00"),
    "long-text": ROS1.replace("02000000 7879", "70110100 7879"),
    "long-items": ROS1.replace("01000000 05", "70110100 05"),
}


def test_packets_of_ros1_are_irregular_at_their_first_place(make_message):
    message = make_message("uint8 a\nuint32 n\nstring<=2 s\nstring e\nbool t\nuint8[<=1] l\n")
    value = {"a": 1, "n": 2, "s": b"xy", "e": b"", "t": True, "l": [5]}
    assert plain_packet(message, "ros1", value) == bytes.fromhex(ROS1)
    found = {each: packet for each, _, packet in unusual_packets(message, "ros1", [value])}
    assert found == {name: bytes.fromhex(text) for name, text in ROS1_ODD.items()}


@pytest.mark.parametrize(("bound", "is_made"), [(64, True), (65, False)])
def test_bounds_are_exceeded_up_to_one(make_message, bound, is_made):
    message = make_message(f"string<={bound} s\nuint8[<={bound}] l\nwstring<={bound} w")
    value = {"s": b"", "l": [], "w": []}
    text, items = (
        unusual_value(message, value, "bound-text"),
        unusual_value(message, value, "bound-items"),
    )
    assert (text is not None, items is not None) == (is_made, is_made)
    if is_made:
        assert text == {"s": b"x" * 65, "l": [], "w": []}
        assert items == {"s": b"", "l": [0] * 65, "w": []}
    wide = unusual_value(make_message(f"wstring<={bound} w"), {"w": [1]}, "bound-text")
    assert wide == ({"w": [1] + [0x61] * 64} if is_made else None)


def test_everything_of_a_packet_may_be_big_endian(make_message):
    message = make_message("uint8 a\nuint16 b\nuint32 c\nuint64 d\nstring s")
    value = {"a": 1, "b": 2, "c": 3, "d": 4, "s": b"x"}
    packet = unusual_packet(message, "cdr", value, "big-endian")
    want = "00000000 01 00 0002 00000003 0000000000000004 00000002 7800"
    assert packet == bytes.fromhex(want)


def test_a_text_without_a_nul_is_the_first_one_that_has_bytes(make_message):
    """An empty text without a NUL is the other case. Texts behind the changed one are whole."""
    message = make_message("string e\nstring s\nstring z")
    value = {"e": b"", "s": b"xyz", "z": b"q"}
    packet = unusual_packet(message, "cdr", value, "no-nul")
    want = "00010000 01000000 00 000000 02000000 6162 0000 02000000 7100"
    assert packet == bytes.fromhex(want)
    assert unusual_packet(message, "cdr", {"e": b"", "s": b"", "z": b""}, "no-nul") is None
