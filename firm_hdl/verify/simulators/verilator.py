"""Verilator, on exported Verilog: compiled to C++, and quick to run.

Verilator knows 0 and 1 only, so there are two copies of the devices. A value that the text does not
define is 0 in one copy and 1 in the other. An example is a register without an initial value. A bit
of an output that differs between the two copies is reported as ``X``.
"""

from __future__ import annotations

import functools
import os
import re
import shlex
import shutil
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from firm_hdl.export.top import Top
from firm_hdl.jobs.processes import ToolError, made_by, run_tool
from firm_hdl.jobs.programs import ProgramMissingError, find_program
from firm_hdl.verify.simulators.benches import RESULTS, written
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.verify.simulators.verilog import modules_of, write_inputs

__all__ = ["Verilator"]

PACKAGE = "verilator g++"
COMPILERS = ("g++", "c++", "clang++")
# The program runs for less than a second, so optimization would take longer than it saves.
COMPILE = ("-O0", "-w", "-std=gnu++17")
MODELS = "model"
PARTS = "Vreplay_classes.mk"
HERE = Path(__file__).parent
VERILATE = (
    # Warnings are checked elsewhere, with `waivers.vlt`. Invalid Verilog fails all the same.
    *("--cc", "-Wno-lint", "-Wno-style", "-Wno-fatal"),
    *("--x-initial", "unique", "--x-assign", "unique"),
    *("--prefix", "Vreplay", "--top-module", "replay", "--Mdir", MODELS),
)


class Verilator:
    """Verilator, on the Verilog that ``firm-hdl build`` writes.

    Raises
    ------
    ProgramMissingError
    """

    title = "Verilator"

    def __init__(self) -> None:
        self.path = find_program(self.title, "VERILATOR", ["verilator"], PACKAGE)
        self.compiler = _find_compiler()

    def replay(self, trace: Trace, tops: Callable[[], list[Top]], folder: Path) -> list[str]:
        files = write_inputs(trace, tops(), folder)
        text = written("replay_verilator.v", trace, modules=modules_of(trace))
        (folder / "replay.v").write_text(text, encoding="utf-8")
        run_tool([self.path, *VERILATE, "replay.v", *files], folder)
        models = folder / MODELS
        made_by(self.title, models / PARTS)
        # Compile all sources as one file, because the compiler mostly reads Verilator's headers.
        sources = sorted(path.name for path in models.glob("*.cpp"))
        text = written("replay_main.cc", trace, sources=sources)
        (models / "main.cc").write_text(text, encoding="utf-8")
        runtime = _runtime(self.path, self.compiler, _runtime_parts(models))
        command = [*self.compiler, *COMPILE, *runtime.includes, f"{MODELS}/main.cc"]
        run_tool([*command, *runtime.objects, "-pthread", "-o", "replay"], folder)
        run_tool([str(made_by(self.compiler[0], folder / "replay"))], folder)
        return made_by("the simulation", folder / RESULTS).read_text().splitlines()


def _find_compiler() -> tuple[str, ...]:
    """Return the command of a C++ compiler: the environment's ``CXX``, with its options."""
    given = shlex.split(os.environ.get("CXX", ""))
    for name in given[:1] or COMPILERS:
        if path := shutil.which(name):
            return (path, *given[1:])
    if given:
        raise ProgramMissingError(
            f"CXX is '{given[0]}' in the environment, but there is no such command"
        )
    raise ProgramMissingError(
        "Verilator needs a C++ compiler, and none is installed (Debian, Ubuntu: apt install g++)"
    )


class _Runtime:
    """Verilator's runtime, which every program is linked with; compiled once in a process.

    Attributes
    ----------
    includes : list of str
        Compiler options with the folders of the headers.
    objects : list of str
    """

    def __init__(self, verilator: str, compiler: Sequence[str], parts: Sequence[str]):
        root = run_tool([verilator, "--getenv", "VERILATOR_ROOT"], HERE).strip()
        if not root:
            raise ToolError("Verilator did not say where its runtime is")
        library = Path(root, "include")
        self.includes = [f"-I{library}", f"-I{HERE}"]
        # Removed with this object, at the end of the process.
        self._folder = tempfile.TemporaryDirectory(prefix="firm-hdl-")
        folder = Path(self._folder.name)
        self.objects = []
        for source in [HERE / "replay.cpp", *(library / f"{part}.cpp" for part in parts)]:
            self.objects.append(str(folder / f"{source.stem}.o"))
            command = [*compiler, *COMPILE, *self.includes, "-c", str(source)]
            run_tool([*command, "-o", self.objects[-1]], folder)


@functools.cache
def _runtime(verilator: str, compiler: tuple[str, ...], parts: tuple[str, ...]) -> _Runtime:
    return _Runtime(verilator, compiler, parts)


def _runtime_parts(models: Path) -> tuple[str, ...]:
    """Return the sources that Verilator's makefile names for its runtime; versions differ."""
    text = (models / PARTS).read_text(encoding="utf-8")
    found = re.search(r"^VM_GLOBAL_FAST \+= ((?:\\\n|[^\n])*)", text, re.MULTILINE)
    parts = found[1].replace("\\", " ").split() if found else []
    if not parts:
        raise ToolError("Verilator did not say which parts of its runtime are to be compiled")
    return tuple(parts)
