"""DATA and DATA_FRAG: the submessages with samples (8.3.8.2, 8.3.8.3, 9.4.5)."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar

from firm_hdl.rtps.wire.numbers import entities, writer_number
from firm_hdl.rtps.wire.octets import Cursor, MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList, sequence_number_bytes

__all__ = ["NO_PARAMETERS", "Data", "DataFrag"]

NO_PARAMETERS = ParameterList(())
"""Inline QoS of a sample that has none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Data:
    """DATA: a sample, or the end of an instance (8.3.8.2).

    Attributes
    ----------
    reader, writer : int
        Entity identifiers. Reader 0 means all matched readers.
    sequence_number : int
        The number of the sample, from 1 on.
    payload : bytes or None
        The serialized sample with its encapsulation header; the serialized key if `key`.
    inline : ParameterList
        Inline QoS.
    """

    KIND: ClassVar[int] = 0x15

    reader: int
    writer: int
    sequence_number: int
    payload: bytes | None
    key: bool = False
    inline: ParameterList = NO_PARAMETERS

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        inline = self.inline.encode() if self.inline.items else b""
        content = 0 if self.payload is None else 0x08 if self.key else 0x04
        head = struct.pack(order + "HH", 0, 16) + entities(self.reader, self.writer)
        head += sequence_number_bytes(self.sequence_number, order) + inline
        return (0x02 if inline else 0) | content, head + (self.payload or b"")

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> Data:
        """Read the bytes behind the header."""
        cursor.u16()
        skip = cursor.u16()
        start = cursor.at
        reader, writer = cursor.u32_big(), cursor.u32_big()
        number = writer_number(cursor)
        # 9.4.5.4: a later version may have more fields before the inline QoS.
        cursor.at = start
        cursor.take(max(skip, 16))
        inline = ParameterList.decode(cursor) if flags & 0x02 else NO_PARAMETERS
        if flags & 0x04 and flags & 0x08:
            raise MalformedError("data and key at once")
        payload = cursor.take(cursor.left) if flags & 0x0C else None
        return cls(
            reader=reader,
            writer=writer,
            sequence_number=number,
            payload=payload,
            key=bool(flags & 0x08),
            inline=inline,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class DataFrag:
    """DATA_FRAG: consecutive fragments of a sample (8.3.8.3).

    Attributes
    ----------
    first, count : int
        Number of the first fragment, from 1 on, and how many there are.
    fragment_bytes, sample_bytes : int
        Size of every fragment but the last, and of the whole sample with its encapsulation header.
    payload : bytes
        The bytes of these fragments.
    """

    KIND: ClassVar[int] = 0x16

    reader: int
    writer: int
    sequence_number: int
    first: int
    count: int
    fragment_bytes: int
    sample_bytes: int
    payload: bytes
    inline: ParameterList = NO_PARAMETERS

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        inline = self.inline.encode() if self.inline.items else b""
        head = struct.pack(order + "HH", 0, 28) + entities(self.reader, self.writer)
        head += sequence_number_bytes(self.sequence_number, order)
        sizes = (self.first, self.count, self.fragment_bytes, self.sample_bytes)
        head += struct.pack(order + "IHHI", *sizes) + inline
        return 0x02 if inline else 0, head + self.payload

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> DataFrag:
        """Read the bytes behind the header."""
        cursor.u16()
        skip = cursor.u16()
        start = cursor.at
        reader, writer = cursor.u32_big(), cursor.u32_big()
        number = writer_number(cursor)
        first, count = cursor.u32(), cursor.u16()
        size, whole = cursor.u16(), cursor.u32()
        if not (first and count and size) or (first + count - 2) * size >= whole:
            raise MalformedError(f"{count} fragments of {size} bytes from {first} of {whole} bytes")
        cursor.at = start
        cursor.take(max(skip, 28))
        inline = ParameterList.decode(cursor) if flags & 0x02 else NO_PARAMETERS
        # Bytes behind the last fragment are padding.
        expected = min(count * size, whole - (first - 1) * size)
        payload = cursor.take(expected)
        return cls(
            reader=reader,
            writer=writer,
            sequence_number=number,
            first=first,
            count=count,
            fragment_bytes=size,
            sample_bytes=whole,
            payload=payload,
            inline=inline,
        )
