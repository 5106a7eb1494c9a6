"""Streams inside a design, which a bench watches and holds up."""

from __future__ import annotations

import pytest
from amaranth.hdl import Cat, Const, Module, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.sim import StreamRuleError
from firm_hdl.sim.bench import Bench, Job, Ports, RunOptions
from firm_hdl.sim.stalls import Stalls
from tests.sim.components import Relay


class Tapped(wiring.Component):
    """A stream through a register, with a gate that can stall it inside."""

    def __init__(self, fault=""):
        self.fault = fault
        super().__init__({"i": In(stream.Signature(8)), "o": Out(stream.Signature(8))})
        self.between = stream.Signature(8).create()
        self.gates = Signal(1)

    def elaborate(self, platform):
        m = Module()
        m.submodules.relay = relay = Relay(8, self.fault)
        m.d.comb += [
            relay.i.payload.eq(self.i.payload),
            relay.i.valid.eq(self.i.valid),
            self.i.ready.eq(relay.i.ready),
            self.o.payload.eq(relay.o.payload),
            self.o.valid.eq(relay.o.valid & self.gates),
            relay.o.ready.eq(self.o.ready & self.gates),
            self.between.payload.eq(relay.o.payload),
            self.between.valid.eq(relay.o.valid & self.gates),
            self.between.ready.eq(self.o.ready & self.gates),
        ]
        return m


@pytest.mark.parametrize(
    ("stalls", "times"),
    [({}, [1, 2, 3]), ({"tap": "001"}, [2, 5, 8]), ({"tap": "100", "o": "01"}, [3, 7, 9])],
)
def test_taps_are_watched_and_held_up_by_their_gates(stalls, times):
    design = Tapped()
    ports = Ports(
        sources={"i": design.i},
        sinks={"o": design.o},
        taps={"tap": design.between},
        gates=design.gates,
        payloads={"tap": Cat(design.between.payload, Const(1))},
    )
    taken = {"o": [], "tap": []}
    takes = {
        name: lambda cycle, bits, name=name: taken[name].append((cycle, bits)) for name in taken
    }
    job = Job(
        sources={"i": [7, 8, 9]},
        takes=takes,
        finished=lambda: len(taken["o"]) == 3,
        outstanding=lambda: "",
        options=RunOptions(stalls={name: Stalls.bits(bits) for name, bits in stalls.items()}),
    )
    Bench(design, ports).run(job)
    assert taken["o"] == list(zip(times, [7, 8, 9], strict=True))
    assert taken["tap"] == [(time, 256 + payload) for time, payload in taken["o"]]


@pytest.mark.parametrize(("fault", "rule"), [("drop", 2), ("change", 3)])
def test_rules_are_watched_at_taps(fault, rule):
    design = Tapped(fault)
    # The output behind the tap is never ready, and nobody watches it.
    ports = Ports(sources={"i": design.i}, taps={"tap": design.between}, gates=design.gates)
    taken = []
    job = Job(
        sources={"i": [4]},
        takes={"tap": lambda cycle, bits: taken.append(bits)},
        finished=lambda: len(taken) == 1,
        outstanding=lambda: "",
        options=RunOptions(deadline=20),
    )
    with pytest.raises(StreamRuleError, match=f"^Stream 'tap' breaks rule {rule} in cycle"):
        Bench(design, ports).run(job)
