"""Where values may start and end, as sets of residues modulo 8."""

from __future__ import annotations

import pytest

from firm_hdl.model import PRIMITIVES, Array, Field, FieldType, Message, Sequence, String
from firm_hdl.wire import CDR, ROS1
from firm_hdl.wire.alignment import LENGTH, Alignment
from firm_hdl.wire.rules import WireRules

UINT8, UINT32, FLOAT64 = (PRIMITIVES["ros2"][name] for name in ("uint8", "uint32", "float64"))
EMPTY = Message(name="p/msg/Empty", dialect="ros2", fields=())
PAIR = Message(
    name="p/msg/Pair",
    dialect="ros2",
    fields=(Field(name="a", type=UINT32), Field(name="b", type=UINT8)),
)


def residues(*numbers: int) -> int:
    return sum(1 << number for number in numbers)


@pytest.mark.parametrize(
    ("kind", "at", "after"),
    [
        (UINT32, residues(0), residues(4)),
        (UINT32, residues(1, 5), residues(0, 4)),
        (FLOAT64, residues(1, 5), residues(0)),
        (String(), residues(0), residues(*range(8))),
        (String(wide=True), residues(1), residues(0, 4)),
        (EMPTY, residues(3), residues(4)),
        (PAIR, residues(0), residues(5)),
        (Array(element=PAIR, count=3), residues(0), residues(5)),
        (Array(element=PAIR, count=2), residues(0), residues(5)),
        (Sequence(element=FLOAT64), residues(0), residues(0, 4)),
        (Sequence(element=PAIR), residues(0), residues(1, 4)),
    ],
)
def test_a_value_ends_where_cdr_lets_it(kind: object, at: int, after: int) -> None:
    assert Alignment(CDR).after(kind, at) == after  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("kind", "entry"),
    [
        # Later elements need no padding, so they start where the one before ends.
        (Array(element=UINT32, count=9), residues(0)),
        (Sequence(element=FLOAT64), residues(4)),
        (Array(element=PAIR, count=1), residues(0)),
        (Array(element=PAIR, count=2), residues(0, 5)),
        (Sequence(element=PAIR), residues(1, 4)),
    ],
)
def test_an_element_starts_where_one_before_may_end(kind: Array | Sequence, entry: int) -> None:
    assert Alignment(CDR).entry(kind, residues(0)) == entry


def test_ros1_has_no_alignment() -> None:
    alignment = Alignment(ROS1)
    assert [alignment.of(each) for each in (UINT8, UINT32, FLOAT64)] == [1, 1, 1]
    assert alignment.pad(FLOAT64, residues(*range(8))) == 0
    assert alignment.after(EMPTY, residues(3)) == residues(3)
    assert alignment.past(LENGTH, residues(3)) == residues(7)

    assert alignment.shortest(EMPTY, 3) == 0
    assert alignment.shortest(Array(element=PAIR, count=3), 2) == 15


@pytest.mark.parametrize(
    ("rules", "element", "size"),
    [
        # The first element needs no padding, and each later one 3 bytes.
        (CDR, PAIR, 8),
        (ROS1, PAIR, 5),
        (CDR, String(), 4),
        (CDR, EMPTY, 1),
        (ROS1, EMPTY, 0),
        (CDR, Array(element=UINT8, count=3), 3),
        (CDR, Array(element=PAIR, count=2), 16),
    ],
)
def test_repeated_elements_are_padded_as_those_after_the_first(
    rules: WireRules, element: FieldType, size: int
) -> None:
    assert Alignment(rules).repeated(element) == size


def test_padding_that_differs_is_not_known() -> None:
    alignment = Alignment(CDR)
    found: list[int | None] = [alignment.pad(UINT32, at) for at in (residues(1), residues(0, 1))]
    assert found == [3, None]


@pytest.mark.parametrize(
    ("kind", "start", "size"),
    [
        (UINT32, 0, 4),
        (UINT32, 1, 7),
        (PAIR, 0, 5),
        (PAIR, 5, 8),
        # 5 bytes, and 3 of padding before each further element.
        (Array(element=PAIR, count=3), 0, 5 + 8 + 8),
        (Array(element=PAIR, count=3), 2, 7 + 8 + 8),
        (Array(element=FLOAT64, count=2), 4, 4 + 8 + 8),
        (Array(element=PAIR, count=0), 1, 0),
        (Sequence(element=PAIR), 6, 2 + 4),
        (String(), 3, 1 + 4),
        (EMPTY, 3, 1),
    ],
)
def test_shortest_values_are_padded_as_cdr_pads_them(kind: object, start: int, size: int) -> None:
    assert Alignment(CDR).shortest(kind, start) == size  # type: ignore[arg-type]
