"""What accelerators need: numbers in fixed point, and whole messages at once.

A `float32` or `float64` leaf of a message carries the bits of the float. `FloatToFixed` and
`FixedToFloat` convert streams of them, a number per cycle; `float_to_fixed` and `fixed_to_float`
are the same as combinational logic. `take_message` and `offer_message` make one stream of a
message, whose payload has its fields.
"""

from __future__ import annotations

from firm_hdl.accelerator.convert import fixed_to_float, float_to_fixed
from firm_hdl.accelerator.fixed import Fixed, float_bits
from firm_hdl.accelerator.messages import offer_message, offer_messages, take_message, tie_off
from firm_hdl.accelerator.streams import FixedToFloat, FloatToFixed

__all__ = [
    "Fixed",
    "FixedToFloat",
    "FloatToFixed",
    "fixed_to_float",
    "float_bits",
    "float_to_fixed",
    "offer_message",
    "offer_messages",
    "take_message",
    "tie_off",
]
