"""Simulators of exported text, behind one small interface.

A simulator replays a trace (:mod:`firm_hdl.verify.simulators.trace`): it makes the text of the
devices, drives the rows of inputs, and gives the rows of outputs that it saw. To add one is to
write a class with the members of `TextSimulator` and to name it in `SIMULATORS`.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from firm_hdl.export.top import Top
from firm_hdl.verify.simulators.ghdl import Ghdl
from firm_hdl.verify.simulators.icarus import Icarus
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.verify.simulators.verilator import Verilator

__all__ = [
    "SIMULATORS",
    "Ghdl",
    "Icarus",
    "TextSimulator",
    "Verilator",
    "simulator",
]

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


SIMULATORS: dict[str, Callable[[], TextSimulator]] = {
    "ghdl": Ghdl,
    "iverilog": Icarus,
    "verilator": Verilator,
}
"""By the name that ``firm-hdl verify --simulator`` takes."""


def simulator(name: str) -> TextSimulator | None:
    """Return a simulator by its name; `None` for ``python``, which is there anyway.

    Raises
    ------
    ProgramMissingError
    """
    return None if name == "python" else SIMULATORS[name]()
