"""A reading of ours against an answer of an oracle: who refuses, and what is said of it."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.model import PRIMITIVES, Field, Message
from firm_hdl.verify.ts1.comparison import Compared, compared
from firm_hdl.verify.ts1.facts import Difference
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Refused

FIELDS = {"structure": {"p/msg/A": {"fields": [{"name": "a", "type": "uint8"}]}}}
MESSAGE = Message(
    name="p/msg/A", dialect="ros2", fields=(Field(name="a", type=PRIMITIVES["ros2"]["uint8"]),)
)
REFUSAL = DefinitionError([Diagnostic(message="the first"), Diagnostic(message="the second")])


def test_a_definition_that_both_refuse_is_one_case_without_a_difference():
    found = compared(REFUSAL, Refused("no"), {}, lambda: "")
    assert found == Compared(differences=(), cases=1, is_refused=True)


@pytest.mark.parametrize(
    ("ours", "answer", "text"),
    [
        (REFUSAL, Accepted(FIELDS), "firm-hdl refuses: the first; oracle accepts"),
        (KeyError("a"), Accepted(FIELDS), "firm-hdl raised KeyError: 'a'; oracle accepts"),
        (KeyError("a"), Refused("no"), "firm-hdl raised KeyError: 'a'; oracle refuses: no"),
        (MESSAGE, Refused("no"), "firm-hdl accepts; oracle refuses: no"),
    ],
)
def test_one_that_refuses_alone_and_an_error_of_ours_are_told(ours, answer, text):
    found = compared(ours, answer, {}, lambda: "")
    assert [str(each) for each in found.differences] == [f"verdict: {text}"]
    assert (found.cases, found.is_refused, found.is_about_verdict) == (1, False, True)


def test_only_a_difference_of_the_verdicts_is_about_the_verdict():
    one = Difference(path="verdict", ours="accepts", theirs="refuses: no")
    other = Difference(path="show", ours="'a'", theirs="'b'")
    kinds = [(), (one,), (other,), (other, one)]
    found = [Compared(differences=each).is_about_verdict for each in kinds]
    assert found == [False, True, False, True]


def test_only_the_facts_that_the_oracle_gives_are_compared():
    found = compared(MESSAGE, Accepted({"show": "uint8 b\n"}), {}, lambda: "uint8 a\n")
    assert [each.path for each in found.differences] == ["show"]
    assert found.cases == 1


def test_a_fact_that_we_cannot_make_is_a_difference_with_the_error():
    def show():
        raise OSError("no file")

    found = compared(MESSAGE, Accepted({"show": ""}), {}, show)
    assert [each.ours for each in found.differences] == ["'raises OSError: no file'"]


def test_what_no_oracle_answers_is_refused():
    with pytest.raises(TypeError, match="must accept, refuse or not judge, not None"):
        compared(MESSAGE, None, {}, lambda: "")
