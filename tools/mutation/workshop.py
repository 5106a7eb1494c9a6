"""A private copy of the repository, with one fault at a time."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tools.mutation.chosen import CHOSEN, RUNNING
from tools.mutation.mutants import Mutant

__all__ = ["Run", "Workshop", "copy_tree"]

LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv", "__pycache__", ".*_cache", ".hypothesis", "*.egg-info", "build", "dist"
)
OPTIONS = ["-x", "-q", "--no-header", "--tb=line", "-p", "no:cacheprovider", "-p", "no:xdist"]
# Hypothesis is loaded before pytest could rewrite its assertions, so ignore this warning.
OPTIONS += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]
SECONDS = 1800
LOADING_SECONDS = 60
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S.*?)(?: - .*)?$", re.MULTILINE)
WRONG_COPY = 98
# Exit status of pytest if no test was collected, so that no test judges the mutant.
NOTHING = 5


@dataclass(frozen=True)
class Run:
    """The result of a run of pytest.

    Attributes
    ----------
    status : str
        ``passed``, ``failed``, ``timeout``, or ``error`` if something else ended it.
    by : str
        The first test that failed, or the test that ran at the time limit.
    cpu_seconds : float
    """

    status: str
    by: str
    cpu_seconds: float


def copy_tree(source: Path, to: Path) -> None:
    """Copy a repository without the files that tools have made."""
    shutil.copytree(source, to, ignore=LEFT_OUT, dirs_exist_ok=True, symlinks=True)


class Workshop:
    """A context manager: a copy of the repository, and a process that runs tests in it.

    Parameters
    ----------
    root : Path
        The copy. Each change to it is undone.
    nice : int
    """

    def __init__(self, root: Path, nice: int = 0) -> None:
        self.root = root
        self._log = root.parent / f"{root.name}.log"
        # Modification time of the next changed file. Each is later than all before, because Python
        # finds outdated bytecode by it.
        self._now = 2_000_000_000
        environment = {
            **os.environ,
            "PYTHONPATH": str(root),
            "HYPOTHESIS_STORAGE_DIRECTORY": str(root.parent / f"{root.name}.hypothesis"),
            "OPENBLAS_NUM_THREADS": "1",
        }
        environment.pop("PYTEST_ADDOPTS", None)
        self._server = subprocess.Popen(
            [sys.executable, "-m", "tools.mutation.warm"],
            cwd=root,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: os.nice(nice) and None,
        )

    def __enter__(self) -> Workshop:
        return self

    def __exit__(self, *_: object) -> None:
        assert self._server.stdin and self._server.stdout
        with contextlib.suppress(BrokenPipeError):
            self._server.stdin.close()
        self._server.terminate()
        self._server.wait()
        self._server.stdout.close()

    @contextlib.contextmanager
    def with_fault(self, mutant: Mutant) -> Iterator[None]:
        """Insert a fault, and remove it at the end."""
        path = self.root / mutant.path
        before = path.read_bytes()
        try:
            self._write(path, mutant.change.apply(before.decode()).encode())
            yield
        finally:
            self._write(path, before)
            # The database would give a later mutant the examples of an earlier failure.
            storage = self.root.parent / f"{self.root.name}.hypothesis"
            shutil.rmtree(storage, ignore_errors=True)

    def _write(self, path: Path, data: bytes) -> None:
        path.write_bytes(data)
        self._now += 1
        os.utime(path, (self._now, self._now))

    def run_tests(self, names: Sequence[str], cpu_seconds: float, seconds: float) -> Run:
        """Run tests in this order until one fails. Tests that do not exist are ignored."""
        beside = self.root.parent / self.root.name
        chosen, running = beside.with_suffix(".chosen"), beside.with_suffix(".running")
        chosen.write_text(json.dumps(list(names)))
        running.write_text("")
        files = dict.fromkeys(name.partition("::")[0] for name in names)
        environment = {CHOSEN: str(chosen), RUNNING: str(running)}
        run = self.run(
            ["-p", "tools.mutation.chosen", *files], cpu_seconds, environment, seconds=seconds
        )
        # Use the whole name of the failed test: pytest's output may cut it at a ` - ` in the name.
        last = running.read_text()
        if run.status == "passed" or (run.by.startswith("tests/") and not last.startswith(run.by)):
            return run
        # If no test has begun, the failure was in loading, most likely that of the first file.
        return replace(run, by=last or next(iter(files)))

    def run(
        self,
        arguments: Sequence[str],
        cpu_seconds: float,
        environment: Mapping[str, str] | None = None,
        *,
        seconds: float | None = None,
    ) -> Run:
        """Run pytest until one test fails.

        Parameters
        ----------
        arguments : sequence of str
            Test files, and options in addition to the usual ones.
        cpu_seconds : float
            Limit on the processor time of pytest, without processes that tests start.
        environment : mapping, optional
            Variables in addition to the usual ones.
        seconds : float, optional
            Limit on the elapsed time.
        """
        answer = self._ask(
            {
                "args": [*OPTIONS, *arguments],
                "cpu_seconds": int(cpu_seconds) + 1,
                "seconds": SECONDS if seconds is None else seconds,
                "environment": dict(environment or {}),
            }
        )
        text = self._log.read_text(errors="replace")
        if answer["code"] == WRONG_COPY:
            raise RuntimeError(text[-300:])
        status = _status(answer["code"], answer["timeout"])
        match = FAILED.search(text)
        by = match[1] if match and status == "failed" else ""
        if status in ("failed", "error") and not by:
            by = f"exit status {answer['code']}"
        return Run(status=status, by=by, cpu_seconds=answer["cpu"])

    def loads(self, path: str) -> bool:
        """Return whether Python loads a module of the copy."""
        module = path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
        limits = {"cpu_seconds": LOADING_SECONDS, "seconds": 10 * LOADING_SECONDS}
        return bool(self._ask({"module": module, "environment": {}, **limits})["code"] == 0)

    def _ask(self, job: dict[str, Any]) -> dict[str, Any]:
        assert self._server.stdin and self._server.stdout
        self._server.stdin.write(json.dumps({**job, "log": str(self._log)}) + "\n")
        self._server.stdin.flush()
        line = self._server.stdout.readline()
        if not line:
            raise RuntimeError("the process that runs tests has ended")
        answer: dict[str, Any] = json.loads(line)
        return answer

    def output(self) -> str:
        """Return what the last run printed."""
        return self._log.read_text(errors="replace")


def _status(code: int, timeout: bool) -> str:
    if timeout:
        return "timeout"
    # The run was killed from outside, for example for lack of memory. This is no result.
    if code in (-signal.SIGKILL, -signal.SIGTERM, -signal.SIGINT, -signal.SIGHUP):
        return "error"
    return "passed" if code in (0, NOTHING) else "failed"
