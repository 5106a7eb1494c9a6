"""Messages of numbers in the place of wide text, for rosbags, which has no wide text."""

from __future__ import annotations

import numpy as np
import pytest

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.user_oracle import judge_of
from firm_hdl.cases.values import from_objects
from firm_hdl.cases.wide_oracle import STAND_IN_NOTE, WideOracle, fit_units, stand_ins
from firm_hdl.model import closure

TEXT = "uint8 a\nwstring w\nwstring<=3[2] two\nB[] list\nB one\nstring s\n"
INNER = "wstring<=3 v\nuint8 x\n"


@pytest.fixture
def message(make_message):
    return make_message(TEXT, B=INNER)


def test_each_wide_text_has_a_type_in_its_place(message):
    member = "units_of_wide_text"
    assert stand_ins(closure([message])) == {
        "firm_hdl_wide/msg/Text": f"uint32[] {member}\n",
        "firm_hdl_wide/msg/Text3": f"uint32[<=3] {member}\n",
    }
    assert stand_ins([message.children[0]]) == {
        "firm_hdl_wide/msg/Text3": f"uint32[<=3] {member}\n"
    }


def test_numbers_become_units_that_are_not_nul():
    numbers = np.array([0, 1, 0xFFFE, 0xFFFF, 0x10000, 0xFFFFFFFF], dtype=np.uint32)
    assert fit_units(numbers).tolist() == [1, 2, 0xFFFF, 1, 2, 1]


def value_of(oracle):
    def text(*numbers, bound=""):
        kind = oracle.store.types[f"firm_hdl_wide/msg/Text{bound}"]
        return kind(units_of_wide_text=np.array(numbers, dtype=np.uint32))

    def inner(*numbers):
        return oracle.store.types["p/msg/B"](v=text(*numbers, bound=3), x=7)

    two = [text(0x10001, bound=3), text(4, 5, bound=3)]
    return oracle.store.types["p/msg/A"](
        a=9, w=text(0x60, 0xFFFF), two=two, list=[inner(8), inner()], one=inner(1, 2, 3), s="x"
    )


PACKET = (
    "00010000 09 000000 02000000 61000000 01000000 01000000 03000000 02000000 05000000 06000000 "
    "02000000 01000000 09000000 07 000000 00000000 07 000000 "
    "03000000 02000000 03000000 04000000 07 000000 02000000 7800"
)


def test_packets_and_transfers_are_those_of_wide_text(message):
    judge = judge_of(message, stand_in=True)
    assert isinstance(judge.oracle, WideOracle) and judge.note == STAND_IN_NOTE
    value = value_of(judge.oracle)
    packet = judge.oracle.write(value, judge.name, "cdr")
    assert packet == bytes.fromhex(PACKET)
    read = judge.oracle.read(packet, judge.name, "cdr")
    found = judge.oracle.transfers(read, judge.name, "cdr", 8)
    assert found["w", "length"] == [2] and found["w", "items"] == [((0x61, 1), True)]
    assert found["two", "item", "length"] == [1, 2]
    assert found["list", "item", "v", "length"] == [1, 0]
    assert found["list", "item", "v", "items"] == [((9, 0), True)]
    assert found["one", "v", "items"] == [((2, 3), False), ((4, 0), True)]
    assert found["one", "x"] == [7] and found["s", "length"] == [1]
    # What follows the last wide text is there, too.
    assert found["s", "items"] == [((0x78, *[0] * 7), True)]
    assert not any("units_of_wide_text" in path for path in found)
    plain = from_objects(message, value)
    assert (plain["w"], plain["two"]) == ([0x61, 1], [[3], [5, 6]])
    assert plain["one"] == {"v": [2, 3, 4], "x": 7}


def test_types_without_wide_text_have_the_usual_oracle(make_message):
    message = make_message("string s\n")
    assert not isinstance(judge_of(message, stand_in=True).oracle, WideOracle)
    with pytest.raises(NotJudgedError, match="has no wstring"):
        judge_of(make_message("wstring w\n"))
