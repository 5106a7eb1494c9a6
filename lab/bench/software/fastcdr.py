"""Time Fast CDR, in a program that is compiled for a message type."""

from __future__ import annotations

import struct
import tempfile
from functools import cache
from pathlib import Path

from firm_hdl.bench.tools import BenchError
from firm_hdl.jobs import ProgramMissingError, ToolError, run_tool
from firm_hdl.jobs.programs import find_compiler
from lab.bench.software.cpp import cpp_types
from lab.bench.software.sample import NoFigureError, Sample, Timed
from lab.bench.software.timing import RUN_SECONDS, RUNS

__all__ = ["fastcdr_versions", "time_fastcdr"]

OPTIONS = ("-std=c++17", "-O2")
"""Options of the compiler. ROS's packages are built with ``-O2``."""

_SOURCE = Path(__file__).with_name("fastcdr_timing.cpp")
_HOW = "(Debian, Ubuntu: apt install g++ libfastcdr-dev)"


@cache
def _compiler() -> tuple[str, ...]:
    return find_compiler("Fast CDR")


@cache
def fastcdr_versions() -> dict[str, str]:
    """Return the versions of Fast CDR and of the compiler.

    Raises
    ------
    ProgramMissingError
    """
    question = "fastcdr FASTCDR_VERSION_STR\ncompiler __VERSION__\n"
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "a.cpp").write_text(question, encoding="utf-8")
        command = [*_compiler(), "-E", "-P", "-include", "fastcdr/Cdr.h", "a.cpp"]
        try:
            lines = run_tool(command, Path(folder)).splitlines()
        except ToolError:
            raise ProgramMissingError(f"Fast CDR's headers are not installed {_HOW}") from None
    fastcdr, compiler = (line.split(" ", 1)[1].strip('"') for line in lines[-2:])
    return {"Fast CDR": fastcdr, f"g++ {' '.join(OPTIONS)}": compiler}


def time_fastcdr(sample: Sample, runs: int = RUNS, run_seconds: float = RUN_SECONDS) -> Timed:
    """Time Fast CDR.

    Raises
    ------
    ProgramMissingError
    NoFigureError
        If Fast CDR does not have the wire format, or `cpp_types` does not support the type.
    BenchError
        If the program cannot be compiled, or does not write what it has read.
    """
    if sample.wire != "cdr":
        raise NoFigureError("Fast CDR has the wire format CDR only")
    types = cpp_types(sample.message)
    fastcdr_versions()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "message.h").write_text(types, encoding="utf-8")
        (folder / "packets").write_bytes(
            b"".join(struct.pack("<I", len(packet)) + packet for packet in sample.packets)
        )
        compile_ = [*_compiler(), *OPTIONS, "-I.", "-o", "program", str(_SOURCE), "-lfastcdr"]
        try:
            run_tool(compile_, folder)
            program = [str(folder / "program"), "packets", str(runs), str(run_seconds)]
            lines = run_tool(program, folder).splitlines()
        except ToolError as error:
            raise BenchError(f"Fast CDR, {sample.message.name}: {error}") from None
    return Timed(deserialize=float(lines[-2]), serialize=float(lines[-1]))
