"""Which known differences explain a difference, with an oracle and rules that a test controls."""

from __future__ import annotations

from typing import ClassVar

import pytest

from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.ts1 import explain
from firm_hdl.verify.ts1 import judge as judging
from firm_hdl.verify.ts1.judge import compare, read
from firm_hdl.verify.ts1.known.rule import KnownRule, mend_members
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Oracle, Refused


class Reader(Oracle):
    """An oracle with a given answer to each text."""

    name = "reader"
    languages: ClassVar = {"ros1": frozenset({"msg"})}

    def __init__(self, answers):
        self.answers = answers

    def missing(self):
        return None

    def judge(self, cases):
        for case in cases:
            yield self.answers[case.text]


def fields(*members):
    """Facts with fields, which are given as in a definition."""
    pairs = [member.split() for member in members]
    return {"structure": {"p/A": {"fields": [{"type": kind, "name": n} for kind, n in pairs]}}}


def rule(key, old="", new="", **more):
    """A rule that replaces a piece of text by another."""
    if old:
        more["rewrite"] = lambda case: case.text.replace(old, new)
    return KnownRule(key=key, oracles=frozenset({"reader"}), text=key, **more)


@pytest.fixture
def judged(court, monkeypatch):
    """Return a function that judges a definition by answers and rules."""

    def judge(text, rules, answers, knows=True):
        monkeypatch.setattr(explain, "KNOWN", tuple(rules))
        universe = court("noetic", {"p/msg/A.msg": text}).universe
        (case,) = universe.select(["p/A"])
        oracle, ours = Reader(answers), read(universe, case)
        return compare(oracle, case, ours, answers[text], universe if knows else None)

    return judge


X, Y = Accepted(fields("int8 x")), Accepted(fields("int8 y"))
SIZES = "structure/p/A/fields/x/type: firm-hdl 'int8'; oracle 'int16'"
TEXT, EVEN, ZERO, BOTH = (f"int8 x # {words}\n" for words in ("odd one", "even one", "odd 0", "0"))


def test_who_says_nothing_of_a_definition_refuses_nothing(judged):
    found = judged(TEXT, [], {TEXT: Accepted({})})
    why = "the oracle takes the definition, and says nothing of it"
    assert (found.verdict, found.is_refused) == (NotJudged(why), False)


def test_of_two_rules_that_explain_the_same_one_is_named(judged):
    rules = [rule("first", "odd", "even"), rule("second", "one", "0")]
    wide = Accepted(fields("int16 x"))
    both = "int8 x # even 0\n"
    found = judged(TEXT, rules, {TEXT: wide, EVEN: X, ZERO: X, both: X})
    assert found.verdict == KnownDifference(("second",), 2)
    # Each is needed.
    found = judged(TEXT, rules, {TEXT: wide, EVEN: wide, ZERO: wide, both: X})
    assert found.verdict == KnownDifference(("first", "second"), 2)
    # The first one alone explains the difference.
    found = judged(TEXT, rules, {TEXT: wide, EVEN: X, ZERO: wide, both: X})
    assert found.verdict == KnownDifference(("first",), 2)
    # A rule without which the oracle does not judge, or says nothing, is needed.
    silent = {EVEN: NotJudged("it slept"), ZERO: Accepted({})}
    found = judged(TEXT, rules, {TEXT: wide, both: X, **silent})
    assert found.verdict == KnownDifference(("first", "second"), 2)
    # None does: the rules that changed the text are named beside what is left.
    found = judged(TEXT, rules, {TEXT: wide, EVEN: X, ZERO: X, both: wide})
    assert found.verdict == Failed((f"{SIZES} (beside first, second)",))
    # A mistake that we do not refuse explains nothing.
    mistake = rule("mistake", "odd", "even", is_mistake=True)
    assert judged(TEXT, [mistake], {TEXT: wide, EVEN: X}).verdict == Failed((SIZES,))
    # Without other definitions, no difference is known.
    found = judged(TEXT, rules, {TEXT: wide}, knows=False)
    assert found.verdict == Failed((SIZES,))


def test_all_rules_that_are_not_needed_are_left_out(judged):
    changes = {"a": ("odd", "even"), "b": ("one", "0"), "c": ("x #", "x  #")}
    texts = [TEXT]
    for old, new in changes.values():
        texts += [text.replace(old, new) for text in texts]
    answers = {each: X if "x  #" in each else Accepted(fields("int16 x")) for each in texts}
    found = judged(TEXT, [rule(key, *change) for key, change in changes.items()], answers)
    assert len(answers) == 8 and found.verdict == KnownDifference(("c",), 2)


def test_a_rule_that_changes_nothing_explains_nothing(judged):
    wide = Accepted(fields("int16 x"))
    rules = [
        rule("other", "absent", "x"),
        rule("hashed", "absent", "x", hashed=lambda model: 1 / 0),
    ]
    assert judged(TEXT, rules, {TEXT: wide}).verdict == Failed((SIZES,))


def test_where_an_oracle_is_known_to_err_we_must_not_agree(judged):
    answers = {TEXT: X, EVEN: Y}
    found = judged(TEXT, [rule("plain", "odd", "even")], answers)
    names = "structure/p/A/fields: firm-hdl ['x']; oracle ['y']"
    assert found.verdict == Failed((f"{names} (beside plain)",))
    # A mistake that only the oracle accepts does not matter in a definition that we accept.
    found = judged(TEXT, [rule("mistake", "odd", "even", is_mistake=True)], answers)
    assert found.verdict == Passed(2)


def test_facts_are_mended_by_rules_for_facts(judged):
    mend = mend_members("fields", lambda field: {**field, "name": "x"})
    found = judged(TEXT, [rule("names", theirs=mend)], {TEXT: Y})
    assert found.verdict == KnownDifference(("names",), 2)
    # What needs no mending is no known difference.
    assert judged(TEXT, [rule("names", theirs=mend)], {TEXT: X}).verdict == Passed(2)
    # The other fact stays, and only rules that mended anything are named.
    found = judged(TEXT, [rule("names", theirs=mend)], {TEXT: Accepted(fields("int16 x"))})
    assert found.verdict == Failed((SIZES,))
    found = judged(TEXT, [rule("names", theirs=mend)], {TEXT: Accepted(fields("int16 y"))})
    assert found.verdict == Failed((f"{SIZES} (beside names)",))


BAD = "int8 x-y # odd\nint8 z\n"
GOOD, BAD_EVEN, GOOD_EVEN = "int8 x # odd\nint8 z\n", "int8 x-y # even\nint8 z\n", "int8 x # even\n"
GOOD_EVEN += "int8 z\n"
MISTAKE = rule("mistake", "x-y", "x", is_mistake=True)
PLAIN = rule("plain", "odd", "even")
ACCEPTED = Accepted(fields("int8 x", "int8 z"))


def test_a_mistake_that_the_oracle_accepts_is_removed_for_both(judged):
    answers = {BAD: Accepted({}), GOOD: ACCEPTED, BAD_EVEN: Accepted({}), GOOD_EVEN: ACCEPTED}
    # An answer without facts is none.
    assert isinstance(judged(BAD, [MISTAKE], {**answers, GOOD: Accepted({})}).verdict, Failed)
    assert judged(BAD, [MISTAKE], answers).verdict == KnownDifference(("mistake",), 4)
    assert judged(BAD, [PLAIN, MISTAKE], answers).verdict == KnownDifference(("mistake",), 4)
    # It is removed although the oracle refuses it for a reason of its own, which is known, too.
    refused = {**answers, BAD: Refused("odd")}
    assert judged(BAD, [PLAIN, MISTAKE], refused).verdict == KnownDifference(("mistake",), 4)
    # Only mistakes are removed for us.
    rename = rule("rename", "int8 z", "int8 w")
    renamed = {
        key.replace("int8 z", "int8 w"): Accepted(fields("int8 x", "int8 w")) for key in answers
    }
    (failure,) = judged(BAD, [MISTAKE, rename], {**renamed, **answers}).verdict.failures
    assert failure.startswith("structure/p/A/fields: firm-hdl ['x', 'z']; oracle ['x', 'w']")
    # The rest is compared.
    wrong = {**answers, GOOD: Accepted(fields("int8 x", "int16 z"))}
    excuse = rule("excuse", unavoidable=lambda case: True)
    (failure,) = judged(BAD, [MISTAKE, excuse], wrong).verdict.failures
    assert failure.startswith("structure/p/A/fields/z/type: firm-hdl 'int8'; oracle 'int16'")


def test_a_refused_text_is_read_again_if_it_changed_even_to_none(judged, monkeypatch):
    read_again = []

    def reading(universe, case):
        read_again.append(case.text)
        return read(universe, case)

    monkeypatch.setattr(judging, "read", reading)
    # Only the oracle's text changes, so our reading of it stays.
    assert isinstance(judged(BAD, [PLAIN], {BAD: ACCEPTED, BAD_EVEN: ACCEPTED}).verdict, Failed)
    assert read_again == []
    answers = {BAD: ACCEPTED, "": Accepted(fields())}
    found = judged(BAD, [rule("all", BAD, is_mistake=True)], answers)
    assert found.verdict == KnownDifference(("all",), 1) and set(read_again) == {""}


@pytest.mark.parametrize("rules", [(MISTAKE,), (MISTAKE, PLAIN), (PLAIN, MISTAKE)])
def test_a_mistake_that_both_refuse_without_it_explains_nothing(judged, rules):
    """The oracle accepts the whole text, so it differs from us in the mistake that is left."""
    text, left = BAD.replace("z", "2"), Refused("no")
    names = {each.replace("z", "2"): left for each in (GOOD, BAD_EVEN, GOOD_EVEN)}
    found = judged(text, rules, {**names, text: Accepted(fields("int8 x"))})
    (failure,) = found.verdict.failures
    assert failure.startswith("verdict: firm-hdl refuses: ") and not found.is_refused
    assert f"oracle accepts (beside {', '.join(each.key for each in rules)})" in failure


def test_without_a_known_difference_both_may_refuse(judged):
    found = judged(BAD, [PLAIN], {BAD: Accepted({"md5": {}, **fields("int8 x")}), BAD_EVEN: X})
    assert isinstance(found.verdict, Failed) and not found.is_refused
    found = judged(BAD, [PLAIN], {BAD: X, BAD_EVEN: Refused("no")})
    assert (found.verdict, found.is_refused) == (KnownDifference(("plain",), 1), True)


def test_an_oracle_that_does_not_judge_the_changed_text_explains_nothing(judged):
    answers = {TEXT: Accepted(fields("int16 x")), EVEN: NotJudged("it slept")}
    assert judged(TEXT, [rule("plain", "odd", "even")], answers).verdict == Failed((SIZES,))


def test_a_text_that_no_other_text_replaces_is_not_judged(judged):
    here = rule("here", unavoidable=lambda case: "x-y" in case.text)
    there = rule("there", unavoidable=lambda case: "absent" in case.text)
    found = judged(BAD, [there, here], {BAD: X})
    assert (found.verdict, found.is_refused) == (NotJudged("here: here"), False)
    assert isinstance(judged(BAD, [there], {BAD: X}).verdict, Failed)
    # It excuses only a refusal of ours.
    assert judged(TEXT, [rule("any", unavoidable=lambda case: True)], {TEXT: X}).verdict == Passed(
        2
    )
    wide = {TEXT: Accepted(fields("int16 x"))}
    assert judged(TEXT, [rule("any", unavoidable=lambda case: True)], wide).verdict == Failed(
        (SIZES,)
    )


def test_rules_of_other_oracles_are_left_alone(judged):
    foreign = KnownRule(
        key="foreign", oracles=frozenset({"other"}), text="", rewrite=lambda case: 1 / 0
    )
    assert judged(TEXT, [foreign], {TEXT: X}).verdict == Passed(2)


def of_b(*members, name="p/B"):
    """Facts about the message that the other one needs."""
    return Accepted({"structure": {name: fields(*members)["structure"]["p/A"]}})


NEEDS, NEEDED, NEEDED_EVEN = "B b\n", "int8 x # odd\n", "int8 x # even\n"
NEEDS_BOTH = "B b\nq/C c\n"


@pytest.fixture
def judged_with(court, monkeypatch):
    """Return a function that judges a definition by answers; it needs others in other files.

    The definition that it needs is `p/B`. With a text for `q/C`, it needs that one, too.
    """

    def judge(text, rules, answers, distro="noetic", file="p/msg/B.msg", kind=Reader, other=None):
        monkeypatch.setattr(explain, "KNOWN", tuple(rules))
        more = {} if other is None else {"q/msg/C.msg": other}
        needs = NEEDS if other is None else NEEDS_BOTH
        universe = court(distro, {"p/msg/A.msg": needs, file: text, **more}).universe
        (case,) = universe.select(["p/A"])
        oracle, ours = kind(answers), read(universe, case)
        return compare(oracle, case, ours, answers[needs], universe).verdict

    return judge


class ChangesAll(Reader):
    """It changes the definitions that a definition needs as well."""

    changes_needs = True


class ReadsMessages(Reader):
    """It reads no IDL; asked about any, it raises an error."""

    languages: ClassVar = {"ros2": frozenset({"msg"})}


def test_what_needs_a_definition_with_a_known_difference_is_not_judged(judged_with):
    rules = [rule("plain", "odd", "even")]
    refused = "verdict: firm-hdl accepts; oracle refuses: no B"
    answers = {NEEDS: Refused("no B"), NEEDED: of_b("int16 x"), NEEDED_EVEN: of_b("int8 x")}
    needs = NotJudged("it needs p/B, a known difference: plain")
    assert judged_with(NEEDED, rules, answers) == needs
    # The difference is not known, there is none, or the oracle does not judge what is needed.
    for changes in ({NEEDED_EVEN: of_b("int16 x")}, {NEEDED: of_b("int8 x")},
                    {NEEDED: NotJudged("it slept")}):  # fmt: skip
        assert judged_with(NEEDED, rules, answers | changes) == Failed((refused,))
    assert judged_with(NEEDED, [], answers) == Failed((refused,))
    # What it needs was changed already, and that was no help.
    assert judged_with(NEEDED, rules, answers, kind=ChangesAll) == Failed((refused,))


def test_our_refusal_of_a_needed_definition_may_be_a_known_difference(judged_with):
    wrong, right = "int8 x-y # odd\n", "int8 x # odd\n"
    rules = [rule("mistake", "x-y", "x", is_mistake=True)]
    answers = {NEEDS: Accepted(fields("p/B b")), wrong: of_b("int8 x"), right: of_b("int8 x")}
    needs = NotJudged("it needs p/B, a known difference: mistake")
    assert judged_with(wrong, rules, answers) == needs
    assert isinstance(judged_with(wrong, [], answers), Failed)
    assert isinstance(judged_with(wrong, rules, answers | {right: of_b("int8 y")}), Failed)


def test_an_oracle_is_not_asked_for_a_needed_definition_that_it_cannot_read(judged_with):
    idl = "module p { module msg { struct B { long x; }; }; };"
    answers = {NEEDS: Refused("no B")}
    found = judged_with(idl, [], answers, "lyrical", "p/msg/B.idl", ReadsMessages)
    assert found == Failed(("verdict: firm-hdl accepts; oracle refuses: no B",))


@pytest.mark.parametrize("known", ["p/B", "q/C"])
def test_any_of_the_definitions_that_are_needed_may_have_a_known_difference(judged_with, known):
    """Neither the first one decides, nor do all of them have to."""
    odd, even, plain = "int8 {} # odd\n", "int8 {} # even\n", "int8 {}\n"
    rules = [rule("plain", "odd", "even")]
    texts = {"p/B": plain.format("x"), "q/C": plain.format("y")}
    answers = {NEEDS_BOTH: Refused("it lacks one")}
    for name, member in (("p/B", "x"), ("q/C", "y")):
        right, wide = (of_b(f"{kind} {member}", name=name) for kind in ("int8", "int16"))
        answers |= {plain.format(member): right, even.format(member): right}
        answers[odd.format(member)] = wide
        if name == known:
            texts[name] = odd.format(member)
    found = judged_with(texts["p/B"], rules, answers, other=texts["q/C"])
    assert found == NotJudged(f"it needs {known}, a known difference: plain")


@pytest.mark.parametrize("known", ["p/B", "q/C"])
def test_any_of_the_needed_definitions_that_we_refuse_may_be_the_known_one(judged_with, known):
    rules = [rule("mistake", "k-k", "k", is_mistake=True)]
    texts, answers = {}, {NEEDS_BOTH: Accepted(fields("p/B b", "q/C c"))}
    for name, member in (("p/B", "x"), ("q/C", "y")):
        texts[name] = f"int8 {member}{'k-k' if name == known else '-z'}\n"
        answers[texts[name]] = of_b(f"int8 {member}", name=name)
        answers[f"int8 {member}k\n"] = of_b(f"int8 {member}k", name=name)
    found = judged_with(texts["p/B"], rules, answers, other=texts["q/C"])
    assert found == NotJudged(f"it needs {known}, a known difference: mistake")


@pytest.mark.parametrize("place", ["B b", "x-y"])
def test_a_text_that_no_other_text_replaces_may_be_any_that_was_read(judged_with, place):
    """An oracle that changes what is needed reads several texts; one of them is enough."""
    answers = {NEEDS: Accepted(fields("p/B b")), "int8 x-y\n": of_b("int8 x")}
    here = rule("here", unavoidable=lambda case: place in case.text)
    there = rule("there", unavoidable=lambda case: "absent" in case.text)
    found = judged_with("int8 x-y\n", [there, here], answers, kind=ChangesAll)
    assert found == NotJudged("here: here")
    assert isinstance(judged_with("int8 x-y\n", [there], answers, kind=ChangesAll), Failed)
