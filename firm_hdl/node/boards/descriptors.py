"""A ring of descriptors in memory, for a channel of an AXI DMA with a scatter-gather engine.

Names of fields are those of the DMA's manual, PG021 ("Scatter Gather Descriptor").
"""

from __future__ import annotations

import struct
from typing import Protocol

__all__ = ["BYTES", "WHOLE", "Memory", "Ring"]

BYTES = 64
"""A descriptor begins at a multiple of so many bytes: a line of the processor's caches."""

WHOLE = 1 << 27 | 1 << 26
"""First and last descriptor of a packet, SOF and EOF: in CONTROL of MM2S, and STATUS of S2MM."""

_COMPLETED = 1 << 31
_LENGTH = (1 << 26) - 1
# NXTDESC and BUFFER_ADDRESS, with upper halves; CONTROL, STATUS.
_FORM = struct.Struct("<QQ8xII32x")
_STATUS_AT = 0x1C


class Memory(Protocol):
    """What a ring needs of a :class:`.DmaBuffer`."""

    address: int
    data: memoryview

    def to_device(self, offset: int, size: int, *, is_written: bool) -> None: ...
    def to_processor(self, offset: int, size: int) -> None: ...


class Ring:
    """Descriptors, each of which has a buffer of its own.

    * `memory`: has both.
    * `start`, `buffers`: where descriptors and buffers begin in it, in bytes.
    * `count`: how many of them. They are armed and completed in their order.
    * `buffer_bytes`: size of a buffer, a multiple of 64.
    """

    def __init__(
        self, memory: Memory, start: int, buffers: int, count: int, buffer_bytes: int
    ) -> None:
        self._memory, self._start, self._buffers = memory, start, buffers
        self._count, self._buffer_bytes = count, buffer_bytes
        # The oldest one that is armed, and how many are.
        self._head = self._armed = 0

    @property
    def has_room(self) -> bool:
        """Whether a descriptor is not armed."""
        return self._armed < self._count

    @property
    def next_buffer(self) -> int:
        """Where the buffer begins that :meth:`arm` gives the DMA."""
        return self._buffers + self._next * self._buffer_bytes

    @property
    def _next(self) -> int:
        return (self._head + self._armed) % self._count

    @property
    def first(self) -> int:
        """The address of the first descriptor, at which the DMA begins."""
        return self._address(0)

    @property
    def last(self) -> int:
        """The address of the last descriptor that was armed, after which the DMA waits."""
        return self._address((self._next - 1) % self._count)

    def _address(self, number: int) -> int:
        return self._memory.address + self._start + number * BYTES

    def arm(self, control: int) -> None:
        """Hand over the next descriptor, whose buffer was handed over; STATUS becomes 0."""
        at, following = self._start + self._next * BYTES, (self._next + 1) % self._count
        address = self._memory.address + self.next_buffer
        _FORM.pack_into(self._memory.data, at, self._address(following), address, control, 0)
        # The DMA also writes STATUS into it: `completed` takes the line back before each look.
        self._memory.to_device(at, BYTES, is_written=False)
        self._armed += 1

    def completed(self) -> tuple[int, int, int] | None:
        """Take the oldest descriptor back, once the DMA has completed it; `None`: it has not.

        Returns where its buffer begins, the bytes that were transferred, and its STATUS.
        """
        if not self._armed:
            return None
        at = self._start + self._head * BYTES
        self._memory.to_processor(at, BYTES)
        (status,) = struct.unpack_from("<I", self._memory.data, at + _STATUS_AT)
        if not status & _COMPLETED:
            return None
        buffer = self._buffers + self._head * self._buffer_bytes
        self._head, self._armed = (self._head + 1) % self._count, self._armed - 1
        return buffer, status & _LENGTH, status
