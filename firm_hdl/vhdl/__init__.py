"""Any Amaranth design as VHDL-2008: `convert`. Knows no messages."""

from __future__ import annotations

from firm_hdl.vhdl.convert import Vhdl, convert

__all__ = ["Vhdl", "convert"]
