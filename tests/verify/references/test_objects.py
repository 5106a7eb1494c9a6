"""Definitions that libraries get as texts, and conversions to and from their objects."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.model import Field, Message
from firm_hdl.verify.references.objects import (
    definition_text,
    full_text,
    plainly_named,
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
