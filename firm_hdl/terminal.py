"""What commands print: no text of a definition and no name of a file acts on the terminal.

Definitions are other people's. An escape sequence in one of their comments could move the cursor,
rename the window or hide what stands in front of it; so characters that act instead of being seen
are printed as Python would write them. Letters of any alphabet stay.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

__all__ = ["printable", "printable_streams"]

# Control characters but for tab and line feed, line and paragraph separators, and what turns the
# direction of writing round.
_ACTING = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")
# What tqdm writes beside its bars, in texts of its own: it moves, and resets the colour.
_MOVES = re.compile(r"(?:\n|\x1b\[A|\x1b\[0m)*")


def printable(text: str) -> str:
    r"""Give a text in which everything can be seen.

    >>> printable("\x1b[2Jgrün\n")
    '\\x1b[2Jgrün\n'
    """
    return _ACTING.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


class _Printable:
    """A stream that writes what is printable.

    Parameters
    ----------
    stream : text stream
    bars : bool
        Whether progress bars go there, which return to the start of their lines.
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
    """Let nothing but what is printable go to standard output and standard error."""
    before = sys.stdout, sys.stderr
    sys.stdout = _Printable(sys.stdout, bars=False)
    sys.stderr = _Printable(sys.stderr, bars=True)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
