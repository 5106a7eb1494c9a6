"""What tests of verification need from outside."""

from __future__ import annotations

import pytest

from firm_hdl.verify.simulators import SimulatorMissingError, TextSimulator, find_ghdl, simulator
from tests.export.conftest import need


@pytest.fixture
def ghdl() -> str:
    """GHDL's path."""
    try:
        return find_ghdl()
    except SimulatorMissingError:
        return need("GHDL", None)


@pytest.fixture
def of_verilog(request: pytest.FixtureRequest) -> TextSimulator:
    """A simulator of Verilog, by the name that is the parameter."""
    found = None
    try:
        found = simulator(request.param)
    except SimulatorMissingError:
        need(request.param, None)
    assert found is not None
    return found
