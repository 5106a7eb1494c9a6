"""Stalls: reproducible, different per stream, and of the promised lengths."""

from __future__ import annotations

from itertools import groupby, islice

import pytest

from firm_hdl.sim import Stalls
from firm_hdl.sim.stalls import stalls_of


def first(stalls: Stalls, name: str, count: int = 2000) -> list[bool]:
    return list(islice(stalls.cycles(name), count))


def test_same_record_and_name_give_the_same_pattern():
    assert first(Stalls(0.3, 1, 4, seed=7), "a") == first(Stalls(0.3, 1, 4, seed=7), "a")


def test_other_names_and_other_seeds_give_other_patterns():
    patterns = [
        first(Stalls(0.3, 1, 4, seed=7), "a"),
        first(Stalls(0.3, 1, 4, seed=7), "b"),
        first(Stalls(0.3, 1, 4, seed=8), "a"),
    ]
    assert all(patterns.count(pattern) == 1 for pattern in patterns)


def test_pattern_of_a_seed_is_the_same_in_every_release():
    bits = "".join("01"[stalled] for stalled in first(Stalls(0.3, 1, 3, seed=1), "a", 24))
    assert bits == "010000100110000001110011"


@pytest.mark.parametrize("probability", [0.0, 0.1, 0.5, 1.0])
def test_stalls_are_as_long_as_promised_and_let_through_in_between(probability):
    stalls = Stalls(probability, 2, 5, seed=3)
    runs = [(k, len(list(g))) for k, g in groupby(first(stalls, "x"))][:-1]
    lengths = {length for stalled, length in runs if stalled}
    assert lengths <= {2, 3, 4, 5}
    assert bool(lengths) == (probability > 0) == bool(stalls)
    assert stalls.longest == (5 if probability else 0)


def test_bits_repeat_and_zero_stalls():
    stalls = Stalls.bits("1101")
    assert first(stalls, "any", 8) == [False, False, True, False] * 2
    assert stalls and not Stalls.bits("11") and not Stalls.none
    assert Stalls.bits("0110").longest == 2


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        ({"probability": 1.5}, r"^Probability must be in 0\.\.1, not 1\.5$"),
        (
            {"min_cycles": 3, "max_cycles": 2},
            r"^Lengths must be 1 <= min_cycles <= max_cycles, not 3 and 2$",
        ),
        ({"min_cycles": 0}, r"^Lengths must be 1 <= .* <= max_cycles, not 0 and 1$"),
        ({"min_cycles": 0, "max_cycles": 0}, r", not 0 and 0$"),
        ({"probability": -0.1}, r"^Probability must be in 0\.\.1, not -0\.1$"),
        ({"pattern": "12"}, r"^Pattern must consist of 0 and 1, not '12'$"),
        ({"pattern": "00"}, r"^Pattern '00' would stall for ever$"),
    ],
)
def test_wrong_parameters_are_refused(arguments, error):
    with pytest.raises(ValueError, match=error):
        Stalls(**arguments)


def test_empty_bits_are_refused():
    with pytest.raises(ValueError, match=r"^Pattern must not be empty$"):
        Stalls.bits("")


def test_longest_name_counts():
    header, message = Stalls.bits("10"), Stalls.bits("110")
    plan = {"message": message, "message.header": header}
    assert stalls_of(plan, "message.header.stamp.sec") is header
    assert stalls_of(plan, "message.headers") is message
    assert stalls_of(plan, "status") is Stalls.none
    assert stalls_of(header, "status") is header
    assert stalls_of(None, "status") is Stalls.none
