"""Small programs around parts of the harness, so that a test can call these parts."""

from __future__ import annotations

import subprocess
from pathlib import Path

import firm_hdl.fuzz
from firm_hdl.jobs import ProgramMissingError
from firm_hdl.jobs.programs import find_compiler
from tests.tools import need

__all__ = ["compiled"]

HARNESS = Path(firm_hdl.fuzz.__file__).parent / "harness"


def compiled(folder: Path, main: str, *parts: str) -> Path:
    """Compile a program that has `main` and parts of the harness; return its path."""
    try:
        compiler = find_compiler("A test")
    except ProgramMissingError as error:
        need(str(error), None)
    # One file is compiled faster than several.
    lines = [f'#include "{HARNESS / part}.cpp"\n' for part in parts]
    (folder / "main.cpp").write_text("".join(lines) + main)
    options = ["-O0", "-std=gnu++17", f"-I{HARNESS}", "-o", str(folder / "program")]
    command = [*compiler, *options, str(folder / "main.cpp")]
    subprocess.run(command, check=True, timeout=300)
    return folder / "program"
