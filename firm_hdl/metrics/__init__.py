"""Figures of message types that explain how hard a type is to convert."""

from __future__ import annotations

from firm_hdl.metrics.analysis import Analyses, Metrics, metrics_of
from firm_hdl.metrics.features import FEATURES
from firm_hdl.metrics.report import FORMATS, report

__all__ = ["FEATURES", "FORMATS", "Analyses", "Metrics", "metrics_of", "report"]
