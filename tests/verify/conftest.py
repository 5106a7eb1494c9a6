"""Fixtures for tests of verification: external programs, libraries and message types."""

from __future__ import annotations

import pytest

from firm_hdl.jobs.programs import ProgramMissingError, find_ghdl
from firm_hdl.verify.references.clients import client
from firm_hdl.verify.simulators.programs import TextSimulator, simulator
from tests.cases.conftest import make_message
from tests.tools import need

__all__ = ["make_message"]


@pytest.fixture
def ghdl() -> str:
    """The path of GHDL."""
    try:
        return find_ghdl()
    except ProgramMissingError:
        return need("GHDL", None)


@pytest.fixture
def of_verilog(request: pytest.FixtureRequest) -> TextSimulator:
    """A Verilog simulator, named by the parameter."""
    found = None
    try:
        found = simulator(request.param)
    except ProgramMissingError:
        need(request.param, None)
    assert found is not None
    return found


@pytest.fixture
def library_here():
    """A function that returns a client library; skip the test if it is missing, or fail in CI."""

    def get(name):
        found = client(name)
        if found.missing() is not None:
            need(f"{name} ({found.missing()})", None)
        return found

    return get
