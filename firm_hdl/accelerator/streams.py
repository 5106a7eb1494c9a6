"""The conversions as components with streams."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import stream
from amaranth.lib.wiring import In, Out

from firm_hdl.accelerator.convert import Rounding, Step, Values, to_fixed_steps, to_float_steps
from firm_hdl.accelerator.fixed import Fixed, format_of
from firm_hdl.gateware.component import Component

__all__ = ["FixedToFloat", "FloatToFixed"]


class _Pipeline(Component):
    """Steps with a register behind each, which all move at once."""

    def __init__(self, source: Any, target: Any, steps: Sequence[Step]) -> None:
        self._steps = steps
        super().__init__({"i": In(stream.Signature(source)), "o": Out(stream.Signature(target))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # `i.ready` has to come from a register. So one more number is kept when the output stops.
        kept = Signal.like(self.i.payload)
        is_kept, moves = Signal(), Signal()
        number, valid = Signal.like(self.i.payload), Signal()
        m.d.comb += [
            self.i.ready.eq(~is_kept),
            number.eq(Mux(is_kept, kept, self.i.payload)),
            valid.eq(is_kept | self.i.valid),
            moves.eq(~self.o.valid | self.o.ready),
        ]
        with m.If(moves):
            m.d.sync += is_kept.eq(0)
        with m.Elif(self.i.valid & self.i.ready):
            m.d.sync += [is_kept.eq(1), kept.eq(self.i.payload)]
        values: Values = {"number": number}
        for step in self._steps:
            values = step(m, values)
            registers: Values = {}
            for name, value in values.items():
                registers[name] = register = Signal.like(value, name=name)
                with m.If(moves):
                    m.d.sync += register.eq(value)
            values, before, valid = registers, valid, Signal(name="valid")
            with m.If(moves):
                m.d.sync += valid.eq(before)
        m.d.comb += [self.o.payload.eq(values["number"]), self.o.valid.eq(valid)]
        return m


class FloatToFixed(_Pipeline):
    """Convert floats to fixed-point numbers.

    One number per cycle; latency 3 cycles. All outputs depend on registers only.

    What is too large, infinities included, becomes the largest or the smallest number. NaN becomes
    0. Denormal numbers are converted as all others.

    Parameters
    ----------
    float_bits : int
        32 or 64.
    shape : Fixed
        Each of its numbers but 0 has to be in the range of normal floats.
    rounding : "nearest" or "zero"
        To the nearest number, and to the even one at a tie; or towards 0.

    Members
    -------
    i : In(stream.Signature(float_bits))
        The bits of floats, as leaves of messages carry them.
    o : Out(stream.Signature(shape))
    """

    def __init__(self, float_bits: int, shape: Fixed, *, rounding: Rounding = "nearest"):
        steps = to_fixed_steps(shape, format_of(float_bits), rounding)
        super().__init__(float_bits, shape, steps)


class FixedToFloat(_Pipeline):
    """Convert fixed-point numbers to floats.

    One number per cycle; latency 4 cycles. All outputs depend on registers only.

    A number that no float has becomes the nearest one, and at a tie the even one. 0 becomes 0.0,
    never -0.0.

    Parameters
    ----------
    shape : Fixed
        Each of its numbers but 0 has to be in the range of normal floats.
    float_bits : int
        32 or 64.

    Members
    -------
    i : In(stream.Signature(shape))
    o : Out(stream.Signature(float_bits))
        The bits of floats, as leaves of messages carry them.
    """

    def __init__(self, shape: Fixed, float_bits: int):
        super().__init__(shape, float_bits, to_float_steps(shape, format_of(float_bits)))
