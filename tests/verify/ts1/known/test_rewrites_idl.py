"""IDL texts that entries of the table of known differences rewrite, and texts that they leave."""

from __future__ import annotations

import pytest

from firm_hdl.verify.ts1.known.idl_values import integer_of
from tests.verify.ts1.known.rewriting import APART, BY_KEY, numbered, rewritten
from tests.verify.ts1.known.test_rewrites import MSG

IDL = [
    # key, before, after
    (
        "ascii-only",
        'const long A\xe9 = \u0661; // \xe9\n"\xe9" \xe9',
        'const long Axe9 = 1; // \xe9\n"\xe9" xe9',
    ),
    ("ascii-only", "/* \xe9\n\xe9 */ \xe9", "/* \xe9\n\xe9 */ xe9"),
    (
        "sizes-of-32-bits",
        "string<4294967296> a; long b[4294967296]; sequence<long, 4294967297> c; "
        "wstring< 4294967295 > d",
        "string<4294967295> a; long b[4294967295]; sequence<long, 4294967295> c; "
        "wstring< 4294967295 > d",
    ),
    ("sizes-of-32-bits", "const long A = 4294967296;", "const long A = 4294967296;"),
    (
        "idl-bounds-by-name",
        "const long N = 3; const uint8 M= 4 ; struct A { wstring<N> a; "
        "wstring < p::M > b; string<N> c;"
        ' wstring<O> d; wstring<5> e; }; // wstring<N>\n"wstring<N>"',
        "const long N = 3; const uint8 M= 4 ; struct A { wstring<3> a; wstring < 4 > b; "
        "string<N> c;"
        ' wstring<O> d; wstring<5> e; }; // wstring<N>\n"wstring<N>"',
    ),
    (
        "idl-bounds-by-name",
        "const long N = 1+2; wstring<N> a;",
        "const long N = 1+2; wstring<N> a;",
    ),
    (
        "idl-bounds-by-name",
        "// const long N = 3;\nwstring<N> a;",
        "// const long N = 3;\nwstring<N> a;",
    ),
    (
        "idl-twice",
        "struct A { long a; short a; long b; string<3> b; long c[3]; long c; };",
        "struct A { long a; short RENAMED610; long b; string<3> RENAMED621; long c[3];"
        " long RENAMED632; };",
    ),
    (
        "idl-twice",
        "module A_Constants { const long A = 1; const short A = 2; const long B = 3; }; "
        "struct A { long A; long B; };",
        "module A_Constants { const long A = 1; const short RENAMED410 = 2; const long B = 3; }; "
        "struct A { long A; long B; };",
    ),
    (
        "idl-twice",
        "struct A { long a, b, a; }; struct B { long a; };",
        "struct A { long a, b, RENAMED610; }; struct B { long a; };",
    ),
    (
        "idl-twice",
        'struct A { long a; // long a;\n @unit(value="; long a;") long b; /* a; */ };',
        'struct A { long a; // long a;\n @unit(value="; long a;") long b; /* a; */ };',
    ),
    (
        "idl-lengths",
        "long a[-3]; long b[ - 3 ]; long c[3]; const long D = -3; // [-3]",
        "long a[1]; long b[ 1 ]; long c[3]; const long D = -3; // [-3]",
    ),
    (
        "idl-words",
        "struct A {longa; unsigned shortb; stringc[3]; unsignedlong d; unsignedshort e;};",
        "struct A {long a; unsigned shortb; string c[3]; unsigned long d; unsigned short e;};",
    ),
    (
        "idl-words",
        "typedef longa; longer b; long c; // {longa;",
        "typedef long a; longer b; long c; // {longa;",
    ),
    (
        "idl-type-scopes",
        "q::msg::B a; q::srv::B b; q::action::B c; q::B d; q::idl::B e[3]; r::q::msg::B f;",
        "q::msg::B a; q::srv::B b; q::action::B c; long d; long e[3]; long f;",
    ),
    (
        "idl-type-scopes",
        "sequence<q::msg::B> a; sequence<q::B> b; sequence< q :: x :: B , 3> c; // q::B d;",
        "sequence<q::msg::B> a; sequence<long> b; sequence< long , 3> c; // q::B d;",
    ),
    (
        "idl-unsupported",
        "@optional long a; @optional(TRUE) long b; @mutable struct; "
        "@extensibility ( MUTABLE ) struct;"
        " @extensibility(FINAL) struct; @optionally long c; // @optional",
        " long a;  long b;  struct;  struct; @extensibility(FINAL) struct; @optionally long c;"
        " // @optional",
    ),
    ("idl-file-names", "struct B { B a; Bb c; }; // B", "struct A { A a; Bb c; }; // B"),
    (
        "idl-file-names",
        "module B_Constants {}; struct B_Request {}; struct B_Response {}; struct B_Event {};",
        "module B_Constants {}; struct B_Request {}; struct B_Response {}; struct B_Event {};",
    ),
    (
        "idl-file-names",
        "module B_Constants {}; module B_Request_Constants {}; struct B_Request {}; "
        "struct B_Response {};",
        "module A_Constants {}; module A_Request_Constants {}; struct A_Request {}; "
        "struct A_Response {};",
    ),
    (
        "idl-file-names",
        "struct B_Goal {}; struct B_Result {}; struct B_Feedback {};",
        "struct A_Goal {}; struct A_Result {}; struct A_Feedback {};",
    ),
    ("idl-file-names", "struct A {}; struct A_Request {};", "struct A {}; struct A_Request {};"),
    ("idl-file-names", "struct B {}; struct C {};", "struct B {}; struct C {};"),
    ("idl-file-names", "// struct B\n", "// struct B\n"),
]


IDL += [
    (
        "idl-expressions",
        "const long A = 1 + 2; const uint8 B = A*2 ; const long C = 0; const long D = -3; "
        "const float E = 1.5; const long F = 0x10 + C; const char G = 'a'; // const long H = 1+1;",
        "const long A = 3; const uint8 B = 6 ; const long C = 0; const long D = -3; "
        "const float E = 1.5; const long F = 16; const char G = 97; // const long H = 1+1;",
    ),
    (
        "idl-expressions",
        "module q { const long N = 2; }; long a[N]; long b[ q::N + 1 ]; string<N> c; "
        "wstring< 1+1 > d; sequence<long, N> e; sequence<string<3>, N*2> f; long g['a']; "
        "string<'a'> h; long i[x::N]; long j[3]; @default(value=N) long k; "
        '@default (value = 1+N) @unit(value="N") long l; @default(value="N") string m;',
        "module q { const long N = 2; }; long a[2]; long b[ 3 ]; string<2> c; "
        "wstring< 2 > d; sequence<long, 2> e; sequence<string<3>, 4> f; long g['a']; "
        "string<'a'> h; long i[x::N]; long j[3]; @default(value=2) long k; "
        '@default (value = 3) @unit(value="N") long l; @default(value="N") string m;',
    ),
    (
        "idl-typedefs",
        "typedef long T; typedef T U; typedef U V[3]; typedef V W; typedef V X[2]; U a;",
        "typedef long T; typedef long U; typedef long V[3]; typedef long W[3]; "
        "typedef V X[2]; U a;",
    ),
    (
        "idl-typedefs",
        "module p { module msg { typedef long T; }; typedef short S; }; typedef p::msg::T U; "
        "p::msg::T a; ::p::msg::T b; msg::T c; p::S d; p::msg::S e; x::T f; p::T g; // p::S",
        "module p { module msg { typedef long T; }; typedef short S; }; typedef long U; "
        "T a; T b; T c; S d; p::msg::S e; x::T f; p::T g; // p::S",
    ),
    ("idl-typedefs", "}; typedef long T; typedef T U;", "}; typedef long T; typedef long U;"),
    (
        "idl-long-names",
        "long longitude; unsigned long long_a; long double d; long long e; long doubled, f; "
        "long long long_b; unsigned  long doubles[3]; // long longitude;",
        "int32 longitude; uint32 long_a; long double d; long long e; int32 doubled, f; "
        "long long long_b; uint32 doubles[3]; // long longitude;",
    ),
    (
        "idl-service-constants",
        "module S_Request_Constants { const long A = 1; const long B = 2; }; "
        "module S_Response_Constants { const long C = 1; const long A = 2; const long B = 3; };"
        " module q { const long A = 3; };",
        "module S_Request_Constants { const long A = 1; const long B = 2; }; "
        "module S_Response_Constants { const long C = 1; const long RENAMED41 = 2;"
        " const long RENAMED42 = 3; }; module q { const long A = 3; };",
    ),
    (
        "idl-defaults",
        '@default(value=1) @default (value=(2)) @unit(value="m") @default(value=3) long a; '
        "@default(value=4) long b; @default(value=5) long c;",
        '@default(value=1)  @unit(value="m")  long a; '
        "@default(value=4) long b; @default(value=5) long c;",
    ),
    (
        "idl-lists-of-one",
        '@default(value="(1)") sequence<long> a; @default(value="( -1.5 )") sequence<float> b; '
        '@default(value="(1, )") sequence<long> c; @default(value="(1, 2)") sequence<long> d; '
        '@default(value=1) long e; @default(value="x") string f; // @default(value="(1)") long g;',
        '@default(value="(1,)") sequence<long> a; @default(value="(-1.5,)") sequence<float> b; '
        '@default(value="(1, )") sequence<long> c; @default(value="(1, 2)") sequence<long> d; '
        '@default(value=1) long e; @default(value="x") string f; // @default(value="(1)") long g;',
    ),
]
LIMITS = {
    "int8": (-128, 127),
    "char": (-128, 127),
    "int16": (-32768, 32767),
    "short": (-32768, 32767),
    "int32": (-(1 << 31), (1 << 31) - 1),
    "long": (-(1 << 31), (1 << 31) - 1),
    "int64": (-(1 << 63), (1 << 63) - 1),
    "long long": (-(1 << 63), (1 << 63) - 1),
    "uint8": (0, 255),
    "octet": (0, 255),
    "uint16": (0, 65535),
    "unsigned short": (0, 65535),
    "wchar": (0, 65535),
    "uint32": (0, (1 << 32) - 1),
    "unsigned long": (0, (1 << 32) - 1),
    "uint64": (0, (1 << 64) - 1),
    "unsigned long long": (0, (1 << 64) - 1),
}
CONSTANTS = [
    # type, value, replacement; `None` if the value fits
    *((kind, str(value), None) for kind, values in LIMITS.items() for value in values),
    *((kind, str(least - 1), "0") for kind, (least, _) in LIMITS.items()),
    *((kind, str(most + 1), "0") for kind, (_, most) in LIMITS.items()),
    ("long", "TRUE", "0"),
    ("long", '"x"', "0"),
    ("long", "1.5", "0"),
    ("long", "'a'", "0"),
    ("char", "'a'", None),
    ("wchar", "L'a'", None),
    ("octet", "'a'", "0"),
    ("long", "N", None),
    ("long", "q::N", None),
    ("long", "O", "0"),
    ("long", "N * 2", None),
    ("octet", "N * 200", "0"),
    ("long", "x + 1", None),
    ("float", "TRUE", "0.0"),
    ("float", '"x"', "0.0"),
    ("double", "FALSE", "0.0"),
    ("long double", '"x"', "0.0"),
    ("float", "1", None),
    ("double", "1.5e3", None),
    ("boolean", "TRUE", None),
    ("boolean", "FALSE", None),
    ("boolean", "0", None),
    ("boolean", "1", None),
    ("boolean", "2", "FALSE"),
    ("boolean", "1.5", "FALSE"),
    ("boolean", '"x"', "FALSE"),
    ("string", '"x"', None),
    ("string", "1", '""'),
    ("string", "1.5", '""'),
    ("string", "TRUE", '""'),
    ("wstring", 'L"x"', None),
    ("wstring", "FALSE", '""'),
    ("unknown", "1", None),
]
DEFAULTS = [
    # member, value, whether it fits
    ("octet a", "255", True),
    ("octet a", "256", False),
    ("unsigned  long a", "-1", False),
    ("boolean a", "TRUE", True),
    ("boolean a", "2", False),
    ("string<3> a", '"abc"', True),
    ("string<3> a", '"abcd"', False),
    ("wstring<3> a", 'L"abc"', True),
    ("wstring<3> a", 'L"abcd"', False),
    ("string<N> a", '"abc"', False),
    ("string a", '"abcd"', True),
    ("octet a[2]", '"(1, 2)"', True),
    ("octet a[2]", '"(1, 256)"', False),
    ("octet a[2]", '"(256, 1)"', False),
    ("octet a[2]", '"(1, )"', False),
    ("octet a[2]", '"(1, 2, 3)"', False),
    ("octet a[2]", "1", False),
    ("octet a[2]", '"[1, 2]"', True),
    ("octet a[2]", '"[1, 2, 3]"', False),
    ("octet a[2]", '"x"', True),
    ("octet a[2]", '"3"', True),
    ("octet a[N]", '"(1, 2)"', True),
    ("octet a[N]", '"(1, 2, 3)"', False),
    ("sequence<octet> a", '"(1, 2, 3)"', True),
    ("sequence<octet> a", '"(1, 256)"', False),
    ("sequence<octet, 2> a", '"(1,)"', True),
    ("sequence<octet, N> a", '"(1, 2)"', True),
    ("sequence<octet, N> a", '"(1, 2, 3)"', False),
    ("sequence<boolean> a", '"(True, False)"', True),
    ("sequence<octet> a", '"(True, )"', False),
    ("sequence<string<2>> a", "\"('ab', 'c')\"", True),
    ("sequence<string<2>> a", "\"('ab', 'abc')\"", False),
    ("sequence<string> a", '"(1, )"', False),
    ("T a", "255", True),
    ("T a", "256", False),
    ("q::U a", '"(1, 2, 3)"', True),
    ("q::U a", '"(1, 2)"', False),
    ("q::U a", '"(1, 2, 256)"', False),
    ("V a", '"(1, 2, 3)"', True),
    ("V a", '"(1, 2, 3, 4)"', False),
]
DECLARATIONS = "module q { const long N = 2; typedef octet T; typedef T U[3]; "
DECLARATIONS += "typedef sequence<T, 3> V; }; "


@pytest.mark.parametrize(("kind", "value", "instead"), CONSTANTS)
def test_constants_that_do_not_fit(kind, value, instead):
    text = f"{DECLARATIONS}const {kind} A = {value}; const {kind} B = {value};"
    expected = text
    if instead is not None:
        expected = f"{DECLARATIONS}const {kind} A ={instead}; const {kind} B ={instead};"
    assert rewritten("idl-values", text, language="idl") == expected


@pytest.mark.parametrize(("member", "value", "fits"), DEFAULTS)
def test_defaults_that_do_not_fit(member, value, fits):
    note, unit = f"@default(value={value})", '@unit(value="m")'
    text = f"{DECLARATIONS}{note} {unit} {member}; @default(value=1) long z;"
    expected = text if fits else text.replace(note, "", 1)
    assert rewritten("idl-values", text, language="idl") == expected


@pytest.mark.parametrize(("key", "before", "after"), numbered(IDL))
def test_rewriting_idl(key, before, after):
    assert rewritten(key, before, language="idl") == after


def test_every_rewriting_has_a_row():
    rows = {row[0] for row in [*MSG, *IDL]} | APART
    assert rows == {key for key, each in BY_KEY.items() if each.rewrite}


def test_included_files_are_looked_up():
    included = (
        "module q { const long N = 3; const long M = N + 1; typedef long T; typedef T U; };",
        "typedef long R[2]; const long O = 5; // const long P = 1;",
    )
    text = "long a[N]; string<q::M> b; const long X = O; @default(value=N) q::U c; T d; R e; "
    text += "sequence<T> f; long h[::q::N]; N::T g; "
    text += 'const long Y = 1 + N; long N; "N" // N\n; const P = P;'
    assert rewritten("idl-includes", text, language="idl", included=included) == (
        "long a[3]; string<4> b; const long X = 5; @default(value=3) long c; long d; R e; "
        'sequence<long> f; long h[3]; long g; const long Y = 1 + 3; long N; "N" // N\n; '
        "const P = P;"
    )
    # Declarations of the text itself have priority; without files, the name is unknown.
    text = "const long N = 7; typedef short T; long a[N]; T b; long c[M];"
    expected = text.replace("[M]", "[4]")
    assert rewritten("idl-includes", text, language="idl", included=included) == expected
    assert rewritten("idl-includes", text, language="idl") == text


NAMES = {"N": 3, "M": -2}


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1 + 2 * 3", 7),
        ("(1 + 2) * 3", 9),
        ("7 / 2", 3),
        ("7 / 0", 0),
        ("7 % 4", 3),
        ("7 - 9", -2),
        ("1 << 4", 16),
        ("1 << 64", 1 << 64),
        ("1 << 65", None),
        ("2 << 64", None),
        ("256 >> 4", 16),
        ("6 | 1", 7),
        ("6 ^ 3", 5),
        ("6 & 3", 2),
        ("-5", -5),
        ("+5", 5),
        ("~5", -6),
        ("0x1F", 31),
        ("017", 15),
        ("0", 0),
        ("08", None),
        ("1.5", None),
        ("N + q::N", 6),
        ("::q::M", -2),
        ("x::N", None),
        ("O", None),
        ("'a'", 97),
        ("L'a'", 97),
        ("'\\n'", 10),
        ("'\\x41'", 65),
        ("L'\\u00e9'", 233),
        ("'ab'", None),
        # Integers for Python only.
        ("0b1", None),
        ("0o7", None),
        ("1_000", None),
        ("--1", None),
        ("1 - -1", 2),
        ("1 + ~1", -1),
        ("1 - - -1", None),
        ("(-+1)", None),
        ("(-1)", -1),
        ("2 ** 3", None),
        ("True", None),
        ("f(1)", None),
        ("", None),
        ("1 +", None),
    ],
)
def test_integers_of_idl(expression, value):
    assert integer_of(expression, NAMES, {"q"}) == value
