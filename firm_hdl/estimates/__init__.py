"""Estimated area and clock rate of a converter: the measured figures of a similar converter."""

from __future__ import annotations

from firm_hdl.estimates.nearest import Estimate, estimate_text, estimates_of, features_of

__all__ = ["Estimate", "estimate_text", "estimates_of", "features_of"]
