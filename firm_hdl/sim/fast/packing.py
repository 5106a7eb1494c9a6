"""Payloads and packets as the bytes of the protocol, many at a time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from firm_hdl.sim.fast.protocol import CYCLE_BYTES

__all__ = ["Packet", "PacketJoiner", "Transfer", "packed", "packed_packets", "unpacked"]


class Transfer(NamedTuple):
    """A transfer: the cycle, counted from 0 at the start or reset, and the payload as bits."""

    cycle: int
    bits: int


class Packet(NamedTuple):
    """A packet that came: its bytes, and the cycle of its last beat."""

    data: bytes
    cycle: int


def packed(payloads: Iterable[int], size: int) -> bytes:
    """Return payloads, given as bits, as `size` bytes each."""
    return b"".join(bits.to_bytes(size, "little") for bits in payloads)


def unpacked(records: bytes, size: int) -> list[Transfer]:
    """Return the transfers of a message TRANSFERS, whose payloads have `size` bytes."""
    step = CYCLE_BYTES + size
    return [
        Transfer(
            int.from_bytes(records[at : at + CYCLE_BYTES], "little"),
            int.from_bytes(records[at + CYCLE_BYTES : at + step], "little"),
        )
        for at in range(0, len(records), step)
    ]


def packed_packets(packets: Iterable[bytes], bus_bytes: int) -> bytes:
    """Return the beats of packets, as bytes of the protocol.

    The payload of a beat has `bus_bytes` bytes of data, then a byte: `count` in its lowest bits,
    and `last` above. Lanes that are not valid are 0.
    """
    return b"".join(_beats(packet, bus_bytes) for packet in packets)


def _beats(packet: bytes, bus_bytes: int) -> bytes:
    count = max(1, -(-len(packet) // bus_bytes))
    beats = np.zeros((count, bus_bytes + 1), np.uint8)
    padded = packet.ljust(count * bus_bytes, b"\0")
    beats[:, :bus_bytes] = np.frombuffer(padded, np.uint8).reshape(count, bus_bytes)
    beats[:, bus_bytes] = bus_bytes
    beats[-1, bus_bytes] = len(packet) - (count - 1) * bus_bytes | 1 << bus_bytes.bit_length()
    return beats.tobytes()


@dataclass(slots=True)
class PacketJoiner:
    """Join the transfers of a packet stream to packets.

    Attributes
    ----------
    bus_bytes : int
    partial : bytearray
        Bytes of the packet that has begun and not yet ended.
    """

    bus_bytes: int
    partial: bytearray = field(default_factory=bytearray)

    def add(self, records: bytes) -> list[Packet]:
        """Add the records of a message TRANSFERS; return the packets that end in them."""
        width = self.bus_bytes
        rows = np.frombuffer(records, np.uint8).reshape(-1, CYCLE_BYTES + width + 1)
        cycles = rows[:, :CYCLE_BYTES].copy().view("<u8").ravel()
        data = rows[:, CYCLE_BYTES : CYCLE_BYTES + width]
        tail = rows[:, CYCLE_BYTES + width]
        counts = tail & ((1 << width.bit_length()) - 1)
        valid = np.arange(width) < counts[:, None]
        # Number of bytes up to the end of each beat.
        ends = np.cumsum(np.minimum(counts, width), dtype=np.int64)
        whole = data[valid].tobytes()
        packets, start = [], 0
        for index in np.flatnonzero(tail >> width.bit_length()):
            end = int(ends[index])
            packets.append(Packet(bytes(self.partial) + whole[start:end], int(cycles[index])))
            self.partial.clear()
            start = end
        self.partial += whole[start:]
        return packets
