"""Verilator, on exported Verilog: compiled to C++, and quick to run.

Verilator knows 0 and 1 only, so there are two copies of the devices. A value that the text does not
define is 0 in one copy and 1 in the other. An example is a register without an initial value. A bit
of an output that differs between the two copies is reported as ``X``.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from firm_hdl.export.top import Top
from firm_hdl.jobs.processes import made_by, run_tool
from firm_hdl.jobs.programs import find_compiler, version_of
from firm_hdl.verify.simulators.benches import RESULTS, written
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.verify.simulators.verilated import (
    find_verilator,
    runtime_of,
    runtime_parts,
)
from firm_hdl.verify.simulators.verilog import modules_of, write_inputs

__all__ = ["Verilator"]

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
        self.path = find_verilator()
        self.compiler = find_compiler("Verilator")

    @property
    def version(self) -> str:
        return version_of(self.path)

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
        runtime = runtime_of(
            self.path, self.compiler, COMPILE, (HERE / "replay.cpp",), runtime_parts(models / PARTS)
        )
        command = [*self.compiler, *COMPILE, *runtime.includes, f"{MODELS}/main.cc"]
        run_tool([*command, *runtime.objects, "-pthread", "-o", "replay"], folder)
        run_tool([str(made_by(self.compiler[0], folder / "replay"))], folder)
        return made_by("the simulation", folder / RESULTS).read_text().splitlines()
