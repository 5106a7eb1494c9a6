"""Each deliberate difference happens, is known by its key, and stands in docs/errata.md."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.verify.ts1.known import KNOWN
from firm_hdl.verify.verdict import Failed
from tests.verify.judged import assert_known

ERRATA = Path(__file__).parents[3] / "docs" / "errata.md"

EXAMPLES = {
    "rosbags-lenient": ("lyrical", "rosbags", "int32 Bad\n"),
    "rosbags-crlf": ("lyrical", "rosbags", "int32 x\r\n"),
    "rosbags-wstring": ("lyrical", "rosbags", "wstring x\n"),
    "rosbags-constant-names": ("noetic", "rosbags", "uint8 low=1\n"),
    "rosbags-constant-texts": ("noetic", "rosbags", 'string NAME="x"\n'),
    "rosbags-constant-bool": ("noetic", "rosbags", "bool ON=1\n"),
    "rosbags-octal": ("noetic", "rosbags", "int8 N=010\n"),
    "rosbags-char-hash": ("lyrical", "rosbags", "char c\n"),
    "ros1-constant-names": ("noetic", "genmsg", "int8 a-b=1\n"),
    "ros1-bool-literals": ("noetic", "genmsg", "bool ON=[1]\n"),
    "ros1-empty-arrays": ("noetic", "genmsg", "int8[0] x\n"),
    "ros1-indented-texts": ("noetic", "genmsg", "  string X=1\n"),
    "ros1-64-bit-limits": ("noetic", "genmsg", "int64 X=9223372036854775808\n"),
    "ascii-only": ("noetic", "genmsg", "int8 größe\n"),
    "ros2-escaped-quotes": ("lyrical", "rosidl_adapter", 'string[] x ["\\""]\n'),
    "sizes-of-32-bits": ("lyrical", "rosidl_adapter", "int8[4294967296] x\n"),
    "idl-names": (
        "lyrical",
        "rosidl_parser",
        "module q { module idl { struct A { long x; }; }; };",
    ),
    "idl-file-names": (
        "lyrical",
        "rosidl_parser",
        "module p { module msg { struct B { long x; }; }; };",
    ),
    "idl-bounds-by-name": (
        "lyrical",
        "rosidl_parser",
        "module p { module msg { module A_Constants { const long N = 3; }; "
        "struct A { sequence<wstring<N>, 2> x; }; }; };",
    ),
    "idl-whole-numbers": (
        "lyrical",
        "rosidl_parser",
        "module p { module msg { module A_Constants { const long double N = 3; }; "
        'struct A { @default(value=3) double x; @default(value="(1, 2)") double y[2]; }; }; };',
    ),
    "idl-unsupported": (
        "lyrical",
        "rosidl_parser",
        "module p { module msg { struct A { @optional long x; }; }; };",
    ),
    "ros2-comment-blanks": ("lyrical", "rosidl_adapter", "# Head. \n\nint8 x\n"),
}


@pytest.mark.parametrize("key", EXAMPLES)
def test_difference_is_known_by_its_key(court, key):
    distro, oracle, text = EXAMPLES[key]
    file = "A.idl" if text.startswith("module") else "A.msg"
    outcome = court(distro, {f"p/msg/{file}": text}).outcome(oracle, "p/A")
    assert_known(outcome, key)


def test_every_key_has_an_example_and_stands_in_the_errata():
    keys = [entry.key for entry in KNOWN]
    assert sorted(keys) == sorted(EXAMPLES)
    _, _, page = ERRATA.read_text(encoding="utf-8").partition("\n## Definitions\n")
    listed = re.findall(r"^\| `([a-z0-9-]+)` \|", page, re.MULTILINE)
    assert sorted(listed) == sorted(keys)


@pytest.mark.parametrize(
    ("distro", "oracle", "text"),
    [
        # One mistake that is known does not hide another.
        ("noetic", "genmsg", "int8 a-b=1\nint8 A=1000\n"),
        ("noetic", "genmsg", "int8[0] x\nint8 x-y\n"),
        ("lyrical", "rosidl_adapter", "int8[4294967296] x\nint8 Bad\n"),
    ],
)
def test_a_known_difference_hides_no_other(court, distro, oracle, text, monkeypatch):
    here = court(distro, {"p/msg/A.msg": text})
    from firm_hdl.verify.ts1.judge import compare, read
    from firm_hdl.verify.ts1.oracle import Accepted

    case = here.universe.select(["p/A"])[0]
    outcome = compare(here.oracle(oracle), case, read(here.universe, case), Accepted({}))
    assert isinstance(outcome.verdict, Failed)
