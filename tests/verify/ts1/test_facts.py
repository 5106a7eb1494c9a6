"""Facts of a model, and their comparison."""

from __future__ import annotations

from firm_hdl.frontend import load_message
from firm_hdl.verify.ts1.facts import count_facts, differences, facts_of
from tests.frontend.workspace import make_files

TEXT = """# Head.
int32 LOW = -3  # lowest
string<=5[<=3] names ["a", "b"]
# Speed [m/s].
float64[2] speed [1.5, .5]
char c
std_msgs/Header header
"""


def model(tmp_path, text=TEXT):
    make_files(tmp_path, {"p/msg/A.msg": text})
    return load_message("p/msg/A", paths=[tmp_path])


def structure(message, alike=None):
    return facts_of(message, ["structure"], alike)["structure"]


def test_facts_have_the_whole_definition(tmp_path):
    plain = {"default": None, "comment": "", "unit": None}
    facts = structure(model(tmp_path))["p/msg/A"]
    assert facts["comment"] == "Head."
    assert facts["constants"] == [
        {
            "name": "LOW",
            "type": "int32",
            "value": -3,
            "text": "-3",
            "comment": "lowest",
            "unit": None,
        }
    ]
    assert facts["fields"] == [
        {**plain, "name": "names", "type": "string<=5[<=3]", "default": ["a", "b"]},
        {
            "name": "speed",
            "type": "float64[2]",
            "default": [1.5, 0.5],
            "comment": "Speed.",
            "unit": "m/s",
        },
        {**plain, "name": "c", "type": "char"},
        {**plain, "name": "header", "type": "std_msgs/msg/Header"},
    ]


def test_a_list_without_members_differs_from_one_with_members_by_its_names():
    members = [{"name": "a", "type": "int8"}, {"name": "b", "type": "int16"}]
    for ours, theirs, listed in (
        ([], members, "[]; oracle ['a', 'b']"),
        (members, [], "['a', 'b']; oracle []"),
    ):
        found = [str(each) for each in differences({"s": ours}, {"s": theirs})]
        assert found == [f"s: firm-hdl {listed}"]
    assert list(differences([], [])) == []
    # Other lists are compared as a whole, and so are those with something else among members.
    for other in ([1, 2], [*members, 1], [1, *members]):
        assert list(differences(other, [*other])) == [] and count_facts(other) == 1
        assert len(list(differences(members, other))) == 1
        assert len(list(differences(other, members))) == 1


def test_a_missing_fact_of_ours_is_a_difference_and_one_of_the_oracle_is_none():
    assert [str(each) for each in differences({"a": 1}, {"b": 2})] == [
        "b: firm-hdl has none; oracle 2"
    ]
    assert list(differences({"a": 1, "b": 2}, {"b": 2})) == []
    # An empty fact is a fact.
    for nothing in (None, "", [], {}, 0, False):
        (found,) = differences({"a": 1}, {"a": 1, "b": nothing})
        assert str(found) == f"b: firm-hdl has none; oracle {nothing!r}"
    ours = {"a": {"b": {"c": 1, "d": 2, "e": 3, "f": 4}}}
    theirs = {"a": {"b": {"c": 1, "d": 0, "e": 3, "f": 5}}, "g": 6}
    assert [each.path for each in differences(ours, theirs)] == ["a/b/d", "a/b/f", "g"]


def test_single_facts_are_counted():
    assert [count_facts(each) for each in (1, "a", None, [1, 2], {}, [])] == [1, 1, 1, 1, 0, 1]
    fields = [{"name": "a", "type": "b"}, {"name": "c", "type": "d", "default": [1, 2]}]
    assert count_facts({"s": {"A": {"fields": fields, "constants": []}}, "md5": {"A": "x"}}) == 7


def test_values_are_compared_with_their_types_and_signs():
    nan = float("nan")
    assert list(differences(nan, nan)) == []
    for ours, theirs in [(1, True), (1, 1.0), (0.0, -0.0), ("1", 1), (None, 0), ([], "")]:
        assert len(list(differences(ours, theirs))) == 1, (ours, theirs)
