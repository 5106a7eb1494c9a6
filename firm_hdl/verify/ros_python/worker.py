"""Starts `worker_script` in a process, and sends requests to it. If it dies, it is restarted."""

from __future__ import annotations

import json
import os
import subprocess
import time
import weakref
from contextlib import suppress
from pathlib import Path
from typing import Any

from firm_hdl.jobs.processes import answered, hang_up, start_program

__all__ = ["DIED", "ROS_PYTHON", "Worker"]

ROS_PYTHON = os.environ.get("FIRM_HDL_ROS_PYTHON", "/usr/bin/python3")
"""The Python that ROS's modules are installed for. In Debian, this is the system's Python."""

DIED = "the process that was asked died"

_SCRIPT = Path(__file__).with_name("worker_script.py")


class Worker:
    """A process with the readers of one family, for a folder of definitions.

    * `family`: ``FAMILY`` in the name of the module ``worker_FAMILY``, which has the readers.
    * `folder`: the folder of the definitions.
    * `modules`: the folder of that module.
    * `python`: the Python that runs the process.
    """

    def __init__(
        self, family: str, folder: str, *, modules: Path, python: str = ROS_PYTHON
    ) -> None:
        self._command = [python, str(_SCRIPT), family, folder, str(modules)]
        self._process: subprocess.Popen[bytes] | None = None
        self._end: weakref.finalize[[subprocess.Popen[bytes], float], Worker] | None = None
        self.missing: str | None = None
        self.versions: dict[str, str] = {}
        self._start()

    def ask(self, request: dict[str, Any]) -> dict[str, Any]:
        """Send a request; return the answer, which is ``failed`` if the process dies of it."""
        if self._process is None:
            self._start()
        # A process that died may not start again.
        answer = None if self._process is None else self._exchange(json.dumps(request))
        if answer is None:
            self.close()
            return {"failed": self.missing or DIED}
        return answer

    @property
    def cpu_seconds(self) -> float:
        """Processor time of the process so far; 0 if the system does not tell."""
        if self._process is None:
            return 0.0
        # The number of the other process's clock, as clock_getcpuclockid(3) has it on Linux.
        with suppress(OSError):
            return time.clock_gettime((~self._process.pid << 3) | 2)
        return 0.0

    def close(self) -> None:
        """End the process. The next request starts another one."""
        self._process, end, self._end = None, self._end, None
        if end is not None:
            end()

    def _start(self) -> None:
        try:
            self._process = start_program(
                self._command,
                stdin=subprocess.PIPE,
                environment=_environment(self._command[0]),
            )
        except OSError as error:
            self.missing = f"{self._command[0]} cannot be run: {error.strerror}"
            return
        # Also ends the process of a worker that nobody closes, at the latest when Python ends.
        self._end = weakref.finalize(self, hang_up, self._process, 10)
        hello = self._exchange(None) or {"missing": "its Python does not start"}
        self.missing = hello.get("missing")
        self.versions = hello.get("versions", {})
        if self.missing is not None:
            self.close()

    def _exchange(self, line: str | None) -> dict[str, Any] | None:
        assert self._process is not None
        with suppress(OSError, ValueError):
            return answered(self._process, line)
        return None


def _environment(python: str) -> dict[str, str]:
    # Most users run ROS's tools in a UTF-8 environment. The hash seed is fixed, because the order
    # of sets decides how rosidl_parser 3.3.1 reads a text that lark can read in two ways.
    found = {"LC_ALL": "C.UTF-8", "PYTHONUTF8": "1", "PYTHONHASHSEED": "0"}
    # A sourced release of ROS must not replace the release that was asked for.
    return found if python == ROS_PYTHON else {**found, "PYTHONPATH": ""}
