"""TS3 on a type, and assertions about verdicts: a pass needs a judge that found it correct."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.verify.results.records import Seconds
from firm_hdl.verify.results.verdict import KnownDifference, Passed
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.acceptance import accepted
from firm_hdl.verify.ts3.task import as_test

__all__ = ["NAN_KEY", "TIME_KEY", "accept", "assert_known", "assert_passed", "without_times"]


NAN_KEY = "python-signalling-nan"
"""Key for NaN values that Python floats change, in libraries that confirm packets."""
TIME_KEY = "rosbags-time-signs"
"""Key for ROS 1 seconds, which rosbags reads as signed, and genpy as unsigned."""


def accept(distro, name, options=None):
    """Run TS3 on a type in this process; return its record."""
    options = options or CaseOptions()
    task = TypeUnderTest(distro=distro, name=name, same=(distro,))
    return accepted(options, as_test(task, options))


def assert_passed(result, known=()):
    """Assert that a verdict, or that of a result, is a pass; return the number of judged cases.

    `known` has the keys of the expected differences between libraries; there must be no others.
    """
    verdict = getattr(result, "verdict", result)
    assert isinstance(verdict, KnownDifference if known else Passed), verdict
    assert getattr(verdict, "keys", ()) == known
    return verdict.cases


def assert_known(result, *keys):
    """Assert that a verdict, or that of a result, is a known difference with these keys only."""
    verdict = getattr(result, "verdict", result)
    assert isinstance(verdict, KnownDifference), verdict
    assert verdict.keys == keys


def without_times(record):
    """Return a record without its times, which differ from run to run."""
    return replace(record, seconds=Seconds(), cpu_seconds=0.0)
