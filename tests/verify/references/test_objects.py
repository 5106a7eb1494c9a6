"""Definitions that libraries get as texts, and conversions to and from their objects."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from firm_hdl.cases.values import bits_of
from firm_hdl.model import Field, Message
from firm_hdl.verify.references.client import UnsupportedError
from firm_hdl.verify.references.objects import (
    ObjectCodec,
    definition_text,
    full_text,
    plainly_named,
    refuse_wide,
)
from tests.frontend.workspace import make_files

LINE = "=" * 80


def test_the_text_of_a_definition_has_those_that_it_needs(make_message):
    message = make_message(
        "string<=4[2] s\nB[<=3] b\nE e\n", B="float32 x\nC c\nC[] more\n", C="int8 y 3\n", E=""
    )
    assert definition_text(message) == "string<=4[2] s\np/B[<=3] b\np/E e\n"
    head, *others = full_text(message).split(f"{LINE}\n")
    assert head == "string<=4[2] s\np/B[<=3] b\np/E e\n"
    assert sorted(others) == [
        "MSG: p/B\nfloat32 x\np/C c\np/C[] more\n",
        "MSG: p/C\nint8 y\n",
        "MSG: p/E\n\n",
    ]
    assert full_text(make_message("")) == "\n"


def test_messages_of_services_get_different_names_without_underscores(make_message, tmp_path):
    from firm_hdl.frontend import Library

    files = {"p/srv/Ab.srv": "int8 a\n---\nint8 b\n", "p/srv/A.srv": "int8 a\n---\nQ q\n"}
    root = make_files(tmp_path, {**files, "p/msg/Q.msg": "int8 x\n"})
    service = Library("lyrical", [root]).interface("p/srv/Ab")
    event = next(each for each in service.messages if each.name.endswith("_Event"))
    named = plainly_named(event)
    names = [named.name, *(kind.name for kind in named.children)]
    assert len({*names}) == len(names) >= 3
    assert all("_" not in name.rpartition("/")[2] for name in names)
    # Names that are plain already stay, and so do all fields.
    assert "service_msgs/msg/ServiceEventInfo" in names
    assert [item.name for item in named.fields] == [item.name for item in event.fields]
    plain = make_message("B b\n", B="int8 x\n")
    assert plainly_named(plain) == plain
    # Names that differ only in the place of the `_` stay different.
    parts = [
        Message(name=f"p/action/{name}", dialect="ros2", fields=()) for name in ("A_BC", "AB_C")
    ]
    fields = tuple(Field(name=f"f{n}", type=part) for n, part in enumerate(parts))
    whole = plainly_named(replace(plain, fields=fields))
    assert len({item.type.name for item in whole.fields}) == 2


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("wstring w\n", "it has no wstring"),
        ("uint8 a\nwstring<=2[3] w\n", "it has no wstring"),
        ("uint8 a\nB[] b\n", "it has no wstring"),
        ("C c\n", "it is not asked about wchar"),
    ],
)
def test_wide_text_is_refused_wherever_it_is(make_message, text, why):
    others = {"B": "wstring[] w\n", "C": "module p { module msg { struct C { wchar w[2]; }; }; };"}
    with pytest.raises(UnsupportedError, match=f"^{why}$"):
        refuse_wide(make_message(text, **others), "it")
    refuse_wide(make_message("string s\nuint8[] a\n"), "it")


class Plain(ObjectCodec):
    """A library that keeps objects as they are, and counts what it makes."""

    def __init__(self, message):
        super().__init__(message)
        self.kept = None

    def write(self, value):
        self.kept = value
        return b"\1"

    def read(self, packet):
        return self.kept

    def made(self, kind, members):
        return SimpleNamespace(kind=kind.name, **members)


TEXT = "bool t\nfloat32 f\nfloat64[2] d\nstring s\nstring[] l\nB b\nB[] many\nint16[] i\n"
VALUE = {
    "t": True,
    "f": bits_of(-1.5, 4),
    "d": [bits_of(0.1, 8), 1 << 63],
    "s": b"\xc3\xa9\xff",
    "l": [b"a", b""],
    "b": {"x": 1},
    "many": [{"x": 2}, {"x": 3}],
    "i": [-1, 300],
}


def test_values_become_objects_and_come_back(make_message):
    codec = Plain(make_message(TEXT, B="uint8 x\n"))
    assert codec.encode(VALUE) == b"\1"
    made = codec.kept
    assert (made.kind, made.t, made.f, made.d) == ("p/msg/A", True, -1.5, [0.1, -0.0])
    assert (made.s, made.l, made.i) == ("é\udcff", ["a", ""], [-1, 300])
    assert [(each.kind, each.x) for each in (made.b, *made.many)] == [
        ("p/msg/B", 1),
        ("p/msg/B", 2),
        ("p/msg/B", 3),
    ]
    assert codec.decode(b"") == VALUE
    # A library may give a number for a bool, and an integer for a float.
    made.t, made.f = 0, 2
    found = codec.decode(b"")
    assert found["t"] is False and found["f"] == bits_of(2.0, 4)
