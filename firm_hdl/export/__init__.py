"""Export: converters as files for FPGA tools."""

from __future__ import annotations

from firm_hdl.export.backend import Options
from firm_hdl.export.build import BuildError, Built, build
from firm_hdl.export.top import Port, Top, ports_of

__all__ = [
    "BuildError",
    "Built",
    "Options",
    "Port",
    "Top",
    "build",
    "ports_of",
]
