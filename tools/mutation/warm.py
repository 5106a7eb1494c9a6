"""Run pytest many times without loading third-party packages each time.

``python -m tools.mutation.warm`` runs in the folder whose tests it runs. It reads one job per line
from standard input and answers each with a line. Every job is a fork of its own, so that no job
sees modules of another. This process never loads `firm_hdl`.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import resource
import signal
import sys
import time
from typing import Any

__all__ = ["main"]

# Packages that are slow to load and not part of the tested program.
PACKAGES = (
    "pytest numpy amaranth.hdl amaranth.lib.wiring amaranth.lib.stream amaranth.sim"
    " amaranth.back.rtlil lark yaml tqdm rosbags.typesys rosbags.serde hypothesis.strategies"
    " hypothesis.internal.conjecture.engine"
)
MOST_BYTES = 4 << 30
POLL_SECONDS = 0.05


def main() -> None:
    """Serve until standard input ends."""
    for package in PACKAGES.split():
        with contextlib.suppress(ImportError):
            importlib.import_module(package)
    loaded = [name for name in sys.modules if name.partition(".")[0] == "firm_hdl"]
    assert not loaded, loaded
    signal.signal(signal.SIGTERM, _end)
    for line in sys.stdin:
        print(json.dumps(_serve(json.loads(line))), flush=True)


_running: list[int] = []


def _end(*_: object) -> None:
    """End this process and the running job."""
    for child in _running:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)
    os._exit(128 + signal.SIGTERM)


def _serve(job: dict[str, Any]) -> dict[str, Any]:
    """Run one job: `args` of pytest, `log`, `environment`, limits `cpu_seconds` and `seconds`.

    With `module`, load that module instead of running tests.
    """
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        _run(job)
    _running.append(child)
    late = time.monotonic() + job["seconds"]
    timed_out = False
    while True:
        done, status, usage = os.wait4(child, os.WNOHANG)
        if done:
            break
        if time.monotonic() > late and not timed_out:
            timed_out = True
            os.killpg(child, signal.SIGKILL)
        time.sleep(POLL_SECONDS)
    # Kill processes that a test has left running, such as simulators.
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    _running.clear()
    code = os.waitstatus_to_exitcode(status)
    timed_out |= code == -signal.SIGXCPU
    return {"code": code, "timeout": timed_out, "cpu": usage.ru_utime + usage.ru_stime}


def _run(job: dict[str, Any]) -> None:
    """Run the job in this forked process; never return."""
    code = 99
    try:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        os.setsid()
        log = os.open(job["log"], os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        null = os.open(os.devnull, os.O_RDONLY)
        for here, there in ((null, 0), (log, 1), (log, 2)):
            os.dup2(here, there)
        seconds = job["cpu_seconds"]
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
        resource.setrlimit(resource.RLIMIT_DATA, (MOST_BYTES, MOST_BYTES))
        os.environ.update(job["environment"])
        if "module" in job:
            importlib.import_module(job["module"])
            code = 0
        else:
            import pytest

            code = int(pytest.main(job["args"]))
        tested = getattr(sys.modules.get("firm_hdl"), "__file__", None)
        if tested and not os.path.realpath(tested).startswith(os.path.realpath(os.getcwd())):
            print(f"\nWRONG COPY {tested}")
            code = 98
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


if __name__ == "__main__":
    main()
