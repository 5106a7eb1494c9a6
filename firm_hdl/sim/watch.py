"""Check the rules of streams.

The rules have the numbers of ``docs/reference/streams.md``. Those that can be observed are
checked: two of all streams, and two of packets
(:func:`firm_hdl.gateware.signatures.packet_layout`).

* Rule 2: once `valid` is high, it stays high until the transfer.
* Rule 3: once `valid` is high, the payload stays the same until the transfer.
* Rule 5: a beat that is not the last of its packet is full: `count` is the width of the bus.
* Rule 6: `count` is at most the width of the bus, and 0 only in the single beat of an empty packet.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from amaranth.hdl import Cat, Value
from amaranth.sim import SimulatorContext

from firm_hdl.gateware.interfaces import Stream
from firm_hdl.gateware.signatures import bus_bytes_of
from firm_hdl.sim.design import Domain, check_domain

__all__ = [
    "PacketRules",
    "StreamRuleError",
    "StreamRules",
    "check_packet_stream",
    "check_stream",
    "watch",
]


class StreamRuleError(AssertionError):
    """A stream broke a rule.

    Attributes
    ----------
    stream : str
        Name of the stream.
    rule : int
        Number of the rule in ``docs/reference/streams.md``; see :mod:`firm_hdl.sim.watch`.
    cycle : int
        Cycle in which the rule was broken, counted from 0.
    """

    def __init__(self, stream: str, rule: int, cycle: int, what: str):
        self.stream = stream
        self.rule = rule
        self.cycle = cycle
        super().__init__(f"Stream {stream!r} breaks rule {rule} in cycle {cycle}: {what}")


@dataclass(slots=True)
class StreamRules:
    """Rules 2 and 3 for a set of streams, checked in each cycle.

    Each stream is a bit in an integer, so that a cycle in which no transfer waits is checked fast.

    Attributes
    ----------
    names : list of str
        Name of the stream of each bit.
    held : dict of int to int
        Payload of each stream whose offered transfer was not taken.
    """

    names: list[str]
    held: dict[int, int] = field(default_factory=dict)
    _waiting: int = 0

    def check(self, cycle: int, valid: int, ready: int, payload: Callable[[int], int]) -> None:
        """Check one cycle; `payload` returns the payload of a stream by its number, as bits."""
        if dropped := self._waiting & ~valid:
            name = self.names[dropped.bit_length() - 1]
            raise StreamRuleError(name, 2, cycle, "valid fell before the transfer")
        waiting = valid & ~ready
        if not (waiting or self.held):
            return
        for number, before in self.held.items():
            if (now := payload(number)) != before:
                what = f"payload changed from {before:#x} to {now:#x} before the transfer"
                raise StreamRuleError(self.names[number], 3, cycle, what)
        if waiting == self._waiting:
            return
        self.held = {
            number: self.held[number] if number in self.held else payload(number)
            for number in range(waiting.bit_length())
            if waiting >> number & 1
        }
        self._waiting = waiting


@dataclass(slots=True)
class PacketRules:
    """Rules 5 and 6 for one packet stream, checked at each transfer."""

    name: str
    bus_bytes: int
    _inside: bool = False

    def check(self, cycle: int, bits: int) -> None:
        """Check one beat, given as bits of the payload."""
        count_bits = self.bus_bytes.bit_length()
        count = bits >> 8 * self.bus_bytes & ((1 << count_bits) - 1)
        last = bool(bits >> (8 * self.bus_bytes + count_bits))
        if not last and count != self.bus_bytes:
            what = f"count is {count}, not {self.bus_bytes}, in a beat that is not the last"
            raise StreamRuleError(self.name, 5, cycle, what)
        if count > self.bus_bytes or (count == 0 and self._inside):
            what = f"count is {count}" + (" at the end of a packet" if self._inside else "")
            raise StreamRuleError(self.name, 6, cycle, what)
        self._inside = not last


def check_stream(port: Any, name: str) -> None:
    """Raise a TypeError unless a port of a user's is a stream."""
    # A flipped stream is not an instance of the class.
    if not all(hasattr(port, part) for part in ("payload", "valid", "ready")):
        raise TypeError(f"{name!r} must be a stream, such as rx.packets, not {port!r}")


def check_packet_stream(port: Any, name: str) -> int:
    """Return the bytes of a beat; raise a TypeError unless a port is a stream of packets."""
    check_stream(port, name)
    bus_bytes = bus_bytes_of(port.payload)
    if not bus_bytes:
        raise TypeError(
            f"{name!r} must be a stream of packets, such as rx.packets, not one of "
            f"{port.payload.shape()!r}"
        )
    return bus_bytes


def watch(
    streams: Mapping[str, Stream[Any]], *, domain: Domain = "sync"
) -> Callable[[SimulatorContext], Awaitable[None]]:
    """Return a testbench that checks streams while the simulation runs.

    Use as ``sim.add_testbench(watch({"packets": rx.packets}), background=True)``.

    Parameters
    ----------
    streams : mapping of str to stream.Interface
        Streams by name, for errors. Packet streams are also checked for rules 5 and 6.
    domain : str or ClockDomain
        Clock domain of all of them.

    Raises
    ------
    TypeError
        If the streams are not given by name.
    ClockDomainError
        From the simulation, if a stream is in another clock domain.
    StreamRuleError
        From the simulation, in the cycle in which a rule is broken.
    """
    if not isinstance(streams, Mapping):
        raise TypeError(
            "watch takes a dict of streams by name, such as {'packets': rx.packets}, "
            f"not {streams!r}"
        )
    for name, port in streams.items():
        check_stream(port, name)
    ports = list(streams.values())
    names = list(streams)
    packets = {
        number: PacketRules(name, bus_bytes)
        for number, (name, port) in enumerate(streams.items())
        if (bus_bytes := bus_bytes_of(port.payload))
    }

    async def watcher(ctx: SimulatorContext) -> None:
        check_domain(ctx, streams, domain)
        rules = StreamRules(names)
        for rule in packets.values():
            rule._inside = False
        valids, readies = Cat(port.valid for port in ports), Cat(port.ready for port in ports)
        payloads = [Value.cast(port.payload) for port in ports]
        cycle = 0
        while True:
            _, reset, valid, ready, *bits = await ctx.tick(domain).sample(
                valids, readies, *payloads
            )
            if reset:
                # A reset discards offered transfers and incomplete packets.
                rules = StreamRules(names)
                for rule in packets.values():
                    rule._inside = False
            else:
                rules.check(cycle, valid, ready, bits.__getitem__)
                for number, rule in packets.items():
                    if (valid & ready) >> number & 1:
                        rule.check(cycle, bits[number])
            cycle += 1

    return watcher
