"""Write any Amaranth design as Verilog: `convert`. Independent of ROS."""

from __future__ import annotations

from firm_hdl.verilog.convert import convert

__all__ = ["convert"]
