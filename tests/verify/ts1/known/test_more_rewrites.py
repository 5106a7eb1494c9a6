"""Texts at the limits of rules: the second of two, blanks of other kinds, and names of the same."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from firm_hdl.verify.ts1.known.idl_values import integer_of
from firm_hdl.verify.ts1.known.rule import KnownRule, Line, by_lines, each_line
from firm_hdl.verify.ts1.known.texts import hidden, renamed, renamed_back, shown
from tests.verify.ts1.known.rewriting import BY_KEY, case_of, numbered, rewritten

DEEP = "-" * 20_000
MSG = [
    # key, dialect, before, after
    ("ascii-only", "ros2", "wstring A=\xe9\nwstring<=3 \xe9\n", "wstring A=\xe9\nwstring<=3 xe9\n"),
    ("ascii-only", "ros2", "int8 a\xb2\u2460\nint8 b\u20ac", "int8 axb2x2460\nint8 b\u20ac"),
    (
        "rosbags-floats",
        "ros2",
        "float32 A=1.5_0\nfloat32 B=2.5e1_0",
        "float32 A=1.5\nfloat32 B=25000000000.0",
    ),
    ("rosbags-texts", "ros1", "string\tA\t=\tb c # d\t", 'string\tA\t=\t"b c # d"'),
    ("rosbags-texts", "ros2", "  string<=9 a  b\n", '  string<=9 a "b"\n'),
    (
        "rosbags-integers",
        "ros2",
        "int8 A=1_0\rint8 B=1_1\r\nint8 C=1_2",
        "int8 A=10\rint8 B=11\r\nint8 C=12",
    ),
    # Python gives up on such a literal.
    ("ros1-bool-literals", "ros1", f"bool A={DEEP}1\nbool B=2", f"bool A={DEEP}1\nbool B=True"),
]


@pytest.mark.parametrize(("key", "dialect", "before", "after"), numbered(MSG))
def test_rewriting_lines(key, dialect, before, after):
    assert rewritten(key, before, dialect=dialect) == after


IDL = [
    ("idl-expressions", "const long A = 010; long b[011]; const long C = 0;",
     "const long A = 8; long b[9]; const long C = 0;"),
    ("idl-typedefs",
     "module a { module b { typedef long T; }; module c { ::a::b::T x; ::c::T y; }; };",
     "module a { module b { typedef long T; }; module c { T x; ::c::T y; }; };"),
    ("idl-service-constants",
     "module A_Constants { const long N = 1; }; module B_Constants { const long M = 1; }; "
     "module C_Constants { const long N = 2; };",
     "module A_Constants { const long N = 1; }; module B_Constants { const long M = 1; }; "
     f"module C_Constants {{ const long {renamed('N')} = 2; }};"),
    ("idl-twice", "struct A { long a; long b; long a; };",
     f"struct A {{ long a; long b; long {renamed('a')}0; }};"),
    ("idl-values", '@default(value=300) @default(value=1) octet a; @default(value=2) octet b;',
     "  octet a; @default(value=2) octet b;"),
    ("idl-values", f'@default(value="({DEEP}1,)") octet a[2]; @default(value="(1,)") octet b[2];',
     f'@default(value="({DEEP}1,)") octet a[2];  octet b[2];'),
]  # fmt: skip


@pytest.mark.parametrize(("key", "before", "after"), numbered(IDL))
def test_rewriting_idl(key, before, after):
    assert rewritten(key, before, language="idl") == after


@pytest.mark.parametrize("included", [False, True])
def test_a_constant_of_any_type_is_a_value(included):
    """Its value is not looked up, unless it is an integer."""
    others = 'const string S = "x"; const float F = 1.5; const boolean B = TRUE; const long N = 3; '
    text = "const string T = S; const float G = F; const boolean C = B; const octet O = N; "
    wrong = "const string U = Z; const float H = Z; const octet P = Z;"
    mended = 'const string U =""; const float H =0.0; const octet P =0;'
    more = {"included": (others,)} if included else {}
    head = "" if included else others
    found = rewritten("idl-values", head + text + wrong, language="idl", **more)
    assert found == head + text + mended


def test_names_of_included_files_are_replaced_only_where_they_are_meant():
    included = ("module q { const long value = 3; typedef short T; typedef long R[2]; };",)
    for text, after in (
        ("@default(value=value) long a;", "@default(value=3) long a;"),
        ("T T[2]; T b;", "short T[2]; short b;"),
        ("T T; sequence<T> c; T d, T;", "short T; sequence<short> c; short d, T;"),
        ("q::T a[value]; R b;", "short a[3]; R b;"),
    ):
        assert rewritten("idl-includes", text, language="idl", included=included) == after


def test_a_file_s_own_constants_come_before_those_that_it_includes():
    included = ("const long N = 1000;",)
    text = "const long N = 2; const octet A = N * 100; const octet B = N * 200;"
    found = rewritten("idl-values", text, language="idl", included=included)
    assert found == text.replace(" N * 200", "0")


def test_only_arguments_without_a_name_get_one():
    text = (
        '@default(VALUE 3) @unit (VALUE"m") long a; '
        '@default( value = 3) @unit(value="n = m") long b; '
        "@key @range(1) @default (VALUE(A)) long c; // @default(3)\n"
        '@verbatim(language="comment", text="@default(3)") @default(VALUETRUE) boolean d;'
    )
    before = text.replace("VALUE", "")
    after = text.replace("VALUE", "value=")
    assert rewritten("idl-short-annotations", before, language="idl") == after


def test_bounds_that_no_constant_has_in_sight_are_replaced():
    text = (
        "module q { const long Q = 1; }; module A_Constants { const long N = 3; }; struct A { "
        "wstring<N> a; wstring< q::Q > b; wstring<{}> c; sequence<wstring<{}>, 4> d; "
        "wstring<E> e; string<{}> f; wstring<7> g; }; // wstring<NONE>"
    )

    def named(*names):
        left = iter(names)
        return re.sub("{}", lambda _: next(left), text)

    more = {"language": "idl", "included": ("const long E = 3;",)}
    found = rewritten("idl-unseen-bounds", named("Q", "NONE", "NONE"), **more)
    assert found == named("1", "1", "NONE")


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1 >> 70", 0),
        ("(1 << 64) + 1", None),
        ("-(1 << 64)", -(1 << 64)),
        ("-(1 << 64) - 1", None),
        ("1 << 100000000000000", None),
        ("-7 / 2", -3),
        ("1" + " + 1" * 20_000, None),
        ("9" * 5000, None),
        # A comment in Python, not in IDL.
        ("1048#576", None),
        ("'#' + 1", 36),
    ],
)
def test_large_negative_and_odd_values_of_expressions(expression, value):
    assert integer_of(expression, {}, set()) == value


def test_every_ascii_character_can_be_hidden():
    every = "".join(map(chr, range(128)))
    text = hidden(every, every)
    assert len(text) == 128 and not any(each in every for each in text)
    assert shown(text) == every and shown([text, [text], None]) == [every, [every], None]
    # Others stay, also those of the private-use area that follow.
    assert shown("\ue080\udfffé") == "\ue080\udfffé"


def test_only_members_that_were_rewritten_get_their_primitive_back():
    def facts(fields, constants=()):
        members = [[{"name": n, "type": t} for n, t in each] for each in (fields, constants)]
        return {"structure": {"p/A": dict(zip(("fields", "constants"), members, strict=True))}}

    text = "wstring<=2[] a\nstring b\nwstring C=x\nstring D=y\nwstring e x\nint8 f # wstring g\n"
    read = [(name, "string") for name in ("b", "C", "e", "g")]
    given = facts([("a", "string<=2[]"), *read], [(name, "string") for name in "CDa"])
    back = BY_KEY["rosbags-wstring"].theirs(given, case_of(text))
    after = [("b", "string"), ("C", "string"), ("e", "wstring"), ("g", "string")]
    constants = [("C", "wstring"), ("D", "string"), ("a", "string")]
    assert back == facts([("a", "wstring<=2[]"), *after], constants)
    # Another primitive is another difference.
    other = facts([("c", "uint8[3]"), ("d", "uint16")])
    mended = BY_KEY["rosbags-char-hash"].theirs(other, case_of("char[3] c\nchar d\n"))
    assert mended == facts([("c", "char[3]"), ("d", "uint16")])


RULE = KnownRule(key="k", oracles=frozenset({"a"}), text="")


def test_a_rule_is_for_a_language_and_not_for_a_kind():
    idl, msg, srv = (case_of("", language=name) for name in ("idl", "msg", "srv"))
    assert (idl.kind, msg.kind) == ("msg", "msg")
    for language, about in (
        ("idl", [idl]),
        ("msg", [msg]),
        ("srv", [srv]),
        (None, [idl, msg, srv]),
    ):
        rule = replace(RULE, language=language)
        assert [case for case in (idl, msg, srv) if rule.is_about("a", "1", case)] == about


def test_a_rule_is_for_whole_releases():
    case = case_of("")
    rule = replace(RULE, releases=re.compile(r"3\.3"))
    assert rule.is_about("a", "3.3", case) and rule.is_about("a-3.3", "3.3", case)
    assert not any(rule.is_about("a", release, case) for release in ("3.3.1", "13.3", ""))
    assert not RULE.is_about("b", "3.3", case)


def test_the_text_before_the_first_change_is_kept():
    rule = replace(RULE, rewrite=lambda case: case.text + "x")
    once = rule.changed(case_of("a"))
    assert (once.text, once.before) == ("ax", "a")
    assert (rule.changed(once).text, rule.changed(once).before) == ("axx", "a")
    mutated = rule.changed(case_of("a", before="file"))
    assert (mutated.text, mutated.before) == ("ax", "file")
    assert RULE.changed(once) is once
    assert replace(RULE, rewrite=lambda case: case.text).changed(once) is once


@pytest.mark.parametrize("name", ["low", "a-b", "é", "a b", "Ā"])
def test_names_come_back_from_their_code(name):
    code = renamed(name)
    assert re.fullmatch("RENAMED[0-9A-F]+", code) and code != renamed(name + "x")
    assert renamed_back({"name": code, "value": 1}) == {"name": name, "value": 1}


def test_every_line_end_ends_a_line_and_stays():
    assert each_line("a\rb\r\nc\n\nd", lambda line: f"<{line}>") == "<a>\r<b>\r\n<c>\n<>\n<d>"


def test_a_line_keeps_all_its_parts():
    seen = []

    def look(line, case):
        seen.append(line)
        return replace(line, name=line.name.upper())

    text = " int8\t a\t= 1 # b\nstring<=3[<=2]  c 'd'\n# int8 e\n\nint8\n"
    assert by_lines(look)(case_of(text)) == text.replace("\t a", "\t A").replace("  c ", "  C ")
    first, second = seen
    assert (first.indent, first.gap, first.equals, first.value) == (" ", "\t ", "\t= ", "1")
    assert (second.type, second.base, second.value) == ("string<=3[<=2]", "string", "'d'")
    assert str(first.with_value("2")) == " int8\t a\t= 2 # b"
    assert str(first.without_value()) == " int8\t a\t= # b"
    assert str(second.with_value("x")) == "string<=3[<=2]  c x"
    assert str(second.without_value()) == "string<=3[<=2]  c"
    assert str(first.with_code(lambda code: code.replace("1", "11"))) == " int8\t a\t= 11 # b"
    assert Line(**{**dict.fromkeys(Line.__slots__, ""), "type": "a[3]"}).base == "a"
