"""The command ``firm-hdl node run`` as a process."""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

__all__ = ["BridgeProcess"]

ROOT = Path(__file__).parents[2]


class BridgeProcess:
    """A bridge in a process; a context manager, which kills it.

    Parameters
    ----------
    file : path
        The description of the node.
    arguments : str
        Arguments behind it.
    python : str
        The Python that runs it.
    variables : dict
        Further variables of the environment.
    setup : str
        Python that is run before.
    """

    def __init__(self, file, *arguments, python=sys.executable, variables=None, setup=""):
        paths = [str(ROOT), *(path for path in sys.path if path.endswith("site-packages"))]
        variables = dict(variables or {})
        paths.append(variables.pop("PYTHONPATH", ""))
        code = f"import sys; {setup}from firm_hdl.cli import main; sys.exit(main())"
        self.process = subprocess.Popen(
            [python, "-c", code, "node", "run", str(file), *arguments],
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(paths), **variables},
        )
        self.lines = []
        self._new = queue.Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self._reader.join()
        self.process.stderr.close()

    def wait_for(self, text, timeout=1200.0):
        """Wait for a line with a text, perhaps until a design is compiled; return it."""
        end = time.monotonic() + timeout
        while True:
            try:
                line = self._new.get(timeout=max(0.01, end - time.monotonic()))
            except queue.Empty:
                line = None
            assert line is not None, f"no {text!r} in {self.lines}"
            if text in line:
                return line

    def stop(self, number=signal.SIGINT):
        """End it as Ctrl-C does; return its account, the last lines."""
        begin = len(self.lines)
        self.process.send_signal(number)
        assert self.process.wait(30) == 0, self.lines
        self._reader.join()
        return [line for line in self.lines[begin:] if line.strip()]

    def engine(self):
        """Return the process of its simulation."""
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children")
        # Another child may be Yosys, which stays for the next design.
        (found,) = (
            number
            for number in children.read_text().split()
            if b"simulation-" in Path(f"/proc/{number}/cmdline").read_bytes()
        )
        return int(found)

    def _read(self):
        for line in self.process.stderr:
            self.lines.append(line.rstrip("\n"))
            self._new.put(self.lines[-1])
        self._new.put(None)
