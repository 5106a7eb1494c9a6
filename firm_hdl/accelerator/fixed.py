"""Formats of numbers: signed fixed point, and the floats of ROS."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from amaranth.hdl import Const, Shape, ShapeCastable, Value, signed

from firm_hdl.gateware.limits import check_integer

__all__ = ["Fixed", "FloatFormat", "float_bits", "format_of"]

MOST_BITS = 64


@dataclass(frozen=True, slots=True)
class FloatFormat:
    """A binary interchange format of IEEE 754."""

    bits: int
    mantissa_bits: int
    exponent_bits: int
    letter: str  # Its letter in `struct`.

    @property
    def bias(self) -> int:
        return (1 << (self.exponent_bits - 1)) - 1


_FORMATS = {32: FloatFormat(32, 23, 8, "f"), 64: FloatFormat(64, 52, 11, "d")}


def format_of(float_bits: int) -> FloatFormat:
    """Return the format of a float.

    Raises `ValueError` if ROS has no float of so many bits.
    """
    if float_bits not in _FORMATS:
        raise ValueError(f"A float of ROS has 32 or 64 bits, not {float_bits!r}")
    return _FORMATS[float_bits]


@dataclass(frozen=True)
class Fixed(ShapeCastable):
    """Signed fixed point: the number is the integer, divided by ``2**fraction_bits``.

    An Amaranth shape, ``signed(bits)``: ``Signal(Fixed(32, 16), init=0.5)``. Constants are numbers.
    Values of this shape are plain signed integers, with the operators of these, also in simulation.

    Parameters
    ----------
    bits : int
        All bits, the sign included: from 2 to 64.
    fraction_bits : int
        Bits after the point. It may be negative, or larger than `bits`.
    """

    bits: int
    fraction_bits: int

    def __post_init__(self) -> None:
        check_integer("The number of bits", self.bits)
        check_integer("The number of bits after the point", self.fraction_bits)
        if not 2 <= self.bits <= MOST_BITS:
            raise ValueError(
                f"A fixed-point number has from 2 to {MOST_BITS} bits, not {self.bits}"
            )

    def raw(self, number: float | Fraction) -> int:
        """Return the integer of a number, rounded to the nearest one, or to the even one.

        Raises
        ------
        ValueError
            If the number is not finite, or too large.
        """
        if isinstance(number, float) and not math.isfinite(number):
            raise ValueError(f"{number} is no fixed-point number")
        # `round` of a fraction is exact.
        raw = round(Fraction(number) * Fraction(2) ** self.fraction_bits)
        if not -1 << (self.bits - 1) <= raw < 1 << (self.bits - 1):
            raise ValueError(f"{number} does not fit into {self}")
        return raw

    def number(self, raw: int) -> Fraction:
        """Return the number of an integer, exactly. ``float`` of it is the nearest float."""
        return Fraction(raw) / Fraction(2) ** self.fraction_bits

    # The protocol of Amaranth.

    def as_shape(self) -> Shape:
        return signed(self.bits)

    def __call__(self, target: Any) -> Value:
        value = Value.cast(target)
        return value if value.shape().signed else value.as_signed()

    def const(self, init: float | Fraction | None) -> Const:
        return Const(self.raw(init or 0), signed(self.bits))

    def from_bits(self, raw: int) -> int:
        # As `ctx.get` of a signal.
        return int(Const(raw, self.as_shape()).value)


def float_bits(number: float, bits: int) -> int:
    """Return the bits of a constant: ``leaf.payload.eq(float_bits(0.5, 64))``.

    Parameters
    ----------
    bits : int
        32 or 64. A number that is not a float of 32 bits becomes the nearest one.

    Raises
    ------
    ValueError
        If the number is too large.
    """
    letter = format_of(bits).letter
    try:
        return int.from_bytes(struct.pack(f"<{letter}", number), "little")
    except OverflowError:
        raise ValueError(f"{number} is too large for a float of {bits} bits") from None
