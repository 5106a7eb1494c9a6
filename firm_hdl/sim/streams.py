"""Drivers and monitors of single streams, for users' own testbenches.

All are async functions; await them in a testbench of `amaranth.sim`. To run functions at the same
time, use separate testbenches. Each function starts in the current cycle and returns right after
the clock edge of its last transfer. Payloads are the values that `ctx.set` and `ctx.get` use for
the stream. Each function has the clock domain of its stream as `domain`.

Both sides have a deadline. If there is no transfer for that many cycles, a `DeadlineError` names
the transfers that were still expected, and the streams of the design that wait.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Iterable
from typing import Any

from amaranth.hdl import Value
from amaranth.sim import SimulatorContext

from firm_hdl.gateware.interfaces import Stream
from firm_hdl.gateware.limits import check_integer
from firm_hdl.gateware.signatures import Status
from firm_hdl.sim.bench import DeadlineError
from firm_hdl.sim.design import Domain, check_domain, what_waits
from firm_hdl.sim.payloads import PacketCollector, all_beats, as_packets
from firm_hdl.sim.stalls import Stalls, check_stalls, stalls_of
from firm_hdl.sim.watch import PacketRules, check_packet_stream, check_stream

__all__ = ["receive", "receive_packets", "receive_statuses", "send", "send_packets"]

DEADLINE = 1000
SEND_DEADLINE = 10_000
"""A message may have to wait while another stream transfers a large array."""


async def send(
    ctx: SimulatorContext,
    port: Stream[Any],
    payloads: Iterable[Any],
    *,
    stalls: Stalls = Stalls.none,
    name: str = "stream",
    domain: Domain = "sync",
    deadline: int = SEND_DEADLINE,
) -> None:
    """Send payloads on a stream, and leave it idle.

    Parameters
    ----------
    payloads : iterable
        Payloads. An integer is interpreted as the bits of a payload.
    stalls : Stalls
        Cycles in which the next payload is not offered.
    name : str
        Name of the stream, for errors and for the pattern of stalls.
    domain : str or ClockDomain
        Clock domain of the stream.
    deadline : int
        Most cycles in which a payload is not taken.

    Raises
    ------
    ClockDomainError
        If the stream is in another clock domain, or the domain has no clock.
    DeadlineError
    """
    check_stream(port, name)
    check_stalls(stalls, [name])
    check_domain(ctx, {name: port}, domain, sends=True)
    check_integer("deadline=", deadline)
    if isinstance(payloads, str) or not isinstance(payloads, Iterable):
        raise TypeError(f"Payloads must be a list, not {payloads!r}")
    stalled = stalls_of(stalls, name).cycles(name)
    bits = Value.cast(port.payload)
    for number, payload in enumerate(payloads):
        while next(stalled):
            await ctx.tick(domain)
        if isinstance(payload, int):
            if not -(1 << len(bits)) >> 1 <= payload < 1 << len(bits):
                raise ValueError(f"{name!r} has {len(bits)} bits, too few for {payload}")
            ctx.set(bits, payload)
        elif payload is None:
            raise TypeError(f"{name!r} needs a payload, not None")
        else:
            ctx.set(port.payload, payload)
        ctx.set(port.valid, 1)
        # Do not use `until`: its generator raises if the simulation ends with an error before it.
        taken = quiet = 0
        while not taken:
            _, _, taken = await ctx.tick(domain).sample(port.ready)
            quiet += 1
            if quiet > deadline and not taken:
                what = f"No transfer on stream {name!r} in {quiet} cycles"
                raise DeadlineError(f"{what}; {number} payloads were taken{what_waits(ctx)}")
        ctx.set(port.valid, 0)


async def receive(
    ctx: SimulatorContext,
    port: Stream[Any],
    count: int,
    *,
    stalls: Stalls = Stalls.none,
    deadline: int = DEADLINE,
    name: str = "stream",
    domain: Domain = "sync",
) -> list[Any]:
    """Receive payloads from a stream, and leave it not ready.

    Parameters
    ----------
    count : int
        Number of payloads.
    stalls : Stalls
        Cycles in which the stream is not ready.
    deadline : int
        Most cycles without a transfer, in addition to the longest stall.
    name : str
        Name of the stream, for errors and for the pattern of stalls.
    domain : str or ClockDomain
        Clock domain of the stream.

    Raises
    ------
    ClockDomainError
        If the stream is in another clock domain, or the domain has no clock.
    DeadlineError
    """
    check_stream(port, name)
    payloads: list[Any] = []

    def expected() -> str:
        left = count - len(payloads)
        return f"{left} of {count} transfers" if left > 0 else ""

    options = (count, stalls, deadline, name, domain)
    await _receive(ctx, port, port.payload, payloads.append, expected, *options)
    return payloads


async def send_packets(
    ctx: SimulatorContext,
    port: Stream[Any],
    packets: Iterable[bytes],
    *,
    stalls: Stalls = Stalls.none,
    name: str = "packets_in",
    domain: Domain = "sync",
    deadline: int = SEND_DEADLINE,
) -> None:
    """Send packets on a packet stream, back to back. Parameters are those of :func:`send`.

    Lanes that are not valid carry random bytes, which a receiver has to ignore.
    """
    beats = all_beats(as_packets(packets), check_packet_stream(port, name))
    await send(ctx, port, beats, stalls=stalls, name=name, domain=domain, deadline=deadline)


async def receive_packets(
    ctx: SimulatorContext,
    port: Stream[Any],
    count: int,
    *,
    stalls: Stalls = Stalls.none,
    deadline: int = DEADLINE,
    name: str = "packets_out",
    domain: Domain = "sync",
) -> list[bytes]:
    """Receive packets from a packet stream, and check its rules.

    Parameters are those of :func:`receive`.

    Raises
    ------
    ClockDomainError, DeadlineError
        As for :func:`receive`.
    StreamRuleError
        If a beat breaks rule 5 or 6 of :mod:`firm_hdl.sim.watch`.
    """
    collector = PacketCollector(check_packet_stream(port, name))
    rules = PacketRules(name, collector.bus_bytes)

    def expected() -> str:
        left = count - len(collector.packets)
        begun = f", {len(collector.partial)} bytes of one have come" if collector.partial else ""
        return f"{left} of {count} packets{begun}" if left > 0 else ""

    def take(beat: int) -> None:
        rules.check(collector.beats, beat)
        collector.take(beat)

    bits = Value.cast(port.payload)
    options = (count, stalls, deadline, name, domain)
    await _receive(ctx, port, bits, take, expected, *options)
    return collector.packets


async def receive_statuses(
    ctx: SimulatorContext,
    port: Stream[Any],
    count: int,
    *,
    stalls: Stalls = Stalls.none,
    deadline: int = DEADLINE,
    name: str = "status",
    domain: Domain = "sync",
) -> list[Status]:
    """Receive statuses. Parameters and errors are those of :func:`receive`."""
    check_stream(port, name)
    if not isinstance(port.payload.shape(), enum.EnumMeta):
        shape = port.payload.shape()
        raise TypeError(f"{name!r} must be a stream of statuses, not one of {shape!r}")
    return await receive(
        ctx, port, count, stalls=stalls, deadline=deadline, name=name, domain=domain
    )


async def _receive(
    ctx: SimulatorContext,
    port: Stream[Any],
    payload: Any,
    take: Callable[[Any], object],
    expected: Callable[[], str],
    count: int,
    stalls: Stalls,
    deadline: int,
    name: str,
    domain: Domain,
) -> None:
    """Receive until `expected` returns an empty text; call `take` with each value of `payload`."""
    check_integer("The number to receive", count)
    check_integer("deadline=", deadline)
    if count < 0:
        raise ValueError(f"The number to receive must be at least 0, not {count}")
    check_stalls(stalls, [name])
    check_domain(ctx, {name: port}, domain, sends=False)
    found = stalls_of(stalls, name)
    stalled = found.cycles(name)
    ready = quiet = 0
    while expected():
        if ready == (stall := next(stalled)):
            ready = not stall
            ctx.set(port.ready, ready)
        _, _, valid, value = await ctx.tick(domain).sample(port.valid, payload)
        if valid and ready:
            take(value)
            quiet = 0
        else:
            quiet += 1
        if quiet > deadline + found.longest:
            what = f"No transfer on stream {name!r} in {quiet} cycles"
            raise DeadlineError(f"{what}; outstanding: {expected()}{what_waits(ctx)}")
    ctx.set(port.ready, 0)
