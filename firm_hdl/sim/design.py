"""What a simulated design tells about its streams: their clock domains, and those that wait.

All of this is found in the elaborated design. So it holds for any component of
`amaranth.lib.wiring` that has streams, whoever wrote it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeAlias
from weakref import WeakKeyDictionary

from amaranth.hdl import ClockDomain, Fragment, Signal, Value
from amaranth.hdl._ast import Assign, Switch
from amaranth.hdl._ir import Design
from amaranth.hdl._mem import MemoryInstance
from amaranth.hdl._xfrm import DomainCollector
from amaranth.sim import SimulatorContext
from amaranth.sim._pyclock import PyClockProcess

from firm_hdl.errors import UserError
from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import Stream
from firm_hdl.rtlil.connections import check_connections, components_of, streams_of

__all__ = [
    "ClockDomainError",
    "Domain",
    "Logic",
    "check_domain",
    "check_domains",
    "unconnected_streams",
    "what_waits",
]

Domain: TypeAlias = "str | ClockDomain"
"""A clock domain, or its name in the outermost module."""

_ENDS = {True: "sends on", False: "receives from"}
_MOST_NAMES = 12
_LOST = tuple("aborted full large truncated trailing length encapsulation string overrun".split())
"""Counters of packets that FIFOs and gates dropped."""


class ClockDomainError(UserError):
    """A stream cannot be driven in a clock domain."""


def check_domain(
    ctx: SimulatorContext,
    ports: Mapping[str, Stream[Any]],
    domain: Domain,
    *,
    sends: bool | None = None,
) -> None:
    """Check that a testbench can use streams, given by name, in a clock domain.

    * `sends`: whether the testbench sends on the streams or receives from them; `None`: it only
      watches.

    Raises `TypeError` if the context or the domain is none. Raises `ValueError` if the design has
    the same end of a stream as the testbench. Raises `ClockDomainError` if the design has no such
    domain, the domain has no clock, or a stream belongs to registers of other domains. Raises
    `wiring.ConnectionError`: as :func:`.check_connections`.
    """
    if not isinstance(ctx, SimulatorContext):
        raise TypeError(f"The first argument must be the context of a testbench, not {ctx!r}")
    if not isinstance(domain, str | ClockDomain):
        raise TypeError(f"domain= must be the name of a clock domain, not {domain!r}")
    design: Design = ctx._design
    if design not in _logic:
        check_connections(design.fragment)
        _logic[design] = Logic(design)
    logic = _logic[design]
    clock = _resolved(design, domain)
    if id(clock.clk) not in logic.drivers and not _has_clock(ctx, clock):
        raise ClockDomainError(
            f"The clock domain {clock.name!r} has no clock: "
            f"call add_clock(period, domain={clock.name!r}) of the simulator"
        )
    for name, port in ports.items():
        if sends is not None and id(port.valid if sends else port.ready) in logic.drivers:
            hint = "receive from it" if sends else "send on it"
            raise ValueError(f"The design itself {_ENDS[sends]} stream {name!r}; {hint}")
        found = logic.domains_of(port)
        if found and not any(logic.share_a_clock(each, clock) for each in found):
            named = [each for each in found if design.fragment.domains.get(each.name) is each]
            names = sorted(repr(each.name) for each in named or found)
            raise ClockDomainError(
                f"Stream {name!r} is in the clock domain {' and '.join(names)}, not in "
                f"{clock.name!r}: pass domain={names[0] if named else 'that ClockDomain'}"
            )


def check_domains(design: Fragment, what: str) -> None:
    """Check that an elaborated design has no other clock domain than `sync`.

    * `what`: what simulates the design, for the error.

    Raises `ClockDomainError`.
    """
    collector = DomainCollector()
    collector(design)
    others = (collector.used_domains | collector.defined_domains) - {"comb", "sync"}
    if others:
        raise ClockDomainError(
            f"{what} has one clock domain, 'sync'; the design also has "
            + ", ".join(repr(name) for name in sorted(others))
        )


def _resolved(design: Design, domain: Domain) -> ClockDomain:
    if isinstance(domain, ClockDomain):
        return domain
    try:
        found: ClockDomain = design.lookup_domain(domain, None)
    except KeyError:
        there = ", ".join(map(repr, sorted(design.fragment.domains))) or "none"
        raise ClockDomainError(
            f"The design has no clock domain {domain!r}; the names for domain= are {there}"
        ) from None
    return found


def _has_clock(ctx: SimulatorContext, domain: ClockDomain) -> bool:
    slot = ctx._engine.state.get_signal(domain.clk)
    clocks = (each for each in ctx._engine._processes if isinstance(each, PyClockProcess))
    return any(each.slot == slot for each in clocks)


class Logic:
    """The assignments of a design, by the signals that they drive and read."""

    def __init__(self, design: Design):
        # By the `id` of a driven signal: the domain of each driver, `None` for combinational logic,
        # and the values that it reads.
        self.drivers: dict[int, list[tuple[ClockDomain | None, list[Value]]]] = {}
        self._readers: dict[int, list[tuple[ClockDomain | None, list[Signal]]]] | None = None
        self._assigned = [each for fragment in design.fragments for each in _assigned(fragment)]
        for domain, driven, read in self._assigned:
            for signal in driven:
                self.drivers.setdefault(id(signal), []).append((domain, read))

    def domains_of(self, port: Stream[Any]) -> set[ClockDomain]:
        """Return the domains of the registers that drive a stream, or else of its readers."""
        signals = [port.valid, port.ready]
        found = self._before(signals)[0]
        return found or self._after([*signals, *Value.cast(port.payload)._rhs_signals()])

    def share_a_clock(self, one: ClockDomain, other: ClockDomain) -> bool:
        """Return whether the clock of one domain is that of the other, maybe through logic."""
        pairs = ((one, other), (other, one))
        return any(id(a.clk) in self._before([b.clk])[1] for a, b in pairs)

    def _before(self, signals: Iterable[Any]) -> tuple[set[ClockDomain], set[int]]:
        """Return the domains of the registers, and the signals, that combinational logic reads."""
        domains, seen, stack = set(), set(), list(signals)
        while stack:
            signal = stack.pop()
            if id(signal) in seen:
                continue
            seen.add(id(signal))
            for domain, read in self.drivers.get(id(signal), ()):
                if domain is not None:
                    domains.add(domain)
                else:
                    stack += [each for value in read for each in value._rhs_signals()]
        return domains, seen

    def _after(self, signals: Iterable[Any]) -> set[ClockDomain]:
        """Return the domains of the registers that read signals through combinational logic."""
        if self._readers is None:
            self._readers = {}
            for domain, driven, read in self._assigned:
                for value in read:
                    for signal in value._rhs_signals():
                        self._readers.setdefault(id(signal), []).append((domain, driven))
        domains, seen, stack = set(), set(), list(signals)
        while stack:
            signal = stack.pop()
            if id(signal) in seen:
                continue
            seen.add(id(signal))
            for domain, driven in self._readers.get(id(signal), ()):
                if domain is not None:
                    domains.add(domain)
                else:
                    stack += driven
        return domains


_logic: WeakKeyDictionary[Design, Logic] = WeakKeyDictionary()


def _assigned(
    fragment: Fragment,
) -> Iterator[tuple[ClockDomain | None, list[Signal], list[Value]]]:
    """Yield each assignment of a module: the domain, the driven signals, and what is read."""
    domains = {"comb": None, **fragment.domains}
    if isinstance(fragment, MemoryInstance):
        for port in fragment._read_ports:
            yield domains[port._domain], [*port._data._lhs_signals()], [port._addr, port._en]
        for port in fragment._write_ports:
            yield domains[port._domain], [], [port._addr, port._data, port._en]
    for name, statements in fragment.statements.items():
        stack: list[tuple[Any, list[Value]]] = [(each, []) for each in statements]
        while stack:
            statement, tests = stack.pop()
            if isinstance(statement, Switch):
                for _, body, _ in statement.cases:
                    stack += [(each, [*tests, statement.test]) for each in body]
            elif isinstance(statement, Assign):
                yield domains[name], [*statement._lhs_signals()], [statement.rhs, *tests]


def unconnected_streams(design: Fragment, logic: Logic) -> Iterator[str]:
    """Yield the names of streams that offer transfers, and whose `ready` no logic drives."""
    for place, component in components_of(design):
        for name, port in streams_of(component):
            is_open = isinstance(port.ready, Signal) and id(port.ready) not in logic.drivers
            if is_open and id(port.valid) in logic.drivers:
                yield ".".join([*place, *name])


def what_waits(ctx: SimulatorContext) -> str:
    """Describe the streams of a design whose offered transfer is not taken, and dropped packets.

    Streams inside the components of firm-hdl are left out. The text is the end of an error, and
    empty if there is nothing to tell.
    """
    design: Design = ctx._design
    driven = _logic[design].drivers
    open_: list[str] = []
    waiting: list[str] = []
    dropped: list[str] = []
    for place, component in components_of(design.fragment):
        for name, port in streams_of(component):
            if ctx.get(port.valid) and not ctx.get(port.ready):
                names = waiting if id(port.ready) in driven else open_
                names.append(".".join([*place, *name]))
        if isinstance(component, Component) and "counters" in component.signature.members:
            counters: Any = component.counters
            there = (key for key in _LOST if key in counters.shape().members)
            counts = {key: ctx.get(counters[key]) for key in there}
            if lost := ", ".join(f"{count} {key}" for key, count in counts.items() if count):
                dropped.append(f"{'.'.join(place) or type(component).__name__} ({lost})")
    parts = [
        ("offered while no logic drives `ready`", open_),
        ("offered while `ready` is low", waiting),
        ("packets were dropped", dropped),
    ]
    return "".join(f"; {what}: {_listed(names)}" for what, names in parts if names)


def _listed(names: list[str]) -> str:
    rest = len(names) - _MOST_NAMES
    return ", ".join(names[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else "")
