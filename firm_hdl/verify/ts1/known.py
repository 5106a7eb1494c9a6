"""Differences between oracles and us that are meant to be: docs/errata.md says why.

Each has a key, by which a report names it. A difference that no entry takes for itself is a mistake
of somebody's.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

from firm_hdl.errors import DefinitionError
from firm_hdl.model import Array, Interface, Message, Primitive, Sequence, Text
from firm_hdl.verify.ts1.case import Case
from firm_hdl.verify.ts1.facts import Difference

__all__ = ["KNOWN", "Known", "known_key"]

_Reading: TypeAlias = "Interface | Exception"
_Rule: TypeAlias = "Callable[[Case, _Reading, Difference], bool]"


@dataclass(frozen=True, slots=True, kw_only=True)
class Known:
    """One deliberate difference.

    Attributes
    ----------
    key : str
        Its name, here and in docs/errata.md.
    oracles : set of str
        Whom it is a difference to.
    applies : callable
        Whether it explains a difference, given the case and what we make of it.
    text : str
        What differs, in one sentence.
    """

    key: str
    oracles: frozenset[str]
    applies: _Rule
    text: str


def known_key(
    oracle: str, case: Case, ours: Interface | Exception, difference: Difference
) -> str | None:
    """Return the key of the entry that explains a difference; `None` if none does."""
    for entry in KNOWN:
        if oracle in entry.oracles and entry.applies(case, ours, difference):
            return entry.key
    return None


def _only_they_refuse(difference: Difference) -> bool:
    return difference.path == "verdict" and difference.ours == "accepts"


def _only_we_refuse(difference: Difference) -> bool:
    return difference.path == "verdict" and difference.theirs == "accepts"


def _elements(ours: _Reading) -> Iterator[object]:
    """Yield the types of all fields, those of nested messages and those inside arrays included."""
    pending = [] if isinstance(ours, Exception) else list(ours.messages)
    seen: set[str] = set()
    while pending:
        message = pending.pop()
        for item in message.fields:
            kind = item.type.element if isinstance(item.type, Array | Sequence) else item.type
            if not isinstance(kind, Message):
                yield kind
            elif kind.name not in seen:
                seen.add(kind.name)
                pending.append(kind)


def _has_wstring(ours: _Reading) -> bool:
    return any(isinstance(kind, Text) and kind.wide for kind in _elements(ours))


def _has_char(ours: _Reading) -> bool:
    return any(isinstance(kind, Primitive) and kind.name == "char" for kind in _elements(ours))


# rosbags: it is right about bytes, but has a language of its own.

_CONSTANT = re.compile(r"(?m)^[ \t]*\w+[ \t]+(\w+)[ \t]*=")
_ROSBAGS_NAME = re.compile(r"[A-Z](?:_?[A-Z0-9]+)*")
_STRING_CONSTANT = re.compile(r"(?m)^[ \t]*string[ \t]+\w+[ \t]*=")


def _rosbags_names(case: Case, ours: _Reading, difference: Difference) -> bool:
    is_listed = difference.path.endswith(("/fields", "/constants"))
    return (_only_they_refuse(difference) or is_listed) and any(
        not _ROSBAGS_NAME.fullmatch(name) for name in _CONSTANT.findall(case.text)
    )


def _rosbags_texts(case: Case, ours: _Reading, difference: Difference) -> bool:
    if _only_they_refuse(difference) or difference.path.endswith(("/fields", "/constants")):
        return _STRING_CONSTANT.search(case.text) is not None
    our, their = difference.values
    return (
        difference.path.endswith("/value")
        and isinstance(our, str)
        and (our[:1] == our[-1:] and our[:1] in ("'", '"') and our[1:-1] == their)
    )


def _rosbags_bool(case: Case, ours: _Reading, difference: Difference) -> bool:
    our, their = difference.values
    return isinstance(our, bool) and type(their) is int and our == bool(their)


def _rosbags_octal(case: Case, ours: _Reading, difference: Difference) -> bool:
    our, their = difference.values
    digits = str(our)
    return (
        type(our) is int
        and set(digits) <= set("01234567")
        and type(their) is int
        and int(digits, 8) == their
    )


# What genmsg does not look at.

_CONSTANT_LINE = re.compile(r"\s*(\w+)\s(.*?)=")
_LEGAL_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)


def _all_lines(rule: Callable[[str, str], bool]) -> _Rule:
    """Make a rule: only we refuse, and each of our messages and its line are as `rule` says."""

    def applies(case: Case, ours: _Reading, difference: Difference) -> bool:
        return (
            _only_we_refuse(difference)
            and isinstance(ours, DefinitionError)
            and all(
                each.span is not None and rule(each.message, each.span.line_text)
                for each in ours.diagnostics
            )
        )

    return applies


def _is_oddly_named(message: str, line: str) -> bool:
    match = _CONSTANT_LINE.match(line.partition("#")[0])
    return match is not None and not _LEGAL_NAME.fullmatch(match[2].strip())


def _is_bool_constant(message: str, line: str) -> bool:
    match = _CONSTANT_LINE.match(line.partition("#")[0])
    return match is not None and match[1] == "bool" and "is not a truth value" in message


_LIMITS = ("9223372036854775808", "18446744073709551616")


def _is_one_too_many(message: str, line: str) -> bool:
    digits = line.replace("_", "")
    return "64 must be in" in message and any(limit in digits for limit in _LIMITS)


# ROS 2's own.

_ESCAPE_IN_LIST = re.compile(r"""(?m)^w?string\S*\]\s.*\[[^#]*\\["'][^#]*\]""")


def _escaped_quotes(case: Case, ours: _Reading, difference: Difference) -> bool:
    is_about = difference.path == "verdict" or "default" in difference.path
    return is_about and _ESCAPE_IN_LIST.search(case.text) is not None


def _comment_blanks(case: Case, ours: _Reading, difference: Difference) -> bool:
    def bare(comment: object) -> list[str]:
        lines = [line.rstrip() for line in str(comment).split("\n")]
        return [line for line in lines if line]

    return difference.path.endswith("/comment") and bare(difference.values[0]) == bare(
        difference.values[1]
    )


_BOUND_BY_NAME = re.compile(r"(wstring<=)([A-Za-z_]\w*)(.*)")


def _idl_bounds(case: Case, ours: _Reading, difference: Difference) -> bool:
    our, their = (str(value) for value in difference.values)
    match = _BOUND_BY_NAME.fullmatch(their)
    if match is None or not difference.path.endswith("/type") or isinstance(ours, Exception):
        return False
    before, name, behind = match.groups()
    bound = re.fullmatch(rf"{re.escape(before)}(\d+){re.escape(behind)}", our)
    # Those of an included file have no value here.
    values = {
        constant.value
        for message in ours.messages
        for constant in message.constants
        if constant.name == name
    }
    return bound is not None and (not values or int(bound[1]) in values)


def _idl_whole_numbers(case: Case, ours: _Reading, difference: Difference) -> bool:
    our, their = (value if isinstance(value, list) else [value] for value in difference.values)
    return (
        difference.path.endswith(("/value", "/default"))
        and our == their
        and all(type(value) is float for value in our)
        and all(type(value) in (int, float) for value in their)
    )


def _entry(key: str, oracles: str, applies: _Rule, text: str) -> Known:
    return Known(key=key, oracles=frozenset(oracles.split()), applies=applies, text=text)


KNOWN: tuple[Known, ...] = (
    _entry(
        "rosbags-lenient",
        "rosbags",
        lambda case, ours, difference: _only_we_refuse(difference),
        "rosbags takes definitions that ROS refuses.",
    ),
    _entry(
        "rosbags-crlf",
        "rosbags",
        lambda case, ours, difference: _only_they_refuse(difference) and "\r" in case.text,
        "rosbags refuses lines that end in CR LF.",
    ),
    _entry(
        "rosbags-wstring",
        "rosbags",
        lambda case, ours, difference: _only_they_refuse(difference) and _has_wstring(ours),
        "rosbags does not know wstring.",
    ),
    _entry(
        "rosbags-constant-names",
        "rosbags",
        _rosbags_names,
        "rosbags takes constants with lower-case letters for fields, or refuses them.",
    ),
    _entry(
        "rosbags-constant-texts",
        "rosbags",
        _rosbags_texts,
        "rosbags takes quotes off string constants of ROS 1, or refuses them.",
    ),
    _entry(
        "rosbags-constant-bool",
        "rosbags",
        _rosbags_bool,
        "rosbags keeps a bool constant that is written as a number as a number.",
    ),
    _entry(
        "rosbags-octal",
        "rosbags",
        _rosbags_octal,
        "rosbags reads 010 as 8.",
    ),
    _entry(
        "rosbags-char-hash",
        "rosbags",
        lambda case, ours, difference: difference.path.startswith("hash/") and _has_char(ours),
        "rosbags hashes char of a .msg as a character, and rosidl as a uint8.",
    ),
    _entry(
        "ros1-constant-names",
        "genmsg",
        _all_lines(_is_oddly_named),
        "genmsg takes anything for the name of a constant.",
    ),
    _entry(
        "ros1-bool-literals",
        "genmsg",
        _all_lines(_is_bool_constant),
        "genmsg takes any literal of Python for a truth value.",
    ),
    _entry(
        "ros1-indented-texts",
        "genmsg",
        _all_lines(lambda message, line: message.startswith("a string constant must start in")),
        "genmsg takes an indented string constant for one called 'string X'.",
    ),
    _entry(
        "ros1-64-bit-limits",
        "genmsg",
        _all_lines(_is_one_too_many),
        "genmsg compares with rounded limits, and takes one more than 64 bits hold.",
    ),
    _entry(
        "ascii-only",
        "genmsg rosidl_adapter rosidl_parser",
        _all_lines(lambda message, line: not message.isascii()),
        "Names and numbers are written in ASCII.",
    ),
    _entry(
        "ros2-escaped-quotes",
        "rosidl_adapter",
        _escaped_quotes,
        "rosidl_adapter loses count of escaped quotes in a list of strings.",
    ),
    _entry(
        "sizes-of-32-bits",
        "genmsg rosidl_adapter rosidl_parser",
        _all_lines(lambda message, line: f"must be at most {2**32 - 1}" in message),
        "Every wire format counts elements in 32 bits, and so do we.",
    ),
    _entry(
        "ros1-empty-arrays",
        "genmsg",
        _all_lines(lambda message, line: "must be at least 1, not 0" in message),
        "genmsg takes arrays of no elements.",
    ),
    _entry(
        "idl-names",
        "rosidl_parser",
        lambda case, ours, difference: difference.path == "names",
        "A type in IDL is called by its package and its file, whatever its modules say.",
    ),
    _entry(
        "idl-file-names",
        "rosidl_parser",
        _all_lines(lambda message, line: message.startswith("this file must declare")),
        "A file in IDL must declare what it is called; rosidl_parser does not see file names.",
    ),
    _entry(
        "idl-bounds-by-name",
        "rosidl_parser",
        _idl_bounds,
        "rosidl_parser keeps the name of a constant that bounds a wstring; we have its value.",
    ),
    _entry(
        "idl-whole-numbers",
        "rosidl_parser",
        _idl_whole_numbers,
        "rosidl_parser keeps an integer that is given for a floating-point number an integer.",
    ),
    _entry(
        "idl-unsupported",
        "rosidl_parser",
        _all_lines(lambda message, line: message.endswith("is not supported")),
        "IDL that has no place in ROS messages, or that no circuit can do, is refused by name.",
    ),
    _entry(
        "ros2-comment-blanks",
        "rosidl_adapter",
        _comment_blanks,
        "Blanks at the end of a comment's lines, and empty lines, do not count for us.",
    ),
)
