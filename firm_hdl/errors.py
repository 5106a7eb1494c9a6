"""Errors in a user's definitions: where they are, what is wrong, and how that is printed.

Libraries raise :class:`DefinitionError` with every problem that they found; only the command line
prints. The form is that of compilers: ``file:line:column: error: message``, then the source line,
then a caret under the words that are meant.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from firm_hdl.terminal import printable

__all__ = ["DefinitionError", "Diagnostic", "Source", "Span", "UserError", "described"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """A text of definitions.

    Parameters
    ----------
    name : str
        What to call it in messages: a file's path as the user wrote it, or ``<origin>/...`` for a
        text that is in no file.
    text : str
        All of its characters, line ends as they were.
    """

    name: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Span:
    """A range of characters of a source. Line and column are computed when somebody asks."""

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Diagnostic:
    """One problem: a sentence, and the place that it is about (`None`: no text is to blame)."""

    message: str
    span: Span | None = None

    def __str__(self) -> str:
        said = printable(self.message)
        if self.span is None:
            return f"error: {said}"
        span = self.span
        column = span.column
        where = f"{printable(span.source.name)}:{span.line}:{column}"
        text, before = _clip(span.line_text, column - 1)
        meant = max(1, min(span.end - span.start, len(text) - before))
        head, words, tail = (
            printable(part)
            for part in (text[:before], text[before : before + meant], text[before + meant :])
        )
        # Tabs stay tabs in front of the caret, so that it stands right at any tab width.
        indent = "".join("\t" if c == "\t" else " " for c in head)
        carets = "^" * max(1, len(words))
        return f"{where}: error: {said}\n{head}{words}{tail}\n{indent}{carets}"


# A file may be one line, with all of its mistakes.
_MOST_SHOWN = 400


def _clip(text: str, before: int) -> tuple[str, int]:
    """Cut a long line to what stands around a place; give the characters in front of it, too."""
    if len(text) <= _MOST_SHOWN:
        return text, before
    start = max(0, before - _MOST_SHOWN // 2)
    end = start + _MOST_SHOWN
    head, tail = "..." if start else "", "..." if end < len(text) else ""
    return head + text[start:end] + tail, before - start + len(head)


# A text with a thousand mistakes must not be searched from its start for each of them.
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

    def __str__(self) -> str:
        # Not made before somebody reads it: there may be a thousand, in a thousand types.
        return "\n".join(str(d) for d in self.diagnostics)


class UserError(Exception):
    """What was asked for cannot be done; the text says why, for whoever asked."""


def described(error: BaseException) -> str:
    """Return what an error says; of one that is not meant for users, with its name in Python."""
    if isinstance(error, DefinitionError | UserError):
        return str(error)
    return f"{type(error).__name__}: {error}"
