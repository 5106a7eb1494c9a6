"""Payloads of streams as plain integers, and packets as beats.

Simulation is several times faster with integers than with structures. So :mod:`firm_hdl.sim` moves
payloads as bits of a stream, and converts them only at its interfaces. The payload of a leaf is an
integer, which is negative for a negative value of a signed leaf. A float is given by its bits. The
payload of `items` is a tuple: the lanes, and whether `last` is set.

Bits that a receiver has to ignore are random in simulation, so that a circuit that uses them fails.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Sized
from dataclasses import dataclass, field

from firm_hdl.plan import Leaf, Payload

__all__ = [
    "PacketCollector",
    "all_beats",
    "as_packets",
    "beats_of",
    "decoder_of",
    "encoder_of",
    "packet_beats",
]


def decoder_of(leaf: Leaf) -> Callable[[int], Payload]:
    """Return the function from the bits of a leaf's payload to the payload."""
    bits, lanes = leaf.primitive.bits, range(leaf.lanes)
    mask = (1 << bits) - 1
    sign = 1 << (bits - 1) if leaf.signed else 0

    def number(value: int) -> int:
        return ((value & mask) ^ sign) - sign

    if leaf.kind != "items":
        return number
    end = bits * leaf.lanes
    return lambda value: (
        tuple(number(value >> bits * lane) for lane in lanes),
        bool(value >> end & 1),
    )


def encoder_of(leaf: Leaf) -> Callable[[Payload], int]:
    """Return the function from a leaf's payload to its bits; missing lanes are 0."""
    bits = leaf.primitive.bits
    mask = (1 << bits) - 1

    def encode(payload: Payload) -> int:
        if isinstance(payload, int):
            return payload & mask
        items, last = payload
        value = int(last) << bits * leaf.lanes
        for lane, item in enumerate(items):
            value |= (item & mask) << bits * lane
        return value

    return encode


def as_packets(packets: Iterable[bytes]) -> Iterator[bytes]:
    """Return packets of a user, checked: those of a list at once, others when they are taken.

    Raises `TypeError` if it is one packet in place of several, or one of them is not bytes.
    """
    if isinstance(packets, bytes | bytearray | memoryview | str) or not isinstance(
        packets, Iterable
    ):
        raise TypeError(f"Packets must be a list of bytes, such as [b'...'], not {packets!r}")
    checked = map(_as_packet, packets)
    return iter(list(checked)) if isinstance(packets, Sized) else checked


def _as_packet(packet: object) -> bytes:
    if not isinstance(packet, bytes | bytearray | memoryview):
        raise TypeError(f"A packet must be bytes, not {packet!r}")
    return bytes(packet)


def beats_of(packet_bytes: int, bus_bytes: int) -> int:
    """Return the number of beats of a packet; an empty packet has one."""
    return max(1, -(-packet_bytes // bus_bytes))


def packet_beats(
    packet: bytes, bus_bytes: int, noise: random.Random | None = None, *, counts: bool = False
) -> Iterator[int]:
    """Yield the beats of a packet, as bits of a packet stream's payload.

    * `noise`: generator for the bytes of lanes that are not valid; `None`: these bytes are 0.
    * `counts`: make `count` random, too, in beats that are not the last. A deserializer ignores
      `count` there; other components may not.
    """
    count_at = 8 * bus_bytes
    last_at = count_at + bus_bytes.bit_length()
    for at in range(0, max(1, len(packet)), bus_bytes):
        data = packet[at : at + bus_bytes]
        count, last = len(data), at + bus_bytes >= len(packet)
        if noise is not None:
            data += noise.randbytes(bus_bytes - count)
            count = noise.randint(0, bus_bytes) if counts and not last else count
        yield int.from_bytes(data, "little") | count << count_at | last << last_at


@dataclass(slots=True)
class PacketCollector:
    """Join beats to packets."""

    bus_bytes: int
    packets: list[bytes] = field(default_factory=list)  # Complete packets.
    beats: int = 0  # Beats taken so far.
    _parts: list[bytes] = field(default_factory=list)

    def take(self, bits: int) -> bool:
        """Add one beat; return whether it ended a packet."""
        count_at = 8 * self.bus_bytes
        count = bits >> count_at & ((1 << self.bus_bytes.bit_length()) - 1)
        data = (bits & ((1 << count_at) - 1)).to_bytes(self.bus_bytes, "little")
        self._parts.append(data[:count])
        self.beats += 1
        if not bits >> (count_at + self.bus_bytes.bit_length()):
            return False
        self.packets.append(b"".join(self._parts))
        self._parts.clear()
        return True

    @property
    def partial(self) -> bytes:
        """Bytes of the packet that has begun and not yet ended."""
        return b"".join(self._parts)


def all_beats(packets: Iterable[bytes], bus_bytes: int, *, counts: bool = False) -> Iterator[int]:
    """Yield the beats of packets, back to back; the noise is the same in each call.

    `counts` is that of :func:`packet_beats`.
    """
    noise = random.Random(f"{bus_bytes}/lanes that are not valid")
    for packet in packets:
        yield from packet_beats(packet, bus_bytes, noise, counts=counts)
