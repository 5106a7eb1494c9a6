"""Devices of a processor's own chip in user space: registers with an interrupt, and buffers.

Registers are those of UIO (the kernel's "Userspace I/O HOWTO"), buffers those of u-dma-buf.
"""

from __future__ import annotations

import fcntl
import mmap
import os
from contextlib import suppress
from pathlib import Path

from firm_hdl.node.boards.board import BoardError

__all__ = ["DmaBuffer", "Uio"]

_ROOT = Path("/")

_TO_DEVICE, _TO_PROCESSOR = "sync_for_device", "sync_for_cpu"


class Uio:
    """The registers of a device, and its interrupt. Nobody else can open it meanwhile.

    * `name`: ``uio0``, or the name of the device, which is that of its node in the device tree.
    * `root`: folder of ``dev`` and ``sys``.

    Raises `BoardError` if there is no such device, or it cannot be used.
    """

    def __init__(self, name: str, root: Path = _ROOT) -> None:
        self._folder = _uio_folder(name, root / "sys/class/uio")
        path = root / "dev" / self._folder.name
        size = _number(self._folder / "maps/map0/size", 0)
        self._file = _opened(path, os.O_RDWR | os.O_NONBLOCK)
        try:
            self._map = mmap.mmap(self._file, size)
        except (OSError, ValueError) as error:
            os.close(self._file)
            raise BoardError(f"cannot map the registers of '{path}': {_why(error)}") from None
        # An item of a view is read and written at once, as the bus asks for.
        self._registers = memoryview(self._map).cast("I")

    def fileno(self) -> int:
        """Return the file descriptor that can be read when there was an interrupt."""
        return self._file

    def read(self, offset: int) -> int:
        """Return the register at an offset in bytes."""
        return self._registers[offset // 4]

    def write(self, offset: int, value: int) -> None:
        """Write the register at an offset in bytes."""
        self._registers[offset // 4] = value

    def take_interrupt(self) -> None:
        """Forget the interrupts so far. No further one comes until they are enabled again.

        Raises `BoardError` if the device is gone, as its driver or its part of the device tree was
        removed.
        """
        try:
            os.read(self._file, 4)
        except BlockingIOError:
            return
        except OSError as error:
            # What an access to registers that are gone does is not known.
            self._registers = memoryview(bytearray(self._registers.nbytes)).cast("I")
            raise BoardError(f"'{self._folder.name}' is gone: {_why(error)}") from None

    def enable_interrupt(self) -> None:
        """Let interrupts come; one that waits comes at once.

        Raises `BoardError` if the device has none.
        """
        try:
            os.write(self._file, (1).to_bytes(4, "little"))
        except OSError as error:
            raise BoardError(
                f"'{self._folder.name}' has no interrupt that can be enabled: {_why(error)}"
            ) from None

    def tree_value(self, name: str) -> int | None:
        """Return a property of the device in the device tree, one cell; `None` if it has none."""
        try:
            return int.from_bytes((self._folder / "device/of_node" / name).read_bytes(), "big")
        except OSError:
            return None

    def close(self) -> None:
        """Close the device."""
        self._registers.release()
        self._map.close()
        os.close(self._file)


class DmaBuffer:
    """Memory of a fixed address that both a processor and a DMA access. Nobody else can open it.

    The processor has it in its caches, unless the driver says that they are coherent. So a part is
    handed over before the other side accesses it. Parts begin and end at multiples of 64.

    * `name`: such as ``udmabuf0``.
    * `root`: folder of ``dev`` and ``sys``.

    Raises `BoardError` if there is no such buffer, or it cannot be used.
    """

    def __init__(self, name: str, root: Path = _ROOT) -> None:
        self.name = name
        self._folder = root / "sys/class/u-dma-buf" / name
        path = root / "dev" / name
        self.size = _number(self._folder / "size", 10)
        self.address = _number(self._folder / "phys_addr", 0)  # Physical address.
        is_coherent = bool(_number(self._folder / "dma_coherent", 0))
        # With O_SYNC, memory would be uncached, where processors refuse unaligned copies.
        self._file = _opened(path, os.O_RDWR)
        try:
            self._map = mmap.mmap(self._file, self.size)
        except (OSError, ValueError) as error:
            os.close(self._file)
            raise BoardError(f"cannot map '{path}': {_why(error)}") from None
        self.data = memoryview(self._map)
        # They stay open, as each frame takes several orders.
        self._orders: dict[str, int] = {}
        for order in () if is_coherent else (_TO_DEVICE, _TO_PROCESSOR):
            try:
                self._orders[order] = os.open(self._folder / order, os.O_WRONLY)
            except OSError as error:
                self.close()
                raise BoardError(f"cannot open '{self._folder / order}': {_why(error)}") from None

    def to_device(self, offset: int, size: int, *, is_written: bool) -> None:
        """Hand a part over to the DMA, which writes it or reads it."""
        self._sync(_TO_DEVICE, offset, size, 2 if is_written else 1)

    def to_processor(self, offset: int, size: int) -> None:
        """Take a part back that the DMA has written."""
        self._sync(_TO_PROCESSOR, offset, size, 2)

    def _sync(self, order: str, offset: int, size: int, direction: int) -> None:
        if not self._orders:
            return
        # Offset, size, direction and the order itself in one number.
        text = f"0x{offset:08X}{size & 0xFFFF_FFF0 | direction << 2 | 1:08X}"
        try:
            os.pwrite(self._orders[order], text.encode(), 0)
        except OSError as error:
            raise BoardError(f"cannot write '{self._folder / order}': {_why(error)}") from None

    def close(self) -> None:
        """Close the buffer; its memory stays."""
        for file in (self._file, *self._orders.values()):
            os.close(file)
        self.data.release()
        self._map.close()


def _uio_folder(name: str, uios: Path) -> Path:
    """Return the folder in sysfs of a device with that name."""
    if (uios / name).is_dir():
        return uios / name
    known = {}
    for folder in sorted(uios.glob("uio*")):
        with suppress(OSError):
            known[(folder / "name").read_text().strip()] = folder
    if name in known:
        return known[name]
    there = ", ".join(f"{folder.name} ({text})" for text, folder in known.items())
    raise BoardError(f"there is no UIO device '{name}'; there is {there or 'none'}")


def _opened(path: Path, flags: int) -> int:
    try:
        file = os.open(path, flags)
    except OSError as error:
        raise BoardError(f"cannot open '{path}': {_why(error)}") from None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(file)
        raise BoardError(f"'{path}' is used by another program") from None
    return file


def _number(path: Path, base: int) -> int:
    try:
        return int(path.read_text(), base)
    except OSError as error:
        raise BoardError(f"cannot read '{path}': {_why(error)}") from None
    except ValueError:
        raise BoardError(f"'{path}' has no number") from None


def _why(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
