"""What tests of the back ends need from outside."""

from __future__ import annotations

import os

import pytest

from tests.export.ghdl import GHDL


@pytest.fixture
def ghdl() -> str:
    """GHDL's path. Without GHDL, tests are skipped, except in CI, where they fail."""
    if GHDL is None:
        message = "GHDL is not installed (Debian: apt install ghdl-mcode)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return GHDL
