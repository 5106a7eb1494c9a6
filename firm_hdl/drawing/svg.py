"""Scales with axes, and figures of text, lines and points, as SVG in a page.

Colours are classes (``c1`` and so on). The style sheet of the page has a value for each of them in
light and in dark mode. The ``<title>`` of a point describes it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape

__all__ = ["Figure", "Scale", "number", "seconds", "spread"]


def number(value: float) -> str:
    """Write a number with three significant digits and separators of thousands."""
    if not math.isfinite(value):
        return "-"
    if value == int(value):
        return f"{int(value):,}"
    if abs(value) >= 1000:
        return f"{value:,.0f}"
    text = f"{value:.3g}"
    return text if "e" not in text else f"{value:.1e}"


def seconds(value: float) -> str:
    """Write a time in a suitable unit."""
    if value <= 0:
        return "0 s"
    for most, factor, unit in ((1e-3, 1e6, "µs"), (1, 1e3, "ms"), (120, 1, "s")):
        if value < most:
            return f"{number(value * factor)} {unit}"
    # Rounded before it is divided, so that 179.6 s are not 2 min 60 s.
    if value < 7200:
        minutes, rest = divmod(round(value), 60)
        return f"{minutes} min {rest} s"
    hours, minutes = divmod(round(value / 60), 60)
    return f"{hours} h {minutes} min"


@dataclass(frozen=True, slots=True)
class Scale:
    """The mapping from values to coordinates in a figure."""

    # Values at the ends.
    low: float
    high: float
    # Coordinates of the ends.
    start: float
    end: float
    is_log: bool = False

    @classmethod
    def logarithmic(cls, values: Iterable[float], start: float, end: float) -> Scale:
        """Return a logarithmic scale that shows all positive values, between round figures."""
        known = [value for value in values if value > 0] or [1.0]
        low, high = _round_down(min(known)), -_round_down(-max(known))
        return cls(low, high if high > low else low * 10, start, end, True)

    @classmethod
    def linear(cls, values: Iterable[float], start: float, end: float) -> Scale:
        """Return a scale from 0 to a round figure that is at least as high as all values."""
        most = max(values, default=0.0)
        power = 10.0 ** math.floor(math.log10(most)) if most > 0 else 1.0
        ends = (digits * power for digits in (1, 1.5, 2, 2.5, 3, 4, 5, 7.5, 10))
        return cls(0, next(end for end in ends if end >= most), start, end)

    def __call__(self, value: float) -> float:
        """Return the coordinate of a value."""
        if self.is_log:
            share = math.log(max(value, self.low) / self.low) / math.log(self.high / self.low)
        else:
            share = (value - self.low) / (self.high - self.low)
        return round(self.start + share * (self.end - self.start), 1)

    def ticks(self) -> list[float]:
        """Return a few round values; for a linear scale, six values at equal distances."""
        if not self.is_log:
            return [self.low + (self.high - self.low) * fifths / 5 for fifths in range(6)]
        decades = math.log10(self.high / self.low)
        digits: Sequence[int] = (1, 2, 5) if decades <= 2.1 else (1,)
        every = 1 if decades <= 6 else math.ceil(decades / 5)
        first = math.floor(math.log10(self.low) + 1e-9)
        found = [
            digit * 10.0**power
            for power in range(first, math.ceil(math.log10(self.high)) + 1, every)
            for digit in digits
        ]
        return [v for v in found if self.low * (1 - 1e-9) <= v <= self.high * (1 + 1e-9)]


def _round_down(value: float) -> float:
    """Return the next 1, 2 or 5 times a power of ten below, away from zero if negative."""
    size = abs(value)
    power = 10.0 ** math.floor(math.log10(size))
    if value > 0:
        return max(digit * power for digit in (1, 2, 5) if digit * power <= size * (1 + 1e-9))
    return -min(digit * power for digit in (1, 2, 5, 10) if digit * power >= size * (1 - 1e-9))


def spread(index: int) -> float:
    """Return a number from 0 to 1 that is far from those of neighbours, the same in each run."""
    return (index * 0.6180339887498949) % 1


@dataclass(slots=True)
class Figure:
    """A figure."""

    width: int
    height: int
    label: str  # The text for screen readers.
    parts: list[str] = field(default_factory=list)

    def __str__(self) -> str:
        return (
            f'<svg viewBox="0 0 {self.width} {self.height}" role="img" '
            f'aria-label="{escape(self.label)}" style="max-width:{self.width}px">'
            + "".join(self.parts)
            + "</svg>"
        )

    def line(self, x1: float, y1: float, x2: float, y2: float, kind: str) -> None:
        """Draw a straight line."""
        self.parts.append(f'<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" class="{kind}"/>')

    def path(
        self, points: Iterable[tuple[float, float]], kind: str, title: str = "", steps: bool = False
    ) -> None:
        """Draw a line through points; with `steps`, as a staircase."""
        text = ""
        for x, y in points:
            text += f"M{x} {y}" if not text else f"H{x}V{y}" if steps else f"L{x} {y}"
        self.parts.append(f'<path d="{text}" class="{kind}">{_title(title)}</path>')

    def text(
        self, x: float, y: float, text: str, kind: str = "tick", anchor: str = "middle"
    ) -> None:
        """Write a text."""
        self.parts.append(
            f'<text x="{x}" y="{y}" class="{kind}" text-anchor="{anchor}">{escape(text)}</text>'
        )

    def dot(self, x: float, y: float, kind: str, title: str = "", radius: float = 2.5) -> None:
        """Draw a point."""
        self.parts.append(
            f'<circle cx="{x}" cy="{y}" r="{radius}" class="{kind}">{_title(title)}</circle>'
        )

    def box(
        self, x: float, y: float, width: float, height: float, kind: str, title: str = ""
    ) -> None:
        """Draw a rectangle."""
        self.parts.append(
            f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" '
            f'class="{kind}">{_title(title)}</rect>'
        )

    def x_axis(self, scale: Scale, y: float, label: str, top: float) -> None:
        """Draw a horizontal axis, and a grid up to `top`."""
        for value in scale.ticks():
            at = scale(value)
            self.line(at, y, at, top, "grid")
            self.text(at, y + 15, number(value))
        self.line(scale.start, y, scale.end, y, "axis")
        self.text((scale.start + scale.end) / 2, y + 33, label, "label")

    def y_axis(
        self, scale: Scale, x: float, label: str, right: float, percent: bool = False
    ) -> None:
        """Draw a vertical axis, and a grid up to `right`."""
        for value in scale.ticks():
            at = scale(value)
            self.line(x, at, right, at, "grid")
            self.text(x - 6, at + 4, f"{value:.0%}" if percent else number(value), anchor="end")
        middle = (scale.start + scale.end) / 2
        self.parts.append(
            f'<text x="14" y="{middle}" class="label" text-anchor="middle" '
            f'transform="rotate(-90 14 {middle})">{escape(label)}</text>'
        )


def _title(text: str) -> str:
    return f"<title>{escape(text)}</title>" if text else ""
