"""Find external programs, such as GHDL."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence

__all__ = ["ProgramMissingError", "find_ghdl", "find_program"]

GHDL_NAMES = ("ghdl", "ghdl-mcode", "ghdl-llvm", "ghdl-gcc")


class ProgramMissingError(ValueError):
    """A program is not installed; the message says how to install it."""


def find_program(title: str, variable: str, names: Sequence[str], package: str) -> str:
    """Return the path of a program: the environment's `variable`, or the first that is installed.

    Parameters
    ----------
    title : str
        Name of the program in messages.
    variable : str
        Environment variable with the name or the path of a command.
    names : sequence of str
        Commands to search for if the variable is not set.
    package : str
        Package of Debian and Ubuntu that has the program.

    Raises
    ------
    ProgramMissingError
    """
    given = os.environ.get(variable)
    for name in [given] if given else names:
        if path := shutil.which(name):
            return path
    if given:
        raise ProgramMissingError(
            f"{title} is '{given}' in the environment, but there is no such command"
        )
    raise ProgramMissingError(f"{title} is not installed (Debian, Ubuntu: apt install {package})")


def find_ghdl() -> str:
    """Return the command of GHDL: the environment's ``GHDL``, or the first that is installed.

    Raises
    ------
    ProgramMissingError
    """
    return find_program("GHDL", "GHDL", GHDL_NAMES, "ghdl-mcode")
