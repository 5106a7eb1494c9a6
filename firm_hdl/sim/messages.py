"""Whole messages on message interfaces, for users' own testbenches.

A :class:`MessagePort` has the stream of each leaf. All leaves transfer independently. A sending
leaf offers its transfers as soon as it can. A receiving leaf is ready only while more of its
transfers are known to follow. The lengths that have arrived determine the number of transfers.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Cat, Value
from amaranth.lib import stream, wiring
from amaranth.sim import SimulatorContext

from firm_hdl.gateware.members import member_tree
from firm_hdl.gateware.signatures import MessageSignature, leaf_shape, leaf_streams
from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan, build_plan
from firm_hdl.sim.bench import DeadlineError
from firm_hdl.sim.design import Domain, check_domain, what_waits
from firm_hdl.sim.harness import leaf_name
from firm_hdl.sim.payloads import decoder_of, encoder_of
from firm_hdl.sim.stalls import StallPlan, check_stalls, stalls_of
from firm_hdl.sim.streams import SEND_DEADLINE
from firm_hdl.sim.transfers import PendingTransfers, checked_transfers, transfer_table
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.wire import Wire, lay_out

__all__ = ["MessagePort"]


@dataclass(slots=True)
class _LeafSource:
    """A leaf that has transfers to send."""

    name: str
    port: stream.Interface
    bits: Value
    payloads: Iterator[int]
    stalled: Iterator[bool]
    offered: bool = False


class MessagePort:
    """A message interface as a testbench drives it.

    Parameters
    ----------
    interface : interface of a MessageSignature
        Such as ``rx.message`` of a converter.
    message : Message
    bus_bytes : int
        As for the signature.
    wire : "ros1", "cdr" or None
        As for the signature.
    domain : str or ClockDomain
        Clock domain of the interface.

    Attributes
    ----------
    plan : Plan
        Its `leaves` are in the order of their indices.
    streams : dict of int to stream.Interface

    Raises
    ------
    TypeError, ValueError
        If the interface is that of another message, bus width or wire format.
    """

    def __init__(
        self,
        interface: Any,
        message: Message,
        *,
        bus_bytes: int = 8,
        wire: Wire | None = None,
        domain: Domain = "sync",
    ):
        layout = lay_out(message, wire)
        self.domain = domain
        self.message = message
        self.plan = build_plan(layout, bus_bytes=bus_bytes, max_message_bytes=(1 << 32) - 1)
        self.streams = _streams_of(interface, self.plan, message)
        self._table = transfer_table(self.plan, message)
        self._encoders = [encoder_of(leaf) for leaf in self.plan.leaves]
        self._decoders = [decoder_of(leaf) for leaf in self.plan.leaves]
        self._names = [leaf_name(self.plan, leaf) for leaf in self.streams]

    async def send(self, ctx: SimulatorContext, value: object, *, stalls: StallPlan = None) -> None:
        """Send one message.

        Parameters
        ----------
        value : mapping or object
            A dict by field names, or an object with the fields as attributes, as in rosbags.
        stalls : Stalls, mapping or None
            Cycles in which leaves do not offer their next transfer, by ``message.`` and the leaf's
            path.

        Raises
        ------
        TypeError, ValueError
            If the value is none of the message.
        ClockDomainError
            If the interface is in another clock domain, or the domain has no clock.
        DeadlineError
            If leaves are not taken for 10,000 cycles; the text names them.
        """
        transfers = to_transfers(self.plan, self.message, value)
        await self.send_transfers(ctx, transfers, stalls=stalls)

    async def receive(
        self, ctx: SimulatorContext, *, stalls: StallPlan = None, deadline: int = 1000
    ) -> dict[str, Any]:
        """Receive one message, as a dict.

        Parameters
        ----------
        stalls : Stalls, mapping or None
            Cycles in which leaves are not ready, by ``message.`` and the leaf's path.
        deadline : int
            Most cycles without any transfer, in addition to the longest stall.

        Raises
        ------
        ClockDomainError
            If the interface is in another clock domain, or the domain has no clock.
        DeadlineError
            If expected transfers do not come; the text names their leaves.
        """
        transfers = await self.receive_transfers(ctx, stalls=stalls, deadline=deadline)
        return from_transfers(self.plan, self.message, transfers)

    async def send_transfers(
        self,
        ctx: SimulatorContext,
        transfers: Mapping[int, list[Payload]],
        *,
        stalls: StallPlan = None,
    ) -> None:
        """Send transfers given by leaf until all are taken; they may be invalid on purpose."""
        self._check(ctx, stalls, sends=True)
        sources = []
        for leaf, payloads in checked_transfers(self.plan, transfers).items():
            port, name = self.streams[leaf], self._names[leaf]
            bits = map(self._encoders[leaf], payloads)
            stalled = stalls_of(stalls, name).cycles(name)
            sources.append(_LeafSource(name, port, Value.cast(port.payload), bits, stalled))
        sources = [source for source in sources if _offer(ctx, source)]
        quiet = 0
        while sources:
            readies = Cat(source.port.ready for source in sources)
            _, _, ready = await ctx.tick(self.domain).sample(readies)
            quiet += 1
            for number, source in enumerate(sources):
                if source.offered and ready >> number & 1:
                    ctx.set(source.port.valid, 0)
                    source.offered, quiet = False, 0
            if quiet > SEND_DEADLINE:
                left = ", ".join(source.name for source in sources)
                what = f"No transfer of a message in {quiet} cycles; not taken: {left}"
                raise DeadlineError(f"{what}{what_waits(ctx)}")
            sources = [source for source in sources if source.offered or _offer(ctx, source)]

    async def receive_transfers(
        self, ctx: SimulatorContext, *, stalls: StallPlan = None, deadline: int = 1000
    ) -> dict[int, list[Payload]]:
        """Receive the transfers of one message. Parameters and errors as for :meth:`receive`."""
        self._check(ctx, stalls, sends=False)
        pending = PendingTransfers(self._table)
        got: dict[int, list[Payload]] = {leaf: [] for leaf in self.streams}
        kinds = [stalls_of(stalls, name) for name in self._names]
        patterns = [kind.cycles(name) for kind, name in zip(kinds, self._names, strict=True)]
        deadline += max(kind.longest for kind in kinds)
        ports = list(self.streams.values())
        valids = Cat(port.valid for port in ports)
        payloads = [Value.cast(port.payload) for port in ports]
        ready = quiet = 0
        while True:
            ready = self._set_ready(ctx, pending, patterns, ready)
            if not pending.counts:
                return got
            _, _, valid, *bits = await ctx.tick(self.domain).sample(valids, *payloads)
            quiet = 0 if valid & ready else quiet + 1
            for leaf in got:
                if (valid & ready) >> leaf & 1:
                    payload = self._decoders[leaf](bits[leaf])
                    got[leaf].append(payload)
                    pending.take(leaf, payload)
            if quiet > deadline:
                left = (f"{self._names[leaf]} ({n})" for leaf, n in sorted(pending.counts.items()))
                what = f"No transfer of a message in {quiet} cycles; outstanding"
                raise DeadlineError(f"{what}: {', '.join(left)}{what_waits(ctx)}")

    def _check(self, ctx: SimulatorContext, stalls: StallPlan, *, sends: bool) -> None:
        check_stalls(stalls, self._names)
        streams = dict(zip(self._names, self.streams.values(), strict=True))
        check_domain(ctx, streams, self.domain, sends=sends)

    def _set_ready(
        self,
        ctx: SimulatorContext,
        pending: PendingTransfers,
        patterns: list[Iterator[bool]],
        before: int,
    ) -> int:
        """Make the leaves with pending transfers ready; return them as a bit mask."""
        ready = 0
        for leaf in pending.counts:
            if not next(patterns[leaf]):
                ready |= 1 << leaf
        for leaf, port in self.streams.items():
            if (ready ^ before) >> leaf & 1:
                ctx.set(port.ready, ready >> leaf & 1)
        return ready


def _offer(ctx: SimulatorContext, source: _LeafSource) -> bool:
    """Offer the next transfer of a leaf unless it is stalled; return `False` after the last one."""
    if next(source.stalled):
        return True
    payload = next(source.payloads, None)
    if payload is None:
        return False
    ctx.set(source.bits, payload)
    ctx.set(source.port.valid, 1)
    source.offered = True
    return True


def _streams_of(interface: Any, plan: Plan, message: Message) -> dict[int, stream.Interface]:
    """Return the streams of an interface by leaf; each has the shape that the plan gives it."""
    signature = getattr(interface, "signature", None)
    if not isinstance(signature, wiring.Signature):
        raise TypeError(
            f"A message port needs a message interface, such as rx.message, not {interface!r}"
        )
    wanted = f"{message.name} with bus_bytes={plan.bus_bytes} and wire={plan.wire!r}"
    if isinstance(signature, MessageSignature):
        found = (
            f"{signature.message.name} with bus_bytes={signature.bus_bytes} "
            f"and wire={signature.wire!r}"
        )
        if found != wanted:
            raise ValueError(f"The interface is that of {found}, not of {wanted}")
    tree = member_tree(leaf.path for leaf in plan.leaves)
    try:
        streams = leaf_streams(interface, tree)
    except AttributeError as error:
        raise ValueError(f"The interface is not that of {wanted}: {error}") from None
    for leaf, port in streams.items():
        if port.payload.shape() != leaf_shape(plan.leaves[leaf]):
            raise ValueError(
                f"The interface is not that of {wanted}: {plan.leaves[leaf]} has the shape "
                f"{port.payload.shape()!r}"
            )
    return streams
