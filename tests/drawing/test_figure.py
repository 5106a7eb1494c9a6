"""Elements of figures: their positions, classes and texts."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import pytest

from firm_hdl.drawing.document import document
from firm_hdl.drawing.svg import Figure, Scale


def parts_of(method, *arguments, **options):
    figure = Figure(200, 100, "A < B")
    getattr(figure, method)(*arguments, **options)
    return figure.parts


def test_figure_states_its_label_and_size():
    figure = Figure(200, 100, "A < B")
    head = '<svg viewBox="0 0 200 100" role="img" aria-label="A &lt; B" style="max-width:200px">'
    assert str(figure) == f"{head}</svg>"
    figure.line(1, 2, 3, 4, "grid")
    figure.line(5, 6, 7, 8, "axis")
    lines = (
        '<line x1="1" y1="2" x2="3" y2="4" class="grid"/>'
        '<line x1="5" y1="6" x2="7" y2="8" class="axis"/>'
    )
    assert str(figure) == f"{head}{lines}</svg>"
    assert Figure(1, 1, "").parts == []


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (
            ("text", 1, 2, "a<b"),
            '<text x="1" y="2" class="tick" text-anchor="middle">a&lt;b</text>',
        ),
        (
            ("text", 1, 2, "a", "label", "end"),
            '<text x="1" y="2" class="label" text-anchor="end">a</text>',
        ),
        (("dot", 1, 2, "c1"), '<circle cx="1" cy="2" r="2.5" class="c1"></circle>'),
        (
            ("dot", 1, 2, "c1", "a<b", 4),
            '<circle cx="1" cy="2" r="4" class="c1"><title>a&lt;b</title></circle>',
        ),
        (
            ("box", 1, 2, 3, 4.25, "c2"),
            '<rect x="1.0" y="2.0" width="3.0" height="4.2" class="c2"></rect>',
        ),
        (
            ("box", 1, 2, 3, 4, "c2", "x"),
            '<rect x="1.0" y="2.0" width="3.0" height="4.0" class="c2"><title>x</title></rect>',
        ),
        (("path", [(1, 2), (3, 4), (5, 6)], "c1"), '<path d="M1 2L3 4L5 6" class="c1"></path>'),
        (
            ("path", [(1, 2), (3, 4), (5, 6)], "c1", "x", True),
            '<path d="M1 2H3V4H5V6" class="c1"><title>x</title></path>',
        ),
        (("path", [], "c1"), '<path d="" class="c1"></path>'),
    ],
)
def test_elements_of_each_shape(call, part):
    assert parts_of(*call) == [part]


def test_a_horizontal_axis_has_a_grid_above_it():
    parts = parts_of("x_axis", Scale(0, 2.5, 10, 110), 50, "cycles", 5)
    assert parts == [
        '<line x1="10.0" y1="50" x2="10.0" y2="5" class="grid"/>',
        '<text x="10.0" y="65" class="tick" text-anchor="middle">0</text>',
        '<line x1="30.0" y1="50" x2="30.0" y2="5" class="grid"/>',
        '<text x="30.0" y="65" class="tick" text-anchor="middle">0.5</text>',
        '<line x1="50.0" y1="50" x2="50.0" y2="5" class="grid"/>',
        '<text x="50.0" y="65" class="tick" text-anchor="middle">1</text>',
        '<line x1="70.0" y1="50" x2="70.0" y2="5" class="grid"/>',
        '<text x="70.0" y="65" class="tick" text-anchor="middle">1.5</text>',
        '<line x1="90.0" y1="50" x2="90.0" y2="5" class="grid"/>',
        '<text x="90.0" y="65" class="tick" text-anchor="middle">2</text>',
        '<line x1="110.0" y1="50" x2="110.0" y2="5" class="grid"/>',
        '<text x="110.0" y="65" class="tick" text-anchor="middle">2.5</text>',
        '<line x1="10" y1="50" x2="110" y2="50" class="axis"/>',
        '<text x="60.0" y="83" class="label" text-anchor="middle">cycles</text>',
    ]


@pytest.mark.parametrize(("percent", "ends"), [(False, ("0", "1")), (True, ("0%", "100%"))])
def test_a_vertical_axis_has_a_grid_beside_it(percent, ends):
    parts = parts_of("y_axis", Scale(0, 1, 90, 10), 40, "a<b", 190, percent)
    assert parts[0] == '<line x1="40" y1="90.0" x2="190" y2="90.0" class="grid"/>'
    assert parts[1] == f'<text x="34" y="94.0" class="tick" text-anchor="end">{ends[0]}</text>'
    assert parts[-3] == '<line x1="40" y1="10.0" x2="190" y2="10.0" class="grid"/>'
    assert parts[-2] == f'<text x="34" y="14.0" class="tick" text-anchor="end">{ends[1]}</text>'
    assert parts[-1] == (
        '<text x="14" y="50.0" class="label" text-anchor="middle" '
        'transform="rotate(-90 14 50.0)">a&lt;b</text>'
    )
    # A line and a text for each of 0, 0.2 and so on, and the label.
    assert len(parts) == 2 * 6 + 1


def test_a_file_has_a_size_a_style_sheet_and_a_background():
    figure = Figure(200, 100, "A > B")
    figure.line(1, 2, 3, 4, "grid")
    figure.text(5, 6, "a<b>c", "label")
    space = "{http://www.w3.org/2000/svg}"
    root = ElementTree.fromstring(document(figure))
    assert root.tag == f"{space}svg"
    sizes = [root.get(name) for name in ("width", "height", "viewBox", "aria-label")]
    assert sizes == ["200", "100", "0 0 200 100", "A > B"]
    style, paper, line, text = root
    assert style.tag == f"{space}style" and "prefers-color-scheme: dark" in style.text
    assert paper.tag == f"{space}rect"
    assert paper.attrib == {"width": "200", "height": "100", "class": "paper"}
    assert (line.tag, line.get("y2"), text.text) == (f"{space}line", "4", "a<b>c")
    # Each element has a line, so that two versions of a file can be compared.
    assert [each[:6] for each in document(figure).splitlines()[-3:]] == [
        "<line ",
        "<text ",
        "</svg>",
    ]
