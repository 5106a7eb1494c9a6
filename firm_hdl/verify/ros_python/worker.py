"""The near end of `worker_script`: a process that answers requests, and is replaced if it dies."""

from __future__ import annotations

import json
import os
import subprocess
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from firm_hdl.jobs.processes import hang_up

__all__ = ["DIED", "ROS_PYTHON", "Worker"]

ROS_PYTHON = os.environ.get("FIRM_HDL_ROS_PYTHON", "/usr/bin/python3")
"""The Python that ROS's modules are installed for; Debian's is the system's."""

DIED = "the process that was asked died"

_SCRIPT = Path(__file__).with_name("worker_script.py")


class Worker:
    """Readers of one family, over a folder of definitions.

    Parameters
    ----------
    family : str
        Of the module ``worker_FAMILY``, which has the readers.
    folder : str
        What the definitions are in.
    modules : Path
        Folder of that module.
    python : str
        Which Python runs it.
    """

    def __init__(
        self, family: str, folder: str, *, modules: Path, python: str = ROS_PYTHON
    ) -> None:
        self._command = [python, str(_SCRIPT), family, folder, str(modules)]
        self._process: subprocess.Popen[str] | None = None
        self.missing: str | None = None
        self.versions: dict[str, str] = {}
        self._start()

    def ask(self, request: dict[str, Any]) -> dict[str, Any]:
        """Send a request; return the answer, which is ``failed`` if the process dies of it."""
        if self._process is None:
            self._start()
        answer = self._exchange(json.dumps(request))
        if answer is None:
            self.close()
            return {"failed": DIED}
        return answer

    @property
    def cpu_seconds(self) -> float:
        """Processor time of the process so far; 0 where the system does not say."""
        if self._process is None:
            return 0.0
        # The clock of another process: clock_getcpuclockid(3) computes its number so on Linux.
        with suppress(OSError):
            return time.clock_gettime((~self._process.pid << 3) | 2)
        return 0.0

    def close(self) -> None:
        """End the process. It can be asked again, which starts another."""
        if self._process is None:
            return
        process, self._process = self._process, None
        hang_up(process, 10)

    def _start(self) -> None:
        try:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                env=_environment(self._command[0]),
            )
        except OSError as error:
            self.missing = f"{self._command[0]} cannot be run: {error.strerror}"
            return
        hello = self._exchange(None) or {"missing": "its Python does not start"}
        self.missing = hello.get("missing")
        self.versions = hello.get("versions", {})
        if self.missing is not None:
            self.close()

    def _exchange(self, line: str | None) -> dict[str, Any] | None:
        process = self._process
        assert process is not None and process.stdin is not None and process.stdout is not None
        try:
            if line is not None:
                process.stdin.write(line + "\n")
                process.stdin.flush()
            return dict(json.loads(process.stdout.readline()))
        except (OSError, ValueError):
            return None


def _environment(python: str) -> dict[str, str]:
    # As ROS's tools are run by most: in an environment that speaks UTF-8. What rosidl_parser 3.3.1
    # makes of a text that lark can read in two ways depends on the order of sets, so on the seed.
    found = {**os.environ, "LC_ALL": "C.UTF-8", "PYTHONUTF8": "1", "PYTHONHASHSEED": "0"}
    if python != ROS_PYTHON:
        # A release of ROS that is sourced must not stand in for the one that was asked for.
        found.pop("PYTHONPATH", None)
    return found
