"""An AXI DMA of Xilinx, after its manual, PG021 (v7.1), in Python: both of its modes.

It is strict: what the manual leaves undefined is an `AssertionError` of the driver.
"""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Callable

__all__ = ["AxiDma"]

RS, RESET, IOC, ERR = 1 << 0, 1 << 2, 1 << 12, 1 << 14
HALTED, IDLE, SG = 1 << 0, 1 << 1, 1 << 3
INT_ERR, SLV_ERR, DEC_ERR = 1 << 4, 1 << 5, 1 << 6
SG_INT_ERR, SG_SLV_ERR, SG_DEC_ERR = 1 << 8, 1 << 9, 1 << 10
# Of a descriptor: in CONTROL of MM2S, and in STATUS of S2MM; in STATUS.
SOF, EOF, COMPLETED = 1 << 27, 1 << 26, 1 << 31
DESCRIPTOR = struct.Struct("<QQ8xII32x")


class Channel:
    """The registers of a channel. `length` is that of the register, `left` that of a transfer."""

    def __init__(self, dma: AxiDma, is_s2mm: bool) -> None:
        self.dma, self.is_s2mm = dma, is_s2mm
        self.reset()

    def reset(self) -> None:
        # IRQThreshold is 1 after a reset, and bit 1 is always 1.
        self.control, self.status = 1 << 16 | 1 << 1, HALTED
        self.address = self.length = 0
        self.is_busy = self.is_sent = False

    @property
    def interrupt(self) -> bool:
        return bool(self.status & self.control & (IOC | ERR))

    def read(self, offset: int) -> int:
        match offset:
            case 0x00:
                return self.control
            case 0x04:
                return self.status
            case 0x18:
                return self.address & 0xFFFF_FFFF
            case 0x1C:
                return self.address >> 32
            case 0x28:
                return self.length
        raise AssertionError(f"offset {offset:#x} is reserved")

    def write(self, offset: int, value: int) -> None:
        match offset:
            case 0x00:
                self._write_control(value)
            case 0x04:
                # Interrupts are cleared by writing 1; all else is read only.
                self.status &= ~(value & (IOC | ERR))
            case 0x18:
                self.address = self.address & ~0xFFFF_FFFF | value
            case 0x1C:
                high = value & ((1 << max(0, self.dma.address_bits - 32)) - 1)
                self.address = self.address & 0xFFFF_FFFF | high << 32
            case 0x28:
                self._write_length(value)
            case _:
                raise AssertionError(f"offset {offset:#x} is reserved")

    def _write_control(self, value: int) -> None:
        if value & RESET:
            self.dma.reset()
            return
        starts = value & RS and not self.control & RS
        self.control = value & 0xFFFF_F019 | 1 << 1
        if starts:
            # Idle is 0 before the first transfer.
            self.status &= ~(HALTED | IDLE)
        elif not value & RS:
            self.halt()

    def halt(self) -> None:
        self.control &= ~RS
        self.status = self.status & ~IDLE | HALTED
        self.is_busy = False

    def _write_length(self, value: int) -> None:
        value &= (1 << self.dma.length_bits) - 1
        if self.status & HALTED or not value:
            return
        assert not self.is_busy, "a transfer is under way"
        assert self.address % self.dma.bus_bytes == 0, "without DRE, addresses are aligned"
        self.length, self.is_busy, self.is_sent = value, True, False
        self.status &= ~IDLE
        if self.is_s2mm:
            self.dma.streams.let_packet_come()

    def step(self) -> None:
        """Do what can be done now."""
        if not self.is_busy or (self.is_s2mm and not self.dma.packets):
            return
        if not self.is_sent:
            packet = self.dma.packets.popleft() if self.is_s2mm else b""
            size = len(packet) if self.is_s2mm else self.length
            if problem := self._problem(size):
                self.fail(problem)
                return
            place = self.dma.memory[self.address - self.dma.base :][:size]
            if self.is_s2mm:
                place[:] = packet
                # The size of the buffer is replaced by that of the packet.
                self.length = size
            else:
                self.is_sent = True
                self.dma.streams.send(bytes(place))
        if self.is_s2mm or self.dma.streams.has_sent:
            self.is_busy = False
            self.status |= IDLE | IOC

    def fail(self, problem: int) -> None:
        """Stop with these error bits."""
        self.status |= problem | ERR
        # "error_out <= error; map out to halt opposing channel": the VHDL of the core.
        self.dma.mm2s.halt()
        self.dma.s2mm.halt()

    def _problem(self, size: int) -> int:
        """Return the error bit of a transfer of `size` bytes."""
        if self.is_s2mm and size > self.length:
            return INT_ERR
        return self.access_problem(self.address, size)

    def access_problem(self, address: int, size: int) -> int:
        """Return the error bit of an access to memory."""
        if not self.dma.base <= address <= self.dma.base + len(self.dma.memory) - size:
            return DEC_ERR
        return self.dma.fails.pop("S2MM" if self.is_s2mm else "MM2S", 0)


class SgChannel(Channel):
    """A channel with a scatter-gather engine, which fetches a descriptor when it is due."""

    def reset(self) -> None:
        super().reset()
        # Where the engine is, where it pauses, and where it goes on.
        self.current = self.tail = self.following = 0
        # IRQThresholdSts: packets until the next interrupt.
        self.to_interrupt = 1
        self.packet = b""
        self.is_inside = self.is_fetched = False

    def read(self, offset: int) -> int:
        match offset:
            case 0x00:
                return self.control
            case 0x04:
                return self.status | SG | self.to_interrupt << 16
            case 0x08 | 0x0C:
                return self.current >> 8 * (offset - 0x08) & 0xFFFF_FFFF
            case 0x10 | 0x14:
                return self.tail >> 8 * (offset - 0x10) & 0xFFFF_FFFF
        raise AssertionError(f"offset {offset:#x} is reserved with a scatter-gather engine")

    def write(self, offset: int, value: int) -> None:
        has_high = self.dma.address_bits > 32
        match offset:
            case 0x00:
                threshold = value >> 16 & 0xFF
                assert value & RESET or threshold, "the threshold is 1 at least"
                assert not value >> 24, "there is no timer here"
                self._write_control(value)
                self.to_interrupt = threshold or 1
            case 0x04:
                super().write(offset, value)
            case 0x08 | 0x0C:
                # With RS = 1, it is read only.
                if self.status & HALTED:
                    self.current = self.following = self._pointer(self.current, offset, value)
            case 0x10 | 0x14:
                self.tail = self._pointer(self.tail, offset, value)
                if offset == (0x14 if has_high else 0x10) and not self.status & HALTED:
                    self.is_busy, self.status = True, self.status & ~IDLE
            case _:
                raise AssertionError(f"offset {offset:#x} is reserved with a scatter-gather engine")

    def _pointer(self, old: int, offset: int, value: int) -> int:
        if offset & 4:
            high = value & ((1 << max(0, self.dma.address_bits - 32)) - 1)
            return old & 0xFFFF_FFFF | high << 32
        assert value % 64 == 0, "descriptors are aligned to 16 words"
        return old & ~0xFFFF_FFFF | value

    def step(self) -> None:
        if self.is_busy and not self.is_fetched:
            self._fetch()
        if self.is_busy and self.is_fetched and self.is_s2mm:
            self._receive()
        elif self.is_busy and self.is_fetched and self.dma.streams.has_sent:
            self._complete(self.length, self.is_sent)

    def _fetch(self) -> None:
        self.current = self.following
        name = "S2MM descriptor" if self.is_s2mm else "MM2S descriptor"
        problem = self.dma.fails.pop(name, 0)
        if not self.dma.base <= self.current <= self.dma.base + len(self.dma.memory) - 64:
            problem = SG_DEC_ERR
        if problem:
            self.fail(problem)
            return
        fields = DESCRIPTOR.unpack_from(self.dma.memory, self.current - self.dma.base)
        self.following, self.address, control, status = fields
        assert self.following % 64 == 0, "descriptors are aligned to 16 words"
        assert self.address % self.dma.bus_bytes == 0, "without DRE, addresses are aligned"
        self.length = control & (1 << self.dma.length_bits) - 1
        if status & COMPLETED:
            self.fail(SG_INT_ERR)
            return
        if not self.length or (not self.is_s2mm and (problem := self._access())):
            self._fail_here(problem or INT_ERR)
            return
        self.is_fetched = True
        if self.is_s2mm:
            self.dma.streams.let_packet_come()
            return
        assert bool(control & SOF) != self.is_inside, "SOF begins a packet"
        self.packet += bytes(self.dma.memory[self.address - self.dma.base :][: self.length])
        self.is_sent, self.is_inside = bool(control & EOF), not control & EOF
        if self.is_sent:
            packet, self.packet = self.packet, b""
            self.dma.streams.send(packet)

    def _access(self) -> int:
        return self.access_problem(self.address, self.length)

    def _fail_here(self, problem: int) -> None:
        """Stop with an error that STATUS has, too: its bits are those of DMASR from bit 28 on."""
        self._update(problem << 24)
        self.fail(problem)

    def _receive(self) -> None:
        if not self.is_inside:
            if not self.dma.packets:
                return
            self.packet = self.dma.packets.popleft()
        if problem := self._access():
            self._fail_here(problem)
            return
        piece, self.packet = self.packet[: self.length], self.packet[self.length :]
        self.dma.memory[self.address - self.dma.base :][: len(piece)] = piece
        marks = SOF * (not self.is_inside) | EOF * (not self.packet)
        self.is_inside = bool(self.packet)
        self._complete(len(piece) | marks, not self.packet)

    def _complete(self, status: int, ends_packet: bool) -> None:
        self._update(status | COMPLETED)
        self.is_fetched = False
        if self.current == self.tail:
            self.is_busy, self.status = False, self.status | IDLE
        if ends_packet:
            self.to_interrupt -= 1
            if not self.to_interrupt:
                self.to_interrupt, self.status = self.control >> 16 & 0xFF, self.status | IOC

    def _update(self, status: int) -> None:
        struct.pack_into("<I", self.dma.memory, self.current - self.dma.base + 0x1C, status)


class Streams:
    """The streams of a DMA, with a function in place of what is connected with them.

    Parameters
    ----------
    take : callable
        Takes a packet of MM2S.

    Attributes
    ----------
    has_sent : bool
        Whether the last packet has left.
    """

    has_sent = True

    def __init__(self, take: Callable[[bytes], None]) -> None:
        self.send = take

    def let_packet_come(self) -> None:
        """Let the next packet of S2MM come, for which there is a buffer now."""

    def receive(self) -> list[bytes]:
        """Return the packets of S2MM that have come."""
        return []

    def reset(self) -> None:
        """Reset, with what is connected."""


class AxiDma:
    """Both channels.

    Parameters
    ----------
    memory : memoryview
        The memory that the DMA sees, from the address `base` on.
    streams : Streams
        Where packets of MM2S go.

    Attributes
    ----------
    packets : deque of bytes
        What has come on the stream of S2MM. A reset loses it.
    fails : dict of str to int
        By channel: the error bit of its next transfer. By ``MM2S descriptor`` or ``S2MM
        descriptor``: that of its next access to a descriptor.
    resets : int
        Resets by software, in which `mm2s_prmry_reset_out_n` and `s2mm_prmry_reset_out_n` are low.
    """

    def __init__(
        self,
        memory: memoryview,
        base: int,
        streams: Streams,
        *,
        bus_bytes: int = 8,
        length_bits: int = 14,
        address_bits: int = 40,
        has_sg: bool = False,
        has_s2mm: bool = True,
    ) -> None:
        self.memory, self.base, self.streams, self.bus_bytes = memory, base, streams, bus_bytes
        self.length_bits, self.address_bits = length_bits, address_bits
        self.has_s2mm, self.resets = has_s2mm, 0
        self.packets: deque[bytes] = deque()
        self.fails: dict[str, int] = {}
        kind = SgChannel if has_sg else Channel
        self.mm2s, self.s2mm = kind(self, False), kind(self, True)

    def reset(self) -> None:
        """Reset the whole engine, as the bit of either channel does."""
        self.resets += 1
        self.packets.clear()
        self.mm2s.reset()
        self.s2mm.reset()
        self.streams.reset()

    @property
    def interrupt(self) -> bool:
        """Both interrupts in one line."""
        return self.mm2s.interrupt or self.s2mm.interrupt

    def read(self, offset: int) -> int:
        """Read a register on AXI4-Lite."""
        if offset < 0x30:
            return self.mm2s.read(offset)
        return self.s2mm.read(offset - 0x30) if self.has_s2mm else 0

    def write(self, offset: int, value: int) -> None:
        """Write a register on AXI4-Lite."""
        assert 0 <= value < 1 << 32
        if offset < 0x30:
            self.mm2s.write(offset, value)
        elif self.has_s2mm:
            self.s2mm.write(offset - 0x30, value)

    def step(self) -> None:
        """Do what can be done now."""
        self.mm2s.step()
        self.s2mm.step()
