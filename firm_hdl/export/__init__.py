"""Export: converters as files for FPGA tools."""

from __future__ import annotations

from firm_hdl.export.backend import Options
from firm_hdl.export.build import BuildError, Built, build
from firm_hdl.export.top import Port, Top, ports_of
from firm_hdl.export.verilog import to_verilog
from firm_hdl.names.identifiers import flat_names, identifier, scope_names

__all__ = [
    "BuildError",
    "Built",
    "Options",
    "Port",
    "Top",
    "build",
    "flat_names",
    "identifier",
    "ports_of",
    "scope_names",
    "to_verilog",
]
