"""Evaluate operators whose operands are constant, wholly or in part.

The rules of widths are those of Yosys (`kernel/calc.cc`), as in :mod:`firm_hdl.vhdl.cells`.
"""

from __future__ import annotations

from firm_hdl.rtlil.ir import Bits, Cell, Spec, bits_of, cut, join, spec_width

__all__ = ["constant", "evaluate", "extended"]

_BITWISE = ("$and", "$or", "$xor")
_COMPARISONS = ("$eq", "$ne", "$lt", "$le", "$gt", "$ge")
_SHIFTS = ("$shl", "$shr", "$sshr", "$shift")


def constant(spec: Spec, *, signed: bool = False) -> int | None:
    """Return the number that a value has if all its bits are constant, else `None`."""
    text = bits_of(spec)
    if text is None:
        return None
    bits = "".join("1" if bit == "1" else "0" for bit in text)
    return int(bits or "0", 2) - ((signed and bits[:1] == "1") << len(bits))


def extended(spec: Spec, width: int, *, signed: bool) -> Spec:
    """Extend a value, or cut it, to `width` bits."""
    missing = width - spec_width(spec)
    if missing <= 0:
        return cut(spec, 0, width)
    if signed and spec:
        return join(spec, *[cut(spec, spec_width(spec) - 1, 1)] * missing)
    return join(spec, (Bits("0" * missing),))


def evaluate(cell: Cell) -> Spec | None:
    """Return the result of an operator as a value that needs no operator, else `None`."""
    kind, ports = cell.kind, cell.ports
    width = spec_width(ports["Y"])
    if kind == "$mux":
        return _mux(ports["S"], ports["A"], ports["B"])
    if "A" not in ports:
        return None
    signed = cell.parameters.get("A_SIGNED") == 1
    a = constant(ports["A"], signed=signed)
    if "B" not in ports:
        return _unary(kind, ports["A"], a, width, signed=signed)
    b = constant(ports["B"], signed=cell.parameters.get("B_SIGNED") == 1)
    if a is not None and b is not None:
        return _bits(_binary(kind, a, b, spec_width(ports["A"])), width)
    if kind in _SHIFTS:
        return None if b is None else _shifted(kind, ports["A"], b, width, signed=signed)
    if kind in _BITWISE:
        return _bitwise(kind, ports["A"], ports["B"], width, signed=signed)
    if kind in ("$add", "$sub") and b == 0:
        return extended(ports["A"], width, signed=signed)
    if kind == "$add" and a == 0:
        return extended(ports["B"], width, signed=signed)
    if kind == "$mul":
        return _product(ports["A"], ports["B"], a, b, width, signed=signed)
    if signed or kind not in _COMPARISONS:
        return None
    return _compared(kind, a, b, ports["A"], ports["B"])


def _bits(value: int, width: int) -> Spec:
    return (Bits(f"{value & ((1 << width) - 1):0{width}b}"),) if width else ()


def _mux(select: Spec, a: Spec, b: Spec) -> Spec | None:
    chosen = constant(select)
    if chosen is not None:
        return b if chosen else a
    if constant(a) == 0 and constant(b) == 1 and spec_width(a) == spec_width(b) == 1:
        return select
    return a if a == b else None


def _unary(kind: str, spec: Spec, value: int | None, width: int, *, signed: bool) -> Spec | None:
    size = spec_width(spec)
    if value is not None:
        unsigned = value & ((1 << size) - 1)
        results = {
            "$not": ~value,
            "$neg": -value,
            "$reduce_or": unsigned != 0,
            "$reduce_bool": unsigned != 0,
            "$reduce_and": unsigned == (1 << size) - 1,
            "$reduce_xor": unsigned.bit_count() & 1,
        }
        return _bits(int(results[kind]), width) if kind in results else None
    if kind.startswith("$reduce") and size == 1:
        return extended(spec, width, signed=False)
    ones = any(isinstance(chunk, Bits) and "1" in chunk.text for chunk in spec)
    if kind in ("$reduce_or", "$reduce_bool") and ones:
        return _bits(1, width)
    zeros = any(isinstance(chunk, Bits) and "0" in chunk.text for chunk in spec)
    return _bits(0, width) if kind == "$reduce_and" and zeros else None


def _binary(kind: str, a: int, b: int, size: int) -> int:
    if kind in ("$divfloor", "$modfloor"):
        return 0 if b == 0 else a // b if kind == "$divfloor" else a % b
    # No value of Amaranth has more than 65,535 bits, but a distance can be any number.
    if kind == "$shl":
        return a << min(b, 1 << 16)
    if kind in _SHIFTS:
        # A negative `a`, from a signed operand, is shifted arithmetically.
        return a >> min(b, 1 << 16)
    results = {
        "$add": a + b,
        "$sub": a - b,
        "$mul": a * b,
        "$and": a & b,
        "$or": a | b,
        "$xor": a ^ b,
        "$eq": a == b,
        "$ne": a != b,
        "$lt": a < b,
        "$le": a <= b,
        "$gt": a > b,
        "$ge": a >= b,
    }
    return int(results[kind])


def _shifted(kind: str, spec: Spec, by: int, width: int, *, signed: bool) -> Spec:
    if kind == "$shl":
        whole = extended(spec, width, signed=signed)
        by = min(by, width)
        return join((Bits("0" * by),), cut(whole, 0, width - by))
    by = min(by, max(spec_width(spec), width))
    whole = extended(spec, width + by, signed=signed)
    return cut(whole, by, width)


def _bitwise(kind: str, a: Spec, b: Spec, width: int, *, signed: bool) -> Spec | None:
    a, b = extended(a, width, signed=signed), extended(b, width, signed=signed)
    ones = (1 << width) - 1
    for one, other in ((a, b), (b, a)):
        value = constant(one)
        if value == 0:
            return _bits(0, width) if kind == "$and" else other
        if value == ones and kind != "$xor":
            return other if kind == "$and" else _bits(ones, width)
    return a if a == b and kind != "$xor" else None


def _product(
    a: Spec, b: Spec, left: int | None, right: int | None, width: int, *, signed: bool
) -> Spec | None:
    for spec, factor in ((a, right), (b, left)):
        if factor is not None and factor >= 0 and factor & (factor - 1) == 0:
            by = max(factor.bit_length() - 1, 0)
            if not factor:
                return _bits(0, width)
            zeros: Spec = (Bits("0" * by),) if by else ()
            return cut(join(zeros, extended(spec, width, signed=signed)), 0, width)
    return None


def _compared(kind: str, a: int | None, b: int | None, left: Spec, right: Spec) -> Spec | None:
    """Evaluate comparisons of unsigned numbers whose result is the same for all values.

    At most one of them is a constant, so each has bits.
    """
    if b is not None and spec_width(left) < b.bit_length():
        return _bits(kind in ("$lt", "$le", "$ne"), 1)
    if a is not None and spec_width(right) < a.bit_length():
        return _bits(kind in ("$gt", "$ge", "$ne"), 1)
    if (kind, b) == ("$lt", 0) or (kind, a) == ("$gt", 0):
        return _bits(0, 1)
    if (kind, b) == ("$ge", 0) or (kind, a) == ("$le", 0):
        return _bits(1, 1)
    for value, other in ((a, right), (b, left)):
        if spec_width(other) == 1 and (kind, value) in (("$eq", 1), ("$ne", 0)):
            return other
    if left == right:
        return _bits(int(kind in ("$eq", "$le", "$ge")), 1)
    return None
