"""Write any Amaranth design as Verilog for every simulator: `convert`. Independent of ROS."""

from __future__ import annotations

from firm_hdl.verilog.yosys import convert, is_out_of_memory, out_of_memory

__all__ = ["convert", "is_out_of_memory", "out_of_memory"]
