"""Verilog: a module per converter, waivers for linters, and an instantiation template."""

from __future__ import annotations

from firm_hdl.export.backend import module_name
from firm_hdl.export.verilog.backend import Verilog
from firm_hdl.export.verilog.yosys import is_out_of_memory, out_of_memory, to_verilog

__all__ = ["Verilog", "is_out_of_memory", "module_name", "out_of_memory", "to_verilog"]
