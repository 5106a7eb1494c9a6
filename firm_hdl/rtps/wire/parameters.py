"""Parameter lists: discovery data and inline QoS as pairs of an identifier and bytes (9.4.2.11)."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass

from firm_hdl.rtps.wire.guid import VENDOR, Guid, SampleIdentity
from firm_hdl.rtps.wire.octets import Cursor, MalformedError, padded

__all__ = ["ParameterList", "Pid", "identity", "sequence_number_bytes", "string"]

_PAD, _SENTINEL = 0x0000, 0x0001
# 9.6.2.2.1: bits that say "of a vendor", and "must understand".
_VENDOR, _MUST_UNDERSTAND = 0x8000, 0x4000
# PL_CDR_BE and PL_CDR_LE: representation identifiers of 10.5, before the list of discovery data.
_PL_CDR = {b"\x00\x02": False, b"\x00\x03": True}
_MAX_PARAMETERS = 512
_FAST_DDS = b"\x01\x0f"


class Pid:
    """Identifiers of parameters (tables 9.13 and 9.14 of 9.6.2.2.2)."""

    PARTICIPANT_LEASE_DURATION = 0x0002
    TOPIC_NAME = 0x0005
    TYPE_NAME = 0x0007
    DOMAIN_ID = 0x000F
    PROTOCOL_VERSION = 0x0015
    VENDOR_ID = 0x0016
    RELIABILITY = 0x001A
    LIVELINESS = 0x001B
    DURABILITY = 0x001D
    OWNERSHIP = 0x001F
    DEADLINE = 0x0023
    PARTITION = 0x0029
    USER_DATA = 0x002C
    UNICAST_LOCATOR = 0x002F
    DEFAULT_UNICAST_LOCATOR = 0x0031
    METATRAFFIC_UNICAST_LOCATOR = 0x0032
    HISTORY = 0x0040
    PARTICIPANT_GUID = 0x0050
    BUILTIN_ENDPOINT_SET = 0x0058
    ENDPOINT_GUID = 0x005A
    ENTITY_NAME = 0x0062
    KEY_HASH = 0x0070
    STATUS_INFO = 0x0071
    DATA_REPRESENTATION = 0x0073
    # DDS-RPC 7.6.2: the request that a reply answers.
    RELATED_SAMPLE_IDENTITY = 0x0083
    # The same, as Fast DDS wrote it before the standard had an identifier for it.
    FAST_DDS_SAMPLE_IDENTITY = 0x800F


@dataclass(frozen=True, slots=True)
class ParameterList:
    """Parameters in the order of the wire."""

    # Pairs of an identifier and the bytes of the value, without the sentinel.
    items: tuple[tuple[int, bytes], ...]
    little: bool = True  # Whether integers in the values are little-endian.

    def first(self, pid: int) -> Cursor | None:
        """Return the first value of `pid`, or `None`."""
        return next(iter(self.every(pid)), None)

    def every(self, pid: int) -> list[Cursor]:
        """Return all values of `pid`, as locators may have several."""
        return [Cursor(value, self.little) for each, value in self.items if each == pid]

    def encode(self) -> bytes:
        """Return the list with its sentinel.

        Raises
        ------
        ValueError
            A value does not fit into 65,532 bytes.
        """
        order = "<" if self.little else ">"
        parts = []
        for pid, value in (*self.items, (_SENTINEL, b"")):
            value = padded(value)
            if len(value) > 0xFFFC:
                raise ValueError(f"parameter 0x{pid:04x} has {len(value)} bytes")
            parts.append(struct.pack(order + "HH", pid, len(value)) + value)
        return b"".join(parts)

    def encode_payload(self) -> bytes:
        """Return the list as a serialized payload, with its encapsulation header (10.5)."""
        return (b"\x00\x03" if self.little else b"\x00\x02") + bytes(2) + self.encode()

    @classmethod
    def decode(cls, cursor: Cursor) -> ParameterList:
        """Read a list up to its sentinel.

        The bit "must understand" is removed from identifiers of the standard. Identifiers of
        vendors stay whole: the same number means another thing to another vendor (9.6.2.2.1).
        """
        items: list[tuple[int, bytes]] = []
        while True:
            pid, size = cursor.u16(), cursor.u16()
            if pid == _SENTINEL:
                return cls(tuple(items), cursor.little)
            value = cursor.take(size)
            if pid == _PAD:
                continue
            if len(items) == _MAX_PARAMETERS:
                raise MalformedError(f"more than {_MAX_PARAMETERS} parameters")
            items.append((pid if pid & _VENDOR else pid & ~_MUST_UNDERSTAND, value))

    @classmethod
    def decode_payload(cls, payload: bytes) -> ParameterList:
        """Read a serialized payload.

        Raises `MalformedError`: the payload has another representation, or no sentinel.
        """
        little = _PL_CDR.get(payload[:2])
        if little is None:
            raise MalformedError(f"encapsulation {payload[:2].hex()} is no parameter list")
        return cls.decode(Cursor(payload, little, 4))

    def related(self, vendor: bytes) -> SampleIdentity | None:
        """Return the sample that this one answers, by inline QoS (DDS-RPC 7.6.2).

        * `vendor`: vendor of the writer. Only Fast DDS and we have an identifier of Fast DDS.
        """
        own = (Pid.FAST_DDS_SAMPLE_IDENTITY,) if vendor in (_FAST_DDS, VENDOR) else ()
        for pid in (Pid.RELATED_SAMPLE_IDENTITY, *own):
            value = self.first(pid)
            if value is not None:
                guid = Guid.parse(value.take(16))
                return SampleIdentity(guid, value.sequence_number())
        return None


def string(text: str) -> bytes:
    """Return the CDR string of `text`, little-endian, without padding."""
    data = text.encode() + b"\0"
    return struct.pack("<I", len(data)) + data


def sequence_number_bytes(number: int, order: str = "<") -> bytes:
    """Return the 8 bytes of a sequence number, by default little-endian (9.3.2)."""
    return struct.pack(order + "iI", number >> 32, number & 0xFFFF_FFFF)


def identity(related: SampleIdentity) -> Iterable[tuple[int, bytes]]:
    """Return the inline QoS of a sample that is related to another one.

    Both identifiers are written: old releases of Fast DDS know their own alone.
    """
    value = bytes(related.writer) + sequence_number_bytes(related.sequence_number)
    return (
        (Pid.RELATED_SAMPLE_IDENTITY, value),
        (Pid.FAST_DDS_SAMPLE_IDENTITY, value),
    )
