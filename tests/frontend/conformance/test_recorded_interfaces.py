"""Services, actions and types without definitions in recordings; what is not usable is named."""

from __future__ import annotations

import pytest

from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import RecordingOrigin, open_library, recordings
from tests.frontend.recordings import make_old_db3
from tests.frontend.workspace import make_files
from tests.recordings.files import Channel, write_bag, write_db3, write_mcap

LINE = "=" * 80
ADD = "int64 a\nint64 b\n---\nint64 sum\n"
TURN = "float32 theta\n---\nfloat32 delta\n---\nfloat32 remaining\n"
STRING = Channel()


def fields(library, name):
    return [(field.name, str(field.type)) for field in library.message(name).fields]


def heading(kind, name, text):
    return f"{LINE}\n{kind}: {name}\n{text}"


@pytest.mark.parametrize("first", ["", " \n\n", "# from p/msg/Text\n"])
def test_nothing_before_the_first_heading_is_no_definition(tmp_path, first):
    text = first + heading("MSG", "p/msg/Text", "string data\n")
    ours = open_library(
        bags=[write_mcap(tmp_path / "x.mcap", Channel(type="p/msg/Text", text=text))]
    )
    assert fields(ours, "p/msg/Text") == [("data", "string")]


def test_a_text_of_other_types_alone_does_not_define_its_own(tmp_path):
    text = heading("MSG", "p/msg/B", "int8 x\n")
    path = write_mcap(tmp_path / "x.mcap", Channel(type="p/msg/A", text=text))
    ours = open_library(bags=[path])
    assert ours.names() == ["p/msg/B"]
    with pytest.raises(DefinitionError, match="'p/msg/A', but not its definition: the recorded"):
        ours.message("p/A")


@pytest.mark.parametrize("write", [write_mcap, write_db3])
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("p/srv/Add_Event", heading("SRV", "p/srv/Add", ADD)),
        ("p/srv/Add_Event", heading("SRV", "p/srv/Add_Event", ADD)),
        ("p/srv/Add_Event", ADD),
        ("p/srv/Add", ADD),
    ],
)
def test_the_event_of_a_service_is_that_of_its_text(tmp_path, write, name, text):
    # In a database, the definition has the name of the service.
    channel = Channel(type="p/srv/Add_Event", schema=name, text=text)
    ours = open_library(bags=[write(tmp_path / "x", STRING, channel)])
    assert ours.interfaces() == ["p/srv/Add", "std_msgs/msg/String"]
    assert ours.unusable == {}
    assert fields(ours, "p/srv/Add_Event") == [
        ("info", "service_msgs/msg/ServiceEventInfo"),
        ("request", "p/srv/Add_Request[<=1]"),
        ("response", "p/srv/Add_Response[<=1]"),
    ]


@pytest.mark.parametrize("name", ["Turn_FeedbackMessage", "Turn_SendGoal_Event", "Turn_Goal"])
@pytest.mark.parametrize("text", [TURN, heading("ACTION", "p/action/Turn", TURN)])
def test_an_action_has_all_its_messages(tmp_path, name, text):
    channel = Channel(type=f"p/action/{name}", text=text)
    ours = open_library(bags=[write_mcap(tmp_path / "x.mcap", channel)])
    assert ours.interfaces() == ["p/action/Turn"]
    assert len(ours.interface("p/action/Turn").messages) == 10
    assert ours.message(f"p/action/{name}")
    assert fields(ours, "p/action/Turn_FeedbackMessage")[0] == (
        "goal_id",
        "unique_identifier_msgs/msg/UUID",
    )


def test_what_ros_adds_is_that_of_the_recording_if_there(tmp_path):
    info = heading("MSG", "service_msgs/msg/ServiceEventInfo", "int8 mine\n")
    channel = Channel(type="p/srv/Add_Event", text=f"{heading('SRV', 'p/srv/Add', ADD)}{info}")
    ours = open_library(bags=[write_mcap(tmp_path / "x.mcap", channel)])
    assert fields(ours, "service_msgs/msg/ServiceEventInfo") == [("mine", "int8")]


def test_what_else_is_missing_comes_from_a_folder(tmp_path, capsys):
    path = write_mcap(tmp_path / "x.mcap", Channel(type="p/msg/A", text="q/B b\n"))
    folder = make_files(tmp_path / "q", {"msg/B.msg": "int8 x\n"})
    with pytest.raises(DefinitionError) as error:
        open_library(bags=[path]).message("p/A")
    assert str(error.value) == (
        f"<{path}>/p/msg/A.msg:1:1: error: package 'q' is not found; the recording lacks it: name "
        "a folder that has it with --depends, or a distribution with --distro\nq/B b\n^^^"
    )
    assert open_library(bags=[path], paths=[folder]).message("p/A")
    for command in ("show", "metrics", "plan"):
        assert main([command, "p/A", "--bag", str(path), "--depends", str(folder)]) == 0
    # The folder's types are not those of the recording.
    capsys.readouterr()
    assert main(["list", "--bag", str(path), "--depends", str(folder)]) == 0
    assert capsys.readouterr().out == "p/msg/A\n"


def test_types_of_old_databases_come_from_a_distribution_or_a_folder(tmp_path, capsys):
    path = make_old_db3(tmp_path / "x.db3", ["std_msgs/msg/Header", "p/msg/A", "p/action/Go_Goal"])
    with pytest.raises(DefinitionError, match=r"or the distribution with --distro humble$"):
        open_library(bags=[path])
    ours = open_library("humble", bags=[path])
    assert ours.interfaces() == ["std_msgs/msg/Header"]
    assert fields(ours, "std_msgs/Header")[0] == ("stamp", "builtin_interfaces/msg/Time")
    assert [*ours.unusable] == ["p/msg/A", "p/action/Go_Goal"]
    go = "std_msgs/Header h\n---\n---\n"
    folder = make_files(tmp_path / "p", {"msg/A.msg": "int8 a\n", "action/Go.action": go})
    both = open_library("humble", bags=[path], depends=[folder])
    assert both.interfaces() == ["p/action/Go", "p/msg/A", "std_msgs/msg/Header"]
    assert (fields(both, "p/A"), both.unusable) == ([("a", "int8")], {})
    assert fields(both, "p/action/Go_Goal") == [("h", "std_msgs/msg/Header")]
    # The distribution that the recording names is not asked for more.
    alone = open_library(bags=[path], depends=[folder])
    assert (alone.interfaces(), alone.distro) == (["p/action/Go", "p/msg/A"], "humble")
    arguments = ["--bag", str(path), "--depends", str(folder), "--distro", "humble", "--all"]
    assert main(["proto", *arguments]) == 0


def test_a_distribution_that_was_named_is_not_proposed(tmp_path, capsys):
    path = make_old_db3(tmp_path / "x.db3", ["p/msg/A"])
    for more in ([], ["--bag", str(make_old_db3(tmp_path / "y.db3", ["std_msgs/msg/Bool"]))]):
        main(["list", "--bag", str(path), *more, "--distro", "humble"])
        said = capsys.readouterr().err
        assert "none was recorded, and humble does not have it; name a folder that has" in said
        assert "--distro" not in said
    mcap = write_mcap(tmp_path / "x.mcap", Channel(type="p/msg/A", text="q/B b\n"))
    assert main(["show", "p/A", "--bag", str(mcap), "--distro", "humble"]) == 1
    said = capsys.readouterr().err
    assert "the recording and humble lack it: name a folder" in said and "--distro" not in said


def test_one_recording_has_what_another_lacks(tmp_path):
    """Whatever their order is, and whether the first has anything of its own."""
    old = make_old_db3(tmp_path / "old.db3", ["p/msg/A", "p/msg/B"])
    some = write_db3(tmp_path / "some", STRING, Channel(type="p/msg/A", schema="other", text=""))
    a = write_mcap(tmp_path / "a.mcap", Channel(type="p/msg/A", text="int8 a\n"))
    b = write_mcap(tmp_path / "b.mcap", Channel(type="p/msg/B", text="A a\n"))
    for bags in ([old, a, b], [a, old, b], [b, a, old], [some, a, b]):
        ours = open_library(bags=bags)
        assert fields(ours, "p/A") == [("a", "int8")] and not ours.unusable
        assert fields(ours, "p/B") == [("a", "p/msg/A")]
    with pytest.raises(DefinitionError, match=r"old\.db3' has a topic of type 'p/msg/B', but not"):
        open_library(bags=[old, a]).message("p/B")


@pytest.mark.parametrize("write", [write_mcap, write_db3])
@pytest.mark.parametrize(
    ("language", "text", "reason"),
    [
        ("unknown", "", "none was recorded; name a folder"),
        ("unknown", "int8 a\n", "none was recorded; name a folder"),
        ("", "", "none was recorded; name a folder"),
        ("jsonschema", '{"type": "object"}', "it is in 'jsonschema', and only ros2msg and ros2idl"),
        ("protobuf", b"\n\xff\xfe", "it is in 'protobuf', and only ros2msg"),
        ("protobuf", "message A {}", "it is in 'protobuf', and only ros2msg"),
        ("flatbuffer", bytes(range(256)), "it is in 'flatbuffer', and only ros2msg"),
        ("ros1msg", "int8 a\n", "it is in 'ros1msg', and only ros2msg"),
        ("omgidl", "struct A { long a; };", "it is in 'omgidl', and only ros2msg"),
        ("x" * 100, "", "it is in 'xxx"),
        ("ros2msg", b"int8 a # \xe4\n", "it is not UTF-8 text"),
        ("ros2msg", "#" * (1 << 22) + "\n", "it has more than 4194304 bytes"),
        ("ros2msg", "===\nMSG: p/A\n" * 20_000, "it has more than 16384 headings"),
        ("ros2idl", "", "none was recorded"),
    ],
    ids=lambda value: value[:10] if isinstance(value, str) else "bytes",
)
def test_one_topic_does_not_make_the_others_unusable(tmp_path, write, language, text, reason):
    bad = Channel(topic="/bad", type="p/msg/A", language=language, text=text)
    for order in ((bad, STRING), (STRING, bad)):
        ours = open_library(bags=[write(tmp_path / f"{order.index(bad)}.x", *order)])
        assert ours.interfaces() == ["std_msgs/msg/String"]
        ((name, sentence),) = ours.unusable.items()
        assert name == "p/msg/A"
        assert f"has a topic of type 'p/msg/A', but not its definition: {reason}" in sentence
        with pytest.raises(DefinitionError) as error:
            ours.message("p/A")
        assert str(error.value) == f"error: {sentence}"


@pytest.mark.parametrize("name", ["*", "String", "std_msgs/*", "p/msg/a-b", "-/x", "a/b/c/d"])
def test_names_that_are_no_types_are_listed_as_unusable(tmp_path, capsys, name):
    path = write_bag(
        tmp_path / "x.bag", Channel(type="std_msgs/String"), Channel(type=name, text="")
    )
    assert main(["list", "--bag", str(path)]) == 0
    note = f"note: '{path}' has a topic of type '{name}', which is not the name of a type\n"
    assert capsys.readouterr() == ("std_msgs/String\n", note)
    assert main(["md5", "--all", "--bag", str(path)]) == 0
    assert capsys.readouterr() == ("992ce8a1687cec8c8bd883ec73ca41d1  std_msgs/String\n", note)


def test_many_reasons_are_cut(tmp_path):
    channels = [Channel(type=f"p/msg/A{number}", language="x") for number in range(25)]
    with pytest.raises(DefinitionError) as error:
        RecordingOrigin(write_mcap(tmp_path / "x.mcap", *channels))
    assert len(error.value.diagnostics) == 21
    assert str(error.value).endswith("\nerror: 5 more types cannot be used")


@pytest.mark.parametrize(
    ("written", "recorded"),
    [
        ("Header", "roslib/Header"),
        ("roslib/Header", "roslib/Header"),
        ("roslib/Header", "std_msgs/Header"),
    ],
)
def test_the_header_of_roslib_is_that_of_std_msgs(tmp_path, written, recorded):
    text = f"{written} header\n{heading('MSG', recorded, 'uint32 seq')}\n"
    path = write_bag(tmp_path / "x.bag", Channel(type="p/A", text=text))
    ours = open_library(bags=[path])
    assert ours.names() == ["p/A", "std_msgs/Header"]
    assert fields(ours, "p/A") == [("header", "std_msgs/Header")]


def test_a_topic_without_a_type_is_named(tmp_path):
    channel = Channel(type="", topic="/chat", language="")
    path = write_mcap(tmp_path / "x.mcap", channel, Channel(type="std_msgs/msg/String"))
    assert list(open_library(bags=[path]).unusable.values()) == [
        f"'{path}' has a topic '/chat' without a type"
    ]


def test_mcap_of_ros1_has_types_of_ros1(tmp_path):
    channel = Channel(type="std_msgs/String", language="ros1msg", wire="ros1")
    ours = open_library(bags=[write_mcap(tmp_path / "x.mcap", channel, profile="ros1")])
    assert (ours.dialect, ours.distro, ours.names()) == ("ros1", "noetic", ["std_msgs/String"])


def test_the_names_in_a_recording_have_a_limit(tmp_path, monkeypatch):
    # More names than this limit take seconds to check.
    monkeypatch.setattr(recordings, "_MOST_NAMES", 100)
    text = "".join(f"===\nMSG: p/A{number}\n" for number in range(49))
    path = write_mcap(
        tmp_path / "x.mcap",
        Channel(type="p/msg/B", text=text),
        Channel(type="p/msg/C", text=text.replace("A", "*")),
    )
    assert len(open_library(bags=[path]).names()) == 49
    monkeypatch.setattr(recordings, "_MOST_NAMES", 99)
    with pytest.raises(DefinitionError, match=r"has more than 99 names of types$"):
        open_library(bags=[path])


@pytest.mark.sampled(5)
@pytest.mark.parametrize("sign", ['\\"', "/*", "module a{", "struct S{long a;};", "}"])
def test_sections_of_any_signs_end(tmp_path, sign):
    """Each is processed in a time that grows with its length, not with the square of it."""
    text = heading("IDL", "p/msg/A", sign * (1_000_000 // len(sign)))
    channel = Channel(type="p/msg/A", language="ros2idl", text=text)
    ours = open_library(bags=[write_mcap(tmp_path / "x.mcap", channel)])
    assert "p/msg/A" in ours.names()
