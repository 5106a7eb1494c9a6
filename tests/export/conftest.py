"""What tests of the back ends need from outside."""

from __future__ import annotations

import os
import shutil

import pytest

from tests.export.ghdl import GHDL


def need(tool: str, path: str | None) -> str:
    """Return a tool's path. Without the tool, skip the test; in CI, fail it."""
    if path is None:
        message = f"{tool} is not installed (as root: make tools)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return path


@pytest.fixture
def ghdl() -> str:
    """GHDL's path."""
    return need("GHDL", GHDL)


@pytest.fixture
def iverilog() -> str:
    """Icarus Verilog's path."""
    return need("Icarus Verilog", shutil.which("iverilog"))


@pytest.fixture
def verilator() -> str:
    """Verilator's path."""
    return need("Verilator", shutil.which("verilator"))
