"""What commands print: control characters are escaped, and a line tells what takes long.

Definitions and names of files come from other people. An escape sequence in a comment could move
the cursor, rename the window or hide text in front of it. So control characters are printed as in
a Python string literal. Letters of any alphabet stay.
"""

from __future__ import annotations

import os
import re
import stat
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, TextIO

__all__ = ["printable", "printable_streams", "progress", "stage"]

SECONDS_UNTIL_SHOWN = 3.0
SECONDS_BETWEEN = 1.0

# Control characters except tab and line feed, line and paragraph separators, and characters that
# change the direction of writing.
_CONTROL = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")


def printable(text: str) -> str:
    r"""Escape the control characters of a text.

    >>> printable("\x1b[2Jgrün\n")
    '\\x1b[2Jgrün\n'
    """
    return _CONTROL.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


class _Printable:
    """A stream that escapes control characters.

    * `replaces`: whether a text may begin with a carriage return, and so replace the line before.
    """

    def __init__(self, stream: TextIO, *, replaces: bool) -> None:
        self._stream = stream
        self._replaces = replaces

    def write(self, text: str) -> int:
        with _line.erased():
            head = "\r" if self._replaces and text.startswith("\r") else ""
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
    sys.stdout = _Printable(sys.stdout, replaces=False)
    sys.stderr = _Printable(sys.stderr, replaces=True)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before


class _Line:
    """A line on a terminal that says what the command does, and for how long."""

    def __init__(self) -> None:
        self.text = ""  # What the command does; empty: no line is shown.
        # How much of it is done; a total of 0: not known.
        self.done = self.total = 0
        self._first, self._since = 0, 0.0
        self._descriptor = -1
        self._process = 0
        self._width = 0
        self._lock = threading.RLock()

    def start(self, descriptor: int, ends: threading.Event) -> threading.Thread:
        """Show the line on a terminal from another thread, until the event is set."""
        self._descriptor, self._process = descriptor, os.getpid()
        thread = threading.Thread(target=self._run, args=(ends,), daemon=True)
        thread.start()
        return thread

    def tell(self, text: str, done: int, total: int) -> None:
        """Set the attributes."""
        if text != self.text:
            self._first, self._since = done, time.monotonic()
        self.text, self.done, self.total = text, done, total

    def _said(self, seconds: float) -> str:
        if not self.text:
            return ""
        if not self.total:
            return f"{self.text}, {seconds:.0f} s"
        said = f"{self.text}: {self.done} of {self.total}, {seconds:.0f} s"
        if self._first < self.done < self.total:
            each = (time.monotonic() - self._since) / (self.done - self._first)
            left = each * (self.total - self.done)
            said += f", {left:.0f} s left" if left < 100 else f", {left / 60:.0f} min left"
        return said

    @contextmanager
    def erased(self) -> Iterator[None]:
        """Take the line away while something else is printed."""
        if self._process != os.getpid():
            # There is no line, or it is that of the process that has forked this one.
            yield
            return
        with self._lock:
            self._show("")
            yield

    def _run(self, ends: threading.Event) -> None:
        began = time.monotonic()
        wait = SECONDS_UNTIL_SHOWN
        while not ends.wait(wait):
            wait = SECONDS_BETWEEN
            with self._lock:
                self._show(self._said(time.monotonic() - began))
        with self._lock:
            self._show("")
            self._process = 0

    def _show(self, text: str) -> None:
        """Write the line in place of the one before, without any buffer that a fork would copy."""
        with suppress(OSError):
            columns = os.get_terminal_size(self._descriptor).columns or 80
            text = printable(text)[: columns - 1]
            if text or self._width:
                end = "" if text else "\r"
                os.write(self._descriptor, f"\r{text.ljust(self._width)}{end}".encode())
            self._width = len(text)


_line = _Line()


def stage(text: str, done: int = 0, total: int = 0) -> None:
    """Say what the command does from now on, for the line of `progress`; empty: show none.

    * `text`: with a total, it names what is counted, such as ``"verify: types"``.
    * `done`, `total`: how much of it is done; a total of 0: not known.
    """
    _line.tell(text, done, total)


@contextmanager
def progress(text: str) -> Iterator[None]:
    """Show what a command does, with its seconds, once it takes more than three.

    The line is on standard error, if that is a terminal, and if standard output is no pipe: the
    reader of the pipe may use the terminal, as ``less`` does. Whatever else is printed takes the
    place of the line.
    """
    stage(text)
    if not _has_terminal():
        yield
        return
    ends = threading.Event()
    thread = _line.start(sys.stderr.fileno(), ends)
    try:
        yield
    finally:
        ends.set()
        thread.join()


def _has_terminal() -> bool:
    with suppress(OSError, ValueError):
        is_pipe = stat.S_ISFIFO(os.fstat(1).st_mode)
        return sys.stderr.isatty() and not is_pipe
    return False
