"""Time calls in Python.

The Python that has genpy also runs this file, so it imports nothing of firm-hdl.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

__all__ = ["RUNS", "RUN_SECONDS", "best_ns"]

RUNS = 5
"""Number of runs. The fastest one counts, because other load of the machine only adds time."""

RUN_SECONDS = 0.1
"""Least length of a run, in seconds of processor time."""


def best_ns(
    work: Callable[[Any], object],
    items: Sequence[Any],
    runs: int = RUNS,
    run_seconds: float = RUN_SECONDS,
) -> float:
    """Return the processor time of `work` for one of the items, in ns.

    Parameters
    ----------
    work : callable
        Takes an item.
    items : list
        The items; `work` is called equally often with each.
    runs : int
    run_seconds : float
    """
    passes = 1
    while (taken := _seconds(work, items, passes)) < run_seconds:
        passes *= 2
    taken = min([taken, *(_seconds(work, items, passes) for _ in range(runs - 1))])
    return 1e9 * taken / (passes * len(items))


def _seconds(work: Callable[[Any], object], items: Sequence[Any], passes: int) -> float:
    start = time.thread_time()
    for _ in range(passes):
        for item in items:
            work(item)
    return time.thread_time() - start
