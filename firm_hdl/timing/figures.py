"""The cycles that a converter takes for a packet, found by running its plan.

Cycles are those of the slower converter; see :mod:`firm_hdl.timing.cycles`. The packet with the
most cycles per byte is the result of a search, not of a proof. The search tries short strings and
few elements: their lengths take a step each, and the packet has few bytes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product

from firm_hdl.plan import Payload, Plan, encode
from firm_hdl.plan.yaml import counted
from firm_hdl.timing.cycles import cycles_between, packet_of
from firm_hdl.timing.recovery import Recovery, recovery

__all__ = ["LINE_RATES", "Cost", "Timing", "clock_mhz", "describe", "recovery_text", "timing"]

LINE_RATES = {"100 Mbit/s": 0.1e9, "1 Gbit/s": 1e9, "10 Gbit/s": 10e9}
"""Bits of packets per second, by the usual name of the rate."""

RECOVERY_MHZ = 100
"""The clock rate at which the time of recovery is printed."""

MAX_ELEMENTS = {1: 16, 2: 4}
"""Largest number of elements per loop in the search, by levels of loops."""

MAX_TRANSFERS = 1 << 12
"""Largest number of transfers of a packet in the search. Nested loops soon have more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """Size and cycles of one packet when it is repeated back to back."""

    bytes: int
    beats: int
    steps: int
    cycles: int  # Cycles from one packet to the next.


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """Figures of a plan."""

    bus_bytes: int
    # Number of steps of the plan; each takes one cycle, or one cycle per bus word of a run.
    steps: int
    shortest: Cost  # Cost of the packet with every length 0.
    hardest: Cost  # Cost of the packet with the most cycles per byte among those tried.
    recovery: Recovery  # How long a deserializer is busy with bad packets and with long ones.


def timing(plan: Plan) -> Timing:
    """Compute the figures of a plan."""
    bus = plan.bus_bytes
    shortest = hardest = _cost(plan, 0, 0)
    # In a long packet, short strings are a small part.
    is_short = shortest.bytes < 1 << 14
    if is_short and any(leaf.kind == "length" for leaf in plan.leaves):
        counts = sorted({0, 1, MAX_ELEMENTS.get(plan.levels, 2)})
        # A run takes one cycle for each bus word, so longer runs are not harder.
        for elements, items in product(counts, sorted({0, 1, bus // 2})):
            try:
                cost = _cost(plan, elements, items, MAX_TRANSFERS)
            except _TooLongError:
                continue
            if cost.cycles * hardest.bytes > hardest.cycles * cost.bytes:
                hardest = cost
    return Timing(
        bus_bytes=bus,
        steps=len(plan.steps),
        shortest=shortest,
        hardest=hardest,
        recovery=recovery(plan, shortest.cycles),
    )


class _TooLongError(Exception):
    """A packet has too many transfers for the search."""


def _cost(plan: Plan, elements: int, items: int, most: int | None = None) -> Cost:
    """Compute the cost of a packet by the lengths of its sequences.

    * `elements`: length of each sequence of messages.
    * `items`: length of each string and sequence of primitives.
    * `most`: largest number of transfers of the packet.

    Raises `_TooLongError` if the packet has more than `most` transfers.
    """
    left = most

    def transfers(payload: Payload) -> Iterator[Payload]:
        nonlocal left
        while left is None or left > 0:
            left = None if left is None else left - 1
            yield payload
        raise _TooLongError

    runs = {leaf.path[:-1] for leaf in plan.leaves if leaf.kind == "items"}
    limits = {leaf: length.limit for leaf, length in plan.lengths.items()}
    streams: dict[int, Iterable[Payload]] = {}
    for index, leaf in enumerate(plan.leaves):
        payload: Payload = 0
        if leaf.kind == "length":
            wanted = items if leaf.path[:-1] in runs else elements
            payload = min(wanted, limits.get(index, wanted))
        elif leaf.kind == "items":
            payload = ((0,) * leaf.lanes, False)
        streams[index] = transfers(payload)
    # `last` is never set, which is an error; the serializer still writes all bytes.
    data, _ = encode(plan, streams)
    packet = packet_of(plan, data)
    return Cost(
        bytes=packet.bytes,
        beats=packet.beats,
        steps=len(packet.visits),
        cycles=cycles_between(packet),
    )


def clock_mhz(cost: Cost, bits_per_second: float) -> float:
    """Return the clock rate in MHz that packets like this one need, back to back at a line rate."""
    return bits_per_second / 8 / max(1, cost.bytes) * cost.cycles / 1e6


def describe(name: str, plan: Plan, figures: Timing) -> str:
    """Describe in a few lines the cycles of a converter and the clock that a line rate needs."""
    short, hard = figures.shortest, figures.hardest
    if any(leaf.kind == "length" for leaf in plan.leaves):
        packet = "shortest packet"
        which = "the shortest" if hard is short else _cost_text(hard)
        rows = [(f"of the hardest packets that were tried ({which})", hard)]
        if _has_long(plan):
            long = Cost(bytes=plan.bus_bytes, beats=1, steps=1, cycles=1)
            rows.insert(0, ("of long strings or arrays", long))
    else:
        packet, rows = "every packet", [("of these packets", short)]
    wire = "ROS 1" if plan.wire == "ros1" else "CDR, as in ROS 2"
    table = [("clock that keeps up with a full line", list(LINE_RATES))]
    for what, cost in rows:
        clocks = [f"{clock_mhz(cost, bits):.1f} MHz" for bits in LINE_RATES.values()]
        table.append((f"    {what}", clocks))
    width = max(len(what) for what, _ in table)
    return "\n".join(
        [
            f"{name} ({wire}) on a bus of {counted(plan.bus_bytes, 'byte')} per clock cycle",
            f"    {packet}: {counted(short.bytes, 'byte')} in "
            f"{counted(short.beats, 'beat')} (words of the bus) and "
            f"{counted(short.cycles, 'clock cycle')}",
            *(
                f"    {what.ljust(width)}{''.join(cell.rjust(13) for cell in cells)}"
                for what, cells in table
            ),
        ]
    )


def recovery_text(figures: Timing) -> str:
    """Describe in a line how long a bad packet keeps a deserializer busy."""
    found = figures.recovery
    micros = found.cycles / RECOVERY_MHZ
    time = f"{micros:.2f} us" if micros < 1000 else f"{micros / 1000:.1f} ms"
    return (
        f"    after a damaged packet: ready within {counted(found.cycles, 'cycle')} ({time} at "
        f"{RECOVERY_MHZ} MHz); the longest legal packet takes {found.longest_packet}"
    )


def _has_long(plan: Plan) -> bool:
    """Tell whether a packet can be long: it has a run of variable length."""
    lengths = {leaf.path[:-1] for leaf in plan.leaves if leaf.kind == "length"}
    return any(leaf.kind == "items" and leaf.path[:-1] in lengths for leaf in plan.leaves)


def _cost_text(cost: Cost) -> str:
    beats, cycles = counted(cost.beats, "beat"), counted(cost.cycles, "cycle")
    return f"{counted(cost.bytes, 'byte')}, {beats}, {cycles}"
