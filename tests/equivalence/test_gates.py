"""Constants of GHDL's netlists, at the borders of their 32-bit words."""

from __future__ import annotations

from itertools import count

import pytest

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.dump import Instance
from firm_hdl.equivalence.gates import Gate, renamed


def constant(kind, width, *parameters):
    numbers = count(2)
    instance = Instance(kind=kind, name="c", inputs={}, outputs={}, parameters=parameters)
    return renamed(Gate(instance, {}, width, lambda n: tuple(next(numbers) for _ in range(n))))


@pytest.mark.parametrize("width", [1, 31, 32])
def test_constants_of_one_word(width):
    top = 1 << width - 1
    bits = ("0",) * (width - 1) + ("1",)
    assert constant("$const_bit", width, top) == bits
    assert constant("$const_log", width, top, 0) == bits
    for words in (0, 2):
        with pytest.raises(ProofError, match="an unknown form"):
            constant("$const_bit", width, *[0] * words)
        with pytest.raises(ProofError, match="an unknown form"):
            constant("$const_log", width, *[0] * (2 * words))


@pytest.mark.parametrize("width", [33, 63, 64])
def test_constants_of_two_words(width):
    low, high = 0x80000001, 1 << width - 33
    bits = tuple("01"[(high << 32 | low) >> place & 1] for place in range(width))
    assert constant("$const_bit", width, low, high) == bits
    assert constant("$const_log", width, low, 0, high, 0) == bits
    with pytest.raises(ProofError, match="an unknown form"):
        constant("$const_log", width, low, 0)


def test_bits_that_have_no_value_may_be_anything():
    bits = constant("$const_log", 34, 0b101, 0b100, 0b10, 0b10)
    assert bits[:3] == ("1", "0", 2) and bits[3:] == ("0",) * 30 + (3,)
    assert constant("$const_UL32", 3, 0b101, 0b100) == ("1", "0", 2)


@pytest.mark.parametrize(("word", "sign"), [(0xFFFFFFFE, "1"), (0x7FFFFFFE, "0")])
def test_signed_constants_are_extended_by_their_sign(word, sign):
    """GHDL prints the low word as an unsigned number."""
    assert constant("$const_SB32", 34, word) == ("0", *"1" * 30, *sign * 3)
    assert constant("$const_UB32", 34, word) == ("0", *"1" * 30, *sign[:1] * 1, "0", "0")
    assert constant("$const_SB32", 4, word) == ("0", "1", "1", "1")
