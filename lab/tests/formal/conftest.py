"""What proofs need from outside."""

from __future__ import annotations

import pytest

from firm_hdl.equivalence.tools import find_tools
from firm_hdl.jobs import ProgramMissingError
from tests.tools import need


@pytest.fixture(autouse=True)
def yosys() -> None:
    """Yosys with ABC."""
    try:
        find_tools(ghdl=False)
    except ProgramMissingError as error:
        need(str(error), None)
