"""What a simulator of exported text has to do, and where its programs are."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol

from firm_hdl.export.top import Top
from firm_hdl.verify.trace import Trace

__all__ = ["SimulatorMissingError", "TextSimulator", "find_program"]


class SimulatorMissingError(ValueError):
    """A simulator is not installed; the text says how to get it."""


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


def find_program(title: str, variable: str, names: Sequence[str], package: str) -> str:
    """Return the path of a program: the environment's `variable`, or the first that is installed.

    Parameters
    ----------
    title : str
        What it is called in messages.
    variable : str
        A variable that names a command, or has its path.
    names : sequence of str
        Commands to look for without the variable.
    package : str
        What to install on Debian and Ubuntu.

    Raises
    ------
    SimulatorMissingError
    """
    given = os.environ.get(variable)
    for name in [given] if given else names:
        if path := shutil.which(name):
            return path
    if given:
        raise SimulatorMissingError(f"{title} is '{given}' in the environment, and no such command")
    raise SimulatorMissingError(f"{title} is not installed (Debian, Ubuntu: apt install {package})")
