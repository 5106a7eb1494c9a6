"""What programs around Verilator's models need: a compiler, and Verilator's runtime as objects."""

from __future__ import annotations

import functools
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path

from firm_hdl.jobs.processes import ToolError, run_tool
from firm_hdl.jobs.programs import find_program

__all__ = ["find_verilator", "runtime_of", "runtime_parts"]

PACKAGE = "verilator g++"


def find_verilator() -> str:
    """Return the command of Verilator: the environment's ``VERILATOR``, or that on the PATH.

    Raises
    ------
    ProgramMissingError
    """
    return find_program("Verilator", "VERILATOR", ["verilator"], PACKAGE)


class Runtime:
    """Verilator's runtime and sources of our own, as objects that programs are linked with.

    Parameters
    ----------
    options : sequence of str
        Options of the compiler.
    own : sequence of Path
        Our sources. Their folders are searched for headers.
    parts : sequence of str
        Sources of Verilator, from :func:`runtime_parts`.

    Attributes
    ----------
    includes : list of str
        Compiler options with the folders of the headers.
    objects : list of str
    """

    def __init__(
        self,
        verilator: str,
        compiler: Sequence[str],
        options: Sequence[str],
        own: Sequence[Path],
        parts: Sequence[str],
    ):
        # Removed with this object, at the end of the process.
        self._folder = tempfile.TemporaryDirectory(prefix="firm-hdl-")
        folder = Path(self._folder.name)
        root = run_tool([verilator, "--getenv", "VERILATOR_ROOT"], folder).strip()
        if not root:
            raise ToolError("Verilator did not say where its runtime is")
        library = Path(root, "include")
        folders = dict.fromkeys([library, *(source.parent for source in own)])
        self.includes = [f"-I{each}" for each in folders]
        self.objects = []
        for source in [*own, *(library / f"{part}.cpp" for part in parts)]:
            self.objects.append(str(folder / f"{source.stem}.o"))
            command = [*compiler, *options, *self.includes, "-c", str(source)]
            run_tool([*command, "-o", self.objects[-1]], folder)


@functools.cache
def runtime_of(
    verilator: str,
    compiler: tuple[str, ...],
    options: tuple[str, ...],
    own: tuple[Path, ...],
    parts: tuple[str, ...],
) -> Runtime:
    """Return a runtime, compiled once in a process."""
    return Runtime(verilator, compiler, options, own, parts)


def runtime_parts(makefile: Path) -> tuple[str, ...]:
    """Return the sources that Verilator's makefile names for its runtime; versions differ."""
    text = makefile.read_text(encoding="utf-8")
    found = re.search(r"^VM_GLOBAL_FAST \+= ((?:\\\n|[^\n])*)", text, re.MULTILINE)
    parts = found[1].replace("\\", " ").split() if found else []
    if not parts:
        raise ToolError("Verilator did not say which parts of its runtime are to be compiled")
    return tuple(parts)
