"""Deliberate differences from ROS's own readers of ``.msg``, ``.srv`` and ``.action``."""

from __future__ import annotations

import ast
import math
import re
import unicodedata
from dataclasses import replace
from itertools import groupby
from typing import Any

from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.known.rule import (
    Line,
    Rules,
    by_lines,
    each_line,
    mend_members,
    mend_messages,
    mend_values,
)
from firm_hdl.verify.ts1.known.texts import FLOATS, TEXTS, float_of, hidden, renamed, shown

__all__ = ["MISTAKES", "RULES"]

MISTAKES = Rules("genmsg", is_mistake=True)
"""Mistakes that readers of ROS accept."""
RULES = Rules("rosidl_parser")
"""Definitions that rosidl reads differently from firm-hdl."""


@MISTAKES.lines(
    "ros1-indented-texts", "genmsg takes an indented string constant for one called 'string X'."
)
def _no_indent(line: Line, case: DefinitionCase) -> Line:
    return replace(line, indent="") if line.type == "string" and line.equals else line


def _ascii(text: str) -> str:
    """Write letters, digits and blanks of other scripts in ASCII."""

    def sign(character: str) -> str:
        if character.isascii():
            return character
        if character.isdecimal():
            return str(unicodedata.decimal(character))
        if character.isspace():
            return " "
        return f"x{ord(character):x}" if character.isalnum() else character

    return "".join(map(sign, text))


@MISTAKES.text(
    "ascii-only",
    "Names and numbers are written in ASCII.",
    oracles="genmsg rosidl_adapter rosidl_parser",
)
def _ascii_lines(case: DefinitionCase) -> str:
    if case.language == "idl":
        parts = re.split(r'("(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/)', case.text, flags=re.DOTALL)
        return "".join(part if index % 2 else _ascii(part) for index, part in enumerate(parts))

    def line(text: str) -> str:
        is_text = text.partition("#")[0].split(maxsplit=1)[:1] in (["string"], ["wstring"])
        code, sign, rest = text.partition("=" if is_text else "#")
        # The value of a string constant is left alone, and so is all that follows it.
        return f"{_ascii(code)}{sign}{rest}" if sign or not is_text else text

    return each_line(case.text, line)


_CONSTANT = re.compile(r"(\s*)(\w+)( +)(.*?)( *=.*)", re.DOTALL)
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


@MISTAKES.text("ros1-constant-names", "genmsg takes anything for the name of a constant.")
def _legal_constant_names(case: DefinitionCase) -> str:
    # The name may have blanks in it, so the line cannot be a `Line`.
    def legal(line: str) -> str:
        match = _CONSTANT.fullmatch(line)
        if match is None or "=" not in line.partition("#")[0] or _NAME.fullmatch(match[4]):
            return line
        indent, kind, gap, name, rest = match.groups()
        return f"{indent}{kind}{gap}{renamed(name)}{rest}"

    return each_line(case.text, legal)


@MISTAKES.lines("ros1-bool-literals", "genmsg takes any literal of Python for a truth value.")
def _plain_bools(line: Line, case: DefinitionCase) -> Line:
    """Write truth values as ``True`` and ``False``."""
    if line.type != "bool" or not line.equals or line.value in ("True", "False"):
        return line
    try:
        value = ast.literal_eval(line.value)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return line
    return line.with_value(str(bool(value)))


@MISTAKES.lines(
    "ros1-64-bit-limits",
    "genmsg compares with rounded limits, and takes one more than 64 bits hold.",
)
def _within_64_bits(line: Line, case: DefinitionCase) -> Line:
    limits = {"int64": 1 << 63, "uint64": 1 << 64}
    if not line.equals or line.type not in limits:
        return line
    try:
        number = int(line.value)
    except ValueError:
        return line
    # The rounded limits let one number through that is too large by 1.
    return line.with_value(str(number - 1)) if number == limits[line.type] else line


@MISTAKES.lines("ros1-empty-arrays", "genmsg takes arrays of no elements.")
def _arrays_of_one(line: Line, case: DefinitionCase) -> Line:
    return replace(line, type=re.sub(r"\[0+\]$", "[1]", line.type))


_LARGEST = 2**32 - 1


@MISTAKES.text(
    "sizes-of-32-bits",
    "Every wire format counts elements in 32 bits, and so do we.",
    oracles="genmsg rosidl_adapter rosidl_parser rosbags",
)
def _sizes(case: DefinitionCase) -> str:
    """Replace sizes and bounds of more than 32 bits by the largest number of 32 bits."""

    def size(match: re.Match[str]) -> str:
        return match[1] + (match[2] if int(match[2]) <= _LARGEST else str(_LARGEST))

    if case.language == "idl":
        return re.sub(r"([<\[,]\s*)(\d+)(?=\s*[>\]])", size, case.text)

    def change(line: Line, case: DefinitionCase) -> Line:
        return replace(line, type=re.sub(r"(\[(?:<=)?|<=)([0-9_]+)", size, line.type))

    return by_lines(change)(case)


# rosidl.


def _unquoted(element: Any) -> Any:
    if not isinstance(element, str):
        return element
    text = shown(element)
    is_quoted = text != element and text[:1] == text[-1:] and text[:1] in ("'", '"')
    return text[1:-1] if is_quoted else text


def _unquoted_default(field: dict[str, Any]) -> dict[str, Any]:
    """Restore quotes in texts, and remove those around an element, as rosidl_adapter does."""
    default = field["default"]
    if not isinstance(default, list):
        return field
    return {**field, "default": [_unquoted(each) for each in default]}


@RULES.lines(
    "ros2-escaped-quotes",
    "rosidl_adapter loses count of escaped quotes in a list of strings.",
    oracles="rosidl_adapter rosidl_parser",
    theirs=mend_members("fields", _unquoted_default),
)
def _no_escaped_quotes(line: Line, case: DefinitionCase) -> Line:
    """Replace escaped quotes in lists by the placeholder characters of `hidden`."""
    if line.equals or line.base not in TEXTS or not line.value.startswith("["):
        return line

    def element(match: re.Match[str]) -> str:
        return re.sub(r"\\([\"'])", lambda found: hidden(found[1], found[1]), match[0])

    return line.with_code(lambda code: _QUOTED.sub(element, code))


_QUOTED = re.compile(r"""\"(?:[^"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'""")


@RULES.lines(
    "ros2-backslashes",
    "rosidl_adapter copies backslashes into IDL, where rosidl_parser takes them for escapes.",
    theirs=mend_values(lambda _, value: shown(value)),
)
def _no_backslashes(line: Line, case: DefinitionCase) -> Line:
    """Replace backslashes that escape no quote by the placeholder characters of `hidden`."""
    if line.base not in TEXTS:
        return line
    return line.with_code(
        lambda code: re.sub(r"\\(?![\"'])", lambda found: hidden(found[0], "\\"), code)
    )


# Finite numbers that stand for infinity and NaN, which IDL cannot write.
_INFINITE, _NO_NUMBER = "1.25e300", "1.75e300"


def _float_back(value: Any) -> Any:
    if isinstance(value, list):
        return [_float_back(each) for each in value]
    if not isinstance(value, float):
        return value
    stand_ins = {float(_INFINITE): math.inf, float(_NO_NUMBER): math.nan}
    return math.copysign(stand_ins.get(abs(value), abs(value)), value)


@RULES.lines(
    "ros2-infinite-numbers",
    "rosidl_adapter writes inf and nan into IDL, where they are names.",
    theirs=mend_values(lambda _, value: _float_back(value)),
)
def _plain_floats(line: Line, case: DefinitionCase) -> Line:
    """Replace infinities and NaNs by the finite numbers that stand for them."""
    if line.base not in FLOATS:
        return line

    def word(match: re.Match[str]) -> str:
        number = float_of(match[0])
        if number is None or math.isfinite(number):
            return match[0]
        sign = "-" if match[0].startswith("-") else ""
        return sign + (_NO_NUMBER if math.isnan(number) else _INFINITE)

    return line.with_code(lambda code: re.sub(r"[^][, ]+", word, code))


def _without_blanks(comment: str) -> str:
    lines = [line.rstrip() for line in comment.split("\n")]
    kept: list[str] = []
    for is_empty, group in groupby(lines, key=lambda line: line == ""):
        kept += [""] if is_empty else group
    return "\n".join(kept).strip("\n")


RULES.add(
    "ros2-comment-blanks",
    "Blanks at the end of a comment's lines, and empty lines, do not count for us.",
    oracles="rosidl_adapter",
    theirs=mend_messages(
        lambda message: {**message, "comment": _without_blanks(message.get("comment", ""))}
    ),
)
