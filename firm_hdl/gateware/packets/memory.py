"""The size of a packet memory, as its writer and its reader see it."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

from amaranth.lib import enum
from amaranth.utils import ceil_log2

from firm_hdl.gateware.limits import check_integer
from firm_hdl.gateware.packets.sides import beat_layout
from firm_hdl.plan import check_bus_bytes

__all__ = ["MemoryShape", "Outcome", "WhenFull", "check_policy"]

WhenFull: TypeAlias = Literal["wait", "drop"]
"""What happens to a packet for which there is no room."""


class Outcome(enum.Enum, shape=2):  # type: ignore[call-arg]
    """What a :class:`PacketFifo` did with a packet.

    Members
    -------
    KEPT
        The packet is forwarded.
    ABORTED
        The packet was dropped because of `abort`, whether or not there was room.
    FULL
        The packet was dropped because there was no room.
    LARGE
        The packet was dropped because it is larger than the memory.
    """

    KEPT = 0
    ABORTED = 1
    FULL = 2
    LARGE = 3


def check_policy(when_full: WhenFull) -> None:
    """Raise a `ValueError` if a policy does not exist."""
    if when_full not in get_args(WhenFull):
        raise ValueError(f"Policy must be 'wait' or 'drop', not {when_full!r}")


class MemoryShape:
    """The size of a packet memory.

    A position is the address of a beat, with a lap bit above it. So the difference of two positions
    tells a full memory from an empty one.

    * `bus_bytes`, `memory_bytes`, `packets`, `side_bits`: as for :class:`PacketFifo`.

    Raises `TypeError` or `ValueError`.
    """

    def __init__(self, bus_bytes: int, memory_bytes: int, packets: int, side_bits: int = 0):
        check_bus_bytes(bus_bytes)
        check_integer("Memory size", memory_bytes)
        check_integer("Number of packets", packets)
        if memory_bytes < 2 * bus_bytes or memory_bytes & (memory_bytes - 1):
            least = 2 * bus_bytes
            raise ValueError(
                f"Memory size must be a power of two from {least} bytes on, not {memory_bytes}"
            )
        if packets < 1:
            raise ValueError(f"Number of packets must be at least 1, not {packets}")
        self.bus_bytes, self.memory_bytes, self.packets = bus_bytes, memory_bytes, packets
        self.beats = memory_bytes // bus_bytes  # Beats in the memory.
        # A word of the memory: a beat, with `side` if there are such bits.
        self.side_bits, self.beat = side_bits, beat_layout(bus_bytes, side_bits)
        # Bits of an address, of a position, and of the number of a byte in its beat.
        self.lane_bits = ceil_log2(bus_bytes)
        self.address_bits = ceil_log2(self.beats)
        self.position_bits = self.address_bits + 1
