"""Limits of what Amaranth can elaborate."""

from __future__ import annotations

__all__ = ["MAX_CELL_BITS"]

MAX_CELL_BITS = 65_535
"""Most bits of a cell in Amaranth 0.5. All inputs of a design together count as one cell."""
