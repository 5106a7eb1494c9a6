"""Frames on a stream of bytes without packets, such as a UART, on the host.

Each frame is followed by its CRC and written in COBS (S. Cheshire, M. Baker, "Consistent Overhead
Byte Stuffing", IEEE/ACM Transactions on Networking 7(2), 1999): no byte of it is 0. A byte 0 stands
before and after it. So a receiver finds the next frame after any garbage.

The CRC is that of Ethernet (IEEE 802.3, 3.2.9), as `zlib.crc32` computes it, little-endian.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass

__all__ = ["CRC_BYTES", "ByteStreamReader", "write_frame"]

CRC_BYTES = 4

MOST_IN_BLOCK = 254
"""Most bytes of a block of COBS that has no 0."""


def write_frame(frame: bytes) -> bytes:
    """Write a frame for a stream of bytes."""
    data = frame + zlib.crc32(frame).to_bytes(CRC_BYTES, "little")
    parts = [b"\0"]
    for part in data.split(b"\0"):
        # A block of 254 bytes stands for no 0, so one more block follows, if need be an empty one.
        while len(part) >= MOST_IN_BLOCK:
            parts.append(b"\xff" + part[:MOST_IN_BLOCK])
            part = part[MOST_IN_BLOCK:]
        parts.append(bytes([len(part) + 1]) + part)
    return b"".join([*parts, b"\0"])


@dataclass(slots=True)
class ByteStreamCounters:
    """What a reader found between the bytes 0."""

    passed: int = 0  # Frames whose CRC is right.
    # Others: a block that is too long, a CRC that is wrong, too few bytes for a CRC.
    damaged: int = 0
    large: int = 0  # Others that have more bytes than the limit.


class ByteStreamReader:
    """Read frames from a stream of bytes.

    * `max_bytes`: largest frame. Of a larger one, nothing is kept.
    """

    def __init__(self, *, max_bytes: int = 1 << 20) -> None:
        # COBS adds a byte per block.
        data = max_bytes + CRC_BYTES
        self._most = data + 1 + data // MOST_IN_BLOCK
        self._block = bytearray()
        self._is_large = False
        self.counters = ByteStreamCounters()

    def feed(self, data: bytes) -> list[bytes]:
        """Take bytes as they come; return the frames that they complete."""
        frames = []
        *ended, rest = data.split(b"\0")
        for part in ended:
            self._add(part)
            frame = self._end()
            if frame is not None:
                frames.append(frame)
        self._add(rest)
        return frames

    def _add(self, part: bytes) -> None:
        if self._is_large or len(self._block) + len(part) > self._most:
            self._is_large = True
            self._block.clear()
        else:
            self._block += part

    def _end(self) -> bytes | None:
        block, large = bytes(self._block), self._is_large
        self._block.clear()
        self._is_large = False
        if large:
            self.counters.large += 1
            return None
        if not block:
            return None
        frame = _checked(block)
        if frame is None:
            self.counters.damaged += 1
        else:
            self.counters.passed += 1
        return frame


def _checked(block: bytes) -> bytes | None:
    """Return the frame of the bytes between two zeros; `None` if it is damaged."""
    parts: list[bytes] = []
    at = 0
    while at < len(block):
        code = block[at]
        end = at + code
        if end > len(block):
            return None
        parts.append(block[at + 1 : end])
        if code <= MOST_IN_BLOCK and end < len(block):
            parts.append(b"\0")
        at = end
    data = b"".join(parts)
    frame, crc = data[:-CRC_BYTES], data[-CRC_BYTES:]
    if len(data) < CRC_BYTES or zlib.crc32(frame).to_bytes(CRC_BYTES, "little") != crc:
        return None
    return frame
