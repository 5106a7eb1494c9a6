"""Export: converters as files for FPGA tools."""

from __future__ import annotations

__all__: list[str] = []
