"""The picture of a layout: exactly the bytes of the wire, in their order."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from itertools import pairwise

import pytest

from firm_hdl.frontend import Library
from firm_hdl.wire import lay_out
from firm_hdl.wire.picture import BYTE_WIDTH, INDENT, LEFT, ROW_BYTES, Note, bands, to_svg
from tests.frontend.workspace import library

SVG = "{http://www.w3.org/2000/svg}"

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
        if isinstance(band, Note):
            lines.append(f"{indent}{band.kind}: {band.text}")
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


def rects(picture):
    """Return the drawn cells: left edge, top, width, and title of each."""
    found = []
    for rect in picture.iter(f"{SVG}rect"):
        title = rect.find(f"{SVG}title")
        if title is not None:
            x, y, width = (int(rect.get(name)) for name in ("x", "y", "width"))
            found.append((x, y, width, title.text))
    return found


@pytest.mark.parametrize("name", ["sensor_msgs/msg/Imu", "sensor_msgs/msg/PointCloud2"])
@pytest.mark.parametrize("wire", ["cdr", "ros1"])
def test_cells_stand_where_their_bytes_are(name, wire):
    layout = lay_out(Library().message(name), wire)
    picture = ElementTree.fromstring(to_svg(layout, name))
    drawn = rects(picture)
    width, height = (float(picture.get(key)) for key in ("width", "height"))
    assert all(x + w <= width and y < height for x, y, w, _ in drawn)
    for band in bands(layout):
        if isinstance(band, Note):
            continue
        left = LEFT + band.depth * INDENT
        for cell in band.cells:
            text = f"{f'{cell.name} {cell.type}'.strip()}, {cell.bytes} bytes"
            x, y, w, _ = next(rect for rect in drawn if rect[3] == text)
            drawn.remove((x, y, w, text))
            assert (x - left) / BYTE_WIDTH == cell.at % ROW_BYTES
            row = min(cell.bytes, ROW_BYTES - cell.at % ROW_BYTES)
            assert w == row * BYTE_WIDTH
            pieces = [row]
            rows = -(-(cell.at + cell.bytes) // ROW_BYTES) - cell.at // ROW_BYTES
            # Of more than four rows, three are drawn.
            for _ in range(min(rows, 4 if rows <= 4 else 3) - 1):
                x, y_next, w, _ = next(rect for rect in drawn if rect[3] == text and rect[1] > y)
                drawn.remove((x, y_next, w, text))
                assert x == left
                y = y_next
                pieces.append(w // BYTE_WIDTH)
            if rows <= 4:
                assert sum(pieces) == cell.bytes
            else:
                last = (cell.at + cell.bytes) % ROW_BYTES or ROW_BYTES
                assert pieces[1:] == [ROW_BYTES, last]
    assert drawn == []


def texts_of(text):
    return [each.text for each in ElementTree.fromstring(text).iter(f"{SVG}text")]


def test_offsets_count_from_the_start_of_the_packet(tmp_path):
    message = library(tmp_path, {"p/T": "uint64[9] a\nuint8 b\nuint8[] c"}).message("p/T")
    texts = texts_of(to_svg(lay_out(message, "cdr"), "p/T"))
    rows = [text for text in texts if re.fullmatch(r"\+?\d+", text)]
    # Column heads; the header; then 9 rows of 8 bytes, of which six are left out.
    assert rows == [*(f"+{lane}" for lane in range(8)), "0", "4", "68", "76"]
    assert "... 7 rows" in texts
    # After a part of variable size, offsets start again.
    message = library(tmp_path, {"p/U": "string s\nuint64[2] a"}).message("p/U")
    texts = texts_of(to_svg(lay_out(message, "ros1"), "p/U"))
    rows = [text for text in texts if re.fullmatch(r"\+?\d+", text)]
    assert rows[8:] == ["0", "+0", "+8"]


def test_special_characters_of_a_title_are_escaped(tmp_path):
    message = library(tmp_path, {"p/T": "uint8 a"}).message("p/T")
    title = "</text><script>&\"'"
    assert texts_of(to_svg(lay_out(message), title))[0] == title


@pytest.mark.parametrize(
    ("kind", "fits", "cut"),
    # A byte has room for 5 characters, two for 11, and a row of eight for 49.
    [("uint8", 5, 4), ("uint16", 11, 10), ("uint64", 49, 48)],
)
def test_names_without_room_are_cut(tmp_path, kind, fits, cut):
    for more in (0, 1):
        name = "n" * (fits + more)
        message = library(tmp_path / str(more), {"p/T": f"{kind} {name}"}).message("p/T")
        picture = ElementTree.fromstring(to_svg(lay_out(message, "ros1"), "p/T"))
        cells = [each.text for each in picture.iter(f"{SVG}text") if each.get("class") == "c"]
        assert cells == [name if not more else "n" * cut + "~"]


DEEP = {
    "p/Deep": "T[] a\nuint8 end",
    "p/T": f"uint64[5] first\nPart[2] parts\nstring {'long_' * 20}name\nuint64 last",
    "p/Part": "uint8 x\nuint64[9] y\nstring z",
}


def boxes_of(picture):
    """Return left, top, right and bottom of each rectangle but the background."""
    numbers = (
        [int(each.get(key)) for key in ("x", "y", "width", "height")]
        for each in picture.iter(f"{SVG}rect")
    )
    _, *boxes = [(x, y, x + width, y + height) for x, y, width, height in numbers]
    return boxes


@pytest.mark.parametrize("wire", ["cdr", "ros1"])
def test_bands_are_below_each_other_inside_the_picture(tmp_path, wire):
    layout = lay_out(library(tmp_path, DEEP).message("p/Deep"), wire)
    picture = ElementTree.fromstring(to_svg(layout, "p/Deep"))
    width, height = (int(picture.get(key)) for key in ("width", "height"))
    boxes = boxes_of(picture)
    assert all(x >= 0 and y >= 0 and right <= width for x, y, right, _ in boxes)
    assert max(bottom for *_, bottom in boxes) <= height
    for number, (x, y, right, bottom) in enumerate(boxes):
        for left, top, end, below in boxes[:number]:
            assert right <= left or end <= x or bottom <= top or below <= y
    # Texts that start at their left end, such as the names beside a row.
    ends = [
        int(each.get("x")) + 6.7 * len(each.text)
        for each in picture.iter(f"{SVG}text")
        if each.get("class") is None
    ]
    assert width - 20 <= max(ends) <= width
    # A rail for each loop around a band, from the left.
    rails = [x for x, _, right, _ in boxes if right - x == 5]
    depths = [band.depth for band in bands(layout)]
    assert rails == [6 + 8 * level for depth in depths for level in range(depth)]
    assert max(depths) == 2


def test_a_long_title_and_few_bytes_fit(tmp_path):
    layout = lay_out(library(tmp_path, {"p/T": "uint8 a"}).message("p/T"))
    title = "t" * 200
    picture = ElementTree.fromstring(to_svg(layout, title))
    assert int(picture.get("width")) >= 8 + 6.7 * len(title)


def test_a_box_has_room_for_its_text_and_is_not_smaller_than_a_row(tmp_path):
    name = "part_" * 12 + "end"
    layout = lay_out(library(tmp_path, {"p/T": f"string {name}\nuint8[] b"}).message("p/T"), "ros1")
    picture = ElementTree.fromstring(to_svg(layout, "p/T"))
    notes = [each.text for each in bands(layout) if isinstance(each, Note)]
    boxes = {
        text.text: tuple(int(rect.get(key)) for key in ("x", "y", "width", "height"))
        for rect, text in pairwise(picture)
        if text.text in notes
    }
    tops = []
    for text, (x, y, width, height) in boxes.items():
        assert (x, height) == (LEFT, 22)
        assert width == max(ROW_BYTES * BYTE_WIDTH, int(6.7 * len(text)) + 16)
        tops.append(y)
    assert [*boxes] == notes and len(name) > 50 > len(notes[1]) and tops == sorted(tops)
    assert int(picture.get("width")) >= LEFT + 8 + 6.7 * len(notes[0])
