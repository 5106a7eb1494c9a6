"""Datagrams of invented participants, damaged in many ways."""

from __future__ import annotations

import random
import struct
from collections.abc import Sequence
from typing import Any

from firm_hdl.rtps import Qos
from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.ros import graph
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_WRITER,
    SPDP_WRITER,
    SUBSCRIPTIONS_WRITER,
    Guid,
    user_reader,
    user_writer,
)
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    InfoDestination,
    InfoSource,
    InfoTimestamp,
    NackFrag,
    NumberSet,
    Submessage,
)

__all__ = ["Attack"]

_EXTREMES = (0, 1, 2, 3, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 0xFFFF, 0x7FFF_FFFF, 0x8000_0000)
_MOST_BYTES = 1472


class Attack:
    """A source of datagrams.

    Parameters
    ----------
    seed : int
    board : bytes
        GUID prefix of the node.
    topics : sequence of pairs of str
        Names of its topics and of their types, as on the wire.
    """

    def __init__(self, seed: int, board: bytes, topics: Sequence[tuple[str, str]]) -> None:
        self.random = random.Random(seed)
        self.board = board
        self.topics = topics
        self._prefixes = [self._prefix()]

    def datagram(self) -> bytes:
        """Return the next one: good, or damaged."""
        rnd = self.random
        if rnd.random() < 0.05:
            return rnd.randbytes(rnd.randrange(1, 200))
        made = self._good()
        if rnd.random() < 0.1:
            # The tail of another one; its first submessage often says less than it has.
            made += self._good()[20:]
        data = bytearray(made)
        for _ in range(rnd.choice((0, 0, 1, 1, 1, 2, 4))):
            self._damage(data)
        return bytes(data[:_MOST_BYTES]) or b"\0"

    def _prefix(self) -> bytes:
        return b"\x01\xee" + self.random.randbytes(10)

    def _damage(self, data: bytearray) -> None:
        rnd = self.random
        if not data:
            return
        place, way = rnd.randrange(len(data)), rnd.randrange(8)
        if way < 3:
            data[place] ^= 1 << rnd.randrange(8)
        elif way == 3:
            data[place] = rnd.randrange(256)
        elif way == 4:
            form = rnd.choice(("<H", "<I", ">H", ">I"))
            value = rnd.choice(_EXTREMES) & (0xFFFF if form[1] == "H" else 0xFFFF_FFFF)
            place -= place % struct.calcsize(form)
            data[place : place + struct.calcsize(form)] = struct.pack(form, value)
        elif way == 5:
            del data[place:]
        elif way == 6:
            size = rnd.randrange(1, 40)
            data[place:place] = data[place : place + size] if rnd.random() < 0.5 else bytes(size)
        else:
            # Length and flags of the first submessage.
            for at, bits in ((21, 3), (22, 8), (23, 3)):
                if len(data) > at and rnd.random() < 0.5:
                    data[at] = rnd.randrange(1 << bits)

    def _good(self) -> bytes:
        rnd = self.random
        if rnd.random() < 0.1:
            self._prefixes = [*self._prefixes[-40:], self._prefix()]
        prefix = rnd.choice(self._prefixes)
        some: list[Submessage] = []
        for _ in range(rnd.choice((1, 1, 1, 2, 3))):
            head = rnd.random()
            if head < 0.3:
                some.append(
                    InfoDestination(rnd.choice((self.board, self.board, bytes(12), prefix)))
                )
            elif head < 0.4:
                some.append(InfoTimestamp(rnd.choice((None, rnd.randrange(1 << 62)))))
            elif head < 0.43:
                some.append(InfoSource(rnd.choice(self._prefixes)))
            some.append(self._submessage(prefix))
        return message.write(prefix, some)

    def _submessage(self, prefix: bytes) -> Submessage:
        rnd = self.random
        way = rnd.randrange(10)
        if way < 2:
            return self._participant(prefix)
        if way < 4:
            return self._endpoint(prefix)
        number = rnd.choice((0, 1, 1, 2, 2, 3, 4, 300, 1 << 31))
        ours = rnd.choice((user_writer(1), SPDP_WRITER, PUBLICATIONS_WRITER, SUBSCRIPTIONS_WRITER))
        theirs = rnd.choice((0, 0, 0x3C7, 0x4C7, *map(user_reader, range(1, 8))))
        as_writer: dict[str, Any] = {"reader": theirs, "writer": ours}
        count = rnd.choice((0, 1, 2, rnd.randrange(1 << 31)))
        base = rnd.choice((number, 1, max(0, number - 5)))
        members = rnd.sample(range(base, base + 256), rnd.choice((0, 1, 9)))
        missing = NumberSet.of(base, members)
        if way == 4:
            return Data(**as_writer, sequence_number=number, payload=self._payload())
        if way == 5:
            last = number + rnd.choice((-1, 0, 1, 10, 1 << 20))
            return Heartbeat(
                **as_writer, first=number, last=max(0, last), count=count, final=rnd.random() < 0.5
            )
        if way == 6:
            return Gap(**as_writer, start=rnd.choice((1, number)), numbers=missing)
        if way == 7:
            return DataFrag(
                **as_writer,
                sequence_number=number,
                first=rnd.choice((0, 1, 1, 2, 3, 1 << 31)),
                count=rnd.choice((0, 1, 1, 2, 0xFFFF)),
                fragment_bytes=rnd.choice((0, 1, 16, 16, 64, 0xFFFF)),
                sample_bytes=rnd.choice((0, 1, 40, 40, 100, 1 << 15, 1 << 31)),
                payload=rnd.randbytes(rnd.choice((0, 16, 32, 40))),
            )
        if way == 8 and rnd.random() < 0.3:
            return HeartbeatFrag(**as_writer, sequence_number=number, last=count, count=count)
        reader = rnd.choice((user_reader(1), 0x3C7, 0x4C7))
        writer = rnd.choice((0x3C2, 0x4C2, 0x1C2, *map(user_writer, range(1, 8))))
        if way == 8:
            return NackFrag(
                reader=reader, writer=writer, sequence_number=number, missing=missing, count=count
            )
        return AckNack(
            reader=reader, writer=writer, missing=missing, count=count, final=rnd.random() < 0.5
        )

    def _payload(self) -> bytes:
        """Return a message, often a string, that says that it is bad."""
        rnd = self.random
        text = b"bad" + bytes(rnd.randrange(97, 123) for _ in range(rnd.randrange(60))) + b"\0"
        return b"\0\1\0\0" + struct.pack("<I", len(text)) + text

    def _participant(self, prefix: bytes) -> Data:
        rnd = self.random
        host = rnd.choice((f"10.0.0.{rnd.randrange(3, 40)}", "10.0.0.2", "239.255.0.1"))
        there = (Address(host, rnd.choice((7410, 7411, 9))),)
        lease = rnd.choice((1.0, 10.0, 100.0, 1e6))
        made = ParticipantData(prefix=prefix, discovery=there, user=there, lease=lease, domain=0)
        return Data(reader=0, writer=SPDP_WRITER, sequence_number=1, payload=made.encode())

    def _endpoint(self, prefix: bytes) -> Data:
        rnd = self.random
        is_writer = rnd.random() < 0.5
        topic, type_name = rnd.choice((*self.topics, (graph.TOPIC, graph.TYPE), ("rt/x", "x")))
        end = EndpointData(
            guid=Guid(prefix, user_writer(1) if is_writer else user_reader(1)),
            topic=topic,
            type_name=type_name,
            qos=Qos(depth=rnd.choice((0, 1, 10))),
        )
        writer = PUBLICATIONS_WRITER if is_writer else SUBSCRIPTIONS_WRITER
        return Data(
            reader=0, writer=writer, sequence_number=rnd.randrange(1, 4), payload=end.encode()
        )
