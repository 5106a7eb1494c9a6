"""The submessages of a datagram: what endpoints tell each other (8.3.8, 9.4.5).

Each class has the number of its kind, `body` and `decode`: from its fields to the flags and the
bytes behind the header, and back. `order` is that of :mod:`struct`. A reader or a writer is an
entity identifier.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, TypeAlias, get_args

from firm_hdl.rtps.wire.guid import VENDOR
from firm_hdl.rtps.wire.octets import Cursor, MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList, sequence_number_bytes

__all__ = [
    "NO_PARAMETERS",
    "AckNack",
    "Data",
    "DataFrag",
    "Gap",
    "Heartbeat",
    "HeartbeatFrag",
    "InfoDestination",
    "InfoSource",
    "InfoTimestamp",
    "NackFrag",
    "NumberSet",
    "Submessage",
    "decode",
    "encode",
    "fragment",
    "fragment_count",
]

NO_PARAMETERS = ParameterList(())
"""Inline QoS of a sample that has none."""

# Flags of all submessages, of HEARTBEAT and ACKNACK, and of DATA and DATA_FRAG.
_LITTLE, _FINAL = 0x01, 0x02
_INLINE, _DATA, _KEY = 0x02, 0x04, 0x08


@dataclass(frozen=True, slots=True)
class InfoDestination:
    """INFO_DST: the participant that the following submessages are for (8.3.8.8)."""

    KIND: ClassVar[int] = 0x0E

    prefix: bytes

    def body(self, order: str) -> tuple[int, bytes]:
        return 0, self.prefix

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> InfoDestination:
        return cls(cursor.take(12))


@dataclass(frozen=True, slots=True)
class InfoSource:
    """INFO_SRC: the participant that the following submessages come from (8.3.8.10)."""

    KIND: ClassVar[int] = 0x0C

    prefix: bytes
    version: bytes = b"\x02\x03"
    vendor: bytes = VENDOR

    def body(self, order: str) -> tuple[int, bytes]:
        return 0, bytes(4) + self.version + self.vendor + self.prefix

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> InfoSource:
        cursor.take(4)
        version, vendor = cursor.take(2), cursor.take(2)
        return cls(cursor.take(12), version, vendor)


@dataclass(frozen=True, slots=True)
class InfoTimestamp:
    """INFO_TS: the time of the following submessages (8.3.8.11)."""

    KIND: ClassVar[int] = 0x09

    # Time since 1970 in nanoseconds, or `None` for no time. The wire has seconds, unsigned, and
    # fractions of 2**-32 s (9.3.2).
    nanoseconds: int | None

    def body(self, order: str) -> tuple[int, bytes]:
        if self.nanoseconds is None:
            return 0x02, b""
        seconds, rest = divmod(self.nanoseconds, 10**9)
        # Rounded up, so that reading gives the same nanosecond again.
        fraction = -(-(rest << 32) // 10**9)
        return 0, struct.pack(order + "II", seconds & 0xFFFF_FFFF, fraction)

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> InfoTimestamp:
        if flags & 0x02:
            return cls(None)
        seconds, fraction = cursor.u32(), cursor.u32()
        return cls(seconds * 10**9 + (fraction * 10**9 >> 32))


@dataclass(frozen=True, slots=True)
class NumberSet:
    """A set of sequence numbers or of fragment numbers (8.3.5.5, 8.3.5.7)."""

    base: int  # All numbers below it are received, or irrelevant.
    members: tuple[int, ...] = ()  # The numbers in the set, ascending, each less than `base + 256`.

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


@dataclass(frozen=True, slots=True)
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
        bounds = sequence_number_bytes(self.start, order)
        bounds += sequence_number_bytes(self.numbers.base, order)
        return 0, _entities(self.reader, self.writer) + bounds + self.numbers.bitmap(order)

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> Gap:
        reader, writer = cursor.u32_big(), cursor.u32_big()
        start = _writer_number(cursor)
        return cls(reader, writer, start, NumberSet.decode(cursor, cursor.sequence_number()))


@dataclass(frozen=True, slots=True)
class Heartbeat:
    """HEARTBEAT: the sequence numbers that a writer has (8.3.8.6)."""

    KIND: ClassVar[int] = 0x07

    reader: int
    writer: int
    # Lowest and highest number. If there are none, `last` is `first - 1`.
    first: int
    last: int
    count: int  # Number of this heartbeat, modulo 2**32 (8.4.15.7).
    final: bool = False  # Whether a reader that misses nothing need not answer.

    def body(self, order: str) -> tuple[int, bytes]:
        bounds = sequence_number_bytes(self.first, order) + sequence_number_bytes(self.last, order)
        count = struct.pack(order + "I", self.count)
        return _FINAL * self.final, _entities(self.reader, self.writer) + bounds + count

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> Heartbeat:
        reader, writer = cursor.u32_big(), cursor.u32_big()
        first, last = _writer_number(cursor), cursor.sequence_number()
        if last < first - 1:
            raise MalformedError(f"a heartbeat from {first} to {last}")
        return cls(reader, writer, first, last, cursor.u32(), bool(flags & _FINAL))


@dataclass(frozen=True, slots=True)
class AckNack:
    """ACKNACK: the sequence numbers that a reader has, and those that it misses (8.3.8.1).

    `missing` has the base of what is not acknowledged. Fast DDS begins with base 0, which is let
    pass. `final` says that no heartbeat is asked for.
    """

    KIND: ClassVar[int] = 0x06

    reader: int
    writer: int
    missing: NumberSet
    count: int
    final: bool = False

    def body(self, order: str) -> tuple[int, bytes]:
        numbers = sequence_number_bytes(self.missing.base, order) + self.missing.bitmap(order)
        count = struct.pack(order + "I", self.count)
        return _FINAL * self.final, _entities(self.reader, self.writer) + numbers + count

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> AckNack:
        reader, writer = cursor.u32_big(), cursor.u32_big()
        missing = NumberSet.decode(cursor, cursor.sequence_number())
        return cls(reader, writer, missing, cursor.u32(), bool(flags & _FINAL))


@dataclass(frozen=True, slots=True)
class HeartbeatFrag:
    """HEARTBEAT_FRAG: the fragments of a sample that a writer has sent (8.3.8.7)."""

    KIND: ClassVar[int] = 0x13

    reader: int
    writer: int
    sequence_number: int
    last: int
    count: int

    def body(self, order: str) -> tuple[int, bytes]:
        number = sequence_number_bytes(self.sequence_number, order)
        rest = struct.pack(order + "II", self.last, self.count)
        return 0, _entities(self.reader, self.writer) + number + rest

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> HeartbeatFrag:
        reader, writer = cursor.u32_big(), cursor.u32_big()
        return cls(reader, writer, _writer_number(cursor), cursor.u32(), cursor.u32())


@dataclass(frozen=True, slots=True)
class NackFrag:
    """NACK_FRAG: the fragments of a sample that a reader misses (8.3.8.12)."""

    KIND: ClassVar[int] = 0x12

    reader: int
    writer: int
    sequence_number: int
    missing: NumberSet
    count: int

    def body(self, order: str) -> tuple[int, bytes]:
        number = sequence_number_bytes(self.sequence_number, order)
        missing = struct.pack(order + "I", self.missing.base) + self.missing.bitmap(order)
        count = struct.pack(order + "I", self.count)
        return 0, _entities(self.reader, self.writer) + number + missing + count

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> NackFrag:
        reader, writer = cursor.u32_big(), cursor.u32_big()
        number = _writer_number(cursor)
        missing = NumberSet.decode(cursor, cursor.u32())
        return cls(reader, writer, number, missing, cursor.u32())


@dataclass(frozen=True, slots=True)
class Data:
    """DATA: a sample, or the end of an instance (8.3.8.2)."""

    KIND: ClassVar[int] = 0x15

    # Reader 0 means all matched readers.
    reader: int
    writer: int
    sequence_number: int  # The number of the sample, from 1 on.
    # The serialized sample with its encapsulation header; the serialized key if `key`.
    payload: bytes | None
    key: bool = False
    inline: ParameterList = NO_PARAMETERS

    def body(self, order: str) -> tuple[int, bytes]:
        flags, inline = _inline_bytes(self.inline)
        flags |= 0 if self.payload is None else _KEY if self.key else _DATA
        head = struct.pack(order + "HH", 0, 16) + _entities(self.reader, self.writer)
        head += sequence_number_bytes(self.sequence_number, order)
        return flags, head + inline + (self.payload or b"")

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> Data:
        behind = _behind_the_head(cursor, 16)
        reader, writer = cursor.u32_big(), cursor.u32_big()
        number = _writer_number(cursor)
        cursor.at = behind
        inline = ParameterList.decode(cursor) if flags & _INLINE else NO_PARAMETERS
        if flags & _DATA and flags & _KEY:
            raise MalformedError("data and key at once")
        payload = cursor.take(cursor.left) if flags & (_DATA | _KEY) else None
        return cls(reader, writer, number, payload, bool(flags & _KEY), inline)


@dataclass(frozen=True, slots=True)
class DataFrag:
    """DATA_FRAG: consecutive fragments of a sample (8.3.8.3)."""

    KIND: ClassVar[int] = 0x16

    reader: int
    writer: int
    sequence_number: int
    # Number of the first fragment, from 1 on, and how many there are.
    first: int
    count: int
    # Size of every fragment but the last, and of the whole sample with its encapsulation header.
    fragment_bytes: int
    sample_bytes: int
    payload: bytes  # The bytes of these fragments.
    inline: ParameterList = NO_PARAMETERS

    def body(self, order: str) -> tuple[int, bytes]:
        flags, inline = _inline_bytes(self.inline)
        head = struct.pack(order + "HH", 0, 28) + _entities(self.reader, self.writer)
        head += sequence_number_bytes(self.sequence_number, order)
        sizes = (self.first, self.count, self.fragment_bytes, self.sample_bytes)
        return flags, head + struct.pack(order + "IHHI", *sizes) + inline + self.payload

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> DataFrag:
        behind = _behind_the_head(cursor, 28)
        reader, writer = cursor.u32_big(), cursor.u32_big()
        number = _writer_number(cursor)
        first, count = cursor.u32(), cursor.u16()
        size, whole = cursor.u16(), cursor.u32()
        if not (first and count and size) or (first + count - 2) * size >= whole:
            raise MalformedError(f"{count} fragments of {size} bytes from {first} of {whole} bytes")
        cursor.at = behind
        inline = ParameterList.decode(cursor) if flags & _INLINE else NO_PARAMETERS
        # Bytes behind the last fragment are padding.
        payload = cursor.take(min(count * size, whole - (first - 1) * size))
        return cls(reader, writer, number, first, count, size, whole, payload, inline)


Submessage: TypeAlias = (
    Data
    | DataFrag
    | Gap
    | Heartbeat
    | AckNack
    | HeartbeatFrag
    | NackFrag
    | InfoDestination
    | InfoSource
    | InfoTimestamp
)

_OF_KIND = {each.KIND: each for each in get_args(Submessage)}


def encode(submessage: Submessage, little: bool = True, pads: bool = False) -> bytes:
    """Return a submessage with its header (9.4.5.1); with `pads`, its body ends with a word.

    A body of more than 65,535 bytes has the length 0, which means "to the end of the datagram"; so
    it has to be the last one.
    """
    order = "<" if little else ">"
    flags, body = submessage.body(order)
    body += bytes(-len(body) % 4 if pads else 0)
    size = len(body) if len(body) <= 0xFFFF else 0
    return struct.pack(order + "BBH", submessage.KIND, flags | little, size) + body


def decode(kind: int, flags: int, body: bytes) -> Submessage | None:
    """Read a submessage without its header.

    Returns
    -------
    Submessage or None
        `None` for a kind that is not known, which is skipped (8.3.4.1).

    Raises
    ------
    MalformedError
        The bytes are no valid submessage of this kind.
    """
    if kind not in _OF_KIND:
        return None
    found: Submessage = _OF_KIND[kind].decode(flags, Cursor(body, bool(flags & _LITTLE)))
    return found


def fragment_count(sample_bytes: int, fragment_bytes: int) -> int:
    """Return the number of fragments of a sample (8.4.14.1)."""
    return -(-sample_bytes // fragment_bytes)


def fragment(sample: Data, number: int, fragment_bytes: int) -> DataFrag:
    """Return fragment `number`, from 1 on, of a sample with a payload (8.4.14.1)."""
    assert sample.payload is not None
    start = (number - 1) * fragment_bytes
    return DataFrag(
        reader=sample.reader,
        writer=sample.writer,
        sequence_number=sample.sequence_number,
        first=number,
        count=1,
        fragment_bytes=fragment_bytes,
        sample_bytes=len(sample.payload),
        payload=sample.payload[start : start + fragment_bytes],
        inline=sample.inline,
    )


def _entities(reader: int, writer: int) -> bytes:
    """Return the entity identifiers, whose byte order is the same on every wire (9.3.1.2)."""
    return struct.pack(">II", reader, writer)


def _writer_number(cursor: Cursor) -> int:
    """Read a sequence number of a writer, which is at least 1 (8.3.5.4)."""
    number = cursor.sequence_number()
    if number < 1:
        raise MalformedError(f"sequence number {number}")
    return number


def _inline_bytes(parameters: ParameterList) -> tuple[int, bytes]:
    """Return the flag of inline QoS, and the bytes."""
    return (_INLINE, parameters.encode()) if parameters.items else (0, b"")


def _behind_the_head(cursor: Cursor, size: int) -> int:
    """Read where the inline QoS of DATA or DATA_FRAG begin: behind a head of at least `size` bytes.

    9.4.5.4: a later version may have more fields before them.
    """
    cursor.u16()
    skip = max(cursor.u16(), size)
    start = cursor.at
    cursor.take(skip)
    behind, cursor.at = cursor.at, start
    return behind
