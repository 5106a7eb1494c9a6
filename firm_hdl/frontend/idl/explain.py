"""The wording of syntax errors in IDL, and of constructs that ROS 2 does not support.

A parser knows which terminals it expected. This module describes them in the user's words, and
recognizes constructs of the standard that ROS 2 does not support.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from lark.exceptions import UnexpectedInput

from firm_hdl.frontend.explain import alternatives, clip, place_of, words_at

__all__ = ["explain"]

# Constructs that OMG IDL has and rosidl_parser does not, by their first word.
_REFUSED = {
    "abstract": "interfaces are",
    "bitmask": "bitmasks are",
    "bitset": "bitsets are",
    "component": "components are",
    "custom": "value types are",
    "eventtype": "event types are",
    "exception": "exceptions are",
    "home": "components are",
    "import": "'import' is",
    "interface": "interfaces are",
    "local": "interfaces are",
    "map": "maps are",
    "native": "native types are",
    "typeid": "'typeid' is",
    "typeprefix": "'typeprefix' is",
    "union": "unions are",
    "valuetype": "value types are",
}
# Terminals in the order in which a message lists them.
_PHRASES = {
    "_MODULE": "'module'",
    "_CONST": "'const'",
    "_TYPEDEF": "'typedef'",
    "_STRUCT": "'struct'",
    "_ENUM": "'enum'",
    "INCLUDE": "'#include'",
    "SIZED_TYPE": "a type",
    "LONG": "'long'",
    "SHORT": "'short'",
    "IDENTIFIER": "a name",
    "DECIMAL": "a value",
    "_OPEN": "'{'",
    "_BRACKET": "'['",
    "_PAREN": "'('",
    "_EQUALS": "'='",
    "OR": "an operator",
    "PLUS": "an operator",
    "_COMMA": "','",
    "_GREATER": "'>'",
    "_END_PAREN": "')'",
    "_END_BRACKET": "']'",
    "_SEMICOLON": "';'",
    "_CLOSE": "'}'",
    "$END": "the end of the file",
}
_WORD = re.compile(r"\w+|::|.", re.DOTALL)
_BLANKS = " \t\f\r\n"
_NUMBER = re.compile(r"\.?[0-9](?:[eE][+-]|[\w.])*")
_DIRECTIVE = re.compile(r"#\s*\w*")
_LAST_WORD = re.compile(r"(@\s*)?(\w+)\s*\Z")
_ESCAPED = re.compile(r"_+[A-Za-z]\w*")
_DECLARED = re.compile(r"\b(?:struct|enum|union)\s+\w+\s*\Z")


def explain(error: UnexpectedInput, text: str, accepts: Iterable[str]) -> tuple[int, int, str]:
    """Put a syntax error into words.

    * `accepts`: names of the terminals that are legal at this place.

    Returns: start and end of the words that are wrong, as offsets in the text, and the message.
    """
    start = place_of(error, len(text.rstrip(_BLANKS)))
    expected = frozenset(accepts)
    # A short context is enough to recognize a known mistake, even after long names or comments.
    before = text[max(0, start - 200) : start]
    for rule in (_wrong_character, _wrong_word, _wrong_sign):
        found = rule(text, start, before, expected)
        if found is not None:
            length, message = found
            return start, start + length, message
    return _in_general(text, start, expected)


_Found = tuple[int, str] | None


def _wrong_character(text: str, start: int, before: str, expected: frozenset[str]) -> _Found:
    """Explain characters that start no token at any place."""
    rest = text[start : start + 100]
    if rest.startswith("#"):
        directive = words_at(_DIRECTIVE, text, start)
        if directive == "#include":
            return len(directive), "'#include' needs a path in quotes or angle brackets"
        message = f"'{clip(directive)}' is not supported: ROS 2 supports only '#include'"
        return len(directive), message
    if rest.startswith("/**/"):
        return 4, "an empty comment is not allowed: ROS 2 reads its end as its content"
    if rest.startswith("/*"):
        return 2, "this comment is not closed"
    if rest.startswith(('"', 'L"')) and '"' not in text[start:].splitlines()[0][2:]:
        return len(text[start:].splitlines()[0]), "this string is not closed in its line"
    if rest.startswith("\ufeff"):
        return 1, "a byte order mark is not allowed"
    number = words_at(_NUMBER, text, start)
    if number and "DECIMAL" in expected:
        return len(number), f"'{clip(number)}' is not a number"
    if rest.startswith(("'", "L'")):
        return 1, "a character literal must have one character, or one escape, between its quotes"
    escaped = words_at(_ESCAPED, text, start)
    if escaped:
        rule = "letters, digits and underscores, a letter first"
        return len(escaped), f"'{clip(escaped)}' is not a legal name: {rule}"
    return None


def _wrong_word(text: str, start: int, before: str, expected: frozenset[str]) -> _Found:
    """Explain a construct that the standard has and ROS 2 does not support."""
    word = words_at(_WORD, text, start)
    last = _LAST_WORD.search(before)
    at, previous = last.groups() if last else (None, "")
    if word in _REFUSED and "_MODULE" in expected:
        return len(word), f"{_REFUSED[word]} not supported"
    if at and previous == "annotation":
        return len(word), "annotations cannot be declared, only used"
    if word == "<" and previous in _REFUSED:
        return len(word), f"{_REFUSED[previous]} not supported"
    if word == "{" and _DECLARED.search(before):
        return 1, "a type cannot be declared inside another declaration"
    return None


def _wrong_sign(text: str, start: int, before: str, expected: frozenset[str]) -> _Found:
    sign = text[start : start + 1]
    stripped = before.rstrip()
    if sign == ":" and "_OPEN" in expected:
        return 1, "inheritance of structs is not supported"
    if sign == ">" and stripped.endswith(">") and "IDENTIFIER" in expected:
        return 1, "the '>' before this one ends the type; put a right shift in parentheses here"
    if sign == "}" and stripped.endswith("{"):
        what = "struct" if "SIZED_TYPE" in expected else "enum" if "_MODULE" not in expected else ""
        return 1, f"{'an' if what == 'enum' else 'a'} {what or 'module'} must not be empty"
    if sign == "}" and stripped.endswith(",") and "IDENTIFIER" in expected:
        return 1, "a name must follow the comma"
    return None


def _in_general(text: str, start: int, expected: frozenset[str]) -> tuple[int, int, str]:
    if {"_MODULE", "_STRUCT", "_TYPEDEF"} <= expected:
        phrases = ["a definition"]
        phrases += [_PHRASES[name] for name in ("_CLOSE", "$END") if name in expected]
    else:
        # Do not list `>` here: in an expression, it is the start of a shift.
        hidden = {"_GREATER"} if "OR" in expected and "_END_BRACKET" in expected else set()
        names = [name for name in _PHRASES if name in expected - hidden]
        phrases = list(dict.fromkeys(_PHRASES[name] for name in names))
    wanted = alternatives(phrases or ["something else"])
    word = words_at(_WORD, text, start)
    if start < len(text.rstrip(_BLANKS)):
        return start, start + len(word), f"expected {wanted}, not '{clip(word)}'"
    return start, start + 1, f"expected {wanted}, but the file ends here"
