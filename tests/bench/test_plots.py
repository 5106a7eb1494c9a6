"""What a reader sees in a plot: where bars, numbers, names and curves are."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from xml.etree.ElementTree import Element

import pytest

from firm_hdl.bench.plots import area_plot, beats_plot, clock_plot
from firm_hdl.bench.results import Result
from firm_hdl.wire import Wire
from tests.bench.results import result

Plot = Callable[[Sequence[Result]], str]
SVG = "{http://www.w3.org/2000/svg}"
SEEDS = {"deserializer": (60.0, 110.0, 100.0), "serializer": (170.0, 240.0, 180.0)}
LUT = {"deserializer": 200, "serializer": 400}


def found(name: str, wire: Wire = "cdr") -> list[Result]:
    """Return a converter of each direction; the median rate of seeds is their last."""
    each = [
        result(name, direction=way, mhz=SEEDS[way], lut=LUT[way])
        for way in ("serializer", "deserializer")
    ]
    return [replace(one, converter=replace(one.converter, wire=wire)) for one in each]


# Those of a type are not side by side, and one type has two wires.
RESULTS = [
    *found("p/msg/B")[:1],
    *found("p/msg/A"),
    *found("p/msg/B")[1:],
    *found("p/msg/A", "ros1"),
]
ROWS = ["B, cdr", "A, cdr", "A, ros1"]


def place(part: Element, name: str) -> float:
    return float(part.get(name) or "nan")


def bars_of(root: Element) -> list[Element]:
    return [box for box in root.findall(f"{SVG}rect") if box.findall(f"{SVG}title")]


def texts_of(root: Element, anchor: str, kind: str) -> dict[str, Element]:
    found = root.findall(f"{SVG}text[@class='{kind}']")
    return {text.text or "": text for text in found if text.get("text-anchor") == anchor}


def value_at(root: Element, x: float) -> float:
    """Return the value at a place, by the numbers of the axis."""
    ticks = {
        float(text): place(each, "x") for text, each in texts_of(root, "middle", "tick").items()
    }
    low, high = min(ticks), max(ticks)
    return low + (high - low) * (x - ticks[low]) / (ticks[high] - ticks[low])


PLOTS: list[tuple[Plot, Mapping[str, float]]] = [
    (clock_plot, {way: seeds[-1] for way, seeds in SEEDS.items()}),
    (area_plot, LUT),
]


@pytest.mark.parametrize(("plot", "values"), PLOTS)
def test_bars_are_in_rows_below_each_other(plot: Plot, values: Mapping[str, float]) -> None:
    root = ElementTree.fromstring(plot(RESULTS))
    bars = bars_of(root)
    assert len(bars) == len(RESULTS)
    for upper, lower in pairwise(bars):
        assert place(upper, "y") + place(upper, "height") < place(lower, "y")
    (axis,) = root.findall(f"{SVG}line[@class='axis']")
    assert (
        place(bars[-1], "y") + place(bars[-1], "height") < place(axis, "y1") < place(root, "height")
    )
    # The two bars of a row have its name between them, and the legend has their colours above.
    names = texts_of(root, "end", "row")
    assert list(names) == ROWS
    kinds = [box.get("class") for box in root.findall(f"{SVG}rect") if box.get("class") != "paper"]
    legend = dict(zip(texts_of(root, "start", "row"), kinds, strict=False))
    assert list(legend) == ["deserializer", "serializer"]
    for row, name in enumerate(ROWS):
        for way, bar in zip(legend, bars[2 * row : 2 * row + 2], strict=True):
            assert re.search(rf" {way}: {values[way]:g}", bar[0].text or "")
            assert bar.get("class") == legend[way]
            right = place(bar, "x") + place(bar, "width")
            assert value_at(root, place(bar, "x")) == pytest.approx(0, abs=0.2)
            assert value_at(root, right) == pytest.approx(values[way], rel=0.005)
        top, bottom = place(bars[2 * row], "y"), place(bar, "y") + place(bar, "height")
        assert top < place(names[name], "y") < bottom and place(names[name], "x") < place(bar, "x")


@pytest.mark.parametrize(("plot", "values"), PLOTS)
def test_a_number_is_beside_its_bar_and_behind_its_line_inside_the_figure(
    plot: Plot, values: Mapping[str, float]
) -> None:
    root = ElementTree.fromstring(plot(found("p/msg/A")))
    numbers = texts_of(root, "start", "tick")
    assert list(numbers) == [f"{value:.0f}" for value in values.values()]
    lines = root.findall(f"{SVG}line[@class='whisker']")
    for row, (bar, number) in enumerate(zip(bars_of(root), numbers.values(), strict=True)):
        bottom = place(bar, "y") + place(bar, "height")
        assert place(bar, "y") < place(number, "y") < bottom
        assert place(bar, "x") + place(bar, "width") < place(number, "x")
        # Three digits of the smallest font have 20 pixels.
        assert place(number, "x") + 20 < place(root, "width")
        for line in lines[row : row + 1]:
            ends = [value_at(root, place(line, end)) for end in ("x1", "x2")]
            seeds = list(SEEDS.values())[row]
            assert ends == pytest.approx([min(seeds), max(seeds)], abs=0.5)
            assert place(bar, "y") < place(line, "y1") == place(line, "y2") < bottom
            assert place(number, "x") > place(line, "x2")


@pytest.mark.parametrize(("plot", "values"), PLOTS)
def test_a_converter_without_figures_keeps_its_place(
    plot: Plot, values: Mapping[str, float]
) -> None:
    whole = bars_of(ElementTree.fromstring(plot(RESULTS)))
    # The serializer of the first row was not placed, and nothing is known of it.
    root = ElementTree.fromstring(plot([replace(RESULTS[0], measured=None), *RESULTS[1:]]))
    assert list(texts_of(root, "end", "row")) == ROWS
    assert [place(bar, "y") for bar in bars_of(root)] == [
        place(bar, "y") for number, bar in enumerate(whole) if number != 1
    ]


def test_a_circuit_that_was_not_placed_has_an_area_and_no_rate() -> None:
    results = [result(mhz=()), result("p/msg/B")]
    assert len(bars_of(ElementTree.fromstring(clock_plot(results)))) == 1
    assert len(bars_of(ElementTree.fromstring(area_plot(results)))) == 2


def test_a_curve_of_beats_is_the_share_of_converters() -> None:
    slow, fast = result(beats=25), result("p/msg/B", beats=50)
    sets = {"one": [fast, slow, result("p/msg/C"), result("p/msg/D")], "two": [slow]}
    root = ElementTree.fromstring(beats_plot(sets))
    left, right, top, bottom = 62, 730, 34, 286

    def point(beats: float, share: float) -> tuple[float, float]:
        return round(left + (right - left) * beats, 1), round(bottom - (bottom - top) * share, 1)

    wanted: dict[str, list[tuple[float, float]]] = {
        "one": [(0, 0), (0.25, 0.25), (0.5, 0.5), (0.8, 0.75), (0.8, 1)],
        "two": [(0, 0), (0.25, 1)],
    }
    curves = {path[0].text: path for path in root.findall(f"{SVG}path")}
    assert list(curves) == list(wanted)
    keys = root.findall(f"{SVG}line[@class='curve c1']") + root.findall(
        f"{SVG}line[@class='curve c2']"
    )
    names = texts_of(root, "start", "row")
    assert list(names) == list(wanted) and len(keys) == 2
    for (name, points), key in zip(wanted.items(), keys, strict=True):
        path = re.findall(r"[MH]([\d.]+)[ V]([\d.]+)", curves[name].get("d") or "")
        assert [(float(x), float(y)) for x, y in path] == [point(*each) for each in points]
        # A line of the same colour is in front of the name.
        assert curves[name].get("class") == key.get("class")
        assert place(key, "x2") < place(names[name], "x")
        assert abs(place(key, "y1") - place(names[name], "y")) <= 6 and key.get("y1") == key.get(
            "y2"
        )


def test_more_curves_than_colours_are_drawn_all() -> None:
    root = ElementTree.fromstring(beats_plot({f"s{n}": [result()] for n in range(5)}))
    kinds = [path.get("class") for path in root.findall(f"{SVG}path")]
    assert kinds == [f"curve c{n}" for n in (1, 2, 3, 4, 1)]
    heights = [place(text, "y") for text in texts_of(root, "start", "row").values()]
    assert all(lower - upper >= 12 for upper, lower in pairwise(heights))
