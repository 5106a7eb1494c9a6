"""A report as JSON, for other programs."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from typing import Any

from firm_hdl.verify.report.outcomes import NotRun, Outcome
from firm_hdl.verify.report.summary import Summary
from firm_hdl.verify.results.records import to_json as record_to_json

__all__ = ["to_json"]

FORMAT = "firm-hdl report 2"


def to_json(summary: Summary) -> str:
    """Write a report as JSON: the fields of `Summary`, and tests with their records."""
    # Each outcome is written once, below, because there may be a hundred thousand of them.
    content: dict[str, Any] = {"format": FORMAT, **asdict(replace(summary, outcomes=()))}
    content["verdict"] = summary.verdict
    del content["outcomes"]
    for name in ("failed", "not_run", "not_judged", "uncovered", "slowest", "most_complex"):
        content[name] = [outcome.test.key for outcome in getattr(summary, name)]
    text = _written(content, indent=1).removesuffix("\n}")
    # One line for each test, which is also much faster to write than indented JSON.
    tests = ",\n".join(f"  {_written(_outcome(outcome))}" for outcome in summary.outcomes)
    return f'{text},\n "outcomes": [\n{tests}\n ]\n}}\n'


def _written(content: object, indent: int | None = None) -> str:
    return json.dumps(content, indent=indent, ensure_ascii=False, allow_nan=False)


def _outcome(outcome: Outcome) -> dict[str, Any]:
    found: dict[str, Any] = {
        "test": asdict(outcome.test),
        "verdict": outcome.verdict.name,
        "details": () if isinstance(outcome.verdict, NotRun) else outcome.verdict.details,
        "record": None,
        "circuit_of": outcome.circuit_of,
        "key": outcome.test.key,
    }
    if outcome.record is not None:
        found["record"] = record_to_json(outcome.record)
        del found["record"]["test"]
    return found
