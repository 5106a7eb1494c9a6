"""The features of a type, by hand: of its definition, of its layout on each wire, of its text."""

from __future__ import annotations

import pytest

from firm_hdl.covering.choose import all_features, cost
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out

from ..frontend.workspace import library

TEXTS = {
    "p/T": 'string NAME=a\nint8 X=1\nuint8 a 0\nstring<=3 b "x"\nwstring c\nint16[<=2] d\n'
    "Part[2] e\nNone f\nNone[] g\nfloat64[3] h\n",
    "p/Part": "wstring<=2[] x\n",
    "p/None": "",
}

DEFINITION = """\
array of float64
array of message
bounded sequence of int16
constant int8
constant string
default of bounded string
default of uint8
empty message
field bounded string
field empty message
field uint8
field wstring
sequence of bounded wstring
sequence of empty message
"""

# In the order of the fields: a and f, b, c, d, e, e.x, the texts in e.x, g, h.
CDR = """\
scalar of 1 bytes, gap of 0
run of 1 bytes, length: gap of 3, items: gap of 0, bounded, NUL
run of 4 bytes, length: gap to a multiple of 4, by packet, items: gap of 0
run of 2 bytes, length: gap of 0, items: gap of 0, bounded
loop, of a constant length
loop, length: gap to a multiple of 4, by packet
run of 4 bytes, length: gap of 0, items: gap of 0, bounded
loop, length: gap of 3
run of 8 bytes, of a constant length, items: gap to a multiple of 8, by packet
"""
ROS1 = """\
scalar of 1 bytes, gap of 0
run of 1 bytes, length: gap of 0, items: gap of 0, bounded
run of 4 bytes, length: gap of 0, items: gap of 0
run of 2 bytes, length: gap of 0, items: gap of 0, bounded
loop, of a constant length
loop, length: gap of 0
run of 4 bytes, length: gap of 0, items: gap of 0, bounded
trigger
run of 8 bytes, of a constant length, items: gap of 0
"""


def family(found, name):
    return {each.partition(": ")[2] for each in found if each.startswith(f"{name}: ")}


@pytest.mark.parametrize(("wire", "layout"), [("cdr", CDR), ("ros1", ROS1)])
def test_features_are_those_of_the_definition_and_of_the_wire(tmp_path, wire, layout):
    ours = library(tmp_path, TEXTS)
    message = ours.message("p/T")
    found = all_features(ours, message, build_plan(lay_out(message, wire)))
    assert family(found, "definition") == {*DEFINITION.splitlines()}
    assert family(found, "layout") == {*layout.splitlines()}
    assert f"wire {wire}" in family(found, "plan")


def test_builtin_types_have_fields_and_no_text(tmp_path):
    """Not even the production of an empty line."""
    ours = library(tmp_path, {"p/T": "time t\nuint8 b"}, "ros1")
    message = ours.message("p/T")
    found = all_features(ours, message, build_plan(lay_out(message)))
    assert family(found, "grammar") == {
        "ros1 field: INT_TYPE NAME",
        "ros1 field: TIME_TYPE NAME",
        "ros1 line: field",
    }
    assert family(found, "definition") == {"field message", "field uint32", "field uint8"}


def test_equal_types_have_the_productions_of_their_own_texts(tmp_path):
    found = []
    for name, text in (("one", "uint8 a 1\n"), ("other", "uint8 a 1  # one\n")):
        ours = library(tmp_path / name, {"p/T": text})
        message = ours.message("p/T")
        found.append(family(all_features(ours, message, build_plan(lay_out(message))), "grammar"))
    assert found[0] != found[1] and any("COMMENT" in production for production in found[1])


def test_the_cost_of_a_type_is_that_of_its_steps(tmp_path):
    message = library(tmp_path, {"p/T": "uint64[3] a\nuint8 b\nuint8 c\n"}).message("p/T")
    plans = [build_plan(lay_out(message), bus_bytes=bus) for bus in (1, 8)]
    assert len(plans[0].steps) > len(plans[1].steps)
    assert [cost(plan) for plan in plans] == [20 + len(plan.steps) for plan in plans]
