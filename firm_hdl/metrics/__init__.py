"""Figures of message types, by which to explain what is hard about them."""

from __future__ import annotations

from firm_hdl.metrics.analysis import Analyses, Metrics, metrics_of
from firm_hdl.metrics.features import FEATURES
from firm_hdl.metrics.report import FORMATS, report

__all__ = ["FEATURES", "FORMATS", "Analyses", "Metrics", "metrics_of", "report"]
