"""Faults in Lark grammars: one alternative, option, quantifier, border, look-around or priority."""

from __future__ import annotations

import re
from collections.abc import Iterator

from lark import Lark
from lark.exceptions import LarkError

from tools.mutation.mutants import Change

__all__ = ["changes", "is_fault"]

DEFINITION = re.compile(r"^(?P<name>[?!]*\w+)(?P<priority>\.\d+)?: *(?=\S)", re.MULTILINE)
# A comment, a regular expression, a string, an arrow, or any other character.
TOKEN = re.compile(r"//.*|/(?:\\.|\[(?:\\.|[^\]\\])*\]|[^/\\])+/\w*|\"(?:\\.|[^\"\\])*\"|->|.|\n")
# A class of characters, an escape, an opening bracket with its meaning, any character.
REGEX_TOKEN = re.compile(r"\[\^?\]?(?:\\.|[^\]\\])*\]|\\.|\(\?(?:<?[=!]|:)|\{\d+(?:,\d*)?\}|.")
RANGE = re.compile(r"(?<!\\)(\w)-(\w)")
LOOK = ("(?=", "(?!", "(?<=", "(?<!")
QUANTIFIERS = {"*": "+", "+": "*", "?": ""}


def changes(text: str) -> list[Change]:
    """Return all changes of a grammar, in order; some of them may be no faults."""
    found = [change for change in _changes(text) if change.new != text[change.start : change.end]]
    return sorted(found, key=lambda each: (each.start, each.end, each.rule, each.new))


def is_fault(text: str, change: Change, start: list[str]) -> bool:
    """Return whether Lark still loads the grammar with the change."""
    try:
        Lark(change.apply(text), parser="lalr", lexer="contextual", start=start)
    except (LarkError, re.error, ValueError, AssertionError):
        return False
    return True


def _changes(text: str) -> Iterator[Change]:
    definitions = list(DEFINITION.finditer(text))
    borders = [match.start() for match in definitions[1:]] + [len(text)]
    for match, border in zip(definitions, borders, strict=True):
        name = match["name"].lstrip("?!")
        if match["priority"]:
            first, last = match.span("priority")
            yield Change(first, last, "", "drop priority", name)
        yield from _rule(text, match.end(), border, name)


def _rule(text: str, start: int, end: int, name: str) -> Iterator[Change]:
    """Yield the changes of one rule or terminal."""
    tokens: list[tuple[int, str]] = []
    for match in TOKEN.finditer(text, start, end):
        token = match[0]
        if token.startswith("%"):
            break
        if token.startswith("/") and not token.startswith("//"):
            yield from _regex(text, match.start() + 1, match.start() + token.rindex("/"), name)
        if token.strip() and not token.startswith("//"):
            tokens.append((match.start(), token))
    yield from _structure(text, tokens, name)


def _regex(text: str, start: int, end: int, name: str) -> Iterator[Change]:
    tokens = [(match.start(), match[0]) for match in REGEX_TOKEN.finditer(text, start, end)]
    for at, token in tokens:
        if token.startswith("[") and len(token) > 1:
            for match in RANGE.finditer(token):
                low, high = match[1], match[2]
                for new in (f"{chr(ord(low) + 1)}-{high}", f"{low}-{chr(ord(high) - 1)}"):
                    span = (at + match.start(), at + match.end())
                    yield Change(*span, new, "class border", name)
    yield from _structure(text, tokens, name)


def _structure(text: str, tokens: list[tuple[int, str]], name: str) -> Iterator[Change]:
    """Yield changes of constructs that rules and regular expressions have in common."""
    opened: list[int] = []
    # Where the alternatives of each open bracket start; the lowest is the whole rule.
    starts: list[list[int]] = [[tokens[0][0]]] if tokens else []
    ends = [at + len(token) for at, token in tokens]
    for index, (at, token) in enumerate(tokens):
        if token in "([" or token.startswith("(?"):
            opened.append(index)
            starts.append([at + len(token)])
        elif token in ")]" and opened:
            first = opened.pop()
            yield from _alternatives(text, starts.pop(), at, name)
            if tokens[first][1] in LOOK:
                yield Change(tokens[first][0], ends[index], "", "drop look-around", name)
            elif token == "]":
                yield Change(tokens[first][0], ends[index], "", "drop optional", name)
        elif token == "|":
            starts[-1].append(at + 1)
        elif token in QUANTIFIERS and index and tokens[index - 1][1] not in ("|", "("):
            yield Change(at, at + 1, QUANTIFIERS[token], "quantifier", name)
    if starts:
        yield from _alternatives(text, starts[0], ends[-1], name)


def _alternatives(text: str, starts: list[int], end: int, name: str) -> Iterator[Change]:
    if len(starts) < 2:
        return
    for index, start in enumerate(starts):
        if index + 1 < len(starts):  # Also drop the `|` after the alternative.
            yield Change(start, starts[index + 1], "", "drop alternative", name)
        else:
            yield Change(start - 1, end, "", "drop alternative", name)
