"""Constants, expressions and typedefs in IDL, some of which rosidl_parser does not evaluate.

rosidl_parser accepts only a single literal as a value. This module computes values by Python's own
rules for integers, without code of firm-hdl's reader, and writes them in place of expressions.
"""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping

from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.known.idl_text import (
    DECLARED,
    TYPEDEF,
    blanked,
    changed,
    modules_of,
)
from firm_hdl.verify.ts1.known.rule import Rules, mend_constants, whole_bool
from firm_hdl.verify.ts1.known.texts import renamed, renamed_back

__all__ = ["RULES", "integer_of", "integers_of"]

RULES = Rules("rosidl_parser", language="idl")
"""Known differences from rosidl_parser in values of IDL."""

# Expressions.

_OPERATORS: Mapping[type[ast.AST], Callable[..., int]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: lambda one, other: int(one / other) if other else 0,
    ast.Mod: operator.mod,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
    ast.BitAnd: operator.and_,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Invert: operator.invert,
}
_MOST = 1 << 64
_ESCAPE = re.compile(r"L?'(?:\\x([0-9A-Fa-f]{1,2})|\\u([0-9A-Fa-f]{1,4})|\\(n)|([^\\']))'")


_PYTHON_ONLY = re.compile(r"\b0[bo]|\b\d\w*_", re.IGNORECASE)
_TWO_SIGNS = re.compile(r"(?:^|[(*/%&|^<>+~-])\s*[-+~]\s*[-+~]")


def integer_of(expression: str, names: Mapping[str, int], modules: set[str]) -> int | None:
    """Evaluate an expression; `None` if it is not an integer, or not one in IDL."""
    scopes = re.findall(r"(\w+)\s*::", expression)
    is_odd = _TWO_SIGNS.search(expression) or _PYTHON_ONLY.search(expression)
    if is_odd or not modules.issuperset(scopes):
        return None
    text = re.sub(r"(?:::)?\b(?:\w+::)+(?=\w)", "", expression.strip())
    text = re.sub(r"(?<![\w.])0(?=[0-7]+\b)", "0o", text)
    text = _ESCAPE.sub(lambda match: str(_character(match)), text)
    if "#" in text:
        # Python would read a comment.
        return None
    try:
        return _worked_out(ast.parse(text, mode="eval").body, names)
    except (SyntaxError, ValueError, KeyError, OverflowError, MemoryError, RecursionError):
        return None


def _character(match: re.Match[str]) -> int:
    hexadecimal, wide, newline, plain = match.groups()
    if newline:
        return 10
    return ord(plain) if plain else int(hexadecimal or wide, 16)


def _worked_out(node: ast.expr, names: Mapping[str, int]) -> int:
    match node:
        case ast.Constant(value=int() as value) if type(value) is int:
            found = value
        case ast.Name(id=name):
            found = names[name]
        case ast.UnaryOp(op=sign, operand=operand):
            found = _OPERATORS[type(sign)](_worked_out(operand, names))
        case ast.BinOp(left=left, op=sign, right=right):
            one, other = _worked_out(left, names), _worked_out(right, names)
            if isinstance(sign, ast.LShift) and other > 64:
                raise OverflowError
            found = _OPERATORS[type(sign)](one, other)
        case _:
            raise ValueError
    if abs(found) > _MOST:
        raise OverflowError
    return found


# Typedefs.


def _paths(code: str) -> list[str]:
    """List the full names that typedefs declare."""
    found: list[str] = []
    scopes: list[str] = []
    for mark in re.finditer(rf"\bmodule\s+(\w+)\s*{{|[{{}}]|{TYPEDEF.pattern}", code):
        if mark[3] is not None:
            found.append("::".join([*filter(None, scopes), mark[3]]))
        elif mark[0] != "}":
            scopes.append(mark[1] or "")
        elif scopes:
            scopes.pop()
    return found


@RULES.text(
    "idl-typedefs",
    "rosidl_parser does not know typedefs of typedefs, and typedefs with their scopes.",
)
def _plain_typedefs(case: DefinitionCase) -> str:
    """Write the original type in a typedef of a typedef, and typedefs without their scopes."""
    code = blanked(case.text)
    meanings: dict[str, tuple[str, str]] = {}
    changes: list[tuple[int, int, str]] = []
    for match in TYPEDEF.finditer(code):
        kind, name, size = match.groups()
        base = kind.rpartition("::")[2]
        if base in meanings and not (size and meanings[base][1]):
            kind, size = meanings[base][0], size or meanings[base][1]
            changes.append((match.start(1), match.end(3), f"{kind} {name}{size}"))
        meanings[name] = kind, size
    paths = _paths(code)
    for match in re.finditer(r"(?<![\w:])(?:::)?\b(?:\w+::)+(\w+)\b", code):
        is_one = any(
            match[0] == f"::{path}" or f"::{path}".endswith(f"::{match[0]}") for path in paths
        )
        if is_one and not any(a <= match.start() < b for a, b, _ in changes):
            changes.append((*match.span(), match[1]))
    return changed(case.text, changes)


_PLACES = re.compile(
    r"(?P<const>\bconst\s+[\w :]+?\s+\w+\s*=\s*)(?P<a>[^;]*?)(?=\s*;)"
    r"|(?P<size>\[\s*)(?P<b>[^\]]*?)(?=\s*\])"
    r"|(?P<text>\bw?string\s*<\s*)(?P<c>[^<>]*?)(?=\s*>)"
    r"|(?P<list>\bsequence\s*<[^;{}]*?,\s*)(?P<d>[^<>,;]*?)(?=\s*>)"
    r"|(?P<default>@default\s*\(\s*value\s*=\s*)(?P<e>[^\"]*?)(?=\s*\)\s*(?:@|[\w:]))"
)


def integers_of(code: str) -> dict[str, int]:
    """Evaluate the integer constants that a text declares."""
    names: dict[str, int] = {}
    modules = modules_of(code)
    for _, name, expression in DECLARED.findall(code):
        value = integer_of(expression, names, modules)
        if value is not None:
            names[name] = value
    return names


@RULES.text(
    "idl-expressions",
    "rosidl_parser knows decimal numbers and no expressions, names of constants or characters.",
)
def _literals(case: DefinitionCase) -> str:
    """Write the value of each integer expression in its place."""
    code = blanked(case.text)
    names, modules = integers_of(code), modules_of(code)
    changes: list[tuple[int, int, str]] = []
    for match in _PLACES.finditer(code):
        which = next(name for name in "abcde" if match[name] is not None)
        expression = match[which]
        if not expression or re.fullmatch(r"-?\s*(?:0|[1-9]\d*)", expression):
            continue
        if which in "bcd" and "'" in expression:  # A character is not a length or a bound.
            continue
        value = integer_of(expression, names, modules)
        if value is not None:
            changes.append((*match.span(which), str(value)))
    return changed(case.text, changes)


RULES.add(
    "idl-booleans",
    "rosidl_parser keeps a boolean constant that is written as a number a number.",
    theirs=mend_constants(whole_bool),
)


@RULES.text("idl-long-names", "rosidl_parser reads 'long longitude' as a long long called itude.")
def _long_names(case: DefinitionCase) -> str:
    """Write int32 for a long whose member name begins like the second word of a type."""
    code = blanked(case.text)
    pattern = r"\b(unsigned\s+)?long(?=\s+(?:long|double)\w+\s*[;,\[])"
    changes = [
        (*match.span(), "uint32" if match[1] else "int32")
        for match in re.finditer(pattern, code)
        if re.search(r"\blong\s+$", code[: match.start()]) is None
    ]
    return changed(case.text, changes)


@RULES.text(
    "idl-service-constants",
    "rosidl_parser gives the request what request and response both declare, twice.",
    theirs=mend_constants(renamed_back),
)
def _own_constants(case: DefinitionCase) -> str:
    """Rename constants that an earlier part of the service or action declares as well."""
    code = blanked(case.text)
    seen: set[str] = set()
    changes: list[tuple[int, int, str]] = []
    for block in re.finditer(r"\bmodule\s+\w+_Constants\s*\{([^{}]*)\}", code):
        mine: set[str] = set()
        for match in DECLARED.finditer(code, *block.span(1)):
            mine.add(match[2])
            if match[2] in seen:
                changes.append((*match.span(2), renamed(match[2])))
        seen |= mine
    return changed(case.text, changes)
