"""An example of each known difference, with an injected fault for its must-fail twin.

The twin is a front end with a fault besides the known difference. The fault must be reported.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.model import PRIMITIVES, Message, Service, String

__all__ = ["EXAMPLES", "Example", "drop_last", "refuse"]

_Fault = Callable[[Any], Any]


def refuse(read):
    """Refuse the definition."""
    return DefinitionError([Diagnostic(message="it is planted")])


def drop_last(read):
    """Drop the last field."""
    if isinstance(read, Service):
        return replace(read, response=drop_last(read.response))
    return replace(read, fields=read.fields[:-1]) if isinstance(read, Message) else read


def _constant(**changes):
    """Return a fault that changes the first constant."""

    def fault(read):
        if not isinstance(read, Message):
            return read
        first = replace(read.constants[0], **changes)
        return replace(read, constants=(first, *read.constants[1:]))

    return fault


def _field(index, **changes):
    """Return a fault that changes a field."""

    def fault(read):
        if not isinstance(read, Message):
            return read
        fields = list(read.fields)
        fields[index] = replace(fields[index], **changes)
        return replace(read, fields=tuple(fields))

    return fault


def _accept(read):
    """Accept a definition that must be refused."""
    return Message(name="p/msg/A", dialect="ros2", fields=()) if refuses(read) else read


def refuses(read):
    return isinstance(read, DefinitionError)


def _rename(read):
    return replace(read, name="p/msg/B") if isinstance(read, Message) else read


def _length(read):
    return _field(0, type=replace(read.fields[0].type, count=6))(read)


def _response(change):
    """Return a fault that changes the response of a service."""

    def fault(read):
        return replace(read, response=change(read.response)) if isinstance(read, Service) else read

    return fault


def _comment(read):
    return replace(read, comment=read.comment[:-1]) if isinstance(read, Message) else read


@dataclass(frozen=True, kw_only=True)
class Example:
    """A definition ``p/A`` with a known difference, and a field after it that has none.

    Attributes
    ----------
    key, oracle : str
    text : str
        Its last field must have no known difference.
    fault : callable
        Changes the definition that the twin has read.
    distro : str
    idl : bool
    kind : str
        Kind of the definition.
    more : mapping of str to str
        Other definitions.
    judgeable : str
        A similar text without the known difference, if the text with it cannot be judged. Its twin
        refuses this text.
    """

    key: str
    oracle: str
    text: str
    fault: _Fault
    distro: str = "lyrical"
    idl: bool = False
    kind: str = "msg"
    more: Mapping[str, str] = field(default_factory=dict)
    judgeable: str = ""

    @property
    def files(self):
        return {self.file: self.text, **self.more}

    @property
    def judgeable_files(self):
        return {self.file: self.judgeable, **self.more}

    @property
    def file(self):
        return f"p/{self.kind}/A.{'idl' if self.idl else self.kind}"


def _ros1(key, oracle, text, fault, **more):
    return Example(
        key=key, oracle=oracle, text=text + "uint16 last\n", fault=fault, distro="noetic", **more
    )


def _ros2(key, oracle, text, fault, **more):
    return Example(key=key, oracle=oracle, text=text + "uint16 last\n", fault=fault, **more)


def _idl(
    key,
    members,
    fault,
    before="",
    name="A",
    modules=("p", "msg"),
    oracle="rosidl_parser",
    include="",
    **more,
):
    text = (
        f"{include}module {modules[0]} {{ module {modules[1]} {{ {before} "
        f"struct {name} {{ {members} unsigned short last; }}; }}; }};"
    )
    return Example(key=key, oracle=oracle, text=text, fault=fault, idl=True, **more)


_N = "module A_Constants { const long N = 3; };"
_B = {
    "p/msg/B.idl": "module p { module msg { module B_Constants { const long N = 4; }; "
    "typedef sequence<long> L; typedef wstring T; struct B { long x; }; }; };"
}

_WIDE, _CHAR, _UINT8 = String(wide=True), PRIMITIVES["ros2"]["char"], PRIMITIVES["ros2"]["uint8"]

EXAMPLES: tuple[Example, ...] = (
    # Definitions that rosbags refuses, or reads differently.
    _ros2("rosbags-crlf", "rosbags", "int8 X=1\r\nint8 a\r\n", _constant(value=2)),
    _ros2("rosbags-wstring", "rosbags", "wstring<=4[] a\n", _field(0, name="b")),
    # The same primitive beside it, or where it is, is another difference.
    _ros2("rosbags-wstring", "rosbags", "wstring w\nstring s\n", _field(1, type=_WIDE)),
    _ros2("rosbags-wstring", "rosbags", "wstring w\nstring s\n", _field(0, type=String())),
    _ros2("rosbags-wstring", "rosbags", "wstring w\nstring S=x\n", _constant(type=_WIDE)),
    _ros2(
        "rosbags-special-types",
        "rosbags",
        "Header h\n",
        _field(0, name="g"),
        more={"p/msg/Header.msg": "int8 x\n"},
    ),
    _ros2("rosbags-special-types", "rosbags", "time t\n", _accept),
    _ros2(
        "rosbags-placeholders",
        "rosbags",
        "uint8 structure_needs_at_least_one_member 3\nint8 a\n",
        _field(0, name="structure_has_one_more_member"),
    ),
    _ros1("rosbags-constant-names", "rosbags", "uint8 low=1\nint8 a\n", _constant(name="LOW")),
    _ros1("rosbags-constant-names", "rosbags", "uint8 low = 1\n", _constant(value=2)),
    _ros1("rosbags-constant-names", "rosbags", "uint8 _A=1\nint8 a\n", _constant(name="A")),
    _ros1("rosbags-texts", "rosbags", 'string NAME="x"\n', _constant(value="x")),
    _ros1("rosbags-texts", "rosbags", "string NAME=[1, 2]\n", _constant(value="[1,2]")),
    _ros2("rosbags-texts", "rosbags", "string NAME=5 # five\n", _constant(value="5 # five")),
    _ros2("rosbags-texts", "rosbags", "string s 2nd floor\n", _field(0, name="t")),
    _ros1("rosbags-constant-bool", "rosbags", "bool ON=1\n", _constant(value=False)),
    _ros1("rosbags-integers", "rosbags", "int8 N=010\n", _constant(value=8)),
    _ros2("rosbags-integers", "rosbags", "int32 N=1_000\n", _constant(value=1)),
    _ros1("rosbags-floats", "rosbags", "float32 LOW = 0\n", _constant(value=-0.0)),
    _ros2("rosbags-floats", "rosbags", "float64 X=-inf # low\n", _constant(value=float("inf"))),
    _ros2("rosbags-char-hash", "rosbags", "char c\n", _field(0, name="d")),
    _ros2("rosbags-char-hash", "rosbags", "char c\nuint8 u\n", _field(1, type=_CHAR)),
    _ros2("rosbags-char-hash", "rosbags", "char c\nuint8 u\n", _field(0, type=_UINT8)),
    # Definitions that rosbags accepts.
    _ros2("rosbags-names", "rosbags", "int32 Bad\n", drop_last),
    _ros2(
        "rosbags-type-names",
        "rosbags",
        "bad b\n",
        refuse,
        more={"p/msg/bad.msg": "int8 x\n", "p/msg/Good.msg": "int8 x\n"},
        judgeable="Good b\n",
    ),
    _ros1("rosbags-twice", "rosbags", "int8 a\nint8 a\n", drop_last),
    _ros2("rosbags-twice", "rosbags", "int8 A=1\nint8 A=2\n", drop_last),
    _ros1("rosbags-values", "rosbags", "uint8 X=256\n", drop_last),
    _ros2("rosbags-values", "rosbags", "bool ON=yes\nint8[2] a [1]\n", drop_last),
    _ros1("rosbags-sizes", "rosbags", "int8[0] x\n", drop_last),
    _ros1("rosbags-ros2-forms", "rosbags", "string<=5 a\nint8 b 1\n", drop_last),
    _ros1("rosbags-blanks", "rosbags", "int8\ta\n", drop_last),
    _ros2("rosbags-blanks", "rosbags", " int8 a\n", drop_last),
    _ros2("rosbags-annotations", "rosbags", "@key\nint8 a\n", drop_last),
    # genmsg.
    _ros1("ros1-constant-names", "genmsg", "int8 a-b=1\n", drop_last),
    _ros1("ros1-bool-literals", "genmsg", "bool ON=[1]\n", _constant(value=False)),
    _ros1("ros1-empty-arrays", "genmsg", "int8[0] x\n", drop_last),
    _ros1("ros1-indented-texts", "genmsg", "  string X=1\n", _constant(value="2")),
    _ros1("ros1-64-bit-limits", "genmsg", "int64 X=9223372036854775808\n", drop_last),
    _ros1("ascii-only", "genmsg", "int8 größe\n", drop_last),
    _ros1("sizes-of-32-bits", "genmsg", "int8[4294967296] x\n", drop_last),
    _ros1("sizes-of-32-bits", "rosbags", "int8[4294967296] x\n", drop_last),
    _ros2("sizes-of-32-bits", "rosbags", "int8[<=4294967296] x\n", drop_last),
    # rosidl.
    _ros2("ascii-only", "rosidl_adapter", "int8 X=\uff11\n", _constant(value=2)),
    _ros2("ascii-only", "rosidl_parser", "int8 X=\uff11\n", _constant(value=2)),
    _ros2("sizes-of-32-bits", "rosidl_adapter", "int8[4294967296] x\n", drop_last),
    _idl("sizes-of-32-bits", "sequence<long, 4294967296> x;", drop_last),
    _ros2(
        "ros2-escaped-quotes",
        "rosidl_adapter",
        'string[] x ["\\"", "a\\"b"]\n',
        _field(0, default=("", "ab")),
    ),
    _ros2(
        "ros2-escaped-quotes",
        "rosidl_parser",
        'string[] x ["\\"", "a\\"b"]\n',
        _field(0, default=("", "ab")),
    ),
    _ros2("ros2-backslashes", "rosidl_parser", "string X=a\\b\n", _constant(value="ab")),
    _ros2(
        "ros2-infinite-numbers",
        "rosidl_parser",
        "float64 a -inf\n",
        _field(0, default=float("inf")),
    ),
    _ros2("ros2-comment-blanks", "rosidl_adapter", "# Head. \n\nint8 x\n", _comment),
    # IDL.
    _idl("idl-names", "long x;", _rename, modules=("q", "idl")),
    Example(
        key="idl-names",
        oracle="rosidl_parser",
        kind="srv",
        idl=True,
        text="module q { module srv { struct A_Request { long a; }; "
        "struct A_Response { string b; unsigned short last; }; }; };",
        fault=_response(lambda part: replace(part, name="p/srv/A_Reply")),
    ),
    _idl("idl-lengths", "long x[-1];", drop_last),
    _idl("idl-long-names", "long longitude; unsigned long doubled[2];", _field(0, name="itude")),
    _idl("idl-words", "shortvalue; unsignedlong x;", drop_last),
    _idl("idl-type-scopes", "msg::X x; a::b::c::X y[2];", drop_last),
    _idl("idl-type-scopes", "sequence<a::X> x; p::T y;", drop_last, before="typedef long T;"),
    _idl("idl-file-names", "long x;", drop_last, name="B"),
    _idl("idl-bounds-by-name", "sequence<wstring<N>, 2> x;", _constant(value=4), before=_N),
    # Another constant of the same name, behind: its value is none of the bound's.
    _idl(
        "idl-bounds-by-name",
        "wstring<N> x;",
        _field(0, type=String(wide=True, bound=4)),
        before=_N + "module B_Constants { const long N = 4; }; module q { const long N = 4; };",
    ),
    _idl("idl-unseen-bounds", "wstring<NONE> x; long y;", drop_last),
    _idl(
        "idl-unseen-bounds",
        "wstring<N> x; long y;",
        drop_last,
        before=_N.replace("A_", "B_") + _N.replace("A_", "C_"),
    ),
    _idl("idl-unseen-bounds", "wstring<N> x; long y;", drop_last, before=_N.replace("A_", "")),
    _idl(
        "idl-whole-numbers",
        '@default(value=3) double x; @default(value="(1, 2)") double y[2];',
        _field(1, default=(1.0, 3.0)),
        before="module A_Constants { const long double N = 3; };",
    ),
    _idl(
        "idl-long-double-hash",
        "long double x;",
        _field(0, name="y"),
        oracle="rosidl_parser-4.9",
    ),
    _idl("idl-twice", "long x; long x;", drop_last),
    _idl(
        "idl-twice",
        "long x;",
        drop_last,
        before="module A_Constants { const long N = 3; const long N = 4; };",
    ),
    _idl("idl-typedefs", "B x; p::msg::A y;", drop_last, before="typedef long A; typedef A B;"),
    _idl("idl-typedefs", "B x;", drop_last, before="typedef long A[3]; typedef A B;"),
    _idl("idl-expressions", "long x[2*N+0x1];", _length, before=_N),
    _idl(
        "idl-expressions",
        "long x;",
        _constant(value=ord("b")),
        before="module A_Constants { const char C = 'a'; };",
    ),
    _idl(
        "idl-booleans",
        "long x;",
        _constant(value=False),
        before="module A_Constants { const boolean B = 1; };",
    ),
    Example(
        key="idl-service-constants",
        oracle="rosidl_parser",
        kind="srv",
        idl=True,
        text="module p { module srv { module A_Request_Constants { const long K = 1; }; "
        "struct A_Request { long a; }; module A_Response_Constants { const long K = 1; }; "
        "struct A_Response { string b; unsigned short last; }; }; };",
        fault=_response(lambda part: replace(part, constants=())),
    ),
    _idl(
        "idl-includes",
        "T x; sequence<wstring<B_Constants::N>, p::msg::B_Constants::N> y; long z[B_Constants::N];",
        _field(2, name="w"),
        more=_B,
        include='#include "p/msg/B.idl"\n',
    ),
    _idl("idl-defaults", '@default(value=1) @unit(value="m") @default(value=2) long x;', drop_last),
    _idl("idl-short-annotations", '@default(3) long x; @unit("m") long y;', _field(0, default=4)),
    _idl("idl-defaults", "@default @default(value=2) long x;", drop_last),
    _idl(
        "idl-values",
        '@default(value=300) uint8 a; @default(value="(1, 2, 3)") long b[2]; '
        '@default(value=5) string c; @default(value="(1, -1)") sequence<octet> d; '
        "@default(value=TRUE) T e;",
        drop_last,
        before="typedef double T;",
    ),
    _idl(
        "idl-values",
        "long x;",
        drop_last,
        before="module A_Constants { const long long L = 9223372036854775808; "
        'const float F = "x"; const boolean B = 2; };',
    ),
    _idl("idl-lists-of-one", '@default(value="(7)") sequence<long> x;', _field(0, default=(8,))),
    _idl("ros2-wstring-sequences", "sequence<wstring<4>> x;", _field(0, name="y")),
    _ros2("ros2-wstring-sequences", "rosidl_parser", "wstring<=4[] x\n", _field(0, name="y")),
    _idl("idl-unsupported", "@optional long x;", drop_last),
    Example(
        key="idl-lists-of-lists",
        oracle="rosidl_parser",
        idl=True,
        text="module p { module msg { typedef sequence<long> L; struct A { L x[3]; }; }; };",
        fault=refuse,
        judgeable="module p { module msg { typedef sequence<long> L; struct A { L x; }; }; };",
    ),
)
