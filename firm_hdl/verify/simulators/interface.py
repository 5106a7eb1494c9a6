"""What a simulator of exported text has to do."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from firm_hdl.export.top import Top
from firm_hdl.verify.simulators.trace import Trace

__all__ = ["TextSimulator"]


class TextSimulator(Protocol):
    """A simulator of exported text.

    Attributes
    ----------
    title : str
        What it is called in reports.
    """

    title: str

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        """Run a trace; return rows of outputs as they are in `Trace.expected`.

        A bit that is undefined in the simulator is any letter, such as ``X``.

        Parameters
        ----------
        tops : callable
            Gives the devices, in order, to be exported.
        folder : Path
            An empty one, for what the simulator needs and leaves.

        Raises
        ------
        ToolError
        """
