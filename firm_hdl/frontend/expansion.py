"""How much a recording may expand to: rosbags decompresses whatever comes, without an end.

A chunk or a file of some kilobytes can stand for gigabytes, in memory or on the disk. What rosbags
decompresses with is therefore replaced by functions that count what comes out, as long as a
recording is `bounded`. They are found by their names in rosbags' modules; without a recording they
do what those do.
"""

from __future__ import annotations

import bz2
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from io import BytesIO
from types import TracebackType
from typing import IO, Any

import lz4.frame  # type: ignore[import-untyped]
from rosbags.rosbag1 import reader as rosbag1
from rosbags.rosbag2 import reader as rosbag2
from rosbags.rosbag2 import storage_mcap

__all__ = ["LEAST", "MOST_AT_ONCE", "RATIO", "Budget", "bounded"]

LEAST = 1 << 28
"""So much may come out of any recording, in bytes."""

RATIO = 100
"""And so many times its own size. Recordings of real sensors shrink to a third, or to a tenth."""

MOST_AT_ONCE = 1 << 29
"""And so many from one chunk, which is held in memory. Writers close chunks at some megabytes."""

_PIECE = 1 << 20


class TooLargeError(Exception):
    """More would come out of a recording than its size lets one expect."""


class Budget:
    """What may still come out of a recording.

    Parameters
    ----------
    compressed : int
        Size of its files, in bytes.

    Attributes
    ----------
    excess : str
        What there was too much of; empty as long as there is not.
    """

    def __init__(self, compressed: int) -> None:
        self._most = max(LEAST, RATIO * compressed)
        self._left = self._most
        self.excess = ""

    def take(self, count: int) -> None:
        """Count bytes that came out."""
        self._left -= count
        if self._left < 0:
            self._refuse(f"more than {self._most} bytes come out of it when it is decompressed")

    def check_block(self, count: int) -> None:
        """Check how many bytes of one chunk came out so far."""
        if count > MOST_AT_ONCE:
            self._refuse(f"it has a chunk of more than {MOST_AT_ONCE} bytes")

    def _refuse(self, reason: str) -> None:
        self.excess = reason
        raise TooLargeError(reason)


_BUDGET: ContextVar[Budget | None] = ContextVar("budget", default=None)


@contextmanager
def bounded(path: str) -> Iterator[Budget]:
    """Bound what rosbags decompresses of a recording.

    When more would come out, reading fails, and the budget says so.
    """
    budget = Budget(_size(path))
    token = _BUDGET.set(budget)
    try:
        yield budget
    finally:
        _BUDGET.reset(token)


def _size(path: str) -> int:
    if not os.path.isdir(path):
        return os.stat(path).st_size
    with os.scandir(path) as entries:
        return sum(entry.stat().st_size for entry in entries if entry.is_file())


class _CountedFile:
    """A file that decompresses, of which what is read is counted."""

    def __init__(self, file: IO[bytes], budget: Budget) -> None:
        self._file = file
        self._budget = budget

    def __enter__(self) -> _CountedFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._file.close()

    def read(self, size: int) -> bytes:
        """Read so many bytes, at most."""
        data = self._file.read(size)
        self._budget.take(len(data))
        return data


def _counted(
    open_: Callable[..., Any], decompress: Callable[[bytes], bytes]
) -> Callable[[bytes], bytes]:
    """Give a function that decompresses like another, and stops where the budget ends."""

    def decompress_counted(data: bytes) -> bytes:
        budget = _BUDGET.get()
        if budget is None:
            return decompress(data)
        block = bytearray()
        with _CountedFile(open_(BytesIO(data), "rb"), budget) as file:
            while piece := file.read(_PIECE):
                block += piece
                budget.check_block(len(block))
        return bytes(block)

    return decompress_counted


class _CountedZstd:
    """What rosbags uses of a module zstd to read files.

    Parameters
    ----------
    module : module
    """

    def __init__(self, module: Any) -> None:
        self._module = module
        self.decompress = _counted(module.open, module.decompress)

    def open(self, file: IO[bytes], mode: str) -> Any:
        """Open a file."""
        budget = _BUDGET.get()
        found = self._module.open(file, mode)
        return found if budget is None else _CountedFile(found, budget)


def _count() -> None:
    """Replace what rosbags decompresses with."""
    lz4_ = _counted(lz4.frame.open, lz4.frame.decompress)
    rosbag1.decompressors.update(bz2=_counted(bz2.open, bz2.decompress), lz4=lz4_)
    # Which module it is depends on the versions of Python and of rosbags.
    modules = vars(storage_mcap)
    zstd = _CountedZstd(modules["zstd" if "zstd" in modules else "zstandard"])
    storage_mcap.DECOMPRESSORS["lz4"] = lambda data, _: lz4_(data)
    storage_mcap.DECOMPRESSORS["zstd"] = lambda data, _: zstd.decompress(data)
    if "zstd" in vars(rosbag2):
        vars(rosbag2)["zstd"] = zstd


_count()
