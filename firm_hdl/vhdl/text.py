"""Pieces of VHDL text: expressions with their precedence, literals, lines of at most 100 columns.

IEEE Std 1076-2008, clause 9.2 (operators and their precedence) and 15.8 (bit string literals).
"""

from __future__ import annotations

import textwrap
from typing import NamedTuple

__all__ = [
    "Expression",
    "atom",
    "bit_literal",
    "call",
    "chain",
    "infix",
    "literal",
    "prefix",
    "wrap",
]

COLUMNS = 100

_LEVELS = {
    **dict.fromkeys(("and", "or", "xor"), 1),
    **dict.fromkeys(("=", "/=", "<", "<=", ">", ">="), 2),
    **dict.fromkeys(("+", "-", "&"), 4),
    "*": 5,
    "not": 6,
    # A reduction such as `or x`, which VHDL does not combine with other operators.
    "reduce": 0,
}
_ATOM = 9

# Where a line is broken, in VHDL and in Verilog.
_ENDS = (" and", " or", " xor", " &", ",", " else", " <=", " &&", " ||", " |", " ?", " :", " =")


class Expression(NamedTuple):
    """An expression; its outermost `operator` decides whether it needs parentheses."""

    text: str
    operator: str = ""

    @property
    def level(self) -> int:
        """Precedence of the outermost operator; a higher level binds more strongly."""
        return _LEVELS.get(self.operator, _ATOM)

    def inside(self, level: int) -> str:
        """Return the text, in parentheses if the place needs a higher level."""
        return self.text if self.level >= level else f"({self.text})"


def atom(text: str) -> Expression:
    """Make an expression that never needs parentheses."""
    return Expression(text)


def call(function: str, *arguments: Expression | str | int) -> Expression:
    """Call a function."""
    parts = (part.text if isinstance(part, Expression) else str(part) for part in arguments)
    return Expression(f"{function}({', '.join(parts)})")


def prefix(operator: str, operand: Expression) -> Expression:
    """Apply `not`, or a reduction such as `or`."""
    return Expression(
        f"{operator} {operand.inside(_ATOM)}", "not" if operator == "not" else "reduce"
    )


def infix(operator: str, left: Expression, right: Expression) -> Expression:
    """Apply a binary operator. The left operand may have the same operator without parentheses."""
    level = _LEVELS[operator]
    if level == 1:
        # Without parentheses, VHDL allows neither mixed logical operators nor `not` of a relation.
        return chain(operator, left, right)
    strict = level + (level == 2)
    return Expression(f"{left.inside(strict)} {operator} {right.inside(level + 1)}", operator)


def chain(operator: str, *operands: Expression) -> Expression:
    """Join any number of operands by an associative operator."""
    if len(operands) == 1:
        return operands[0]
    level = _LEVELS[operator]
    parts = (
        part.text if part.operator == operator else part.inside(level + 1) for part in operands
    )
    return Expression(f" {operator} ".join(parts), operator)


def bit_literal(bits: str) -> str:
    """Write one bit; an undefined bit is 0, as in Amaranth's simulator."""
    return "'1'" if bits == "1" else "'0'"


def literal(bits: str) -> str:
    """Write a string of bits as the shortest literal of exactly that width."""
    bits = "".join("1" if bit == "1" else "0" for bit in bits)
    width = len(bits)
    if width <= 8:
        return f'"{bits}"'
    digits = f"{int(bits, 2):0{-(-width // 4)}X}"
    return f'x"{digits}"' if width % 4 == 0 else f'{width}x"{digits}"'


def wrap(line: str, remark: str = "--") -> list[str]:
    """Break a line of code that is too long, at spaces outside of strings.

    If the line ends with a comment, the comment is written on its own line before the code.
    """
    indent = " " * (len(line) - len(line.lstrip()))
    code, mark, comment = line.partition(f"  {remark} ")
    if len(line) > COLUMNS and mark and code.strip():
        start = f"{indent}{remark} "
        comments = textwrap.wrap(comment, COLUMNS, initial_indent=start, subsequent_indent=start)
        return [*comments, *wrap(code, remark)]
    if not code.strip() or code.lstrip().startswith(remark):
        return [line]
    lines: list[str] = []
    while len(line) > COLUMNS and (cut := _break(line, len(indent) + 4)):
        lines.append(line[:cut])
        line = f"{indent}    {line[cut + 1 :]}"
    return [*lines, line]


def _break(line: str, start: int) -> int:
    """Find the last good space to break at, preferably after a logical operator or a comma."""
    best, quoted = 0, False
    any_space = 0
    for index, character in enumerate(line[: COLUMNS + 1]):
        if character == '"':
            quoted = not quoted
        elif character == " " and not quoted and index > start:
            any_space = index
            if line[:index].endswith(_ENDS):
                best = index
    return best if best > COLUMNS // 2 else any_space
