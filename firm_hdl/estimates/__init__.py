"""Area and clock rate of a converter, estimated from those of converters that were measured."""

from __future__ import annotations

from firm_hdl.estimates.nearest import Estimate, estimate_text, estimates_of, features_of

__all__ = ["Estimate", "estimate_text", "estimates_of", "features_of"]
