"""What a user is told of a recording that cannot be read, or that has no definitions of use."""

from __future__ import annotations

import errno
import os

import pytest
from rosbags.rosbag1 import ReaderError as ReaderError1
from rosbags.rosbag2 import ReaderError as ReaderError2

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import RecordingOrigin, open_library
from firm_hdl.frontend.recordings import use_recording
from tests.frontend.recordings import make_recording, record, record_in_idl

LINE = "=" * 80
DAMAGED = "it is damaged"


def wrapped(error, context):
    """Return an error that was raised while another one was handled, as rosbags does."""
    error.__context__ = context
    return error


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    return str(make_recording(tmp_path_factory.mktemp("recordings"), "mcap"))


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (OSError(errno.EINVAL, "Invalid argument"), DAMAGED),
        (OSError(errno.EIO, "Input/output error"), "Input/output error"),
        (OSError("no number"), "no number"),
        (ReaderError1("File magic is invalid."), "File magic is invalid."),
        (ReaderError2("Time is up."), "Time is up."),
        (wrapped(ReaderError2("'x'"), TypeError()), DAMAGED),
        (wrapped(ReaderError2("'x'"), AttributeError()), DAMAGED),
        (wrapped(ReaderError2("'x'"), KeyError("x")), DAMAGED),
        (wrapped(ReaderError1("'x'"), UnicodeDecodeError("utf-8", b"", 0, 1, "x")), DAMAGED),
        (wrapped(ReaderError2("No file."), FileNotFoundError()), "No file."),
        (KeyError("ros1msg"), "rosbags does not support 'ros1msg'"),
        (KeyError(), "rosbags does not support "),
        (MemoryError(), "it needs more memory than is available"),
        (RecursionError("deep"), DAMAGED),
        (ValueError("bad"), DAMAGED),
        *(
            (
                KeyError(language),
                f"its definitions are in '{language}', and only ros2msg and ros2idl are read",
            )
            for language in ("omgidl", "protobuf", "flatbuffer", "jsonschema")
        ),
    ],
    ids=repr,
)
def test_every_failure_of_a_reader_is_one_line_with_a_reason(recording, error, reason):
    def fail(reader):
        raise error

    with pytest.raises(DefinitionError) as caught:
        use_recording(recording, fail)
    assert str(caught.value) == (f"error: '{recording}' cannot be read as a recording: {reason}")


def test_what_is_read_is_the_result(recording):
    assert use_recording(recording, lambda reader: reader.message_count) == 1


def test_a_file_in_a_folder_that_cannot_be_read_is_named(tmp_path):
    path = make_recording(tmp_path, "db3")
    os.mkfifo(path / "more.db3")
    with pytest.raises(DefinitionError) as caught:
        RecordingOrigin(path)
    assert str(caught.value) == (
        f"error: '{path / 'more.db3'}' cannot be read: it is a FIFO, not a regular file"
    )


def refused(path):
    with pytest.raises(DefinitionError) as caught:
        RecordingOrigin(path)
    return str(caught.value)


DDS = "struct One { long x; }; struct Two { long x; };"


@pytest.mark.parametrize("order", [1, -1])
def test_the_first_of_the_types_that_no_ros_tool_wrote_is_named(tmp_path, order):
    names = ["q/msg/A", "p/msg/B", "p/msg/C"][::order]
    path = record_in_idl(tmp_path / "dds", names[0], DDS, *((name, DDS) for name in names[1:]))
    assert refused(path).startswith(f"error: '{path}' defines 'p/msg/B' in 'omgidl', ")
    names = ["plain", "a/b/c/d", "q/idl/A"][::order]
    path = record(tmp_path / "odd", names[0], "", *((name, "") for name in names[1:]))
    assert "has a topic of type 'a/b/c/d', which is not a ROS name" in refused(path)


@pytest.mark.parametrize("order", [1, -1])
def test_definitions_in_another_language_are_of_more_weight_than_missing_ones(tmp_path, order):
    # With --path or --distro, this recording is of no more use.
    (one, text), other = [("p/msg/A", DDS), ("p/msg/B", "")][::order]
    path = record_in_idl(tmp_path / "r", one, text, other)
    assert "defines 'p/msg/A' in 'omgidl'" in refused(path)


def test_types_in_another_language_are_refused_among_others(tmp_path):
    path = record_in_idl(
        tmp_path / "r",
        "p/msg/A",
        DDS,
        ("p/msg/B", f"{LINE}\nIDL: p/msg/B\nstruct B {{ long b; }};"),
    )
    ours = open_library(bags=[path])
    assert ours.names() == ["p/msg/B"]
    with pytest.raises(DefinitionError) as caught:
        ours.message("p/A")
    assert str(caught.value) == (
        f"error: '{path}' defines 'p/msg/A' in 'omgidl', and only ros2msg and ros2idl are read"
    )


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
        (f"p/msg/{name}", ()) for name in "ABC"
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
