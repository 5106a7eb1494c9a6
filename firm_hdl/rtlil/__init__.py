"""Read, simplify and evaluate RTLIL, the netlist that Amaranth writes. Independent of ROS."""

from __future__ import annotations

from firm_hdl.rtlil.indices import without_indices
from firm_hdl.rtlil.read import parse
from firm_hdl.rtlil.simplify import netlist_of, simplified
from firm_hdl.rtlil.write import convert_fragment, rtlil_of

__all__ = ["convert_fragment", "netlist_of", "parse", "rtlil_of", "simplified", "without_indices"]
