"""Fixtures: external tools that proofs need."""

from __future__ import annotations

import pytest

from firm_hdl.equivalence import Tools, find_tools
from firm_hdl.jobs import ProgramMissingError
from tests.tools import need


@pytest.fixture
def tools() -> Tools:
    """GHDL and Yosys."""
    try:
        return find_tools()
    except ProgramMissingError as error:
        need(str(error), None)
        raise
