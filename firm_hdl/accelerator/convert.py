"""The logic of the conversions, in steps: functions join the steps, components register them.

A float is ``significand * 2**exponent`` (IEEE Std 754-2019, clause 3.4), so both conversions shift
the significand: to fixed point by what its exponent says, and back until its highest bit is 1.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, TypeAlias

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, ValueLike, signed

from firm_hdl.accelerator.fixed import Fixed, FloatFormat, format_of

__all__ = [
    "Rounding",
    "Step",
    "Values",
    "fixed_to_float",
    "float_to_fixed",
    "to_fixed_steps",
    "to_float_steps",
]

Rounding: TypeAlias = Literal["nearest", "zero"]
"""`nearest`: to the nearest number, a tie to the even one. `zero`: towards 0."""

Values: TypeAlias = "dict[str, Value]"
Step: TypeAlias = "Callable[[Module, Values], Values]"
"""Combinational logic between the values before and behind it."""


def float_to_fixed(
    m: Module, number: ValueLike, shape: Fixed, *, rounding: Rounding = "nearest"
) -> Signal:
    """Return a float as a fixed-point number; combinational.

    Parameters
    ----------
    number : value-like
        The bits of a float, 32 or 64.
    shape : Fixed
    rounding : Rounding

    Returns
    -------
    Signal of `shape`
        What is too large, infinities included, becomes the largest or the smallest number. NaN
        becomes 0.

    Raises
    ------
    TypeError, ValueError
        If `number` has another width, or the floats do not reach all of `shape`.
    """
    value = Value.cast(number)
    steps = to_fixed_steps(shape, format_of(len(value)), rounding)
    return _joined(m, value, steps, Signal(signed(shape.bits), name="fixed"))


def fixed_to_float(m: Module, number: ValueLike, fraction_bits: int, float_bits: int) -> Signal:
    """Return a fixed-point number as a float; combinational.

    Parameters
    ----------
    number : value-like
        Signed, such as the result of a sum: its width need not be that of a :class:`Fixed`, but is
        at most 64.
    fraction_bits : int
        Its bits after the point.
    float_bits : int
        32 or 64.

    Returns
    -------
    Signal
        The bits of the nearest float, of the even one at a tie. 0 becomes 0.0, never -0.0.

    Raises
    ------
    TypeError, ValueError
        If `number` is not signed, or the floats do not reach all of its values.
    """
    value = Value.cast(number)
    if not value.shape().signed:
        raise TypeError(f"A fixed-point number is signed, not {value!r}")
    target = format_of(float_bits)
    steps = to_float_steps(Fixed(len(value), fraction_bits), target)
    return _joined(m, value, steps, Signal(float_bits, name="float"))


def _joined(m: Module, value: Value, steps: Sequence[Step], result: Signal) -> Signal:
    values = {"number": value}
    for step in steps:
        values = {name: _signal(m, name, each) for name, each in step(m, values).items()}
    m.d.comb += result.eq(values["number"])
    return result


def _signal(m: Module, name: str, value: ValueLike) -> Signal:
    """Give a value a signal: an expression that is used twice would be elaborated twice."""
    signal = Signal.like(Value.cast(value), name=name)
    m.d.comb += signal.eq(value)
    return signal


def _check_reach(shape: Fixed, target: FloatFormat) -> None:
    """Check that each fixed-point number but 0 is in the range of normal floats."""
    if not isinstance(shape, Fixed):
        raise TypeError(f"A fixed-point number has a Fixed as its shape, not {shape!r}")
    least, most = shape.bits - 1 - target.bias, target.bias - 1
    if not least <= shape.fraction_bits <= most:
        raise ValueError(
            f"A number of {shape.bits} bits with {shape.fraction_bits} after the point is out of "
            f"the range of float{target.bits}: {least} to {most} bits after the point are possible"
        )


def to_fixed_steps(shape: Fixed, source: FloatFormat, rounding: Rounding) -> Sequence[Step]:
    """Return the steps from a float to a fixed-point number; both are called `number`."""
    _check_reach(shape, source)
    if rounding not in ("nearest", "zero"):
        raise ValueError(f"Rounding must be 'nearest' or 'zero', not {rounding!r}")
    bits, mantissa_bits = shape.bits, source.mantissa_bits
    # The exponent with which the highest bit of the significand is the highest one below the sign.
    top = source.bias + bits - 2 - shape.fraction_bits
    # The significand is in the highest bits. Below those of the result is the first bit that is
    # cut off.
    width = max(mantissa_bits + 1, bits)

    def decode(m: Module, values: Values) -> Values:
        number = values["number"]
        mantissa, exponent = number[:mantissa_bits], number[mantissa_bits:-1]
        is_normal = exponent.any()
        # A denormal number has the exponent of the smallest normal one, and no 1 before its point.
        # Its sign has to stay right with the largest exponent.
        distance = _signal(m, "distance", Const(top, source.exponent_bits) - exponent - ~is_normal)
        return {
            "sign": number[-1],
            "significand": Cat(mantissa, is_normal),
            # With so many places, less than a quarter is left.
            "places": Mux(distance > bits, bits, distance)[: bits.bit_length()],
            "is_large": exponent > top,
            "is_nan": exponent.all() & mantissa.any(),
        }

    def shift(m: Module, values: Values) -> Values:
        significand, places = values["significand"], values["places"]
        value: Value = Cat(Const(0, width - len(significand)), significand)
        lost: list[Value] = []
        for place in reversed(range(len(places))):
            count = min(1 << place, width)
            lost.append(places[place] & value[:count].any())
            value = _signal(m, "shifted", Mux(places[place], value[count:], value))
        low = width - (bits - 1)
        passed = {name: values[name] for name in ("sign", "is_large", "is_nan")}
        if rounding == "zero":
            return {"magnitude": value[low:], "up": Const(0, 1), **passed}
        rest = Cat(lost).any() | value[: low - 1].any()
        up = value[low - 1] & (rest | value[low])
        return {"magnitude": value[low:], "up": up, **passed}

    def finish(m: Module, values: Values) -> Values:
        sign, up = values["sign"], values["up"]
        # -(magnitude + up) is ~magnitude + 1 - up: one addition for both signs.
        flipped = Cat(values["magnitude"] ^ sign.replicate(bits - 1), sign)
        result = _signal(m, "result", (flipped + (up ^ sign))[:bits])
        is_large = values["is_large"] | (result[-1] & ~sign)
        limit = Cat((~sign).replicate(bits - 1), sign)
        number = Mux(is_large, limit, result)
        return {"number": Mux(values["is_nan"], 0, number).as_signed()}

    return decode, shift, finish


def to_float_steps(shape: Fixed, target: FloatFormat) -> Sequence[Step]:
    """Return the steps from a fixed-point number to a float; both are called `number`."""
    _check_reach(shape, target)
    bits, mantissa_bits = shape.bits, target.mantissa_bits
    places = (bits - 1).bit_length()

    def split(m: Module, values: Values) -> Values:
        number = values["number"]
        return {"sign": number[-1], "magnitude": Mux(number[-1], -number, number)[:bits]}

    def shift(first: int, last: int) -> Step:
        """Shift zeros out at the left, ``2**first`` of them, and so on down to ``2**last``."""

        def step(m: Module, values: Values) -> Values:
            value = values["magnitude"]
            zeros: list[Any] = []
            for place in range(first, last - 1, -1):
                count = 1 << place
                is_zero = _signal(m, "is_zero", ~value[bits - count :].any())
                moved = Cat(Const(0, count), value[: bits - count])
                value = _signal(m, "moved", Mux(is_zero, moved, value))
                zeros.insert(0, is_zero)
            below = [values["zeros"]] if "zeros" in values else []
            return {"sign": values["sign"], "magnitude": value, "zeros": Cat(*zeros, *below)}

        return step

    def finish(m: Module, values: Values) -> Values:
        magnitude, sign = values["magnitude"], values["sign"]
        largest = Const(target.bias + bits - 1 - shape.fraction_bits, target.exponent_bits)
        exponent = (largest - values["zeros"])[: target.exponent_bits]
        cut = bits - 1 - mantissa_bits
        if cut <= 0:
            number = Cat(Const(0, -cut), magnitude[:-1], exponent)
        else:
            rest = magnitude[: cut - 1].any()
            up = magnitude[cut - 1] & (rest | magnitude[cut])
            # A carry out of the mantissa makes the exponent right, too.
            number = (Cat(magnitude[cut:-1], exponent) + up)[: target.bits - 1]
        # Without a 1, the number is 0.
        is_zero = ~magnitude[-1]
        return {"number": Mux(is_zero, 0, Cat(number, sign))}

    half = places // 2
    return split, shift(places - 1, half), shift(half - 1, 0), finish
