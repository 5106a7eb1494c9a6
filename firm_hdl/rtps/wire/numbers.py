"""Parts that several submessages have: sets of numbers, entity identifiers, sequence numbers."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

from firm_hdl.rtps.wire.octets import Cursor, MalformedError

__all__ = ["NumberSet", "entities", "writer_number"]


@dataclass(frozen=True, slots=True)
class NumberSet:
    """A set of sequence numbers or of fragment numbers (8.3.5.5, 8.3.5.7).

    Attributes
    ----------
    base : int
        All numbers below it are received, or irrelevant.
    members : tuple of int
        The numbers in the set, ascending, each less than ``base + 256``.
    """

    base: int
    members: tuple[int, ...] = ()

    MAX_SIZE: ClassVar[int] = 256

    @classmethod
    def of(cls, base: int, members: Iterable[int]) -> NumberSet:
        """Return the set of those `members` that fit behind `base`."""
        last = base + cls.MAX_SIZE
        return cls(base, tuple(sorted(each for each in members if base <= each < last)))

    def bitmap(self, order: str) -> bytes:
        """Return the count of bits, and the bits: the first is the highest of a word (9.4.2.6)."""
        size = self.members[-1] - self.base + 1 if self.members else 0
        count = (size + 31) // 32
        top = self.base + 32 * count - 1
        bits = sum(1 << (top - each) for each in self.members)
        words = struct.unpack(f">{count}I", bits.to_bytes(4 * count, "big"))
        return struct.pack(f"{order}I{count}I", size, *words)

    @classmethod
    def decode(cls, cursor: Cursor, base: int) -> NumberSet:
        """Read the bits behind `base`. More than 256 are an error (8.3.5.5)."""
        size = cursor.u32()
        if size > cls.MAX_SIZE or base < 0:
            raise MalformedError(f"a set of {size} numbers from {base}")
        words = [cursor.u32() for _ in range((size + 31) // 32)]
        numbers = range(size)
        return cls(base, tuple(base + n for n in numbers if words[n // 32] >> (31 - n % 32) & 1))


def entities(reader: int, writer: int) -> bytes:
    """Return the entity identifiers, whose byte order is the same on every wire (9.3.1.2)."""
    return struct.pack(">II", reader, writer)


def writer_number(cursor: Cursor) -> int:
    """Read a sequence number of a writer, which is at least 1 (8.3.5.4)."""
    number = cursor.sequence_number()
    if number < 1:
        raise MalformedError(f"sequence number {number}")
    return number
