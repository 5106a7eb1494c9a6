"""Counted effort: the allowed number of calls passes, one call more fails."""

from __future__ import annotations

import contextlib

import pytest

from tests.steps import calls_at_most


def work(times):
    return [abs(number) for number in map(int, range(times))]


def test_calls_are_counted_the_same_each_time():
    with calls_at_most(1200):
        work(1000)
    with pytest.raises(AssertionError, match="more than 900 calls"), calls_at_most(900):
        work(1000)


def test_code_that_catches_every_exception_does_not_hide_it():
    raised = pytest.raises(AssertionError, match="more than 9 calls")
    with raised, calls_at_most(9), contextlib.suppress(Exception):
        work(1000)


def test_endless_work_is_stopped():
    with pytest.raises(AssertionError), calls_at_most(1000):
        while True:
            work(1)
