"""Figures of message types that explain how hard a type is to convert."""

from __future__ import annotations

from firm_hdl.metrics.analysis import FEATURES, FORMATS, Analyses, Metrics, metrics_of, report

__all__ = ["FEATURES", "FORMATS", "Analyses", "Metrics", "metrics_of", "report"]
