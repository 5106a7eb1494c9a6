"""Names and texts of recordings: which topics have a definition, and which one counts."""

from __future__ import annotations

import pytest
from rosbags.rosbag1 import Writer

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import RecordingOrigin, open_library
from tests.frontend.recordings import record

LINE = "=" * 80


def refused(path):
    with pytest.raises(DefinitionError) as error:
        RecordingOrigin(path)
    return str(error.value)


def record_in_ros1(path, *topics):
    """Record topics of ROS 1 with given definitions; their md5 sums are wrong."""
    with Writer(path) as writer:
        for number, (name, text) in enumerate(topics):
            writer.add_connection(f"/t{number}", name, msgdef=text, md5sum="0" * 32)
    return path


@pytest.mark.parametrize(
    ("name", "is_legal"),
    [
        ("p/A", True),
        ("p/msg/A", True),
        ("p/srv/A_Request", True),
        ("p/action/A_Goal", True),
        ("p/idl/A", False),
        ("p//A", False),
        ("/A", False),
        ("p/", False),
        ("/msg/A", False),
        ("p/msg/", False),
        ("A", False),
        ("p/msg/A/B", False),
    ],
)
def test_names_of_types_have_a_package_and_at_most_one_of_three_kinds(tmp_path, name, is_legal):
    path = record(tmp_path / "r", name, "int8 a\n", ("q/msg/B", "int8 b\n"))
    want = name if name.count("/") == 2 else name.replace("/", "/msg/")
    assert open_library(bags=[path]).interfaces() == [*([want] if is_legal else []), "q/msg/B"]


def test_constants_of_an_included_section_are_known(tmp_path):
    a = """#include "p/msg/B.idl"
    module p { module msg { struct A { p::msg::B b; Many c; long d[B_Constants::N]; }; }; };"""
    b = """module p { module msg { module B_Constants { const long N = 3; };
    typedef sequence<long, 7> Many; struct B { long x; }; }; };"""
    text = "".join(f"{LINE}\nIDL: p/msg/{name}\n{body}\n" for name, body in (("A", a), ("B", b)))
    ours = open_library(bags=[record(tmp_path / "r", "p/msg/A", text)])
    assert [str(f.type) for f in ours.message("p/A").fields] == [
        "p/msg/B", "int32[<=7]", "int32[3]"
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "text", "parts"),
    [
        ("p/srv/S", "int8 a\n---\nint8 b\n", ["p/srv/S_Request", "p/srv/S_Response"]),
        ("p/srv/S_Request", "int8 a\n", ["p/srv/S_Request"]),
        ("p/srv/S_Request", "int8 a # ---\n", ["p/srv/S_Request"]),
        ("p/action/A_Goal", "int8 a\n", ["p/action/A_Goal"]),
    ],
)
def test_separators_tell_services_from_their_messages(tmp_path, name, text, parts):
    ours = open_library("humble", bags=[record(tmp_path / "r", name, text)])
    assert [message.name for message in ours.interface(name).messages] == parts


def test_bags_are_known_by_their_ending_in_any_case(tmp_path):
    path = record_in_ros1(tmp_path / "r.bag", ("p/msg/A", "int8 a\n"))
    path = path.rename(tmp_path / "R.BAG")
    assert RecordingOrigin(path).dialect == "ros1"
    folder = record(tmp_path / "folder.bag", "p/msg/A", "int8 a\n")
    assert RecordingOrigin(folder).dialect == "ros2"
    assert open_library(bags=[folder]).names() == ["p/msg/A"]


def test_definitions_in_full_names_keep_words_that_only_look_so(tmp_path):
    text = "  q/msg/Pt p # of q/msg/Pt\nstring q='q/msg/Pt'\n# q/msg/Pt\n"
    path = record(tmp_path / "r", "p/msg/A", f"{text}{LINE}\nMSG: q/Pt\nint8 x\n")
    assert open_library(bags=[path]).source("p/A").text == (
        "q/Pt p # of q/msg/Pt\nstring q='q/msg/Pt'\n# q/msg/Pt\n"
    )


def test_folders_in_a_recordings_folder_are_not_read(tmp_path):
    path = record(tmp_path / "r", "p/msg/A", "int8 a\n")
    (path / "metadata").mkdir()
    assert open_library(bags=[path]).names() == ["p/msg/A"]


def test_separators_have_three_signs_or_more_and_headings_may_be_of_services(tmp_path):
    text = "B b\n===\nMSG: p/B\nint8 x\n=====\nSRV: p/srv/S\nint8 y\n---\nint8 z\n"
    ours = open_library("humble", bags=[record(tmp_path / "r", "p/msg/A", text)])
    assert ours.interfaces() == ["p/msg/A", "p/msg/B", "p/srv/S"]
    assert [len(part.fields) for part in ours.interface("p/S").messages] == [1, 1]
    text = text.replace("===\nMSG", "==\nMSG")
    ours = open_library(bags=[record(tmp_path / "two", "p/msg/A", text)])
    assert ours.interfaces() == ["p/msg/A", "p/srv/S"]
