"""Simulators of exported text, behind one small interface.

A simulator replays a trace (:mod:`firm_hdl.verify.simulators.trace`). It exports the devices as
text, drives the rows of inputs, and returns the rows of outputs that it saw. To add a simulator,
write a class with the members of `TextSimulator`, and name it in `SIMULATORS`.
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
        The name of the simulator in messages.
    version : str
        What the simulator says of its version.
    """

    title: str

    @property
    def version(self) -> str: ...

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        """Run a trace; return rows of outputs as they are in `Trace.expected`.

        A bit that is undefined in the simulator is a letter, such as ``X``.

        Parameters
        ----------
        tops : callable
            Returns the tops of the devices to export, in order.
        folder : Path
            An empty folder for the files of the simulator.

        Raises
        ------
        ToolError
        """


SIMULATORS: dict[str, Callable[[], TextSimulator]] = {
    "ghdl": Ghdl,
    "iverilog": Icarus,
    "verilator": Verilator,
}
"""Simulators by the names that ``firm-hdl verify --simulator`` takes."""


def simulator(name: str) -> TextSimulator | None:
    """Return a simulator by its name; `None` for ``python``, which is always used.

    Raises
    ------
    ProgramMissingError
    """
    return None if name == "python" else SIMULATORS[name]()
