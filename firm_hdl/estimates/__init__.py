"""Estimated area and clock rate, from measured figures of similar circuits."""

from __future__ import annotations

from firm_hdl.estimates.nearest import Estimate, estimate_text, estimates_of, features_of
from firm_hdl.estimates.parts import part_estimate, placed_cells

__all__ = [
    "Estimate",
    "estimate_text",
    "estimates_of",
    "features_of",
    "part_estimate",
    "placed_cells",
]
