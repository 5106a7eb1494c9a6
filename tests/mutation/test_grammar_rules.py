"""The mutants that each rule for grammars makes."""

from __future__ import annotations

import pytest

from tools.mutation.rules.grammar_rules import changes, is_fault


@pytest.mark.parametrize(
    ("line", "rule", "changed"),
    [
        ("A: B | C | D", "drop alternative", ["A:  C | D", "A: B | C", "A: B | D"]),
        ("A: B (C | D)*", "drop alternative", ["A: B ( D)*", "A: B (C )*"]),
        ("A: B [C]", "drop optional", ["A: B"]),
        ("A: B* C? D+", "quantifier", ["A: B* C D+", "A: B* C? D*", "A: B+ C? D+"]),
        ("A: /a*b/", "quantifier", ["A: /a+b/"]),
        ("A: /[*+]\\*(?:a|b)/", "quantifier", []),
        ("A: /[*|]a|b/", "drop alternative", ["A: /[*|]a/", "A: /b/"]),
        ("A: /[a-f_]/", "class border", ["A: /[a-e_]/", "A: /[b-f_]/"]),
        ("A: /a(?=b)(?<!c)/", "drop look-around", ["A: /a(?<!c)/", "A: /a(?=b)/"]),
        ("A.2: /a/", "drop priority", ["A: /a/"]),
        ("A: /a/ // b* [c] | d", "quantifier", []),
        ('A: "a|b*"', "drop alternative", []),
    ],
)
def test_rules(line, rule, changed):
    found = [change.apply(line) for change in changes(line) if change.rule == rule]
    assert sorted(text.rstrip() for text in found) == changed


def test_comments_between_rules_stay():
    text = "// a | b*\na: B\n\n// c? [d]\nB: /b/\n%ignore B\n"
    assert changes(text) == []


def test_grammar_that_lark_refuses_is_no_mutant():
    text = 'start: A B*\nA: "a"\nB: /[b-c]|d/\n'
    good = {change.apply(text) for change in changes(text) if is_fault(text, change, ["start"])}
    assert text.replace("B*", "B+") in good
    assert text.replace("[b-c]|", "") in good
    (empty,) = changes("start: A\nA: /a?/\n")
    assert is_fault("start: A\nA: /a?/\n", empty, ["start"])
    # A terminal that matches no text.
    text = 'start: A B\nA: "a"\nB: /b+/\n'
    assert not any(is_fault(text, change, ["start"]) for change in changes(text))
