"""Definitions in ``.msg`` that rosbags refuses, or reads differently from ROS.

Mistakes that rosbags accepts and ROS refuses are in `firm_hdl.verify.ts1.known.lenient`.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from firm_hdl.model import (
    Array,
    Field,
    Message,
    Sequence,
    String,
)
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.known.rule import (
    Line,
    Rules,
    mend_constants,
    mend_members,
    rebuild,
    types_back,
    whole_bool,
)
from firm_hdl.verify.ts1.known.texts import (
    FLOATS,
    INTEGERS,
    TEXTS,
    float_of,
    hidden,
    integer_of,
    renamed,
    renamed_back,
    shown,
)

__all__ = ["RULES"]

RULES = Rules("rosbags")
"""Definitions that rosbags refuses or reads differently."""


@RULES.text("rosbags-crlf", "rosbags refuses lines that end in CR LF.")
def _line_ends(case: DefinitionCase) -> str:
    return case.text.replace("\r\n", "\n").replace("\r", "\n")


# wstring.


def _narrow(message: Message) -> Message:
    def narrow(item: Field) -> Field:
        kind: Any = item.type
        match kind:
            case String():
                kind = replace(kind, wide=False)
            case Array(element=String() as text) | Sequence(element=String() as text):
                kind = replace(kind, element=replace(text, wide=False))
        return replace(item, type=kind)

    return replace(message, fields=tuple(map(narrow, message.fields)))


@RULES.lines(
    "rosbags-wstring",
    "rosbags does not know wstring.",
    dialect="ros2",
    theirs=types_back("wstring", "string"),
    hashed=rebuild(_narrow),
)
def _narrow_lines(line: Line, case: DefinitionCase) -> Line:
    return replace(line, type=line.type[1:]) if line.base == "wstring" else line


# Names of constants. In ROS 1, any name is allowed.

_UPPER = re.compile(r"[A-Z](?:_?[A-Z0-9]+)*")
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


@RULES.lines(
    "rosbags-special-types",
    "rosbags takes time, duration and Header for builtin types where ROS does not.",
)
def _own_types(line: Line, case: DefinitionCase) -> Line:
    """Write the package of a type that is special to rosbags, but not to ROS."""
    is_special = line.base in ("time", "duration", "Header")
    if case.dialect == "ros1":
        is_special = line.base == "Header" and line.type != "Header"
    return replace(line, type=f"{case.package}/{line.type}") if is_special else line


@RULES.lines(
    "rosbags-constant-names",
    "rosbags takes constants with lower-case letters for fields, or refuses them.",
    dialect="ros1",
    theirs=mend_constants(renamed_back),
)
def _upper_lines(line: Line, case: DefinitionCase) -> Line:
    is_legal = line.equals and _NAME.fullmatch(line.name)
    if not is_legal or _UPPER.fullmatch(line.name):
        return line
    return replace(line, name=renamed(line.name))


# The name of the field that rosbags adds to messages without fields; on purpose not that of the
# model, which rosbags judges.

_PLACEHOLDER, _STAND_IN = "structure_needs_at_least_one_member", "structure_has_one_more_member"


def _placeholder_back(field: dict[str, Any]) -> dict[str, Any]:
    return {**field, "name": _PLACEHOLDER} if field["name"] == _STAND_IN else field


def _with_stand_in(message: Message) -> Message:
    fields = (
        replace(item, name=_STAND_IN) if item.name == _PLACEHOLDER else item
        for item in message.fields
    )
    return replace(message, fields=tuple(fields))


@RULES.lines(
    "rosbags-placeholders",
    "rosbags takes a field of this name for the one that messages without fields get.",
    theirs=mend_members("fields", _placeholder_back),
    hashed=rebuild(_with_stand_in),
)
def _plain_placeholders(line: Line, case: DefinitionCase) -> Line:
    is_one = line.name == _PLACEHOLDER and not line.equals
    return replace(line, name=_STAND_IN) if is_one else line


# Texts: rosbags looks for numbers and quotes in them, but not for escapes and comments.


def _text_of(line: Line, case: DefinitionCase) -> str | None:
    """Return the text that a line gives, as ROS reads it; `None` if ROS refuses it."""
    if case.dialect == "ros1":
        return line.rest.strip()
    value = line.value
    quote = value[:1]
    if quote not in ("'", '"') or not value.endswith(quote):
        return value
    inner = value[1:-1]
    if re.search(rf"(?<!\\){quote}", inner):
        return None
    return inner.replace(f"\\{quote}", quote)


def _show_text(constant: dict[str, Any]) -> dict[str, Any]:
    return {**constant, "value": shown(constant["value"])}


@RULES.lines(
    "rosbags-texts",
    "rosbags takes texts without quotes for numbers, and knows neither escapes nor comments.",
    theirs=mend_constants(_show_text),
)
def _quoted_lines(line: Line, case: DefinitionCase) -> Line:
    is_field = not line.equals and case.dialect == "ros2" and line.value and "[" not in line.type
    if line.base not in TEXTS or not (line.equals or is_field):
        return line
    text = _text_of(line, case)
    if text is None:
        return line
    quoted = f'"{hidden(text, _SIGNS)}"'
    return replace(line, rest=quoted if line.equals else f" {quoted}")


RULES.add(
    "rosbags-constant-bool",
    "rosbags keeps a bool constant that is written as a number as a number.",
    theirs=mend_constants(whole_bool),
)


_SIGNS = "\"'\\"


# Numbers.


@RULES.lines("rosbags-integers", "rosbags reads 010 as 8, and does not know 1_000 and 0o17.")
def _decimal_lines(line: Line, case: DefinitionCase) -> Line:
    """Write integers without leading zeros and underscores, and without bases that ROS 1 lacks."""
    if "[" in line.type or line.base not in INTEGERS or "x" in line.value.lower():
        return line
    number = integer_of(line.value, case.dialect)
    return line if number is None else line.with_value(str(number))


_FRACTION = re.compile(
    r"[+-]?\d+\.\d*(?:e[+-]?\d+)?|\.\d+(?:e[+-]?\d+)?|[+-]?\d+e[+-]?\d+", re.IGNORECASE
)


def _float_constant(constant: dict[str, Any]) -> dict[str, Any]:
    # rosbags has infinities and NaN as texts.
    number = float_of(constant["value"]) if isinstance(constant["value"], str) else None
    if constant["type"] not in FLOATS or number is None:
        return constant
    return {**constant, "value": number}


@RULES.lines(
    "rosbags-floats",
    "rosbags takes floating-point numbers for such only if they have digits and a point.",
    theirs=mend_constants(_float_constant),
)
def _fraction_lines(line: Line, case: DefinitionCase) -> Line:
    """Write floating-point numbers with digits and a point, or an exponent."""
    if "[" in line.type or line.base not in FLOATS or _FRACTION.fullmatch(line.value):
        return line
    number = float_of(line.value)
    return line if number is None else line.with_value(repr(number))


@RULES.lines(
    "rosbags-char-hash",
    "rosbags hashes char of a .msg as a character, and rosidl as a uint8.",
    dialect="ros2",
    theirs=types_back("char", "uint8"),
)
def _uint8_lines(line: Line, case: DefinitionCase) -> Line:
    return replace(line, type=f"uint8{line.type[4:]}") if line.base == "char" else line
