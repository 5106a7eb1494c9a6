"""Read, simplify and evaluate RTLIL, the netlist that Amaranth writes. Independent of ROS."""

from __future__ import annotations

from firm_hdl.rtlil.indices import without_indices
from firm_hdl.rtlil.read import parse
from firm_hdl.rtlil.simplify import simplified
from firm_hdl.rtlil.write import convert, convert_fragment

__all__ = ["convert", "convert_fragment", "parse", "simplified", "without_indices"]
