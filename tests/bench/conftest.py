"""Fixtures: external tools that measurements need."""

from __future__ import annotations

import pytest

from firm_hdl.bench import DEVICES, Device
from firm_hdl.bench.tools import find_nextpnr, find_yosys
from firm_hdl.jobs import ProgramMissingError
from tests.tools import need


@pytest.fixture
def ecp5() -> Device:
    """The ECP5, if its tools are installed."""
    device = DEVICES["ecp5"]
    assert device.placer is not None
    try:
        find_yosys()
        find_nextpnr(device.placer.package, device.placer.program)
    except ProgramMissingError as error:
        need(str(error), None)
    return device
