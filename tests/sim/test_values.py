"""Conversion of Python values to transfers and back: kinds, spellings, ranges, refusals."""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import pytest

from firm_hdl.plan import build_plan
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import TIMES, make

INNER = make("ros2", {"x": "int16", "s": "string"}, "I")


def transfers(fields, value, *, dialect="ros2", bus_bytes=4, **options):
    message = make(dialect, fields)
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    streams = to_transfers(plan, message, value, **options)
    return {str(plan.leaves[leaf]): payloads for leaf, payloads in streams.items()}


def test_items_go_a_bus_word_per_transfer_with_last_on_the_last():
    got = transfers({"a": "uint8[]", "b": "uint16[3]"}, {"a": range(1, 7), "b": [1, 2, 3]})
    assert got == {
        "a.length": [6],
        "a.items": [((1, 2, 3, 4), False), ((5, 6, 0, 0), True)],
        "b.items": [((1, 2), False), ((3, 0), True)],
    }


def test_an_empty_message_is_a_trigger_on_ros1_and_an_octet_on_cdr():
    assert transfers({}, {}, dialect="ros1") == {"trigger": [1]}
    name = "structure_needs_at_least_one_member"
    assert transfers({}, {}) == {name: [0]}
    assert transfers({}, {name: 0}) == {name: [0]}


def test_floats_are_their_bits():
    value = {"f": 1.0, "d": -2.0, "fs": [0.5]}
    got = transfers({"f": "float32", "d": "float64", "fs": "float32[]"}, value)
    assert got["f"] == [0x3F800000]
    assert got["d"] == [0xC000000000000000]
    assert got["fs.items"] == [((0x3F000000,), True)]


@pytest.mark.parametrize(
    ("kind", "value", "want"),
    [
        ("byte", 254, 254),
        ("byte", -2, 254),
        ("byte", b"\xfe", 254),
        ("bool", np.True_, 1),
        ("bool", 0, 0),
        ("int64", np.int64(-5), -5),
        ("uint8", np.uint8(255), 255),
        ("float32", 3, 0x40400000),
        ("float32", np.float64(3), 0x40400000),
    ],
)
def test_numbers_may_be_of_any_kind_that_fits(kind, value, want):
    assert transfers({"x": kind}, {"x": value}) == {"x": [want]}


@pytest.mark.parametrize("given", [b"\1\2\xff", [1, 2, 255], np.array([1, 2, 255], np.uint8)])
def test_bytes_lists_and_arrays_mean_the_same(given):
    assert transfers({"x": "uint8[3]"}, {"x": given}) == {"x.items": [((1, 2, 255, 0), True)]}


def test_a_ros1_byte_is_signed():
    assert transfers({"x": "byte[2]"}, {"x": b"\1\xff"}, dialect="ros1") == {
        "x.items": [((1, -1, 0, 0), True)]
    }


@pytest.mark.parametrize("order", ["<", ">"])
def test_numbers_of_numpy_have_either_order_of_bytes(order):
    fields = {"x": "float32", "d": "float64[2]", "i": "int16[2]"}
    value = {
        "x": np.array([1.5], f"{order}f4")[0] if order == "<" else np.array(1.5, ">f4"),
        "d": np.array([-2.0, 0.5], f"{order}f8"),
        "i": np.array([-2, 0x1234], f"{order}i2"),
    }
    got = transfers(fields, value, bus_bytes=16)
    assert got["x"] == [0x3FC00000]
    assert got["d.items"] == [((0xC000000000000000, 0x3FE0000000000000), True)]
    assert got["i.items"] == [((-2, 0x1234, 0, 0, 0, 0, 0, 0), True)]


@pytest.mark.parametrize("number", [-128, -127, -1, 0, 1, 127, 128, 129, 255])
def test_a_byte_may_be_given_with_or_without_a_sign(number):
    signed = number - 256 if number > 127 else number
    assert transfers({"x": "byte"}, {"x": number}, dialect="ros1") == {"x": [signed]}
    assert transfers({"x": "byte"}, {"x": number}) == {"x": [number % 256]}
    for dialect, sent in (("ros1", signed), ("ros2", number % 256)):
        got = transfers({"x": "byte[1]"}, {"x": bytes([number % 256])}, dialect=dialect)
        assert got == {"x.items": [((sent, 0, 0, 0), True)]}


def test_half_of_a_pair_in_a_wstring_is_a_unit_of_its_own():
    got = transfers({"w": "wstring"}, {"w": "\udc00a\ud83d"}, bus_bytes=16)
    assert got["w.items"] == [((0xDC00, 0x61, 0xD83D, 0), True)]
    streams = {"w.length": [3], "w.items": got["w.items"]}
    assert joined({"w": "wstring"}, streams, bus_bytes=16) == {"w": "\udc00a\ud83d"}


def test_wstring_is_utf_16_units_or_any_numbers():
    got = transfers({"w": "wstring"}, {"w": "a\U0001f600"}, bus_bytes=16)
    assert got["w.items"] == [((0x61, 0xD83D, 0xDE00, 0), True)]
    got = transfers({"w": "wstring"}, {"w": [0x12345678]}, bus_bytes=16)
    assert got["w.items"] == [((0x12345678, 0, 0, 0), True)]


def test_objects_are_read_by_attributes_in_rosbags_spelling():
    inner = make("ros1", {"from": "uint8", "t": TIMES[0], "d": TIMES[1]}, "K")
    value = SimpleNamespace(
        k=SimpleNamespace(
            from_=7,
            t=SimpleNamespace(sec=-1, nanosec=2),
            d=SimpleNamespace(sec=-3, nanosec=0xFFFFFFFF),
        )
    )
    assert transfers({"k": inner}, value, dialect="ros1") == {
        "k.from": [7],
        "k.t.secs": [0xFFFFFFFF],
        "k.t.nsecs": [2],
        "k.d.secs": [-3],
        "k.d.nsecs": [-1],
    }


REFUSED = [
    ({"x": "uint8"}, {"x": 256}, ValueError, "x must be from 0 to 255, not 256"),
    ({"x": "int8"}, {"x": -129}, ValueError, "x must be from -128 to 127, not -129"),
    ({"x": "byte"}, {"x": 256}, ValueError, "x must be from -128 to 255, not 256"),
    ({"x": "uint8"}, {"x": 1.0}, TypeError, "x must be an integer, not 1.0"),
    ({"x": "uint8"}, {"x": True}, TypeError, "x must be an integer, not True"),
    ({"x": "bool"}, {"x": 2}, TypeError, "x must be a bool, not 2"),
    ({"x": "bool"}, {"x": "yes"}, TypeError, "x must be a bool, not 'yes'"),
    ({"x": "float32"}, {"x": "1"}, TypeError, "x must be a number, not '1'"),
    ({"x": "float32"}, {"x": 1e39}, ValueError, "x is too large for a float32: 1e+39"),
    ({"x": "string"}, {"x": 5}, TypeError, "x must be a string, not 5"),
    ({"x": "wstring"}, {"x": b"a"}, TypeError, "x must be a wstring, not b'a'"),
    (
        {"x": "wstring"},
        {"x": [1 << 32]},
        ValueError,
        "x[0] must be from 0 to 4294967295, not 4294967296",
    ),
    ({"x": "uint8[3]"}, {"x": [1, 2]}, ValueError, "x must have 3 elements, not 2"),
    ({"x": "uint8[<=1]"}, {"x": [1, 2]}, ValueError, "x must have at most 1 elements, not 2"),
    ({"x": "string<=1"}, {"x": "é"}, ValueError, "x must have at most 1 elements, not 2"),
    ({"x": "uint8[]"}, {"x": [1, 256]}, ValueError, "x[1] must be from 0 to 255, not 256"),
    ({"x": "uint8[]"}, {"x": "abc"}, TypeError, "x must be a list of uint8, not 'abc'"),
    ({"x": "uint8[]"}, {"x": 3}, TypeError, "x must be a list of uint8, not 3"),
    ({"x": "uint8"}, {}, ValueError, "value lacks the field 'x' of p/msg/T (its fields: x)"),
    (
        {"x": "uint8"},
        {"x": 1, "y": 2},
        ValueError,
        "value has a field 'y' that p/msg/T does not have (its fields: x)",
    ),
    ({"x": "uint8"}, 5, TypeError, "value must be a p/msg/T (its fields: x), not 5"),
    (
        {"p": (INNER, "[]")},
        {"p": [{"x": 1, "s": ""}, {"x": 1 << 15, "s": ""}]},
        ValueError,
        "p[1].x must be from -32768 to 32767, not 32768",
    ),
    ({"p": INNER}, {"p": None}, TypeError, "p must be a p/msg/I (its fields: x, s), not None"),
    (
        {"p": INNER},
        {"p": {"x": 1}},
        ValueError,
        "p lacks the field 's' of p/msg/I (its fields: x, s)",
    ),
]


@pytest.mark.parametrize(("fields", "value", "error", "message"), REFUSED)
def test_values_that_do_not_fit_are_refused_by_their_path(fields, value, error, message):
    with pytest.raises(error, match=f"^{re.escape(message)}$"):
        transfers(fields, value)


def test_bounds_can_be_exceeded_on_purpose():
    got = transfers({"x": "uint8[<=1]"}, {"x": [1, 2]}, check_bounds=False)
    assert got == {"x.length": [2], "x.items": [((1, 2, 0, 0), True)]}


# From transfers to values.


def joined(fields, streams, bus_bytes=4, **options):
    message = make("ros2", fields)
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    paths = [str(leaf) for leaf in plan.leaves]
    given = {paths.index(name): payloads for name, payloads in streams.items()}
    return from_transfers(plan, message, given, **options)


def test_exact_values_are_bits_bytes_and_units():
    fields = {"f": "float32", "d": "float64[1]", "s": "string", "w": "wstring", "b": "bool"}
    streams = {
        # A signalling NaN, which a Python float does not keep.
        "f": [0x7F800001],
        "d.items": [((0x7FF0000000000001,), True)],
        "s.length": [2],
        "s.items": [((0x61, 0x62, 0, 0, 0, 0, 0, 0), True)],
        "w.length": [2],
        "w.items": [((0x61, 0x62), True)],
        "b": [1],
    }
    assert joined(fields, streams, 8, exact=True) == {
        "f": 0x7F800001,
        "d": [0x7FF0000000000001],
        "s": b"ab",
        "w": [0x61, 0x62],
        "b": True,
    }
    value = joined(fields, streams, 8)
    assert (value["s"], value["w"]) == ("ab", "ab")
    assert value["f"] != value["f"] and value["d"][0] != value["d"][0]


def test_transfers_become_plain_values():
    empty = make("ros2", {}, "E")
    fields = {"b": "bool", "f": "float32[]", "s": "string", "p": (INNER, "[1]"), "e": empty}
    streams = {
        "b": [1],
        "f.length": [2],
        "f.items": [((0x3F800000,), False), ((0x40000000,), True)],
        "s.length": [2],
        "s.items": [((0xC3, 0xA9, 0, 0), True)],
        "p.item.x": [-4],
        "p.item.s.length": [0],
        "e.structure_needs_at_least_one_member": [0],
    }
    value = joined(fields, streams)
    assert value == {"b": True, "f": [1.0, 2.0], "s": "é", "p": [{"x": -4, "s": ""}], "e": {}}
    assert value["b"] is True


def test_text_that_is_not_unicode_stays_bytes_or_numbers():
    assert joined({"s": "string"}, {"s.length": [1], "s.items": [((0xFF, 0, 0, 0), True)]}) == {
        "s": b"\xff"
    }
    assert joined({"s": "wstring"}, {"s.length": [1], "s.items": [((0x10000,), True)]}) == {
        "s": [0x10000]
    }
    assert joined({"s": "wstring"}, {"s.length": [1], "s.items": [((0xD800,), True)]}) == {
        "s": "\ud800"
    }


@pytest.mark.parametrize(
    ("streams", "message"),
    [
        ({"q.length": [1]}, "Leaf q.items has fewer transfers than the message needs"),
        ({}, "Leaf q.length has fewer transfers than the message needs"),
        ({"q.length": [0, 0]}, "Leaf q.length has more transfers than the message needs"),
        (
            {"q.length": [0], "q.items": [((0, 0, 0, 0), True)]},
            "Leaf q.items has more transfers than the message needs",
        ),
        (
            {"q.length": [1], "q.items": [((1, 0, 0, 0), False)]},
            "Leaf q.items has the wrong `last` at item 1 of 1",
        ),
        (
            {"q.length": [5], "q.items": [((1, 0, 0, 0), True), ((1, 0, 0, 0), True)]},
            "Leaf q.items has the wrong `last` at item 4 of 5",
        ),
        ({"q.length": [((1,), True)]}, "Leaf q.length transfers numbers, not ((1,), True)"),
        ({"q.length": [1], "q.items": [1]}, "Leaf q.items transfers lanes and `last`, not 1"),
    ],
)
def test_transfers_that_are_no_message_are_refused(streams, message):
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        joined({"q": "uint8[]"}, streams)
