"""Submessages that say what a writer has and what a reader misses (8.3.8, 9.4.5)."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar

from firm_hdl.rtps.wire.numbers import NumberSet, entities, writer_number
from firm_hdl.rtps.wire.octets import Cursor, MalformedError
from firm_hdl.rtps.wire.parameters import sequence_number_bytes

__all__ = ["AckNack", "Gap", "Heartbeat", "HeartbeatFrag", "NackFrag"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Gap:
    """GAP: sequence numbers that the writer will not send to this reader (8.3.8.4).

    These are the numbers from `start` to below ``numbers.base``, and the members of `numbers`.
    """

    KIND: ClassVar[int] = 0x08

    reader: int
    writer: int
    start: int
    numbers: NumberSet

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        bounds = sequence_number_bytes(self.start, order)
        bounds += sequence_number_bytes(self.numbers.base, order)
        return 0, entities(self.reader, self.writer) + bounds + self.numbers.bitmap(order)

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> Gap:
        """Read the bytes behind the header."""
        reader, writer = cursor.u32_big(), cursor.u32_big()
        start = writer_number(cursor)
        numbers = NumberSet.decode(cursor, cursor.sequence_number())
        return cls(reader=reader, writer=writer, start=start, numbers=numbers)


@dataclass(frozen=True, slots=True, kw_only=True)
class Heartbeat:
    """HEARTBEAT: the sequence numbers that a writer has (8.3.8.6).

    Attributes
    ----------
    first, last : int
        Lowest and highest number. If there are none, `last` is ``first - 1``.
    count : int
        Number of this heartbeat, modulo 2**32 (8.4.15.7).
    final : bool
        Whether a reader that misses nothing need not answer.
    """

    KIND: ClassVar[int] = 0x07

    reader: int
    writer: int
    first: int
    last: int
    count: int
    final: bool = False

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        bounds = sequence_number_bytes(self.first, order) + sequence_number_bytes(self.last, order)
        count = struct.pack(order + "I", self.count)
        return 0x02 if self.final else 0, entities(self.reader, self.writer) + bounds + count

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> Heartbeat:
        """Read the bytes behind the header."""
        reader, writer = cursor.u32_big(), cursor.u32_big()
        first, last = writer_number(cursor), cursor.sequence_number()
        if last < first - 1:
            raise MalformedError(f"a heartbeat from {first} to {last}")
        final = bool(flags & 0x02)
        count = cursor.u32()
        return cls(reader=reader, writer=writer, first=first, last=last, count=count, final=final)


@dataclass(frozen=True, slots=True, kw_only=True)
class AckNack:
    """ACKNACK: the sequence numbers that a reader has, and those that it misses (8.3.8.1).

    `missing` has the base of what is not acknowledged. `final` says that no heartbeat is asked for.
    """

    KIND: ClassVar[int] = 0x06

    reader: int
    writer: int
    missing: NumberSet
    count: int
    final: bool = False

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        numbers = sequence_number_bytes(self.missing.base, order) + self.missing.bitmap(order)
        count = struct.pack(order + "I", self.count)
        return 0x02 if self.final else 0, entities(self.reader, self.writer) + numbers + count

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> AckNack:
        """Read the bytes behind the header. Fast DDS begins with base 0, which is let pass."""
        reader, writer = cursor.u32_big(), cursor.u32_big()
        missing = NumberSet.decode(cursor, cursor.sequence_number())
        final = bool(flags & 0x02)
        count = cursor.u32()
        return cls(reader=reader, writer=writer, missing=missing, count=count, final=final)


@dataclass(frozen=True, slots=True, kw_only=True)
class HeartbeatFrag:
    """HEARTBEAT_FRAG: the fragments of a sample that a writer has sent (8.3.8.7)."""

    KIND: ClassVar[int] = 0x13

    reader: int
    writer: int
    sequence_number: int
    last: int
    count: int

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        number = sequence_number_bytes(self.sequence_number, order)
        rest = struct.pack(order + "II", self.last, self.count)
        return 0, entities(self.reader, self.writer) + number + rest

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> HeartbeatFrag:
        """Read the bytes behind the header."""
        reader, writer = cursor.u32_big(), cursor.u32_big()
        number = writer_number(cursor)
        last, count = cursor.u32(), cursor.u32()
        return cls(reader=reader, writer=writer, sequence_number=number, last=last, count=count)


@dataclass(frozen=True, slots=True, kw_only=True)
class NackFrag:
    """NACK_FRAG: the fragments of a sample that a reader misses (8.3.8.12)."""

    KIND: ClassVar[int] = 0x12

    reader: int
    writer: int
    sequence_number: int
    missing: NumberSet
    count: int

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        number = sequence_number_bytes(self.sequence_number, order)
        missing = struct.pack(order + "I", self.missing.base) + self.missing.bitmap(order)
        count = struct.pack(order + "I", self.count)
        return 0, entities(self.reader, self.writer) + number + missing + count

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> NackFrag:
        """Read the bytes behind the header."""
        reader, writer = cursor.u32_big(), cursor.u32_big()
        number = writer_number(cursor)
        missing = NumberSet.decode(cursor, cursor.u32())
        count = cursor.u32()
        return cls(
            reader=reader, writer=writer, sequence_number=number, missing=missing, count=count
        )
