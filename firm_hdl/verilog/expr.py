"""Netlist values and Amaranth's operators as Verilog expressions.

Verilog extends operands to the width of their context, also beyond the width of an operator's
result. So each expression here has exactly the bits of its value, and all operands of an operator
have one width: a shorter one is extended by a concatenation, whose parts have no context. All
signals are unsigned, and ``$signed`` is around a whole operand. The rules of widths are those of
Yosys (`kernel/calc.cc`), as in :mod:`firm_hdl.vhdl.cells`.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby

from firm_hdl.rtlil.evaluate import constant
from firm_hdl.rtlil.ir import Bits, Cell, Chunk, Slice, Spec, bits_of, spec_width
from firm_hdl.vhdl import expr
from firm_hdl.vhdl.expr import Declared
from firm_hdl.vhdl.text import Expression as _Expression
from firm_hdl.vhdl.uses import int_parameter, output, trim

__all__ = ["Expression", "Values", "infix", "is_foldable", "literal", "part", "unary"]

_BINARY = {"$add": "+", "$sub": "-", "$mul": "*", "$and": "&", "$or": "|", "$xor": "^"}
_COMPARISONS = {"$eq": "==", "$ne": "!=", "$lt": "<", "$le": "<=", "$gt": ">", "$ge": ">="}
_INVERSE = {"==": "!=", "!=": "==", "<": ">=", ">=": "<", ">": "<=", "<=": ">"}
_MIRRORED = {"==": "==", "!=": "!=", "<": ">", ">": "<", "<=": ">=", ">=": "<="}
_REDUCTIONS = {"$reduce_or": "|", "$reduce_bool": "|", "$reduce_and": "&", "$reduce_xor": "^"}
_RIGHT = ("$shr", "$sshr", "$shift")
_DIVISIONS = ("$divfloor", "$modfloor")
_ASSOCIATIVE = frozenset("+ & | ^ && ||".split())


class Expression(_Expression):
    """An expression; its outermost `operator` decides whether it needs parentheses."""

    __slots__ = ()

    def operand(self, operator: str = "") -> str:
        """Return the text as an operand of an operator."""
        plain = self.operator in ("", "not")
        plain |= self.operator == operator and operator in _ASSOCIATIVE
        return self.text if plain else f"({self.text})"


def infix(operator: str, *operands: Expression) -> Expression:
    """Apply a binary operator; an associative one to any number of operands."""
    if len(operands) == 1:
        return operands[0]
    text = f" {operator} ".join(each.operand(operator) for each in operands)
    return Expression(text, operator)


def unary(operator: str, operand: Expression) -> Expression:
    """Apply ``~``, ``!``, ``-`` or a reduction."""
    # `|~x` and `&~x` would be other operators.
    text = operand.text if not operand.operator else f"({operand.text})"
    return Expression(f"{operator}{text}", "not" if operator in "~!" else "reduce")


def literal(bits: str) -> str:
    """Write a constant; an undefined bit is 0, as in Amaranth's simulator."""
    value = int("".join("1" if bit == "1" else "0" for bit in bits) or "0", 2)
    if len(bits) == 1:
        return f"1'b{value}"
    return f"{len(bits)}'d{value}" if value < 1024 else f"{len(bits)}'h{value:x}"


def part(target: Declared, low: int, width: int) -> str:
    """Name bits of a signal."""
    if width == target.width:
        return target.name
    top = low + width - 1
    return f"{target.name}[{low}]" if width == 1 else f"{target.name}[{top}:{low}]"


def is_foldable(cell: Cell, width: int) -> bool:
    """Return whether an expression can be written where its result of `width` bits is read.

    Only an assignment cuts a result.
    """
    if cell.kind in _RIGHT:
        return width >= spec_width(cell.ports["A"])
    return cell.kind not in _DIVISIONS


class Values(expr.Values):
    """Writes the values of one module."""

    def __init__(
        self, declared: Mapping[str, Declared], folded: Mapping[str, Cell], width: Mapping[str, int]
    ) -> None:
        super().__init__(declared, folded, width)
        self.reads: dict[str, Declared] = {}  # The signals that were read, by name.

    def edge(self, cell: Cell) -> str:
        """Write the clock edge of a cell."""
        word = "posedge" if int_parameter(cell, "CLK_POLARITY") else "negedge"
        return f"{word} {self.logic(cell.ports['CLK']).text}"

    def name(self, chunk: Chunk) -> str:
        assert isinstance(chunk, Slice)
        declared = self._declared[chunk.wire]
        self.reads[declared.name] = declared
        return part(declared, chunk.low, chunk.width)

    def logic(self, spec: Spec) -> Expression:
        """Write one bit."""
        return self.value(spec, 1)

    def value(self, spec: Spec, width: int | None = None, *, signed: bool = False) -> Expression:
        """Write a value, extended or cut to `width` bits."""
        width = spec_width(spec) if width is None else width
        spec = trim(spec, width)
        missing = width - spec_width(spec)
        bits = bits_of(spec)
        if bits is not None:
            return Expression(literal(bits.rjust(width, bits[0] if signed and bits else "0")))
        parts = [text for chunk, count in _runs(spec) for text in self._chunks(chunk, count)]
        if not missing:
            return parts[0] if len(parts) == 1 else _joined(parts)
        if not signed:
            return _joined([Expression(f"{missing}'d0"), *parts])
        top = spec[-1]
        if isinstance(top, Bits):
            return _joined([Expression(literal(top.text[0] * missing)), *parts])
        if top.wire in self._folded:
            # The highest bit of an expression has no name.
            sign = literal("0" * missing + "1" + "0" * (width - missing - 1))
            value = Expression(f"{self.value(spec, width).text} ^ {sign}", "^")
            return Expression(f"{{{infix('-', value, Expression(sign)).text}}}")
        sign = self.name(Slice(top.wire, top.low + top.width - 1, 1))
        return _joined([Expression(f"{{{missing}{{{sign}}}}}"), *parts])

    def _chunks(self, chunk: Chunk, count: int) -> list[Expression]:
        if isinstance(chunk, Bits):
            return [Expression(literal(chunk.text))] * count
        cell = self._folded.get(chunk.wire)
        text = self.result(cell) if cell is not None else Expression(self.name(chunk))
        return [text] if count == 1 else [Expression(f"{{{count}{{{text.text}}}}}")]

    def boolean(self, spec: Spec | Cell, *, inverted: bool = False) -> Expression:
        """Write one bit as a condition, or as the inverted condition."""
        cell = spec if isinstance(spec, Cell) else self.folded(spec)
        if cell is not None:
            if cell.kind in _COMPARISONS:
                return self._compare(cell, inverted=inverted)
            if cell.kind == "$not":
                return self.boolean(trim(cell.ports["A"], 1), inverted=not inverted)
            if cell.kind in ("$and", "$or"):
                sides = [
                    self.boolean(trim(cell.ports[port], 1), inverted=inverted)
                    for port in "AB"
                    if cell.ports[port]
                ]
                if len(sides) == 2:
                    return infix("&&" if (cell.kind == "$and") != inverted else "||", *sides)
            value = self.result(cell)
        else:
            assert not isinstance(spec, Cell)
            value = self.logic(spec)
        return unary("!", value) if inverted else value

    def result(self, cell: Cell) -> Expression:
        """Write the result of an operator."""
        kind, ports, width = cell.kind, cell.ports, self._width[output(cell)]
        signed = int_parameter(cell, "A_SIGNED") == 1
        if kind in _BINARY:
            sides = [self.value(ports[port], width, signed=signed) for port in "AB"]
            return infix(_BINARY[kind], *sides)
        if kind in ("$not", "$neg"):
            operand = self.value(ports["A"], width, signed=signed)
            return unary("~" if kind == "$not" else "-", operand)
        if kind == "$mux":
            if width == 1 and (bit := self._chosen_bit(ports)) is not None:
                return bit
            select = self.boolean(ports["S"])
            b, a = (self.value(ports[port], width).operand() for port in "BA")
            return Expression(f"{select.operand()} ? {b} : {a}", "?")
        if kind == "$shl":
            operand = self.value(ports["A"], width, signed=signed)
            return infix("<<", operand, self.value(ports["B"]))
        if kind in _RIGHT:
            return self._shift(cell, max(width, spec_width(ports["A"])), signed)
        if kind in _DIVISIONS:
            return self._division(cell, width, signed)
        if kind in _COMPARISONS:
            bit = self._compare(cell)
        elif ports["A"] and all(chunk.width == 1 for chunk in ports["A"]):
            bit = infix(_REDUCTIONS[kind], *(self.value((chunk,)) for chunk in ports["A"]))
        else:
            bit = unary(_REDUCTIONS[kind], self.value(ports["A"]))
        return bit if width == 1 else _joined([Expression(f"{width - 1}'d0"), bit])

    def _chosen_bit(self, ports: Mapping[str, Spec]) -> Expression | None:
        """Write a multiplexer of one bit with a constant as an `and` or an `or`."""
        select, (a, b) = self.logic(ports["S"]), (trim(ports[port], 1) for port in "AB")
        if constant(a) is not None:
            if constant(a):
                select = unary("~", select)
            return infix("|" if constant(a) else "&", select, self.logic(b))
        if constant(b) is not None:
            if not constant(b):
                select = unary("~", select)
            return infix("|" if constant(b) else "&", select, self.logic(a))
        return None

    def _shift(self, cell: Cell, whole: int, signed: bool) -> Expression:
        a, b = cell.ports["A"], cell.ports["B"]
        distance = self.value(b)
        if not signed and self._width[output(cell)] == 1 and self.is_name(a):
            (chunk,) = a
            assert isinstance(chunk, Slice)
            is_whole = chunk.width == self._declared[chunk.wire].width
            if is_whole and 1 << spec_width(b) <= chunk.width:
                return Expression(f"{self.name(chunk)}[{distance.text}]")
        operand = self.value(a, whole, signed=signed)
        if not signed:
            return infix(">>", operand, distance)
        return _unsigned(infix(">>>", _signed(operand), distance))

    def _compare(self, cell: Cell, *, inverted: bool = False) -> Expression:
        a, b = cell.ports["A"], cell.ports["B"]
        operator = _COMPARISONS[cell.kind]
        if inverted:
            operator = _INVERSE[operator]
        if constant(a) is not None:
            a, b, operator = b, a, _MIRRORED[operator]
        signed = int_parameter(cell, "A_SIGNED") == 1
        width = max(spec_width(a), spec_width(b), 1)
        value = constant(b)
        if width == 1 and value is not None and operator in ("==", "!=") and not signed:
            bit = self.logic(a)
            return bit if (value == 1) == (operator == "==") else unary("~", bit)
        sides = [self.value(spec, width, signed=signed) for spec in (a, b)]
        if value is not None and (name := self.choice(a, f"{value:0{width}b}")):
            sides[1] = Expression(name)
        return infix(operator, *(map(_signed, sides) if signed else sides))

    def _division(self, cell: Cell, width: int, signed: bool) -> Expression:
        """Write a division that rounds down; dividing by 0 gives 0."""
        a, b = cell.ports["A"], cell.ports["B"]
        whole = max(width, spec_width(a) + signed, spec_width(b) + signed)
        left, right = (self.value(spec, whole, signed=signed) for spec in (a, b))
        zero, one = f"{whole}'d0", f"{whole}'sd1"
        operator = "/" if cell.kind == "$divfloor" else "%"
        guard = infix("==", right, Expression(zero))
        result = infix(operator, left, right)
        if signed:
            x, y = _signed(left).text, _signed(right).text
            rest = f"{x} % {y}"
            # Verilog rounds to 0.
            sign = x if operator == "/" else rest
            corrected = f"{x} / {y} - {one}" if operator == "/" else f"{rest} + {y}"
            test = f"{rest} != {whole}'sd0 && (({sign}) < {whole}'sd0) != ({y} < {whole}'sd0)"
            text = f"({test}) ? {corrected} : {x} {operator} {y}"
            result = _unsigned(Expression(text, "?"))
        return Expression(f"{guard.operand()} ? {zero} : {result.operand()}", "?")


def _runs(spec: Spec) -> list[tuple[Chunk, int]]:
    """Count equal bits that follow each other, from the highest bit on."""
    found: list[tuple[Chunk, int]] = []
    for chunk, equal in groupby(reversed(spec)):
        count = len(list(equal))
        found += [(chunk, count)] if chunk.width == 1 else [(chunk, 1)] * count
    return found


def _joined(parts: list[Expression]) -> Expression:
    return Expression(f"{{{', '.join(each.text for each in parts)}}}")


def _signed(operand: Expression) -> Expression:
    return Expression(f"$signed({operand.text})")


def _unsigned(operand: Expression) -> Expression:
    return Expression(f"$unsigned({operand.text})")
