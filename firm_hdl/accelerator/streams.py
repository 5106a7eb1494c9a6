"""The conversions as components with streams, and a fork of streams."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import stream
from amaranth.lib.wiring import In, Out

from firm_hdl.accelerator.convert import Rounding, Step, Values, to_fixed_steps, to_float_steps
from firm_hdl.accelerator.fixed import Fixed, format_of
from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import Stream
from firm_hdl.gateware.limits import check_integer

__all__ = ["FixedToFloat", "FloatToFixed", "Fork"]


def _kept(m: Module, port: Any, moves: Value) -> tuple[Signal, Signal]:
    """Return payload and `valid` of an input; they are taken if `moves` is high.

    `ready` of the input has to come from a register. So one more transfer is kept in registers when
    the output stops.
    """
    came = Value.cast(port.payload)
    kept = Signal.like(came, name="kept")
    is_kept = Signal()
    payload, valid = Signal.like(came, name="number"), Signal(name="is_offered")
    m.d.comb += [
        port.ready.eq(~is_kept),
        payload.eq(Mux(is_kept, kept, came)),
        valid.eq(is_kept | port.valid),
    ]
    with m.If(moves):
        m.d.sync += is_kept.eq(0)
    with m.Elif(port.valid & port.ready):
        m.d.sync += [is_kept.eq(1), kept.eq(came)]
    return payload, valid


class _Pipeline(Component):
    """Steps with a register behind each, which all move at once."""

    i: Stream[Any]
    o: Stream[Any]

    def __init__(self, source: Any, target: Any, steps: Sequence[Step]) -> None:
        self._steps = steps
        super().__init__({"i": In(stream.Signature(source)), "o": Out(stream.Signature(target))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        moves = Signal()
        m.d.comb += moves.eq(~self.o.valid | self.o.ready)
        number, valid = _kept(m, self.i, moves)
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


class Fork(Component):
    """Send each transfer of a stream to several others, which may take it at different times.

    One transfer per cycle; latency 1 cycle. All outputs depend on registers only. An output that
    stops holds the others after two transfers.

    Parameters
    ----------
    shape : shape-like
        Of the payload.
    outputs : int
        How many streams come out.

    Members
    -------
    i : In(stream.Signature(shape))
    o : Out(stream.Signature(shape)).array(outputs)

    Raises
    ------
    TypeError, ValueError
        If `outputs` is no number from 1 on.
    """

    i: Stream[Any]
    o: Sequence[Stream[Any]]

    def __init__(self, shape: Any, outputs: int):
        check_integer("The number of outputs", outputs)
        if outputs < 1:
            raise ValueError(f"A fork has at least 1 output, not {outputs}")
        port = stream.Signature(shape)
        super().__init__({"i": In(port), "o": Out(port).array(outputs)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        outputs: list[Any] = list(self.o)
        moves = Signal()
        m.d.comb += moves.eq(Cat(~each.valid | each.ready for each in outputs).all())
        payload, valid = _kept(m, self.i, moves)
        held = Signal.like(payload, name="held")
        with m.If(moves):
            m.d.sync += held.eq(payload)
        for number, each in enumerate(outputs):
            waits = Signal(name=f"waits_{number}")
            m.d.comb += [Value.cast(each.payload).eq(held), each.valid.eq(waits)]
            with m.If(moves):
                m.d.sync += waits.eq(valid)
            with m.Elif(each.ready):
                m.d.sync += waits.eq(0)
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
