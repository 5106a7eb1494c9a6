"""What acceptance does to packets and streams: damage, and stalls."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence

from firm_hdl.plan import Plan
from firm_hdl.sim.stalls import Stalls
from firm_hdl.verify.cases import Case

__all__ = ["broken_packets", "stalls_for"]


def stalls_for(seed: str | float) -> Stalls:
    """Draw stalls: rare and long, frequent and short, or in between."""
    rng = random.Random(seed)
    probability, most = rng.choice(((0.05, 30), (0.2, 6), (0.5, 2), (0.8, 1), (0.3, 12)))
    return Stalls(probability, 1, most, seed=rng.getrandbits(32))


def broken_packets(plan: Plan, cases: Sequence[Case], rng: random.Random) -> Iterator[bytes]:
    """Yield packets that are cut, too long, just not too long, or of a wrong representation."""
    for case in cases:
        packet = case.packet
        kind = rng.choice(("cut", "cut", "long", "slack", "header"))
        if kind == "header" and plan.header_bytes:
            yield bytes((0, rng.choice((0, 2, 3, 7)))) + packet[2:]
        elif kind == "cut" and packet:
            yield packet[: rng.randrange(len(packet))]
        elif kind == "long":
            yield packet + rng.randbytes(plan.slack_bytes + rng.randint(1, 2 * plan.bus_bytes))
        else:
            # As many as are allowed, or one more.
            yield packet + rng.randbytes(plan.slack_bytes + rng.randint(0, 1))
