"""Depth of tests: `make test` takes minutes, `make test-thorough` has no limit of time.

Checks that take long and rarely find a fault are thorough: tests with the marker `thorough`, and
further cases of a test by :func:`by_depth`. Tests with real peers on the network have the marker
`live`, and `make test-live` alone runs them.
"""

from __future__ import annotations

import os
from typing import TypeVar

__all__ = ["LIVE", "THOROUGH", "by_depth"]

T = TypeVar("T")

THOROUGH = bool(os.environ.get("FIRM_HDL_THOROUGH"))
LIVE = bool(os.environ.get("FIRM_HDL_LIVE"))


def by_depth(usual: T, thorough: T) -> T:
    """Return the first value in `make test`, the second one in `make test-thorough`."""
    return thorough if THOROUGH else usual
