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
    ("kind", "widths", "width", "parameters", "bits"),
    [
        ("$signal", [3], 3, (), (10, 11, 12)),
        # GHDL has the most significant operand first.
        ("$concat2", [1, 2], 3, (), (11, 12, 10)),
        ("$concatn", [1, 1, 1, 1], 4, (), (13, 12, 11, 10)),
        ("$extract", [4], 2, (1,), (11, 12)),
        ("$extract", [4], 2, (2,), (12, 13)),
        ("$utrunc", [4], 3, (), (10, 11, 12)),
        ("$strunc", [4], 4, (), (10, 11, 12, 13)),
        ("$uextend", [2], 4, (), (10, 11, "0", "0")),
        ("$sextend", [2], 4, (), (10, 11, 11, 11)),
        ("$sextend", [2], 2, (), (10, 11)),
        ("$and", [2, 2], 2, (), None),
    ],
)
def test_gates_that_only_rename_bits(kind, widths, width, parameters, bits):
    assert renamed(gate(kind, widths, width, *parameters)) == bits


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


@pytest.mark.parametrize(
    ("kind", "cell", "signed"),
    [
        *(("$and", "$and", 0), ("$or", "$or", 0), ("$xor", "$xor", 0), ("$xnor", "$xnor", 0)),
        *(("$add", "$add", 0), ("$sub", "$sub", 0), ("$umul", "$mul", 0), ("$smul", "$mul", 1)),
        *(("$eq", "$eq", 0), ("$ne", "$ne", 0)),
        *((f"$u{name}", f"${name}", 0) for name in ("lt", "le", "gt", "ge")),
        *((f"$s{name}", f"${name}", 1) for name in ("lt", "le", "gt", "ge")),
    ],
)
def test_operators_have_the_sign_of_their_names(kind, cell, signed):
    width = 1 if cell[1:] in ("eq", "ne", "lt", "le", "gt", "ge") else 3
    output = tuple(range(200, 200 + width))
    (found,) = gate_cells(gate(kind, [3, 3], width), output)
    assert found.kind == cell and found.outputs == {"Y": output}
    assert found.inputs == {"A": (10, 11, 12), "B": (13, 14, 15)}
    assert found.parameters == {
        "A_WIDTH": 3,
        "B_WIDTH": 3,
        "Y_WIDTH": width,
        "A_SIGNED": signed,
        "B_SIGNED": signed,
    }


@pytest.mark.parametrize(
    ("kind", "cell", "signed"), [("$lsl", "$shl", 0), ("$lsr", "$shr", 0), ("$asr", "$sshr", 1)]
)
def test_the_distance_of_a_shift_has_no_sign(kind, cell, signed):
    (found,) = gate_cells(gate(kind, [3, 2], 3), (200, 201, 202))
    assert (found.kind, found.inputs) == (cell, {"A": (10, 11, 12), "B": (13, 14)})
    assert (found.parameters["A_SIGNED"], found.parameters["B_SIGNED"]) == (signed, 0)


@pytest.mark.parametrize(("kind", "cell"), [("$nand", "$and"), ("$nor", "$or")])
def test_an_inverted_operator_is_two_cells(kind, cell):
    first, second = gate_cells(gate(kind, [2, 2], 2), (200, 201))
    assert (first.kind, first.inputs) == (cell, {"A": (10, 11), "B": (12, 13)})
    assert (second.kind, second.inputs) == ("$not", {"A": first.outputs["Y"]})
    assert second.outputs == {"Y": (200, 201)}


def chosen(cells, values):
    """Return the values of all nets behind multiplexers."""
    for each in cells:
        side = each.inputs["B" if values[each.inputs["S"][0]] else "A"]
        values |= {to: values[bit] for to, bit in zip(each.outputs["Y"], side, strict=True)}
    return values


@pytest.mark.parametrize("number", range(4))
def test_choices_are_in_the_order_of_the_selector(number):
    # Of four, the first one is chosen by 0; of two, the second one by 1.
    values = {10: number & 1, 11: number >> 1} | {12 + n: f"choice {n}" for n in range(4)}
    assert chosen(gate_cells(gate("$mux4", [2, 1, 1, 1, 1], 1), (200,)), values)[200] == (
        f"choice {number}"
    )
    if number < 2:
        values = {10: number, 11: "choice 0", 12: "choice 1"}
        assert chosen(gate_cells(gate("$mux2", [1, 1, 1], 1), (200,)), values)[200] == (
            f"choice {number}"
        )
    # Of several, the default or that of the only bit that is 1.
    bits = {10 + n: int(n == number) for n in range(3)}
    values = bits | {13: "choice 3", **{14 + n: f"choice {n}" for n in range(3)}}
    assert chosen(gate_cells(gate("$pmux", [3, 1, 1, 1, 1], 1), (200,)), values)[200] == (
        f"choice {number}"
    )


@pytest.mark.parametrize("parameters", [(), (1, 2)])
@pytest.mark.parametrize("kind", ["$extract", "$const_UB32", "$const_SB32"])
def test_gates_of_one_parameter_have_no_other_number_of_them(kind, parameters):
    given = gate(kind, [4] if kind == "$extract" else [], 2, *parameters)
    message = f"^GHDL's {re.escape(kind)} g has {len(parameters)} parameters$"
    with pytest.raises(ProofError, match=message):
        renamed(given)


def test_gates_that_nobody_knows_are_refused():
    with pytest.raises(ProofError, match=r"^GHDL's netlist has \$const_Z, which a proof does not"):
        renamed(gate("$const_Z", [], 2))
    with pytest.raises(ProofError, match=r"^GHDL's netlist has \$rol, which a proof does not"):
        gate_cells(gate("$rol", [2, 1], 2), (200, 201))
