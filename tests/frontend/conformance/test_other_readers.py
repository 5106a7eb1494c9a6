"""Spellings of definitions that ROS's own tools and other readers of recordings accept."""

from __future__ import annotations

import sqlite3

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import get_types_from_idl

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import open_library
from tests.frontend.recordings import make_recording


def recorded(path, text, name="p/msg/A"):
    with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        writer.add_connection("/t", name, msgdef=text, rihs01="RIHS01_" + "0" * 64)
    return path


LINE = "=" * 80


@pytest.mark.parametrize(
    "text",
    [
        f"q/msg/Pt p\nq/msg/Pt[] more\n{LINE}\nMSG: q/msg/Pt\nint8 x\n",
        f"  q/Pt p\n\tq/Pt[] more\n  # a comment\n{LINE}\nMSG: q/Pt\n  int8 x\n",
        f"  q/msg/Pt p\n\tq/msg/Pt[] more\n{LINE}\nMSG: q/msg/Pt\n  int8 x\n",
    ],
    ids=["full names", "indented lines", "both"],
)
def test_full_names_and_indented_lines_are_read_in_recordings(tmp_path, text):
    ours = open_library(bags=[recorded(tmp_path / "r", text)])
    assert [str(f.type) for f in ours.message("p/A").fields] == ["q/msg/Pt", "q/msg/Pt[]"]
    assert ours.message("q/Pt").fields[0].name == "x"


STRUCTS = "module p { module msg { struct B { long b; }; struct A { B b; }; }; };\n"


def test_schemas_of_other_tools_are_named(tmp_path):
    folder = make_recording(tmp_path, "db3")
    (file,) = folder.glob("*.db3")
    database = sqlite3.connect(file)
    database.execute("UPDATE message_definitions SET encoding = 'omgidl'")
    database.commit()
    database.close()
    with pytest.raises(DefinitionError, match="in 'omgidl', and only ros2msg and ros2idl are read"):
        open_library(bags=[file])
    path = recorded(tmp_path / "r", f"{'=' * 80}\nIDL: p/msg/A\n{STRUCTS}")
    for each in path.glob("*.mcap"):
        # The format is recognised by the heading, so it is removed.
        head = f"{'=' * 80}\nIDL: p/msg/A\n".encode()
        each.write_bytes(each.read_bytes().replace(head, b" " * len(head)))
    with pytest.raises(
        DefinitionError, match="'p/msg/A', but not its definition: it is in 'omgidl'"
    ):
        open_library(bags=[path])


def test_scopes_of_idl_in_the_name_of_a_topics_type_are_those_of_omgidl(tmp_path):
    (path,) = recorded(tmp_path / "r", "struct W { long b; };", "p/msg//Long").glob("*.mcap")
    data = path.read_bytes().replace(b"p/msg//Long", b"p::msg::Lon")
    path.write_bytes(data.replace(b"ros2msg", b"ros2idl"))
    message = "'p::msg::Lon', but not its definition: it is in 'omgidl', and only ros2msg"
    with pytest.raises(DefinitionError, match=message):
        open_library(bags=[path])
    other = recorded(tmp_path / "other", "int8 a\n")
    with pytest.raises(DefinitionError, match=message):
        open_library(bags=[other, path]).message("p/Lon")
    with pytest.raises(DefinitionError, match="package 'q' is not found"):
        open_library(bags=[other]).message("q/Lon")


SEVERAL = """\
module q { module msg { typedef long T;
  @verbatim(language="comment", text="struct X { }; of q")
  struct C { T t; }; }; };
module p { module msg {
  module A_Constants { const long N = 3; };
  struct B { long b[A_Constants::N]; };  // struct D { long d; };
  @verbatim(language="comment", text="of A")
  struct A { B b; sequence<B> bs; p::msg::B more[2]; q::msg::C c; long B_last; };
}; };
"""


def test_a_section_in_idl_may_declare_several_messages_in_recordings(tmp_path):
    heading = f"{'=' * 80}\nIDL: p/msg/A\n"
    ours = open_library(bags=[recorded(tmp_path / "r", heading + SEVERAL)])
    a = ours.message("p/A")
    assert [(f.name, str(f.type)) for f in a.fields] == [
        ("b", "p/msg/B"), ("bs", "p/msg/B[]"), ("more", "p/msg/B[2]"), ("c", "q/msg/C"),
        ("B_last", "int32"),
    ]  # fmt: skip
    assert (a.comment, [c.name for c in a.constants]) == ("of A", ["N"])
    assert ours.message("q/C").comment == "struct X { }; of q"
    assert [str(f.type) for f in ours.message("p/B").fields] == ["int32[3]"]
    assert [str(name) for name in ours.names()] == ["p/msg/A", "p/msg/B", "q/msg/C"]
    # The reader of rosbags gives the same result.
    theirs = get_types_from_idl(SEVERAL)
    assert {name: len(fields) for name, (_, fields) in theirs.items() if fields} == {
        str(name): len(ours.message(str(name)).fields) for name in ours.names()
    }


def test_mistakes_in_one_of_several_messages_are_shown_where_they_are(tmp_path):
    heading = f"{'=' * 80}\nIDL: p/msg/A\n"
    text = SEVERAL.replace("long B_last", "lang B_last")
    ours = open_library(bags=[recorded(tmp_path / "r", heading + text)])
    with pytest.raises(DefinitionError, match=r"p/msg/A\.idl:8:\d+: error: .*lang"):
        ours.message("p/A")
    assert len(ours.message("p/B").fields) == 1


@pytest.mark.parametrize(
    "text",
    [
        STRUCTS.replace("struct A", "struct C"),
        "module p { struct B { long b; }; struct A { long a; }; };",
        "struct B { long b; }; struct A { long a; };",
        "module p { struct B { long b; }; module msg { struct A { long a; }; }; };",
        "module p { module msg { struct B_Request { long b; }; struct A { long a; }; }; };",
    ],
)
def test_several_structs_that_are_no_messages_of_ros_are_one_message_per_file(tmp_path, text):
    heading = f"{'=' * 80}\nIDL: p/msg/A\n"
    ours = open_library(bags=[recorded(tmp_path / "r", heading + text)])
    with pytest.raises(DefinitionError):
        ours.message("p/A")
