"""Cuts of segments: as few steps as possible, between values if that costs no step."""

from __future__ import annotations

import pytest

from firm_hdl.plan.cut import cut, split, step_sizes
from firm_hdl.plan.tree import Pad, Part


@pytest.mark.parametrize(
    ("values", "sizes"),
    [
        ([4, 4], [4, 4]),
        # Cut between the values, because one more step is needed anyway.
        ([1, 8], [1, 4, 4]),
        ([2, 4, 3], [2, 4, 3]),
        # Of several such cuts, the last one leaves the least.
        ([1, 2, 4, 2], [3, 4, 2]),
        ([1, 1, 1, 4], [3, 4]),
        # Cut through the second value: a cut between the values would cost a step.
        ([1, 7], [4, 4]),
        ([3, 1, 3, 1], [4, 4]),
        ([1], [1]),
    ],
)
def test_steps_are_few_and_end_where_values_end(values, sizes):
    slices = [Pad(bytes=size) for size in values]
    assert cut(slices, 4, 4) == sizes


def test_the_last_step_may_be_larger():
    assert cut([Pad(bytes=4), Pad(bytes=6)], 4, 8) == [4, 6]


def segment(*values):
    """Return values of leaves by their sizes; transfers of an array share a negative leaf."""
    slices = []
    for number, value in enumerate(values):
        size, leaf = value if isinstance(value, tuple) else (value, number)
        slices.append(Part(bytes=size, leaf=leaf, first=0, size=size))
    return slices


@pytest.mark.parametrize(
    ("values", "start", "narrow_start", "wide", "narrow", "after_a_rest"),
    [
        # The start, cut at bus words, with a last step of two words or one; the same elsewhere; and
        # with the rest of a run in the first step.
        ([4], [4], [4], [4], [4], [4]),
        ([4, 4], [8], [4, 4], [8], [4, 4], [4, 4]),
        ([4, 2], [6], [4, 2], [6], [4, 2], [4, 2]),
        ([4, 4, 4], [4, 8], [4, 4, 4], [4, 8], [4, 4, 4], [4, 8]),
        ([2, 4, 4], [4, 6], [4, 4, 2], [2, 8], [2, 4, 4], [2, 8]),
        # A step ends between two transfers of an array.
        ([(4, -1), (4, -1)], *([[4, 4]] * 5)),
        ([(4, -1), (1, -1)], *([[4, 1]] * 5)),
        ([2, (4, -1), (2, -1)], [6, 2], [4, 2, 2], [6, 2], [2, 4, 2], [2, 4, 2]),
        ([2, (4, -1), (4, -1), 2], [6, 6], [4, 2, 4, 2], [6, 6], [2, 4, 4, 2], [2, 4, 6]),
        ([(4, -1), (2, -1), 4], [4, 6], [4, 2, 4], [4, 6], [4, 2, 4], [4, 6]),
        ([(4, -1), (2, -1), (4, -2), (2, -2)], *([[4, 6, 2], [4, 2, 4, 2]] * 2), [4, 6, 2]),
    ],
)
def test_sizes_of_steps(values, start, narrow_start, wide, narrow, after_a_rest):
    slices = segment(*values)
    for sizes, at_start, may_be_wide, has_rest in (
        (start, True, True, False),
        (narrow_start, True, False, False),
        (wide, False, True, False),
        (narrow, False, False, False),
        (narrow, False, False, True),
        (after_a_rest, False, True, True),
    ):
        options = {"at_start": at_start, "may_be_wide": may_be_wide, "has_rest": has_rest}
        assert step_sizes(slices, 4, **options) == sizes, options
        for step in split(slices, sizes):
            leaves = [part.leaf for part in step]
            assert len(set(leaves)) == len(leaves)
