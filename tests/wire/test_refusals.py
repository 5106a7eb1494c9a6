# amaranth: UnusedElaboratable=no
"""Types that no wire has are read, but refused with their position by all users of a wire."""

from __future__ import annotations

import pytest

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.errors import DefinitionError
from firm_hdl.gateware.record import RecordReader
from firm_hdl.model import IDL_PRIMITIVES, PRIMITIVE_OF, PRIMITIVES, Array, Field, Message, Sequence
from firm_hdl.wire import lay_out, layout, refusals
from tests.frontend.workspace import errors_of, make_files
from tests.steps import calls_at_most

FILES = {
    "p/msg/Wide.idl": (
        "module p { module msg {\n"
        "  typedef long double Real;\n"
        "  module Wide_Constants { const long double X = 1.5; };\n"
        "  struct Wide {\n"
        "    long double one;\n"
        "    Real two[3];\n"
        "    double fine;\n"
        "    sequence<long double, 4> three;\n"
        "  };\n"
        "}; };\n"
    ),
    "p/msg/Constant.idl": (
        "module p { module msg {\n"
        "  module Constant_Constants { const long double X = 1.5; };\n"
        "  struct Constant { double a; };\n"
        "}; };\n"
    ),
    "p/msg/Outer.msg": "Middle[] many\nint8 x\nWide again\n",
    "p/msg/Middle.msg": "Wide[<=3] wide\n",
}


def sentence(field: str, owner: str = "p/msg/Wide") -> str:
    return (
        f"field '{field}' of {owner} is of type 'long double': systems do not agree about its "
        "bytes, so it cannot be put on a wire"
    )


@pytest.fixture
def load(tmp_path):
    make_files(tmp_path, FILES)
    return lambda name: load_message(name, distro="lyrical", paths=[tmp_path])


WHOLE = f"""\
p/msg/Wide.idl:5:17: error: {sentence("one")}
    long double one;
                ^^^
p/msg/Wide.idl:6:10: error: {sentence("two")}
    Real two[3];
         ^^^
p/msg/Wide.idl:8:30: error: {sentence("three")}
    sequence<long double, 4> three;
                             ^^^^^"""


@pytest.mark.parametrize("wire", [None, "cdr", "ros1"])
@pytest.mark.parametrize("name", ["Wide", "Middle", "Outer"])
def test_layout_refuses_each_field_once_with_its_position(load, tmp_path, wire, name):
    with pytest.raises(DefinitionError) as error:
        lay_out(load(f"p/{name}"), wire)
    assert errors_of(error.value, tmp_path) == WHOLE


def test_a_layout_that_took_it_would_be_noticed(load, monkeypatch):
    # Without the rule, there is a layout of 16 bytes: no other check refuses it.
    monkeypatch.setattr(layout, "refusals", lambda message: [])
    assert lay_out(load("p/Wide")).least_bytes >= 16 * 4


@pytest.mark.parametrize("make", [Deserializer, Serializer, RecordReader])
def test_converters_refuse_it(load, tmp_path, make):
    with pytest.raises(DefinitionError) as error:
        make(load("p/Outer"))
    assert errors_of(error.value, tmp_path) == WHOLE


def test_constants_are_never_on_a_wire(load):
    message = load("p/Constant")
    (constant,) = message.constants
    assert (str(constant.type), constant.value) == ("long double", 1.5)
    assert refusals(message) == []
    assert lay_out(message).least_bytes == 12


def test_a_message_without_a_text_is_refused_by_its_names():
    kinds = [IDL_PRIMITIVES["long double"]]
    kinds += [Array(element=kinds[0], count=2), Sequence(element=kinds[0])]
    for kind in kinds:
        message = Message(name="p/msg/T", dialect="ros2", fields=(Field(name="f", type=kind),))
        (found,) = refusals(message)
        assert str(found) == f"error: {sentence('f', 'p/msg/T')}"


def test_fields_are_refused_in_the_order_in_which_a_reader_meets_them():
    def message(name, *fields):
        parts = tuple(Field(name=each, type=kind) for each, kind in fields)
        return Message(name=f"p/msg/{name}", dialect="ros2", fields=parts)

    real = IDL_PRIMITIVES["long double"]
    first, second = message("First", ("a", real)), message("Second", ("b", real))
    outer = message("Outer", ("x", second), ("c", real), ("y", first), ("z", second))
    assert [found.message for found in refusals(outer)] == [
        sentence(name, f"p/msg/{owner}")
        for name, owner in (("c", "Outer"), ("b", "Second"), ("a", "First"))
    ]


def test_it_is_the_only_primitive_that_no_wire_has():
    tables = [*PRIMITIVES.values(), IDL_PRIMITIVES]
    refused = {item.name for table in tables for item in table.values() if not item.has_wire_format}
    assert refused == {"long double"}
    assert not {name for name, _ in PRIMITIVE_OF} & refused


def test_deep_nesting_needs_neither_stack_nor_time():
    kind = IDL_PRIMITIVES["long double"]
    for level in range(3000):
        fields = tuple(Field(name=name, type=kind) for name in "ab")
        kind = Message(name=f"p/msg/L{level}", dialect="ros2", fields=fields)
    with calls_at_most(200_000):
        assert [found.message for found in refusals(kind)] == [
            sentence(name, "p/msg/L0") for name in "ab"
        ]
