"""Frames, good and damaged in many ways, and a judge that shares nothing with the gateware."""

from __future__ import annotations

import random
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

__all__ = ["Judge", "Sent", "traffic"]

MAC = bytes.fromhex("020000000050")
ADDRESS = bytes([192, 168, 50, 50])
GROUPS = (bytes([239, 255, 0, 1]), bytes([239, 255, 1, 2]), bytes([224, 0, 0, 1]))
PORTS = (7400, 7410, 7411)
PREAMBLE = bytes([0x55] * 7 + [0xD5])


@dataclass(frozen=True, slots=True)
class Sent:
    """What goes over the wire: cycles before, bytes from the preamble on, a byte with an error."""

    gap: int
    data: bytes
    error: int | None = None

    def record(self) -> bytes:
        """Return it as the harness reads it."""
        error = 0xFFFF if self.error is None else self.error
        head = b"".join(n.to_bytes(2, "little") for n in (self.gap, len(self.data), error))
        return head + self.data


def checksum(data: bytes) -> int:
    """Return the checksum of RFC 1071; 0 if the data has one that is right."""
    data += bytes(len(data) & 1)
    total = sum(data[::2]) * 256 + sum(data[1::2])
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return 0xFFFF ^ total


def with_checksum(data: bytes, place: int, before: bytes = b"") -> bytes:
    """Return the data with its checksum at a place."""
    data = data[:place] + b"\0\0" + data[place + 2 :]
    return data[:place] + checksum(before + data).to_bytes(2, "big") + data[place + 2 :]


def ipv4(
    protocol: int,
    payload: bytes,
    source: bytes,
    destination: bytes = ADDRESS,
    *,
    ident: int = 0,
    fragment: int = 0,
    options: bytes = b"",
) -> bytes:
    """Return a datagram of IPv4."""
    words, total = 5 + len(options) // 4, 20 + len(options) + len(payload)
    head = bytes([0x40 | words, 0, total >> 8 & 255, total & 255])
    head += ident.to_bytes(2, "big") + fragment.to_bytes(2, "big") + bytes([64, protocol, 0, 0])
    return with_checksum(head + source + destination + options, 10) + payload


def udp(source: bytes, destination: bytes, ports: tuple[int, int], payload: bytes) -> bytes:
    """Return a datagram of UDP."""
    length = (8 + len(payload)).to_bytes(2, "big")
    head = ports[0].to_bytes(2, "big") + ports[1].to_bytes(2, "big") + length + b"\0\0"
    pseudo = source + destination + b"\0\x11" + length
    found = with_checksum(head + payload, 6, pseudo)
    return found if found[6:8] != b"\0\0" else found[:6] + b"\xff\xff" + found[8:]


def group_mac(group: bytes) -> bytes:
    """Return the address of a group in hardware."""
    return b"\x01\x00\x5e" + bytes([group[1] & 127]) + group[2:]


def on_wire(frame: bytes) -> bytes:
    """Return a frame with padding, frame check sequence and preamble."""
    frame += bytes(max(0, 60 - len(frame)))
    return PREAMBLE + frame + zlib.crc32(frame).to_bytes(4, "little")


class _Traffic:
    """The making of frames."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.hosts = [bytes([192, 168, 50, n]) for n in (1, 2, 3, 4, 5, 77)]

    def frame(self) -> bytes:
        """Return a good frame, from Ethernet's header to the payload's end."""
        rnd = self.random
        host = rnd.choice(self.hosts)
        own = b"\x02\x11" + host
        kinds = {"udp": 60, "echo": 8, "arp": 6, "igmp": 3, "part": 8, "short": 4, "other": 5}
        kind = rnd.choices([*kinds], [*kinds.values()])[0]
        size = rnd.choice((rnd.randrange(1, 60), rnd.randrange(1, 300), rnd.randrange(1, 1473)))
        if kind == "other":
            return MAC + own + rnd.randbytes(2) + rnd.randbytes(size)
        if kind == "arp":
            asked = rnd.choice((ADDRESS, ADDRESS, host))
            head = bytes.fromhex("0806000108000604") + bytes([0, rnd.choice((1, 1, 2, 3))])
            sender = rnd.choice((own, own, own, b"\xff" * 6))
            return b"\xff" * 6 + own + head + sender + host + bytes(6) + asked
        options = rnd.choice((b"", b"", b"", rnd.randbytes(4 * rnd.randrange(11))))
        to, mac = ADDRESS, MAC
        if kind == "udp":
            if rnd.random() < 0.2:
                to = rnd.choice(GROUPS)
                mac = group_mac(to)
            port = rnd.choice((*PORTS, *PORTS, rnd.randrange(65536)))
            size = min(size, 1472 - len(options))
            payload = udp(host, to, (rnd.randrange(65536), port), rnd.randbytes(size))
            if rnd.random() < 0.05:
                payload = payload[:6] + b"\0\0" + payload[8:]
            packet = ipv4(17, payload, host, to, ident=rnd.randrange(65536), options=options)
        elif kind == "echo":
            body = with_checksum(b"\x08\0\0\0" + rnd.randbytes(4 + size % 1400), 2)
            packet = ipv4(1, body, host, ident=rnd.randrange(65536), options=b"")
        elif kind == "igmp":
            to, group = GROUPS[2], rnd.choice((bytes(4), GROUPS[0], rnd.randbytes(4)))
            mac = group_mac(to)
            body = with_checksum(b"\x11" + rnd.randbytes(1) + b"\0\0" + group, 2)
            packet = ipv4(2, body, host, to, options=b"\x94\x04\0\0")
        elif kind == "short":
            # A header that is cut off, or has nothing behind it.
            protocol, more = rnd.choice((1, 17, 17)), rnd.random() < 0.3
            body = b"\x08\0" + rnd.choice(PORTS).to_bytes(2, "big") + bytes([0, rnd.randrange(10)])
            body = (body + bytes(2))[: 8 if more else rnd.randrange(9)]
            where = 0x2000 if more else rnd.choice((0, 0, 1))
            packet = ipv4(protocol, body, host, ident=rnd.randrange(2), fragment=where)
        else:
            # A fragment of nothing.
            body = rnd.randbytes(8 * rnd.randrange(1, 30))
            where = rnd.choice((0x2000, rnd.randrange(1, 0x2000), rnd.randrange(0x4000)))
            packet = ipv4(17, body, host, ident=rnd.randrange(4), fragment=where)
        return mac + own + b"\x08\0" + packet

    def damaged(self, frame: bytes) -> Iterator[Sent]:
        """Yield a frame that is good, or damaged in some way."""
        rnd = self.random
        gap = rnd.choice((0, 0, rnd.randrange(50))) + len(frame) // 6
        data, error = bytearray(frame), None
        way = rnd.randrange(24)
        header = min(len(data) - 1, 64)
        if way == 1:
            for _ in range(rnd.randrange(1, 4)):
                data[rnd.randrange(header)] ^= 1 << rnd.randrange(8)
        elif way == 2:
            data[rnd.randrange(len(data))] = rnd.randrange(256)
        elif way == 3:
            del data[rnd.randrange(14, len(data)) :]
        elif way == 4:
            data += rnd.randbytes(rnd.randrange(1, 1600 - min(1599, len(data))))
        elif way == 5 and data[12:14] == b"\x08\0":
            # A wrong header with a right checksum.
            place = rnd.choice((14, 16, 17, 20, 21, 22, 23, *range(26, 34)))
            data[place] = rnd.choice((data[place] ^ 1 << rnd.randrange(8), rnd.randrange(256)))
            size = max(20, 4 * (data[14] & 15))
            data[14 : 14 + size] = with_checksum(bytes(data[14 : 14 + size]).ljust(12, b"\0"), 10)
        elif way == 6:
            data = bytearray(rnd.randbytes(rnd.randrange(1, 200)))
        wire = on_wire(bytes(data))
        if way == 7:
            place = rnd.randrange(8, len(wire))
            wire = wire[:place] + bytes([wire[place] ^ 1 << rnd.randrange(8)]) + wire[place + 1 :]
        elif way == 8:
            error = rnd.randrange(len(wire))
        elif way == 9:
            wire = wire[rnd.randrange(12) :]
        elif way == 10:
            wire = wire[: rnd.randrange(1, len(wire))]
        elif way == 11:
            wire = wire + on_wire(frame)
        elif way == 12:
            wire = PREAMBLE + data + zlib.crc32(data).to_bytes(4, "little")
        elif way == 13:
            wire = bytes([0x55] * rnd.randrange(30)) + wire
        elif way == 14:
            wire = rnd.randbytes(rnd.randrange(1, 100))
        yield Sent(gap, wire[:3000], error)

    def train(self) -> Iterator[Sent]:
        """Yield the fragments of a datagram; sometimes one is missing, damaged or moved."""
        rnd = self.random
        host = rnd.choice(self.hosts)
        size = rnd.choice((rnd.randrange(100, 3000), rnd.randrange(100, 20000)))
        ports = (rnd.randrange(65536), rnd.choice(PORTS))
        whole = udp(host, ADDRESS, ports, rnd.randbytes(size))
        step = 8 * rnd.choice((rnd.randrange(8, 185), 185))
        ident = rnd.randrange(65536)
        frames = []
        for at in range(0, len(whole), step):
            more = 0x2000 if at + step < len(whole) else 0
            part = whole[at : at + step]
            packet = ipv4(17, part, host, ident=ident, fragment=more | at // 8)
            frames.append(MAC + b"\x02\x11" + host + b"\x08\0" + packet)
        way = rnd.randrange(12)
        place = rnd.randrange(len(frames))
        if way == 1:
            del frames[place]
        elif way == 2:
            frames.insert(place, frames[place])
        elif way == 3:
            rnd.shuffle(frames)
        elif way == 4:
            damaged = bytearray(frames[place])
            damaged[rnd.randrange(34, len(damaged))] ^= 1
            frames[place] = bytes(damaged)
        for frame in frames:
            gap = rnd.randrange(30) + len(frame) // 6
            yield Sent(gap, on_wire(frame))
            if rnd.random() < 0.1:
                yield from self.damaged(self.frame())
        # Time to read it.
        yield Sent(min(65535, 2 * size), on_wire(self.frame()))


def traffic(seed: int, count: int) -> Iterator[Sent]:
    """Yield about `count` frames."""
    made = _Traffic(seed)
    number = 0
    while number < count:
        several = made.train() if made.random.random() < 0.01 else made.damaged(made.frame())
        for each in several:
            yield each
            number += 1


@dataclass(slots=True)
class Judge:
    """Say what has to become of frames.

    Attributes
    ----------
    datagrams : list of bytes
        Datagrams in one piece that have to come, as lines of the harness.
    drops : Counter of str
        Frames that have to be dropped, by cause; ``answer`` are those that are answered, if there
        is room.
    trains : set of bytes
        Datagrams whose fragments came in order, with nothing of the source between them.
    """

    datagrams: list[str] = field(default_factory=list)
    drops: Counter[str] = field(default_factory=Counter)
    trains: set[str] = field(default_factory=set)
    _open: dict[bytes, tuple[bytes, bytes, bytes]] = field(default_factory=dict)
    _echo: tuple[bytes, bytes, int] | None = None

    def judge(self, sent: Sent) -> None:
        """Take the next frame."""
        cause = self._cause(sent)
        if cause:
            self.drops[cause] += 1

    def _cause(self, sent: Sent) -> str:
        data = sent.data
        start = next((n for n, byte in enumerate(data) if byte != 0x55), None)
        if start is None or data[start] != 0xD5:
            return "damaged"
        frame = data[start + 1 :]
        if len(frame) > 1518:
            return "giant"
        if not frame:
            return "runt"
        if len(frame) < 64:
            return "runt"
        if sent.error is not None or zlib.crc32(frame[:-4]).to_bytes(4, "little") != frame[-4:]:
            return "damaged"
        frame = frame[:-4]
        to, kind, rest = frame[:6], frame[12:14], frame[14:]
        to_group = to[:3] == b"\x01\x00\x5e"
        if to not in (MAC, b"\xff" * 6) and not to_group:
            return "other"
        if kind == b"\x08\x06":
            return self._arp(rest)
        return self._ipv4(rest, to == MAC, to_group) if kind == b"\x08\0" else "other"

    @staticmethod
    def _arp(rest: bytes) -> str:
        right = rest[:6] == bytes.fromhex("000108000604") and rest[6:8] in (b"\0\1", b"\0\2")
        if not right or rest[8] & 1 or rest[24:28] != ADDRESS:
            return "other"
        return "answer" if rest[7] == 1 and rest[14:18] != ADDRESS else ""

    def _ipv4(self, rest: bytes, to_node: bool, to_group: bool) -> str:
        size, total = 4 * (rest[0] & 15), int.from_bytes(rest[2:4], "big")
        # A header behind which the frame has nothing, not even padding, counts as wrong.
        if rest[0] >> 4 != 4 or size < 20 or size >= len(rest) or not size <= total <= len(rest):
            return "malformed"
        source, destination = rest[12:16], rest[16:20]
        if checksum(rest[:size]) or source == ADDRESS or source[0] >= 224 or source[0] == 0:
            return "malformed"
        ours = (to_node and destination == ADDRESS) or (to_group and destination in GROUPS)
        if not ours or rest[9] not in (1, 2, 17):
            return "other"
        body = rest[size:total]
        word = int.from_bytes(rest[6:8], "big")
        offset, more = 8 * (word & 0x1FFF), bool(word & 0x2000)
        if rest[9] == 17:
            if offset or more:
                return self._fragment(source, destination, rest[4:6], offset, more, body)
            return self._udp(source, destination, body)
        if rest[9] == 2:
            return self._igmp(body, bool(offset or more))
        return self._icmp(rest, body, size, offset, more, to_node)

    def _udp(self, source: bytes, destination: bytes, body: bytes) -> str:
        # Of what is shorter than a header, the rest is what came before.
        if len(body) < 8:
            return "short"
        cause = wrong_udp(source, destination, body)
        if not cause:
            self.datagrams.append(line_of(source, body))
        return cause

    def _igmp(self, body: bytes, is_part: bool) -> str:
        if checksum(body):
            return "checksum"
        asked = body[4:8] in (bytes(4), *GROUPS[:2])
        return "" if body[:1] == b"\x11" and len(body) >= 8 and asked and not is_part else "other"

    def _icmp(
        self, rest: bytes, body: bytes, size: int, offset: int, more: bool, to_node: bool
    ) -> str:
        if size != 20 or not to_node:
            return "other"
        key = (rest[12:16], rest[4:6])
        if offset:
            if self._echo != (*key, offset):
                return "other"
        elif body[:2] != b"\x08\0" or len(body) < 8:
            return "other"
        elif not more and checksum(body):
            return "checksum"
        self._echo = (*key, offset + len(body) // 8 * 8) if more else None
        return "answer"

    def _fragment(
        self, source: bytes, to: bytes, ident: bytes, offset: int, more: bool, body: bytes
    ) -> str:
        if not offset:
            self._open[source] = (ident, to, body)
        elif source in self._open:
            known, first_to, before = self._open[source]
            if known != ident:
                return "fragment"
            del self._open[source]
            if len(before) == offset:
                self._open[source] = (ident, first_to, before + body)
                if not more and len(before) >= 8 and not wrong_udp(source, to, before + body):
                    self.trains.add(line_of(source, before + body))
        return "fragment"


def wrong_udp(source: bytes, destination: bytes, body: bytes) -> str:
    """Return why a datagram has to be dropped."""
    port, length = int.from_bytes(body[2:4], "big"), int.from_bytes(body[4:6], "big")
    if port not in PORTS:
        return "port"
    pseudo = source + destination + b"\0\x11" + body[4:6]
    if length != len(body) or (body[6:8] != b"\0\0" and checksum(pseudo + body)):
        return "checksum"
    return "other" if length == 8 else ""


def line_of(source: bytes, body: bytes) -> str:
    """Return a datagram as a line of the harness."""
    ports = [int.from_bytes(body[n : n + 2], "big") for n in (0, 2)]
    return f"d {source.hex()} {ports[0]} {ports[1]} {body[8:].hex()}"
