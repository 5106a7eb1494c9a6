"""Statistics of numbers with known results."""

from __future__ import annotations

import pytest

from firm_hdl.verify.report.summary import (
    box_of,
    correlate,
    curve_of,
    share_within,
)


def test_box_has_quartiles():
    box = box_of([5, 1, 4, 2, 3])
    assert (box.count, box.least, box.q1, box.median, box.q3, box.most) == (5, 1, 2, 3, 4, 5)
    assert box.p95 == pytest.approx(4.8) and box.total == 15
    assert box_of([]) is None


@pytest.mark.parametrize("count", [1, 2, 7, 239, 240, 241, 1000, 12345])
def test_curve_ends_with_all_values(count):
    values = [float(number) for number in range(count)]
    points = curve_of(values)
    assert points[-1] == (count - 1, 1.0) and len(points) <= 2 * 240 + 1
    assert points == sorted(points) and len(set(points)) == len(points)
    for value, share in points:
        assert share == pytest.approx(share_within(values, value))


def test_line_is_found():
    found = correlate([1, 2, 3, 4, 5], [5, 7, 9, 11, 13])
    assert (found.linear.a, found.linear.b, found.linear.r2) == pytest.approx((3, 2, 1))
    assert found.pearson == pytest.approx(1) and found.spearman == pytest.approx(1)


def test_power_law_is_found():
    xs = [1.0, 2, 4, 8, 16, 32]
    found = correlate(xs, [0.5 * x**1.5 for x in xs])
    assert (found.power.a, found.power.b, found.power.r2) == pytest.approx((0.5, 1.5, 1))
    assert found.spearman == pytest.approx(1)
    assert found.linear.r2 < 1 and found.pearson < 1


def test_known_noise_has_its_r2():
    # Around the line, the remaining sum of squares is 24/9 of 42/9.
    found = correlate([1, 2, 3, 1, 2, 3], [1, 0, 3, 1, 0, 3])
    assert found.linear.b == pytest.approx(1)
    assert found.linear.r2 == pytest.approx(1 - 24 / 42)


def test_equal_values_share_their_rank():
    assert correlate([1, 1, 2, 3], [5, 5, 6, 7]).spearman == pytest.approx(1)
    assert correlate([1, 2, 3], [3, 2, 1]).spearman == pytest.approx(-1)
    # Ranks 1, 3, 3, 3, 5 and 1, 2, 3, 4, 5: by hand, 8 divided by the root of 8 times 10.
    assert correlate([1, 2, 2, 2, 3], [1, 2, 3, 4, 5]).spearman == pytest.approx(8 / 80**0.5)
    # Ranks 1.5, 1.5, 3, 4 and 1, 2, 3.5, 3.5.
    assert correlate([1, 1, 2, 3], [1, 2, 3, 3]).spearman == pytest.approx(4 / 4.5)


def test_constant_values_have_no_correlation():
    assert correlate([1, 1, 1], [1, 2, 3]) is None
    assert correlate([1, 2, 3], [1, 1, 1]) is None
    assert correlate([], []) is None


def test_few_points_have_no_fit():
    assert correlate([1, 2, 3, 4], [1, 2, 3, 5]).linear is None
    assert correlate([1, 1, 2, 2, 2], [1, 2, 3, 5, 4]).linear is None


def test_zero_is_left_out_of_power_laws_alone():
    found = correlate([0, 1, 2, 4, 8, 16], [1, 1, 2, 4, 8, 16])
    assert found.power.b == pytest.approx(1) and found.linear.r2 < 1
