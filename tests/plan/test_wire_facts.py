"""Easily missed facts about the wire formats, byte by byte, at every bus width.

The hexadecimal of CDR is what ROS 2's own type support writes or follows from OMG DDS-XTypes 1.3,
clause 7.4; spaces stand between fields, `|` before padding. Fast CDR 1.0.26, 2.2.5 and 2.3.3
(humble, jazzy, kilted) write all of `FACTS` so: ``tests/verify/references/test_fast_cdr.py``.
"""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest

from firm_hdl.model import IDL_PRIMITIVES, Array, Field, Message, Sequence, idl_primitives
from firm_hdl.plan import build_plan, decode, encode, to_yaml
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import BUS_WIDTHS, TIMES, make, on_every_bus

ROS1, ROS2 = "ros1", "ros2"
EMPTY1 = make(ROS1, {}, "E")
EMPTY2 = make(ROS2, {}, "E")
INNER = make(ROS2, {"a": "uint8", "b": "float64"}, "Inner")
PAIR = make(ROS2, {"a": "uint8", "b": "uint16"}, "Pair")

FACTS = {
    "ros1 byte is signed": (ROS1, {"x": "byte"}, {"x": -2}, "fe"),
    "ros1 char is unsigned": (ROS1, {"x": "char"}, {"x": 200}, "c8"),
    "ros1 does not align": (
        ROS1,
        {"a": "uint8", "b": "float64", "c": "uint16"},
        {"a": 1, "b": 1.0, "c": 2},
        "01 000000000000f03f 0200",
    ),
    "ros1 array has no prefix": (
        ROS1,
        {"x": "uint16[3]", "y": "uint8"},
        {"x": [1, 2, 3], "y": 4},
        "0100 0200 0300 04",
    ),
    "ros1 string has no NUL": (
        ROS1,
        {"s": "string", "x": "uint8"},
        {"s": "aé", "x": 7},
        "03000000 61c3a9 07",
    ),
    "ros1 empty string": (ROS1, {"s": "string", "x": "uint8"}, {"s": "", "x": 7}, "00000000 07"),
    "ros1 empty message": (ROS1, {}, {}, ""),
    "ros1 nested empty message": (
        ROS1,
        {"a": "uint8", "e": EMPTY1, "f": EMPTY1, "b": "uint8"},
        {"a": 1, "e": {}, "f": {}, "b": 2},
        "01 02",
    ),
    "ros1 empty messages in a row": (
        ROS1,
        {"e": (EMPTY1, "[]"), "a": (EMPTY1, "[2]"), "b": "uint8"},
        {"e": [{}, {}, {}], "a": [{}, {}], "b": 2},
        "03000000 02",
    ),
    "ros1 time is unsigned, duration signed": (
        ROS1,
        {"t": TIMES[0], "d": TIMES[1]},
        {"t": {"secs": 0xFFFFFFFE, "nsecs": 1}, "d": {"secs": -1, "nsecs": -2}},
        "feffffff 01000000 ffffffff feffffff",
    ),
    "byte is an octet, char unsigned": (
        ROS2,
        {"c": "char", "b": "byte", "i": "int8"},
        {"c": 200, "b": 0xFE, "i": -1},
        "00010000 c8 fe ff",
    ),
    "empty message is an octet": (ROS2, {}, {}, "00010000 00"),
    "nested empty messages are octets": (
        ROS2,
        {"p": "uint8", "es": (EMPTY2, "[]"), "one": EMPTY2, "z": "uint32"},
        {"p": 1, "es": [{}, {}], "one": {}, "z": 5},
        "00010000 01|000000 02000000 00 00 00|00 05000000",
    ),
    "alignment counts from the end of the header": (
        ROS2,
        {"a": "uint8", "b": "int64", "c": "uint16", "f": "float32"},
        {"a": 1, "b": -2, "c": 3, "f": 1.0},
        "00010000 01|00000000000000 feffffffffffffff 0300|0000 0000803f",
    ),
    "a first float64 needs no padding": (
        ROS2,
        {"d": "float64"},
        {"d": 1.0},
        "00010000 000000000000f03f",
    ),
    "an empty sequence adds no padding": (
        ROS2,
        {"q": "float64[]", "x": "uint8"},
        {"q": [], "x": 7},
        "00010000 00000000 07",
    ),
    "padding after an empty sequence is that of the next field": (
        ROS2,
        {"q": "float64[]", "x": "float64"},
        {"q": [], "x": 1.0},
        "00010000 00000000|00000000 000000000000f03f",
    ),
    "a sequence aligns its first item": (
        ROS2,
        {"q": "float64[]", "x": "uint8"},
        {"q": [1.0], "x": 7},
        "00010000 01000000|00000000 000000000000f03f 07",
    ),
    "a struct has no alignment of its own": (
        ROS2,
        {"x": "uint8", "p": (PAIR, "[2]"), "y": "uint8", "q": PAIR},
        {"x": 1, "p": [{"a": 2, "b": 3}, {"a": 4, "b": 5}], "y": 6, "q": {"a": 7, "b": 8}},
        "00010000 01 02 0300 04|00 0500 06 07 0800",
    ),
    "elements of a sequence are padded each where it stands": (
        ROS2,
        {"p": "uint8", "q": (INNER, "[]"), "x": "uint8"},
        {"p": 9, "q": [{"a": 1, "b": 1.0}, {"a": 1, "b": 1.0}], "x": 7},
        "00010000 09|000000 02000000 01|00000000000000 000000000000f03f "
        "01|00000000000000 000000000000f03f 07",
    ),
    "an empty sequence of structs adds no padding": (
        ROS2,
        {"p": "uint8", "q": (INNER, "[]"), "x": "uint8"},
        {"p": 9, "q": [], "x": 7},
        "00010000 09|000000 00000000 07",
    ),
    "a string's length counts its NUL": (
        ROS2,
        {"s": "string", "d": "float64"},
        {"s": "abc", "d": 1.0},
        "00010000 04000000 616263 00 000000000000f03f",
    ),
    "a string's length counts bytes": (
        ROS2,
        {"s": "string"},
        {"s": "é"},
        "00010000 03000000 c3a9 00",
    ),
    "an empty string has a NUL": (
        ROS2,
        {"s": "string", "d": "float64"},
        {"s": "", "d": 1.0},
        "00010000 01000000 00|000000 000000000000f03f",
    ),
    "strings in a sequence": (
        ROS2,
        {"ss": "string[]", "z": "uint64"},
        {"ss": ["", "ab"], "z": 5},
        "00010000 02000000 01000000 00|000000 03000000 6162 00|00 |00000000 0500000000000000",
    ),
    "wstring is units of 4 bytes without NUL": (
        ROS2,
        {"x": "uint8", "w": "wstring", "y": "uint8"},
        {"x": 1, "w": "aé\U0001f600", "y": 2},
        "00010000 01|000000 04000000 61000000 e9000000 3dd80000 00de0000 02",
    ),
    "bounds are not on the wire": (
        ROS2,
        {"s": "string<=3", "q": "uint16[<=3]", "z": "uint64"},
        {"s": "abc", "q": [1], "z": 5},
        "00010000 04000000 616263 00 01000000 0100|0000 0500000000000000",
    ),
    "bools are bytes": (
        ROS2,
        {"f": "bool", "fb": "bool[3]", "fs": "bool[]"},
        {"f": True, "fb": [True, False, True], "fs": [True, False]},
        "00010000 01 01 00 01 02000000 01 00",
    ),
    "a big array": (
        ROS2,
        {"x": "uint8", "a": "uint16[37]", "y": "uint8"},
        {"x": 1, "a": list(range(37)), "y": 2},
        "00010000 01|00" + b"".join(n.to_bytes(2, "little") for n in range(37)).hex() + "02",
    ),
}


def data(text: str) -> bytes:
    return bytes.fromhex(text.replace("|", ""))


@on_every_bus
@pytest.mark.parametrize("fact", FACTS)
def test_bytes_are_as_the_wire_format_says(fact, bus_bytes):
    dialect, fields, value, text = FACTS[fact]
    message = make(dialect, fields)
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    streams = to_transfers(plan, message, value)
    packet, status = encode(plan, streams)
    assert (packet.hex(), status) == (data(text).hex(), "OK")
    decoded = decode(plan, packet)
    assert decoded.status == "OK"
    assert from_transfers(plan, message, decoded.streams) == value


@on_every_bus
def test_bool_is_one_for_any_byte_but_zero(bus_bytes):
    message = make(ROS2, {"a": "bool", "b": "bool[5]"})
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    decoded = decode(plan, data("00010000 02 00 01 80 ff 00"))
    value = from_transfers(plan, message, decoded.streams)
    assert value == {"a": True, "b": [False, True, True, True, False]}
    assert decoded.streams[0] == [1]
    assert encode(plan, decoded.streams)[0] == data("00010000 01 00 01 01 01 00")


@on_every_bus
def test_options_and_up_to_three_trailing_bytes_are_ignored(bus_bytes):
    message = make(ROS2, {"a": "uint8"})
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    for trailing in range(4):
        decoded = decode(plan, data("0001abcd 05") + bytes(range(9, 9 + trailing)))
        assert (decoded.status, decoded.streams) == ("OK", {0: [5]})


@on_every_bus
def test_a_nan_keeps_its_payload(bus_bytes):
    message = make(ROS2, {"f": "float32", "d": "float64", "fs": "float32[]"})
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    single = np.frombuffer(bytes.fromhex("4523817f"), "<f4")
    double = np.frombuffer(bytes.fromhex("8967452301eff47f"), "<f8")
    value = {"f": single[0], "d": double[0], "fs": single}
    packet, _ = encode(plan, to_transfers(plan, message, value))
    want = "00010000 4523817f|00000000 8967452301eff47f 01000000 4523817f"
    assert packet == data(want)
    assert encode(plan, decode(plan, packet).streams)[0] == packet
    assert math.isnan(from_transfers(plan, message, decode(plan, packet).streams)["d"])


@on_every_bus
@pytest.mark.parametrize("count", [0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 63, 64, 65, 127, 128, 129])
def test_strings_of_every_residue_end_where_they_should(bus_bytes, count):
    message = make(ROS2, {"s": "string", "x": "uint32"})
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    text = bytes(1 + n % 100 for n in range(count))
    packet, _ = encode(plan, to_transfers(plan, message, {"s": text, "x": 0x01020304}))
    body = struct.pack("<I", count + 1) + text + b"\0"
    assert packet == data("00010000") + body + bytes(-len(body) % 4) + data("04030201")
    words = decode(plan, packet).streams.get(1, [])
    assert [last for _, last in words] == [n == len(words) - 1 for n in range(len(words))]
    assert len(words) == -(-count // bus_bytes)
    assert b"".join(bytes(lanes) for lanes, _ in words) == text + bytes(-count % bus_bytes)


def _wide(size: int) -> Message:
    wchar = idl_primitives(size)["wchar"]
    fields = {"w": wchar, "o": IDL_PRIMITIVES["byte"], "ws": Sequence(element=wchar, bound=3)}
    return Message(
        name="p/msg/T",
        dialect="ros2",
        fields=tuple(Field(name=name, type=kind) for name, kind in fields.items()),
    )


WIDE_VALUE = {"w": 0xCDDC, "o": 1, "ws": [0x61, 0xE9]}
# Fast CDR 1.0.26 (humble) writes 4 bytes, 2.2.5 (jazzy) and 2.3.3 (kilted) write 2. ROS compiles
# wide characters alone and in sequences with a bound, and no others.
WIDE = {
    4: (_wide(4), WIDE_VALUE, data("00010000 dccd0000 01|000000 02000000 61000000 e9000000")),
    2: (_wide(2), WIDE_VALUE, data("00010000 dccd 01|00 02000000 6100 e900")),
}
"""A message, a value and its packet, by the size of a wide character."""


@on_every_bus
@pytest.mark.parametrize("size", WIDE)
def test_a_wide_character_has_the_bytes_of_its_distribution(size, bus_bytes):
    message, value, packet = WIDE[size]
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    assert encode(plan, to_transfers(plan, message, value)) == (packet, "OK")
    decoded = decode(plan, packet)
    assert decoded.status == "OK"
    assert from_transfers(plan, message, decoded.streams) == value


def test_idl_char_is_signed_and_wchar_has_the_size_of_its_distribution():
    # OMG IDL has types that .msg has not: C's signed char; wchar.
    char, wchar = IDL_PRIMITIVES["char"], idl_primitives(4)["wchar"]
    message = Message(
        name="p/msg/T",
        dialect="ros2",
        fields=(
            Field(name="c", type=char),
            Field(name="w", type=wchar),
            Field(name="cs", type=Sequence(element=char)),
            Field(name="ws", type=Array(element=wchar, count=2)),
        ),
    )
    value = {"c": -2, "w": 0xF600, "cs": [-1, 1], "ws": [0x61, 0xE9]}
    for bus_bytes in BUS_WIDTHS:
        plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
        packet, status = encode(plan, to_transfers(plan, message, value))
        want = "00010000 fe|000000 00f60000 02000000 ff 01|0000 61000000 e9000000"
        assert (packet, status) == (data(want), "OK")
        assert from_transfers(plan, message, decode(plan, packet).streams) == value
        text = to_yaml(plan)
        assert "c: signed char\n" in text and "w: uint32\n" in text
