"""Plain values keep everything that a packet may have."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from firm_hdl.cases.values import (
    bits_of,
    from_json,
    from_objects,
    packed,
    shown,
    to_numbers,
    unpacked,
)
from firm_hdl.plan import build_plan, decode, encode
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.verify.references.worker_genpy import to_json
from firm_hdl.wire import lay_out

TEXT = """\
float32 f
float64[] d
string s
wstring w
B[<=2] b
B one
bool[2] flags
int8 i
C[2] two
"""
VALUE = {
    "f": 0x7F812345,  # A signalling NaN.
    "d": [1 << 63, 0xFFF0000000000001],
    "s": b"\xff\0\xfe",
    "w": [0xD800, 0x61],
    "b": [{}, {}],
    "one": {},
    "flags": [True, False],
    "i": -128,
    "two": [{"g": [0x7F812345]}, {"g": [1 << 31, 1]}],
}


ROSBAGS = """\
time t
duration[] d
byte b
byte[] bytes
uint8[2] u
bool f
bool[] flags
int16[] i
float32 x
float32[2] y
float64[] z
string s
string[] texts
B inner
B[2] inners
uint16 from
"""


@pytest.fixture
def message(make_message):
    return make_message(TEXT, B="", C="float32[] g\n")


def test_values_go_through_json(message):
    assert from_json(to_json(VALUE)) == VALUE


def test_values_of_rosbags_are_plain_values_with_the_names_of_ros(make_message):
    message = make_message(ROSBAGS, "noetic", B="uint8 x\n")
    time = lambda secs, nsecs: SimpleNamespace(sec=secs, nanosec=nsecs)  # noqa: E731
    value = SimpleNamespace(
        t=time(-1, 5), d=[time(2, 0xFFFFFFFF)], b=254, bytes=np.array([254, 1], "u1"),
        u=np.array([254, 1], "u1"), f=np.bool_(True), flags=np.array([True, False]),
        i=np.array([-2, 3], "i2"), x=-0.0,
        # A signalling NaN, which a Python float would not keep.
        y=np.array([0x7F800001, 1], "u4").view("f4"), z=np.array([0.5], "f8"),
        s="é\udcff", texts=["", "a"], inner=SimpleNamespace(x=3),
        inners=[SimpleNamespace(x=4), SimpleNamespace(x=5)], from_=6,
    )  # fmt: skip
    found = from_objects(message, value)
    assert found == {
        "t": {"secs": 0xFFFFFFFF, "nsecs": 5},
        "d": [{"secs": 2, "nsecs": -1}],
        "b": -2,
        "bytes": [-2, 1],
        "u": [254, 1],
        "f": True,
        "flags": [True, False],
        "i": [-2, 3],
        "x": 1 << 31,
        "y": [0x7F800001, 1],
        "z": [0x3FE0000000000000],
        "s": b"\xc3\xa9\xff",
        "texts": [b"", b"a"],
        "inner": {"x": 3},
        "inners": [{"x": 4}, {"x": 5}],
        "from": 6,
    }
    assert found["f"] is True and list(found) == [item.name for item in message.fields]
    # rosbags may give numbers of another size.
    value.y = np.array([1.0, -2.0], "f8")
    assert from_objects(message, value)["y"] == [0x3F800000, 0xC0000000]
    del value.inner
    with pytest.raises(ValueError, match=r"^SimpleNamespace has no inner$"):
        from_objects(message, value)


def test_packed_values_have_no_padding_and_no_names(make_message):
    message = make_message(
        "uint8 a\nint16[2] b\nuint32[] c\nstring s\nwstring w\nB[2] d\nB[] e\nint64 f\nbool g\n",
        B="int8 x\nfloat32 y\n",
    )
    inner = {"x": -1, "y": 0x7F800001}
    value = {
        "a": 1, "b": [-2, 3], "c": [4], "s": b"xy\0", "w": [0xD800], "d": [inner, inner], "e": [],
        "f": -1, "g": True,
    }  # fmt: skip
    data = bytes.fromhex(
        "01 feff0300 01000000 04000000 03000000 787900 01000000 00d80000 ff0100807f ff0100807f "
        "00000000 ffffffffffffffff 01"
    )
    assert packed(message, value) == data and unpacked(message, data) == value
    for size in range(len(data)):
        with pytest.raises(ValueError, match=r"^A packed value is too short$"):
            unpacked(message, data[:size])
    with pytest.raises(ValueError, match=r"^A packed value is too long$"):
        unpacked(message, data + b"\0")
    text = make_message("string s\n")
    with pytest.raises(ValueError, match="too short"):
        unpacked(text, bytes.fromhex("02000000 78"))


def test_values_go_through_converters(message):
    plan = build_plan(lay_out(message), bus_bytes=8)
    streams = to_transfers(plan, message, to_numbers(message, VALUE))
    packet, status = encode(plan, streams)
    assert status == "OK"
    assert from_transfers(plan, message, decode(plan, packet).streams, exact=True) == VALUE


def test_values_are_shown_as_people_write_them(make_message):
    message = make_message("float64 a\nfloat32 b\nstring s\nB[] c\n", B="uint8 x\n")
    value = {"a": bits_of(-0.0, 8), "b": 0x7FC00001, "s": b"x\xc3", "c": [{"x": 1}]}
    assert shown(message, value) == r"a: -0.0, b: nan (0x7fc00001), s: b'x\xc3', c: [{x: 1}]"
