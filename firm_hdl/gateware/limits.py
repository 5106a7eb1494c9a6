"""Limits of what Amaranth can elaborate, and of the parameters of components."""

from __future__ import annotations

__all__ = ["MAX_CELL_BITS", "check_bits", "check_integer"]

MAX_CELL_BITS = 65_535
"""Most bits of a cell in Amaranth 0.5. All inputs of a design together count as one cell."""


def check_integer(what: str, number: int) -> None:
    """Raise a TypeError unless a user's parameter is an integer."""
    # In Python, a bool is an integer, too.
    if not isinstance(number, int) or isinstance(number, bool):
        raise TypeError(f"{what} must be an integer, not {number!r}")


def check_bits(what: str, number: int) -> None:
    """Raise an error unless a user's number of bits is an integer from 0 on."""
    check_integer(what, number)
    if number < 0:
        raise ValueError(f"{what} must be at least 0, not {number}")
