"""Mistakes that rosbags accepts although ROS refuses them.

Each entry finds one kind of mistake without firm-hdl's reader, and corrects it. The corrected text
is judged. If rosbags accepts a text that we refuse, and no entry finds a mistake in it, this is a
difference.
"""

from __future__ import annotations

import re
from dataclasses import replace

from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.known.rule import Line, Rules, by_lines
from firm_hdl.verify.ts1.known.texts import FLOATS, INTEGERS, TEXTS, float_of, integer_of, limits

__all__ = ["RULES"]

RULES = Rules("rosbags", is_mistake=True)
"""Mistakes that rosbags accepts."""
_PRIMITIVES = {*INTEGERS, *FLOATS, *TEXTS, "bool"}

# Names of ROS 2.

_FIELD_NAME = re.compile(r"(?!.*__)(?!.*_$)[a-z][a-z0-9_]*")
_CONSTANT_NAME = re.compile(r"[A-Z](?:[A-Z0-9_]?[A-Z0-9]+)*")
_TYPE_NAME = re.compile(r"(?:[a-z][a-z0-9_]*/(?:msg/)?)?[A-Z][A-Za-z0-9]*")
_WORD = re.compile(r"[A-Za-z]\w*", re.ASCII)


@RULES.lines(
    "rosbags-names",
    "rosbags takes names of fields and constants that ROS 2 refuses.",
    dialect="ros2",
)
def _legal_names(line: Line, case: DefinitionCase) -> Line:
    pattern = _CONSTANT_NAME if line.equals else _FIELD_NAME
    if pattern.fullmatch(line.name) or not _WORD.fullmatch(line.name):
        return line
    code = line.name.encode().hex()
    return replace(line, name=f"RENAMED{code.upper()}" if line.equals else f"renamed{code}")


@RULES.unavoidable(
    "rosbags-type-names",
    "rosbags takes names of messages that ROS 2 refuses, which no other text can mend.",
    dialect="ros2",
)
def _has_illegal_type(case: DefinitionCase) -> bool:
    """Whether a message, or one that it needs, has a name that ROS 2 does not allow."""
    if case.dialect != "ros2":
        return False
    found: list[str] = [case.name]

    def look(line: Line, case: DefinitionCase) -> Line:
        if line.base not in _PRIMITIVES:
            found.append(line.base)
        return line

    by_lines(look)(case)
    return not all(map(_TYPE_NAME.fullmatch, found))


# Names that are declared twice.


@RULES.text("rosbags-twice", "rosbags takes what is declared twice.")
def _distinct(case: DefinitionCase) -> str:
    seen: dict[str, int] = {}

    def change(line: Line, case: DefinitionCase) -> Line:
        if line.equals and case.dialect == "ros1":  # ROS 1 allows constants that are repeated.
            return line
        count = seen[line.name] = seen.get(line.name, 0) + 1
        suffix = f"{'TWICE' if line.equals else 'twice'}{count}"
        return line if count == 1 else replace(line, name=f"{line.name}{suffix}")

    return by_lines(change)(case)


# Values.


def _is_value(kind: str, value: str, case: DefinitionCase) -> bool:
    """Whether a text is a value of a scalar type without a bound."""
    if kind in INTEGERS:
        number = integer_of(value, case.dialect)
        least, most = limits(kind, case.dialect)
        return number is not None and least <= number <= most
    if kind in FLOATS:
        return float_of(value) is not None
    if kind != "bool":
        return kind in TEXTS
    if case.dialect == "ros2":
        return value.lower() in ("true", "false", "0", "1")
    return value in ("True", "False") or integer_of(value, "ros2") is not None


def _fits(line: Line, case: DefinitionCase) -> bool:
    """Whether the value of a constant, or a default, fits its type."""
    match = re.fullmatch(r"(\w+)(?:<=(\d+))?(?:\[(<=)?(\d*)\])?", line.type)
    if match is None or match[1] not in _PRIMITIVES:
        return False
    kind, bound, at_most, count = match.groups()
    if "[" not in line.type:
        return _is_value(kind, line.value, case) and _is_short(line.value, bound)
    if line.value[:1] != "[" or line.value[-1:] != "]":
        return False
    if kind in TEXTS:  # Texts may have commas in quotes, so lists of texts are not checked.
        return True
    items = [each.strip() for each in line.value[1:-1].split(",")] if line.value != "[]" else []
    is_long = count and (len(items) > int(count) if at_most else len(items) != int(count))
    return not is_long and all(_is_value(kind, each, case) for each in items)


def _is_short(value: str, bound: str | None) -> bool:
    return bound is None or len(value.strip("\"'")) <= int(bound)


@RULES.lines("rosbags-values", "rosbags takes values that do not fit their types.")
def _fitting_values(line: Line, case: DefinitionCase) -> Line:
    if line.equals:
        is_legal = line.type not in _PRIMITIVES or _is_value(line.type, line.value, case)
        if is_legal:
            return line
        legal = {"bool": "false" if case.dialect == "ros2" else "False"}
        return line.with_value(legal.get(line.type, "0.0" if line.type in FLOATS else "0"))
    if case.dialect == "ros1" or not line.value or _fits(line, case):
        return line
    return line.without_value()


# Forms of types.


@RULES.lines(
    "rosbags-sizes", "rosbags takes arrays and bounds of 0, and in ROS 1 sizes with a sign."
)
def _legal_sizes(line: Line, case: DefinitionCase) -> Line:
    def size(match: re.Match[str]) -> str:
        is_legal = int(match[2]) > 0 and (case.dialect == "ros2" or match[2].isdecimal())
        return match[0] if is_legal else f"{match[1]}1"

    return replace(line, type=re.sub(r"(\[(?:<=)?|<=)([+-]?\d+)", size, line.type))


@RULES.lines("rosbags-ros2-forms", "rosbags takes bounds and defaults in ROS 1.", dialect="ros1")
def _own_forms(line: Line, case: DefinitionCase) -> Line:
    """Remove bounds and defaults, which ROS 1 does not have."""
    plain = replace(line, type=re.sub(r"<=\d+", "", line.type))
    return plain.without_value() if line.value and not line.equals else plain


@RULES.lines(
    "rosbags-blanks",
    "rosbags takes blanks in front of a line in ROS 2, and tabs between words in ROS 1.",
)
def _plain_blanks(line: Line, case: DefinitionCase) -> Line:
    if case.dialect == "ros2":
        return replace(line, indent="")
    return replace(line, gap=line.gap.replace("\t", " "))


@RULES.text("rosbags-annotations", "rosbags takes lines like @key.")
def _without_annotations(case: DefinitionCase) -> str:
    return re.sub(r"(?m)^[ \t]*@[a-z]+[ \t]*(?:\n|$)", "", case.text)
