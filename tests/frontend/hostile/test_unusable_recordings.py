"""What a user is told of a recording that cannot be read, or that has no definitions of use."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import RecordingOrigin, open_library
from tests.frontend.recordings import record, record_in_idl

LINE = "=" * 80


def refused(path):
    with pytest.raises(DefinitionError) as caught:
        RecordingOrigin(path)
    return str(caught.value)


DDS = "struct One { long x; }; struct Two { long x; };"


@pytest.mark.parametrize("order", [1, -1])
def test_a_type_in_another_language_has_the_definition_of_another_topic(tmp_path, order):
    b = "module p { module msg { struct B { p::msg::A a; }; }; };"
    a = "module p { module msg { struct A { long x; }; }; };"
    text = "".join(f"{LINE}\nIDL: p/msg/{name}\n{each}\n" for name, each in (("B", b), ("A", a)))
    topics = [("p/msg/A", DDS), ("p/msg/B", text)][::order]
    ours = open_library(bags=[record_in_idl(tmp_path / "r", *topics[0], topics[1])])
    assert ours.names() == ["p/msg/A", "p/msg/B"]
    assert [item.name for item in ours.message("p/A").fields] == ["x"]


def test_sections_of_blanks_count_unless_they_are_before_the_first_heading(tmp_path):
    b = f"{LINE}\nMSG: p/B\n \n"
    ours = open_library(bags=[record(tmp_path / "msg", "p/msg/A", f" \n{b}{LINE}\nMSG: p/C\n\n")])
    assert [(name, ours.message(name).fields) for name in ours.names()] == [
        ("p/msg/B", ()),
        ("p/msg/C", ()),
    ]
    a = f"{LINE}\nIDL: p/msg/A\nmodule p {{ module msg {{ struct A {{ long a; }}; }}; }};\n"
    text = f" \n\t\n{a}{LINE}\nIDL: p/msg/B\n \n"
    ours = open_library(bags=[record_in_idl(tmp_path / "idl", "p/msg/A", text)])
    assert ours.names() == ["p/msg/A", "p/msg/B"]
    assert ours.message("p/A").fields[0].name == "a"
    with pytest.raises(DefinitionError, match="the file ends here"):
        ours.message("p/B")


def test_indentation_of_comments_is_kept(tmp_path):
    # It is what joins a comment to that of the line above.
    text = "  int8 a # one\n      # two\n\t# three\n\n\tint8 b\n"
    ours = open_library(bags=[record(tmp_path / "r", "p/msg/A", text)])
    assert ours.source("p/A").text == "int8 a # one\n      # two\n\t# three\n\nint8 b\n"
    assert ours.message("p/A").fields[0].comment == "one\ntwo\nthree"
