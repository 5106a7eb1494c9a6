"""INFO_DST, INFO_SRC and INFO_TS: submessages that say of others what they mean (8.3.8, 9.4.5)."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar

from firm_hdl.rtps.wire.guid import VENDOR
from firm_hdl.rtps.wire.octets import Cursor

__all__ = ["InfoDestination", "InfoSource", "InfoTimestamp"]


@dataclass(frozen=True, slots=True)
class InfoDestination:
    """INFO_DST: the participant that the following submessages are for (8.3.8.8)."""

    KIND: ClassVar[int] = 0x0E

    prefix: bytes

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        return 0, self.prefix

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> InfoDestination:
        """Read the bytes behind the header."""
        return cls(cursor.take(12))


@dataclass(frozen=True, slots=True)
class InfoSource:
    """INFO_SRC: the participant that the following submessages come from (8.3.8.10)."""

    KIND: ClassVar[int] = 0x0C

    prefix: bytes
    version: bytes = b"\x02\x03"
    vendor: bytes = VENDOR

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        return 0, bytes(4) + self.version + self.vendor + self.prefix

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> InfoSource:
        """Read the bytes behind the header."""
        cursor.take(4)
        version, vendor = cursor.take(2), cursor.take(2)
        return cls(cursor.take(12), version, vendor)


@dataclass(frozen=True, slots=True)
class InfoTimestamp:
    """INFO_TS: the time of the following submessages (8.3.8.11).

    Attributes
    ----------
    nanoseconds : int or None
        Time since 1970 in nanoseconds, or `None` for no time. The wire has seconds, unsigned, and
        fractions of 2**-32 s (9.3.2).
    """

    KIND: ClassVar[int] = 0x09

    nanoseconds: int | None

    def body(self, order: str) -> tuple[int, bytes]:
        """Return the flags and the bytes behind the header."""
        if self.nanoseconds is None:
            return 0x02, b""
        seconds, rest = divmod(self.nanoseconds, 10**9)
        # Rounded up, so that reading gives the same nanosecond again.
        fraction = -(-(rest << 32) // 10**9)
        return 0, struct.pack(order + "II", seconds & 0xFFFF_FFFF, fraction)

    @classmethod
    def decode(cls, flags: int, cursor: Cursor) -> InfoTimestamp:
        """Read the bytes behind the header."""
        if flags & 0x02:
            return cls(None)
        seconds, fraction = cursor.u32(), cursor.u32()
        return cls(seconds * 10**9 + (fraction * 10**9 >> 32))
