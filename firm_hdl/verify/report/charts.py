"""The charts of a report."""

from __future__ import annotations

from collections.abc import Sequence

from firm_hdl.drawing.svg import Figure, Scale, number, seconds, spread
from firm_hdl.verify.report.summary import Box, Curve, Fit, Trend
from firm_hdl.verify.results.records import STAGES
from firm_hdl.verify.results.verdict import Counts

__all__ = ["colour", "counts_bar", "cumulative", "law_text", "line_text", "scatter", "stages"]

COLOURS = 6
"""The number of colours in the style sheet, ``c1`` and so on."""

MOST_DOTS = 500
BAR_WIDTH = 110
PARTS = (
    ("passed", "pass"),
    ("known", "known"),
    ("failed", "fail"),
    ("not_judged", "skip"),
    ("not_run", "none"),
)


def colour(index: int) -> str:
    """Return the class of a colour."""
    return f"c{index % COLOURS + 1}"


def counts_bar(counts: Counts) -> str:
    """Draw counts as one bar."""
    figure = Figure(BAR_WIDTH, 12, "")
    values = {name: getattr(counts, name) for name, _ in PARTS}
    # Each part has a minimum width, so that small parts can be seen. The widest part gets narrower.
    widths = {name: max(4.0, BAR_WIDTH * v / counts.total) for name, v in values.items() if v}
    most = max(widths, key=lambda name: widths[name])
    widths[most] -= sum(widths.values()) - BAR_WIDTH
    x = 0.0
    for name, kind in PARTS:
        if name in widths:
            title = f"{values[name]} {name.replace('_', ' ')}"
            figure.box(x, 0, widths[name], 12, f"bar-{kind}", title)
            x += widths[name]
    return str(figure).replace('role="img" aria-label=""', 'aria-hidden="true"')


def cumulative(curves: Sequence[Curve]) -> str:
    """Draw the share of tests that were completed within a time, with a line for each suite."""
    figure = Figure(760, 340, "Share of tests completed within a time")
    x = Scale.logarithmic((v for c in curves for v, _ in c.points), 62, 740)
    y = Scale(0, 1, 286, 16)
    figure.x_axis(x, 286, "time per test in s, logarithmic", 16)
    figure.y_axis(y, 62, "share of tests completed", 740, percent=True)
    for index, curve in enumerate(curves):
        if curve.seconds is None:
            continue
        first = curve.seconds.least
        points = [(x(first), y(0)), *((x(v), y(share)) for v, share in curve.points)]
        figure.path(points, f"curve {colour(index)}", curve.suite, steps=True)
        for share, value in ((0.5, curve.seconds.median), (0.95, curve.seconds.p95)):
            title = f"{curve.suite}: {share:.0%} of tests within {seconds(value)}"
            figure.dot(x(value), y(share), f"mark {colour(index)}", title, 4)
    return str(figure)


def stages(curve: Curve) -> str:
    """Draw the times of each stage: all tests as points, and their quartiles as a box."""
    names = [stage for stage in STAGES if stage in curve.stages]
    height = 64
    bottom = 12 + height * len(names)
    figure = Figure(760, bottom + 44, f"Run times of the stages, {curve.suite}")
    # The ends come from all values, because the points are only some of them.
    ends = (v for stage in names for v in (curve.stages[stage].least, curve.stages[stage].most))
    x = Scale.logarithmic(ends, 96, 740)
    figure.x_axis(x, bottom, "time per test in s, logarithmic", 12)
    for row, stage in enumerate(names):
        middle = 12 + height * row + height / 2
        figure.text(86, middle + 4, stage, "row", "end")
        values = curve.stage_values[stage]
        step = -(-len(values) // MOST_DOTS)
        for index, value in enumerate(values[::step]):
            at = middle + 8 + 16 * spread(index)
            figure.dot(x(value), round(at, 1), f"strip {colour(row)}", seconds(value), 1.8)
        _box(figure, x, middle - 8, curve.stages[stage], colour(row), stage)
    return str(figure)


def _box(figure: Figure, x: Scale, y: float, box: Box, kind: str, name: str) -> None:
    title = (
        f"{name}: median {seconds(box.median)}, quartiles {seconds(box.q1)} and {seconds(box.q3)}, "
        f"95 % within {seconds(box.p95)}, from {seconds(box.least)} to {seconds(box.most)}"
    )
    figure.line(x(box.least), y, x(box.most), y, f"whisker {kind}")
    figure.box(x(box.q1), y - 8, max(2, x(box.q3) - x(box.q1)), 16, f"box {kind}", title)
    figure.line(x(box.median), y - 8, x(box.median), y + 8, f"median {kind}")
    figure.line(x(box.p95), y - 5, x(box.p95), y + 5, f"whisker {kind}")


def line_text(fit: Fit | None) -> str:
    """Write a fitted line as a formula."""
    if fit is None:
        return "-"
    sign = "-" if fit.b < 0 else "+"
    return f"{_signed(fit.a)} {sign} {number(abs(fit.b))}·x"


def law_text(fit: Fit | None) -> str:
    """Write a fitted power law as a formula."""
    return "-" if fit is None else f"{number(fit.a)}·x^{fit.b:.2f}"


def _signed(value: float) -> str:
    return f"-{number(-value)}" if value < 0 else number(value)


def scatter(trend: Trend) -> str:
    """Draw times over a figure, and the functions that were fitted to them."""
    name = trend.metric.replace("_", " ")
    figure = Figure(372, 290, f"Time over {name}")
    points = [(a, b) for a, b in trend.points if a > 0 and b > 0]
    x = Scale.logarithmic((a for a, _ in points), 62, 346)
    y = Scale.logarithmic((b for _, b in points), 236, 14)
    figure.x_axis(x, 236, f"{name}, logarithmic", 14)
    figure.y_axis(y, 62, "time in s, logarithmic", 346)
    step = -(-len(points) // MOST_DOTS)
    for a, b in points[::step]:
        figure.dot(x(a), y(b), "point c1", f"{name} {number(a)}: {seconds(b)}", 2.2)
    low, high = min(a for a, _ in points), max(a for a, _ in points)
    across = [low * (high / low) ** (n / 60) for n in range(61)]
    law, line = trend.correlation.power, trend.correlation.linear
    if line is not None:
        made = [(a, line.a + line.b * a) for a in across]
        _fitted(figure, x, y, made, "fit-line", f"line {line_text(line)}, R² {line.r2:.2f}")
    if law is not None:
        made = [(a, law.a * a**law.b) for a in across]
        _fitted(figure, x, y, made, "fit-law", f"power law {law_text(law)}, R² {law.r2:.2f}")
    return str(figure)


def _fitted(
    figure: Figure,
    x: Scale,
    y: Scale,
    made: Sequence[tuple[float, float]],
    kind: str,
    title: str,
) -> None:
    inside = [(x(a), y(b)) for a, b in made if y.low <= b <= y.high]
    if len(inside) > 1:
        figure.path(inside, kind, title)
