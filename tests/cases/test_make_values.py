"""Values of cases: each mode gives its bit patterns for each type."""

from __future__ import annotations

import math
import random
import struct

import pytest

from firm_hdl.cases.make import FLOATS, _Maker

WIDTHS = {
    "bool": 1,
    "byte": 8,
    "char": 8,
    "int8": 8,
    "uint8": 8,
    "int16": 16,
    "uint16": 16,
    "int32": 32,
    "uint32": 32,
    "int64": 64,
    "uint64": 64,
    "float32": 32,
    "float64": 64,
}
SIGNED = {"byte", "int8", "int16", "int32", "int64"}


def maker(mode, seed=0):
    return _Maker(oracle=None, bus_bytes=8, rng=random.Random(seed), mode=mode, visits={})


@pytest.mark.parametrize("name", WIDTHS)
def test_each_mode_has_its_bits(name):
    ones = (1 << WIDTHS[name]) - 1
    top = 1 << WIDTHS[name] - 1
    assert maker("zero").bits(name) == 0
    assert maker("high").bits(name) == (ones >> 1 if name in SIGNED else ones)
    assert maker("low").bits(name) == (top if name in SIGNED or name in FLOATS else 0)
    special = {maker("special", seed).bits(name) for seed in range(200)}
    assert special == (set(FLOATS[name]) if name in FLOATS else {0, 1, ones, ones >> 1, top})
    some = {maker("any", seed).bits(name) for seed in range(200)}
    assert len(some) == 2 if name == "bool" else len(some) > 50
    assert max(some) <= ones
    # Each bit is sometimes 1 and sometimes 0.
    assert max(some) > ones // 2 and min(some) <= ones // 2
    mixed = {maker("mixed", seed).bits(name) for seed in range(200)}
    assert mixed & special and (name == "bool" or mixed - special)


@pytest.mark.parametrize(
    ("name", "mode", "value"),
    [
        ("int8", "high", 127),
        ("int8", "low", -128),
        ("byte", "high", 127),
        ("byte", "low", -128),
        ("char", "high", 255),
        ("uint8", "high", 255),
        ("uint8", "low", 0),
        ("int64", "low", -(1 << 63)),
        ("uint64", "high", (1 << 64) - 1),
        ("bool", "high", True),
        ("bool", "low", False),
        ("bool", "zero", False),
        ("float32", "zero", 0.0),
    ],
)
def test_scalars_are_of_their_types(name, mode, value):
    found = maker(mode).scalar(name)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize("name", ["float32", "float64"])
def test_floats_are_kept_as_python_has_them(name):
    code, fraction = ("<f", 23) if name == "float32" else ("<d", 52)
    assert math.copysign(1, maker("low").scalar(name)) == -1 and maker("low").scalar(name) == 0
    for seed in range(100):
        value = maker("special", seed).scalar(name)
        bits = int.from_bytes(struct.pack(code, value), "little")
        if math.isnan(value):
            assert bits >> fraction - 1 & 1
        else:
            assert bits in FLOATS[name]
    assert math.isnan(maker("high").scalar(name))
