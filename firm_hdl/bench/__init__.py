"""Measure circuits on FPGAs: area and clock rate, from Yosys and nextpnr."""

from __future__ import annotations

from firm_hdl.bench.devices import DEVICES, Device
from firm_hdl.bench.flow import Measured, measure
from firm_hdl.bench.tools import BenchError

__all__ = ["DEVICES", "BenchError", "Device", "Measured", "measure"]
