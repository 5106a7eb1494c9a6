"""Code in IDL, apart from its comments and string literals."""

from __future__ import annotations

import re

import pytest

from firm_hdl.verify.ts1.known.idl_text import (
    DECLARED,
    TYPEDEF,
    blanked,
    changed,
    in_code,
    modules_of,
)

# A comment in a literal and a literal in a comment; a comment of two lines; an escaped quote.
QUIET = ['"// x"', '// "x', "/* x\nx */", '"a\\"x"', "/**/", '"" "x"']


@pytest.mark.parametrize("quiet", QUIET)
def test_comments_and_literals_are_no_code(quiet):
    text = f"x a;{quiet}\nb x;"
    assert len(blanked(text)) == len(text)
    assert blanked(text).split() == ["x", "a;", "b", "x;"]
    assert in_code(text, "x", "long") == f"long a;{quiet}\nb long;"


def test_a_literal_ends_with_its_line():
    assert blanked('a "b\nc "d') == 'a "b\nc "d'


@pytest.mark.parametrize(
    ("code", "modules"),
    [
        ("module p { module msg { struct A { long a; }; }; };", {"p", "msg"}),
        # White space of IDL is also tabs and ends of lines (7.2 of the standard).
        ("module  p\n{\nmodule\n  msg { module\tin { }; }; };", {"p", "msg", "in"}),
        ("module p_1{module Q2{};};", {"p_1", "Q2"}),
        ("submodule a; modules b; struct module_c { };", set()),
        ("", set()),
    ],
)
def test_modules_are_found_in_any_layout(code, modules):
    assert modules_of(code) == modules


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("const long A = 3;", [("long", "A", "3")]),
        ("const\tunsigned  long\nA=1 + 2 ;", [("unsigned  long", "A", "1 + 2")]),
        ("const p::T A = p::B;const long C = 4;", [("p::T", "A", "p::B"), ("long", "C", "4")]),
        ("constant long A = 3;", []),
    ],
)
def test_constants_are_found_in_any_layout(code, found):
    assert re.findall(DECLARED, code) == found


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("typedef long T;", [("long", "T", "")]),
        ("typedef sequence<long, 3>\nT ;", [("sequence<long, 3>", "T", "")]),
        ("typedef unsigned long T [ 3 ];", [("unsigned long", "T", "[ 3 ]")]),
        ("typedefs long T;", []),
    ],
)
def test_typedefs_are_found_in_any_layout(code, found):
    assert re.findall(TYPEDEF, code) == found


def test_changes_are_made_from_the_end_on():
    assert changed("abcdef", [(0, 1, "xyz"), (4, 6, ""), (2, 2, "-")]) == "xyzb-cd"
    assert changed("abc", []) == "abc"
