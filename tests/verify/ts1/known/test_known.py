"""Each deliberate difference occurs, has a key, and is documented in docs/reference/errata.md.

A must-fail twin with one more fault shows that the known difference hides no other.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged
from firm_hdl.verify.ts1 import comparison
from firm_hdl.verify.ts1 import judge as judging
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.known import KNOWN
from firm_hdl.verify.ts1.known.texts import hidden, renamed, renamed_back, shown
from tests.verify.judged import assert_known, assert_passed
from tests.verify.ts1.known.examples import EXAMPLES, Example, drop_last, refuse

ERRATA = Path(__file__).parents[4] / "docs" / "reference" / "errata.md"

NAMED = {f"{number} {each.key} {each.oracle}": each for number, each in enumerate(EXAMPLES)}
JUDGEABLE = {name: each for name, each in NAMED.items() if each.judgeable}
BY_NAME = {name: each for name, each in NAMED.items() if not each.judgeable}


def outcome(here, example, monkeypatch, fault=None):
    """Judge an example, optionally with a fault in the front end."""
    with monkeypatch.context() as with_fault:
        if fault is not None:
            read = judging.read
            with_fault.setattr(judging, "read", lambda *given: fault(read(*given)))
        return here.outcome(example.oracle, f"p/{example.kind}/A")


@pytest.mark.parametrize("name", BY_NAME)
def test_difference_is_known_by_its_key_and_hides_no_mistake(court, name, monkeypatch):
    example = BY_NAME[name]
    here = court(example.distro, example.files)
    found = outcome(here, example, monkeypatch)
    assert_known(found, example.key)
    # An accepted definition is compared: each field has at least a name and a type.
    assert found.is_refused or found.verdict.cases >= 4
    for fault in (example.fault, refuse, drop_last):
        with_fault = outcome(here, example, monkeypatch, fault)
        # If both refuse, there is no field to drop, and a refusal is correct.
        if found.is_refused and fault is not example.fault:
            assert with_fault.verdict == found.verdict
        else:
            assert isinstance(with_fault.verdict, Failed), (fault, with_fault.verdict)


@pytest.mark.parametrize("name", JUDGEABLE)
def test_an_unjudgeable_text_excuses_no_other_fault(court, name, monkeypatch):
    example = JUDGEABLE[name]
    found = outcome(court(example.distro, example.files), example, monkeypatch)
    assert isinstance(found.verdict, NotJudged)
    assert found.verdict.reason.startswith(f"{example.key}: ")
    here = court(example.distro, example.judgeable_files)
    assert_passed(outcome(here, example, monkeypatch))
    for fault in (example.fault, refuse, drop_last):
        assert isinstance(outcome(here, example, monkeypatch, fault).verdict, Failed)


WITH_HASH = [
    name for name, each in BY_NAME.items() if (each.oracle, each.distro) == ("rosbags", "lyrical")
]
NEW_PARSER = Example(
    key="ros2-wstring-sequences",
    oracle="rosidl_parser-4.9",
    text="wstring<=4[] x\nuint16 last\n",
    fault=drop_last,
)


@pytest.mark.parametrize("name", [*WITH_HASH, "rosidl_parser-4.9"])
def test_a_known_difference_hides_no_wrong_hash(court, name, monkeypatch):
    example = BY_NAME.get(name, NEW_PARSER)
    here = court(example.distro, example.files)
    found = outcome(here, example, monkeypatch)
    assert_known(found, example.key)
    monkeypatch.setattr(comparison, "type_hash", lambda interface: "RIHS01_0")
    with_fault = outcome(here, example, monkeypatch)
    if found.is_refused:
        assert with_fault.verdict == found.verdict
    else:
        assert any("hash" in text for text in with_fault.verdict.details), with_fault.verdict
        assert isinstance(with_fault.verdict, Failed)


def test_a_comment_about_a_placeholder_hides_nothing(court, monkeypatch):
    text = "# structure_needs_at_least_one_member\nint8 a\nuint16 last\n"
    here = court("lyrical", {"p/msg/A.msg": text})
    assert_passed(here.outcome("rosbags", "p/msg/A"))
    monkeypatch.setattr(comparison, "type_hash", lambda interface: "RIHS01_0")
    assert isinstance(here.outcome("rosbags", "p/msg/A").verdict, Failed)


@pytest.mark.parametrize("members", ["long x; long x;", "@optional long x;"])
@pytest.mark.parametrize("oracle", ["rosidl_adapter", "rosidl_adapter-4.9"])
def test_who_does_not_read_idl_does_not_judge_who_needs_what_we_refuse(court, oracle, members):
    idl = f"module p {{ module msg {{ struct I {{ {members} }}; }}; }};"
    files = {"p/msg/I.idl": idl, "p/msg/A.msg": "I i\n", "p/srv/S.srv": "I i\n---\n"}
    here = court("lyrical", files)
    why = NotJudged("it needs p/msg/I, which firm-hdl refuses and the oracle does not read")
    assert here.outcome(oracle, "p/msg/A").verdict == why
    assert here.outcome(oracle, "p/srv/S").verdict == why
    # A mistake of the definition itself is one.
    other = court("lyrical", {**files, "p/msg/A.msg": "I i\nint8 X=1\nint8 Y\nint8 a=5\n"})
    found = other.outcome(oracle, "p/msg/A").verdict
    assert not isinstance(found, NotJudged)


def test_every_entry_has_an_example_with_a_twin_and_stands_in_the_errata():
    pairs = sorted((entry.key, oracle) for entry in KNOWN for oracle in entry.oracles)
    assert len(pairs) == len(set(pairs))
    found = {(each.key, each.oracle.partition("-")[0]) for each in EXAMPLES}
    assert sorted(found) == pairs
    unjudgeable = {entry.key for entry in KNOWN if entry.unavoidable is not None}
    assert {each.key for each in JUDGEABLE.values()} == unjudgeable
    _, _, page = ERRATA.read_text(encoding="utf-8").partition("\n## Definitions\n")
    listed = re.findall(r"^\| `([a-z0-9-]+)` \|", page, re.MULTILINE)
    assert sorted(listed) == sorted({entry.key for entry in KNOWN})


PLAIN = {
    "ros1": "# c\nint8 LOW=-1\nfloat32 F=1.5 # x\nbool ON=True\nint8[3] a\n\nHeader h # i\n",
    "ros2": '# c\nint8 LOW=-1\nfloat32 F=1.5 # x\nint8[<=3] a [1, 2]\nstring<=5 t "a"\n',
}


@pytest.mark.parametrize("dialect", PLAIN)
@pytest.mark.parametrize("entry", KNOWN, ids=lambda entry: entry.key)
def test_an_entry_normalises_one_thing_and_leaves_other_texts_alone(entry, dialect):
    assert any((entry.rewrite, entry.theirs, entry.unavoidable))
    case = DefinitionCase(
        dialect=dialect, package="p", kind="msg", name="A", language="msg", text=PLAIN[dialect]
    )
    if entry.is_about(min(entry.oracles), "", case):
        assert entry.changed(case) is case
        assert entry.unavoidable is None or not entry.unavoidable(case)


@pytest.mark.parametrize(
    ("distro", "oracle", "text"),
    [
        # A known mistake does not hide another.
        ("noetic", "genmsg", "int8 a-b=1\nint8 A=1000\n"),
        ("noetic", "genmsg", "int8[0] x\nint8 x-y\n"),
        ("lyrical", "rosidl_adapter", "int8[4294967296] x\nint8 Bad\n"),
    ],
)
def test_a_known_difference_hides_no_other(court, distro, oracle, text):
    from firm_hdl.verify.ts1.judge import compare, read
    from firm_hdl.verify.ts1.oracles.oracle import Accepted

    here = court(distro, {"p/msg/A.msg": text})
    case = here.universe.select(["p/A"])[0]
    # The oracle accepts the other mistake, too.
    judge = here.oracle(oracle)
    judge.judge_changed = lambda case, change: Accepted({"structure": {case.full_name: {}}})
    ours = read(here.universe, case)
    found = compare(judge, case, ours, judge.judge_changed(case, None), here.universe)
    assert isinstance(found.verdict, Failed)


def test_a_text_that_only_the_oracle_refuses_must_be_accepted(court, monkeypatch):
    # rosbags refuses CR LF, which is no mistake. Our reader must not refuse it.
    read = judging.read

    def refuses_returns(universe, case):
        return refuse(None) if "\r" in case.text else read(universe, case)

    here = court("noetic", {"p/msg/A.msg": "int8 x\r\n"})
    assert_known(here.outcome("rosbags", "p/A"), "rosbags-crlf")
    monkeypatch.setattr(judging, "read", refuses_returns)
    found = here.outcome("rosbags", "p/A")
    assert found.verdict.details == (
        "verdict: firm-hdl refuses: it is planted; oracle accepts (beside rosbags-crlf)",
    )


def test_several_known_differences_are_all_named_and_no_others(court):
    text = "int8 N=010\r\nbool ON=1\r\nstring S=text\r\nint8 plain\r\n"
    found = court("noetic", {"p/msg/A.msg": text}).outcome("rosbags", "p/A")
    assert_known(found, "rosbags-crlf", "rosbags-constant-bool", "rosbags-integers")


def test_a_known_difference_of_a_dependency_is_one_of_the_definition(court):
    files = {"p/msg/A.msg": "B b\nint8 last\n", "p/msg/B.msg": "wstring x\r\n"}
    found = court("lyrical", files).outcome("rosbags", "p/A")
    assert_known(found, "rosbags-crlf", "rosbags-wstring")


@pytest.mark.parametrize(
    ("distro", "oracle", "text", "key"),
    [
        ("noetic", "genmsg", "int8[0] x\n", "ros1-empty-arrays"),
        ("lyrical", "rosidl_adapter", 'string[] x ["\\""]\n', "ros2-escaped-quotes"),
    ],
)
def test_where_a_needed_definition_cannot_be_changed_it_is_not_judged(
    court, distro, oracle, text, key, monkeypatch
):
    files = {"p/msg/A.msg": "B b\nint8 last\n", "p/msg/B.msg": text}
    found = court(distro, files).outcome(oracle, "p/A")
    assert isinstance(found.verdict, NotJudged)
    assert found.verdict.reason.endswith(f", a known difference: {key}")
    assert isinstance(court(distro, files).outcome(oracle, "p/B").verdict, KnownDifference)
    # A refusal without a known difference is not excused.
    good = {**files, "p/msg/B.msg": "int8 x\n"}
    read = judging.read
    monkeypatch.setattr(judging, "read", lambda universe, case: refuse(read(universe, case)))
    assert isinstance(court(distro, good).outcome(oracle, "p/A").verdict, Failed)


ORDINARY = {
    "float32 LOW = 0\n": "rosbags-floats",
    "string s true story\n": "rosbags-texts",
    "float64 a inf\n": None,
    "float64[] a [inf, nan]\n": None,
    'string<=5[] a ["b", c]\n': None,
    "int8[] a []\n": None,
    "string<=5[<=3] s\n": None,
}


@pytest.mark.parametrize("text", ORDINARY)
def test_ordinary_files_raise_no_alarm(court, text):
    key = ORDINARY[text]
    here = court("lyrical", {"p/msg/A.msg": text + "uint16 last\n"})
    found = here.outcome("rosbags", "p/A")
    if key is None:
        assert_passed(found)
    else:
        assert_known(found, key)
    assert_passed(here.outcome("rosidl_adapter", "p/A"))
    assert not isinstance(here.outcome("rosidl_parser", "p/A").verdict, Failed)


def test_rosbags_does_not_judge_types_that_need_idl(court, monkeypatch):
    idl = "module p { module msg { struct I { long x; }; }; };"
    files = {"p/msg/A.msg": "B b\n", "p/msg/B.msg": "I[] i\n", "p/msg/I.idl": idl}
    found = court("lyrical", files).outcome("rosbags", "p/A")
    assert found.verdict == NotJudged("it needs p/msg/I, which is written in IDL")
    assert_passed(court("lyrical", files).outcome("rosidl_adapter", "p/A"))


def test_rosbags_does_not_judge_times_that_it_takes_for_those_of_ros1(court):
    files = {
        "p/msg/A.msg": "int8 x\n builtin_interfaces/Duration[] t\n",
        "p/msg/B.msg": "A a\n",
        "p/msg/C.msg": "time t # not builtin_interfaces/Time\n",
    }
    here = court("noetic", files)
    for name in "AB":
        found = here.outcome("rosbags", f"p/{name}")
        assert isinstance(found.verdict, NotJudged) and "builtin_interfaces" in found.verdict.reason
    assert_passed(here.outcome("rosbags", "p/C"))


def test_rosbags_refuses_recursive_types(court):
    files = {"p/msg/A.msg": "B b\n", "p/msg/B.msg": "C[] c\n", "p/msg/C.msg": "B[] b\n"}
    for type_ in ("p/A", "p/B"):
        assert court("lyrical", files).outcome("rosbags", type_).is_refused


def test_an_oracle_that_refuses_for_its_own_reasons_does_not_agree_with_our_refusal(
    court, monkeypatch
):
    here = court("lyrical", {"p/msg/A.msg": "wstring x\r\nint8 a\r\n"})
    read = judging.read
    monkeypatch.setattr(judging, "read", lambda universe, case: refuse(read(universe, case)))
    found = here.outcome("rosbags", "p/A")
    assert isinstance(found.verdict, Failed) and not found.is_refused
    assert "firm-hdl refuses: it is planted" in found.verdict.failures[0]


def test_entries_are_for_some_oracles_releases_and_languages(court):
    from dataclasses import replace

    (case,) = court("lyrical", {"p/msg/A.msg": "int8 x\n"}).universe.select(["p/A"])
    (entry,) = [each for each in KNOWN if each.key == "ros2-comment-blanks"]
    assert entry.is_about("rosidl_adapter", "3.3.1", case)
    assert entry.is_about("rosidl_adapter-4.9.5", "4.9.5", case)
    assert not entry.is_about("rosidl_parser", "3.3.1", case)
    old = replace(entry, releases=re.compile(r"3\..*"))
    assert old.is_about("rosidl_adapter", "3.3.1", case)
    assert not old.is_about("rosidl_adapter-4.9.5", "4.9.5", case)
    assert not replace(entry, language="idl").is_about("rosidl_adapter", "", case)
    assert not replace(entry, dialect="ros1").is_about("rosidl_adapter", "", case)


@pytest.mark.parametrize("text", ["", "a", "a'b\\\"c", 'é"[', "RENAMED41"])
def test_placeholders_can_be_replaced_back(text):
    assert shown(hidden(text, "\"'\\")) == text
    assert shown([hidden(text, "a"), 1]) == [text, 1]
    name = {"name": text or "x"}
    assert renamed_back({"name": renamed(name["name"])}) == name


@pytest.mark.parametrize(
    "members",
    [
        "@default(1) @default(value=2) long x;",
        "@default(1) @default(2) long x;",
        "@default @default(2) long x;",
        "@default(300) octet x;",
        '@default(-1) octet x; @default("x") long y;',
    ],
)
def test_the_short_form_of_an_annotation_has_the_mistakes_of_the_long_one(court, members):
    text = f"module p {{ module msg {{ struct A {{ {members} }}; }}; }};"
    verdict = court("lyrical", {"p/msg/A.idl": text}).outcome("rosidl_parser", "p/A").verdict
    assert isinstance(verdict, KnownDifference)
    assert {"idl-defaults", "idl-values"} & {*verdict.keys}
