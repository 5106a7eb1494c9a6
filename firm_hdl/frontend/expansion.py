"""Limit how much a recording may expand to: rosbags decompresses without any limit.

A chunk or a file of some kilobytes can expand to gigabytes, in memory or on the disk. Therefore,
this module replaces the decompression functions in rosbags' modules. The replacements count the
decompressed bytes inside `bounded`. Outside, they behave like the originals.
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

__all__ = ["MAX_CHUNK_BYTES", "MAX_RATIO", "MIN_BUDGET_BYTES", "Budget", "bounded"]

MIN_BUDGET_BYTES = 1 << 28
"""Number of decompressed bytes that a recording of any size may have."""

MAX_RATIO = 100
"""Most decompressed bytes per byte of a recording. Recordings of real sensors have 3 to 10."""

MAX_CHUNK_BYTES = 1 << 29
"""Most decompressed bytes of a chunk, which is held in memory. Writers make chunks of megabytes."""

_READ_BYTES = 1 << 20


class TooLargeError(Exception):
    """A recording would decompress to more bytes than its budget."""


class Budget:
    """The number of bytes to which a recording may still be decompressed.

    Parameters
    ----------
    compressed : int
        Size of the recording's files, in bytes.

    Attributes
    ----------
    excess : str
        Why the budget was exceeded; empty if it was not exceeded.
    """

    def __init__(self, compressed: int) -> None:
        self._limit = max(MIN_BUDGET_BYTES, MAX_RATIO * compressed)
        self._remaining = self._limit
        self.excess = ""

    def take(self, count: int) -> None:
        """Count decompressed bytes."""
        self._remaining -= count
        if self._remaining < 0:
            self._refuse(f"it decompresses to more than {self._limit} bytes")

    def check_block(self, count: int) -> None:
        """Check the number of decompressed bytes of one chunk."""
        if count > MAX_CHUNK_BYTES:
            self._refuse(f"it has a chunk of more than {MAX_CHUNK_BYTES} bytes")

    def _refuse(self, reason: str) -> None:
        self.excess = reason
        raise TooLargeError(reason)


_BUDGET: ContextVar[Budget | None] = ContextVar("budget", default=None)


@contextmanager
def bounded(path: str) -> Iterator[Budget]:
    """Limit how much of a recording rosbags decompresses.

    Over the limit, reading fails, and the budget's `excess` says why.
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
    """A decompressing file whose read bytes are counted."""

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
        """Read at most `size` bytes."""
        data = self._file.read(size)
        self._budget.take(len(data))
        return data


def _counted(
    open_: Callable[..., Any], decompress: Callable[[bytes], bytes]
) -> Callable[[bytes], bytes]:
    """Wrap a decompressor so that it stops at the end of the budget."""

    def decompress_counted(data: bytes) -> bytes:
        budget = _BUDGET.get()
        if budget is None:
            return decompress(data)
        block = bytearray()
        with _CountedFile(open_(BytesIO(data), "rb"), budget) as file:
            while piece := file.read(_READ_BYTES):
                block += piece
                budget.check_block(len(block))
        return bytes(block)

    return decompress_counted


class _CountedZstd:
    """The part of a zstd module that rosbags uses to read files, with counting.

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
        opened = self._module.open(file, mode)
        return opened if budget is None else _CountedFile(opened, budget)


def _install() -> None:
    """Replace the functions with which rosbags decompresses."""
    lz4_ = _counted(lz4.frame.open, lz4.frame.decompress)
    rosbag1.decompressors.update(bz2=_counted(bz2.open, bz2.decompress), lz4=lz4_)
    # The name of the module depends on the versions of Python and of rosbags.
    modules = vars(storage_mcap)
    zstd = _CountedZstd(modules["zstd" if "zstd" in modules else "zstandard"])
    storage_mcap.DECOMPRESSORS["lz4"] = lambda data, _: lz4_(data)
    storage_mcap.DECOMPRESSORS["zstd"] = lambda data, _: zstd.decompress(data)
    if "zstd" in vars(rosbag2):
        vars(rosbag2)["zstd"] = zstd


_install()
