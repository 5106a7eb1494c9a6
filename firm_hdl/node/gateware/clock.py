"""The clock of a node: seconds and nanoseconds, set and kept in step by the host."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.node.control import RATE_FRACTION_BITS, nominal_rate
from firm_hdl.node.gateware.streams import time_layout

__all__ = ["NodeClock"]

SECOND = 1_000_000_000
"""Nanoseconds of a second."""


class NodeClock(wiring.Component):
    """Count time in steps of ``2**-22`` ns.

    In each cycle, the time advances by the rate. It never jumps and never goes back, except when it
    is set. All outputs are registers. One clock domain, `sync`; its reset sets the time to 0, and
    the rate to that of `clock_hz`.

    Parameters
    ----------
    clock_hz : float
        Frequency of `sync`, from 1 MHz on.

    Members
    -------
    time : Out(time_layout())
        `nanosec` is always below 1,000,000,000. `sec` returns to 0 after ``2**32 - 1``.
    rate : Out(32)
        Steps per cycle.
    sets : In(1)
        Continue from `to`. The output has this time 2 cycles later.
    to : In(time_layout())
        `nanosec` has to be below 1,000,000,000.
    sets_rate : In(1)
        Take `to_rate` as the rate.
    to_rate : In(32)
    """

    def __init__(self, clock_hz: float):
        self.nominal = nominal_rate(clock_hz)
        if not 0 < self.nominal < 1 << 32:
            raise ValueError(f"Frequency must be from 1 MHz on, not {clock_hz:g} Hz")
        super().__init__(
            {
                "time": Out(time_layout()),
                "rate": Out(32),
                "sets": In(1),
                "to": In(time_layout()),
                "sets_rate": In(1),
                "to_rate": In(32),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        fraction = RATE_FRACTION_BITS
        bits = fraction + SECOND.bit_length() + 1
        rate = Signal(32, init=self.nominal)
        step = Signal(32, init=self.nominal)
        # The nanoseconds of a step less a second, in a register, so that no path has two additions.
        step_back = Signal(signed(bits - fraction), init=(self.nominal >> fraction) - SECOND)
        # The time in this second, and the same less a second. If the latter is not negative, the
        # second is over; its sign is a register, so it only selects what the adders add to.
        within = Signal(bits)
        beyond = Signal(bits - 1)
        negative = Signal(init=1)
        now = Signal(bits)
        over = Signal()
        seconds = Signal(32)
        m.d.comb += [
            over.eq(~negative),
            now.eq(Mux(over, beyond, within)),
            self.rate.eq(rate),
        ]
        m.d.sync += [
            step.eq(rate),
            step_back.eq(rate[fraction:] - SECOND),
            within.eq(now + step),
            Cat(beyond, negative).eq(now + Cat(step[:fraction], step_back)),
            seconds.eq(seconds + over),
            self.time.nanosec.eq(now[fraction:]),
            self.time.sec.eq(seconds + over),
        ]
        with m.If(self.sets):
            m.d.sync += [
                within.eq(self.to.nanosec << fraction),
                negative.eq(1),
                seconds.eq(self.to.sec),
            ]
        with m.If(self.sets_rate):
            m.d.sync += rate.eq(self.to_rate)
        return m
