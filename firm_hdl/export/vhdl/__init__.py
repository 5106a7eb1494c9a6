"""The back end for VHDL: a message's records, converters that speak them, and their benches."""

from __future__ import annotations

from firm_hdl.export.vhdl.backend import Vhdl, VhdlFolder, to_vhdl

__all__ = ["Vhdl", "VhdlFolder", "to_vhdl"]
