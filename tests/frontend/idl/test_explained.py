"""Error messages for texts that are not IDL or not one message, and the words that are marked."""

from __future__ import annotations

import pytest

from firm_hdl.errors import Diagnostic, Source
from firm_hdl.frontend.idl.parse import parse_file

from .reading import read

RULE = "letters, digits and underscores, a letter first"


def parse_error(marked):
    """Parse a wrong text; return it with marks around the words of the error, and the message."""
    text = marked.replace("«", "").replace("»", "")
    found = parse_file(Source(name="t.idl", text=text))
    assert isinstance(found, Diagnostic), found
    start, end = found.span.start, found.span.end
    return f"{text[:start]}«{text[start:end]}»{text[end:]}", found.message


SHIFT = "the '>' before this one ends the type; put a right shift in parentheses here"
INSIDE = "a type cannot be declared inside another declaration"
CASES = [
    ("«#include» x", "'#include' needs a path in quotes or angle brackets"),
    ("«#define» X", "'#define' is not supported: ROS 2 supports only '#include'"),
    ("«# pragma» X", "'# pragma' is not supported: ROS 2 supports only '#include'"),
    ("«/**/»", "an empty comment is not allowed: ROS 2 reads its end as its content"),
    ("module m { «/*» }", "this comment is not closed"),
    ('const string S = «"abc»\n;', "this string is not closed in its line"),
    # A quote in a later line does not close it.
    ('const string S = «"abc»\nd";', "this string is not closed in its line"),
    ('const wstring S = L«"abc»\nd";', "this string is not closed in its line"),
    # The parser has read `L` as a name so far.
    ('const wstring S = L«"abc»\n;', "this string is not closed in its line"),
    ("module m {\n«\ufeff»", "a byte order mark is not allowed"),
    ("const long N = «0x»;", "'0x' is not a number"),
    ("const long N = «1e+»;", "'1e+' is not a number"),
    ("const char C = «'»ab';", "a character literal must have one character, or one escape, "
     "between its quotes"),
    ("const wchar C = L«'»ab';", "a character literal must have one character, or one escape, "
     "between its quotes"),
    ("struct «_a» { long b; };", f"'_a' is not a legal name: {RULE}"),
    ("@annotation «a» { };", "annotations cannot be declared, only used"),
    ("struct S { struct T «{» long a; }; };", INSIDE),
    ("struct S { enum T «{» A }; };", INSIDE),
    ("struct S «:» T { };", "inheritance of structs is not supported"),
    ("struct S { «}»;", "a struct must not be empty"),
    ("enum E { «}»;", "an enum must not be empty"),
    ("module m { «}»;", "a module must not be empty"),
    ("enum E { A, «}»;", "a name must follow the comma"),
    ("struct S { map«<»long, long> a; };", "maps are not supported"),
    ("«;»", "expected a definition, not ';'"),
    ("struct S { long a; }; «}»", "expected a definition or the end of the file, not '}'"),
    ("module m { struct S { long a; }; «;»}",
     "expected a definition or '}', not ';'"),
    ("struct S { long «;» };", "expected 'long' or a name, not ';'"),
    ("struct S { long a «}»;", "expected '[', ',' or ';', not '}'"),
    # Words and signs that are wrong in another way than elsewhere.
    ("struct S { long a «home»; };", "expected '[', ',' or ';', not 'home'"),
    ("struct S { long a «:» 3; };", "expected '[', ',' or ';', not ':'"),
    ("struct S { long a«>»; };", "expected '[', ',' or ';', not '>'"),
    ("struct «3» { };", "expected a name, not '3'"),
    ("struct «3x» { };", "expected a name, not '3x'"),
    ("struct «__a» { long b; };", f"'__a' is not a legal name: {RULE}"),
    # What is before the mistake may be long.
    (f"struct S {{ struct {'T' * 100} «{{»", INSIDE),
    # Prefixes of wide texts where no name can stand.
    ('const string S = "a" «L"abc»\n;', "this string is not closed in its line"),
    ("struct S { long a «L»'x; };", "a character literal must have one character, or one escape, "
     "between its quotes"),
    ("struct S { long«<»3> a; };", "expected 'long' or a name, not '<'"),
    ("struct S { sequence<long, 1>«>»2> a; };", SHIFT),
    ("struct S { string<3>«>» a; };", SHIFT),
    ("struct S { long a, «}»;", "a name must follow the comma"),
    ("struct S { long a[«]»; };", "expected a name, a value, '(' or an operator, not ']'"),
    ("struct S { unsigned «float» a; };", "expected 'long' or 'short', not 'float'"),
    ("struct S { fixed<3«>» a; };", "expected ',', not '>'"),
    ("struct«»", "expected a name, but the file ends here"),
    ("struct« » \n", "expected a name, but the file ends here"),
    ("struct S { long a; }«\n»", "expected ';', but the file ends here"),
]  # fmt: skip


@pytest.mark.parametrize(("marked", "message"), CASES)
def test_wrong_words_are_marked_and_explained(marked, message):
    assert parse_error(marked) == (marked, message)
    if not message.endswith("the file ends here"):
        # A number, a name and a directive that would be wrong there are not the first mistake.
        later = marked + "\nlong _later = 0x; #later\n"
        assert parse_error(later) == (later, message)


@pytest.mark.parametrize(
    ("word", "what"),
    {
        "abstract": "interfaces are",
        "bitmask": "bitmasks are",
        "bitset": "bitsets are",
        "component": "components are",
        "custom": "value types are",
        "eventtype": "event types are",
        "exception": "exceptions are",
        "home": "components are",
        "import": "'import' is",
        "interface": "interfaces are",
        "local": "interfaces are",
        "native": "native types are",
        "typeid": "'typeid' is",
        "typeprefix": "'typeprefix' is",
        "union": "unions are",
        "valuetype": "value types are",
    }.items(),
)
def test_unsupported_features_are_called_by_their_names(word, what):
    for before in ("", "module m { "):
        marked = f"{before}«{word}» x"
        assert parse_error(marked) == (marked, f"{what} not supported")


@pytest.mark.parametrize(
    ("names", "wrong", "message"),
    [
        ("A B", "B", "'B' is a second struct beside 'A'; one message per file"),
        ("A_Request B", "B", "'B' must end with '_Response', as the file declares a service"),
        ("A B_Response", "A", "'A' must end with '_Request', as the file declares a service"),
        ("A_Request B_Response", "B_Response",
         "'B_Response' must be called 'A_Response', to match 'A_Request'"),
        ("A_Goal A_Result", "A_Result",
         "'A_Result' is a second struct beside 'A_Goal'; one message per file"),
        ("A_Goal A_Result B_Feedback", "B_Feedback",
         "'B_Feedback' must be called 'A_Feedback', to match 'A_Goal'"),
    ],
)  # fmt: skip
def test_structs_whose_names_do_not_fit_are_marked(names, wrong, message):
    structs = " ".join(f"struct {name} {{ long a; }};" for name in names.split())
    first, *others = read(f"module p {{ {structs} }};")[1]
    # One wrong name is not reported for the names beside it, too.
    assert others == []
    text = first.span.source.text
    assert (text[first.span.start : first.span.end], first.message) == (wrong, message)


FOREIGN = "'{}' is not a type; did you mean '{}'?"
OF_ROS = "'{}' is not a type; those of ROS are written 'package::msg::Name'"
ENUM = "enum '{}' cannot be the type of a member in ROS 2; use an integer"
STRUCT = "'T' is not a typedef; a struct needs its full name, 'p::msg::T'"
NO_TYPES = {
    **{
        word: FOREIGN.format(word, meant)
        for word, meant in {
            "bool": "boolean",
            "byte": "octet",
            "float32": "float",
            "float64": "double",
            "int": "long",
            "uint": "unsigned long",
            "time": "builtin_interfaces::msg::Time",
            "duration": "builtin_interfaces::msg::Duration",
        }.items()
    },
    **{word: f"type '{word}' is not supported" for word in ("any", "map", "Object", "ValueBase")},
    **{name: ENUM.format(name) for name in ("E", "::E", "msg::E", "p::msg::E", "::p::msg::E")},
    # What other words mean is said only of words without a scope.
    **{name: OF_ROS.format(name) for name in ("U", "std::byte", "p::any", "msg::T", "a::b::c::D")},
    "T": STRUCT,
}


@pytest.mark.parametrize(("name", "message"), NO_TYPES.items(), ids=NO_TYPES)
@pytest.mark.parametrize("form", ["{} a;", "sequence<{}> a;", "{} a[2], b;"])
def test_names_that_are_no_types_are_marked(name, message, form):
    text = f"module p {{ module msg {{ enum E {{ A }}; struct T {{ {form.format(name)} }}; }}; }};"
    first, *_ = read(text)[1]
    start, end = first.span.start, first.span.end
    assert (text[start:end], first.message) == (name, message)
    assert start == text.index(form.format(name)) + form.index("{")


DIMENSIONS = "arrays of several dimensions are not supported"
SIZES = [
    ("«sequence<sequence<long>>» a;", "a sequence of sequences is not supported"),
    ("«sequence<S, 3>» a;", "a sequence of sequences is not supported"),
    ("«sequence<A>» a;", "a sequence of arrays is not supported"),
    ("sequence<long> a[«2»];", "an array of sequences is not supported"),
    ("S a[«1 + 1»];", "an array of sequences is not supported"),
    ("A a[«3»];", DIMENSIONS),
    ("long a[2][«3»];", DIMENSIONS),
    ("long a[2][3][«4»];", DIMENSIONS),
    ("long a[«0»];", "the length of an array must be at least 1, not 0"),
    ("sequence<long, «-1»> a;", "the bound of a sequence must be at least 1, not -1"),
    ("string<«4294967296»> a;", "the bound of a string must be at most 4294967295"),
    ("wstring<«0»> a;", "the bound of a string must be at least 1, not 0"),
    ("sequence<wstring<2>, «4294967295 + 1»> a;",
     "the bound of a sequence must be at most 4294967295"),
    ("long a[«1.5»];", "the length of an array must be an integer"),
    ("string<«'a'»> a;", "the bound of a string must be an integer"),
    ("sequence<long, «TRUE»> a;", "the bound of a sequence must be an integer"),
]  # fmt: skip


@pytest.mark.parametrize(("marked", "message"), SIZES)
def test_wrong_sizes_and_nested_types_are_marked(marked, message):
    head = "module p { typedef long A[2]; typedef sequence<long> S; struct T { "
    text = f"{head}{marked.replace('«', '').replace('»', '')} }}; }};"
    (wrong,) = read(text)[1]
    start, end = wrong.span.start, wrong.span.end
    found = f"{text[:start]}«{text[start:end]}»{text[end:]}"
    assert (found, wrong.message) == (f"{head}{marked} }}; }};", message)


@pytest.mark.parametrize(
    ("members", "array", "good"),
    [
        ("long a[2], «b»;", "a", ["a"]),
        ("long a[2], «b»[2];", "a", ["a"]),
        ("long a[2], «b»[3];", "a", ["a"]),
        # Only the first name that is too many is reported.
        ("long a, b[2], «c»[3], d, e[4];", "b", ["a", "b"]),
        # Each declaration may have an array.
        ("long a[2]; B b[2], «c»; long d[3];", "b", ["a", "b", "d"]),
    ],
)
def test_names_after_an_array_are_marked(members, array, good):
    marked = f"module p {{ typedef double B; struct T {{ {members} }}; }};"
    messages, (only,) = read(marked.replace("«", "").replace("»", ""))
    start, end, text = only.span.start, only.span.end, only.span.source.text
    assert f"{text[:start]}«{text[start:end]}»{text[end:]}" == marked
    assert only.message == (
        f"'{text[start:end]}' follows array '{array}', and ROS 2 gives both the same size; "
        "declare it in a line of its own"
    )
    assert [member.name.text for member in messages["T"].members] == good


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        (
            "typedef sequence<long, 0> A, B; struct T { A a; B b; };",
            ["the bound of a sequence must be at least 1, not 0",
             "a typedef declares one name in ROS 2; 'B' is too many"],
        ),
        # The default is read for the plain name, and again for the array.
        ("struct T { @default(value=N) long a, b[2]; };", ["constant 'N' is not declared above"]),
        ("typedef fixed<3, 2> A; typedef A B; struct T { A a; sequence<A> b; B c; };",
         ["type 'fixed' is not supported"]),
        ("typedef A B; typedef B A; struct T { A a; B b; };", ["typedef 'A' refers to itself"]),
        ("const long N = M; const long O = N; struct T { long a[N]; long b[O]; };",
         ["constant 'M' is not declared above"]),
    ],
)  # fmt: skip
def test_a_mistake_is_reported_once_wherever_it_counts(text, messages):
    _, wrong = read(f"module p {{ {text} }};")
    assert [error.message for error in wrong] == messages


def test_errors_at_one_place_are_in_the_order_of_their_words():
    """What is found first depends on the order of the checks, which tells a user nothing."""
    text = "module p { typedef long b; typedef short a, b; struct T { long x; }; };"
    wrong = read(text)[1]
    assert [(each.message, each.span.start) for each in wrong] == [
        ("a typedef declares one name in ROS 2; 'b' is too many", text.index("b; struct")),
        ("typedef 'b' is already declared as another type", text.index("b; struct")),
    ]
