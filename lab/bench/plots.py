"""Plots of results, as SVG files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from firm_hdl.bench.results import Result
from firm_hdl.bench.tables import LINE_RATE_MHZ, beats_per_cycle
from firm_hdl.drawing.document import document
from firm_hdl.drawing.svg import Figure, Scale

__all__ = ["area_plot", "beats_plot", "clock_plot"]

WIDTH, LEFT, RIGHT, TOP, ROW = 760, 240, 730, 34, 38
COLOURS = {"deserializer": "c1", "serializer": "c3"}


def clock_plot(results: Sequence[Result]) -> str:
    """Draw the clock rate of each converter: the median as a bar, and all seeds as a line."""
    label = "Clock rate in MHz; lines: all seeds; dashes: 10 Gbit/s of whole 8-byte beats"
    # Lines reach further than bars.
    rates = [placed.mhz for each in results if each.measured for placed in each.measured.placed]
    scale = Scale.linear([*rates, LINE_RATE_MHZ], LEFT, RIGHT)
    figure, bottom = _figure(results, scale, label)

    def draw(result: Result, y: float) -> None:
        each = [placed.mhz for placed in result.measured.placed] if result.measured else []
        if result.mhz is None:
            return
        title = f"{result.converter}: {result.mhz:.1f} MHz"
        _bar(figure, scale, result, y, result.mhz, title, max(each))
        figure.line(scale(min(each)), y + 6, scale(max(each)), y + 6, "whisker")

    _rows(figure, results, draw)
    at = scale(LINE_RATE_MHZ)
    figure.line(at, TOP, at, bottom, "goal")
    return document(figure)


def area_plot(results: Sequence[Result]) -> str:
    """Draw the look-up tables of each converter as a bar."""
    figures = [float(result.measured.area.lut) for result in results if result.measured]
    scale = Scale.linear(figures, LEFT, RIGHT)
    figure, _ = _figure(results, scale, "Look-up tables")

    def draw(result: Result, y: float) -> None:
        if result.measured is not None:
            area = result.measured.area
            title = f"{result.converter}: {area.lut} LUT, {area.ff} FF"
            _bar(figure, scale, result, y, area.lut, title)

    _rows(figure, results, draw)
    return document(figure)


def beats_plot(sets: Mapping[str, Sequence[Result]]) -> str:
    """Draw the cumulative share of converters over their beats per cycle, a line for each set."""
    figure = Figure(WIDTH, 340, "Beats per cycle of all converters")
    found = {name: beats_per_cycle(results) for name, results in sets.items()}
    x, y = Scale(0, 1, 62, RIGHT), Scale(0, 1, 286, TOP)
    figure.x_axis(x, 286, "beats per cycle", TOP)
    figure.y_axis(y, 62, "share of converters with at most so many", RIGHT, percent=True)
    for index, (name, pairs) in enumerate(found.items()):
        kind = f"c{index % 4 + 1}"
        points = [(x(0), y(0))]
        points += [(x(value), y((n + 1) / len(pairs))) for n, (value, _) in enumerate(pairs)]
        figure.path(points, f"curve {kind}", name, steps=True)
        figure.line(80, TOP + 16 + 18 * index, 104, TOP + 16 + 18 * index, f"curve {kind}")
        figure.text(112, TOP + 20 + 18 * index, name, "row", "start")
    return document(figure)


def _figure(results: Sequence[Result], scale: Scale, label: str) -> tuple[Figure, float]:
    """Return an empty figure with a row for each type, and the place of its axis."""
    bottom = TOP + ROW * len(_types(results))
    figure = Figure(WIDTH, bottom + 44, label)
    figure.x_axis(scale, bottom, label, TOP)
    for index, (name, kind) in enumerate(COLOURS.items()):
        figure.box(LEFT + 130 * index, 10, 12, 12, f"bar {kind}")
        figure.text(LEFT + 18 + 130 * index, 20, name, "row", "start")
    return figure, bottom


def _types(results: Sequence[Result]) -> list[tuple[str, str]]:
    return list(dict.fromkeys((each.converter.type, each.converter.wire) for each in results))


def _rows(figure: Figure, results: Sequence[Result], draw: Callable[[Result, float], None]) -> None:
    for row, (name, wire) in enumerate(_types(results)):
        top = TOP + ROW * row + 5
        figure.text(LEFT - 10, top + 18, f"{name.rpartition('/')[2]}, {wire}", "row", "end")
        for index, direction in enumerate(COLOURS):
            for result in results:
                what = result.converter
                if (what.type, what.wire, what.direction) == (name, wire, direction):
                    draw(result, top + 14 * index)


def _bar(
    figure: Figure,
    scale: Scale,
    result: Result,
    y: float,
    value: float,
    title: str,
    most: float = 0.0,
) -> None:
    """Draw a bar; write its number to the right of the bar and of `most`."""
    kind = f"bar {COLOURS[result.converter.direction]}"
    figure.box(LEFT, y, scale(value) - LEFT, 12, kind, title)
    figure.text(scale(max(value, most)) + 4, y + 10, f"{value:.0f}", anchor="start")
