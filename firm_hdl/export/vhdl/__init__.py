"""The back end for VHDL: records of a message, converters with record ports, and test benches."""

from __future__ import annotations

from firm_hdl.export.vhdl.backend import write

__all__ = ["write"]
