"""Every shape of small pictures: position, size, colour and text, computed by hand."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

from firm_hdl.wire import lay_out
from firm_hdl.wire.picture import COLOURS, to_svg
from tests.frontend.workspace import library

NAME_OF = {colour: kind for kind, colour in COLOURS.items()}


def shapes_of(picture):
    """Return the shapes after the background, each as words in a line."""
    _, _, *shapes = picture
    lines = []
    for shape in shapes:
        at = f"{shape.get('x')},{shape.get('y')}"
        if shape.tag.endswith("text"):
            lines.append(f"text {at} {shape.get('class') or '-'} {shape.text}")
            continue
        style = (shape.get("style") or "").removeprefix("fill:").partition(";")[0]
        colour = NAME_OF[shape.get("fill") or style]
        size = f"{shape.get('width')}x{shape.get('height')}"
        titles = [each.text for each in shape]
        lines.append(" ".join(["rect", at, size, colour, *titles]))
    return lines


def drawn(tmp_path, dialect, wire, texts):
    layout = lay_out(library(tmp_path, texts, dialect).message("p/T"), wire)
    picture = ElementTree.fromstring(to_svg(layout, "p/T"))
    return shapes_of(picture), (picture.get("width"), picture.get("height"))


# A byte is 42 pixels wide, a row 22 high; the left edge is at 64, and 18 further in a loop.
HEADS = ["text 8,20 h p/T", *(f"text {85 + 42 * lane},44 o c +{lane}" for lane in range(8))]

ROS1 = """\
text 56,65 o 0
rect 64,50 84x22 field a uint16, 2 bytes
text 106,65 c a
rect 148,50 252x22 field b uint32[7], 28 bytes
text 274,65 c b
text 410,65 - a uint16, b uint32[7]
text 56,87 o 8
rect 64,72 336x22 field b uint32[7], 28 bytes
text 56,109 o 16
rect 64,94 336x22 field b uint32[7], 28 bytes
text 56,131 o 24
rect 64,116 252x22 field b uint32[7], 28 bytes
rect 64,144 336x22 loop
text 72,159 - q: 2 times
rect 6,166 5x28 loop
text 74,187 o +0
rect 82,172 168x22 length q.item.x.length uint32, 4 bytes
text 166,187 c length
text 428,187 - q.item.x.length uint32
rect 6,194 5x28 loop
rect 82,200 336x22 data
text 90,215 - q.item.x: length x uint8
text 56,243 o +0
rect 64,228 42x22 field z int8, 1 bytes
text 85,243 c z
text 410,243 - z int8
"""


def test_rows_stand_below_each_other_and_parts_beside_each_other(tmp_path):
    texts = {"p/T": "uint16 a\nuint32[7] b\nPart[2] q\nint8 z\n", "p/Part": "uint8[] x\n"}
    found, size = drawn(tmp_path, "ros1", "ros1", texts)
    assert found == HEADS + ROS1.splitlines()
    # The right edge is that of the longest label: 22 characters of 6.7 pixels, and a margin.
    assert size == (str(428 + int(22 * 6.7) + 12), "256")


CDR = """\
text 56,65 o 0
rect 64,50 168x22 header encapsulation 4 bytes, 4 bytes
text 148,65 c encapsulation
text 410,65 - encapsulation 4 bytes
text 56,93 o 4
rect 64,78 42x22 field a uint8, 1 bytes
text 85,93 c a
rect 106,78 294x22 padding padding, 7 bytes
text 253,93 c padding
text 410,93 - a uint8
text 56,115 o 12
rect 64,100 336x22 field b uint64[5], 40 bytes
text 232,115 c b
text 410,115 - b uint64[5]
rect 64,122 336x22 field b uint64[5], 40 bytes
text 232,137 c ... 3 rows
text 56,159 o 44
rect 64,144 336x22 field b uint64[5], 40 bytes
text 56,181 o 52
rect 64,166 168x22 length s.length uint32, 4 bytes
text 148,181 c length
text 410,181 - s.length uint32
rect 64,194 336x22 data
text 72,209 - s: length x uint8, and a NUL that length counts
rect 64,222 336x22 padding
text 72,237 - 0 to 3 bytes of padding, to a multiple of 4
text 56,265 o +0
rect 64,250 168x22 field c uint32, 4 bytes
text 148,265 c c
text 410,265 - c uint32
"""


def test_header_padding_and_rows_that_are_left_out(tmp_path):
    texts = {"p/T": "uint8 a\nuint64[5] b\nstring s\nuint32 c\n"}
    found, size = drawn(tmp_path, "ros2", "cdr", texts)
    assert found == HEADS + CDR.splitlines()
    assert size == (str(410 + int(21 * 6.7) + 12), "278")
