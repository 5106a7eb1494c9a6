"""A report as JSON, for other programs."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from firm_hdl.verify.report.outcomes import Outcome
from firm_hdl.verify.report.summary import Summary

__all__ = ["FORMAT", "to_json"]

FORMAT = "firm-hdl report 1"


def to_json(summary: Summary) -> str:
    """Write a report as JSON: the fields of `Summary`, and tests with their records."""
    content: dict[str, Any] = {"format": FORMAT, **asdict(summary)}
    content["verdict"] = summary.counts.verdict
    content["outcomes"] = [_outcome(outcome) for outcome in summary.outcomes]
    for name in ("failed", "not_run", "skipped", "uncovered", "slowest", "most_complex"):
        content[name] = [outcome.test.key for outcome in getattr(summary, name)]
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _outcome(outcome: Outcome) -> dict[str, Any]:
    found = asdict(outcome)
    found["key"] = outcome.test.key
    if outcome.record is not None:
        found["record"] = outcome.record.as_json()
        del found["record"]["test"]
    return found
