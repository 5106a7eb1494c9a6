# amaranth: UnusedElaboratable=no
"""Results of one bit as conditions, and the enable of a pad."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from amaranth.hdl import IOBufferInstance, IOPort, Module, Signal

from firm_hdl.rtlil.ir import Bits, Cell, Slice, Spec
from firm_hdl.vhdl.convert import convert
from firm_hdl.vhdl.expr import Declared, Values
from tests.vhdl.ghdl import analyse

WIDTHS = {"a": 1, "b": 1, "w": 4, "v": 4, "$y": 1}
VALUES = Values({name: Declared(name=name, width=n) for name, n in WIDTHS.items()}, {}, WIDTHS)
A, B, W, V = ((Slice(name, 0, WIDTHS[name]),) for name in "abwv")
ONE, ZERO = (Bits("1"),), (Bits("0"),)


@pytest.mark.parametrize(
    ("kind", "operands", "plain", "inverted"),
    [
        ("$and", (A, B), "a = '1' and b = '1'", "a = '0' or b = '0'"),
        ("$or", (A, B), "a = '1' or b = '1'", "a = '0' and b = '0'"),
        ("$and", (A, ONE), "a = '1' and true", "a = '0' or false"),
        ("$or", (ZERO, B), "false or b = '1'", "true and b = '0'"),
        ("$not", (A,), "a = '0'", "a = '1'"),
        ("$reduce_or", (W,), "w /= 0", "w = 0"),
        ("$reduce_bool", (A,), "a = '1'", "a = '0'"),
        ("$reduce_and", (W,), "(and w) = '1'", "(and w) = '0'"),
        ("$reduce_and", (ONE,), "true", "false"),
        ("$reduce_xor", ((),), "false", "true"),
        ("$xor", (A, B), "(a xor b) = '1'", "(a xor b) = '0'"),
        ("$eq", (W, V), "w = v", "w /= v"),
        ("$lt", (W, V), "w < v", "w >= v"),
        ("$le", (W, V), "w <= v", "w > v"),
        ("$gt", (W, (Bits("0011"),)), "w > 3", "w <= 3"),
        ("$gt", ((Bits("0011"),), W), "w < 3", "w >= 3"),
        ("$le", ((Bits("0011"),), W), "w >= 3", "w < 3"),
        ("$lt", ((Bits("0011"),), (Bits("0100"),)), "true", "false"),
    ],
)
def test_a_condition_and_its_inverse(
    kind: str, operands: tuple[Spec, ...], plain: str, inverted: str
) -> None:
    ports = {**dict(zip("AB", operands, strict=False)), "Y": (Slice("$y", 0, 1),)}
    cell = Cell(kind=kind, name="c", parameters={}, ports=ports, attributes={}, line=1)
    cells = VALUES.cells
    assert [cells.boolean(cell, inverted=each).text for each in (False, True)] == [plain, inverted]


@pytest.mark.parametrize("bit", ["0", "1"])
@pytest.mark.parametrize(("kind", "equal"), [("$eq", "1"), ("$ne", "0")])
def test_a_bit_is_compared_with_a_constant_on_either_side(kind: str, equal: str, bit: str) -> None:
    """The result is the bit itself where the constant and the operator agree."""
    for operands in ((A, (Bits(bit),)), ((Bits(bit),), A)):
        ports = {**dict(zip("AB", operands, strict=True)), "Y": (Slice("$y", 0, 1),)}
        cell = Cell(kind=kind, name="c", parameters={}, ports=ports, attributes={}, line=1)
        assert VALUES.cells.logic(cell).text == ("a" if bit == equal else "not a")


@pytest.mark.parametrize(("kind", "text"), [("$eq", "not (a xor b)"), ("$ne", "a xor b")])
def test_two_bits_are_compared_without_a_conversion(kind: str, text: str) -> None:
    ports = {"A": A, "B": B, "Y": (Slice("$y", 0, 1),)}
    cell = Cell(kind=kind, name="c", parameters={}, ports=ports, attributes={}, line=1)
    assert VALUES.cells.logic(cell).text == text


def test_a_part_of_a_pad_is_driven_only_while_enabled() -> None:
    m, pad = Module(), IOPort(3, name="pad")
    a, b, one, two = (Signal(n, name=name) for n, name in ((1, "a"), (2, "b"), (1, "e"), (1, "f")))
    m.submodules.low = IOBufferInstance(pad[0], o=a, oe=one)
    m.submodules.high = IOBufferInstance(pad[1:], o=b, oe=two)
    text = convert(m, name="t", ports=[a, b, one, two, pad]).files["t.vhd"]
    assert "  pad(0) <= a when e = '1' else 'Z';" in text
    assert "when f = '1' else \"ZZ\";" in text and "  pad(2 downto 1) <= " in text


@pytest.mark.parametrize(
    ("otherwise", "choice"),
    [
        ("a", "o <= a when s = '1' else b when t = '1' else a;"),
        ("b", "o <= a when s = '1' else b;"),
        ("c", "o <= a when s = '1' else b when t = '1' else c;"),
    ],
)
def test_only_the_last_choices_may_be_left_out(otherwise: str, choice: str) -> None:
    m = Module()
    values = {name: Signal(4, name=name) for name in "abc"}
    s, t, o = Signal(name="s"), Signal(name="t"), Signal(4, name="o")
    with m.If(s):
        m.d.comb += o.eq(values["a"])
    with m.Elif(t):
        m.d.comb += o.eq(values["b"])
    with m.Else():
        m.d.comb += o.eq(values[otherwise])
    text = convert(m, ports=[*values.values(), s, t, o], unsigned_ports=True)
    assert choice in " ".join(text.files["top.vhd"].split())


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("unsigned_ports", [False, True])
def test_a_pad_is_a_vector_in_all_entities(unsigned_ports: bool, tmp_path: Path) -> None:
    top, inner, pad = Module(), Module(), IOPort(3, name="pad")
    a, b, e = Signal(3, name="a"), Signal(3, name="b"), Signal(name="e")
    inner.submodules.buffer = IOBufferInstance(pad, o=a, oe=e, i=b)
    top.submodules.inner = inner
    vhdl = convert(top, ports=[a, b, e, pad], unsigned_ports=unsigned_ports)
    for text in (vhdl.files["top.vhd"], vhdl.files["top_inner.vhd"]):
        assert re.search(r"\bpad +: inout std_logic_vector\(2 downto 0\)", text)
    assert re.search(r"\bpad +=> pad\b", vhdl.files["top.vhd"])
    analyse(vhdl, tmp_path)
