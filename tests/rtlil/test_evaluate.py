"""Operators on constant operands, compared with the rules of Yosys for all values.

The reference here works on numbers and extends them bit by bit; it does not use the program's rules
for parts of operands.
"""

from __future__ import annotations

from itertools import product

import pytest

from firm_hdl.rtlil.evaluate import constant, evaluate, extended
from firm_hdl.rtlil.ir import Bits, Cell, Slice, Spec, cut, join, spec_width

WIDTHS = (1, 2, 3)
A, B = Slice("a", 0, 3), Slice("b", 0, 3)


def value_of(spec: Spec, wires: dict[str, int]) -> int:
    """Return the bits of a value as an unsigned number."""
    total = position = 0
    for chunk in spec:
        if isinstance(chunk, Bits):
            bits = int("".join("1" if bit == "1" else "0" for bit in chunk.text) or "0", 2)
        else:
            bits = wires[chunk.wire] >> chunk.low & ((1 << chunk.width) - 1)
        total |= bits << position
        position += chunk.width
    return total


def number(bits: int, width: int, *, signed: bool) -> int:
    return bits - (1 << width) if signed and width and bits >> (width - 1) else bits


def floor_div(a: int, b: int) -> int:
    return 0 if b == 0 else a // b


def floor_mod(a: int, b: int) -> int:
    return 0 if b == 0 else a % b


ARITHMETIC = {
    "$add": lambda a, b: a + b,
    "$sub": lambda a, b: a - b,
    "$mul": lambda a, b: a * b,
    "$and": lambda a, b: a & b,
    "$or": lambda a, b: a | b,
    "$xor": lambda a, b: a ^ b,
    "$eq": lambda a, b: a == b,
    "$ne": lambda a, b: a != b,
    "$lt": lambda a, b: a < b,
    "$le": lambda a, b: a <= b,
    "$gt": lambda a, b: a > b,
    "$ge": lambda a, b: a >= b,
    "$divfloor": floor_div,
    "$modfloor": floor_mod,
}
UNARY = {
    "$not": lambda a, width, signed: ~number(a, width, signed=signed),
    "$neg": lambda a, width, signed: -number(a, width, signed=signed),
    "$reduce_or": lambda a, width, signed: a != 0,
    "$reduce_bool": lambda a, width, signed: a != 0,
    "$reduce_and": lambda a, width, signed: a == (1 << width) - 1,
    "$reduce_xor": lambda a, width, signed: bin(a).count("1") & 1,
}


def shift_reference(kind: str, a: int, width: int, by: int, out: int, *, signed: bool) -> int:
    whole = number(a, width, signed=signed)
    return whole << by if kind == "$shl" else whole >> by


def forms(wire: Slice, width: int) -> list[Spec]:
    """Yield values of a width: every constant, a wire, and a wire with constants at either end."""
    found: list[Spec] = [(Bits(f"{n:0{width}b}"),) for n in range(1 << width)]
    found.append((Slice(wire.wire, 0, width),))
    if width > 1:
        for bit in "01":
            found.append((Bits(bit), Slice(wire.wire, 0, width - 1)))
            found.append((Slice(wire.wire, 1, width - 1), Bits(bit)))
    return found


def check(cell: Cell, want, *specs: Spec) -> bool:
    """Compare a result with the reference for all values of wires; return whether one exists."""
    result = evaluate(cell)
    if result is None:
        return False
    width = spec_width(cell.ports["Y"])
    assert spec_width(result) == width, cell
    names = {chunk.wire for spec in specs for chunk in spec if isinstance(chunk, Slice)}
    for values in product(range(8), repeat=len(names)):
        wires = dict(zip(sorted(names), values, strict=True))
        got = value_of(result, wires)
        assert got == int(want(wires)) & ((1 << width) - 1), (cell.kind, cell.ports, wires)
    return True


def a_cell(kind: str, width: int, signed: bool, **ports: Spec) -> Cell:
    parameters = {"A_SIGNED": int(signed), "B_SIGNED": int(signed), "Y_WIDTH": width}
    ports["Y"] = (Slice("y", 0, width),)
    return Cell(kind=kind, name="$1", parameters=parameters, ports=ports, attributes={}, line=1)


@pytest.mark.parametrize("kind", ARITHMETIC)
@pytest.mark.parametrize("signed", [False, True])
def test_operators_of_two(kind, signed):
    found = 0
    widths = (1,) if kind in ("$eq", "$ne", "$lt", "$le", "$gt", "$ge") else (1, 4)
    for wa, wb, width in product(WIDTHS, WIDTHS, widths):
        for a, b in product(forms(A, wa), [*forms(B, wb), (Slice("a", 0, wb),)]):

            def want(wires, a=a, b=b, wa=wa, wb=wb):
                left = number(value_of(a, wires), wa, signed=signed)
                right = number(value_of(b, wires), wb, signed=signed)
                return ARITHMETIC[kind](left, right)

            found += check(a_cell(kind, width, signed, A=a, B=b), want, a, b)
    assert found >= 9 * 2


@pytest.mark.parametrize("kind", ["$add", "$mul", "$and", "$or", "$xor", "$eq", "$ne"])
@pytest.mark.parametrize("signed", [False, True])
def test_constant_decides_on_either_side(kind, signed):
    decided = 0
    for number, width in product(range(8), (1, 3)):
        wire, bits = (A,), (Bits(f"{number:03b}"),)
        sides = [
            evaluate(a_cell(kind, width, signed, A=a, B=b)) for a, b in ((wire, bits), (bits, wire))
        ]
        assert [each is None for each in sides] in ([True, True], [False, False]), number
        decided += sides[0] is not None
    # 0 and all ones decide most operators, and powers of two decide products.
    assert decided > 0 or kind in ("$eq", "$ne")


@pytest.mark.parametrize("kind", UNARY)
@pytest.mark.parametrize("signed", [False, True])
def test_operators_of_one(kind, signed):
    found = 0
    for wa, width in product(WIDTHS, (1, 4)):
        for a in forms(A, wa):

            def want(wires, a=a, wa=wa):
                return UNARY[kind](value_of(a, wires), wa, signed)

            if kind.startswith("$reduce") and width > 1:
                continue
            found += check(a_cell(kind, width, signed, A=a), want, a)
    assert found > 5


@pytest.mark.parametrize(
    ("kind", "signed"),
    [("$shl", False), ("$shl", True), ("$shr", False), ("$sshr", True), ("$shift", False)],
)
def test_shifts(kind, signed):
    for wa, width, by in product(WIDTHS, (1, 4), (0, 1, 3, 4, 7, 100_000)):
        distance: Spec = (Bits(f"{by:020b}"),)
        for a in forms(A, wa):

            def want(wires, a=a, wa=wa, by=by, width=width):
                return shift_reference(
                    kind, value_of(a, wires), wa, min(by, 99), width, signed=signed
                )

            cell = a_cell(kind, width, signed, A=a, B=distance)
            parameters = {**cell.parameters, "B_SIGNED": 0}
            cell = Cell(kind=kind, name="$1", parameters=parameters, ports=cell.ports,
                        attributes={}, line=1)  # fmt: skip
            assert check(cell, want, a)


@pytest.mark.parametrize("by", [0, 15, 16, 17, 39, 40, 65_537])
def test_far_shifts_of_constants(by):
    number, distance = (Bits("101"),), (Bits(f"{by:017b}"),)
    (left,) = evaluate(a_cell("$shl", 40, False, A=number, B=distance))
    assert left == Bits(f"{5 << by:b}"[-40:].rjust(40, "0"))
    far = (Bits("1" + "0" * 59),)
    (right,) = evaluate(a_cell("$shr", 60, False, A=far, B=distance))
    assert right == Bits("1".rjust(by + 1, "0").ljust(60, "0")[:60])


def test_the_farthest_shift_takes_no_more_bits_than_its_operand():
    (right,) = evaluate(a_cell("$shr", 8, False, A=(Slice("a", 0, 8),), B=(Bits("1" * 62),)))
    assert right == Bits("0" * 8)


def test_multiplexers():
    for width in WIDTHS:
        for a, b in product(forms(A, width), forms(B, width)):
            for select in "01":
                cell = a_cell("$mux", width, False, A=a, B=b, S=(Bits(select),))
                assert check(
                    cell, lambda w, a=a, b=b, s=select: value_of(b if s == "1" else a, w), a, b
                )
            cell = a_cell("$mux", width, False, A=a, B=a, S=(Slice("s", 0, 1),))
            assert check(cell, lambda w, a=a: value_of(a, w), a)
            if a != b:
                cell = a_cell("$mux", width, False, A=a, B=b, S=(Slice("s", 0, 1),))
                is_select = (a, b) == ((Bits("0"),), (Bits("1"),))
                assert evaluate(cell) == ((Slice("s", 0, 1),) if is_select else None)


def test_values_are_extended_by_their_sign():
    for width, to, signed in product(WIDTHS, (1, 2, 3, 5), (False, True)):
        for spec in forms(A, width):
            result = extended(spec, to, signed=signed)
            assert spec_width(result) == to
            for n in range(8):
                want = number(value_of(spec, {"a": n}), width, signed=signed)
                assert value_of(result, {"a": n}) == want & ((1 << to) - 1)


def test_constants_are_numbers():
    assert constant((Bits("0x1z-"),)) == 0b00100
    assert constant((Bits("01"), Bits("10"))) == 0b1001
    assert constant((Bits("01"), Bits("10")), signed=True) == 0b1001 - 16
    assert constant(()) == 0 and constant((Bits("1"), A)) is None


def test_slices_and_concatenations_have_the_right_bits():
    specs = [(Bits("0110"), A, Bits("1"), Slice("b", 1, 2)), (A,), (Bits("10"),), (A, B)]
    for spec in specs:
        width = spec_width(spec)
        for low, count in product(range(width), range(width + 1)):
            part = cut(spec, low, count)
            assert spec_width(part) == min(count, width - low)
            for a, b in ((5, 3), (2, 6)):
                wires = {"a": a, "b": b}
                want = value_of(spec, wires) >> low & ((1 << count) - 1)
                assert value_of(part, wires) == want
            whole = join(cut(spec, 0, low), cut(spec, low, width - low))
            assert value_of(whole, {"a": 5, "b": 3}) == value_of(spec, {"a": 5, "b": 3})
