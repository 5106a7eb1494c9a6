"""The table of known differences: an example of each key with the real oracle.

Beside each difference, faults are planted in the front end, which must be noticed.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.model import Message, Service, String
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged
from firm_hdl.verify.ts1 import facts
from firm_hdl.verify.ts1 import judge as judging
from firm_hdl.verify.ts1.known import KNOWN
from tests.verify.judged import assert_known, assert_passed

ERRATA = Path(__file__).parents[3] / "docs" / "reference" / "errata.md"


def refuse(read):
    """Refuse the definition."""
    return DefinitionError([Diagnostic(message="it is planted")])


def drop_last(read):
    """Drop the last field."""
    if isinstance(read, Service):
        return replace(read, response=drop_last(read.response))
    return replace(read, fields=read.fields[:-1]) if isinstance(read, Message) else read


def constant(value):
    """Return a fault that gives the first constant another value."""
    return lambda read: replace(read, constants=(replace(read.constants[0], value=value),))


def field(index, **changes):
    """Return a fault that changes a field."""

    def fault(read):
        fields = list(read.fields)
        fields[index] = replace(fields[index], **changes)
        return replace(read, fields=tuple(fields))

    return fault


@dataclass(frozen=True)
class Example:
    """A definition ``p/A`` with a known difference, and a field after it that has none."""

    key: str
    oracle: str
    text: str
    fault: Callable[[Any], Any] = drop_last
    more: tuple[tuple[str, str], ...] = ()
    kind: str = "msg"
    is_ros1: bool = False

    @property
    def files(self):
        is_idl = "module" in self.text
        end = "" if is_idl else "uint16 last\n"
        suffix = "idl" if is_idl else self.kind
        return {f"p/{self.kind}/A.{suffix}": self.text + end, **dict(self.more)}


def ros1(key, oracle, text, fault=drop_last):
    return Example(key, oracle, text, fault, is_ros1=True)


def idl(key, members, fault=drop_last, before="", head="", modules=("p", "msg"), **more):
    body = f"{before} struct A {{ {members} unsigned short last; }};"
    text = f"{head}module {modules[0]} {{ module {modules[1]} {{ {body} }}; }};"
    return Example(key, more.pop("oracle", "rosidl_parser"), text, fault, **more)


def constants(declared):
    return f"module A_Constants {{ {declared} }};"


def service(first, second):
    return Example(
        "idl-service-constants" if first else "idl-names",
        "rosidl_parser",
        f"module {'p' if first else 'q'} {{ module srv {{ {first} struct A_Request {{ long a; }};"
        f" {second} struct A_Response {{ string b; unsigned short last; }}; }}; }};",
        kind="srv",
    )


N = "const long N = 3;"
B = "module p { module msg { module B_Constants { const long N = 4; }; typedef sequence<long> L; "
INCLUDED = (("p/msg/B.idl", B + "typedef wstring T; struct B { long x; }; }; };"),)
QUOTES = 'string[] x ["\\"", "a\\"b"]\n'
BAD = (("p/msg/bad.msg", "int8 x\n"),)
HEADER = (("p/msg/Header.msg", "int8 x\n"),)

EXAMPLES = (
    # rosbags refuses it, or reads it otherwise.
    Example("rosbags-crlf", "rosbags", "int8 X=1\r\nint8 a\r\n", constant(2)),
    Example("rosbags-wstring", "rosbags", "wstring<=4[] a\n"),
    Example("rosbags-special-types", "rosbags", "Header h\n", field(0, name="g"), HEADER),
    Example("rosbags-special-types", "rosbags", "time t\n"),
    Example(
        "rosbags-placeholders", "rosbags", "uint8 structure_needs_at_least_one_member 3\nint8 a\n"
    ),
    ros1("rosbags-constant-names", "rosbags", "uint8 low=1\nint8 a\n"),
    ros1("rosbags-constant-names", "rosbags", "uint8 low = 1\nint8 A = 2\n"),
    ros1("rosbags-texts", "rosbags", 'string NAME="x"\n', constant('"y"')),
    Example("rosbags-texts", "rosbags", "string NAME=5 # five\n", constant("6")),
    Example("rosbags-texts", "rosbags", "string s 2nd floor\n"),
    ros1("rosbags-constant-bool", "rosbags", "bool ON=1\n", constant(False)),
    ros1("rosbags-integers", "rosbags", "int8 N=010\n", constant(9)),
    Example("rosbags-integers", "rosbags", "int32 N=1_000\n"),
    ros1("rosbags-floats", "rosbags", "float32 LOW = 0\n", constant(-0.0)),
    Example("rosbags-floats", "rosbags", "float64 X=-inf # low\n", constant(float("inf"))),
    Example("rosbags-char-hash", "rosbags", "char c\n", field(0, name="d")),
    # rosbags accepts mistakes.
    Example("rosbags-names", "rosbags", "int32 Bad\n"),
    Example("rosbags-type-names", "rosbags", "bad b\n", more=BAD),
    ros1("rosbags-twice", "rosbags", "int8 a\nint8 a\n"),
    Example("rosbags-twice", "rosbags", "int8 A=1\nint8 A=2\n"),
    ros1("rosbags-values", "rosbags", "uint8 X=256\n"),
    Example("rosbags-values", "rosbags", "bool ON=yes\nint8[2] a [1]\n"),
    ros1("rosbags-sizes", "rosbags", "int8[0] x\n"),
    ros1("rosbags-ros2-forms", "rosbags", "string<=5 a\nint8 b 1\n"),
    ros1("rosbags-blanks", "rosbags", "int8\ta\n"),
    Example("rosbags-blanks", "rosbags", " int8 a\n"),
    Example("rosbags-annotations", "rosbags", "@key\nint8 a\n"),
    Example("sizes-of-32-bits", "rosbags", "int8[<=4294967296] x\n"),
    # genmsg.
    ros1("ros1-constant-names", "genmsg", "int8 a-b=1\n"),
    ros1("ros1-bool-literals", "genmsg", "bool ON=[1]\n"),
    ros1("ros1-empty-arrays", "genmsg", "int8[0] x\n"),
    ros1("ros1-indented-texts", "genmsg", "  string X=1\n"),
    ros1("ros1-64-bit-limits", "genmsg", "int64 X=9223372036854775808\n"),
    ros1("ascii-only", "genmsg", "int8 größe\n"),
    ros1("sizes-of-32-bits", "genmsg", "int8[4294967296] x\n"),
    # rosidl.
    Example("ascii-only", "rosidl_adapter", "int8 X=\uff11\n"),
    Example("ascii-only", "rosidl_parser", "int8 X=\uff11\n"),
    Example("sizes-of-32-bits", "rosidl_adapter", "int8[4294967296] x\n"),
    idl("sizes-of-32-bits", "sequence<long, 4294967296> x;"),
    Example("ros2-escaped-quotes", "rosidl_adapter", QUOTES, field(0, name="y")),
    Example("ros2-escaped-quotes", "rosidl_parser", QUOTES, field(0, name="y")),
    Example("ros2-backslashes", "rosidl_parser", "string X=a\\b\n", constant("ab")),
    Example("ros2-infinite-numbers", "rosidl_parser", "float64 a -inf\n", field(0, default=1.0)),
    Example(
        "ros2-comment-blanks",
        "rosidl_adapter",
        "# Head. \n\nint8 x\n",
        lambda read: replace(read, comment="Hea."),
    ),
    Example(
        "ros2-wstring-sequences",
        "rosidl_parser",
        "wstring<=4[] x\n",
        lambda read: field(0, type=replace(read.fields[0].type, bound=5))(read),
    ),
    # IDL.
    idl("idl-names", "long x;", lambda read: replace(read, name="p/msg/B"), modules=("q", "idl")),
    service("", ""),
    idl("idl-bounds-by-name", "sequence<wstring<N>, 2> x;", constant(4), before=constants(N)),
    idl(
        "idl-bounds-by-name", "wstring<N> x;", field(0, type=String(bound=3)), before=constants(N)
    ),
    idl(
        "idl-whole-numbers",
        '@default(value=3) double x; @default(value="(1, 2)") double y[2];',
        field(1, default=(1.0, 3.0)),
        before=constants("const long double N = 3;"),
    ),
    idl("idl-booleans", "long x;", constant(False), before=constants("const boolean B = 1;")),
    idl(
        "idl-long-double-hash", "long double x;", field(0, name="y"), oracle="rosidl_parser-4.9"
    ),
    idl("idl-lists-of-one", '@default(value="(7)") sequence<long> x;', field(0, default=(8,))),
    idl("idl-short-annotations", '@default(3) long x; @unit("m") long y;'),
    idl("idl-includes", "T x; long z[B_Constants::N];", head='#include "p/msg/B.idl"\n',
        more=INCLUDED),
    idl("idl-typedefs", "B x; p::msg::A y;", before="typedef long A; typedef A B;"),
    idl("idl-expressions", "long x[2*N+0x1];", constant(4), before=constants(N)),
    idl("idl-expressions", "long x;", before=constants("const char C = 'a';")),
    idl("idl-long-names", "long longitude; unsigned long doubled[2];"),
    service("module A_Request_Constants { const long K = 1; };",
            "module A_Response_Constants { const long K = 1; };"),
    Example(
        "idl-file-names", "rosidl_parser", "module p { module msg { struct B { long last; }; }; };"
    ),
    idl("idl-unseen-bounds", "wstring<NONE> x;"),
    idl("idl-twice", "long x; long x;"),
    idl("idl-twice", "long x;", before=constants("const long N = 3; const long N = 4;")),
    idl("idl-lengths", "long x[-1];"),
    idl("idl-words", "shortvalue; unsignedlong x;"),
    idl("idl-names-after-arrays", "long x[2], y;"),
    idl("idl-type-scopes", "msg::X x; a::b::c::X y[2];"),
    idl("idl-unsupported", "@optional long x;"),
    idl("idl-lists-of-lists", "L x[3];", before="typedef sequence<long> L;"),
    idl("idl-defaults", '@default(value=1) @unit(value="m") @default(value=2) long x;'),
    idl(
        "idl-values",
        '@default(value=300) uint8 a; @default(value="(1, 2, 3)") long b[2];',
        before=constants('const long long L = 9223372036854775808; const float F = "x";'),
    ),
)  # fmt: skip
NAMED = {f"{number} {each.key} {each.oracle}": each for number, each in enumerate(EXAMPLES)}


def outcome(here, example, monkeypatch, fault=None):
    """Judge an example, optionally with a fault in the front end; return our reading, too."""
    read, found = judging.read, []
    with monkeypatch.context() as planted:
        change = fault or (lambda read: read)
        planted.setattr(
            judging, "read", lambda *given: found.append(change(read(*given))) or found[-1]
        )
        return here.outcome(example.oracle, f"p/{example.kind}/A"), found[-1]


@pytest.mark.parametrize("name", NAMED)
def test_difference_is_known_by_its_key_and_hides_no_fault(court, name, monkeypatch):
    example = NAMED[name]
    here = court("noetic" if example.is_ros1 else "lyrical", example.files)
    found, ours = outcome(here, example, monkeypatch)
    assert_known(found, example.key)
    is_compared = found.verdict.cases > 1
    with_refusal, _ = outcome(here, example, monkeypatch, refuse)
    if not is_compared and not isinstance(ours, DefinitionError):
        # The oracle refuses the text anyway, so its refusal does not confirm ours.
        assert isinstance(with_refusal.verdict, NotJudged)
        assert example.key in with_refusal.verdict.reason
    else:
        assert isinstance(with_refusal.verdict, Failed)
    for fault in (drop_last, example.fault) if is_compared else ():
        with_fault, _ = outcome(here, example, monkeypatch, fault)
        assert isinstance(with_fault.verdict, Failed), (fault, with_fault.verdict)


def test_every_key_has_an_example_and_is_in_the_errata():
    pairs = sorted((row.key, oracle) for row in KNOWN for oracle in row.oracles.split())
    assert len(pairs) == len(set(pairs))
    assert sorted({(each.key, each.oracle.partition("-")[0]) for each in EXAMPLES}) == pairs
    _, _, page = ERRATA.read_text(encoding="utf-8").partition("\n## Definitions\n")
    listed = re.findall(r"^\| `([a-z0-9-]+)` \|", page, re.MULTILINE)
    assert sorted(listed) == sorted({row.key for row in KNOWN})


# Our message and the words that it is about: those of a good text are no known difference.
WRONG_REFUSALS = (
    ("genmsg", "the value of uint8 must be in 0..254", "255"),
    ("genmsg", "the length of an array must be at least 1, not 0", "2"),
    ("genmsg", "'a' is not a legal name: letters, digits and underscores, no digit first", "a"),
    ("genmsg", "'1' is not a boolean: True, False, 1 or 0", "1"),
    ("genmsg", "the length of an array must be at most 4294967295", "12"),
    ("genmsg", "'A' is not a legal name: letters, digits and underscores, a letter first", "A"),
    ("rosbags", "field 'once' is already declared in line 1", "once"),
    ("rosbags", "the value of uint8 must be in 0..127", "128"),
    ("rosbags", "annotation 'int8' is not supported", "int8"),
    ("rosbags", "the bound of a string must be at least 1, not 3", "3"),
)


@pytest.mark.parametrize(("oracle", "message", "words"), WRONG_REFUSALS)
def test_a_refusal_of_a_good_text_is_no_known_difference(
    court, oracle, message, words, monkeypatch
):
    text = "uint8 A=255\nuint8[2] a\nint8[12] once\nbool ON=1\nstring<=3 s\nuint8 N=128\n"
    text = text if oracle == "rosbags" else text.replace("<=3", "")
    here = court("lyrical" if oracle == "rosbags" else "noetic", {"p/msg/A.msg": text})
    (case,) = here.universe.select(["p/A"])
    at = text.index(words)
    span = Span(source=Source(name=case.source, text=text), start=at, end=at + len(words))
    error = DefinitionError([Diagnostic(message=message, span=span)])
    monkeypatch.setattr(judging, "read", lambda universe, case: error)
    assert isinstance(here.outcome(oracle, "p/A").verdict, Failed)


HASHED = [("rosbags", "int8 X=1\r\nint8 a\r\n"), ("rosidl_parser-4.9", "float64 a -inf\n")]


@pytest.mark.parametrize(("oracle", "text"), HASHED)
def test_a_known_difference_hides_no_wrong_hash(court, oracle, text, monkeypatch):
    here = court("lyrical", {"p/msg/A.msg": text})
    assert isinstance(here.outcome(oracle, "p/A").verdict, KnownDifference)
    monkeypatch.setattr(facts, "type_hash", lambda interface: "RIHS01_0")
    found = here.outcome(oracle, "p/A").verdict
    assert isinstance(found, Failed) and "hash" in found.failures[0]


@pytest.mark.parametrize(
    ("oracle", "needed", "key"),
    [
        ("rosbags", "wstring x\n", "rosbags-wstring"),
        ("rosbags", "int8 x\r\n", "rosbags-crlf"),
        ("rosbags", "char x\n", "rosbags-char-hash"),
        ("rosidl_adapter", 'string[] x ["\\""]\n', "ros2-escaped-quotes"),
        ("rosidl_adapter", "int8[4294967296] x\n", "sizes-of-32-bits"),
        ("rosidl_parser-4.9", "wstring<=4[] x\n", "ros2-wstring-sequences"),
    ],
)
def test_a_known_difference_of_a_needed_definition_is_one(court, oracle, needed, key):
    files = {"p/msg/A.msg": "B b\nint8 last\n", "p/msg/B.msg": needed}
    assert_known(court("lyrical", files).outcome(oracle, "p/A"), key)


@pytest.mark.parametrize("members", ["long x; long x;", "@optional long x;"])
def test_who_does_not_read_idl_does_not_judge_who_needs_what_we_refuse(court, members):
    text = f"module p {{ module msg {{ struct I {{ {members} }}; }}; }};"
    files = {"p/msg/I.idl": text, "p/msg/A.msg": "I i\n", "p/srv/S.srv": "I i\n---\n"}
    here = court("lyrical", files)
    for type_ in ("p/A", "p/S"):
        found = here.outcome("rosidl_adapter", type_).verdict
        assert isinstance(found, NotJudged) and "does not read" in found.reason
    # A mistake of the definition itself is one.
    other = court("lyrical", {**files, "p/msg/A.msg": "I i\nint8 Y\n"})
    assert_passed(other.outcome("rosidl_adapter", "p/A"))


ORDINARY = {
    "float32 LOW = 0\n": "rosbags-floats",
    "string s true story\n": "rosbags-texts",
    "float64 a inf\n": None,
    "float64[] a [inf, nan]\n": None,
    'string<=5[] a ["b", c]\n': None,
    "# structure_needs_at_least_one_member, a wstring and char\nint8[] a []\n": None,
}


@pytest.mark.parametrize("text", ORDINARY)
def test_ordinary_files_raise_no_alarm(court, text):
    here = court("lyrical", {"p/msg/A.msg": text + "uint16 last\n"})
    found = here.outcome("rosbags", "p/A")
    if key := ORDINARY[text]:
        assert_known(found, key)
    else:
        assert_passed(found)
    assert_passed(here.outcome("rosidl_adapter", "p/A"))
    assert not isinstance(here.outcome("rosidl_parser", "p/A").verdict, Failed)
