"""Recordings that expand to many zeros, made for one test."""

from __future__ import annotations

import bz2
import sqlite3
import struct
import sys
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import lz4.frame
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

__all__ = ["BOMBS"]

_MAGIC = b"\x89MCAP0\r\n"
_PIECE = bytes(1 << 20)


def _zeros(open_: Callable[..., Any], count: int) -> bytes:
    target = BytesIO()
    with open_(target, "wb") as file:
        for _ in range(count >> 20):
            file.write(_PIECE)
    return target.getvalue()


def _mcap(path: Path, chunks: list[bytes], size: int, compression: str) -> Path:
    """Write a file without an index, so that the reader scans all of it."""

    def record(kind: int, data: bytes) -> bytes:
        return struct.pack("<BQ", kind, len(data)) + data

    def text(value: str) -> bytes:
        return struct.pack("<I", len(value)) + value.encode()

    head = struct.pack("<QQQI", 1, 1, size, 0) + text(compression)
    pieces = [record(6, head + struct.pack("<Q", len(each)) + each) for each in chunks]
    start, end = record(1, text("ros2") + text("")), record(2, bytes(20))
    path.write_bytes(_MAGIC + start + b"".join(pieces) + end + _MAGIC)
    return path


def _zstd_mcap(folder: Path, count: int) -> Path:
    return _mcap(folder / "x.mcap", [_zeros(zstd.open, count)], count, "zstd")


def _chunked_mcap(folder: Path, count: int) -> Path:
    # A record of no known kind, filled with zeros.
    chunk = b"\xff" + struct.pack("<Q", (1 << 20) - 9) + bytes((1 << 20) - 9)
    return _mcap(folder / "x.mcap", [zstd.compress(chunk)] * (count >> 20), 1 << 20, "zstd")


def _lz4_mcap(folder: Path, count: int) -> Path:
    return _mcap(folder / "x.mcap", [_zeros(lz4.frame.open, count)], count, "lz4")


def _bag(folder: Path, count: int, compression: str, open_: Callable[..., Any]) -> Path:
    path = folder / "x.bag"
    writer = Writer1(path)
    writer.set_compression(getattr(writer.CompressionFormat, compression))
    chunk = _zeros(open_, count)
    writer.compressor = lambda data: chunk
    with writer:
        connection = writer.add_connection("/t", "p/msg/A", msgdef="int8 a\n", md5sum="0" * 32)
        writer.write(connection, 1, b"\1")
    data = path.read_bytes()
    place = data.index(b"size=") + len(b"size=")
    path.write_bytes(data[:place] + struct.pack("<I", count) + data[place + 4 :])
    return path


def _database(folder: Path, mode: CompressionMode) -> Path:
    path = folder / "x"
    writer = Writer2(path, version=9, storage_plugin=StoragePlugin.SQLITE3)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        hashed = "RIHS01_" + "0" * 64
        connection = writer.add_connection("/t", "p/msg/A", msgdef="int8 a\n", rihs01=hashed)
        writer.write(connection, 1, b"\0\1\0\0\1")
    return path


def _compressed_database(folder: Path, count: int) -> Path:
    path = _database(folder, CompressionMode.FILE)
    (file,) = path.glob("*.zstd")
    # A database may have any bytes after its end.
    with file.open("ab") as end:
        end.write(_zeros(zstd.open, count))
    return path


def _compressed_message(folder: Path, count: int) -> Path:
    path = _database(folder, CompressionMode.MESSAGE)
    (file,) = path.glob("*.db3")
    with sqlite3.connect(file) as database:
        database.execute("UPDATE messages SET data = ?", (_zeros(zstd.open, count),))
    database.close()
    return path


BOMBS: dict[str, Callable[[Path, int], Path]] = {
    "mcap of zstd": _zstd_mcap,
    "mcap of many chunks": _chunked_mcap,
    "mcap of lz4": _lz4_mcap,
    "bag of bz2": lambda folder, count: _bag(folder, count, "BZ2", bz2.open),
    "bag of lz4": lambda folder, count: _bag(folder, count, "LZ4", lz4.frame.open),
    "compressed database": _compressed_database,
    "compressed message": _compressed_message,
}
"""Functions that make a recording in a folder, out of which so many bytes come."""
