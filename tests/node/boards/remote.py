"""The devices of a :class:`tests.node.boards.chip.Chip`, also of one that runs elsewhere.

They stand for a UIO device and a u-dma-buf, so that the driver is the one of a real board. Orders
are three numbers: ``op, a, b``, of which each is answered by one.
"""

from __future__ import annotations

import mmap
import socket
import struct
from contextlib import suppress
from pathlib import Path

__all__ = ["ADDRESS", "CALL", "MEMORY", "SOCKET", "VALUE", "Buffer", "Registers", "open_devices"]

SOCKET, MEMORY = "chip", "memory"
"""Files of a chip in its folder."""

ADDRESS = 0x1_3000_0000
"""That of the memory."""

CALL, VALUE = struct.Struct("<cII"), struct.Struct("<I")


class Wire:
    """A connection with a chip in another thread or process."""

    def __init__(self, folder: Path) -> None:
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.connect(str(folder / SOCKET))

    def call(self, op: bytes, a: int = 0, b: int = 0) -> int:
        self.socket.send(CALL.pack(op, a, b))
        return VALUE.unpack(self.socket.recv(VALUE.size))[0]

    def close(self) -> None:
        self.socket.close()


class Registers:
    """Registers of the DMA, and a socket that can be read after an interrupt."""

    def __init__(self, wire: Wire, interrupts: socket.socket) -> None:
        self.wire, self.interrupts = wire, interrupts
        interrupts.setblocking(False)

    def fileno(self) -> int:
        return self.interrupts.fileno()

    def read(self, offset: int) -> int:
        return self.wire.call(b"r", offset)

    def write(self, offset: int, value: int) -> None:
        self.wire.call(b"w", offset, value)

    def take_interrupt(self) -> None:
        with suppress(BlockingIOError):
            self.interrupts.recv(VALUE.size)

    def enable_interrupt(self) -> None:
        self.wire.call(b"e")

    def tree_value(self, name: str) -> int | None:
        assert name == "xlnx,sg-length-width"
        return self.wire.call(b"p") or None

    def close(self) -> None:
        self.wire.close()
        self.interrupts.close()


class Buffer:
    """Memory that the DMA has, too, behind caches that are not coherent: `data` is in them."""

    name = "udmabuf0"

    def __init__(self, wire: Wire, data: memoryview, address: int = ADDRESS) -> None:
        self.wire, self.data, self.address, self.size = wire, data, address, len(data)

    def to_device(self, offset: int, size: int, *, is_written: bool) -> None:
        self.wire.call(b"D" if is_written else b"d", offset, size)

    def to_processor(self, offset: int, size: int) -> None:
        self.wire.call(b"c", offset, size)

    def close(self) -> None:
        self.wire.close()


def open_devices(folder: Path) -> tuple[Registers, Buffer]:
    """Return registers and buffer of the chip in a folder."""
    interrupts = Wire(folder)
    interrupts.call(b"i")
    with (folder / MEMORY).open("r+b") as file:
        data = memoryview(mmap.mmap(file.fileno(), 0))
    return Registers(Wire(folder), interrupts.socket), Buffer(Wire(folder), data)
