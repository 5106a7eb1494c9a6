"""What tests of verification need from outside."""

from __future__ import annotations

import pytest

from firm_hdl.verify.simulators import SimulatorMissingError, TextSimulator, find_ghdl, simulator
from firm_hdl.verify.sut import client
from tests.tools import need


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


@pytest.fixture
def library_here():
    """Give a client library. Where it is not installed, skip the test; in CI, fail it."""

    def get(name):
        found = client(name)
        if found.missing() is not None:
            need(f"{name} ({found.missing()})", None)
        return found

    return get
