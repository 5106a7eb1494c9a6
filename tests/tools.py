"""External tools that tests need."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

__all__ = ["need", "run_script"]


def need(tool: str, path: str | None) -> str:
    """Return a tool's path. Without the tool, skip the test; in CI, fail it."""
    if path is None:
        message = f"{tool} is not installed (as root: make tools)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return path


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
