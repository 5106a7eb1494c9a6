"""The packages of primitives are files, and declare the same statuses and primitives as Python."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from firm_hdl.export.primitives import PRIMITIVE_BITS, primitive_name
from firm_hdl.export.systemverilog import types as systemverilog
from firm_hdl.export.vhdl import package as vhdl
from firm_hdl.gateware.signatures import Status
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make

STATUSES = {f"STATUS_{status.name}": status.value for status in Status}


def wrong_in_vhdl(text: str) -> Iterator[str]:
    """Yield the declarations of the VHDL package that differ from Python."""
    constants = re.findall(r'constant (STATUS_\w+) +: .* := x"(..)";', text)
    if {name: int(digits, 16) for name, digits in constants} != STATUSES:
        yield "statuses"
    if re.findall(r'when (STATUS_\w+) => return "(\w+)"', text) != [
        (name, name.removeprefix("STATUS_")) for name in STATUSES
    ]:
        yield "names of statuses"
    for what, form in (
        ("streams", r"type (\w+)_stream_t is record\n +data +: (.*?);"),
        ("items", r"type (\w+)_items_t is array \(natural range <>\) of (.*);"),
    ):
        if dict(re.findall(form, text)) != {name: vhdl.data_type(name) for name in PRIMITIVE_BITS}:
            yield what


def wrong_in_systemverilog(text: str) -> Iterator[str]:
    """Yield the declarations of the SystemVerilog package that differ from Python."""
    constants = re.findall(r"(STATUS_\w+) += 8'h(..)", text)
    if {name: int(digits, 16) for name, digits in constants} != STATUSES:
        yield "statuses"
    form = r"typedef logic( signed)?(?: \[(\d+):0\])? (\w+)_data_t;"
    declared = {name: (int(high or 0) + 1, sign) for sign, high, name in re.findall(form, text)}
    if declared != {
        name: (bits, " signed" if name.startswith("int") else "")
        for name, bits in PRIMITIVE_BITS.items()
    }:
        yield "types"
    if re.findall(r"(\w+)_data_t +data;\n", text) != list(PRIMITIVE_BITS):
        yield "streams"


def test_packages_declare_the_statuses_and_primitives_of_python():
    assert list(wrong_in_vhdl(vhdl.types_package())) == []
    assert list(wrong_in_systemverilog(systemverilog.types_package())) == []


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ("8'h06", "8'h07", "statuses"),
        ("logic [15:0] uint16_data_t", "logic signed [15:0] uint16_data_t", "types"),
        ("int8_data_t data", "uint8_data_t data", "streams"),
    ],
)
def test_other_declarations_in_systemverilog_are_seen(old, new, what):
    text = systemverilog.types_package()
    assert old in text
    assert list(wrong_in_systemverilog(text.replace(old, new, 1))) == [what]


# `byte` and `char` are integers of 8 bits; in ROS 1, `byte` is a signed one.
@pytest.mark.parametrize(
    ("dialect", "type_", "expected"),
    [
        ("ros1", "byte", "int8"),
        ("ros2", "byte", "uint8"),
        ("ros1", "char", "uint8"),
        ("ros2", "char", "uint8"),
        ("ros2", "bool", "bool"),
        ("ros2", "int16", "int16"),
        ("ros2", "uint16", "uint16"),
        ("ros2", "int64", "int64"),
        ("ros2", "float32", "float32"),
        ("ros2", "float64", "float64"),
    ],
)
def test_a_leaf_has_the_primitive_of_its_size_and_sign(dialect, type_, expected):
    for field in (type_, f"{type_}[3]"):
        (leaf,) = build_plan(lay_out(make(dialect, {"a": field}))).leaves
        assert primitive_name(leaf) == expected
