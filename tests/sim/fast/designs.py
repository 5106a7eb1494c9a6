"""A design that has each kind of port, with names that are awkward in C++."""

from __future__ import annotations

from typing import Literal

from amaranth.hdl import Cat, ClockDomain, Module, Signal, signed
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out, connect, flipped

from firm_hdl import PacketCrossing, PacketFifo, PacketSignature

__all__ = ["BUS_BYTES", "Awkward", "Divided", "Fault"]

BUS_BYTES = 4

Fault = Literal["", "value", "late", "order"]


class Awkward(wiring.Component):
    """Adds numbers to a sum, and stores packets in a FIFO.

    Names are keywords of C++, and would be equal if dots were replaced by underscores.

    Faults: "value", a sum of 4 becomes 9; "late", the fourth sum comes a cycle late; "order", the
    plain output `wide` has its halves exchanged.

    Members
    -------
    int : In(stream of signed(12))
    class_ : Out(stream of sum and parity)
        `sum` is that of all numbers, and of `add` for each; `odd` whether it is odd.
    packets_in, packets_out : packet streams
    echo : array of two streams
        `echo.0` comes out of `echo.1`; both are always ready.
    add : In(8), initially 3
    p : with `in`, In(8); p__in : In(8)
    unused : In(3)
    wide : Out(100)
        The number of cycles twice, then `p__in` and `p.in`.
    near, far : packet streams
        `far` has the packets of `near` in the clock domain `video`.
    far_cycles : Out(40)
        The number of cycles of `video`.
    """

    def __init__(self, fault: Fault = "") -> None:
        self.fault = fault
        result = data.StructLayout({"sum": signed(32), "odd": 1})
        always = stream.Signature(8, always_ready=True)
        super().__init__(
            {
                "int": In(stream.Signature(signed(12))),
                "class": Out(stream.Signature(result)),
                "packets_in": In(PacketSignature(BUS_BYTES)),
                "packets_out": Out(PacketSignature(BUS_BYTES)),
                "echo_in": In(always).array(2),
                "echo_out": Out(always).array(2),
                "add": In(8, init=3),
                "p": In(wiring.Signature({"in": Out(8)})),
                "p__in": In(8),
                "unused": In(3),
                "wide": Out(100),
                "near": In(PacketSignature(BUS_BYTES)),
                "far": Out(PacketSignature(BUS_BYTES)),
                "far_cycles": Out(40),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.fifo = fifo = PacketFifo(BUS_BYTES, 64, 8, when_full="wait")
        connect(m, flipped(self.packets_in), fifo.packets_in)
        connect(m, fifo.packets_out, flipped(self.packets_out))
        for n in range(2):
            came = self.echo_in[n]
            m.d.sync += self.echo_out[1 - n].payload.eq(came.payload)
            m.d.sync += self.echo_out[1 - n].valid.eq(came.valid)
        cycles = Signal(40)
        m.d.sync += cycles.eq(cycles + 1)
        inner = getattr(self.p, "in")
        halves = [self.p__in, inner] if self.fault != "order" else [inner, self.p__in]
        m.d.comb += self.wide.eq(Cat(cycles, cycles, *halves))
        self._sum(m)
        m.domains.video = ClockDomain()
        m.submodules.crossing = crossing = PacketCrossing(
            BUS_BYTES, write_domain="sync", read_domain="video"
        )
        connect(m, flipped(self.near), crossing.packets_in)
        connect(m, crossing.packets_out, flipped(self.far))
        m.d.video += self.far_cycles.eq(self.far_cycles + 1)
        return m

    def _sum(self, m: Module) -> None:
        numbers, sums = self.int, getattr(self, "class")
        count, held = Signal(3), Signal()
        free = ~sums.valid | sums.ready
        m.d.comb += numbers.ready.eq(free & ~held)
        with m.If(free):
            m.d.sync += sums.valid.eq(numbers.valid & numbers.ready)
        with m.If(numbers.valid & numbers.ready):
            total = sums.payload.sum + numbers.payload + self.add
            m.d.sync += sums.payload.sum.eq(total)
            m.d.sync += sums.payload.odd.eq(total[0])
            m.d.sync += count.eq(count + 1)
            if self.fault == "value":
                with m.If(total == 4):
                    m.d.sync += sums.payload.sum.eq(9)
            if self.fault == "late":
                m.d.sync += held.eq(count == 2)
        if self.fault == "late":
            with m.If(held):
                m.d.sync += held.eq(0)


class Divided(wiring.Component):
    """A design that makes a clock, and has a stream in its domain."""

    def __init__(self) -> None:
        super().__init__({"o": Out(stream.Signature(8))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.domains.half = half = ClockDomain(reset_less=True)
        m.d.sync += half.clk.eq(~half.clk)
        m.d.half += self.o.payload.eq(self.o.payload + 1)
        m.d.half += self.o.valid.eq(1)
        return m
