"""Small IDL texts, in groups by what rosidl_parser 3.3.1 and firm-hdl make of them."""

from __future__ import annotations

__all__ = ["AGREED", "READ_HERE", "REFUSED_FOR_OTHER_REASONS", "REFUSED_HERE"]


def _struct(members: str = "long a;", before: str = "", top: str = "", after: str = "") -> str:
    return f"{top}module p {{ module msg {{ {before} struct T {{ {members} }}; {after} }}; }};"


def _constant(declaration: str, members: str = "long a;") -> str:
    return _struct(members, f"module T_Constants {{ {declaration} }};")


_WORDS = (
    "short; long; unsigned short; unsigned long; unsigned long long; float; double; char; wchar; "
    "boolean; octet; int8; uint8; int16; uint16; int32; uint32; int64; uint64; string; wstring; "
    "string<5>; wstring<5>; sequence<short>; sequence<string<3>>; sequence<string<3>, 4>; "
    "sequence<wstring<3>,4>; sequence < octet , 1024 >; std_msgs::msg::Header; ::q::msg::X; "
    "q::srv::X_Request; q::action::X_Goal; sequence<q::msg::X>; sequence<q::msg::X, 7>"
)

_TEXTS = (
    r"a\n\t\v\b\r\f\a", r"\"q\"", r"\\", r"\\\\", r"\\\"", r"\x41\x7e", r"\1\12\101\377",
    r"\u0041", r"\?", r"\q", "é", "\u2122", r"a\'b", "/* no */ // comment", "#", "",
)  # fmt: skip
_NUMBERS = "1.25 1. .5 -1e10 1.9e+10 9E-05 1e5 8.7d 4.d .3d 7d 1.5D 00.5 09.5"

AGREED: dict[str, str] = {
    # Accepted.
    **{f"type {word}": _struct(f"{word} a;") for word in _WORDS.split("; ")},
    "long long": _struct("long long a;"),
    "long double": _struct("long double a; long  double b, c; long/**/double double;"),
    "long double in arrays": _struct(
        "long double a[3]; sequence<long double> b; sequence<long double, 4> c;"
    ),
    "long double by typedefs": _struct(
        "A a; A b[2]; sequence<A, 3> c; B d; C e;",
        "typedef long double A; typedef long double B[9]; typedef sequence<long double> C;",
    ),
    "long double in a service": "module p { module srv { struct A_Request { long double a; }; "
    "struct A_Response { sequence<long double> b; }; }; };",
    "array": _struct("long a[23];"),
    "array of strings": _struct("string<3> a[23];"),
    "array of structs": _struct("q::msg::X a[2];"),
    "several names": _struct("long a, b, c;"),
    "array last": _struct("long a, b[2];"),
    "array after two names of a typedef": _struct("A a, b, c[2];", "typedef double A;"),
    "names of a typedef of an array": _struct("A a, b;", "typedef double A[9];"),
    "keywords as names": _struct(
        "long struct; long module; string string; boolean boolean; sequence<long> sequence; "
        "long const; long typedef; long TRUE; short short; long enum; char char;"
    ),
    "names": _struct("long a_; long a__b; long ABC; long aB; long a1;"),
    "typedef": _struct("A a; A b;", "typedef long A;"),
    "typedef of an array": _struct("A a;", "typedef double A[9];"),
    "typedef of a sequence": _struct("A a;", "typedef sequence<octet, 8> A;"),
    "typedef of a string": _struct("A a; A b[2]; sequence<A, 3> c;", "typedef string<4> A;"),
    "typedef of a struct": _struct("A a[2];", "typedef q::msg::X A;"),
    "typedef of an array of a typedef": _struct("B a;", "typedef q::msg::X A; typedef A B[8];"),
    "typedef after": _struct("A a;", after="typedef long A;"),
    "typedef twice": _struct("A a;", "typedef long A; typedef int32 A;"),
    "typedef in another module": f"module q {{ typedef short A; }}; {_struct('A a;')}",
    "typedef unused": _struct(before="typedef long A; typedef Nothing B;"),
    "enum": _struct(before="enum E { X, Y };"),
    "enum with annotations": _struct(before="@a enum E { @b(1) X, @c Y };"),
    "forward declaration": _struct(before="struct F;"),
    "module again": _struct() + "module p { module msg { module T_Constants { "
    "const long A = 1; }; }; };",
    "constants of nobody": _struct(before="module U_Constants { const long A = 1; };"),
    "service": "module p { module srv { struct A_Request { long a; }; "
    "struct A_Response { string b; }; }; };",
    "service with constants": "module p { module srv { "
    "module A_Request_Constants { const long J = 1; }; struct A_Request { long a; }; "
    "module A_Response_Constants { const long K = 2; }; struct A_Response { string b; }; }; };",
    "action": "module p { module action { struct A_Goal { long a; }; "
    "struct A_Result { string b; }; struct A_Feedback { p::action::A_Goal c; }; }; };",
    "long double with a default": _struct(
        '@default(value=1.5) long double a; @default(value=-2.0) @unit(value="m") long double b; '
        '@default(value=1.5d) long double c; @default(value="(1.5, 2.0)") long double d[2];'
    ),
    "long double as a constant": _constant(
        "const long double A = 0.1; const long double B = -2.0; const long double C = 1e300;"
    ),
    "constants": _constant(
        "const short A = -23; const unsigned long B = 42; const float C = 1.25; "
        'const boolean D = TRUE; const boolean E = FALSE; const string F = "s"; '
        'const wstring G = L"w\\u2122"; const string H = ""; const octet I = 255; '
        "const int64 J = -9223372036854775808; const uint64 K = 18446744073709551615; "
        'const double L = 1e-5; const string M = "a" "b" ""; const float N = 2.0;'
    ),
    "texts": _constant(
        "".join(
            f'const string S{i} = "{part}"; const wstring W{i} = L"{part}"; '
            for i, part in enumerate(_TEXTS)
        )
    ),
    "numbers": _struct(
        "".join(f"@default(value={value}) double d{i};" for i, value in enumerate(_NUMBERS.split()))
    ),
    "constant with a comment": _constant(
        '@verbatim(language="comment", text="c") const long A = 1;'
    ),
    "comments": _struct("long /* x */ a; // y\n long b; /* **/ long c; /***/", top="// z\n"),
    "comment at the end": _struct() + " // end",
    "blanks": _struct("\f\tlong\r\na ;"),
    "includes": _struct(top='#include "a.idl"\n#include <q/msg/b.idl>\n#include"c" #include <d>\n'),
    "include inside": _struct(before='#include "a.idl"\n'),
    "struct comment": _struct().replace(
        "struct", '@verbatim(language="comment", text="a" "\\n" "b c") struct'
    ),
    "member comment": _struct('@verbatim (language="comment", text="x\\n\\ny") long a, b;'),
    "comments in two": _struct(
        '@verbatim(language="comment", text="x") @verbatim(language="comment", text="y") long a;'
    ),
    "verbatim for others": _struct('@verbatim(language="c", text="x") long a;'),
    "unit": _struct('@unit(value="m/s") double a;'),
    "defaults": _struct(
        '@default(value=-5) long a; @default(value=TRUE) boolean b; @default(value="x") string c; '
        '@default(value=1.5) float d; @default(value=200) octet e; @default(value=L"x") wstring f;'
    ),
    "default of a list": _struct(
        '@default(value="(1, 2, 3)") sequence<long> a; @default(value="()") sequence<long> b;'
        "@default(value=\"('a', 'b c')\") string c[2];"
        '@default(value="(True, False)") boolean d[2];'
        '@default(value="(0.5,)") sequence<double, 3> e;'
    ),
    "annotations": _struct(
        "@key @range(min=-10, max=10) @ id (3) long a; @a::b(1) @external long b;"
    ),
    "extensibility": _struct().replace("struct", "@final @extensibility(APPENDABLE) struct"),
    "transfer mode": _struct().replace("struct", "@transfer_mode(SHMEM_REF) struct"),
    "padding member of another type": _struct("long structure_needs_at_least_one_member;"),
    "comments of the parts of a service": "module p { module srv { "
    '@verbatim(language="comment", text="c") struct A_Request { long a; }; '
    "struct A_Response { string b; }; }; };",
    "struct without fields": _struct("uint8 structure_needs_at_least_one_member;"),
    # Refused.
    "enum with a scope": _struct("p::msg::E a;", "enum E { X, Y };"),
    "default without a value": _struct("@default(minimum=1) long a;"),
    "sequence of sequences": _struct("sequence<sequence<long>> a;"),
    "array of sequences": _struct("sequence<long> a[3];"),
    "two dimensions": _struct("long a[2][3];"),
    "two dimensions in a typedef": _struct(before="typedef long A[2][3];"),
    "two arrays in a declaration": _struct("long a[2], b[3];"),
    "size missing": _struct("long a[];"),
    "bound missing": _struct("string<> a;"),
    "typedef of two": _struct(before="typedef long A, B;"),
    "typedef of two meanings": _struct("A a;", "typedef long A; typedef short A;"),
    "typedef of a new struct": _struct(before="typedef struct X { long b; } A;"),
    "typedef with an annotation": _struct(before="@a typedef long A;"),
    "enum as a type": _struct("E a;", "enum E { X, Y };"),
    "enum inside": _struct("enum E { X } a;"),
    "enum without names": _struct(before="enum E { };"),
    "enum with a comma last": _struct(before="enum E { X, };"),
    "inheritance": _struct().replace("T {", "T : B {"),
    "struct without members": _struct(""),
    "struct inside": _struct("struct X { long b; } a;"),
    "struct without a name": _struct().replace("struct T", "struct"),
    "two messages": _struct(after="struct U { long a; };"),
    "four structs": _struct(
        after="struct U { long a; }; struct V { long a; }; struct W { long a; };"
    ),
    "only declared": "module p { struct T; };",
    "service the other way round": "module p { struct A_Response { long a; }; "
    "struct A_Request { long b; }; };",
    "service of two names": "module p { struct A_Request { long a; }; "
    "struct B_Response { long b; }; };",
    "service in two modules": "module p { struct A_Request { long a; }; }; "
    "module q { struct A_Response { long b; }; };",
    "action of two": "module p { struct A_Goal { long a; }; struct A_Result { long b; }; };",
    "action of two names": "module p { struct A_Goal { long a; }; struct B_Result { long b; }; "
    "struct A_Feedback { long c; }; };",
    "constant outside": _struct(top="const long N = 3;"),
    "constant of a sequence": _constant("const sequence<long> A = 1;"),
    "constant of a typedef": _struct(
        before="typedef long L; module T_Constants { const L A = 1; };"
    ),
    "constant fixed": _constant("const fixed A = 1.5d;"),
    "constant without a value": _constant("const long A;"),
    "constant text from a number": _constant("const string A = 3;"),
    "two signs": _constant("const long A = --1;"),
    "short escape": _constant(r'const string A = "\x4";'),
    "short wide escape": _constant(r'const wstring A = L"\u41";'),
    "text over two lines": _constant('const string A = "a\nb";'),
    "text without an end": _constant('const string A = "a;'),
    "space in a wide text": _constant('const wstring A = L "a";'),
    "mixed texts": _constant('const wstring A = L"a" "b";'),
    "suffix": _constant("const float A = 1.0f;"),
    "not a number": _constant("const long A = 09;"),
    "union": _struct(before="union U switch(long) { case 1: long x; };"),
    "map": _struct("map<long, string> a;"),
    "any": _struct("any a;"),
    "Object": _struct("Object a;"),
    "bitset": _struct(before="bitset B { bitfield<3> a; };"),
    "bitmask": _struct(before="bitmask B { a };"),
    "interface": _struct(before="interface I { };"),
    "valuetype": _struct(before="valuetype V { };"),
    "native": _struct(before="native V;"),
    "exception": _struct(before="exception X { long a; };"),
    "fixed": _struct("fixed<5,2> a;"),
    "annotation declared": _struct(before="@annotation a { long value; };"),
    "annotation without arguments": _struct("@key() long a;"),
    "annotation after": _struct("long a @key;"),
    "annotation with a comma last": _struct("@range(min=1,) long a;"),
    "unknown type": _struct("X a;"),
    "type of ROS": _struct("float64 a;"),
    "type of C": _struct("int a;"),
    "void": _struct("void a;"),
    "bool": _struct("bool a;"),
    "unsigned": _struct("unsigned a;"),
    "signed long": _struct("signed long a;"),
    "unsigned int8": _struct("unsigned int8 a;"),
    "long long long": _struct("long long long a;"),
    "own name": _struct("T a;"),
    "escaped name": _struct("long _a;"),
    "name with a digit first": _struct("long 1a;"),
    "name that is not ASCII": _struct("long é;"),
    "no name": _struct("long;"),
    "comma last": _struct("long a, ;"),
    "no semicolon": _struct("long a"),
    "no semicolon after a struct": _struct().replace("}; ", "} ", 1),
    "no semicolon at the end": _struct()[:-1],
    "two semicolons": _struct("long a;;"),
    "brace missing": _struct()[:-2],
    "brace too many": _struct() + "}",
    "empty module": _struct(before="module T_Constants { };"),
    "empty file": "",
    "only a comment": "// x\n",
    "empty comment": "/**/" + _struct(),
    "comment without an end": _struct() + " /* ",
    "define": _struct(top="#define X 1\n"),
    "pragma": _struct(top="#pragma once\n"),
    "ifndef": _struct(top="#ifndef X\n") + "\n#endif\n",
    "include with a blank": _struct(top='# include "a.idl"\n'),
    "include of nothing": _struct(top='#include ""\n'),
    "include with a semicolon": _struct(top='#include "a.idl";\n'),
    "byte order mark": _struct(top="\ufeff"),
    "NUL": _struct("long\0 a;"),
    "no-break space": _struct("long\u00a0a;"),
    "msg file": "int32 a\nstring b\n",
}

READ_HERE: dict[str, str] = {
    # Constants and expressions: rosidl_parser reads a single literal, and names of constants only
    # in bounds of wstring, where they stay names.
    "constant as a length": _constant("const long N = 3;", "long a[N];"),
    "constant as a bound": _constant("const long N = 3;", "sequence<long, N> a;"),
    "constant as a bound of a string": _constant("const long N = 3;", "string<N> a;"),
    "constant with a scope": _struct("long a[p::N];").replace(
        "module msg", "const long N = 2; module msg"
    ),
    "hexadecimal length": _struct("long a[0x10];"),
    "octal length": _struct("long a[010];"),
    "hexadecimal constant": _constant("const long A = 0xfF;"),
    "octal constant": _constant("const long A = 017; const long B = 00;"),
    "character": _constant("const char A = 'a'; const char B = '\\n'; const char C = '\\x41';"),
    "wide character": _constant("const wchar A = L'a'; const wchar B = L'\\u2122';"),
    "sum": _constant("const long A = 1 + 2;"),
    "all operators": _constant("const long A = 1 | 2 ^ 3 & 4 << 5 >> 1 + 6 - 7 * 8 / 9 % 10;"),
    "constant in parentheses": _constant("const long A = (1); const long B = -(2);"),
    "expression as a default": _struct("@default(value=1 + 2) long a;"),
    "hexadecimal default": _struct("@default(value=0x10) long a;"),
    # Read otherwise.
    "expression as a length": _struct("long a[2*3];"),
    "complement": _struct("@default(value=~1) long a;"),
    "reference to a constant": _constant("const long A = 1; const long B = A;"),
    "constant as a bound of a wstring": _constant("const long N = 3;", "wstring<N> a;"),
    "typedef of a typedef": _struct("B a;", "typedef long A; typedef A B;"),
    "typedef with its scope": _struct("p::msg::A a;", "typedef long A;"),
    "the same constant in both parts of a service": "module p { module srv { "
    "module A_Request_Constants { const long K = 1; }; struct A_Request { long a; }; "
    "module A_Response_Constants { const long K = 1; }; struct A_Response { string b; }; }; };",
    "other modules": "module p { struct T { long a; }; };",
    "no module": "struct T { long a; };",
    "more modules": "module p { module msg { module x { struct T { long a; }; }; }; };",
    "constant in a plain module": "module p { const long N = 3; struct T { long a; }; };",
    "boolean from a number": _constant("const boolean A = 1;"),
    "whole numbers": _constant(
        "const double A = 2;",
        "".join(f"@default(value={v}) double d{i};" for i, v in enumerate("0 7 12 -23 +5".split())),
    ),
}

REFUSED_HERE: dict[str, str] = {
    # Not supported, by the standard or by firm-hdl.
    "optional": _struct("@optional long a;"),
    "mutable": _struct().replace("struct", "@mutable struct"),
    "extensibility mutable": _struct().replace("struct", "@extensibility(MUTABLE) struct"),
    "array of sequences by a typedef": _struct("A a[3];", "typedef sequence<long> A;"),
    "sequence of sequences by a typedef": _struct("sequence<A> a;", "typedef sequence<long> A;"),
    "sequence of arrays by a typedef": _struct("sequence<A> a;", "typedef long A[3];"),
    "two dimensions by a typedef": _struct(
        "A a[2];", "typedef q::msg::X B; typedef B A[3];"
    ).replace("q::msg::X", "long"),
    # Words that are no types.
    "name with one scope": _struct("msg::X a;"),
    "name with three scopes": _struct("a::b::c::X a;"),
    "name of another kind": _struct("a::idl::X a;"),
    # Values that do not fit their types.
    "constant too large": _constant("const uint8 A = 300;"),
    "constant integer with a fraction": _constant("const long A = 1.5;"),
    "constant integer from a text": _constant('const long A = "x";'),
    "default too large": _struct("@default(value=300) uint8 a;"),
    "default negative": _struct("@default(value=-5) unsigned long a;"),
    "default of another type": _struct('@default(value="x") long a;'),
    "default in lower case": _struct("@default(value=true) boolean a;"),
    "default that is no constant": _struct("@default(value=FOO) long a;"),
    "default of a struct": _struct("@default(value=1) q::msg::X a;"),
    "default of a list of another length": _struct('@default(value="(1, 2)") long a[3];'),
    "default of a list that is none": _struct("@default(value=1) long a[3];"),
    "default text too long": _struct('@default(value="abcdef") string<3> a;'),
    "default twice": _struct("@default(value=1) @default(value=2) long a;"),
    "bound of a wstring that is no constant": _struct("wstring<N> a;"),
    "bound of a wstring of 0": _struct("wstring<0> a;"),
    "negative length": _struct("long a[-1];"),
    # Names that would be declared twice in C++.
    "member twice": _struct("long a; long a;"),
    "constant twice": _constant("const long A = 1; const long A = 2;"),
    # Texts that rosidl reads with another meaning than the written one.
    "array and a name after": _struct("long a[2], b;"),
    "number in two words": _struct("long a[1 2];"),
    "words run together": _struct("shortvalue;"),
    "member called long": _struct("long long;"),
    "member called double": _struct("long double;"),
    "long double in one word": _struct("longdouble a;"),
    "long double of a text": _struct('@default(value="x") long double a;'),
    "long double constant of a text": _constant('const long double A = "x";'),
    "long double too large": _constant("const long double A = 1e400;"),
}

# rosidl_parser fails at them in general, and so its refusal confirms none of ours.
REFUSED_FOR_OTHER_REASONS: dict[str, str] = {
    "array of length 0": _struct("long a[0];"),
    "string of length 0": _struct("string<0> a;"),
    "sequence of length 0": _struct("sequence<long, 0> a;"),
    "minus a text": _constant('const string A = -"x";'),
    "integer suffix": _constant("const long A = 1u;"),
    "typedef of nothing": _struct("A a;", "typedef Nothing A;"),
    "typedef of itself": _struct("A a;", "typedef A A;"),
    "typedef of an enum": _struct("A a;", "enum E { X }; typedef E A;"),
}
