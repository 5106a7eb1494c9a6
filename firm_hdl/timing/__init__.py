"""The cycles that converters take, found from plans: what is known of the circuits' pipeline."""

from firm_hdl.timing.figures import (
    LINE_RATES,
    Cost,
    Timing,
    clock_mhz,
    describe,
    recovery_text,
    timing,
)

__all__ = [
    "LINE_RATES",
    "Cost",
    "Timing",
    "clock_mhz",
    "describe",
    "recovery_text",
    "timing",
]
