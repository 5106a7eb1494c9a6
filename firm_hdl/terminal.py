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
        with _line.erased():
            return self._write(text)

    def _write(self, text: str) -> int:
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


class _Line:
    """A line on a terminal that says what the command does, and for how long.

    Attributes
    ----------
    text : str
        What the command does; empty: no line is shown.
    """

    def __init__(self) -> None:
        self.text = ""
        self._descriptor = -1
        self._process = 0
        self._width = 0
        self._lock = threading.Lock()

    def start(self, descriptor: int, ends: threading.Event) -> threading.Thread:
        """Show the line on a terminal from another thread, until the event is set."""
        self._descriptor, self._process = descriptor, os.getpid()
        thread = threading.Thread(target=self._run, args=(ends,), daemon=True)
        thread.start()
        return thread

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
            seconds = time.monotonic() - began
            if bars := _bars():
                for bar in bars:
                    bar.refresh()
                continue
            with self._lock:
                self._show(f"{self.text}, {seconds:.0f} s" if self.text else "")
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


def _bars() -> list[Any]:
    """Return the bars of tqdm that are shown; their seconds have to go on, too."""
    module = sys.modules.get("tqdm")
    return [] if module is None else list(getattr(module.tqdm, "_instances", ()))


def stage(text: str) -> None:
    """Say what the command does from now on, for the line of `progress`; empty: show none."""
    _line.text = text


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
