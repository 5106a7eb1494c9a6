"""The back end for Verilog: modules with plain ports, and templates of instances."""

from __future__ import annotations

from firm_hdl.export.backend import module_name
from firm_hdl.export.verilog.backend import write

__all__ = ["module_name", "write"]
