"""Bounds of effort that are the same on every machine and in every run.

A test with a clock fails on a busy machine and passes on a fast one. Calls can be counted: what
grows with the square of its input, or worse, makes too many of them, and is stopped there. A call
that takes long inside a library, such as a search in a long list, is not detected.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def calls_at_most(most: int) -> Iterator[None]:
    """Fail as soon as more functions are called inside, of Python or of its libraries."""
    left = most

    def count(frame: FrameType, event: str, argument: object) -> None:
        nonlocal left
        if event in ("call", "c_call"):
            left -= 1
            if left < 0:
                sys.setprofile(None)
                raise AssertionError(f"more than {most} calls")

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        yield
    finally:
        sys.setprofile(before)
    # Code that catches every exception may have caught the first one.
    assert left >= 0, f"more than {most} calls"
