"""External tools that tests need."""

from __future__ import annotations

import fcntl
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

__all__ = ["made_once", "need", "run_script"]


def need(tool: str, path: str | None) -> str:
    """Return a tool's path. Without the tool, skip the test; in CI, fail it."""
    if path is None:
        message = f"{tool} is not installed (as root: make tools)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return path


def made_once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """Return a folder that one of pytest's processes makes, for all of them."""
    base = factory.getbasetemp()
    # pytest-xdist gives each of its processes a folder below a common one.
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / name
    with folder.with_suffix(".lock").open("a+") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        lock.seek(0)
        if not lock.read():
            folder.mkdir(exist_ok=True)
            make(folder)
            lock.write("made")
    return folder


def run_script(
    script: Path, *arguments: str, folder: str | Path = "/", **environment: str
) -> tuple[int, str]:
    """Run a shell script from another folder; return its status and all that it printed."""
    done = subprocess.run(
        ["sh", str(script), *arguments],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr
