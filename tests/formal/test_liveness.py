"""Claims that something moves in time: the bug of each one's twin breaks it in a short run."""

from __future__ import annotations

import random

import pytest

from firm_hdl.formal.blocks import all_studies
from firm_hdl.formal.bugs import seeded
from tests.formal.play import play
from tests.formal.test_played import ASSUMED, STUDIES

# Cycles in which everything waits at random, then offers all it can, and then takes what is left.
WAITS, OFFERS, TAKES = 24, 20, 20


def steps(name, run, widths):
    """Yield random inputs, with waits at first, and none later on."""
    source = random.Random(f"{name} {run}")

    def beat(bits):
        # The highest bit is that of the last beat of a packet; below it, there is a count.
        number = source.getrandbits(bits - 1) | (source.random() < 0.25) << bits - 1
        # In every other run, bytes are 0 or 1, as headers and lengths are.
        mask = ((1 << bits) - 1) >> 8 * (bits // 8) << 8 * (bits // 8)
        return number & (mask | int("01" * (bits // 8), 16)) if run % 2 else number

    def value(signal, bits, cycle):
        if signal in ASSUMED:
            return ASSUMED[signal]
        if signal.endswith(("valid", "ready")):
            is_steady = cycle >= WAITS
            goes_on = signal.endswith("ready") or cycle < WAITS + OFFERS
            return goes_on if is_steady else int(source.random() < 0.8)
        if signal.endswith("mark"):
            return int(source.random() < 0.1)
        return beat(bits) if signal.endswith("choice") and bits > 8 else source.getrandbits(bits)

    for cycle in range(WAITS + OFFERS + TAKES):
        yield {signal: int(value(signal, bits, cycle)) for signal, bits in widths.items()}


# A record view is never to wait at all, which is no claim about time.
LIVE = [
    (study.name, claim.name)
    for study in all_studies()
    for claim in study.claims
    if claim.name.endswith((" moves", " in time")) and not study.name.startswith("record-")
]


# Other sizes of blocks of which one is played anyway, by the same claims.
SIZES = ("deserializer-joyfeedback-lyrical-4", "deserializer-time-lyrical-8", "gate-bool")
SIZES += ("width-8-2", "width-2-2")


@pytest.mark.parametrize(
    ("name", "claim"),
    [pytest.param(*each, marks=[pytest.mark.thorough] * (each[0] in SIZES)) for each in LIVE],
)
def test_what_never_moves_breaks_its_claim(name, claim):
    study = STUDIES[name]
    (bug,) = (each.bug for each in study.claims if each.name == claim)
    with seeded([bug]):
        # Most bugs are found by the first run.
        assert any(
            play(study.build, lambda widths, run=run: steps(name, run, widths))[0][claim]
            for run in range(12)
        )


def test_claims_of_all_kinds_of_blocks_are_asked():
    """No names at all would be no failure of the test above."""
    assert len(LIVE) > 30
    assert {claim.rpartition(" ")[2] for _, claim in LIVE} == {"moves", "time"}
