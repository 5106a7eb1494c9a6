"""Damaged packets and stalled streams for TS3."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence

from firm_hdl.cases.make import Case
from firm_hdl.plan import Plan, decode
from firm_hdl.sim.stalls import Stalls

__all__ = ["DAMAGES", "broken_and_good", "broken_packets", "stalls_for"]

MOST_STEPS = 500
"""The most steps of a damaged packet, in addition to twice the beats of the intact one."""


def stalls_for(seed: str | float) -> Stalls:
    """Draw stalls: rare and long, frequent and short, or in between."""
    rng = random.Random(seed)
    probability, most = rng.choice(((0.05, 30), (0.2, 6), (0.5, 2), (0.8, 1), (0.3, 12)))
    return Stalls(probability, 1, most, seed=rng.getrandbits(32))


def broken_and_good(
    plan: Plan, cases: Sequence[Case], rng: random.Random, room: int | None = None
) -> list[bytes]:
    """Return damaged packets of a few cases, each followed by a good one.

    * `room`: the size to which damaged packets are cut; `None`: they are not.
    """
    sample = list(cases[:: max(1, len(cases) // len(DAMAGES))])
    broken = [packet[:room] for packet in broken_packets(plan, sample, rng)]
    return [each for pair in zip(broken, (c.packet for c in sample), strict=True) for each in pair]


def broken_packets(plan: Plan, cases: Sequence[Case], rng: random.Random) -> Iterator[bytes]:
    """Yield a damaged packet for each case. All kinds of damage take turns, in random order."""
    kinds = rng.sample(DAMAGES, len(DAMAGES))
    for number, case in enumerate(cases):
        packet = kinds[number % len(kinds)](plan, case.packet, rng)
        # A damaged length may stand for many items, which take long to simulate.
        steps = len(decode(plan, packet).steps)
        if steps > MOST_STEPS + 2 * len(case.packet) // plan.bus_bytes:
            packet = _cut(plan, case.packet, rng)
        yield packet


# Each kind of damage takes the plan, the packet, and the random numbers.


def _cut(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    return packet[: rng.randrange(len(packet))] if packet else _longer(plan, packet, rng)


def _shorter(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    """Remove only a few bytes at the end: one, two, or as many as a beat has."""
    return packet[: -rng.choice((1, 1, 2, plan.bus_bytes))]


def _longer(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    return packet + rng.randbytes(plan.max_trailing_bytes + rng.randint(1, 4 * plan.bus_bytes))


def _trailing(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    """Add as many bytes as are allowed, or one more."""
    return packet + rng.randbytes(plan.max_trailing_bytes + rng.randint(0, 1))


def _header(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    """Change the representation identifier, in either of its bytes. The options are random."""
    if not plan.header_bytes:
        return _longer(plan, packet, rng)
    name = rng.choice((b"\0\0", b"\0\2", b"\0\3", b"\0\7", b"\1\1", b"\x80\1", b"\1\0"))
    return name + rng.randbytes(2) + packet[plan.header_bytes :]


def _change(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    """Change a few bytes, which may be bytes of lengths and terminators."""
    changed = bytearray(packet)
    for _ in range(rng.choice((1, 1, 2, 6)) if len(packet) > plan.header_bytes else 0):
        at = rng.randrange(plan.header_bytes, len(packet))
        changed[at] = rng.choice((0, 1, 2, 0x7F, 0x80, 0xFF, rng.randrange(256)))
    return bytes(changed)


def _fill(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    """Overwrite some bytes in a row with zeros, ones, or random bits."""
    if len(packet) <= plan.header_bytes:
        return _longer(plan, packet, rng)
    at = rng.randrange(plan.header_bytes, len(packet))
    end = min(len(packet), at + rng.randint(2, 2 * plan.bus_bytes + 2))
    filled = rng.choice((bytes(end - at), b"\xff" * (end - at), rng.randbytes(end - at)))
    return packet[:at] + filled + packet[end:]


def _change_and_cut(plan: Plan, packet: bytes, rng: random.Random) -> bytes:
    return _cut(plan, _change(plan, packet, rng), rng)


DAMAGES: tuple[Callable[[Plan, bytes, random.Random], bytes], ...] = (
    _cut,
    _shorter,
    _longer,
    _trailing,
    _header,
    _change,
    _fill,
    _change_and_cut,
)
