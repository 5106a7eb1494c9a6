"""Compile the circuits of a type into a program: Verilator's models and the harness around them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from firm_hdl.jobs.processes import ToolError, made_by, run_tool
from firm_hdl.jobs.programs import find_compiler, find_verilator, verilator_sources
from firm_hdl.verify.simulators.programs import runtime_of
from lab.fuzz.circuits import Circuit, templates
from lab.fuzz.table import Table

__all__ = ["Program", "Tools", "build", "find_tools"]

_HARNESS = Path(__file__).parent / "harness"
# The harness is compiled once and runs for long; a model runs for seconds only.
_OPTIONS = ("-w", "-std=gnu++17")
_HARNESS_OPTIONS = ("-O2", *_OPTIONS)
_MODEL_OPTIONS = ("-O1", "-fno-strict-aliasing", *_OPTIONS)
_VERILATE = ("--cc", "-Wno-lint", "-Wno-style", "-Wno-fatal")
_PROGRAM = "fuzz"
_TABLE = "table.txt"
_MOST_SECONDS = 24 * 3600.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Tools:
    """The commands of Verilator and of the compiler."""

    verilator: tuple[str, ...]
    compiler: tuple[str, ...]


def find_tools() -> Tools:
    """Find Verilator and a C++ compiler.

    Raises
    ------
    ProgramMissingError
    """
    return Tools(verilator=find_verilator("The fuzzer"), compiler=find_compiler("Verilator"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Program:
    """A compiled program, in its folder."""

    folder: Path

    def run(
        self, circuits: Sequence[str], *, seed: int, first: int, packets: int
    ) -> list[dict[str, Any]]:
        """Send packets through circuits; return what the program says of each.

        Parameters
        ----------
        first : int
            Number of the first packet. Packets come in episodes; whole ones are run.

        Raises
        ------
        ToolError
            If the program fails, or does not say something of each circuit.
        """
        numbers = map(str, (seed, first, packets))
        command = [str(self.folder / _PROGRAM), _TABLE, *numbers, *circuits]
        output = run_tool(command, self.folder, timeout=_MOST_SECONDS)
        try:
            said = [json.loads(line) for line in output.splitlines()]
        except json.JSONDecodeError:
            raise ToolError(f"the program said: {output[-400:]}") from None
        if [each.get("circuit") for each in said] != list(circuits):
            raise ToolError("the program did not say something of each circuit")
        return said


def build(circuits: Sequence[Circuit], table: Table, folder: Path, tools: Tools) -> Program:
    """Compile circuits of a type, which have the same table, in a folder.

    Raises
    ------
    ToolError
    """
    (folder / _TABLE).write_text(table.text(), encoding="utf-8")
    sources: list[str] = []
    runtime_sources: dict[Path, None] = {}
    for circuit in circuits:
        for name, text in circuit.files.items():
            (folder / name).write_text(text, encoding="utf-8")
        model = folder / circuit.prefix
        names = ["--prefix", circuit.prefix, "--top-module", circuit.module, "--Mdir", model.name]
        run_tool([*tools.verilator, *_VERILATE, *names, *circuit.files], folder)
        makefile = made_by("Verilator", model / f"{circuit.prefix}_classes.mk")
        text = makefile.read_text(encoding="utf-8")
        runtime_sources |= dict.fromkeys(verilator_sources(tools.verilator, text))
        sources += sorted(str(path.relative_to(folder)) for path in model.glob("*.cpp"))
    main = templates.get_template("model.cc.j2").render(
        type=" ".join(dict.fromkeys(circuit.name for circuit in circuits)),
        bus_bytes=table.bus_bytes,
        sources=sources,
        circuits=circuits,
    )
    (folder / "model.cc").write_text(main, encoding="utf-8")
    own = sorted(_HARNESS.glob("*.cpp"))
    runtime = runtime_of(tools.compiler, _HARNESS_OPTIONS, (*runtime_sources, *own))
    command = [*tools.compiler, *_MODEL_OPTIONS, *runtime.includes, "model.cc", *runtime.objects]
    run_tool([*command, "-pthread", "-o", _PROGRAM], folder)
    made_by(tools.compiler[0], folder / _PROGRAM)
    return Program(folder=folder)
