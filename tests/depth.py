"""How deep tests go: `make test` has minutes, `make test-thorough` takes what it needs.

What takes long and rarely tells anything new is thorough: a test with the marker `thorough`, or
more cases of a test by :func:`by_depth`.
"""

from __future__ import annotations

import os
from typing import TypeVar

__all__ = ["THOROUGH", "by_depth"]

T = TypeVar("T")

THOROUGH = bool(os.environ.get("FIRM_HDL_THOROUGH"))


def by_depth(usual: T, thorough: T) -> T:
    """Return what `make test` takes, or what `make test-thorough` takes."""
    return thorough if THOROUGH else usual
