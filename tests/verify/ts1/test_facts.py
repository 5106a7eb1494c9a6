"""Facts of a model, and their comparison."""

from __future__ import annotations

from firm_hdl.frontend import Library, load_message
from firm_hdl.identity.md5 import md5sum
from firm_hdl.identity.rihs import type_hash
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


def test_primitives_that_an_oracle_does_not_distinguish_are_equal(tmp_path):
    fields = structure(model(tmp_path), {"char": "uint8"})["p/msg/A"]["fields"]
    assert fields[2]["type"] == "uint8"


def test_equal_facts_have_no_differences(tmp_path):
    facts = structure(model(tmp_path))
    assert list(differences(facts, facts)) == []


def test_differences_are_listed_by_path(tmp_path):
    ours = structure(model(tmp_path))
    changed = TEXT.replace("-3", "-4").replace("<=5", "<=6").replace("1.5", "1.25")
    theirs = structure(model(tmp_path, changed))
    assert [str(each) for each in differences(ours, theirs)] == [
        "p/msg/A/fields/names/type: firm-hdl 'string<=5[<=3]'; oracle 'string<=6[<=3]'",
        "p/msg/A/fields/speed/default: firm-hdl [1.5, 0.5]; oracle [1.25, 0.5]",
        "p/msg/A/constants/LOW/value: firm-hdl -3; oracle -4",
        "p/msg/A/constants/LOW/text: firm-hdl '-3'; oracle '-4'",
    ]


def test_another_set_or_order_of_fields_is_one_difference(tmp_path):
    ours = structure(model(tmp_path, "int8 a\nint8 b"))
    for text, listed in [("int8 a", "['a']"), ("int8 b\nint8 a", "['b', 'a']")]:
        theirs = structure(model(tmp_path, text))
        assert [str(each) for each in differences(ours, theirs)] == [
            f"p/msg/A/fields: firm-hdl ['a', 'b']; oracle {listed}"
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


def test_each_of_many_members_is_compared():
    members = [{"name": f"a{number}", "type": "int8"} for number in range(40)]
    for number in (0, 9, 39):
        other = [*members]
        other[number] = {"name": f"a{number}", "type": "uint8"}
        assert [each.path for each in differences(members, other, "s")] == [f"s/a{number}/type"]


def test_single_facts_are_counted():
    assert [count_facts(each) for each in (1, "a", None, [1, 2], {}, [])] == [1, 1, 1, 1, 0, 1]
    fields = [{"name": "a", "type": "b"}, {"name": "c", "type": "d", "default": [1, 2]}]
    assert count_facts({"s": {"A": {"fields": fields, "constants": []}}, "md5": {"A": "x"}}) == 7


def test_values_are_compared_with_their_types_and_signs():
    nan = float("nan")
    assert list(differences(nan, nan)) == []
    for ours, theirs in [(1, True), (1, 1.0), (0.0, -0.0), ("1", 1), (None, 0), ([], "")]:
        assert len(list(differences(ours, theirs))) == 1, (ours, theirs)


def test_long_values_are_shortened():
    (difference,) = differences("x" * 5000, "y")
    assert len(str(difference)) < 400
    # The quotes count, too.
    (difference,) = differences("x" * 298, "y" * 299)
    assert str(difference) == f": firm-hdl '{'x' * 298}'; oracle '{'y' * 299}..."


def test_each_part_of_an_action_has_its_own_hash_and_sum(tmp_path):
    texts = {"p/action/A.action": "int8 a\n---\nint16 b\n---\nint32 c\n"}
    for distro, key in (("lyrical", "hash"), ("noetic", "md5")):
        library = Library(distro, [make_files(tmp_path / distro, texts)])
        action = library.interface("p/A")
        own = {each.name: key for each in action.messages}
        if key == "hash":
            parts = (action, *action.messages, *action.services)
            own = {each.name: type_hash(each) for each in parts}
        else:
            own = {each.name: md5sum(each) for each in action.messages}
        assert len(set(own.values())) == len(own) > 6
        assert facts_of(action, [key]) == {key: own}
