"""Evaluate expressions, and check that their values fit their types.

Expressions are those of OMG IDL 4.2, 7.4.1.4.3. rosidl_parser reads only one literal with a sign,
or one name. Strings have the values of rosidl_parser, because ROS 2 programs see these values.
rosidl_parser undoes backslashes twice.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from typing import Literal, NamedTuple, TypeAlias

from firm_hdl.errors import Diagnostic, Span
from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.idl.tree import (
    Chain,
    Expression,
    LiteralSyntax,
    ScopedName,
    Unary,
)
from firm_hdl.model import IDL_PRIMITIVES

__all__ = [
    "AlreadyReportedError",
    "IdlError",
    "Lookup",
    "UnknownNameError",
    "Value",
    "evaluate",
    "fit",
]


class IdlError(Exception):
    """An error in a part of a file. Callers that do not need the part collect such errors."""

    def __init__(self, message: str, span: Span) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic(message, span)


class UnknownNameError(IdlError):
    """Raised for names that are not declared; rosidl_parser does not check all of them."""


class AlreadyReportedError(IdlError):
    """Raised for a part that depends on a declaration whose error has been reported."""


class Value(NamedTuple):
    """A value and the kind of its literal; the kind decides where the value may be used."""

    kind: Literal["integer", "float", "character", "boolean", "text"]
    value: bool | int | float | str


Lookup: TypeAlias = Callable[[ScopedName], Value]
"""Gives the value of a constant, or raises `IdlError`."""

_LOWEST, _HIGHEST = -(2**63), 2**64 - 1

_ESCAPES = {
    "n": "\n",
    "t": "\t",
    "v": "\v",
    "b": "\b",
    "r": "\r",
    "f": "\f",
    "a": "\a",
    "\\": "\\",
    "'": "'",
    '"': '"',
}
_ESCAPE = re.compile(r"\\(?:([ntvbrfa\\'\"])|([0-7]{1,3})|x([0-9A-Fa-f]{1,2})|(u[0-9A-Fa-f]{1,4}))")


def evaluate(expression: Expression, lookup: Lookup, bits: int | None = None) -> Value:
    """Evaluate an expression.

    * `bits`: number of bits that `~` inverts: the size of the target type if that type is unsigned.

    Raises `IdlError` if the expression has no value.
    """
    match expression:
        case ScopedName():
            return lookup(expression)
        case LiteralSyntax():
            return _literal(expression)
        case Unary():
            operand = evaluate(expression.operand, lookup, bits)
            return _unary(expression.operator, operand, bits, expression.span)
        case Chain():
            first, *others = expression.operands
            left = evaluate(first, lookup, bits)
            for sign, other in zip(expression.operators, others, strict=True):
                left = _binary(left, sign, evaluate(other, lookup, bits), expression.span)
            return left


def fit(value: Value, name: str, span: Span) -> bool | int | float | str:
    """Convert a value to a type.

    * `name`: a key of `IDL_PRIMITIVES`, ``string`` or ``wstring``.

    Raises `IdlError` if the value does not fit the type.
    """
    kind, content = value
    if name in ("string", "wstring"):
        if kind != "text":
            raise IdlError(f"expected a string, not {_KINDS[kind]}", span)
        return content
    primitive = IDL_PRIMITIVES[name]
    if primitive.kind == "bool":
        if content not in (0, 1) or kind not in ("boolean", "integer"):
            raise IdlError("expected TRUE or FALSE", span)
        return bool(content)
    if primitive.kind == "float":
        if kind not in ("integer", "float"):
            raise IdlError(f"expected a number, not {_KINDS[kind]}", span)
        return float(content)
    if kind == "character" and name in ("char", "wchar"):
        assert isinstance(content, int)
        # A signed char holds the upper half of Latin-1 as negative numbers.
        content = content - 256 if name == "char" and 127 < content < 256 else content
    elif kind != "integer":
        raise IdlError(f"expected an integer, not {_KINDS[kind]}", span)
    bits = 8 * primitive.bytes - primitive.signed
    low, high = -(2**bits) if primitive.signed else 0, 2**bits - 1
    assert isinstance(content, int)
    if not low <= content <= high:
        raise IdlError(f"the value of {primitive} must be in {low}..{high}", span)
    return content


_KINDS = {
    "integer": "an integer",
    "float": "a number with a fraction",
    "character": "a character",
    "boolean": "a boolean",
    "text": "a string",
}


def _literal(literal: LiteralSyntax) -> Value:
    span = literal.span
    (word, *_) = literal.parts
    match literal.kind:
        case "integer":
            digits = word.lstrip("0xX")
            # A longer number fits no type, and Python refuses to read very long numbers.
            if len(digits) > 30:
                raise IdlError(f"a number of {len(digits)} digits is too long", span)
            base = 16 if word[:2] in ("0x", "0X") else 8 if word[0] == "0" else 10
            return _checked(int(word, base), span)
        case "float" | "fixed":
            number = float(word.rstrip("dD"))
            if not math.isfinite(number):
                raise IdlError("this value is too large", span)
            return Value("float", number)
        case "boolean":
            return Value("boolean", word == "TRUE")
        case "character":
            wide = word.startswith("L")
            text = _unescape(word[1 + wide : -1], True, span)
            text = "?" if text == "\\?" else text
            if len(text) != 1:
                raise IdlError(f"{clip(word)} is not one character", span)
            return Value("character", ord(text))
        case "string":
            return Value("text", "".join(_text(w[1:-1], False, span) for w in literal.parts))
        case "wstring":
            return Value("text", "".join(_text(w[2:-1], True, span) for w in literal.parts))


def _text(text: str, wide: bool, span: Span) -> str:
    """Undo escapes twice, as rosidl_parser does: one backslash is written as four."""
    return re.sub(r'\\(["\\])', r"\1", _unescape(text, wide, span))


def _unescape(text: str, wide: bool, span: Span) -> str:
    def character(match: re.Match[str]) -> str:
        simple, octal, hexadecimal, long = match.groups()
        if simple:
            return _ESCAPES[simple]
        if octal:
            return chr(int(octal, 8))
        if long and not wide:
            return match.group()
        digits = hexadecimal or long[1:]
        want = 2 if hexadecimal else 4
        if len(digits) != want:
            message = f"escape '{match.group()}' needs {want} hexadecimal digits"
            raise IdlError(message, span)
        code = int(digits, 16)
        if 0xD800 <= code < 0xE000:
            raise IdlError(f"escape '{match.group()}' is half of a surrogate pair", span)
        return chr(code)

    return _ESCAPE.sub(character, text)


def _unary(sign: str, operand: Value, bits: int | None, span: Span) -> Value:
    kind, value = operand
    if kind == "integer" and sign == "~":
        assert isinstance(value, int)
        return _checked(2**bits - 1 - value if bits else ~value, span)
    if kind not in ("integer", "float") or sign == "~":
        what = "an integer" if sign == "~" else "a number"
        raise IdlError(f"{what} must follow '{sign}', not {_KINDS[kind]}", span)
    assert isinstance(value, int | float)
    if kind == "float":
        return Value("float", -value if sign == "-" else value)
    return _checked(int(-value if sign == "-" else value), span)


_INTEGERS: dict[str, Callable[[int, int], int]] = {
    "|": operator.or_,
    "^": operator.xor,
    "&": operator.and_,
    "<<": operator.lshift,
    ">>": operator.rshift,
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    # Rounded towards zero, as in C.
    "/": lambda a, b: abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1),
    "%": lambda a, b: abs(a) % abs(b) * (-1 if a < 0 else 1),
}
_FLOATS: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}


def _binary(left: Value, sign: str, right: Value, span: Span) -> Value:
    a, b = left.value, right.value
    for kind, _ in (left, right):
        if kind not in ("integer", "float"):
            raise IdlError(f"'{clip(sign)}' is for numbers, not for {_KINDS[kind]}", span)
    if sign not in _INTEGERS:
        raise IdlError(f"'{clip(sign)}' must be written without blanks", span)
    if b == 0 and sign in "/%":
        raise IdlError("division by zero", span)
    if left.kind == right.kind == "integer":
        assert isinstance(a, int) and isinstance(b, int)
        if sign in ("<<", ">>") and not 0 <= b < 64:
            raise IdlError("a shift must be by 0 to 63 places", span)
        return _checked(_INTEGERS[sign](a, b), span)
    if sign not in _FLOATS:
        raise IdlError(f"'{sign}' is for integers, not for a number with a fraction", span)
    assert isinstance(a, int | float) and isinstance(b, int | float)
    result = _FLOATS[sign](float(a), float(b))
    if not math.isfinite(result):
        raise IdlError("this value is too large", span)
    return Value("float", result)


def _checked(value: int, span: Span) -> Value:
    """Limit numbers to 64 bits, so that no expression takes long."""
    if not _LOWEST <= value <= _HIGHEST:
        raise IdlError("this value does not fit 64 bits", span)
    return Value("integer", value)
