"""Values in IDL that do not fit their types, and declarations of included files.

rosidl_parser accepts any literal as a value of any type. The code that is generated from such a
value does not compile, or has other values. rosidl_parser does not look up names that an included
file declares.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from firm_hdl.model import Field, Message, Sequence, String
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.facts import Facts
from firm_hdl.verify.ts1.known.idl_text import (
    DECLARED,
    TYPEDEF,
    blanked,
    changed,
    modules_of,
)
from firm_hdl.verify.ts1.known.idl_values import integer_of, integers_of
from firm_hdl.verify.ts1.known.rule import Rules, mend_members, rebuild
from firm_hdl.verify.ts1.known.texts import limits

__all__ = ["RULES"]

RULES = Rules("rosidl_parser", language="idl")
"""Known differences from rosidl_parser in values and included files."""

_INTEGERS = {
    "int8": ("char",),
    "int16": ("short",),
    "int32": ("long",),
    "int64": ("long long",),
    "uint8": ("octet",),
    "uint16": ("unsigned short", "wchar"),
    "uint32": ("unsigned long",),
    "uint64": ("unsigned long long",),
}
"""Other names that IDL has for the integers."""

_RANGES = {
    name: limits(kind, "ros2") for kind, others in _INTEGERS.items() for name in (kind, *others)
}
_FLOATS = ("float", "double", "long double")
_NUMBER = re.compile(r"[-+]?\s*(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_WORD = re.compile(r"[A-Za-z_]\w*")


# Declarations of included files.


@RULES.text("idl-includes", "rosidl_parser does not look at included files.")
def _without_includes(case: DefinitionCase) -> str:
    """Replace names that included files declare by their values and types."""
    values: dict[str, int] = {}
    kinds: dict[str, str] = {}
    for code in map(blanked, case.included):
        values.update(integers_of(code))
        for kind, name, size in TYPEDEF.findall(code):
            if not size:
                kinds[name] = kinds.get(kind.rpartition("::")[2], kind)
    code = blanked(case.text)
    for _, name, _ in (*DECLARED.findall(code), *TYPEDEF.findall(code)):
        values.pop(name, None)
        kinds.pop(name, None)

    def meaning(match: re.Match[str]) -> str:
        before = code[: match.start()].rstrip()[-1:]
        following = code[match.end() :].lstrip()[:1]
        if match[1] in values and before in tuple("<[,(=+-*/%&|^~") and following not in ("", "="):
            return str(values[match[1]])
        is_type = match[1] in kinds and following not in tuple(";=,[")
        return kinds[match[1]] if is_type else match[0]

    if not case.included:
        return case.text
    words = re.finditer(r"(?:::)?\b(?:\w+::)*(\w+)\b", code)
    return changed(case.text, [(*match.span(), meaning(match)) for match in words])


# Annotations.


@RULES.text(
    "idl-short-annotations",
    "rosidl_parser does not understand an annotation whose only argument has no name.",
)
def _with_argument_names(case: DefinitionCase) -> str:
    """Write the name of the argument of ``@default`` and ``@unit``."""
    begins = re.finditer(r"@\s*(?:default|unit)\s*\((?!\s*\w+\s*=)", blanked(case.text))
    return changed(case.text, [(match.end(), match.end(), "value=") for match in begins])


# Values that do not fit.


_NOTE = r"@\s*[\w:]+\s*(?:\((?:[^()]|\([^()]*\))*\)\s*)?"


_MEMBER = re.compile(
    rf"(?P<notes>(?:{_NOTE})+)(?P<type>\w[\w: ]*?\s*(?:<[^;{{}}]*?>)?)\s+(?P<name>\w+)\s*"
    r"(?:\[(?P<size>[^\]]*)\]\s*)?(?=[;,])"
)


_DEFAULT = re.compile(r"@\s*default\s*\((?:\s*value\s*=)?(?P<value>(?:[^()]|\([^()]*\))*)\)")


_NO_VALUE = re.compile(r"@\s*default\b(?!\s*\()")


@dataclass(frozen=True, slots=True)
class _Default:
    """A default, and its place in the text: from `start` up to `end`."""

    start: int
    end: int
    text: str


def _members(case: DefinitionCase) -> Iterator[tuple[re.Match[str], list[_Default]]]:
    """Yield the members with their defaults."""
    code = blanked(case.text)
    for member in _MEMBER.finditer(code):
        found = [
            _Default(*match.span(), case.text[match.start("value") : match.end("value")].strip())
            for match in _DEFAULT.finditer(code, *member.span("notes"))
        ]
        yield member, found


@RULES.text("idl-defaults", "rosidl_parser takes several defaults of a member.", is_mistake=True)
def _one_default(case: DefinitionCase) -> str:
    """Remove all defaults of a member except the first that has a value."""
    code = blanked(case.text)
    changes = []
    for member, defaults in _members(case):
        bare = _NO_VALUE.finditer(code, *member.span("notes")) if defaults else ()
        changes += [(*match.span(), "") for match in bare]
        changes += [(each.start, each.end, "") for each in defaults[1:]]
    return changed(case.text, changes)


@dataclass(frozen=True, slots=True)
class _Names:
    """Names that values may refer to: integers with their values, and all declared constants."""

    integers: Mapping[str, int]
    modules: set[str]
    declared: set[str]

    @classmethod
    def of(cls, case: DefinitionCase) -> _Names:
        texts = [blanked(text) for text in (*case.included, case.text)]
        code = "\n".join(texts)
        return cls(
            integers={name: each for text in texts for name, each in integers_of(text).items()},
            modules=modules_of(code),
            declared={name for _, name, _ in DECLARED.findall(code)},
        )

    def integer(self, text: str) -> int | None:
        return integer_of(text, self.integers, self.modules)


def _is_value(kind: str, text: str, names: _Names) -> bool:
    """Whether a text is a value of a scalar type. A text that is not understood counts as one."""
    if _WORD.fullmatch(text) and text not in ("TRUE", "FALSE"):
        return text in names.declared
    is_truth, is_text = text in ("TRUE", "FALSE"), text[:1] == '"' or text[:2] == 'L"'
    integer = names.integer(text)
    if kind in _RANGES:
        least, most = _RANGES[kind]
        is_number = _NUMBER.fullmatch(text) is not None and integer is None
        is_character = "'" in text and kind not in ("char", "wchar")
        if is_truth or is_text or is_number or is_character:
            return False
        return integer is None or least <= integer <= most
    is_number = integer is not None or _NUMBER.fullmatch(text) is not None
    if kind == "boolean":
        return not is_text and (integer in (0, 1) or not is_number)
    if kind in _FLOATS:
        return not is_text and not is_truth
    match = re.fullmatch(r"w?string\s*(?:<(.*)>)?", kind)
    if match is None:
        return True
    bound = None if match[1] is None else names.integer(match[1])
    is_long = is_text and bound is not None and len(text.strip("L")) - 2 > bound
    return not is_number and not is_truth and not is_long


def _is_list(kind: str, text: str, count: int | None, at_most: bool, names: _Names) -> bool:
    """Whether a text in quotes is a list of values of some type."""
    if text[:1] != '"':
        return False
    try:
        items = ast.literal_eval(text[1:-1])
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return True
    if not isinstance(items, tuple | list):
        return True  # This is not a list, but another mistake.
    if count is not None and (len(items) > count if at_most else len(items) != count):
        return False
    return all(
        _is_value(kind, str(item).upper() if isinstance(item, bool) else _literal(item), names)
        for item in items
    )


def _literal(item: Any) -> str:
    return f'"{item}"' if isinstance(item, str) else repr(item)


@RULES.text(
    "idl-values", "rosidl_parser takes values that are none of their types.", is_mistake=True
)
def _fitting_values(case: DefinitionCase) -> str:
    """Replace values of constants that do not fit, and remove defaults that do not fit."""
    names = _Names.of(case)
    code = blanked(case.text)
    changes: list[tuple[int, int, str]] = []
    for match in DECLARED.finditer(code):
        kind = " ".join(match[1].split())
        # Look for "=" in `code`, because texts are blank there.
        start, end = code.index("=", match.end(2)) + 1, match.end() - 1
        if not _is_value(kind, case.text[start:end].strip(), names):
            fit = {"boolean": "FALSE", "string": '""', "wstring": '""'}
            new = fit.get(kind, "0.0" if kind in _FLOATS else "0")
            changes.append((start, end, new))
    kinds = {name: (kind, size.strip("[] ")) for kind, name, size in TYPEDEF.findall(code)}
    for member, defaults in _members(case):
        if not all(_is_default(member, each.text, kinds, names) for each in defaults):
            changes += [(each.start, each.end, "") for each in defaults]
    return changed(case.text, changes)


def _is_default(
    member: re.Match[str], text: str, kinds: Mapping[str, tuple[str, str]], names: _Names
) -> bool:
    kind, size = " ".join(member["type"].split()), member["size"]
    while (named := kinds.get(kind.rpartition("::")[2])) is not None:
        kind, size = named[0], size or named[1] or None
    sequence = re.fullmatch(r"sequence\s*<\s*(.*?)\s*(?:,([^,<>]*))?>", kind)
    if sequence is not None:
        count = None if sequence[2] is None else names.integer(sequence[2].strip())
        return _is_list(sequence[1], text, count, True, names)
    if size is not None:
        return _is_list(kind, text, names.integer(size), False, names)
    return _is_value(kind, text, names)


@RULES.text(
    "idl-lists-of-one",
    "Generators fail at a list that is written (1); rosidl_adapter writes (1, ).",
)
def _lists_of_one(case: DefinitionCase) -> str:
    """Write a comma after the only element of a list, as rosidl_adapter does."""
    changes = [
        (each.start, each.end, f'@default(value="({match[1]},)")')
        for _, defaults in _members(case)
        for each in defaults
        if (match := re.fullmatch(r'"\(\s*([-+\w.]+)\s*\)"', each.text))
    ]
    return changed(case.text, changes)


# The bound of a sequence, and that of its texts.

_WIDE = re.compile(r"\bsequence\s*<\s*wstring\s*<[^<>]*>\s*>\s+(\w+)|\bwstring<=\d+\[\] +(\w+)")


def _bounded_by_texts(message: Message) -> Message:
    """Give sequences of wstring without a bound that of their texts."""

    def bounded(item: Field) -> Field:
        match item.type:
            case Sequence(element=String(wide=True, bound=bound), bound=None) if bound is not None:
                return replace(item, type=replace(item.type, bound=bound))
        return item

    return replace(message, fields=tuple(map(bounded, message.fields)))


@RULES.facts(
    "ros2-wstring-sequences",
    "rosidl_parser takes the bound of the texts in a sequence of wstring for the sequence's.",
    language=None,
    dialect="ros2",
    hashed=rebuild(_bounded_by_texts),
)
def _own_bounds(facts: Facts, case: DefinitionCase) -> Facts:
    """Remove the bound of the texts from a sequence that has no bound itself."""
    code = blanked(case.text) if case.language == "idl" else case.text
    names = {one or other for one, other in _WIDE.findall(code)}

    def own(field: dict[str, Any]) -> dict[str, Any]:
        match = re.fullmatch(r"(wstring<=(\w+))\[<=\2\]", field["type"])
        is_one = match is not None and field["name"] in names
        return {**field, "type": f"{match[1]}[]"} if match is not None and is_one else field

    return mend_members("fields", own)(facts, case)
