"""The engines of a simulation: a compiled design in a process of its own, or Amaranth's."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import weakref
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Literal, TypeAlias

from firm_hdl.jobs import ProgramMissingError
from firm_hdl.jobs.processes import start_program
from firm_hdl.jobs.programs import find_compiler, find_verilator
from firm_hdl.sim.fast.amaranth_engine import AmaranthEngine
from firm_hdl.sim.fast.channel import Channel
from firm_hdl.sim.fast.compilers import BuildError, Report, program_of, verilated_source
from firm_hdl.sim.fast.top import Top

__all__ = ["EngineName", "VerilatorEngine", "check_engine", "expected_engine", "start"]

_END_SECONDS = 2.0


class VerilatorEngine(Channel):
    """A process that simulates a design that Verilator has translated.

    The process ends when its socket is closed, or when the process that started it has died, half a
    second later at most. It is not interrupted by Ctrl-C, so that its parent may finish first.

    Parameters
    ----------
    program : Path
        From :func:`.program_of`.
    wave : Path or None
        The file of the waveform, if the program writes one.

    Attributes
    ----------
    process : subprocess.Popen

    Raises
    ------
    BuildError
        If the program cannot be started.
    """

    engine = "verilator"

    def __init__(self, program: Path, wave: Path | None = None):
        self._program, self._wave = program, wave
        own, other = socket.socketpair()
        command = [str(program), str(os.getpid()), *([str(wave.absolute())] if wave else [])]
        try:
            # Texts of `Print` and `Assert` go where those of this process go.
            self.process = start_program(command, stdin=other.fileno(), stdout=None, stderr=None)
        except OSError as error:
            own.close()
            raise BuildError(f"The program of a design cannot be started: {error}") from None
        finally:
            other.close()
        super().__init__(own)
        # A simulation that nobody closed leaves no zombie.
        self._finalizer = weakref.finalize(self, _end, own, self.process)

    def again(self) -> VerilatorEngine:
        return VerilatorEngine(self._program, self._wave)

    def close(self) -> None:
        self._finalizer()

    def _reason(self) -> str:
        status = self.process.returncode
        if status is None or status >= 0:
            return f"exit status {status}"
        try:
            return f"killed by {signal.Signals(-status).name}"
        except ValueError:
            return f"killed by signal {-status}"


def _end(own: socket.socket, process: subprocess.Popen[bytes]) -> None:
    own.close()
    with suppress(subprocess.TimeoutExpired):
        process.wait(_END_SECONDS)
    process.kill()
    process.wait()


EngineName: TypeAlias = Literal["auto", "verilator", "amaranth"]


def check_engine(engine: str) -> None:
    """Raise a ValueError unless there is an engine of that name."""
    if engine not in ("auto", "verilator", "amaranth"):
        raise ValueError(f"Engine must be 'auto', 'verilator' or 'amaranth', not {engine!r}")


def expected_engine(engine: EngineName) -> tuple[EngineName, str]:
    """Return the engine that :func:`start` takes, and why if ``"auto"`` is not the compiled one.

    Raises `ProgramMissingError` if the engine is ``"verilator"`` and there is no Verilator, or no
    compiler.
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
    traced = "" if wave is None else "fst" if wave.suffix == ".fst" else "vcd"
    source = partial(verilated_source, top, modules, traced=traced)
    program = program_of(source, options=options, cache=cache, report=report)
    return VerilatorEngine(program, wave)
