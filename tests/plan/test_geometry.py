"""What plans need of their windows, worked out by hand."""

from __future__ import annotations

import pytest

from firm_hdl.plan import build_plan
from firm_hdl.plan.geometry import geometry
from firm_hdl.wire import lay_out
from tests.strategies import make


def needs(fields, wire, bus_bytes, window_words=1):
    layout = lay_out(make("ros2", fields), wire)
    return geometry(build_plan(layout, bus_bytes=bus_bytes, window_words=window_words))


@pytest.mark.parametrize(
    ("fields", "wire", "bus_bytes", "alignment", "beats"),
    [
        # Steps are whole bus words.
        ({"a": "uint64"}, "ros1", 8, 8, 1),
        ({"a": "uint32", "b": "uint64", "c": "uint32"}, "ros1", 8, 8, 1),
        ({"a": "uint8[3]", "b": "uint32"}, "ros1", 4, 4, 1),
        # Items start behind a length of four bytes, which CDR has behind a header of four.
        ({"s": "string"}, "ros1", 4, 4, 1),
        ({"s": "string"}, "ros1", 8, 4, 2),
        ({"s": "string"}, "cdr", 8, 8, 1),
        ({"a": "uint64[]"}, "cdr", 8, 4, 2),
        # Anything may follow text; what follows items is where items end.
        ({"s": "string", "n": "uint8"}, "ros1", 8, 1, 2),
        ({"s": "string", "n": "uint8"}, "cdr", 8, 1, 1),
        ({"a": "uint16[]", "b": "uint16"}, "cdr", 4, 2, 1),
    ],
)
def test_where_steps_start_and_how_far_they_reach(fields, wire, bus_bytes, alignment, beats):
    found = needs(fields, wire, bus_bytes)
    assert (found.start_alignment_bytes, found.window_beats) == (alignment, beats)


def test_padding_that_is_computed():
    assert needs({"s": "string", "n": "uint32"}, "cdr", 8).aligns
    assert not needs({"s": "string", "n": "uint32"}, "ros1", 8).aligns
    assert needs({"a": "uint64[]"}, "cdr", 4).aligns


def test_bytes_that_a_step_takes_and_goes_forward():
    found = needs({"a": "uint64[]"}, "cdr", 8)
    # Encapsulation, length and four bytes of padding.
    assert (found.window_bytes, found.skip_bytes) == (8, 12)
    found = needs({"a": "uint32[]"}, "ros1", 8, window_words=2)
    # The length and a bus word of items.
    assert (found.window_bytes, found.skip_bytes) == (12, 12)


def test_an_empty_run_ends_in_front_of_the_padding_of_items():
    # Only from there do later steps reach into a third beat.
    fields = {"a": "uint64[]", "b": "uint8", "c": "uint32[5]", "d": "uint32[]"}
    assert needs(fields, "cdr", 8, window_words=2).window_beats == 3
    assert needs(fields, "cdr", 16, window_words=2).window_beats == 3
