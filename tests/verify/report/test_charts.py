"""Charts: each mark is at its place on the axes, and has its description."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace

import pytest

from firm_hdl.drawing.svg import Figure, Scale, seconds
from firm_hdl.verify.report import charts
from firm_hdl.verify.report.charts import counts_bar, cumulative, scatter, stages
from firm_hdl.verify.report.outcomes import Counts
from firm_hdl.verify.report.stats import Correlation, Fit, box_of, curve_of
from firm_hdl.verify.report.summary import Curve, Trend

TIMES = [0.1, 0.2, 0.3, 0.4, 10.0]


def a_curve(suite="ts3", times=TIMES, **more):
    known = {
        "suite": suite,
        "points": tuple(curve_of(times)),
        "within": {},
        "seconds": box_of(times),
        "cpu_seconds": None,
        "stages": {"generation": box_of(times), "testing": box_of([0.01, 0.02])},
        "stage_values": {"generation": tuple(times), "testing": (0.01, 0.02)},
    }
    return Curve(**{**known, **more})


def drawn(text):
    """Return the elements of a figure as (tag, attributes, title or text)."""
    root = ET.fromstring(text)
    return [(each.tag, each.attrib, each.findtext("title") or each.text or "") for each in root]


def of_kind(text, tag, kind):
    return [each for each in drawn(text) if each[0] == tag and each[1].get("class") == kind]


def at(element):
    return float(element[1]["cx"]), float(element[1]["cy"])


def test_a_suite_without_times_has_no_curve_and_the_next_one_has_its_own():
    text = cumulative([a_curve("none", [], points=(), seconds=None), a_curve("b"), a_curve("c")])
    titles = [each[2] for each in drawn(text) if each[0] == "path"]
    assert titles == ["b", "c"]
    kinds = [each[1]["class"] for each in drawn(text) if each[0] == "path"]
    assert kinds == ["curve c2", "curve c3"]


def test_the_curve_of_a_suite_climbs_from_its_fastest_test_to_all():
    text = cumulative([a_curve(), a_curve("slow", [100.0, 1000.0])])
    x = Scale.logarithmic([*TIMES, 100.0, 1000.0], 62, 740)
    y = Scale(0, 1, 286, 16)
    (path,) = of_kind(text, "path", "curve c1")
    expected = f"M{x(0.1)} {y(0)}" + "".join(f"H{x(v)}V{y(n / 5)}" for n, v in enumerate(TIMES, 1))
    assert path[1]["d"] == expected
    (slow,) = of_kind(text, "path", "curve c2")
    assert slow[1]["d"].startswith(f"M{x(100.0)} {y(0)}H{x(100.0)}V")
    median, most = of_kind(text, "circle", "mark c1")
    box = box_of(TIMES)
    assert at(median) == (x(box.median), y(0.5)) and at(most) == (x(box.p95), y(0.95))
    assert median[2] == f"ts3: 50% of tests within {seconds(box.median)}"
    assert most[2] == f"ts3: 95% of tests within {seconds(box.p95)}"


def test_the_axis_of_stages_has_the_least_and_the_most_of_all():
    # Only some values are drawn, but the box is computed from all.
    curve = a_curve(stage_values={"generation": (0.3,), "testing": (0.02,)})
    x = Scale.logarithmic([0.01, 10.0], 96, 740)
    text = stages(curve)
    whiskers = of_kind(text, "line", "whisker c1")
    assert (float(whiskers[0][1]["x1"]), float(whiskers[0][1]["x2"])) == (x(0.1), x(10.0))
    (other, _) = of_kind(text, "line", "whisker c2")
    assert (float(other[1]["x1"]), float(other[1]["x2"])) == (x(0.01), x(0.02))
    assert x(0.01) == 96 and x(10.0) == 740
    (dot,) = of_kind(text, "circle", "strip c1")
    assert at(dot) == (x(0.3), 12 + 32 + 8) and dot[2] == seconds(0.3)


def test_a_box_has_its_quartiles_at_their_places_on_the_axis():
    text = stages(a_curve())
    x = Scale.logarithmic([0.01, 10.0], 96, 740)
    box = box_of(TIMES)
    (rect,) = of_kind(text, "rect", "box c1")
    assert float(rect[1]["x"]) == x(box.q1)
    assert float(rect[1]["width"]) == pytest.approx(x(box.q3) - x(box.q1))
    assert float(rect[1]["height"]) == 16
    # The box covers the line between its ends.
    assert text.index("whisker c1") < text.index("box c1")
    assert rect[2] == (
        "generation: median 300 ms, quartiles 200 ms and 400 ms, "
        f"95 % within {seconds(box.p95)}, from 100 ms to 10 s"
    )
    (median,) = of_kind(text, "line", "median c1")
    assert median[1]["x1"] == median[1]["x2"] == str(x(box.median))
    _, p95 = of_kind(text, "line", "whisker c1")
    assert p95[1]["x1"] == p95[1]["x2"] == str(x(box.p95))
    assert (float(p95[1]["y2"]) - float(p95[1]["y1"])) == 10
    # A box of equal times has a visible width.
    same = a_curve(stages={"testing": box_of([1.0, 1.0])}, stage_values={"testing": (1.0,)})
    (rect,) = of_kind(stages(same), "rect", "box c1")
    assert float(rect[1]["width"]) == 2


def test_each_stage_has_its_row_and_its_name():
    text = stages(a_curve())
    rows = of_kind(text, "text", "row")
    assert [(each[2], float(each[1]["y"])) for each in rows] == [
        ("generation", 12 + 32 + 4),
        ("testing", 12 + 64 + 32 + 4),
    ]
    assert {each[1]["text-anchor"] for each in rows} == {"end"}
    root = ET.fromstring(text)
    assert root.get("viewBox") == f"0 0 760 {12 + 2 * 64 + 44}"


def test_a_stage_that_only_one_test_had_is_drawn_too():
    text = stages(a_curve(stages={"testing": box_of([0.5])}, stage_values={"testing": (0.5,)}))
    assert [each[2] for each in of_kind(text, "text", "row")] == ["testing"]
    assert [each[2] for each in of_kind(text, "circle", "strip c1")] == [seconds(0.5)]


def test_of_many_values_some_are_drawn(monkeypatch):
    monkeypatch.setattr(charts, "MOST_DOTS", 2)
    values = (0.1, 0.2, 0.3, 0.4, 0.5)
    curve = a_curve(stages={"testing": box_of(values)}, stage_values={"testing": values})
    titles = [each[2] for each in of_kind(stages(curve), "circle", "strip c1")]
    assert titles == [seconds(0.1), seconds(0.4)]
    trend = a_trend(points=tuple((value, value) for value in values))
    assert len(of_kind(scatter(trend), "circle", "point c1")) == 2


def a_trend(points=((1, 0.1), (10, 1.0), (100, 10.0)), power=None, linear=None):
    found = Correlation(count=3, spearman=0.5, pearson=0.5, power=power, linear=linear)
    return Trend(
        suite="ts3", metric="dynamic_leaves", time="total", correlation=found, points=points
    )


def test_points_of_a_trend_are_where_the_axes_say():
    text = scatter(a_trend(points=((1, 0.1), (0, 5.0), (7, 0), (10, 1.0), (100, 10.0))))
    x, y = Scale(1, 100, 62, 346, True), Scale(0.1, 10, 236, 14, True)
    dots = of_kind(text, "circle", "point c1")
    assert [at(each) for each in dots] == [
        (x(a), y(b)) for a, b in ((1, 0.1), (10, 1.0), (100, 10.0))
    ]
    assert dots[1][2] == "dynamic leaves 10: 1 s"
    assert not of_kind(text, "path", "fit-line") and not of_kind(text, "path", "fit-law")


def test_fits_are_drawn_inside_the_axes():
    law, line = Fit(a=0.1, b=1.0, r2=0.5), Fit(a=1.0, b=0.01, r2=0.25)
    text = scatter(a_trend(power=law, linear=line))
    x, y = Scale(1, 100, 62, 346, True), Scale(0.1, 10, 236, 14, True)
    (drawn_line,) = of_kind(text, "path", "fit-line")
    (drawn_law,) = of_kind(text, "path", "fit-law")
    assert drawn_line[1]["d"].startswith(f"M{x(1)} {y(1.01)}L")
    assert drawn_line[1]["d"].endswith(f"L{x(100)} {y(2.0)}")
    assert drawn_law[1]["d"].startswith(f"M{x(1)} {y(0.1)}L")
    assert drawn_line[2] == "line 1 + 0.01·x, R² 0.25"
    assert drawn_law[2] == "power law 0.1·x^1.00, R² 0.50"
    # No point, or only one, is inside the axes, so there is no line.
    for far in (Fit(a=1000.0, b=0.0, r2=0.0), Fit(a=1e-6, b=0.0, r2=0.0)):
        assert not of_kind(scatter(a_trend(power=far)), "path", "fit-law")


COUNTS = Counts(passed=96, known=1, failed=1, not_judged=1, not_run=1)


def test_a_bar_has_a_part_of_each_count():
    bar = counts_bar(COUNTS)
    parts = [(kind, float(a["x"]), float(a["width"]), title) for kind, a, title in drawn(bar)]
    assert [title for *_, title in parts] == [
        "96 passed",
        "1 known",
        "1 failed",
        "1 not judged",
        "1 not run",
    ]
    assert [width for _, _, width, _ in parts] == [94, 4, 4, 4, 4]
    assert [x for _, x, _, _ in parts] == [0, 94, 98, 102, 106]
    kinds = [a["class"] for _, a, _ in drawn(bar)]
    assert kinds == ["bar-pass", "bar-known", "bar-fail", "bar-skip", "bar-none"]
    assert 'aria-hidden="true"' in bar and "role" not in bar


def test_a_bar_leaves_out_counts_of_zero():
    parts = drawn(
        counts_bar(replace(COUNTS, passed=30, known=0, not_judged=0, not_run=0, failed=10))
    )
    assert [(a["class"], float(a["x"]), float(a["width"])) for _, a, _ in parts] == [
        ("bar-pass", 0, 82.5),
        ("bar-fail", 82.5, 27.5),
    ]


def test_marks_of_a_figure_are_written_down():
    figure = Figure(30, 20, "a < b")
    figure.text(1, 2, "x < y")
    figure.text(3, 4, "z", "row", "end")
    figure.dot(5, 6, "p")
    figure.dot(7, 8, "q", "r & s", 4)
    figure.line(1, 2, 3, 4, "l")
    figure.box(1, 2, 3.14, 4, "b", "t")
    figure.path([(1, 2), (3, 4), (5, 6)], "c", "u")
    figure.path([(1, 2), (3, 4)], "d", steps=True)
    root = ET.fromstring(str(figure))
    assert root.attrib == {
        "viewBox": "0 0 30 20",
        "role": "img",
        "aria-label": "a < b",
        "style": "max-width:30px",
    }
    assert drawn(str(figure)) == [
        ("text", {"x": "1", "y": "2", "class": "tick", "text-anchor": "middle"}, "x < y"),
        ("text", {"x": "3", "y": "4", "class": "row", "text-anchor": "end"}, "z"),
        ("circle", {"cx": "5", "cy": "6", "r": "2.5", "class": "p"}, ""),
        ("circle", {"cx": "7", "cy": "8", "r": "4", "class": "q"}, "r & s"),
        ("line", {"x1": "1", "y1": "2", "x2": "3", "y2": "4", "class": "l"}, ""),
        ("rect", {"x": "1.0", "y": "2.0", "width": "3.1", "height": "4.0", "class": "b"}, "t"),
        ("path", {"d": "M1 2L3 4L5 6", "class": "c"}, "u"),
        ("path", {"d": "M1 2H3V4", "class": "d"}, ""),
    ]


def test_axes_have_a_grid_line_and_a_figure_at_each_tick():
    figure = Figure(300, 200, "")
    x, y = Scale(0, 10, 50, 250), Scale(0, 1, 150, 50)
    figure.x_axis(x, 150, "across", 40)
    figure.y_axis(y, 50, "up", 260, percent=True)
    figure.y_axis(y, 50, "up", 260)
    text = str(figure)
    grid = [each[1] for each in drawn(text) if each[1].get("class") == "grid"]
    ticks = x.ticks()
    assert [float(a["x1"]) for a in grid[: len(ticks)]] == [x(value) for value in ticks]
    assert {(a["y1"], a["y2"]) for a in grid[: len(ticks)]} == {("150", "40")}
    assert {(a["x1"], a["x2"]) for a in grid[len(ticks) :]} == {("50", "260")}
    labels = of_kind(text, "text", "tick")
    across = labels[: len(ticks)]
    assert [(float(a["x"]), float(a["y"]), output) for _, a, output in across] == [
        (x(value), 165, f"{value:g}") for value in ticks
    ]
    up = labels[len(ticks) :]
    assert [output for *_, output in up] == [
        "0%",
        "20%",
        "40%",
        "60%",
        "80%",
        "100%",
        "0",
        "0.2",
        "0.4",
        "0.6",
        "0.8",
        "1",
    ]
    assert {(a["x"], a["text-anchor"]) for _, a, _ in up} == {("44", "end")}
    assert [float(a["y"]) for _, a, _ in up[:6]] == [y(value) + 4 for value in y.ticks()]
    names = of_kind(text, "text", "label")
    assert [(output, a["x"], a["y"]) for _, a, output in names] == [
        ("across", "150.0", "183"),
        ("up", "14", "100.0"),
        ("up", "14", "100.0"),
    ]
    (axis,) = of_kind(text, "line", "axis")
    assert [axis[1][name] for name in ("x1", "y1", "x2", "y2")] == ["50", "150", "250", "150"]
