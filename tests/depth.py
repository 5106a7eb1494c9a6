"""Depth of tests: `make test` takes minutes, `make nightly` has no limit of time.

Checks that take long and rarely find a fault are thorough: tests with the marker `thorough`, and
further cases of a test by :func:`by_depth`
and by the marker `sampled`. Tests with real peers on the network have the marker
`live`, and `make live` alone runs them.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable
from typing import TypeVar
from zlib import crc32

import pytest

__all__ = ["LIVE", "THOROUGH", "by_depth", "not_sampled"]

T = TypeVar("T")

THOROUGH = bool(os.environ.get("FIRM_HDL_THOROUGH"))
LIVE = bool(os.environ.get("FIRM_HDL_LIVE"))


def by_depth(usual: T, thorough: T) -> T:
    """Return the first value in `make test`, the second one in `make nightly`."""
    return thorough if THOROUGH else usual


def not_sampled(items: Iterable[pytest.Item]) -> set[pytest.Item]:
    """Return the cases that `make test` leaves out: all but one in `n` of a test `sampled(n)`.

    The names of the cases choose, so that the choice is the same in each process and run, and
    differs between tests with the same parameters. At least one case of each test is left.
    """
    cases: dict[str, list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.get_closest_marker("sampled"):
            cases[item.nodeid.partition("[")[0]].append(item)
    left_out: set[pytest.Item] = set()
    for each in cases.values():
        marker = each[0].get_closest_marker("sampled")
        assert marker is not None
        each.sort(key=lambda item: crc32(item.nodeid.encode()))
        left_out.update(each[-(-len(each) // marker.args[0]) :])
    return left_out
