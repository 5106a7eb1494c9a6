"""Limits on what a recording may make its reader do.

A file of some kilobytes may state that gigabytes follow, or decompress to gigabytes. So a `Cursor`
reads only bytes that are there, and a `Budget` counts what is decompressed and what is kept.
"""

from __future__ import annotations

import bz2
import os
import sys
from collections.abc import Callable, Iterator
from io import BytesIO
from typing import IO, Any, BinaryIO

import lz4.frame  # type: ignore[import-untyped]

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

__all__ = [
    "MAX_BLOCK_BYTES",
    "MAX_RATIO",
    "MAX_TEXTS_BYTES",
    "MAX_TEXT_BYTES",
    "MAX_TOPICS",
    "MAX_WORD_BYTES",
    "MIN_BUDGET_BYTES",
    "Budget",
    "Cursor",
    "UnreadableError",
    "word_of",
]

MIN_BUDGET_BYTES = 1 << 28
"""Number of decompressed bytes that a recording of any size may have."""

MAX_RATIO = 100
"""Most decompressed bytes per byte of a recording. Recordings of real sensors have 3 to 10."""

MAX_BLOCK_BYTES = 1 << 29
"""Most bytes of a chunk or a message, which is held in memory. Writers make chunks of megabytes."""

MAX_TOPICS = 1 << 14
"""Most topics, and most types, of a recording. Large systems have some thousands."""

MAX_TEXT_BYTES = 1 << 22
"""Most bytes of a definition, as of a file with a definition."""

MAX_TEXTS_BYTES = 1 << 26
"""Most bytes of all definitions together."""

MAX_WORD_BYTES = 1 << 12
"""Most bytes of a name."""

_PIECE_BYTES = 1 << 20

_OPEN: dict[str, Callable[..., Any]] = {"bz2": bz2.open, "lz4": lz4.frame.open, "zstd": zstd.open}


class UnreadableError(Exception):
    """A recording cannot be read. The message is the reason: a clause about the recording."""


def word_of(data: bytes | None) -> str:
    """Read a name. If it is too long, it is empty; what is not UTF-8 is replaced by signs."""
    if data is None or len(data) > MAX_WORD_BYTES:
        return ""
    return data.decode("utf-8", "replace")


class Cursor:
    """A place in a file, and the number of bytes that may be read from there.

    * `file`: a file that is at this place.
    """

    def __init__(self, file: BinaryIO, left: int) -> None:
        self._file = file
        self.left = left

    def take(self, count: int) -> bytes:
        """Read bytes; raise `UnreadableError` if so many are not left, or are too many."""
        self._pass(count)
        if count > MAX_BLOCK_BYTES:
            raise UnreadableError(
                f"it has a chunk or a message of more than {MAX_BLOCK_BYTES} bytes"
            )
        data = self._file.read(count)
        if len(data) < count:
            raise UnreadableError("it became shorter while it was read")
        return data

    def number(self, size: int) -> int:
        """Read an unsigned number, the least significant byte first."""
        return int.from_bytes(self.take(size), "little")

    def word(self) -> str:
        """Read a name after its length, as `word_of` does."""
        size = self.number(4)
        if size > MAX_WORD_BYTES:
            self.part(size).skip()
            return ""
        return word_of(self.take(size))

    def part(self, count: int) -> Cursor:
        """Return a cursor for the next bytes. It has to be at its end before this one goes on."""
        self._pass(count)
        return Cursor(self._file, count)

    def skip(self) -> None:
        """Go to the end."""
        if self.left:
            self._file.seek(self.left, os.SEEK_CUR)
        self.left = 0

    def _pass(self, count: int) -> None:
        if count > self.left:
            raise UnreadableError("it is damaged or incomplete")
        self.left -= count


class Budget:
    """How much a recording may still be decompressed to, and how long its definitions may be.

    * `compressed`: size of the recording's files, in bytes.
    """

    def __init__(self, compressed: int) -> None:
        self._limit = self._left = max(MIN_BUDGET_BYTES, MAX_RATIO * compressed)
        self._texts = MAX_TEXTS_BYTES

    def begin_file(self) -> None:
        """Count definitions anew, because each file of a recording repeats them."""
        self._texts = MAX_TEXTS_BYTES

    def text(self, cursor: Cursor) -> bytes | None:
        """Read a definition up to the end of a cursor; `None` if it is too long."""
        if cursor.left > MAX_TEXT_BYTES:
            cursor.skip()
            return None
        self.keep(cursor.left)
        return cursor.take(cursor.left)

    def keep(self, size: int) -> None:
        """Count the bytes of a definition."""
        self._texts -= size
        if self._texts < 0:
            raise UnreadableError(f"its definitions have more than {MAX_TEXTS_BYTES} bytes")

    def count(self, size: int) -> None:
        """Count bytes that come out of the recording."""
        self._left -= size
        if self._left < 0:
            raise UnreadableError(f"it expands to more than {self._limit} bytes")

    def expand(self, data: bytes, compression: str, size: int | None = None) -> bytes:
        """Decompress a message, or a chunk that states its size."""
        if size is not None and size > MAX_BLOCK_BYTES:
            raise UnreadableError(f"it has a chunk of more than {MAX_BLOCK_BYTES} bytes")
        most = MAX_BLOCK_BYTES if size is None else size
        block = bytearray()
        for piece in self.pieces(BytesIO(data), compression):
            block += piece
            if len(block) > most:
                break
        if size is None and len(block) > most:
            raise UnreadableError(f"it has a message of more than {MAX_BLOCK_BYTES} bytes")
        if size is not None and len(block) != size:
            raise UnreadableError("it is damaged: a chunk has not the size that it states")
        return bytes(block)

    def pieces(self, file: BinaryIO, compression: str) -> Iterator[bytes]:
        """Decompress a file piece by piece."""
        if compression not in _OPEN:
            known = ", ".join(_OPEN)
            raise UnreadableError(f"it is compressed by '{compression}', and only {known} are read")
        with _OPEN[compression](file, "rb") as expanded:
            while piece := _read(expanded):
                self.count(len(piece))
                yield piece


def _read(file: IO[bytes]) -> bytes:
    try:
        return file.read(_PIECE_BYTES)
    except MemoryError:
        raise
    except Exception:
        # The exceptions of the decompressors for damaged data have no common base class.
        raise UnreadableError("it is damaged: a part of it cannot be decompressed") from None
