"""Reading and writing of the integers of RTPS, in either byte order.

The values come from peers, which may be faulty or hostile. So each read is checked against the end
of the bytes, and :class:`MalformedError` is the only error.
"""

from __future__ import annotations

import struct

__all__ = ["MOST_NAME_BYTES", "Cursor", "MalformedError", "padded"]

MOST_NAME_BYTES = 256
"""Most bytes of the name of a topic, a type, a partition or a participant (8.5.4.4, 9.6.2.2)."""


class MalformedError(Exception):
    """Bytes that are not what their place in a datagram asks for."""


def padded(value: bytes, alignment: int = 4) -> bytes:
    """Return `value` with zeros behind, up to a multiple of `alignment` bytes."""
    return value + bytes(-len(value) % alignment)


class Cursor:
    """A place in bytes, which moves forward as values are read.

    * `little`: whether integers are little-endian.
    * `at`: number of the first byte to read.
    """

    __slots__ = ("at", "data", "little", "order")

    def __init__(self, data: bytes, little: bool, at: int = 0):
        self.data = data
        self.little = little
        self.order = "<" if little else ">"
        self.at = at

    @property
    def left(self) -> int:
        """Number of bytes that were not read yet."""
        return len(self.data) - self.at

    def take(self, count: int) -> bytes:
        """Read `count` bytes.

        Raises `MalformedError`: there are fewer bytes left.
        """
        end = self.at + count
        if count < 0 or end > len(self.data):
            raise MalformedError(f"{count} bytes at {self.at} of {len(self.data)}")
        value = self.data[self.at : end]
        self.at = end
        return value

    def align(self, alignment: int) -> None:
        """Skip padding, up to a multiple of `alignment` bytes."""
        self.take(-self.at % alignment)

    def u16(self) -> int:
        """Read an unsigned integer of 16 bits."""
        return self._number("H", 2)

    def u32(self) -> int:
        """Read an unsigned integer of 32 bits."""
        return self._number("I", 4)

    def i32(self) -> int:
        """Read a signed integer of 32 bits."""
        return self._number("i", 4)

    def u32_big(self) -> int:
        """Read an unsigned integer of 32 bits that is big-endian whatever the others are."""
        return int.from_bytes(self.take(4), "big")

    def sequence_number(self) -> int:
        """Read a sequence number: the high 32 bits, signed, then the low 32 bits (9.3.2)."""
        high = self.i32()
        return (high << 32) | self.u32()

    def string(self) -> str:
        """Read a string of CDR: a count of bytes with the final zero, and the bytes.

        All strings of RTPS are names, of at most 256 bytes. Bytes that are not UTF-8 become
        replacement characters.
        """
        size = self.u32()
        if size > MOST_NAME_BYTES + 1:
            raise MalformedError(f"a name of {size - 1} bytes")
        text = self.take(size)
        return text.split(b"\0", 1)[0].decode("utf-8", "replace")

    def _number(self, code: str, size: int) -> int:
        value: int = struct.unpack_from(self.order + code, self.take(size))[0]
        return value
