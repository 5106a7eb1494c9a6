"""The back end for SystemVerilog: a message's structs, and modules that speak them."""

from __future__ import annotations

from firm_hdl.export.systemverilog.backend import SystemVerilog

__all__ = ["SystemVerilog"]
