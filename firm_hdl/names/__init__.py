"""Names that are legal in VHDL, Verilog and SystemVerilog, and differ in more than case."""

from __future__ import annotations

from firm_hdl.names.identifiers import flat_names, identifier, scope_names

__all__ = ["flat_names", "identifier", "scope_names"]
