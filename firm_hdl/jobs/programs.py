"""Where programs are that are run, such as GHDL."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence

__all__ = ["ProgramMissingError", "find_ghdl", "find_program"]

GHDL_NAMES = ("ghdl", "ghdl-mcode", "ghdl-llvm", "ghdl-gcc")


class ProgramMissingError(ValueError):
    """A program is not installed; the text says how to get it."""


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
    ProgramMissingError
    """
    given = os.environ.get(variable)
    for name in [given] if given else names:
        if path := shutil.which(name):
            return path
    if given:
        raise ProgramMissingError(f"{title} is '{given}' in the environment, and no such command")
    raise ProgramMissingError(f"{title} is not installed (Debian, Ubuntu: apt install {package})")


def find_ghdl() -> str:
    """Return the command of GHDL: the environment's ``GHDL``, or the first that is installed.

    Raises
    ------
    ProgramMissingError
    """
    return find_program("GHDL", "GHDL", GHDL_NAMES, "ghdl-mcode")
