"""Escape control characters in everything that commands print.

Definitions and names of files come from other people. An escape sequence in a comment could move
the cursor, rename the window or hide text in front of it. So control characters are printed as in
a Python string literal. Letters of any alphabet stay.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

__all__ = ["printable", "printable_streams"]

# Control characters except tab and line feed, line and paragraph separators, and characters that
# change the direction of writing.
_CONTROL = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")
# Texts that tqdm writes besides its bars: they move the cursor and reset the colour.
_MOVES = re.compile(r"(?:\n|\x1b\[A|\x1b\[0m)*")


def printable(text: str) -> str:
    r"""Escape the control characters of a text.

    >>> printable("\x1b[2Jgrün\n")
    '\\x1b[2Jgrün\n'
    """
    return _CONTROL.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


class _Printable:
    """A stream that escapes control characters.

    Parameters
    ----------
    stream : text stream
    bars : bool
        Whether progress bars are written to the stream. They use carriage returns.
    """

    def __init__(self, stream: TextIO, *, bars: bool) -> None:
        self._stream = stream
        self._bars = bars

    def write(self, text: str) -> int:
        head = ""
        if self._bars:
            if _MOVES.fullmatch(text):
                return self._stream.write(text)
            head = "\r" if text.startswith("\r") else ""
        return self._stream.write(head + printable(text[len(head) :]))

    def writelines(self, lines: Any) -> None:
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def printable_streams() -> Iterator[None]:
    """Escape control characters in all that goes to standard output and standard error."""
    before = sys.stdout, sys.stderr
    sys.stdout = _Printable(sys.stdout, bars=False)
    sys.stderr = _Printable(sys.stderr, bars=True)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
