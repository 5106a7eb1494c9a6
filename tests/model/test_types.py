"""The primitives: their sizes, signs and kinds, written down from ROS and OMG IDL."""

from __future__ import annotations

import pytest

from firm_hdl.model import (
    IDL_PRIMITIVES,
    PRIMITIVE_OF,
    PRIMITIVES,
    WIRE_OF,
    Array,
    Sequence,
    String,
    element_of,
    idl_primitives,
    type_text,
)

# Bytes, whether negative numbers exist, kind.
COMMON = {
    "bool": (1, False, "bool"),
    "int8": (1, True, "int"),
    "uint8": (1, False, "int"),
    "int16": (2, True, "int"),
    "uint16": (2, False, "int"),
    "int32": (4, True, "int"),
    "uint32": (4, False, "int"),
    "int64": (8, True, "int"),
    "uint64": (8, False, "int"),
    "float32": (4, True, "float"),
    "float64": (8, True, "float"),
}
UNSIGNED, SIGNED = (1, False, "int"), (1, True, "int")
# genmsg: byte is a deprecated int8, char a deprecated uint8. In C, the char of IDL is signed.
OTHERS = {
    "ros1": {"byte": SIGNED, "char": UNSIGNED},
    "ros2": {"byte": UNSIGNED, "char": UNSIGNED},
    "idl": {
        "byte": UNSIGNED,
        "char": SIGNED,
        "wchar": (2, False, "int"),
        "long double": (16, True, "float"),
    },
}
TABLES = {**PRIMITIVES, "idl": IDL_PRIMITIVES}


@pytest.mark.parametrize("table", OTHERS)
def test_primitives(table):
    found = {name: (p.bytes, p.signed, p.kind) for name, p in TABLES[table].items()}
    assert found == COMMON | OTHERS[table]
    assert all(str(p) == p.name == name for name, p in TABLES[table].items())


def test_size_of_a_wchar_is_that_of_the_distribution():
    assert [idl_primitives(size)["wchar"].bytes for size in (2, 4)] == [2, 4]
    assert {**idl_primitives(4), "wchar": None} == {**idl_primitives(2), "wchar": None}


def test_bits_of_a_circuit():
    bits = {name: primitive.bits for name, primitive in IDL_PRIMITIVES.items()}
    assert bits == {
        "bool": 1, "byte": 8, "char": 8, "wchar": 16, "int8": 8, "uint8": 8, "int16": 16,
        "uint16": 16, "int32": 32, "uint32": 32, "int64": 64, "uint64": 64, "float32": 32,
        "float64": 64, "long double": 128,
    }  # fmt: skip


def test_long_double_alone_has_no_wire_format():
    for table in TABLES.values():
        for name, primitive in table.items():
            assert primitive.has_wire_format is (name != "long double")


def test_primitives_of_leaves_are_found_by_name_and_sign():
    floats = {"float32", "float64"}
    want = {(name, signed and name not in floats) for name, (_, signed, _) in COMMON.items()}
    want |= {("byte", True), ("byte", False), ("char", True), ("char", False)}
    assert set(PRIMITIVE_OF) == want
    for (name, signed), primitive in PRIMITIVE_OF.items():
        assert primitive.name == name
        assert primitive.signed is (signed or name in floats)


def test_every_dialect_has_its_own_wire_format():
    assert WIRE_OF == {"ros1": "ros1", "ros2": "cdr"}


def test_elements_of_arrays_and_sequences():
    text = String(bound=3)
    for kind in (text, Array(element=text, count=2), Sequence(element=text)):
        assert element_of(kind) is text


def test_types_are_spelled_with_another_name_for_the_element():
    text = String(bound=3)
    kinds = (text, Array(element=text, count=2), Sequence(element=text))
    assert [type_text(kind, "T") for kind in (*kinds, Sequence(element=text, bound=7))] == [
        "T", "T[2]", "T[]", "T[<=7]",
    ]  # fmt: skip
