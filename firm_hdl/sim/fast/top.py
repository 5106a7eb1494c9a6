"""The module around a simulated component: one flat port per signal, with a name of its own.

Ports are numbered, so no name of a user's member can be a keyword of C++, or the name of another
port. Each port has at least one bit.
"""

from __future__ import annotations

from amaranth.hdl import ClockDomain, Elaboratable, Fragment, Module, Signal, Value
from amaranth.lib import wiring

from firm_hdl.sim import design
from firm_hdl.sim.design import ClockDomainError
from firm_hdl.sim.fast.ports import Ports

__all__ = ["ClockDomainError", "Top", "check_domains"]


class Top(Elaboratable):
    """A component with flat ports, in the clock domain `sync`, whose reset is never high.

    Parameters
    ----------
    component : wiring.Component
    ports : Ports
        Its ports.

    Attributes
    ----------
    clock : Signal
    valids, readies, payloads : list of Signal
        For each stream. The outside drives `valid` and `payload` of input streams, and `ready` of
        output streams.
    plain : list of Signal
        For each plain port.
    """

    def __init__(self, component: wiring.Component, ports: Ports):
        self.component, self.ports = component, ports
        self.domain = ClockDomain("sync")
        self.clock = self.domain.clk
        streams = list(enumerate(self.ports.streams))
        self.valids = [Signal(name=f"valid{number}") for number, _ in streams]
        self.readies = [Signal(name=f"ready{number}") for number, _ in streams]
        self.payloads = [Signal(max(1, s.width), name=f"payload{number}") for number, s in streams]
        self.plain = [
            Signal(max(1, len(port.value)), name=f"plain{number}")
            for number, port in enumerate(self.ports.plain)
        ]

    @property
    def signals(self) -> list[Signal]:
        """All ports."""
        return [self.clock, *self.valids, *self.readies, *self.payloads, *self.plain]

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.domains.sync = self.domain
        m.d.comb += self.domain.rst.eq(0)
        m.submodules.design = self.component
        for number, each in enumerate(self.ports.streams):
            outer = self.valids[number], self.payloads[number], self.readies[number]
            inner = each.port.valid, Value.cast(each.port.payload), each.port.ready
            if each.is_input:
                m.d.comb += [inner[0].eq(outer[0]), outer[2].eq(inner[2])]
                if each.width:
                    m.d.comb += inner[1].eq(outer[1])
            else:
                m.d.comb += [outer[0].eq(inner[0]), outer[1].eq(inner[1])]
                if not each.is_always_ready:
                    m.d.comb += inner[2].eq(outer[2])
        for port, signal in zip(self.ports.plain, self.plain, strict=True):
            if port.is_input:
                m.d.comb += [port.value.eq(signal)] if len(port.value) else []
            else:
                m.d.comb += signal.eq(port.value)
        return m


def check_domains(fragment: Fragment) -> None:
    """Check that an elaborated design has no clock domain but `sync`, and one source per stream.

    Raises
    ------
    ClockDomainError, wiring.ConnectionError
    """
    design.check_domains(fragment, "A fast simulation")
    design.check_connections(fragment)
