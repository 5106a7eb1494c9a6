"""Fixtures: external tools that proofs need."""

from __future__ import annotations

import pytest

from firm_hdl.equivalence import MissingToolError, Tools, find_tools
from tests.tools import need


@pytest.fixture
def tools() -> Tools:
    """GHDL and Yosys."""
    try:
        return find_tools()
    except MissingToolError as error:
        need(str(error), None)
        raise
