"""Payloads and packets as the bytes of the protocol, many at a time."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from firm_hdl.sim.fast.ports import StreamPort
from firm_hdl.sim.fast.protocol import CYCLE_BYTES

__all__ = ["Arrivals", "Packet", "PacketJoiner", "Transfer", "packed", "packed_packets", "unpacked"]


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


def packed_packets(packets: Iterable[bytes], bus_bytes: int, *, counts: bool = False) -> bytes:
    """Return the beats of packets, as bytes of the protocol.

    The payload of a beat has `bus_bytes` bytes of data, then a byte: `count` in its lowest bits,
    and `last` above. Lanes that are not valid have random bytes, and with `counts` so has `count`
    in beats that are not the last. Noise depends on the packet alone, so runs can be repeated.
    """
    return b"".join(_beats(packet, bus_bytes, counts) for packet in packets)


def _beats(packet: bytes, bus_bytes: int, counts: bool) -> bytes:
    noise = random.Random(packet)
    beats = max(1, -(-len(packet) // bus_bytes))
    padding = noise.randbytes(beats * bus_bytes - len(packet))
    rows = np.full((beats, bus_bytes + 1), bus_bytes, np.uint8)
    rows[:, :bus_bytes] = np.frombuffer(packet + padding, np.uint8).reshape(beats, bus_bytes)
    if counts:
        rows[:, bus_bytes] = [noise.randint(0, bus_bytes) for _ in range(beats)]
    rows[-1, bus_bytes] = bus_bytes - len(padding) | 1 << bus_bytes.bit_length()
    return rows.tobytes()


@dataclass(slots=True)
class PacketJoiner:
    """Join the transfers of a packet stream to packets."""

    bus_bytes: int
    # Bytes of the packet that has begun and not yet ended.
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


class Arrivals:
    """Transfers and packets by stream, in the order in which they came.

    The transfers of a packet stream are joined to packets when its packets are asked for. From then
    on, they are no longer there as transfers.

    Parameters
    ----------
    streams : sequence of StreamPort
    ignored : collection of str
        Streams whose transfers are not kept.
    """

    def __init__(self, streams: Sequence[StreamPort], ignored: Collection[str]):
        self._streams = streams
        self._sizes = {each.name: CYCLE_BYTES + each.bytes for each in streams}
        self._ignored = ignored
        self._records: dict[str, list[bytes]] = {}
        widths = {each.name: each.bus_bytes for each in streams if each.bus_bytes}
        self._joiners = {name: PacketJoiner(width) for name, width in widths.items()}
        self._packets: dict[str, deque[Packet]] = {name: deque() for name in widths}

    def __bool__(self) -> bool:
        """Return whether a transfer or a packet waits."""
        return any(self._records.values()) or any(self._packets.values())

    def keep(self, number: int, records: bytes) -> None:
        """Keep the records of a message TRANSFERS."""
        name = self._streams[number].name
        if name not in self._ignored:
            self._records.setdefault(name, []).append(records)

    def count(self, name: str) -> int:
        """Return how many transfers wait; of a packet stream, how many packets."""
        if name in self._packets:
            self._join(name)
            return len(self._packets[name])
        return sum(map(len, self._records.get(name, ()))) // self._sizes[name]

    def take_transfers(self, name: str) -> list[Transfer]:
        """Take all transfers of a stream."""
        records = b"".join(self._records.pop(name, ()))
        return unpacked(records, self._sizes[name] - CYCLE_BYTES)

    def take_packets(self, name: str) -> list[Packet]:
        """Take all packets of a packet stream."""
        self._join(name)
        packets = list(self._packets[name])
        self._packets[name].clear()
        return packets

    def _join(self, name: str) -> None:
        if records := b"".join(self._records.pop(name, ())):
            self._packets[name].extend(self._joiners[name].add(records))
