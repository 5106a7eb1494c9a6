"""Small components with streams, correct and faulty, for tests of the harness itself."""

from __future__ import annotations

from typing import Literal

from amaranth.hdl import ClockDomain, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from firm_hdl.gateware import Serializer

__all__ = ["Fault", "Faulty", "Relay", "run_testbenches"]

Fault = Literal["", "drop", "change", "swallow", "block"]


class Relay(wiring.Component):
    """A register in a stream, optionally with a fault.

    "drop": after three cycles of waiting, `o.valid` falls for a cycle; "change": the payload's
    lowest bit turns while it waits; "swallow": every fourth payload is lost; "block": nothing is
    taken after the fourth.
    """

    def __init__(self, shape, fault: Fault = ""):
        self.fault = fault
        super().__init__({"i": In(stream.Signature(shape)), "o": Out(stream.Signature(shape))})

    def elaborate(self, platform):
        m = Module()
        held = Signal()
        word = Signal(len(Value.cast(self.i.payload)))
        waited = Signal(range(8))
        count = Signal(8)
        blocked = (count >= 4) if self.fault == "block" else 0
        lost = (count[:2] == 3) if self.fault == "swallow" else 0
        m.d.comb += [
            self.o.valid.eq(held & ~((waited == 3) if self.fault == "drop" else 0)),
            Value.cast(self.o.payload).eq(
                word ^ Mux(waited == 2, 1, 0) if self.fault == "change" else word
            ),
            self.i.ready.eq((~held | (self.o.valid & self.o.ready)) & ~blocked),
        ]
        with m.If(self.o.valid & self.o.ready):
            m.d.sync += [held.eq(0), waited.eq(0)]
        with m.Elif(held):
            m.d.sync += waited.eq(waited + 1)
        with m.If(self.i.valid & self.i.ready):
            m.d.sync += [held.eq(~lost), word.eq(self.i.payload), count.eq(count + 1)]
        return m


def run_testbenches(design, *testbenches, background=()):
    """Simulate a design until all testbenches have returned."""
    top = Module()
    top.domains.sync = ClockDomain("sync")
    top.submodules.design = design
    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    for testbench in testbenches:
        simulator.add_testbench(testbench)
    for testbench in background:
        simulator.add_testbench(testbench, background=True)
    simulator.run()


class Faulty(wiring.Component):
    """A serializer with a fault in one of its streams."""

    def __init__(self, fault, *arguments, **options):
        self.fault = fault
        self.inner = Serializer(*arguments, **options)
        self.plan, self.tree = self.inner.plan, self.inner.tree
        super().__init__(self.inner.signature)

    def elaborate(self, platform):
        m = Module()
        m.submodules.inner = inner = self.inner
        wiring.connect(m, wiring.flipped(self.message), inner.message)
        wiring.connect(m, inner.packets, wiring.flipped(self.packets))
        wiring.connect(m, inner.status, wiring.flipped(self.status))
        m.d.comb += self.packet_error.eq(inner.packet_error)
        if self.fault == "silent":
            m.d.comb += self.packets.valid.eq(0)
        elif self.fault == "unstable":
            m.d.comb += self.packets.payload.data[0].eq(
                inner.packets.payload.data[0] ^ ~self.packets.ready
            )
        elif self.fault == "count":
            m.d.comb += self.packets.payload.count.eq(3)
        elif self.fault == "twice":
            m.d.comb += self.status.valid.eq(1)
        return m
