"""What tests of verification need from outside."""

from __future__ import annotations

import pytest

from firm_hdl.verify.simulators import SimulatorMissingError, find_ghdl
from tests.export.conftest import need


@pytest.fixture
def ghdl() -> str:
    """GHDL's path."""
    try:
        return find_ghdl()
    except SimulatorMissingError:
        return need("GHDL", None)
