"""Fast simulation of whole designs: compiled by Verilator, or in Amaranth's simulator."""

from __future__ import annotations

from firm_hdl.sim.fast.channel import SimulationError
from firm_hdl.sim.fast.compilers import BuildError, Report
from firm_hdl.sim.fast.engines import EngineName
from firm_hdl.sim.fast.simulation import FastSimulation, Packet, Transfer
from firm_hdl.sim.fast.top import ClockDomainError

__all__ = [
    "BuildError",
    "ClockDomainError",
    "EngineName",
    "FastSimulation",
    "Packet",
    "Report",
    "SimulationError",
    "Transfer",
]
