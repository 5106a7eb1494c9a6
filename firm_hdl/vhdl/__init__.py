"""Write any Amaranth design as VHDL-2008: `convert`. Independent of ROS."""

from __future__ import annotations

from firm_hdl.vhdl.convert import Vhdl, convert

__all__ = ["Vhdl", "convert"]
