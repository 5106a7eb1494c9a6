"""RTPS messages: the content of one datagram, and the rules of its receiver (8.3.3, 8.3.4)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from firm_hdl.rtps.wire.guid import UNKNOWN_PREFIX, VENDOR
from firm_hdl.rtps.wire.octets import MalformedError
from firm_hdl.rtps.wire.submessages import (
    InfoDestination,
    InfoSource,
    InfoTimestamp,
    Submessage,
    decode,
    encode,
)

__all__ = ["Message", "Received", "read", "write"]

_MAGIC = b"RTPS"
# The version whose rules we keep to and the one that peers of today write: 2.3 of table 9.4.
_VERSION = b"\x02\x03"
_HEADER_BYTES = 20
_PAD = 0x01


@dataclass(frozen=True, slots=True, kw_only=True)
class Received:
    """A submessage with what the submessages before it say of it."""

    source: bytes  # GUID prefix of the sender.
    timestamp: int | None  # Time of the sender in nanoseconds since 1970, where it gave one.
    submessage: Submessage


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """What a datagram has for one receiver."""

    source: bytes  # GUID prefix in the header.
    # The submessages for this receiver, without those that only interpret others.
    received: tuple[Received, ...]
    unknown: int  # How many submessages have a kind that is not known.
    error: str | None  # Why the rest of the datagram was not read.


def write(prefix: bytes, submessages: Iterable[Submessage], little: bool = True) -> bytes:
    """Return a datagram of the participant `prefix`."""
    every = tuple(submessages)
    return (
        _MAGIC
        + _VERSION
        + VENDOR
        + prefix
        + b"".join(
            # 9.4.5.1.3: all but the last one end with a word.
            encode(each, little, pads=number < len(every))
            for number, each in enumerate(every, 1)
        )
    )


def read(datagram: bytes, receiver: bytes) -> Message:
    """Read a datagram that the participant with the GUID prefix `receiver` got.

    A submessage that is not valid makes the rest of the datagram invalid; what comes before counts
    (8.3.4.1). Nothing that a peer can send raises another error than the following.

    Raises `MalformedError`: the datagram is none of RTPS, or of another major version.
    """
    if len(datagram) < _HEADER_BYTES or datagram[:4] != _MAGIC:
        raise MalformedError("no RTPS message")
    if datagram[4] != _VERSION[0]:
        raise MalformedError(f"RTPS version {datagram[4]}.{datagram[5]}")
    # The state of a receiver while it reads one datagram (8.3.4).
    source, is_addressed = datagram[8:20], True
    timestamp: int | None = None
    received: list[Received] = []
    unknown, error = 0, None
    try:
        for kind, submessage in _submessages(datagram):
            match submessage:
                case None:
                    unknown += kind != _PAD
                case InfoDestination(prefix):
                    is_addressed = prefix in (receiver, UNKNOWN_PREFIX)
                case InfoSource(prefix):
                    # 8.3.8.10: the time of the former source is not that of the new one.
                    source, timestamp = prefix, None
                case InfoTimestamp(nanoseconds):
                    timestamp = nanoseconds
                case _ if is_addressed:
                    each = Received(source=source, timestamp=timestamp, submessage=submessage)
                    received.append(each)
    except MalformedError as problem:
        error = str(problem)
    return Message(source=datagram[8:20], received=tuple(received), unknown=unknown, error=error)


def _submessages(datagram: bytes) -> Iterator[tuple[int, Submessage | None]]:
    """Yield the submessages of a datagram: the kind, and `None` if that is not known."""
    at = _HEADER_BYTES
    while at < len(datagram):
        if at + 4 > len(datagram):
            raise MalformedError("part of a submessage's header")
        kind, flags = datagram[at], datagram[at + 1]
        size = int.from_bytes(datagram[at + 2 : at + 4], "little" if flags & 1 else "big")
        at += 4
        # 9.4.5.1.3: 0 means "to the end", except where a submessage may be empty.
        if size == 0 and kind not in (_PAD, InfoTimestamp.KIND):
            size = len(datagram) - at
        if at + size > len(datagram):
            raise MalformedError("a submessage that is longer than its datagram")
        yield kind, decode(kind, flags, datagram[at : at + size])
        at += size
