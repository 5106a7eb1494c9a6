"""The back end for SystemVerilog: structs of a message, and modules whose ports are structs."""

from __future__ import annotations

from firm_hdl.export.systemverilog.backend import write

__all__ = ["write"]
