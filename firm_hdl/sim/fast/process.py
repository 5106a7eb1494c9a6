"""A compiled design as a process of its own."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import weakref
from contextlib import suppress
from pathlib import Path

from firm_hdl.jobs.processes import start_program
from firm_hdl.sim.fast.channel import Channel
from firm_hdl.sim.fast.compilers import BuildError

__all__ = ["VerilatorEngine"]

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
