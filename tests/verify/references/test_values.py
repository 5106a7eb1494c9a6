"""Plain values keep everything that a packet may have."""

from __future__ import annotations

import pytest

from firm_hdl.plan import build_plan, decode, encode
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.verify.references.genpy_objects import to_json
from firm_hdl.verify.references.values import (
    bits_of,
    from_json,
    packed,
    shown,
    to_numbers,
    unpacked,
)
from firm_hdl.wire import lay_out

TEXT = "float32 f\nfloat64[] d\nstring s\nwstring w\nB[<=2] b\nB one\nbool[2] flags\nint8 i\n"
VALUE = {
    "f": 0x7F812345,  # A signalling NaN.
    "d": [1 << 63, 0xFFF0000000000001],
    "s": b"\xff\0\xfe",
    "w": [0xD800, 0x61],
    "b": [{}, {}],
    "one": {},
    "flags": [True, False],
    "i": -128,
}


@pytest.fixture
def message(make_message):
    return make_message(TEXT, B="")


def test_packed_values_come_back(message):
    data = packed(message, VALUE)
    assert unpacked(message, data) == VALUE
    assert data[:4] == bytes.fromhex("4523817f")
    for wrong, output in ((data[:-1], "too short"), (data + b"\0", "too long")):
        with pytest.raises(ValueError, match=output):
            unpacked(message, wrong)


def test_values_go_through_json(message):
    assert from_json(to_json(VALUE)) == VALUE


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
