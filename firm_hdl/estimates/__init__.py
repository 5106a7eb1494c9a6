"""Estimated area and clock rate, from measured figures of similar circuits."""

from __future__ import annotations

from firm_hdl.estimates.nearest import Estimate, estimate_text, estimates_of, features_of
from firm_hdl.estimates.parts import (
    PartEstimate,
    core_estimate,
    ethernet_estimate,
    link_estimate,
)

__all__ = [
    "Estimate",
    "PartEstimate",
    "core_estimate",
    "estimate_text",
    "estimates_of",
    "ethernet_estimate",
    "features_of",
    "link_estimate",
]
