"""Constants: the bits of floats, and names that do not collide."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.export.constants import _float_bits, named_constants
from firm_hdl.export.systemverilog.package import constants_of as sv_constants
from firm_hdl.export.systemverilog.package import message_package
from firm_hdl.export.tree import tree_of
from firm_hdl.export.vhdl.constants import declarations
from firm_hdl.export.vhdl.package import constants_of as vhdl_constants
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.frontend.workspace import library


@pytest.mark.parametrize(
    ("value", "size", "bits"),
    [
        (1.0, 4, 0x3F80_0000),
        (-2.5, 4, 0xC020_0000),
        (-2.5, 8, 0xC004_0000_0000_0000),
        # Numbers of Python that no float32 has.
        (1e39, 4, 0x7F80_0000),
        (-1e39, 4, 0xFF80_0000),
        (1e39, 8, 0x4807_8287_F49C_4A1D),
        (float("inf"), 4, 0x7F80_0000),
        (float("-inf"), 8, 0xFFF0_0000_0000_0000),
        (-0.0, 4, 0x8000_0000),
    ],
)
def test_bits_are_those_of_ieee_754(value: float, size: int, bits: int) -> None:
    assert _float_bits(value, size) == bits


def test_a_constant_hides_no_word_of_vhdl_and_no_taken_name(tmp_path: Path) -> None:
    text = "int8 Error=1\nint8 NS=2\nint8 MUX=3\nint8 Mine=4\nint8 Free=5\nint8 x\n"
    message = library(tmp_path, {"p/T": text}, "ros1").message("p/T")
    assert [each.name for each in named_constants(message, ["mine"])] == [
        "Error_CONSTANT",
        "NS_CONSTANT",
        "MUX_CONSTANT",
        "Mine_CONSTANT",
        "Free",
    ]


PACKAGES = ("P_T_ROS1_4_PKG", "FIRM_HDL_BUS_4_PKG", "FIRM_HDL_TYPES_PKG")
OF_SYSTEMVERILOG = ("P_T_ROS1_4_SV_PKG", "FIRM_HDL_BUS_4_SV_PKG", "FIRM_HDL_SV_PKG")


def test_a_constant_hides_no_package_that_its_own_uses(tmp_path: Path) -> None:
    names = (*PACKAGES, *OF_SYSTEMVERILOG, "FIRM_HDL_BUS_8_PKG", "T_ARRAY_IDLE", "T_VALUE_BITS")
    text = "".join(f"int8 {name}=1\n" for name in names)
    message = library(tmp_path, {"p/T": f"{text}int8 x\n"}, "ros1").message("p/T")
    plan = build_plan(lay_out(message), bus_bytes=4)
    # Of another bus, and of the other language, are other packages.
    hidden = {*PACKAGES, "T_ARRAY_IDLE", "T_VALUE_BITS"}
    for found, words in (
        (vhdl_constants(tree_of(message, plan).package, plan), hidden),
        (sv_constants(tree_of(message, plan).package, plan), {*hidden, *OF_SYSTEMVERILOG}),
    ):
        assert {each.constant.name for each in found if each.name.endswith("_CONSTANT")} == words
        assert {each.name for each in found} == {
            f"{name}_CONSTANT" if name in words else name for name in names
        }


PIECE = re.compile(r'"((?:[^"]|"")*)"|character\'val\((\d+)\)')
HARD = [
    "",
    "-",
    "--",
    "a---b",
    "a-",
    "-a",
    "-" * 99,
    "a" * 80,
    "a" * 81,
    '"',
    '-"-"--',
    "\1",
    "ö",
    "-ö-",
]


def test_strings_of_vhdl_have_their_bytes_and_no_comment(tmp_path: Path) -> None:
    definition = "".join(f"string S{at}={text}\n" for at, text in enumerate(HARD))
    message = library(tmp_path, {"p/T": f"{definition}int8 x\n"}, "ros1").message("p/T")
    text = "".join(declarations(named_constants(message, ()), []))
    found = re.findall(r"constant S\d+ *: string :=\n +(.*?);\n(?= +constant|\Z)", text, re.DOTALL)
    assert len(found) == len(HARD)
    for expression, want in zip(found, HARD, strict=True):
        pieces = re.split(r" &\n +", expression)
        matches = [PIECE.fullmatch(piece) for piece in pieces]
        parts = [
            bytes([int(match[2])]) if match[2] else match[1].replace('""', '"').encode("ascii")
            for match in matches
            if match is not None
        ]
        assert len(parts) == len(pieces) and b"".join(parts) == want.encode()
        assert not any(b"--" in part or len(part) > 80 for part in parts)
        # A character alone is no string.
        assert len(pieces) > 1 or pieces[0].startswith('"')


STRINGS = {
    "p/T": "string EMPTY=\nstring FULL=" + "a" * 64 + "\nstring MORE=" + "a" * 64 + "b\n"
    'string ODD=a\\01"é\nint8 LOW=-128\nuint8 HIGH=200\nint16 WIDE=-2\nbool YES=True\nint8 x\n'
}


def test_constants_of_systemverilog_have_their_width_sign_and_bytes(tmp_path: Path) -> None:
    message = library(tmp_path, STRINGS, "ros1").message("p/T")
    plan = build_plan(lay_out(message), bus_bytes=8)
    text = message_package(tree_of(message, plan).package, plan)
    for line in (
        "  localparam logic signed [7:0] LOW = 8'sh80;",
        "  localparam logic [7:0] HIGH = 8'hc8;",
        "  localparam logic signed [15:0] WIDE = 16'shfffe;",
        "  localparam logic YES = 1'b1;",
    ):
        assert line in text
    strings = {
        name: [_bytes(each) for each in re.findall(r'"((?:[^"\\]|\\...)*)"', value)]
        for name, value in re.findall(r"localparam (\w+) =\n((?:.*\n)*?.*);\n", text)
    }
    assert strings == {
        "EMPTY": [b""],
        "FULL": [b"a" * 64],
        "MORE": [b"a" * 64, b"b"],
        "ODD": ['a\\01"é'.encode()],
    }


def _bytes(literal: str) -> bytes:
    """Return the bytes of a literal, as IEEE Std 1800-2017, clause 5.9.1 has them."""
    # An escape ends with its third digit, so digits that follow are characters.
    parts = re.findall(r"\\([0-7]{3})|([^\\])", literal)
    assert "".join(f"\\{octal}" if octal else other for octal, other in parts) == literal
    return bytes(int(octal, 8) if octal else ord(other) for octal, other in parts)
