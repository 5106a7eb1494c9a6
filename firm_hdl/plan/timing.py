"""What a converter costs in cycles, found by running its plan.

A packet takes as long as its beats or its steps, whichever are more. Which packets are the
hardest for their size is searched, not proved: short strings and few elements cost a step each and
bring few bytes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product

from firm_hdl.plan import Payload, Plan, decode, encode
from firm_hdl.plan.geometry import geometry

__all__ = ["LINE_RATES", "Cost", "Timing", "clock_mhz", "describe", "timing"]

LINE_RATES = {"100 Mbit/s": 0.1e9, "1 Gbit/s": 1e9, "10 Gbit/s": 10e9}
"""Bits of packets per second, by what people call that."""

MANY_ELEMENTS = {1: 16, 2: 4}
"""Most elements per loop that the search tries, by depth of loops: packets grow exponentially."""

MOST_TRANSFERS = 1 << 12
"""Of a packet that the search tries. Loops in loops soon have more, with few elements each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What one packet takes when packets come back to back."""

    bytes: int
    beats: int
    steps: int

    @property
    def cycles(self) -> int:
        """Cycles from one packet to the next."""
        return max(self.beats, self.steps)


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """Figures of a plan.

    Attributes
    ----------
    bus_bytes : int
    steps : int
        Of the plan; each is one cycle, or one cycle per bus word of a run.
    window_bytes : int
        Most bytes that one cycle takes.
    window_beats : int
        Most beats that these bytes touch.
    shortest : Cost
        Of the packet with every length 0.
    hardest : Cost
        Of the packet with the most cycles per byte among those tried.
    """

    bus_bytes: int
    steps: int
    window_bytes: int
    window_beats: int
    shortest: Cost
    hardest: Cost


def timing(plan: Plan) -> Timing:
    """Work out the figures of a plan."""
    bus = plan.bus_bytes
    sizes = geometry(plan)
    shortest = hardest = _cost(plan, 0, 0)
    # Of a long packet, short strings are a small part.
    is_short = shortest.bytes < 1 << 14
    if is_short and any(leaf.kind == "length" for leaf in plan.leaves):
        counts = sorted({0, 1, MANY_ELEMENTS.get(plan.levels, 2)})
        for elements, items in product(counts, sorted({0, 1, bus // 2, bus, bus + 1})):
            try:
                cost = _cost(plan, elements, items, MOST_TRANSFERS)
            except _TooLongError:
                continue
            if cost.cycles * hardest.bytes > hardest.cycles * cost.bytes:
                hardest = cost
    return Timing(
        bus_bytes=bus,
        steps=len(plan.steps),
        window_bytes=sizes.window_bytes,
        window_beats=sizes.window_beats,
        shortest=shortest,
        hardest=hardest,
    )


class _TooLongError(Exception):
    """A packet has more transfers than anybody wants to wait for."""


def _cost(plan: Plan, elements: int, items: int, most: int | None = None) -> Cost:
    """Cost a packet whose sequences of messages and of primitives have lengths as given.

    Raises
    ------
    _TooLongError
        If it has more than `most` transfers.
    """
    left = most

    def transfers(payload: Payload) -> Iterator[Payload]:
        nonlocal left
        while left is None or left > 0:
            left = None if left is None else left - 1
            yield payload
        raise _TooLongError

    runs = {leaf.path[:-1] for leaf in plan.leaves if leaf.kind == "items"}
    limits = {leaf: begin.limit for leaf, begin in plan.counted.items()}
    streams: dict[int, Iterable[Payload]] = {}
    for index, leaf in enumerate(plan.leaves):
        payload: Payload = 0
        if leaf.kind == "length":
            wanted = items if leaf.path[:-1] in runs else elements
            payload = min(wanted, limits.get(index, wanted))
        elif leaf.kind == "items":
            payload = ((0,) * leaf.lanes, False)
        streams[index] = transfers(payload)
    # That `last` is never set is an error that the serializer marks; the bytes are those promised.
    packet, _ = encode(plan, streams)
    return Cost(
        bytes=len(packet),
        beats=max(1, -(-len(packet) // plan.bus_bytes)),
        steps=len(decode(plan, packet).steps),
    )


def clock_mhz(cost: Cost, bits_per_second: float) -> float:
    """Return the clock that packets like this one need, back to back at a line rate."""
    return bits_per_second / 8 / max(1, cost.bytes) * cost.cycles / 1e6


def describe(name: str, plan: Plan, figures: Timing) -> str:
    """Say in a few lines what a converter takes and which clock a line rate needs."""
    short, hard = figures.shortest, figures.hardest
    varies = any(leaf.kind == "length" for leaf in plan.leaves)
    rows = [("every packet", short)]
    if varies:
        long = Cost(bytes=plan.bus_bytes, beats=1, steps=1)
        rows = [("long strings or arrays", long)] if _has_long(plan) else []
        which = "the shortest" if hard is short else _cost_text(hard)
        rows.append((f"the hardest packet tried ({which})", hard))
    lines = [
        f"{name} on {plan.wire}, {8 * plan.bus_bytes}-bit bus: {_count(figures.steps, 'step')}; "
        f"{'shortest ' if varies else ''}packet {_cost_text(short)}"
    ]
    for what, cost in rows:
        clocks = ", ".join(
            f"{rate} {clock_mhz(cost, bits):.1f} MHz" for rate, bits in LINE_RATES.items()
        )
        lines.append(f"    clock for {what}: {clocks}")
    return "\n".join(lines)


def _has_long(plan: Plan) -> bool:
    """Whether a packet can be long: runs of any number of items, which pass a bus word a cycle."""
    lengths = {leaf.path[:-1] for leaf in plan.leaves if leaf.kind == "length"}
    return any(leaf.kind == "items" and leaf.path[:-1] in lengths for leaf in plan.leaves)


def _cost_text(cost: Cost) -> str:
    beats, cycles = _count(cost.beats, "beat"), _count(cost.cycles, "cycle")
    return f"{_count(cost.bytes, 'byte')}, {beats}, {cycles}"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
