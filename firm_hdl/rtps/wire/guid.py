"""GUIDs, the names of participants and endpoints (8.2.4), and entity identifiers (9.3.1)."""

from __future__ import annotations

import os
from dataclasses import dataclass

from firm_hdl.rtps.wire.octets import MalformedError

__all__ = [
    "PARTICIPANT",
    "PUBLICATIONS_READER",
    "PUBLICATIONS_WRITER",
    "SPDP_READER",
    "SPDP_WRITER",
    "SUBSCRIPTIONS_READER",
    "SUBSCRIPTIONS_WRITER",
    "UNKNOWN_PREFIX",
    "VENDOR",
    "Guid",
    "SampleIdentity",
    "is_builtin",
    "is_keyed",
    "new_prefix",
    "user_reader",
    "user_writer",
]

VENDOR = b"\x01\xff"
"""Our vendor id (8.3.3.1.3). The OMG has assigned none to firm-hdl, and none has this one.

Fast DDS takes the reserved id 00.00 for its own, and then reads the vendor-specific parameters of
the sender as its own. With an id that nobody has, peers keep to the standard.
"""

UNKNOWN_PREFIX = bytes(12)
"""GUIDPREFIX_UNKNOWN: as a destination, every participant (8.3.8.8)."""

# Entity identifiers of 9.3.1.5, as the number of their four bytes in the order of the wire.
PARTICIPANT = 0x0000_01C1
SPDP_WRITER = 0x0001_00C2
SPDP_READER = 0x0001_00C7
PUBLICATIONS_WRITER = 0x0000_03C2
PUBLICATIONS_READER = 0x0000_03C7
SUBSCRIPTIONS_WRITER = 0x0000_04C2
SUBSCRIPTIONS_READER = 0x0000_04C7

# Kinds of user-defined entities (table 9.1): the last byte of the identifier.
_WRITER_WITH_KEY, _WRITER_NO_KEY, _READER_NO_KEY, _READER_WITH_KEY = 2, 3, 4, 7


@dataclass(frozen=True, slots=True)
class Guid:
    """The name of a participant or of an endpoint."""

    prefix: bytes  # 12 bytes, which all entities of a participant share.
    entity: int  # The entity identifier: 32 bits, of which the lowest 8 are the kind.

    def __bytes__(self) -> bytes:
        return self.prefix + self.entity.to_bytes(4, "big")

    def __str__(self) -> str:
        return f"{self.prefix.hex()}:{self.entity:08x}"

    @classmethod
    def parse(cls, data: bytes) -> Guid:
        """Read the 16 bytes of a GUID. Their order is the same on every wire (9.3.1.6)."""
        if len(data) < 16:
            raise MalformedError(f"a GUID of {len(data)} bytes")
        return cls(data[:12], int.from_bytes(data[12:16], "big"))


@dataclass(frozen=True, slots=True)
class SampleIdentity:
    """The name of a sample, as in DDS-RPC 7.6.2: its writer and its sequence number."""

    writer: Guid
    sequence_number: int


def new_prefix() -> bytes:
    """Return a GUID prefix of our vendor that no other participant has, nor had.

    The first two bytes are the vendor id (9.3.1.5), the other ten are random. So a participant that
    starts again is a new one for its peers. With its old name, its first samples would be taken for
    old ones.
    """
    return VENDOR + os.urandom(10)


def user_writer(key: int) -> int:
    """Return the entity identifier of our user-defined writer number `key`, from 1 on."""
    return key << 8 | _WRITER_NO_KEY


def user_reader(key: int) -> int:
    """Return the entity identifier of our user-defined reader number `key`, from 1 on."""
    return key << 8 | _READER_NO_KEY


def is_keyed(entity: int) -> bool:
    """Whether an endpoint's topic has a key. Topics of ROS 2 have none."""
    return entity & 0x3F in (_WRITER_WITH_KEY, _READER_WITH_KEY)


def is_builtin(entity: int) -> bool:
    """Whether an endpoint is one of the standard's own, such as those of discovery (table 9.1)."""
    return entity & 0xC0 == 0xC0
