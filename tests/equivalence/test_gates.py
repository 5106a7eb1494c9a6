"""Gates of GHDL's netlists: their form, and constants at the borders of 32-bit words."""

from __future__ import annotations

import re
from itertools import count, islice

import pytest

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.dump import Instance
from firm_hdl.equivalence.gates import Gate, gate_cells, renamed


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


def gate(kind, widths, width, *parameters):
    """Return a gate whose inputs are the nets 10, 11 and so on."""
    nets, fresh = count(10), count(100)
    inputs = {str(n): tuple(islice(nets, each)) for n, each in enumerate(widths)}
    instance = Instance(kind=kind, name="g", inputs={}, outputs={}, parameters=parameters)
    return Gate(instance, inputs, width, lambda n: tuple(islice(fresh, n)))


@pytest.mark.parametrize(
    ("kind", "widths", "width", "parameters"),
    [
        ("$signal", [3], 4, ()),
        ("$concat2", [1, 2], 2, ()),
        ("$extract", [4], 2, (3,)),
        ("$utrunc", [3], 4, ()),
        ("$uextend", [3], 2, ()),
        ("$sextend", [0], 2, ()),
        ("$const_UL32", [], 3, (1,)),
        ("$const_UL32", [], 3, (1, 0, 0)),
        ("$nand", [2, 1], 2, ()),
        ("$nor", [2, 2], 1, ()),
        ("$not", [2], 1, ()),
        ("$neg", [2], 3, ()),
        ("$and", [2, 1], 2, ()),
        ("$add", [2, 2], 3, ()),
        ("$lsl", [2, 1], 3, ()),
        ("$eq", [2, 1], 1, ()),
        ("$slt", [2, 2], 2, ()),
        ("$mux2", [2, 3, 3], 3, ()),
        ("$mux2", [1, 3, 2], 3, ()),
        ("$mux4", [1, 2, 2, 2, 2], 2, ()),
        ("$mux4", [2, 2, 2, 2, 1], 2, ()),
        ("$pmux", [2, 1, 1], 1, ()),
        ("$pmux", [2, 1, 1, 2], 1, ()),
        ("$pmux", [2, 2, 1, 1], 1, ()),
    ],
)
def test_gates_of_another_form_are_refused(kind, widths, width, parameters):
    given = gate(kind, widths, width, *parameters)
    with pytest.raises(ProofError, match=rf"^GHDL's {re.escape(kind)} g has an unknown form$"):
        assert renamed(given) is None
        gate_cells(given, tuple(range(200, 200 + width)))


DIVISIONS = {
    "$udiv": ("$div", 0),
    "$sdiv": ("$div", 1),
    "$umod": ("$mod", 0),
    "$srem": ("$mod", 1),
    "$smod": ("$modfloor", 1),
}


@pytest.mark.parametrize("kind", DIVISIONS)
def test_a_division_by_zero_may_give_anything(kind):
    divided, is_zero, choice = gate_cells(gate(kind, [2, 2], 2), (200, 201))
    assert (divided.kind, divided.parameters["A_SIGNED"]) == DIVISIONS[kind]
    assert divided.parameters["B_SIGNED"] == divided.parameters["A_SIGNED"]
    assert divided.inputs == {"A": (10, 11), "B": (12, 13)}
    assert (is_zero.kind, is_zero.inputs) == ("$logic_not", {"A": (12, 13)})
    assert (choice.kind, choice.inputs["S"]) == ("$mux", is_zero.outputs["Y"])
    assert (choice.inputs["A"], choice.outputs["Y"]) == (divided.outputs["Y"], (200, 201))
    # Nothing drives these nets.
    driven = {*divided.outputs["Y"], *is_zero.outputs["Y"], *choice.outputs["Y"], *range(10, 14)}
    free = choice.inputs["B"]
    assert len({*free}) == 2 and driven.isdisjoint(free)


def test_gates_that_nobody_knows_are_refused():
    with pytest.raises(ProofError, match=r"^GHDL's netlist has \$const_Z, which a proof does not"):
        renamed(gate("$const_Z", [], 2))
    with pytest.raises(ProofError, match=r"^GHDL's netlist has \$rol, which a proof does not"):
        gate_cells(gate("$rol", [2, 1], 2), (200, 201))
