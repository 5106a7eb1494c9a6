"""Choose and start the engine of a simulation."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal, TypeAlias

from firm_hdl.jobs import ProgramMissingError
from firm_hdl.jobs.programs import find_compiler
from firm_hdl.sim.fast.amaranth_engine import AmaranthEngine
from firm_hdl.sim.fast.compilers import program_of
from firm_hdl.sim.fast.cxxrtl import cxxrtl_source
from firm_hdl.sim.fast.process import CxxrtlEngine
from firm_hdl.sim.fast.top import Top

__all__ = ["EngineName", "check_engine", "expected_engine", "start"]

EngineName: TypeAlias = Literal["auto", "cxxrtl", "amaranth"]


def check_engine(engine: str) -> None:
    """Raise a ValueError unless there is an engine of that name."""
    if engine not in ("auto", "cxxrtl", "amaranth"):
        raise ValueError(f"Engine must be 'auto', 'cxxrtl' or 'amaranth', not {engine!r}")


def expected_engine(engine: EngineName) -> tuple[EngineName, str]:
    """Return the engine that :func:`start` takes, and why if ``"auto"`` is not the compiled one.

    Raises
    ------
    ProgramMissingError
        If the engine is ``"cxxrtl"`` and there is no compiler.
    """
    if engine == "amaranth":
        return engine, ""
    try:
        find_compiler("A fast simulation", with_zig=True)
    except ProgramMissingError as error:
        if engine == "cxxrtl":
            raise
        return "amaranth", str(error)
    return "cxxrtl", ""


def start(
    top: Top, engine: EngineName, *, options: Sequence[str], cache: Path | None
) -> CxxrtlEngine | AmaranthEngine:
    """Start an engine. Parameters and errors are those of :class:`.FastSimulation`."""
    if engine != "amaranth":
        try:
            return CxxrtlEngine(program_of(cxxrtl_source(top), options=options, cache=cache))
        except ProgramMissingError:
            if engine == "cxxrtl":
                raise
    return AmaranthEngine(top)
