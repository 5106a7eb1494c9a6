"""Choose and start the engine of a simulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Literal, TypeAlias

from firm_hdl.jobs import ProgramMissingError
from firm_hdl.jobs.programs import find_compiler, find_verilator
from firm_hdl.sim.fast.amaranth_engine import AmaranthEngine
from firm_hdl.sim.fast.compilers import BuildError, Report, program_of
from firm_hdl.sim.fast.process import VerilatorEngine
from firm_hdl.sim.fast.top import Top
from firm_hdl.sim.fast.verilated import verilated_source

__all__ = ["EngineName", "check_engine", "expected_engine", "start"]

EngineName: TypeAlias = Literal["auto", "verilator", "amaranth"]


def check_engine(engine: str) -> None:
    """Raise a ValueError unless there is an engine of that name."""
    if engine not in ("auto", "verilator", "amaranth"):
        raise ValueError(f"Engine must be 'auto', 'verilator' or 'amaranth', not {engine!r}")


def expected_engine(engine: EngineName) -> tuple[EngineName, str]:
    """Return the engine that :func:`start` takes, and why if ``"auto"`` is not the compiled one.

    Raises
    ------
    ProgramMissingError
        If the engine is ``"verilator"`` and there is no Verilator, or no compiler.
    """
    if engine == "amaranth":
        return engine, ""
    try:
        find_verilator("A fast simulation")
        find_compiler("A fast simulation", with_zig=True)
    except ProgramMissingError as error:
        if engine == "verilator":
            raise
        return "amaranth", str(error)
    return "verilator", ""


def start(
    top: Top,
    engine: EngineName,
    *,
    options: Sequence[str],
    cache: Path | None,
    report: Report | None = None,
    modules: Mapping[str, str] | None = None,
    wave: Path | None = None,
) -> VerilatorEngine | AmaranthEngine:
    """Start an engine. Parameters and errors are those of :class:`.FastSimulation`."""
    found, why = expected_engine(engine)
    if found == "amaranth":
        reason = f": {why}" if why else ""
        if modules:
            raise BuildError(f"Amaranth's simulator takes no modules of Verilog{reason}")
        if wave:
            raise BuildError(f"Amaranth's simulator writes no waveform while it is live{reason}")
        return AmaranthEngine(top)
    source = partial(verilated_source, top, modules, traced=wave is not None)
    program = program_of(source, options=options, cache=cache, report=report)
    return VerilatorEngine(program, wave)
