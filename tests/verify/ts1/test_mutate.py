"""Mutated definitions: the mutation rules, and agreement with the oracles on the mutants."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.ts1 import mutate as rules
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.mutate import mutation
from firm_hdl.verify.ts1.run import Ts1Run
from tests.depth import by_depth
from tests.frontend.workspace import make_files
from tests.verify.ts1.conftest import judged_by, need

ROS1 = {
    "p/msg/A.msg": "# All.\nint8 LOW=-5\nfloat32 F = 1.5  # f\nbool ON=True\nstring S= x # y \n"
    "Header header\nuint16[3] codes\nstring[] names\nB b\ntime t\n",
    "p/msg/B.msg": "byte b\nchar c\nq/C[] cs\n",
    "p/srv/S.srv": "int8 a\n---\nB b  # b\n",
    "p/action/Do.action": "int8 g\n---\nint8 r\n---\nfloat32 f\n",
    "q/msg/C.msg": "duration d\nbool x\n",
}
ROS2 = {
    "p/msg/A.msg": "# All.\n\nint8 LOW=-5\nfloat32 F = 1.5  # [m]\nbool ON=true\nstring S='x y'\n"
    "std_msgs/Header header\nuint16[3] codes [1, 2, 3]\nstring<=5[<=2] names [\"a\", 'b']\n"
    'B b\nwstring w "x"\nbool ok true\n',
    "p/msg/B.msg": "byte b 1\nchar c 65\nq/C[] cs\nfloat64[<=4] xs\n",
    "p/srv/S.srv": "int8 a 3\n---\nB b  # b\n",
    "p/action/Do.action": "int8 g\n---\nint8 r\n---\nfloat32 f\n",
    "q/msg/C.msg": "bool x\n",
}


@pytest.mark.parametrize(
    ("distro", "oracle", "count"),
    [
        ("noetic", "genmsg", by_depth(120, 250)),
        ("lyrical", "rosidl_adapter", by_depth(120, 250)),
        ("lyrical", "rosidl_parser", by_depth(60, 100)),
    ],
)
def test_oracles_and_we_agree_on_mistakes(tmp_path, distro, oracle, count):
    root = make_files(tmp_path, ROS1 if distro == "noetic" else ROS2)
    request = Request(distros=(distro,), paths=(str(root),), mutations=count)
    with Ts1Run(replace(request, oracles=(oracle,), jobs=1)) as run:
        need(oracle, run.missing.get(oracle))
        tally, wrong = judged_by(run)
    assert wrong == []
    assert sum(tally.verdicts.values()) - tally.verdicts[oracle, "not judged"] == count
    # Some mutants are invalid, and some are valid.
    assert count / 5 < tally.refused[oracle] < count * 9 / 10


def test_a_mutation_is_decided_by_its_number(court):
    cases = court("lyrical", ROS2).universe.select([])
    texts = [mutation(cases, number) for number in range(200)]
    assert texts == [mutation(cases, number) for number in range(200)]
    assert len({case.text for case in texts}) > 150
    assert all(case.text != case.before for case in texts)


def test_later_versions_make_the_mutations_that_a_report_names(court):
    """If a text of this table changes, the numbers in earlier reports mean other mutations."""
    files = {"p/msg/A.msg": "int8 a 5\n", "p/msg/B.msg": "bool[2] b\n"}
    cases = court("lyrical", files).universe.select([])
    assert [mutation(cases, number).text for number in range(12)] == [
        *("int8 ]a 5\n", "B{ool[2] b\n", "int8 a 5=[1]\n", "int8  a5\r", "iint8 a 5\n"),
        *("bOol[2] b\n", "int5 a 5\n", "int8 a \x0b5\n", "bool[2]] b\n", "int 8 5\n"),
        *("bOol[2] b\n", "bool[2] b\nbool[2] b\n"),
    ]
    assert [rules._tokens(random.Random(number), "a b c d") for number in range(7)] == [
        *("a b c", "a a b c d", "b c d", "a b b c d", "a b d", "c a b d", "a b c d d"),
    ]
    found = [rules._lines(random.Random(number), "a\nb\nc\nd") for number in (4, 5, 7, 8)]
    assert found == ["b\na\nc\nd", "a\nb\nc d", "a\nb\nc\nc\nd", "a\nc\nd\nb"]


def test_changes_are_listed_by_line(court):
    cases = court("lyrical", {"p/msg/A.msg": "int8 a\n"}).universe.select([])
    changed = mutation(cases, 1)
    assert changed.changes and all(line[0] in "+-" for line in changed.changes)


def test_an_empty_text_can_be_mutated(court):
    cases = court("lyrical", {"p/msg/A.msg": ""}).universe.select([])
    assert all(mutation(cases, number).is_changed for number in range(50))


def mutants(rule, text, times=600):
    """Return all texts that a rule makes from a text."""
    return {rule(random.Random(number), text) for number in range(times)}


def test_characters_are_dropped_doubled_swapped_and_put_in():
    assert mutants(rules._drop_character, "abc") == {"bc", "ac", "ab", "abc"}
    assert mutants(rules._double_character, "abc") == {"aabc", "abbc", "abcc", "abc"}
    assert mutants(rules._swap_characters, "abc") == {"bac", "acb", "abc"}
    found = mutants(rules._insert_sign, "ab", 3000)
    assert found == {
        text for sign in rules._SIGNS for text in (f"{sign}ab", f"a{sign}b", f"ab{sign}")
    }


def test_words_and_values_are_others_in_one_place():
    assert mutants(rules._change_digit, "a1b2") == {f"a{n}b2" for n in range(10)} | {
        f"a1b{n}" for n in range(10)
    }
    assert mutants(rules._change_case, "aB 1") == {"AB 1", "ab 1"}
    assert mutants(rules._change_value, "int8 A=1 2#x\n") == {
        f"int8 A={each}#x\n" for each in rules._NUMBERS
    }
    assert mutants(rules._change_value, "int8[3] a\nstring b\nint8[4] c") == {
        text.format(each)
        for each in rules._NUMBERS
        for text in ("int8[{}] a\nstring b\nint8[4] c", "int8[3] a\nstring b\nint8[{}] c")
    }
    assert mutants(rules._change_value, "string<3> a; int8[4] b") == {
        text.format(each)
        for each in rules._NUMBERS
        for text in ("string<{}> a; int8[4] b", "string<3> a; int8[{}] b")
    }
    assert mutants(rules._change_type, "int8 a\nq/B b") == {
        text for each in rules._TYPES for text in (f"{each} a\nq/B b", f"int8 a\n{each} b")
    }
    assert mutants(rules._change_name, "int8 a_1") == {f"int8 {each}" for each in rules._NAMES}
    assert mutants(rules._add_value, "int8 a\n\nb)", 2000) == {
        f"int8 a{sign}{n}\n\nb)" for sign in (" ", "=", " = ") for n in rules._NUMBERS
    }


def test_a_rule_without_a_place_changes_nothing():
    for rule in (rules._change_digit, rules._change_value, rules._change_name, rules._add_value):
        assert mutants(rule, "--", 20) == {"--"}
    assert mutants(rules._change_case, "1", 20) == {"1"}


def test_comments_are_spared_where_anything_else_is():
    assert mutants(rules._change_digit, "a1 # 2") == {f"a{n} # 2" for n in range(10)}
    assert mutants(rules._change_digit, "a # 2") == {f"a # {n}" for n in range(10)}
    assert mutants(rules._change_digit, "a # 2\nb1") == {f"a # 2\nb{n}" for n in range(10)}


def test_characters_of_comments_are_seldom_changed():
    text = "ab # cdefghijklmnopqrstuvwxyz\n"
    for rule in (rules._drop_character, rules._double_character, rules._insert_sign):
        found = [rule(random.Random(number), text) for number in range(400)]
        spared = [each for each in found if each.endswith("# cdefghijklmnopqrstuvwxyz\n")]
        # Without the rule for comments, it would be 80.
        assert 120 < len(spared) < 400


def test_one_rule_is_applied_and_sometimes_a_second(monkeypatch):
    monkeypatch.setattr(rules, "_RULES", (lambda _, text: f"{text}a", lambda _, text: f"{text}b"))
    found = [rules.mutate("", random.Random(number)) for number in range(500)]
    assert {*found} == {"a", "b", "aa", "ab", "ba", "bb"}
    assert 50 < sum(len(each) == 2 for each in found) < 200


def test_only_texts_of_some_length_are_changed(court):
    files = {"p/msg/A.msg": "int8 a\n", "p/msg/B.msg": "# " + "x" * 19_998, "p/msg/C.msg": "int8 c"}
    cases = court("lyrical", files).universe.select([])
    names = {mutation(cases, number).name for number in range(60)}
    assert names == {"A", "B", "C"}
    longer = [replace(case, text=case.text + "x" * (case.name == "B")) for case in cases]
    assert {mutation(longer, number).name for number in range(60)} == {"A", "C"}
    # If all texts are long, they are changed nevertheless.
    assert mutation(longer[1:2], 3).before == longer[1].text


def test_lines_are_dropped_repeated_moved_indented_joined_and_ended():
    assert mutants(rules._lines, "a\nb\nc", 5000) == {
        # Dropped, repeated, moved.
        *("b\nc", "a\nc", "a\nb"),
        *("a\na\nb\nc", "a\nb\nb\nc", "a\nb\nc\nc"),
        *("a\nb\nc", "b\na\nc", "b\nc\na", "c\na\nb", "a\nc\nb"),
        # Indented, or with another line end.
        *(f"{i}a\nb\nc" for i in (" ", "\t", "  ")),
        *(f"a\n{i}b\nc" for i in (" ", "\t", "  ")),
        *(f"a\nb\n{i}c" for i in (" ", "\t", "  ")),
        *(f"a{e}\nb\nc" for e in (" ", "\t", "\r", " # x", "#x", " [m]")),
        *(f"a\nb{e}\nc" for e in (" ", "\t", "\r", " # x", "#x", " [m]")),
        *(f"a\nb\nc{e}" for e in (" ", "\t", "\r", " # x", "#x", " [m]")),
        # Joined.
        *("ab\nc", "a b\nc", "a\nbc", "a\nb c"),
        *(end.join("abc") for end in ("\r\n", "\r", "\n\n")),
    }


def test_words_are_dropped_repeated_and_moved():
    assert mutants(rules._tokens, "a b\nc", 2000) == {
        *("b\nc", "a\nc", "a b\n"),
        *("a a b\nc", "a b b\nc", "a b\nc c"),
        *("a b\nc", "b a\nc"),
    }


def case_of(name, text):
    return DefinitionCase(
        dialect="ros1", package="p", kind="msg", name=name, language="msg", text=text
    )


def test_if_all_texts_are_long_any_of_them_is_changed(monkeypatch):
    monkeypatch.setattr(rules, "_MOST_CHARACTERS", 4)
    cases = [case_of(name, f"int8 {name}\n") for name in "abc"]
    assert {mutation(cases, number).name for number in range(40)} == {*"abc"}


def test_rules_are_applied_until_a_text_is_another_one_and_to_an_empty_text_once(monkeypatch):
    asked = []

    def mutate(text, generator):
        asked.append(text)
        assert len(asked) < 9
        return text if len(asked) < 3 else f"{text}x"

    monkeypatch.setattr(rules, "mutate", mutate)
    found = mutation([case_of("A", "int8 a\n")], 1)
    assert (found.text, found.before, len(asked)) == ("int8 a\nx", "int8 a\n", 3)
    # No rule may have a place in an empty text.
    asked.clear()
    found = mutation([case_of("A", "")], 1)
    assert (found.text, found.before, len(asked)) == ("", "", 1)
