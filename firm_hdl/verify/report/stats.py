"""The statistics of a report: quantiles, shares within a time, correlations, and fitted functions.

Functions are fitted by least squares: a line to the figures themselves, and a power law as a line
to their logarithms. R² is computed in the space of the fit: of the figures or of the logarithms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

__all__ = ["Box", "Correlation", "Fit", "box_of", "correlate", "curve_of", "share_within"]

LEAST_POINTS = 5
"""The smallest number of points that a function is fitted to."""

LEAST_VALUES = 3
MOST_CURVE_POINTS = 240


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """The distribution of values."""

    count: int
    # Quartiles and the 95th percentile between the smallest value and the largest.
    least: float
    q1: float
    median: float
    q3: float
    p95: float
    most: float
    total: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """A fitted function: ``a + b x`` for a line, ``a x^b`` for a power law."""

    a: float
    b: float
    r2: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Correlation:
    """The correlation of a figure with a time."""

    count: int  # The number of pairs.
    # The correlation of the values, and that of their ranks.
    pearson: float
    spearman: float
    # `None` if there are too few points. Only pairs above zero count for the power law.
    linear: Fit | None
    power: Fit | None


def box_of(values: Sequence[float]) -> Box | None:
    """Return the distribution of values; `None` if there are no values."""
    if not values:
        return None
    at = np.quantile(np.asarray(values, dtype=float), (0, 0.25, 0.5, 0.75, 0.95, 1))
    names = ("least", "q1", "median", "q3", "p95", "most")
    quantiles = dict(zip(names, at.tolist(), strict=True))
    return Box(count=len(values), total=float(sum(values)), **quantiles)


def curve_of(values: Sequence[float]) -> list[tuple[float, float]]:
    """Return points of the cumulative distribution of values; the last one is at 1."""
    ordered = sorted(values)
    count = len(ordered)
    if not count:
        return []
    step = max(1, count // MOST_CURVE_POINTS)
    ranks = [*range(step, count, step), count]
    return [(ordered[rank - 1], rank / count) for rank in ranks]


def share_within(values: Sequence[float], limit: float) -> float:
    """Return the share of values that are at most `limit`."""
    return sum(value <= limit for value in values) / len(values) if values else 0.0


def correlate(
    x: Sequence[float] | np.ndarray, y: Sequence[float] | np.ndarray
) -> Correlation | None:
    """Return the correlation of two figures.

    Returns
    -------
    Correlation or None
        `None` if one of the figures does not vary.
    """
    xs, ys = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(xs) < 2 or np.ptp(xs) == 0 or np.ptp(ys) == 0:
        return None
    above = (xs > 0) & (ys > 0)
    line = _line(xs, ys)
    law = _line(np.log(xs[above]), np.log(ys[above]))
    return Correlation(
        count=len(xs),
        pearson=float(np.corrcoef(xs, ys)[0, 1]),
        spearman=float(np.corrcoef(_ranks(xs), _ranks(ys))[0, 1]),
        linear=line,
        power=None if law is None else Fit(a=float(np.exp(law.a)), b=law.b, r2=law.r2),
    )


def _line(xs: np.ndarray, ys: np.ndarray) -> Fit | None:
    if len(xs) < LEAST_POINTS or len(np.unique(xs)) < LEAST_VALUES or np.ptp(ys) == 0:
        return None
    x, y = xs - xs.mean(), ys - ys.mean()
    # `@` would start threads, which cost more time than they save with so few values.
    b = float((x * y).sum() / (x * x).sum())
    left = y - b * x
    r2 = float(1 - (left * left).sum() / (y * y).sum())
    return Fit(a=float(ys.mean() - b * xs.mean()), b=b, r2=r2)


def _ranks(values: np.ndarray) -> np.ndarray:
    """Return ranks. Equal values get the mean of their ranks."""
    _, which, counts = np.unique(values, return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    return np.asarray(((ends - counts + ends + 1) / 2)[which])
