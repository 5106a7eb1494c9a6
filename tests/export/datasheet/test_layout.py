"""The picture of a layout: exactly the bytes of the wire, in their order."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

import pytest

from firm_hdl.export.datasheet.layout import ROW_BYTES, bands, layout_figure
from firm_hdl.export.datasheet.rows import INDENT, LEFT, MOST_ROWS, WIDTH, Row, draw_rows
from firm_hdl.export.datasheet.steps import plan_figure
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.plan.yaml import counted
from firm_hdl.wire import lay_out
from tests.frontend.workspace import library

BYTE = WIDTH / ROW_BYTES

TEXTS = {
    "p/T": "uint8 a\nuint16 b\nPart[2] parts\nstring<=5 s\nPart[<=3] more\nuint8[] raw\n"
    "float64[<=4] d\nuint32[3] e\nPart last\n",
    "p/Part": "uint8 x\nuint32 y\nfloat32[] z\n",
}


def bands_in_words(found):
    """Return bands as text: grids with their starts, and the place of each cell."""
    lines = []
    for band in found:
        indent = "  " * band.depth
        if isinstance(band, Row):
            lines.append(f"{indent}{band.kind}: {band.label}")
            continue
        lines.append(f"{indent}from {band.start}")
        for cell in band.cells:
            lines.append(f"{indent}- {cell.at}+{cell.bytes} {cell.kind} {cell.name} {cell.type}")
    return [line.rstrip() for line in lines]


CDR = """\
from 0
- 0+4 header encapsulation 4 bytes
from 4
- 0+1 field a uint8
- 1+1 padding padding
- 2+2 field b uint16
loop: parts: 2 times
  from None
  - 0+1 field parts.item.x uint8
  - 1+3 padding padding
  - 4+4 field parts.item.y uint32
  - 8+4 length parts.item.z.length uint32
  data: parts.item.z: length x float32
from None
- 0+4 length s.length uint32
data: s: length x uint8, at most 5, and a NUL that length counts
padding: 0 to 3 bytes of padding, to a multiple of 4
from None
- 0+4 length more.length uint32
loop: more: length (at most 3) times
  from None
  - 0+1 field more.item.x uint8
  - 1+3 padding padding
  - 4+4 field more.item.y uint32
  - 8+4 length more.item.z.length uint32
  data: more.item.z: length x float32
from None
- 0+4 length raw.length uint32
data: raw: length x uint8
padding: 0 to 3 bytes of padding, to a multiple of 4
from None
- 0+4 length d.length uint32
data: d: length x float64, at most 4, aligned to 8 if there are any
from None
- 0+12 field e uint32[3]
- 12+1 field last.x uint8
- 13+3 padding padding
- 16+4 field last.y uint32
- 20+4 length last.z.length uint32
data: last.z: length x float32
"""

ROS1_TEXTS = {
    "p/T": "uint8 a\nuint32 b\nstring s\ntime t\nPart[] q\nuint16[2] w\nEmpty n\n",
    "p/Part": "int8 x\n",
    "p/Empty": "",
}
ROS1 = """\
from 0
- 0+1 field a uint8
- 1+4 field b uint32
- 5+4 length s.length uint32
data: s: length x uint8
from None
- 0+4 field t.secs uint32
- 4+4 field t.nsecs uint32
- 8+4 length q.length uint32
loop: q: length times
  from None
  - 0+1 field q.item.x int8
from None
- 0+4 field w uint16[2]
data: n: no bytes
"""


def test_bands_are_the_wire_in_order(tmp_path):
    message = library(tmp_path / "cdr", TEXTS).message("p/T")
    assert bands_in_words(bands(lay_out(message, "cdr"))) == CDR.splitlines()
    message = library(tmp_path / "ros1", ROS1_TEXTS, "ros1").message("p/T")
    assert bands_in_words(bands(lay_out(message, "ros1"))) == ROS1.splitlines()


@pytest.mark.parametrize(
    ("text", "found"),
    [
        # The four bytes of the length need four more before an item of eight bytes.
        (
            "float64[] a",
            ["from 4", "- 0+4 length a.length uint32",
             "data: a: length x float64, after 4 bytes of padding if there are any"],
        ),
        (
            "uint32 a\nfloat64[<=2] b",
            ["from 4", "- 0+4 field a uint32", "- 4+4 length b.length uint32",
             "data: b: length x float64, at most 2"],
        ),
        (
            "uint16 a\nuint8[3] b\nuint16[1] c\nfloat64[2] d",
            ["from 4", "- 0+2 field a uint16", "- 2+3 field b uint8[3]", "- 5+1 padding padding",
             "- 6+2 field c uint16[1]", "- 8+16 field d float64[2]"],
        ),
        ("string a", ["from 4", "- 0+4 length a.length uint32",
                      "data: a: length x uint8, and a NUL that length counts"]),
    ],
)  # fmt: skip
def test_padding_of_a_known_place_has_a_known_size(tmp_path, text, found):
    layout = lay_out(library(tmp_path, {"p/T": text}).message("p/T"), "cdr")
    header = ["from 0", "- 0+4 header encapsulation 4 bytes"]
    assert bands_in_words(bands(layout)) == header + found


def shapes(figure, tag):
    return list(ElementTree.fromstring(str(figure)).iter(tag))


def texts_of(figure):
    return [each.text for each in shapes(figure, "text")]


def box(rect):
    x, y, width, height = (float(rect.get(key)) for key in ("x", "y", "width", "height"))
    return x, y, x + width, y + height


@pytest.mark.parametrize("name", ["sensor_msgs/msg/Imu", "sensor_msgs/msg/PointCloud2"])
@pytest.mark.parametrize("wire", ["cdr", "ros1"])
def test_cells_stand_where_their_bytes_are(name, wire):
    layout = lay_out(Library().message(name), wire)
    drawn = [
        (*box(each), each[0].text) for each in shapes(layout_figure(layout), "rect") if len(each)
    ]
    for band in bands(layout):
        if isinstance(band, Row):
            continue
        left = LEFT + band.depth * INDENT
        for cell in band.cells:
            text = f"{f'{cell.name} {cell.type}'.strip()}, {counted(cell.bytes, 'byte')}"
            end = cell.at + cell.bytes
            rows = -(-end // ROW_BYTES) - cell.at // ROW_BYTES
            # Of more than four rows, three are drawn.
            found = [next(each for each in drawn if each[4] == text)]
            found += [e for e in drawn if e[4] == text and e is not found[0]][: min(rows, 4) - 1]
            found = found[: rows if rows <= 4 else 3]
            for each in found:
                drawn.remove(each)
            places = [((x - left) / BYTE, (right - left) / BYTE) for x, _, right, _, _ in found]
            first, last = cell.at % ROW_BYTES, end % ROW_BYTES or ROW_BYTES
            assert [place for place, _ in places] == [first, *[0] * (len(found) - 1)]
            assert [place for _, place in places] == [*[ROW_BYTES] * (len(found) - 1), last]
            tops = [top for _, top, *_ in found]
            assert tops == sorted(tops)
    assert drawn == []


def test_offsets_count_from_the_start_of_the_packet(tmp_path):
    message = library(tmp_path, {"p/T": "uint64[9] a\nuint8 b\nuint8[] c"}).message("p/T")
    texts = texts_of(layout_figure(lay_out(message, "cdr")))
    rows = [text for text in texts if re.fullmatch(r"\+?\d+", text)]
    # Column heads; the header; then 9 rows of 8 bytes, of which six are left out.
    assert rows == [*(f"+{lane}" for lane in range(8)), "0", "4", "68", "76"]
    assert "... 7 rows" in texts
    # After a part of variable size, offsets start again.
    message = library(tmp_path, {"p/U": "string s\nuint64[2] a"}).message("p/U")
    texts = texts_of(layout_figure(lay_out(message, "ros1")))
    rows = [text for text in texts if re.fullmatch(r"\+?\d+", text)]
    assert rows[8:] == ["0", "+0", "+8"]


@pytest.mark.parametrize("left_out", [0, 1, 7])
def test_rows_beyond_the_most_are_left_out_and_counted(left_out):
    names = [f"row {number}" for number in range(MOST_ROWS + left_out)]
    found = texts_of(draw_rows([Row(label=name) for name in names], ""))
    assert sum(name not in found for name in names) == left_out
    notes = [f"{left_out} more rows are left out"] if left_out else []
    assert [text for text in found if text not in names] == notes


DEEP = {
    "p/Deep": "T[] a\nuint8 end",
    "p/T": f"uint64[5] first\nPart[2] parts\nstring {'long_' * 40}name\nuint64 last\n"
    + "".join(f"float64 x{n}\n" for n in range(300)),
    "p/Part": "uint8 x\nuint64[9] y\nstring z",
}


@pytest.mark.parametrize("wire", ["cdr", "ros1"])
@pytest.mark.parametrize("kind", ["layout", "plan"])
def test_rows_are_below_each_other_inside_a_picture_of_bounded_size(tmp_path, wire, kind):
    layout = lay_out(library(tmp_path, DEEP).message("p/Deep"), wire)
    figure = layout_figure(layout) if kind == "layout" else plan_figure(build_plan(layout))
    assert figure.width < 1200 and figure.height < 5000
    boxes = [box(each) for each in shapes(figure, "rect")]
    assert all(x >= 0 and y >= 0 for x, y, _, _ in boxes)
    assert all(right <= figure.width and bottom <= figure.height for _, _, right, bottom in boxes)
    for number, (x, y, right, bottom) in enumerate(boxes):
        for left, top, end, below in boxes[:number]:
            apart = right <= left + 0.11 or end <= x + 0.11
            assert apart or bottom <= top + 0.11 or below <= y + 0.11
    for each in shapes(figure, "text"):
        if each.get("text-anchor") == "start":
            assert float(each.get("x")) + 6.7 * len(each.text) <= figure.width
