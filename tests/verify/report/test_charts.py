"""Charts: each mark is at its place on the axes, and has its description."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest

from firm_hdl.drawing.svg import Scale, seconds
from firm_hdl.verify.report.charts import cumulative, scatter, stages
from firm_hdl.verify.report.summary import Correlation, Curve, Fit, Trend, box_of, curve_of

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


def a_trend(points=((1, 0.1), (10, 1.0), (100, 10.0)), power=None, linear=None):
    found = Correlation(count=3, spearman=0.5, pearson=0.5, power=power, linear=linear)
    return Trend(
        suite="ts3", metric="dynamic_leaves", time="total", correlation=found, points=points
    )


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
