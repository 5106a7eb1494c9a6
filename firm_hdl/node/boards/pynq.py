"""A node in an overlay of PYNQ, with the driver of `zynq://`.

The memory is PYNQ's, so no module of the kernel has to be built. Interrupts are not used, because
which of them PYNQ hands to programs differs between its images; a thread reads the status instead.
Importing this module needs PYNQ.
"""

from __future__ import annotations

import atexit
import os
import threading
import time
from contextlib import suppress
from typing import Any
from weakref import WeakSet

from pynq import MMIO, Clocks, Overlay, allocate

from firm_hdl.errors import UserError
from firm_hdl.node.boards.board import BoardError
from firm_hdl.node.boards.zynq import ZynqBoard, reset
from firm_hdl.node.description import Description

__all__ = ["NodeOverlay"]

_POLL_SECONDS = 0.001
_STATUS = (0x04, 0x34)
"""MM2S_DMASR and S2MM_DMASR (PG021, 7.1)."""
_INTERRUPTS = 1 << 12 | 1 << 14
"""IOC_Irq and Err_Irq in both."""
_BUFFER_BYTES = 1 << 19
"""For frames of less than 64 kB: three, or a scatter-gather engine's rings of three each."""
_CLOCK_ERROR = 1e-3
"""Of a clock that a description rounds, such as 66.7 MHz."""


class NodeOverlay(Overlay):
    """The overlay of a node with the link `axi_dma`; its parameters are those of `pynq.Overlay`.

    A download, and the end of the program, stop the DMA of each board that is still open.

    Example
    -------
    ::

        board = NodeOverlay("twist.bit").board(read_description("node.yaml"))
    """

    def download(self, *arguments: Any, **options: Any) -> None:
        """Load the overlay."""
        _stop_all()
        super().download(*arguments, **options)
        _loaded.add(self)

    def board(self, description: Description, dma: str = "dma") -> ZynqBoard:
        """Set the clock of the node, and return the node as a board.

        * `description`: that of the node in the overlay.
        * `dma`: the name of the AXI DMA in the block design.

        Raises `UserError` if no divisors make the clock of the node.
        """
        about = self.ip_dict[dma]
        _set_clock(description.clock_hz / 1e6)

        def devices(*_: str) -> tuple[_Registers, _Buffer]:
            if self not in _loaded:
                raise BoardError("another overlay was loaded, or the program ends")
            mmio = MMIO(about["phys_addr"], about["addr_range"])
            return _Registers(mmio, about.get("parameters", {})), _Buffer()

        return ZynqBoard("pynq", dma, "buffer", description.link.buffer_bytes, devices)


_loaded = WeakSet[NodeOverlay]()
_open = WeakSet["_Registers"]()


@atexit.register
def _stop_all() -> None:
    """Stop what is open: a read never returns while the FPGA is loaded, and Linux with it.

    No DMA goes on, as the memory of a program that ends is given to others.
    """
    _loaded.clear()
    while _open:
        _open.pop().stop()


def _set_clock(mhz: float) -> None:
    """Set FCLK0 or pl_clk0.

    A download has set its divisors only, as the `.hwh` has them. They are for the PLL that Vivado
    has planned, and the PLL runs as the boot loader has set it.
    """
    Clocks.fclk0_mhz = mhz
    if abs((real := Clocks.fclk0_mhz) / mhz - 1) > _CLOCK_ERROR:
        raise UserError(
            f"PYNQ's nearest clock to {mhz:g} MHz is {real:g} MHz; with this number as clock_mhz "
            "of the node, make the overlay anew"
        )


class _Registers:
    """The registers of a DMA. The file can be read when a bit of an interrupt was seen."""

    def __init__(self, mmio: Any, parameters: dict[str, str]) -> None:
        self._mmio, self._parameters = mmio, parameters
        self._lock, self._is_stopped = threading.Lock(), False
        self._reader, self._writer = os.pipe()
        os.set_blocking(self._reader, False)
        self._is_asked, self._is_open = threading.Event(), True
        self._thread = threading.Thread(target=self._poll, daemon=True)
        self._thread.start()
        _open.add(self)

    def _poll(self) -> None:
        while self._is_asked.wait() and self._is_open:
            # A board that was stopped learns it from its next read.
            if self._is_stopped or any(self._mmio_read(at) & _INTERRUPTS for at in _STATUS):
                self._is_asked.clear()
                os.write(self._writer, b"\0")
            else:
                time.sleep(_POLL_SECONDS)

    def _mmio_read(self, offset: int) -> int:
        """Read a register; 0 after the stop."""
        with self._lock:
            return 0 if self._is_stopped else int(self._mmio.read(offset))

    def stop(self) -> None:
        """Reset the DMA, and touch it no more."""
        reset(self)
        with self._lock:
            self._is_stopped = True

    def fileno(self) -> int:
        return self._reader

    def read(self, offset: int) -> int:
        value = self._mmio_read(offset)
        if self._is_stopped:
            raise BoardError("its DMA was stopped, as another overlay is loaded")
        return value

    def write(self, offset: int, value: int) -> None:
        with self._lock:
            if not self._is_stopped:
                self._mmio.write(offset, value)

    def take_interrupt(self) -> None:
        with suppress(BlockingIOError):
            os.read(self._reader, 4096)

    def enable_interrupt(self) -> None:
        self._is_asked.set()

    def tree_value(self, name: str) -> int | None:
        """Return a parameter of the DMA, which the file beside the bitstream has (`.hwh`)."""
        text = self._parameters.get(name.replace("xlnx,", "c_").replace("-", "_"))
        return None if text is None else int(text)

    def close(self) -> None:
        _open.discard(self)
        self._is_open = False
        self._is_asked.set()
        self._thread.join()
        os.close(self._reader)
        os.close(self._writer)


class _Buffer:
    """Memory of PYNQ, as a :class:`.DmaBuffer`; it is freed with the last reference to it."""

    name = "buffer"
    size = _BUFFER_BYTES

    def __init__(self) -> None:
        self._array = allocate((self.size,), "u1")
        self.address = int(self._array.device_address)
        self.data = memoryview(self._array)

    def to_device(self, offset: int, size: int, *, is_written: bool) -> None:
        # What the DMA overwrites is written back, too: no line of the cache may follow later.
        self._array[offset : offset + size].flush()

    def to_processor(self, offset: int, size: int) -> None:
        self._array[offset : offset + size].invalidate()

    def close(self) -> None:
        self.data.release()
        del self._array
