"""Sections of IDL with several messages: which of their texts is that of which message."""

from __future__ import annotations

import re

import pytest

from firm_hdl.frontend.recordings import structs_of


def cut(marked):
    """Cut a section in which the parts of one message alone are marked; return all texts.

    The marks ``«A|...»`` enclose what only the text of ``A`` has. ``~B`` is the name ``B`` in the
    section, and ``p::msg::B`` in the text of a message.
    """
    plain = re.sub(r"«\w+\||»", "", marked).replace("~", "")
    want = {}
    for name in re.findall(r"«(\w+)\|", marked):
        text = marked
        for part in re.findall(r"«\w+\|.*?»", marked, re.DOTALL):
            owner, _, inside = part[1:-1].partition("|")
            inside = inside if owner == name else re.sub(r"[^\n]", " ", inside.replace("~", ""))
            text = text.replace(part, inside, 1)
        want[name] = text.replace("~", "p::msg::")
    return plain, want


@pytest.mark.parametrize(
    "marked",
    [
        "module p { module msg { «A|struct A { ~B b; };» «B|struct B { long a; };» }; };",
        # What is no struct stays, and what a struct is preceded by belongs to it.
        """module p { module msg {
             typedef long T; const long N = 3; enum E { X };
             module B_Constants { const long M = 4; };«A|
             @verbatim(language="comment", text="struct X { };") @unit("}") struct A {
               long a[N]; // struct Y {
             };»«B|
             struct B { T t; /* }
               { */ long b[B_Constants::M]; };»
           }; };""",
        # The sign after a declaration may be far from it.
        "module p { module msg { «A|struct A{ long a; }\n;»«B| struct\nB\n{ long b; };» }\n; }\n;",
        # Names that are a member's type, and some that only look so.
        """module p { module msg {«A| struct A { ~B a, b; ~B c[2]; sequence<~B> d;
             sequence< ~B , 3> e; q::B f; B::C g; Bx h; AB o; B_last i; long B;
             string<5> j; ~B /* B k */ l; sequence<B_x> m;
             @unit("B b;") ~B n; // B o;
           };»«B| struct B { long a; };» }; };""",
        "module p { module msg { «A|struct A { ~C c; ~B b; };»«B| struct B { ~C c; };»"
        "«C| struct C { long c; };» }; };",
        # A quote that is escaped ends no text.
        'module p { module msg { «A|@unit("\\"}") struct A { long a; };»«B| struct B { long b; };»'
        " }; };",
    ],
)
def test_each_message_has_what_is_its_own_and_what_is_of_all(marked):
    text, want = cut(marked)
    assert structs_of(text) == {("p", "msg", name): own for name, own in want.items()}
    assert len(want) > 1


def test_modules_that_are_empty_without_the_others_are_left_out():
    a = "module p { module msg { struct A { long a; }; }; };"
    b = "module q { module srv { struct A { long b; }; }; };"
    assert structs_of(f"{a} {b}") == {
        ("p", "msg", "A"): f"{a} {' ' * len(b)}",
        ("q", "srv", "A"): f"{' ' * len(a)} {b}",
    }
    # Names of another module are not those beside the struct.
    c = "module p { module action { struct B { A a; }; }; };"
    assert structs_of(f"{a}{c}")["p", "action", "B"] == f"{' ' * len(a)}{c}"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "}}}",
        "module p { module msg { struct A { long a; }; }; };",
        "struct A { long a; }; struct B { long b; };",
        "module msg { struct A { long a; }; struct B { long b; }; };",
        "module p { module idl { struct A { long a; }; struct B { long b; }; }; };",
        "module p { module msg { module m { struct A { long a; }; }; struct B { long b; }; }; };",
        *(
            f"module p {{ module msg {{ struct A_{part} {{ long a; }}; struct B {{ long b; }};"
            " }; };"
            for part in ("Request", "Response", "Goal", "Result", "Feedback")
        ),
        # Only what is closed is a struct.
        "module p { module msg { struct A { long a; }; struct B { long b; ",
        "module p { module msg { struct A { long a; }; // struct B { long b; };\n }; };",
    ],
)
def test_sections_that_are_no_several_messages_are_not_cut(text):
    assert structs_of(text) == {}


def test_structs_without_a_semicolon_after_them_are_cut_at_their_braces():
    head, tail = "module p { module msg {", " }; };"
    a, b = " struct A { long a; }", " struct B { long b; }"
    assert structs_of(head + a + b + tail) == {
        ("p", "msg", "A"): head + a + " " * len(b) + tail,
        ("p", "msg", "B"): head + " " * len(a) + b + tail,
    }


@pytest.mark.parametrize(
    "text", ["module p { module msg { %s", "} module p { module msg { %s }; }; }"]
)
def test_braces_that_do_not_fit_do_not_hide_the_messages(text):
    found = structs_of(text % "struct A { long a; }; struct B { long b; };")
    assert [*found] == [("p", "msg", "A"), ("p", "msg", "B")]
