"""The module around a simulated component: one flat port per signal, with a name of its own.

Ports are numbered, so no name of a user's member can be a keyword of C++, or the name of another
port. Each port has at least one bit.
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import ClockDomain, Elaboratable, Fragment, Module, Signal, Value
from amaranth.hdl._ir import Design
from amaranth.hdl._xfrm import DomainCollector, DomainLowerer

from firm_hdl.rtlil.connections import check_connections
from firm_hdl.sim.design import ClockDomainError, Logic, unconnected_streams
from firm_hdl.sim.fast.ports import Ports, StreamPort
from firm_hdl.sim.levels import divide

__all__ = ["ClockDomainError", "Top"]


class Top(Elaboratable):
    """A component with flat ports, and with the clock domains that it lacks.

    The outside drives the clock of each domain that the design does not drive itself. Resets are
    never high.

    * `component`: a component, or what a `DomainRenamer` made of one.
    * `ports`: its ports.
    """

    def __init__(self, component: Elaboratable, ports: Ports):
        self.component, self.ports = component, ports
        # If no engine can be started, that is the error, and not that nothing was elaborated.
        self._MustUse__used = component._MustUse__used = True
        # By port: the domains whose clocks the outside drives. Known once the design is prepared.
        self.clocks: dict[str, ClockDomain] = {}
        self.clock_of: list[int] = []  # For each stream: the place of its domain in `clocks`.
        # Streams inside the design that offer transfers, and that nothing takes.
        self.open: list[str] = []
        streams = list(enumerate(self.ports.streams))
        # For each stream. The outside drives `valid` and `payload` of input streams, and `ready` of
        # output streams.
        self.valids = [Signal(name=f"valid{number}") for number, _ in streams]
        self.readies = [Signal(name=f"ready{number}") for number, _ in streams]
        self.payloads = [Signal(max(1, s.width), name=f"payload{number}") for number, s in streams]
        # For each plain port.
        self.plain = [
            Signal(max(1, len(port.value)), name=f"plain{number}")
            for number, port in enumerate(self.ports.plain)
        ]

    def prepare(self, *, name: str, divides: bool = False) -> Design:
        """Elaborate the design, with the clocks as ports ``clock0`` and so on.

        * `divides`: divide combinational logic, as a simulation in Python wants it.

        Raises `ClockDomainError` if a stream is in a domain whose clock the design drives itself,
        or in several. Raises `wiring.ConnectionError` if a stream is connected twice.
        """
        fragment = Fragment.get(self, None)
        check_connections(fragment)
        fragment._propagate_domains(ClockDomain)
        domains = dict(sorted(fragment.domains.items())).values()
        clocks = {f"clock{number}": domain for number, domain in enumerate(domains)}
        ports: dict[str, Any] = {port: (domain.clk, None) for port, domain in clocks.items()}
        for signal in [*self.valids, *self.readies, *self.payloads, *self.plain]:
            ports[signal.name] = (signal, None)
        # As `Fragment.prepare` does, which has no place for the division.
        lowered = DomainLowerer()(fragment)
        if divides:
            divide(lowered)
        design = Design(lowered, fragment._prepare_ports(ports), hierarchy=(name,))
        logic = Logic(design)
        self.clocks = {p: each for p, each in clocks.items() if id(each.clk) not in logic.drivers}
        names = unconnected_streams(lowered, logic)
        self.open = [name.removeprefix("design.") for name in names]
        self.clock_of = [self._clock_of(logic, each) for each in self.ports.streams]
        return design

    def _clock_of(self, logic: Logic, stream: StreamPort) -> int:
        found = logic.domains_of(stream.port)
        places = {
            number
            for number, clock in enumerate(self.clocks.values())
            if any(logic.share_a_clock(clock, each) for each in found)
        }
        if len(places) == 1 or not found:
            return places.pop() if places else 0
        names = " and ".join(sorted(repr(each.name) for each in found))
        why = "several clocks drive it" if places else "the design makes its clock itself"
        raise ClockDomainError(
            f"Stream {stream.name!r} is in the clock domain {names}, and cannot be driven: {why}"
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.design = design = Fragment.get(self.component, None)
        collector = DomainCollector()
        collector(design)
        missing = collector.used_domains - collector.defined_domains - {"comb"}
        # Without any clock, there would be no cycles.
        for name in sorted(missing or ({"sync"} - collector.defined_domains)):
            m.domains += (domain := ClockDomain(name))
            m.d.comb += domain.rst.eq(0)
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
