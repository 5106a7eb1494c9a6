"""A node in the chip of the processor: frames in memory, which an AXI DMA of Xilinx moves.

The DMA is in direct register mode, or has a scatter-gather engine. Names of registers and bits are
those of its manual, PG021.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Literal, Protocol

from firm_hdl.node.boards import descriptors
from firm_hdl.node.boards.board import Board, BoardError
from firm_hdl.node.boards.devices import DmaBuffer, Uio

__all__ = ["Buffer", "Registers", "ZynqBoard", "open_devices", "reset"]

Channel = Literal["MM2S", "S2MM"]

_AT: dict[Channel, int] = {"MM2S": 0x00, "S2MM": 0x30}
_DMACR, _DMASR, _ADDRESS, _ADDRESS_MSB, _LENGTH = 0x00, 0x04, 0x18, 0x1C, 0x28
_CURDESC, _CURDESC_MSB, _TAILDESC = 0x08, 0x0C, 0x10
_RS, _ALWAYS_1, _RESET, _IRQ_THRESHOLD_1 = 1 << 0, 1 << 1, 1 << 2, 1 << 16
_HALTED, _SG_INCLUDED = 1 << 0, 1 << 3
# Of the same bits in DMACR, which enable them.
_IOC_IRQ, _ERR_IRQ = 1 << 12, 1 << 14
_ERRORS = {
    1 << 4: "DMAIntErr: a frame was longer than its buffer, or the DMA failed inside",
    1 << 5: "DMASlvErr: the memory refused an access",
    1 << 6: "DMADecErr: no memory has this address",
    1 << 8: "SGIntErr: a descriptor was not handed over",
    1 << 9: "SGSlvErr: the memory refused an access to a descriptor",
    1 << 10: "SGDecErr: no memory has the address of a descriptor",
}

_LENGTH_BITS = "xlnx,sg-length-width"
"""The property of the DMA in the device tree, also without scatter-gather."""

_LENGTHS_BITS = range(8, 27)
"""Widths that its length register may have."""

_ALIGNMENT = 64
_ROOM_BYTES = 1 << 16
_MOST_AT_ONCE = 256
_MOST_DESCRIPTORS = 64
_WAIT_SECONDS = 0.1
"""How long a reset or a start may take: each takes a few cycles."""


class Registers(Protocol):
    """What a board needs of a :class:`.Uio`."""

    def fileno(self) -> int: ...
    def read(self, offset: int) -> int: ...
    def write(self, offset: int, value: int) -> None: ...
    def take_interrupt(self) -> None: ...
    def enable_interrupt(self) -> None: ...
    def tree_value(self, name: str) -> int | None: ...
    def close(self) -> None: ...


class Buffer(Protocol):
    """What a board needs of a :class:`.DmaBuffer`."""

    name: str
    address: int
    size: int
    data: memoryview

    def to_device(self, offset: int, size: int, *, is_written: bool) -> None: ...
    def to_processor(self, offset: int, size: int) -> None: ...
    def close(self) -> None: ...


def open_devices(uio: str, buffer: str) -> tuple[Registers, Buffer]:
    """Open the devices of these names; raises :class:`BoardError`."""
    registers = Uio(uio)
    try:
        return registers, DmaBuffer(buffer)
    except BoardError:
        registers.close()
        raise


class ZynqBoard(Board):
    """A board with the link `axi_dma`, on its own processor.

    The buffer has three parts of a frame each: one that is sent, and two to receive, of which the
    DMA has one while the other is read. What else is sent waits here. If the DMA has a
    scatter-gather engine, each direction has a ring of as many parts as the buffer has room for:
    the DMA receives while this program is busy, and sends one frame after the other.

    An error of the DMA ends the board. It is counted as ``DMA errors``, and opening the board again
    resets the DMA, which tells the node to begin anew.

    * `uio`, `buffer`: names of the devices.
    * `frame_bytes`: most bytes of a frame: the `buffer_bytes` of the link.
    * `devices`: opens the devices.
    """

    def __init__(
        self,
        name: str,
        uio: str,
        buffer: str,
        frame_bytes: int,
        devices: Callable[[str, str], tuple[Registers, Buffer]] = open_devices,
    ) -> None:
        super().__init__(name, frame_bytes)
        self._names, self._devices = (uio, buffer), devices
        self._most, self._part_bytes = frame_bytes, _aligned(frame_bytes)
        self._opened: tuple[Registers, Buffer] | None = None
        self._waiting: deque[bytes] = deque()
        self._waiting_bytes = 0
        self._sends = self._has_stopped = False
        # The part that the DMA writes.
        self._written = 0
        # With a scatter-gather engine. A frame that is split was longer than a buffer.
        self._rings: dict[Channel, descriptors.Ring] = {}
        self._is_split = False
        # Whether the upper halves of addresses are written.
        self._has_high_addresses = False

    def open(self) -> None:
        self.close()
        self._waiting.clear()
        self._waiting_bytes = 0
        self._sends = self._has_stopped = self._is_split = False
        self._rings = {}
        self._opened = self._devices(*self._names)
        # PG021 has this order: pointers to descriptors while a channel is halted, then RS, then
        # what begins a transfer, which is a tail or a length.
        try:
            registers, buffer = self._opened
            self._check_sizes(registers, buffer)
            if self._reset(registers):
                self._make_rings(registers, buffer)
            self._start(registers)
            if self._rings:
                self._move_tail("S2MM")
            else:
                self._receive_into(1)
                self._check_length(registers)
            self._opened[0].take_interrupt()
            self._opened[0].enable_interrupt()
        except BoardError:
            self.close()
            raise

    def _check_sizes(self, registers: Registers, buffer: Buffer) -> None:
        needed = 3 * self._part_bytes
        if buffer.size < needed:
            raise BoardError(
                f"'{buffer.name}' has {buffer.size} bytes, and {needed} are needed: 3 buffers for "
                f"frames of up to {self._most} bytes"
            )
        if buffer.address % _ALIGNMENT:
            raise BoardError(
                f"'{buffer.name}' begins at {buffer.address:#x}, which is no multiple of "
                f"{_ALIGNMENT}"
            )
        bits = registers.tree_value(_LENGTH_BITS)
        if bits is not None and self._most >> bits:
            raise self._too_narrow(bits)

    def _check_length(self, registers: Registers) -> None:
        """Check that the DMA has kept the length of the buffer; not every device tree tells."""
        kept = registers.read(_AT["S2MM"] + _LENGTH)
        for bits in _LENGTHS_BITS:
            if self._most >> bits and kept == self._most & (1 << bits) - 1:
                raise self._too_narrow(bits)

    def _too_narrow(self, bits: int) -> BoardError:
        return BoardError(
            f"the DMA has lengths of {bits} bits, up to {(1 << bits) - 1} bytes, and frames "
            f"have up to {self._most}; widen its buffer length register, or give the "
            "link smaller 'buffer_bytes'"
        )

    def _reset(self, registers: Registers) -> bool:
        """Reset the DMA; return whether it has a scatter-gather engine."""
        if not reset(registers):
            raise BoardError("the reset of the DMA does not end; does its clock run?")
        status = 0
        for channel, at in _AT.items():
            control, status = registers.read(at + _DMACR), registers.read(at + _DMASR)
            if control & (_RS | _ALWAYS_1 | _RESET) != _ALWAYS_1 or not status & _HALTED:
                raise BoardError(
                    f"'{self._names[0]}' is no AXI DMA with a channel {channel}: its DMACR is "
                    f"{control:#010x} after a reset, and its DMASR {status:#010x}"
                )
        return bool(status & _SG_INCLUDED)

    def _start(self, registers: Registers) -> None:
        for channel, at in _AT.items():
            registers.write(at + _DMACR, _RS | _IOC_IRQ | _ERR_IRQ | _IRQ_THRESHOLD_1)
            if not _clears(registers, at + _DMASR, _HALTED):
                raise BoardError(f"{channel} of the DMA does not start")

    def _make_rings(self, registers: Registers, buffer: Buffer) -> None:
        """Lay out the rings, arm that of S2MM, and tell the DMA where each begins."""
        each = descriptors.BYTES + self._part_bytes
        count = min(_MOST_DESCRIPTORS, buffer.size // (2 * each))
        if count < 2:
            raise BoardError(
                f"'{buffer.name}' has {buffer.size} bytes, and {4 * each} are needed for a DMA "
                "with a scatter-gather engine: 2 descriptors and buffers in each direction"
            )
        start, parts = 0, 2 * count * descriptors.BYTES
        for channel, at in _AT.items():
            ring = descriptors.Ring(buffer, start, parts, count, self._part_bytes)
            start, parts = start + count * descriptors.BYTES, parts + count * self._part_bytes
            self._rings[channel] = ring
            # A DMA with addresses of 32 bits has no upper half.
            registers.write(at + _CURDESC_MSB, 0xFFFF_FFFF)
            self._has_high_addresses = bool(registers.read(at + _CURDESC_MSB))
            self._write_pointer(registers, at + _CURDESC, ring.first)
        while self._rings["S2MM"].has_room:
            self._arm_to_receive(buffer)

    def _write_pointer(self, registers: Registers, at: int, address: int) -> None:
        """Write a pointer to a descriptor. Its upper half is last, as that starts the engine."""
        if address >> 32 and not self._has_high_addresses:
            raise _too_few_bits(address)
        registers.write(at, address & 0xFFFF_FFFF)
        if self._has_high_addresses:
            registers.write(at + 4, address >> 32)

    def _move_tail(self, channel: Channel) -> None:
        """Let the DMA have what was armed."""
        last = self._rings[channel].last
        self._write_pointer(self._there()[0], _AT[channel] + _TAILDESC, last)

    def _arm_to_receive(self, buffer: Buffer) -> None:
        ring = self._rings["S2MM"]
        buffer.to_device(ring.next_buffer, self._part_bytes, is_written=True)
        ring.arm(self._most)

    def fileno(self) -> int:
        return self._there()[0].fileno()

    @property
    def has_room(self) -> bool:
        return self._waiting_bytes < _ROOM_BYTES

    def send(self, frames: Sequence[bytes]) -> bool:
        self._there()
        self._waiting += frames
        self._waiting_bytes += sum(map(len, frames))
        self._send_waiting()
        return True

    def receive(self) -> list[bytes]:
        registers, frames = self._there()[0], []
        registers.take_interrupt()
        try:
            for _ in range(_MOST_AT_ONCE):
                # Both directions go on, however much the node sends.
                self._send_waiting()
                if not self._has_completed("S2MM"):
                    break
                frames += self._taken() if self._rings else [self._received()]
            registers.enable_interrupt()
        except BoardError:
            # The next call says it again.
            if not frames:
                raise
        return frames

    def close(self) -> None:
        if self._opened is None:
            return
        (registers, buffer), self._opened = self._opened, None
        # The DMA must not write into memory that others may use.
        with suppress(BoardError):
            reset(registers)
        registers.close()
        buffer.close()

    def _there(self) -> tuple[Registers, Buffer]:
        if self._opened is None:
            raise BoardError(f"{self.name} is closed")
        return self._opened

    def _has_completed(self, channel: Channel) -> bool:
        """Return whether a transfer has completed, once.

        Raises `BoardError` if the channel has stopped.
        """
        registers, at = self._there()[0], _AT[channel] + _DMASR
        status = registers.read(at)
        if self._is_split or status & (_HALTED | sum(_ERRORS)):
            self.counters["DMA errors"] += not self._has_stopped
            self._has_stopped = True
            if self._is_split:
                raise BoardError(
                    f"a frame was longer than its buffer, which has {self._most} bytes as in the "
                    "description, or the DMA has lengths of too few bits"
                )
            raise BoardError(f"the DMA has stopped ({_problems(registers)}), and is reset")
        if status & _IOC_IRQ:
            registers.write(at, _IOC_IRQ)
        return bool(status & _IOC_IRQ)

    def _taken(self) -> list[bytes]:
        """Return the frames that have come, and let the DMA have their descriptors again."""
        ring, buffer, frames = self._rings["S2MM"], self._there()[1], list[bytes]()
        # What is armed here cannot complete before the tail moves, so this ends.
        while not self._is_split and (done := ring.completed()):
            start, size, status = done
            self._is_split = status & descriptors.WHOLE != descriptors.WHOLE
            if not self._is_split:
                buffer.to_processor(start, _aligned(size))
                frames.append(bytes(buffer.data[start : start + size]))
                self._arm_to_receive(buffer)
        if frames:
            self._move_tail("S2MM")
        return frames

    def _send_in_ring(self) -> None:
        """Send what waits, as far as descriptors are free."""
        ring, buffer = self._rings["MM2S"], self._there()[1]
        if self._has_completed("MM2S"):
            while ring.completed():
                pass
        is_armed = False
        while self._waiting and ring.has_room:
            frame, start = self._waiting.popleft(), ring.next_buffer
            self._waiting_bytes -= len(frame)
            buffer.data[start : start + len(frame)] = frame
            buffer.to_device(start, _aligned(len(frame)), is_written=False)
            ring.arm(descriptors.WHOLE | len(frame))
            is_armed = True
        if is_armed:
            self._move_tail("MM2S")

    def _received(self) -> bytes:
        """Return the frame that has come, after the DMA got the other part."""
        registers, buffer = self._there()
        # The DMA has replaced the size of the part by that of the frame.
        size = min(registers.read(_AT["S2MM"] + _LENGTH), self._most)
        start = self._written * self._part_bytes
        self._receive_into(3 - self._written)
        buffer.to_processor(start, _aligned(size))
        return bytes(buffer.data[start : start + size])

    def _receive_into(self, part: int) -> None:
        self._written = part
        start = part * self._part_bytes
        self._there()[1].to_device(start, self._part_bytes, is_written=True)
        self._transfer("S2MM", start, self._most)

    def _send_waiting(self) -> None:
        """Send what waits until a frame is under way; the DMA is often faster than this loop."""
        if self._rings:
            self._send_in_ring()
            return
        buffer = self._there()[1]
        while not self._sends or self._has_completed("MM2S"):
            self._sends = bool(self._waiting)
            if not self._sends:
                return
            frame = self._waiting.popleft()
            self._waiting_bytes -= len(frame)
            buffer.data[: len(frame)] = frame
            buffer.to_device(0, _aligned(len(frame)), is_written=False)
            self._transfer("MM2S", 0, len(frame))

    def _transfer(self, channel: Channel, start: int, size: int) -> None:
        """Begin a transfer: the length, which starts it, is written last."""
        registers, buffer = self._there()
        address, at = buffer.address + start, _AT[channel]
        registers.write(at + _ADDRESS, address & 0xFFFF_FFFF)
        # Also 0, once another part of the buffer was above 4 GiB: the register keeps its value.
        if (high := address >> 32) or self._has_high_addresses:
            registers.write(at + _ADDRESS_MSB, high)
            if registers.read(at + _ADDRESS_MSB) != high:
                raise _too_few_bits(address)
            self._has_high_addresses = True
        registers.write(at + _LENGTH, size)


def _aligned(size: int) -> int:
    return -(-size // _ALIGNMENT) * _ALIGNMENT


def _too_few_bits(address: int) -> BoardError:
    return BoardError(f"the DMA has too few bits for the address {address:#x}")


def _problems(registers: Registers) -> str:
    """Describe the errors of the DMA: that of one channel halts both."""
    found = [
        f"{channel}: {text}"
        for channel, at in _AT.items()
        for bit, text in _ERRORS.items()
        if registers.read(at + _DMASR) & bit
    ]
    return "; ".join(found) or "no DMASR has an error"


def reset(registers: Registers) -> bool:
    """Reset both channels of a DMA, as the bit of either does; return whether it has ended."""
    registers.write(_AT["MM2S"] + _DMACR, _RESET)
    return _clears(registers, _AT["MM2S"] + _DMACR, _RESET)


def _clears(registers: Registers, offset: int, bit: int) -> bool:
    """Wait for a moment until a bit of a register is 0; return whether it is."""
    end = time.monotonic() + _WAIT_SECONDS
    while (is_set := bool(registers.read(offset) & bit)) and time.monotonic() < end:
        time.sleep(0.001)
    return not is_set
