"""The bits of constants that are floats."""

from __future__ import annotations

import pytest

from firm_hdl.export.constants import _float_bits


@pytest.mark.parametrize(
    ("value", "size", "bits"),
    [
        (1.0, 4, 0x3F80_0000),
        (-2.5, 4, 0xC020_0000),
        (-2.5, 8, 0xC004_0000_0000_0000),
        # Numbers of Python that no float32 has.
        (1e39, 4, 0x7F80_0000),
        (-1e39, 4, 0xFF80_0000),
        (1e39, 8, 0x4807_8287_F49C_4A1D),
        (float("inf"), 4, 0x7F80_0000),
        (float("-inf"), 8, 0xFFF0_0000_0000_0000),
        (-0.0, 4, 0x8000_0000),
    ],
)
def test_bits_are_those_of_ieee_754(value: float, size: int, bits: int) -> None:
    assert _float_bits(value, size) == bits
