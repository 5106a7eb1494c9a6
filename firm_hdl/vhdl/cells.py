"""Amaranth's operators in terms of `ieee.numeric_std`.

The rules of widths are those of Yosys (`kernel/calc.cc`). Operands are extended to the largest of
three widths: those of the result and of both operands. They are sign-extended only if both are
signed. The result is then cut to its own width.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import eq, ge, gt, le, lt, ne
from typing import Protocol

from firm_hdl.rtlil.ir import Cell, Spec, spec_width
from firm_hdl.vhdl.text import Expression, atom, call, chain, infix, literal, prefix
from firm_hdl.vhdl.uses import int_parameter, output, trim

__all__ = ["Cells"]

NATURAL_BITS = 31
"""Widest number that is written in decimal: VHDL's integers have 31 bits and a sign."""

EXTENSIBLE_BITS = 32
"""Widest constant that an operator of numeric_std may extend: where one extends a wider constant,
the synthesis of GHDL 2.0 ends with an internal error (``netlists-utils.adb:163``)."""

COMPARISONS = {"$eq": "=", "$ne": "/=", "$lt": "<", "$le": "<=", "$gt": ">", "$ge": ">="}
_INVERSE = {"=": "/=", "/=": "=", "<": ">=", "<=": ">", ">": "<=", ">=": "<"}
_MIRRORED = {"=": "=", "/=": "/=", "<": ">", "<=": ">=", ">": "<", ">=": "<="}
_COMPARE: dict[str, Callable[..., bool]] = {"=": eq, "/=": ne, "<": lt, "<=": le, ">": gt, ">=": ge}
_BITWISE = {"$and": "and", "$or": "or", "$xor": "xor"}
_REDUCTIONS = {
    "$reduce_or": "or",
    "$reduce_bool": "or",
    "$reduce_and": "and",
    "$reduce_xor": "xor",
}


class Operands(Protocol):
    """Writes the operands of operators. :class:`firm_hdl.vhdl.expr.Values` has the contracts.

    An operand may itself be an operator without a signal of its own. So the writers of operands
    and of operators call each other.
    """

    def width(self, wire: str) -> int: ...
    def folded(self, spec: Spec) -> Cell | None: ...
    def logic(self, spec: Spec) -> Expression: ...
    def boolean(self, spec: Spec) -> Expression: ...
    def unsigned(
        self, spec: Spec, width: int | None = None, *, target: bool = False
    ) -> Expression: ...
    def signed(self, spec: Spec) -> Expression: ...
    def extended(self, spec: Spec, width: int, *, signed: bool) -> Expression: ...
    def number(self, spec: Spec) -> Expression: ...
    def constant(self, spec: Spec, *, signed: bool = False) -> int | None: ...
    def choice(self, spec: Spec, bits: str, /) -> str: ...


class Cells:
    """Writes the operators of one module; `values` writes their operands."""

    def __init__(self, values: Operands) -> None:
        self._values = values

    def width(self, cell: Cell) -> int:
        """Count the bits of the result that are read."""
        return self._values.width(output(cell))

    def is_condition(self, cell: Cell) -> bool:
        """Return whether a result is made of comparisons, so that it reads best as a condition."""
        if cell.kind in COMPARISONS:
            return spec_width(cell.ports["A"]) > 1 or spec_width(cell.ports["B"]) > 1
        if cell.kind in ("$and", "$or", "$not") and self.width(cell) == 1:
            operands = [cell.ports[port] for port in ("A", "B") if cell.ports.get(port)]
            inner = [self._values.folded(trim(spec, 1)) for spec in operands]
            return any(part is not None and self.is_condition(part) for part in inner)
        return False

    def boolean(self, cell: Cell, *, inverted: bool = False) -> Expression:
        """Write a result of one bit as a condition, or as the inverted condition."""
        kind, ports = cell.kind, cell.ports
        if kind in COMPARISONS:
            return self._compare(cell, inverted=inverted)
        if kind == "$not":
            return self._condition(trim(ports["A"], 1), inverted=not inverted)
        if kind in ("$and", "$or") and ports["A"] and ports["B"]:
            a = self._condition(trim(ports["A"], 1), inverted=inverted)
            b = self._condition(trim(ports["B"], 1), inverted=inverted)
            return infix("and" if (kind == "$and") != inverted else "or", a, b)
        if kind in ("$reduce_or", "$reduce_bool") and ports["A"]:
            if all(chunk.width == 1 for chunk in ports["A"]):
                bits = [self._condition((chunk,), inverted=inverted) for chunk in ports["A"]]
                return chain("and" if inverted else "or", *bits)
            operand = self._values.unsigned(ports["A"])
            return infix("=" if inverted else "/=", operand, atom("0"))
        text = self.logic(cell)
        if text.text in ("'0'", "'1'"):
            return atom("true" if (text.text == "'1'") != inverted else "false")
        return infix("=", text, atom("'0'" if inverted else "'1'"))

    def _condition(self, spec: Spec, *, inverted: bool) -> Expression:
        cell = self._values.folded(spec)
        if cell is not None:
            return self.boolean(cell, inverted=inverted)
        if not inverted:
            return self._values.boolean(spec)
        if self._values.constant(spec) is not None:
            return atom("false" if self._values.constant(spec) else "true")
        return infix("=", self._values.logic(spec), atom("'0'"))

    def logic(self, cell: Cell) -> Expression:
        """Write a result of one bit as `std_logic`."""
        kind, ports, values = cell.kind, cell.ports, self._values
        if kind in COMPARISONS:
            return self._compare_bits(cell) or call("to_std_logic", self._compare(cell))
        if kind in _REDUCTIONS:
            if all(chunk.width == 1 for chunk in ports["A"]):
                bits = [values.logic((chunk,)) for chunk in ports["A"]]
                return chain(_REDUCTIONS[kind], *bits) if bits else atom("'0'")
            return prefix(_REDUCTIONS[kind], values.unsigned(ports["A"]))
        if kind == "$mux":
            return self.choice(*(trim(ports[port], 1) for port in "SBA"))
        operands = [self._low_bit(ports[port]) for port in ("A", "B") if port in ports]
        if kind == "$not":
            return prefix("not", operands[0])
        if kind in _BITWISE:
            return infix(_BITWISE[kind], *operands)
        if kind in ("$add", "$sub"):
            return infix("xor", *operands)
        if kind == "$mul":
            return infix("and", *operands)
        if kind == "$neg":
            return operands[0]
        return call("lsb", self._vector(cell, 1))

    def choice(self, select: Spec, b: Spec, a: Spec) -> Expression:
        """Write a multiplexer; of one bit and with a constant, it is an `and` or an `or`."""
        values, s = self._values, self._values.logic(select)
        if spec_width(a) > 1:
            return call("mux", s, *(values.unsigned(spec, target=True) for spec in (b, a)))
        for constant, other, is_on in (
            (values.constant(a), b, True),
            (values.constant(b), a, False),
        ):
            if constant is not None:
                s = s if bool(constant) != is_on else prefix("not", s)
                return infix("or" if constant else "and", s, values.logic(other))
        return call("mux", s, values.logic(b), values.logic(a))

    def _low_bit(self, spec: Spec) -> Expression:
        return self._values.logic(trim(spec, 1)) if spec else atom("'0'")

    def unsigned(self, cell: Cell) -> Expression:
        """Write a result of more than one bit."""
        return self._vector(cell, self.width(cell))

    def _vector(self, cell: Cell, width: int) -> Expression:
        kind, ports, values = cell.kind, cell.ports, self._values
        signed = int_parameter(cell, "A_SIGNED") == 1
        if kind in ("$add", "$sub"):
            return self._sum(cell, width, signed)
        if kind == "$neg":
            return infix("-", atom("0"), values.extended(ports["A"], width, signed=signed))
        if kind == "$mul":
            return self._product(cell, width, signed)
        if kind == "$not":
            return prefix("not", values.extended(ports["A"], width, signed=signed))
        if kind in _BITWISE:
            a, b = (self._bitwise(ports[port], width, signed) for port in "AB")
            return infix(_BITWISE[kind], a, b)
        if kind == "$mux":
            return self.choice(ports["S"], *(trim(ports[port], width) for port in "BA"))
        if kind in ("$divfloor", "$modfloor"):
            return self._division(cell, width, signed)
        if kind in ("$shl", "$shr", "$sshr", "$shift"):
            return self._shift(cell, width, signed)
        # Comparisons and reductions have one bit; the other bits of a wider result are zeros.
        return call("resize", self.logic(cell), width)

    def _bitwise(self, spec: Spec, width: int, signed: bool) -> Expression:
        if spec_width(spec) == width:
            return self._values.unsigned(spec, target=self._values.constant(spec) is not None)
        return self._values.extended(spec, width, signed=signed)

    def _sum(self, cell: Cell, width: int, signed: bool) -> Expression:
        values = self._values
        operator = "+" if cell.kind == "$add" else "-"
        a, b = (trim(cell.ports[port], width) for port in "AB")
        if operator == "+" and values.constant(a) is not None:
            a, b = b, a
        # numeric_std converts a number to the width of the other operand. One that does not fit
        # would be cut, with a warning in each simulation.
        value = values.constant(b, signed=signed)
        if value is not None and abs(value) < 1 << min(width, NATURAL_BITS):
            if value < 0:
                operator, value = ("-" if operator == "+" else "+"), -value
            return infix(operator, values.extended(a, width, signed=signed), atom(str(value)))
        value = values.constant(a)
        if value is not None and not signed and value < 1 << min(width, NATURAL_BITS):
            return infix(operator, atom(str(value)), values.unsigned(b, width))
        if signed or (spec_width(a) < width and spec_width(b) < width):
            left = values.extended(a, width, signed=signed)
            right = values.extended(b, width, signed=True) if signed else self._short(b, width)
            return infix(operator, left, right)
        if spec_width(a) == 1 and operator == "+":
            a, b = b, a
        if spec_width(a) == 1:
            return infix(operator, values.unsigned(a, width), self._short(b, width))
        # The operators of numeric_std extend the shorter operand.
        return infix(operator, self._short(a, width), self._short(b, width))

    def _short(self, spec: Spec, width: int) -> Expression:
        """Write an operand that numeric_std may extend to `width`; in VHDL-2008, also one bit."""
        if spec_width(spec) == 1:
            return self._values.logic(spec)
        return self._values.unsigned(spec, self._extensible(spec, width))

    def _extensible(self, spec: Spec, width: int) -> int:
        """Return the bits with which an operand is written that an operator extends to `width`."""
        natural = spec_width(spec)
        if natural <= EXTENSIBLE_BITS or self._values.constant(spec) is None:
            return max(natural, 1)
        return max(natural, width)

    def _signed(self, spec: Spec, width: int) -> Expression:
        """Write a signed operand as `signed` of `width` bits."""
        return call("signed", self._values.extended(spec, width, signed=True))

    def _product(self, cell: Cell, width: int, signed: bool) -> Expression:
        values = self._values
        a, b = (trim(cell.ports[port], width) for port in "AB")
        # A product of numeric_std has as many bits as both operands together.
        natural = max(spec_width(a), 1) + max(spec_width(b), 1)
        if signed and width <= natural:
            product = call("unsigned", infix("*", values.signed(a), values.signed(b)))
        else:
            left, right = (
                values.extended(x, width, signed=True) if signed else values.unsigned(x)
                for x in (a, b)
            )
            product = infix("*", left, right)
        return product if width == natural else call("resize", product, width)

    def _division(self, cell: Cell, width: int, signed: bool) -> Expression:
        values = self._values
        a, b = cell.ports["A"], cell.ports["B"]
        most = max(spec_width(a), spec_width(b))
        a_bits, b_bits = (self._extensible(spec, most) for spec in (a, b))
        function = "floor_div" if cell.kind == "$divfloor" else "floor_mod"
        if signed:
            inner = call(function, self._signed(a, a_bits), self._signed(b, b_bits))
            # The smallest number divided by -1 needs a bit more.
            natural = max(a_bits, b_bits) + 1 if function == "floor_div" else b_bits
            text = call("unsigned", inner)
            if width > natural:
                return call("sign_extend", text, width)
        else:
            text = call(function, values.unsigned(a, a_bits), values.unsigned(b, b_bits))
            natural = a_bits if function == "floor_div" else b_bits
        return text if natural == width else call("resize", text, width)

    def _shift(self, cell: Cell, width: int, signed: bool) -> Expression:
        values, a = self._values, cell.ports["A"]
        if cell.kind == "$shl":
            operand = values.extended(trim(a, width), width, signed=signed)
            return call("shift_left", operand, self._distance(cell.ports["B"], width))
        whole = max(spec_width(a), int_parameter(cell, "Y_WIDTH"), 1)
        distance = self._distance(cell.ports["B"], whole)
        operand = values.extended(a, whole, signed=signed)
        if signed:
            shifted = call("unsigned", call("shift_right", call("signed", operand), distance))
        else:
            shifted = call("shift_right", operand, distance)
        return shifted if whole == width else call("resize", shifted, width)

    def _distance(self, spec: Spec, width: int) -> Expression:
        """Write a shift distance that fits in VHDL's integers."""
        value = self._values.constant(spec)
        if value is not None:
            return atom(str(min(value, width)))
        if spec_width(spec) < NATURAL_BITS:
            return self._values.number(spec)
        bits = width.bit_length()
        return call("to_integer", call("saturate", self._values.unsigned(spec), bits))

    def _compare_bits(self, cell: Cell) -> Expression | None:
        """Compare single bits for equality without conversion to `boolean`."""
        a, b = cell.ports["A"], cell.ports["B"]
        if cell.kind not in ("$eq", "$ne") or spec_width(a) != 1 or spec_width(b) != 1:
            return None
        for bit, other in ((a, b), (b, a)):
            value = self._values.constant(bit)
            if value is not None:
                text = self._values.logic(other)
                return text if (value == 1) == (cell.kind == "$eq") else prefix("not", text)
        text = infix("xor", self._values.logic(a), self._values.logic(b))
        return prefix("not", text) if cell.kind == "$eq" else text

    def _compare(self, cell: Cell, *, inverted: bool = False) -> Expression:
        values = self._values
        operator = COMPARISONS[cell.kind]
        if inverted:
            operator = _INVERSE[operator]
        a, b = cell.ports["A"], cell.ports["B"]
        signed = int_parameter(cell, "A_SIGNED") == 1
        numbers = [values.constant(spec, signed=signed) for spec in (a, b)]
        if None not in numbers:
            return atom("true" if _COMPARE[operator](*numbers) else "false")
        if values.constant(a) is not None and values.constant(b) is None:
            a, b, operator = b, a, _MIRRORED[operator]
        if not signed and spec_width(a) == spec_width(b) == 1 and operator in ("=", "/="):
            return infix(operator, values.logic(a), values.logic(b))
        left = values.signed(a) if signed else values.unsigned(a)
        value = values.constant(b, signed=signed)
        if value is None:
            return infix(operator, left, values.signed(b) if signed else values.unsigned(b))
        if operator in ("=", "/=") and (name := values.choice(a, f"{value:0{spec_width(a)}b}")):
            return infix(operator, left, atom(name))
        if -(1 << NATURAL_BITS) < value < 1 << NATURAL_BITS:
            return infix(operator, left, atom(str(value)))
        width = self._extensible(b, spec_width(a))
        if signed:
            right = self._signed(b, width)
        elif value.bit_length() == spec_width(b):
            right = atom(literal(f"{value:0{width}b}"))
        else:
            right = values.unsigned(b, width)
        return infix(operator, left, right)
