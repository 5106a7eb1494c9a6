"""Errors in a user's definitions, with their position, and how they are printed.

Libraries raise :class:`DefinitionError` with all problems that they found; only the command line
prints. The form is that of compilers: ``file:line:column: error: message``, then the source line,
then carets under the words in question.
"""

from __future__ import annotations

import unicodedata
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from firm_hdl.terminal import printable

__all__ = [
    "MAX_DIAGNOSTICS",
    "DefinitionError",
    "Diagnostic",
    "Source",
    "Span",
    "UserError",
    "described",
]


MAX_DIAGNOSTICS = 1000
"""Largest number of problems that are reported of one file.

Without a limit, a large file that is no definition takes minutes.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """A text of definitions.

    * `name`: name in messages: a file's path as the user wrote it, or ``<origin>/...`` for a text
      that does not come from a file.
    * `text`: the whole text, with its original line ends.
    """

    name: str
    text: str


@dataclass(frozen=True, slots=True)
class Span:
    """A range of characters of a source. Line and column are computed when they are read."""

    source: Source
    start: int
    end: int

    @property
    def line(self) -> int:
        """Line number, the first line being 1."""
        return bisect_right(_line_starts(self.source.text), self.start)

    @property
    def column(self) -> int:
        """Column number in characters, the first column being 1."""
        return self.start - (self.source.text.rfind("\n", 0, self.start) + 1) + 1

    @property
    def line_text(self) -> str:
        """The source line of the start, without its line end."""
        begin = self.source.text.rfind("\n", 0, self.start) + 1
        end = self.source.text.find("\n", self.start)
        return self.source.text[begin : None if end < 0 else end].rstrip("\r")


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One problem: a sentence, and its place in a text (`None` if there is no place)."""

    message: str
    span: Span | None = None

    def facts(self) -> dict[str, str | int | None]:
        """Return the problem as values of JSON: message, file, line and column."""
        span = self.span
        return {
            "message": self.message,
            "file": None if span is None else span.source.name,
            "line": None if span is None else span.line,
            "column": None if span is None else span.column,
        }

    def __str__(self) -> str:
        message = printable(self.message)
        if self.span is None:
            return f"error: {message}"
        span = self.span
        column = span.column
        where = f"{printable(span.source.name)}:{span.line}:{column}"
        text, before = _clip(span.line_text, column - 1)
        end = before + span.end - span.start
        head, words, tail = (
            printable(part) for part in (text[:before], text[before:end], text[end:])
        )
        # Keep the tabs of the line before the carets, so that carets are aligned at any tab width.
        indent = "\t".join(" " * _columns(part) for part in head.split("\t"))
        carets = "^" * max(1, _columns(words))
        return f"{where}: error: {message}\n{head}{words}{tail}\n{indent}{carets}"


def _columns(text: str) -> int:
    """Return the columns of a text in a terminal: an East Asian sign takes two, an accent none."""
    if text.isascii():
        return len(text)
    accents = sum(unicodedata.category(c) in ("Mn", "Me", "Cf") for c in text)
    return len(text) - accents + sum(unicodedata.east_asian_width(c) in "WF" for c in text)


# A file may be one single line with many errors.
_MAX_SHOWN = 400


def _clip(text: str, before: int) -> tuple[str, int]:
    """Cut a long line to the part around a position; also return the new position."""
    if len(text) <= _MAX_SHOWN:
        return text, before
    start = max(0, before - _MAX_SHOWN // 2)
    end = start + _MAX_SHOWN
    head, tail = "..." if start else "", "..." if end < len(text) else ""
    return head + text[start:end] + tail, before - start + len(head)


# Cached, so that a text with a thousand errors is not searched from its start for each error.
@lru_cache(maxsize=16)
def _line_starts(text: str) -> list[int]:
    starts = [0]
    while end := text.find("\n", starts[-1]) + 1:
        starts.append(end)
    return starts


class DefinitionError(Exception):
    """Definitions that cannot be used.

    Attributes
    ----------
    diagnostics : tuple of Diagnostic
        All problems that were found, in the order of the text; at least one.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic]):
        self.diagnostics = tuple(diagnostics)
        assert self.diagnostics
        super().__init__(self.diagnostics)

    @classmethod
    def of(cls, message: str, span: Span | None = None) -> DefinitionError:
        """Make the error of one problem."""
        return cls([Diagnostic(message=message, span=span)])

    def __str__(self) -> str:
        # Format the text only when it is read: there may be a thousand errors in a thousand types.
        return "\n".join(str(d) for d in self.diagnostics)


class UserError(Exception):
    """A request of the user cannot be met; the message gives the reason."""


def described(error: BaseException) -> str:
    """Return the message of an error; for errors not meant for users, with their Python name."""
    if isinstance(error, DefinitionError | UserError):
        return str(error)
    return f"{type(error).__name__}: {error}"
