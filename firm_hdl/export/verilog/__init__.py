"""Verilog: a module per converter, waivers for linters, and an instantiation template."""

from __future__ import annotations

from firm_hdl.export.backend import module_name
from firm_hdl.export.verilog.backend import Verilog

__all__ = ["Verilog", "module_name"]
