"""The board `zynq` of a bridge, with a chip that another process simulates."""

from __future__ import annotations

from pathlib import Path

from firm_hdl.node import boards
from firm_hdl.node.boards.zynq import ZynqBoard
from tests.node.boards.remote import open_devices

__all__ = ["use_chip"]


class _ChipBoard(ZynqBoard):
    """The driver, as patient as the board `sim`: a simulation is slower than its messages."""

    has_room = True  # type: ignore[assignment]
    sample_seconds = 0.1
    has_real_time = False
    silent_seconds = end_seconds = 60.0
    repeat_seconds = 5.0


def use_chip(folder: Path | str) -> None:
    """Let each board `zynq` of this process have the devices of a chip."""
    boards.ZynqBoard = lambda *values: _ChipBoard(  # type: ignore[assignment,misc]
        *values, lambda *_: open_devices(Path(folder))
    )
