"""Scales and labels: ticks are round figures, in order, inside the picture."""

from __future__ import annotations

import math

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
    ("values", "ends", "ticks"),
    [
        ([1, 100], (1, 100), [1, 2, 5, 10, 20, 50, 100]),
        ([3, 70], (2, 100), [2, 5, 10, 20, 50, 100]),
        ([5, 5], (5, 50), [5, 10, 20, 50]),
        ([1, 1000], (1, 1000), [1, 10, 100, 1000]),
        ([1, 1e6], (1, 1e6), [10.0**n for n in range(7)]),
        ([1, 1e7], (1, 1e7), [1, 1e2, 1e4, 1e6]),
        ([0, -2, 1, 10], (1, 10), [1, 2, 5, 10]),
    ],
)
def test_scales_end_at_round_figures_and_have_a_few_more(values, ends, ticks):
    scale = Scale.logarithmic(values, 0, 100)
    assert (scale.low, scale.high) == pytest.approx(ends)
    assert scale.ticks() == pytest.approx(ticks)
    assert (scale(scale.low), scale(scale.high)) == (0, 100)


def test_a_linear_scale_has_fifths():
    assert Scale(0, 1, 0, 100).ticks() == pytest.approx([0, 0.2, 0.4, 0.6, 0.8, 1])
    assert Scale(-5, 5, 100, 0).ticks() == pytest.approx([-5, -3, -1, 1, 3, 5])
    assert [Scale(-5, 5, 100, 0)(value) for value in (-5, 0, 5)] == [100, 50, 0]
    # A tenth of a pixel is enough.
    assert [Scale(0, 3, 0, 100)(value) for value in (1, 2)] == [33.3, 66.7]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"),
        (3, "3"),
        (0.12345, "0.123"),
        (1e-7, "1.0e-07"),
        (999.4, "999"),
        (999.5, "1.0e+03"),
        (1000.5, "1,000"),
        (1e15, "1,000,000,000,000,000"),
        (-0.5, "-0.5"),
        (-1234.6, "-1,235"),
        (math.inf, "-"),
        (math.nan, "-"),
    ],
)
def test_numbers_have_three_digits_that_matter(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (-1, "0 s"),
        (2e-6, "2 µs"),
        (0.000999, "999 µs"),
        (0.001, "1 ms"),
        (0.0123, "12.3 ms"),
        (0.999, "999 ms"),
        (1, "1 s"),
        (119.4, "119 s"),
        (120, "2 min 0 s"),
        # Numbers are rounded to seconds or minutes, of which no more than 59 are left.
        (179.4, "2 min 59 s"),
        (179.6, "3 min 0 s"),
        (7199, "119 min 59 s"),
        (7200, "2 h 0 min"),
        (10_769, "2 h 59 min"),
        (10_771, "3 h 0 min"),
    ],
)
def test_units_of_time_change_at_their_limits(value, text):
    assert seconds(value) == text


def test_neighbours_are_a_golden_section_apart():
    assert [round(spread(n), 3) for n in range(4)] == [0, 0.618, 0.236, 0.854]


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
