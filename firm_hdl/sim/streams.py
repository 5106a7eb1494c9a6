"""Drivers and monitors of single streams, for users' own testbenches.

All are async functions; await them in a testbench of `amaranth.sim`. To run functions at the same
time, use separate testbenches. Each function starts in the current cycle and returns right after
the clock edge of its last transfer. Payloads are the values that `ctx.set` and `ctx.get` use for
the stream.

The receiving side checks the deadline. If no transfer comes for that many cycles, it raises a
`DeadlineError`, which names the transfers that were still expected.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Value
from amaranth.lib import stream
from amaranth.sim import SimulatorContext

from firm_hdl.gateware.signatures import Status
from firm_hdl.sim.bench import DeadlineError
from firm_hdl.sim.payloads import PacketCollector, all_beats
from firm_hdl.sim.stalls import Stalls
from firm_hdl.sim.watch import PacketRules

__all__ = [
    "receive",
    "receive_packets",
    "receive_statuses",
    "send",
    "send_packets",
]

DEADLINE = 1000


async def send(
    ctx: SimulatorContext,
    port: stream.Interface,
    payloads: Iterable[Any],
    *,
    stalls: Stalls = Stalls.none,
    name: str = "stream",
) -> None:
    """Send payloads on a stream, and leave it idle.

    Parameters
    ----------
    payloads : iterable
        Payloads. An integer is interpreted as the bits of a payload.
    stalls : Stalls
        Cycles in which the next payload is not offered.
    name : str
        Name of the stream, for the pattern of stalls.
    """
    stalled = stalls.cycles(name)
    bits = Value.cast(port.payload)
    for payload in payloads:
        while next(stalled):
            await ctx.tick()
        if isinstance(payload, int):
            ctx.set(bits, payload)
        else:
            ctx.set(port.payload, payload)
        ctx.set(port.valid, 1)
        # Do not use `until`: its generator raises if the simulation ends with an error before it.
        taken = 0
        while not taken:
            _, _, taken = await ctx.tick().sample(port.ready)
        ctx.set(port.valid, 0)


async def receive(
    ctx: SimulatorContext,
    port: stream.Interface,
    count: int,
    *,
    stalls: Stalls = Stalls.none,
    deadline: int = DEADLINE,
    name: str = "stream",
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

    Raises
    ------
    DeadlineError
    """
    payloads: list[Any] = []

    def expected() -> str:
        left = count - len(payloads)
        return f"{left} of {count} transfers" if left > 0 else ""

    receiver = _Receiver(
        port=port, payload=port.payload, stalls=stalls, deadline=deadline, name=name
    )
    await receiver.run(ctx, payloads.append, expected)
    return payloads


async def send_packets(
    ctx: SimulatorContext,
    port: stream.Interface,
    packets: Iterable[bytes],
    *,
    stalls: Stalls = Stalls.none,
    name: str = "packets_in",
) -> None:
    """Send packets on a packet stream, back to back. Parameters are those of :func:`send`.

    Lanes that are not valid carry random bytes, which a receiver has to ignore.
    """
    beats: Iterator[int] = all_beats(packets, len(port.payload.data))
    await send(ctx, port, beats, stalls=stalls, name=name)


async def receive_packets(
    ctx: SimulatorContext,
    port: stream.Interface,
    count: int,
    *,
    stalls: Stalls = Stalls.none,
    deadline: int = DEADLINE,
    name: str = "packets_out",
) -> list[bytes]:
    """Receive packets from a packet stream, and check its rules.

    Parameters are those of :func:`receive`.

    Raises
    ------
    DeadlineError
    StreamRuleError
        If a beat breaks rule 5 or 6 of :mod:`firm_hdl.sim.watch`.
    """
    collector = PacketCollector(len(port.payload.data))
    rules = PacketRules(name, collector.bus_bytes)

    def expected() -> str:
        left = count - len(collector.packets)
        begun = f", {len(collector.partial)} bytes of one have come" if collector.partial else ""
        return f"{left} of {count} packets{begun}" if left > 0 else ""

    def take(beat: int) -> None:
        rules.check(collector.beats, beat)
        collector.take(beat)

    bits = Value.cast(port.payload)
    receiver = _Receiver(port=port, payload=bits, stalls=stalls, deadline=deadline, name=name)
    await receiver.run(ctx, take, expected)
    return collector.packets


async def receive_statuses(
    ctx: SimulatorContext,
    port: stream.Interface,
    count: int,
    *,
    stalls: Stalls = Stalls.none,
    deadline: int = DEADLINE,
    name: str = "status",
) -> list[Status]:
    """Receive statuses. Parameters and errors are those of :func:`receive`."""
    return await receive(ctx, port, count, stalls=stalls, deadline=deadline, name=name)


@dataclass(slots=True, kw_only=True)
class _Receiver:
    """A stream that a testbench receives from.

    Attributes
    ----------
    payload : value
        What to read at each transfer.
    stalls, deadline, name
        As for :func:`receive`.
    """

    port: stream.Interface
    payload: Any
    stalls: Stalls
    deadline: int
    name: str

    async def run(
        self, ctx: SimulatorContext, take: Callable[[Any], object], expected: Callable[[], str]
    ) -> None:
        """Receive until `expected` returns an empty text; call `take` with each payload."""
        stalled = self.stalls.cycles(self.name)
        ready = quiet = 0
        while expected():
            if ready == (stall := next(stalled)):
                ready = not stall
                ctx.set(self.port.ready, ready)
            _, _, valid, payload = await ctx.tick().sample(self.port.valid, self.payload)
            if valid and ready:
                take(payload)
                quiet = 0
            else:
                quiet += 1
            if quiet > self.deadline + self.stalls.longest:
                what = f"No transfer on stream {self.name!r} in {quiet} cycles"
                raise DeadlineError(f"{what}; outstanding: {expected()}")
        ctx.set(self.port.ready, 0)
