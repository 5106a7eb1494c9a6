"""What tests say of verdicts: only what somebody judged and found right is a pass."""

from __future__ import annotations

from firm_hdl.verify.verdict import KnownDifference, Passed

__all__ = ["assert_known", "assert_passed"]


def assert_passed(result):
    """Assert that a verdict, or that of a result, is a pass; return how many cases were judged."""
    verdict = getattr(result, "verdict", result)
    assert isinstance(verdict, Passed), verdict
    return verdict.cases


def assert_known(result, *keys):
    """Assert that a verdict, or that of a result, is a known difference of these keys alone."""
    verdict = getattr(result, "verdict", result)
    assert isinstance(verdict, KnownDifference), verdict
    assert verdict.keys == keys
