"""All submessages: their union, and their bytes with the header (8.3.8, 9.4.5.1)."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import TypeAlias

from firm_hdl.rtps.wire.infos import InfoDestination, InfoSource, InfoTimestamp
from firm_hdl.rtps.wire.octets import Cursor
from firm_hdl.rtps.wire.reliability import AckNack, Gap, Heartbeat, HeartbeatFrag, NackFrag
from firm_hdl.rtps.wire.samples import Data, DataFrag

__all__ = ["Submessage", "decode", "encode"]

_LITTLE = 0x01

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

_DECODERS: dict[int, Callable[[int, Cursor], Submessage]] = {
    Data.KIND: Data.decode,
    DataFrag.KIND: DataFrag.decode,
    Gap.KIND: Gap.decode,
    Heartbeat.KIND: Heartbeat.decode,
    AckNack.KIND: AckNack.decode,
    HeartbeatFrag.KIND: HeartbeatFrag.decode,
    NackFrag.KIND: NackFrag.decode,
    InfoDestination.KIND: InfoDestination.decode,
    InfoSource.KIND: InfoSource.decode,
    InfoTimestamp.KIND: InfoTimestamp.decode,
}


def encode(submessage: Submessage, little: bool = True) -> bytes:
    """Return a submessage with its header (9.4.5.1).

    A body of more than 65,535 bytes has the length 0, which means "to the end of the datagram"; so
    it has to be the last one.
    """
    order = "<" if little else ">"
    flags, body = submessage.body(order)
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
    decoder = _DECODERS.get(kind)
    return None if decoder is None else decoder(flags, Cursor(body, bool(flags & _LITTLE)))
