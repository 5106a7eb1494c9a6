"""Skid buffer: a stream register without a combinational path through it."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, ShapeLike, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["StreamSlice"]


class StreamSlice(wiring.Component):
    """Register a stream. `i.ready`, `o.valid` and `o.payload` are registers.

    Latency 1 cycle. Throughput one transfer per cycle.

    Parameters
    ----------
    shape : shape-like
        The shape of the payload.

    Members
    -------
    i : In(stream.Signature(shape))
    o : Out(stream.Signature(shape))
    """

    def __init__(self, shape: ShapeLike):
        super().__init__({"i": In(stream.Signature(shape)), "o": Out(stream.Signature(shape))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # `second` holds the transfer of the cycle in which `o` stops; it is empty if `i.ready`.
        incoming, out = Value.cast(self.i.payload), Value.cast(self.o.payload)
        second = Signal(len(incoming), reset_less=True)
        ready = Signal(init=1)
        moves = Signal()
        m.d.comb += [self.i.ready.eq(ready), moves.eq(~self.o.valid | self.o.ready)]
        with m.If(moves):
            m.d.sync += [
                self.o.valid.eq(self.i.valid | ~ready),
                out.eq(Mux(ready, incoming, second)),
                ready.eq(1),
            ]
        with m.Elif(self.i.valid):
            m.d.sync += ready.eq(0)
        with m.If(ready):
            m.d.sync += second.eq(incoming)
        return m
