"""Covering sets of types."""

from __future__ import annotations

from firm_hdl.covering.choose import all_features, choose, features
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out

PARTS = {"a": "xyz", "b": "x", "c": "yzw", "d": "w"}


def test_the_chosen_have_everything_and_each_adds_something():
    chosen = choose(PARTS, dict.fromkeys(PARTS, 1.0))
    assert [(each.name, each.adds) for each in chosen] == [("a", ("x", "y", "z")), ("c", ("w",))]


def test_cheap_types_are_preferred():
    chosen = choose(PARTS, {"a": 10, "b": 1, "c": 3, "d": 1})
    assert [each.name for each in chosen] == ["b", "c"]


def test_the_first_by_name_of_equal_types_is_taken():
    for names in ("ab", "ba"):
        (chosen,) = choose(dict.fromkeys(names, "x"), dict.fromkeys(names, 1.0))
        assert chosen.name == "a"


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
    # Without any one of them, its features are not covered.
    for name in names[-5:]:
        others = (types[other] for other in names if other != name)
        assert set().union(*others) != everything


def test_features_are_found_in_nested_types():
    library = Library("lyrical")
    message = library.message("geometry_msgs/msg/PolygonStamped")
    found = features(message, build_plan(lay_out(message)))
    assert {"sequence of message", "field float32", "field string"} <= found
    assert "field float64" not in found


def every_feature(library, name, **options):
    message = library.message(name)
    return all_features(library, message, build_plan(lay_out(message)), **options)


def test_padding_and_bounds_make_layouts_differ():
    library = Library("lyrical")
    solid = every_feature(library, "shape_msgs/msg/SolidPrimitive")
    joy = every_feature(library, "sensor_msgs/msg/Joy")
    assert any("bounded" in feature for feature in solid if feature.startswith("layout: "))
    assert not any("bounded" in feature for feature in joy)
    noetic = every_feature(Library("noetic"), "sensor_msgs/Joy")
    assert not any("by packet" in feature for feature in noetic)


def test_definitions_in_idl_have_productions_of_idl(tmp_path):
    folder = tmp_path / "own_msgs" / "msg"
    folder.mkdir(parents=True)
    (tmp_path / "own_msgs" / "package.xml").write_text("<package><name>own_msgs</name></package>")
    text = "module own_msgs { module msg { struct Mine { sequence<long, 3> x; }; }; };"
    (folder / "Mine.idl").write_text(text)
    (folder / "Ours.msg").write_text("Mine[2] mine\n")
    found = every_feature(Library("lyrical", [tmp_path]), "own_msgs/msg/Mine")
    grammar = {feature for feature in found if feature.startswith("grammar: ")}
    assert grammar and all(feature.startswith("grammar: idl ") for feature in grammar)
    assert any("sequence_type" in feature for feature in grammar)
    # A type of one language in one of another has both.
    both = every_feature(Library("lyrical", [tmp_path]), "own_msgs/msg/Ours")
    assert grammar < both and "grammar: ros2 array: OPEN SIZE CLOSE" in both
