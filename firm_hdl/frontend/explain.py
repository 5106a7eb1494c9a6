"""The wording of all syntax errors in lines of ``.msg``, ``.srv`` and ``.action`` files.

A parser knows which terminals it expected. This module describes them in the user's words, and
recognizes common mistakes.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from difflib import get_close_matches

from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from firm_hdl.model import PRIMITIVES, Dialect

__all__ = [
    "NAME_RULES",
    "alternatives",
    "clip",
    "explain",
    "place_of",
    "similar_builtin",
    "words_at",
]

NAME_RULES = {
    "NAME": "letters, digits and underscores, a letter first",
    "FIELD_NAME": "lower-case letters, digits and single underscores, a letter first and no "
    "underscore last",
    "CONSTANT_NAME": "upper-case letters, digits and single underscores, a letter first and no "
    "underscore last",
    "MESSAGE_NAME": "letters and digits, a capital first",
}
"""The rule for each kind of name."""

_ROS1_CONSTANT_RULE = "letters, digits and underscores, no digit first"

# Terminals in the order in which a message lists them.
_PHRASES = {
    "INT_TYPE": "a type",
    "PACKAGE": "a type",
    "MESSAGE_NAME": "the name of a message type",
    "CONSTANT_NAME": "a constant name",
    "FIELD_NAME": "a field name",
    "NAME": "a name",
    "AT_MOST": "'<='",
    "SIZE": "a number",
    "OPEN": "'['",
    "CLOSE": "']'",
    "_EQUALS": "'='",
    "INTEGER": "an integer",
    "FLOAT": "a number",
    "BOOLEAN": "a boolean",
    "DOUBLE_QUOTED": "a string",
    "CONSTANT_DOUBLE_QUOTED": "a string",
    "DOUBLE_QUOTED_ITEM": "a string",
    "LIST_OPEN": "a list in brackets",
    "_COMMA": "','",
    "LIST_CLOSE": "']'",
    "_SPACE": "a space",
    "COMMENT": "the end of the line",
}
# Names that other languages have for builtin types.
_FOREIGN = {
    "boolean": "bool",
    "double": "float64",
    "float": "float32",
    "int": "int32",
    "long": "int64",
    "short": "int16",
    "str": "string",
    "uint": "uint32",
    "unsigned": "uint32",
}
_WORD = re.compile(r"[^\s#]*")
_TYPE_WORD = re.compile(r"[^\s#\[]*")
_NAME_WORD = re.compile(r"[^\s#=]*")
_VALUE_WORD = re.compile(r"[^#]*[^\s#]|")
_ITEM_WORD = re.compile(r"[^#,\]]*[^\s#,\]]|")


def explain(error: UnexpectedInput, line: str, dialect: Dialect) -> tuple[int, int, str]:
    """Put a syntax error into words.

    Returns: start and end of the words that are wrong, as offsets in the line, and the message.
    """
    start = place_of(error, len(line.rstrip()))
    assert isinstance(error, UnexpectedCharacters | UnexpectedToken)
    terminals = error.expected if isinstance(error, UnexpectedToken) else error.allowed
    expected = frozenset(terminals or ())
    if dialect == "ros2" and line[:1].isspace():
        start = len(line) - len(line.lstrip())
        return start, len(line.rstrip()), "a definition must start in the first column"
    for rule in (
        _wrong_part,
        _wrong_name,
        _wrong_type,
        _wrong_constant,
        _wrong_list,
        _wrong_value,
        _wrong_size,
        _wrong_separator,
    ):
        found = rule(line, start, expected, dialect)
        if found is not None:
            length, message = found
            return start, start + length, message
    start, end, message = _in_general(line, start, expected)
    if dialect == "ros1" and "=" not in line[:end] and "COMMENT" in expected:
        message += "; a field of ROS 1 has no default"
    return start, end, message


def clip(text: str) -> str:
    """Shorten a quotation for a message, and escape what cannot be printed."""
    shown = text if len(text) <= 60 else text[:57] + "..."
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in shown)


def similar_builtin(word: str, dialect: Dialect) -> list[str]:
    """List the builtin type that the user probably meant by a word; empty if there is none."""
    if word in _FOREIGN:
        return [_FOREIGN[word]]
    return get_close_matches(word, [*PRIMITIVES[dialect], "string"], n=1, cutoff=0.7)


def place_of(error: UnexpectedInput, end: int) -> int:
    """Return where in the text the parser stopped: at `end` if more had to follow."""
    if isinstance(error, UnexpectedToken) and error.token.type == "$END":
        return end
    assert error.pos_in_stream is not None
    return error.pos_in_stream


_Found = tuple[int, str] | None


def _wrong_part(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    if not line.startswith("---"):
        return None
    if dialect == "ros2" and line != "---":
        return len(line), "a line that separates two parts must be '---' and nothing else"
    return len(line), "a message has one part; '---' is for services and actions"


def _wrong_name(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    word = words_at(_NAME_WORD, line, start)
    kinds = expected & {"NAME", "FIELD_NAME", "CONSTANT_NAME"}
    if not word or not kinds:
        return None
    has_value = line[start + len(word) :].lstrip().startswith("=")
    if has_value and "CONSTANT_NAME" not in kinds:
        return len(word), "a constant must have a builtin type and cannot be an array"
    if dialect == "ros1":
        what, rule = "name", NAME_RULES["NAME"]
        if has_value:
            rule = _ROS1_CONSTANT_RULE
    elif has_value:
        what, rule = "constant name", NAME_RULES["CONSTANT_NAME"]
    else:
        what, rule = "field name", NAME_RULES["FIELD_NAME"]
    if "[" in word:
        return len(word), f"'{clip(word)}' is not a legal {what}: brackets belong to the type"
    return len(word), f"'{clip(word)}' is not a legal {what}: {rule}"


def _wrong_type(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    word = words_at(_TYPE_WORD, line, start)
    if not word or "MESSAGE_NAME" not in expected:
        return None
    if "PACKAGE" not in expected:
        return len(word), (
            f"'{clip(word)}' is not a legal message name: {NAME_RULES['MESSAGE_NAME']}; "
            "a type is written 'Name' or 'package/Name'"
        )
    message = f"'{clip(word)}' is not a type"
    if dialect == "ros2" and word in ("time", "duration"):
        return len(word), f"{message} of ROS 2; use 'builtin_interfaces/{word.capitalize()}'"
    if word.startswith("@"):
        return len(word), f"annotation '{clip(word)}' is not supported"
    if word.startswith("\ufeff"):
        return 1, "a byte order mark is not allowed"
    package, slash, _ = word.partition("/")
    if slash:
        rule = NAME_RULES["NAME" if dialect == "ros1" else "FIELD_NAME"]
        return len(word), f"'{clip(package)}' is not a legal package name: {rule}"
    close = similar_builtin(word, dialect)
    if close:
        return len(word), f"{message}; did you mean '{close[0]}'?"
    if dialect == "ros2":
        message += f", and not a legal message name: {NAME_RULES['MESSAGE_NAME']}"
    return len(word), message


def _wrong_constant(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    rest = line[start:].lstrip()
    if not rest.startswith("="):
        return None
    if dialect == "ros2" and "COMMENT" in expected:
        return len(line[start:].rstrip()), "a default cannot contain '='"
    return len(line[start:].rstrip()), "a constant must have a builtin type and cannot be an array"


def _wrong_list(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    rest = line[start:].partition("#")[0].rstrip()
    is_empty = line[:start].endswith("[") and expected & {"INTEGER", "FLOAT", "BOOLEAN"}
    # A bracket closes a list only at the end of the line.
    if rest.lstrip().startswith("]") and ("LIST_CLOSE" in expected or is_empty):
        return len(rest), "only a comment may follow the ']' of a list"
    return None


def _wrong_value(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    is_item = line[:start].rstrip()[-1:] in ("[", ",")
    word = words_at(_ITEM_WORD if is_item else _VALUE_WORD, line, start)
    if not word:
        return None
    quoted = clip(word)
    if "INTEGER" in expected:
        what = "a decimal integer" if dialect == "ros1" else "an integer"
        return len(word), f"'{quoted}' is not {what}"
    if "FLOAT" in expected:
        return len(word), f"'{quoted}' is not a number"
    if "BOOLEAN" in expected:
        values = "True, False, 1 or 0" if dialect == "ros1" else "true, false, 1 or 0"
        return len(word), f"'{quoted}' is not a boolean: {values}"
    if "DOUBLE_QUOTED" in expected and "=" in word:
        return len(word), "a default cannot contain '='"
    if expected & {"DOUBLE_QUOTED", "CONSTANT_DOUBLE_QUOTED"}:
        return len(word), f"{quoted} is not a string: a quote inside it needs a backslash"
    return None


def _wrong_size(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    word = words_at(_WORD, line, start)
    if "SIZE" not in expected:
        return None
    if not word:
        return 1, "expected a number; blanks are not allowed inside a type"
    return len(word), f"'{clip(word)}' is not a number of elements or characters"


def _wrong_separator(line: str, start: int, expected: frozenset[str], dialect: Dialect) -> _Found:
    if "_SPACE" not in expected or "COMMENT" in expected:
        return None
    rest = line[start:]
    word = words_at(_WORD, line, start)
    if not rest.strip() or rest.lstrip().startswith("#"):
        return 1, "a name must follow the type"
    if rest[0].isspace():
        return 1, "a space must separate type and name; tabs alone do not"
    if word.startswith("<=") and dialect == "ros1":
        return len(word), "ROS 1 has no bounds"
    if word.startswith("["):
        return len(word), "an array has one dimension"
    return None


def _in_general(line: str, start: int, expected: frozenset[str]) -> tuple[int, int, str]:
    phrases = list(dict.fromkeys(p for name, p in _PHRASES.items() if name in expected))
    wanted = alternatives(phrases or ["the end of the line"])
    start = len(line) - len(line[start:].lstrip())
    word = words_at(_WORD, line, start)
    if word:
        return start, start + len(word), f"expected {wanted}, not '{clip(word)}'"
    return start, start + 1, f"expected {wanted}, but the definition ends here"


def alternatives(words: Sequence[str]) -> str:
    """Join words: ``a, b or c``."""
    *others, last = words
    return f"{', '.join(others)} or {last}" if others else last


def words_at(pattern: re.Pattern[str], text: str, start: int) -> str:
    """Return what matches a pattern at a place, or nothing."""
    match = pattern.match(text, start)
    return match.group() if match else ""
