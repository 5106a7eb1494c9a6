"""Reports of results: one page in HTML, and the same as Markdown and as JSON."""

from __future__ import annotations

from firm_hdl.verify.report.command import FORMATS, run_report, write_report
from firm_hdl.verify.report.outcomes import Counts, Outcome, count, outcomes_of
from firm_hdl.verify.report.summary import Summary, summarise

__all__ = [
    "FORMATS",
    "Counts",
    "Outcome",
    "Summary",
    "count",
    "outcomes_of",
    "run_report",
    "summarise",
    "write_report",
]
