"""Scales: ticks are round figures, in order, inside the picture."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.drawing.svg import Scale, number, seconds, spread

POSITIVE = st.floats(min_value=1e-6, max_value=1e9)


@given(st.lists(POSITIVE, min_size=1))
def test_values_and_ticks_are_inside(values):
    scale = Scale.logarithmic(values, 10, 200)
    for value in values:
        assert 10 <= scale(value) <= 200
    ticks = scale.ticks()
    assert 1 <= len(ticks) <= 12 and ticks == sorted(set(ticks))
    assert all(10 <= scale(tick) <= 200 for tick in ticks)


@given(POSITIVE, POSITIVE)
def test_larger_values_are_further_on(one, other):
    scale = Scale.logarithmic([one, other], 200, 10)
    assert (scale(one) - scale(other)) * (one - other) <= 0


@pytest.mark.parametrize("values", [[], [0], [-1, 0]])
def test_values_without_a_logarithm_are_left_out(values):
    scale = Scale.logarithmic([*values, 0.2, 30], 0, 100)
    assert (scale.low, scale.high) == (0.2, 50)
    assert scale(0) == scale(0.2) == 0
    assert Scale.logarithmic(values, 0, 100).low == 1


def test_logarithms_are_even():
    scale = Scale.logarithmic([0.01, 100], 0, 400)
    assert [scale(value) for value in (0.01, 0.1, 1, 10, 100)] == [0, 100, 200, 300, 400]
    assert scale.ticks() == pytest.approx([0.01, 0.1, 1, 10, 100])


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"),
        (3, "3"),
        (12345.6, "12,346"),
        (0.12345, "0.123"),
        (1e-7, "1.0e-07"),
        (math.nan, "-"),
    ],
)
def test_numbers(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0 s"),
        (2e-6, "2 µs"),
        (0.0123, "12.3 ms"),
        (1.5, "1.5 s"),
        (119.4, "119 s"),
        (150, "2 min 30 s"),
        (7500, "2 h 5 min"),
    ],
)
def test_times_have_units_that_suit(value, text):
    assert seconds(value) == text


def test_neighbours_are_spread():
    values = [spread(index) for index in range(50)]
    assert all(0 <= value < 1 for value in values)
    assert min(abs(a - b) for a, b in pairwise(values)) > 0.3


@pytest.mark.parametrize(
    ("values", "high"),
    [
        *(([], 1), ([0.0], 1), ([1.0], 1), ([156.25, 3], 200), ([2057, 2930], 3000), ([76.0], 100)),
        *(([12.0], 15), ([0.22], 0.25), ([31], 40), ([41], 50), ([5.1], 7.5), ([150], 150)),
    ],
)
def test_linear_scales_go_from_zero_to_a_round_figure(values, high):
    scale = Scale.linear(values, 10, 110)
    assert (scale.low, scale.high, scale.is_log) == (0, high, False)
    assert (scale(0), scale(high)) == (10, 110)
    assert len(scale.ticks()) == 6
