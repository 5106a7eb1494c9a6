"""Segments are cut into as few steps as can be, between values where that costs no step."""

from __future__ import annotations

import pytest

from firm_hdl.plan.cut import cut
from firm_hdl.plan.ir import Pad


@pytest.mark.parametrize(
    ("values", "sizes"),
    [
        ([4, 4], [4, 4]),
        # Between the values, because a step more is needed anyway.
        ([1, 8], [1, 4, 4]),
        ([2, 4, 3], [2, 4, 3]),
        # Through the second value: to cut between them would cost a step.
        ([1, 7], [4, 4]),
        ([3, 1, 3, 1], [4, 4]),
        ([1], [1]),
    ],
)
def test_steps_are_few_and_end_where_values_end(values, sizes):
    slices = [Pad(at=sum(values[:n]), bytes=size) for n, size in enumerate(values)]
    assert cut(slices, 4, 4) == sizes


def test_the_last_step_may_be_larger():
    assert cut([Pad(at=0, bytes=4), Pad(at=4, bytes=6)], 4, 8) == [4, 6]
