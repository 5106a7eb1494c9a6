"""Covering sets of types."""

from __future__ import annotations

from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.verify.cover import choose, features
from firm_hdl.wire import lay_out

PARTS = {"a": "xyz", "b": "x", "c": "yzw", "d": "w"}


def test_the_chosen_have_everything_and_each_adds_something():
    chosen = choose(PARTS, dict.fromkeys(PARTS, 1.0))
    assert [(each.name, each.adds) for each in chosen] == [("a", ("x", "y", "z")), ("c", ("w",))]


def test_cheap_types_are_preferred():
    chosen = choose(PARTS, {"a": 10, "b": 1, "c": 3, "d": 1})
    assert [each.name for each in chosen] == ["b", "c"]


def test_nothing_to_cover_needs_nothing():
    assert choose({}, {}) == []
    assert choose({"a": ""}, {"a": 1}) == []


def test_a_distribution_is_covered_by_few_types():
    library = Library("lyrical")
    types = {}
    for name in library.names():
        message = library.message(name)
        types[name] = features(message, build_plan(lay_out(message)))
    chosen = choose(types, dict.fromkeys(types, 1.0))
    names = [each.name for each in chosen]
    assert len(names) < 40
    everything = set().union(*types.values())
    assert set().union(*(types[name] for name in names)) == everything
    # Leaving any one out loses what it was chosen for.
    for name in names[-5:]:
        others = (types[other] for other in names if other != name)
        assert set().union(*others) != everything


def test_features_are_found_in_nested_types():
    library = Library("lyrical")
    message = library.message("geometry_msgs/msg/PolygonStamped")
    found = features(message, build_plan(lay_out(message)))
    assert {"sequence of message", "field float32", "field string"} <= found
    assert "field float64" not in found
