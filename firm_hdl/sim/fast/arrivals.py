"""What came on the output streams of a simulation, and waits to be received."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Sequence

from firm_hdl.sim.fast.packing import Packet, PacketJoiner, Transfer, unpacked
from firm_hdl.sim.fast.ports import StreamPort
from firm_hdl.sim.fast.protocol import CYCLE_BYTES

__all__ = ["Arrivals"]


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
