"""The comparison of a VHDL bench covers everything that the bench writes."""

from __future__ import annotations

import pytest

from firm_hdl.cases.make import Case
from firm_hdl.plan import build_plan
from firm_hdl.verify.bench import _check_transfers, _compare
from firm_hdl.wire import lay_out
from tests.strategies import make

MESSAGE = make("ros1", {"x": "int16", "b": "bool", "s": "string"})
PLAN = build_plan(lay_out(MESSAGE), bus_bytes=2)
CASES = [
    Case(
        what=what,
        value=None,
        packet=b"",
        transfers={
            ("x",): [x],
            ("b",): [1],
            ("s", "length"): [3],
            ("s", "items"): [((97, 98), False), ((99, 0), True)],
        },
    )
    for what, x in (("one", -2), ("two", 5))
]
LINES = [
    "4 x FFFE",
    "4 b 1",
    "5 s.length 00000003",
    "6 s.items 6261",
    "7 s.items 0063 *",
    "9 x 0005",
    "9 b 1",
    "9 s.length 00000003",
    "12 s.items 6261",
    "17 s.items 0063 *",
]


def check(lines):
    return _check_transfers(PLAN, CASES, "".join(f"{line}\n" for line in lines))


def test_correct_output_is_counted():
    assert check(LINES) == 10


@pytest.mark.parametrize(
    ("change", "output"),
    [
        ({0: "4 x FFFF"}, "transfers of x: number 0 of 2 is ['FFFF'] instead of ['FFFE']"),
        ({1: "4 b 0"}, "transfers of b: number 0 of 2 "),
        ({1: "4 b X"}, "transfers of b: number 0 of 2 is ['X'] instead of ['1']"),
        ({9: "17 s.items 0063"}, "transfers of s.items: number 3 of 4 is ['0063'] instead of"),
        ({8: "12 s.items 6261 *"}, "transfers of s.items: number 2 of 4 is ['6261 *'] instead"),
        # A byte in a lane that the string does not use.
        ({9: "17 s.items A563 *"}, "transfers of s.items: number 3 of 4 "),
        ({7: None}, "transfers of s.length: number 1 of 2 is [] instead of ['00000003']"),
        ({9: None}, "transfers of s.items: number 3 of 4 is [] instead of ['0063 *']"),
        ({0: "4 x FFFE\n5 x FFFE"}, "transfers of x: number 1 of 2 is ['FFFE'] instead of"),
        ({9: "17 s.items 0063 *\n18 s.items 0000"}, "transfers of s.items: number 4 of 4 is ["),
        ({9: "17 s.items 0063 *\n18 y 00"}, "transfers of leaves that there are not: y"),
        # The right data on another leaf.
        ({0: "4 y FFFE"}, "transfers of x: number 0 of 2 is ['0005'] instead of ['FFFE']"),
    ],
)
def test_transfers(change, output):
    lines = [change.get(number, line) for number, line in enumerate(LINES)]
    with pytest.raises(AssertionError) as caught:
        check([line for line in lines if line is not None])
    assert str(caught.value).startswith(output)


@pytest.mark.parametrize(
    ("got", "output"),
    [
        ("00\n0101\n", "number 1 of 2 is ['0101'] instead of ['01']"),
        ("00\n", "number 1 of 2 is [] instead of ['01']"),
        ("00\n01\n02\n", "number 2 of 2 is ['02'] instead of []"),
        ("00\n01\n\n", "number 2 of 2 is [''] instead of []"),
        ("01\n00\n", "number 0 of 2 is ['01'] instead of ['00']"),
        ("00\n0X\n", "number 1 of 2 is ['0X'] instead of ['01']"),
        ("", "number 0 of 2 is [] instead of ['00']"),
    ],
)
def test_packets(got, output):
    with pytest.raises(AssertionError) as caught:
        _compare("packets", got, "00\n01\n")
    assert str(caught.value) == f"packets: {output}"
    _compare("packets", "00\n01\n", "00\n01\n")
