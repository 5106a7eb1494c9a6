"""Types from recordings, without types of other origins."""

from __future__ import annotations

import json
import random
import sqlite3

import pytest
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2

from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library, RecordingOrigin, open_library
from firm_hdl.identity import type_hash
from tests.depth import THOROUGH
from tests.frontend.recordings import FORMATS, make_old_db3, make_recording, record

SEPARATOR = "=" * 80


@pytest.fixture(params=FORMATS)
def recording(request, tmp_path):
    """A recording of each form."""
    return make_recording(tmp_path, request.param)


def test_types_are_those_of_the_topics_and_in_them(recording):
    ours = open_library(bags=[recording])
    names = {"my_msgs/Wheel", "my_msgs/Spot", "std_msgs/String", "std_msgs/Header"}
    if ours.dialect == "ros2":
        names |= {"builtin_interfaces/Time"}
        names = {name.replace("/", "/msg/") for name in names}
    assert {*ours.names()} == names
    assert ours.distro == ("noetic" if ours.dialect == "ros1" else "lyrical")
    wheel = ours.message("my_msgs/Wheel")
    assert [field.name for field in wheel.fields] == ["header", "speed", "spots"]
    assert [field.name for field in wheel.fields[2].type.element.fields] == ["a", "b"]
    assert [(c.name, c.value) for c in wheel.constants] == [("LEFT", 0)]


def test_no_other_types_are_there(recording):
    # The distribution has it, but it is not in the recording.
    with pytest.raises(DefinitionError, match="type 'Bool' is not defined in package 'std_msgs'"):
        open_library(bags=[recording]).message("std_msgs/Bool")


@pytest.mark.parametrize("form", ["mcap", "db3"])
def test_single_file_of_rosbag2_will_do(tmp_path, form):
    (file,) = make_recording(tmp_path, form).glob(f"*.{form}")
    (file.parent / "metadata.yaml").unlink()
    assert open_library(bags=[file]).message("my_msgs/Wheel").fields[1].name == "speed"


def test_definitions_mean_what_those_in_folders_mean(tmp_path):
    recorded = open_library(bags=[make_recording(tmp_path, "mcap")], distro="jazzy")
    want = Library("jazzy")
    for name in ("std_msgs/msg/Header", "std_msgs/msg/String"):
        assert recorded.message(name) == want.message(name)
        assert type_hash(recorded.message(name)) == type_hash(want.message(name))


def test_commands_take_recordings(tmp_path, recording, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    bag = ["--bag", str(recording)]
    assert main(["show", "my_msgs/Wheel", *bag]) == 0
    assert capsys.readouterr().out.startswith("uint8 LEFT=0\nstd_msgs/Header header\n")
    assert main(["list", *bag]) == 0
    assert "Wheel" in capsys.readouterr().out
    # Building takes long, and reads recordings as the other commands do.
    if THOROUGH:
        assert main(["build", "my_msgs/Wheel", *bag, "--out", "out"]) == 0
        (manifest,) = tmp_path.glob("out/*/my_msgs*/manifest.json")
        leaves = json.loads(manifest.read_text())["leaves"]
        assert any("speed" in json.dumps(leaf) for leaf in leaves)
    assert main(["metrics", "--all", *bag]) == 0
    assert main(["info", "my_msgs/Wheel", *bag]) == 0
    assert main(["proto", "my_msgs/Wheel", *bag]) == 0
    command = "md5" if recording.suffix == ".bag" else "hash"
    assert main([command, "my_msgs/Wheel", *bag]) == 0


def test_paths_and_recordings_exclude_each_other(recording, capsys):
    with pytest.raises(SystemExit) as caught:
        main(["list", "--bag", str(recording), "--path", "."])
    assert caught.value.code == 2
    assert "not allowed with argument" in capsys.readouterr().err


def test_dialect_of_the_distribution_must_be_that_of_the_recording(tmp_path):
    bag, mcap = make_recording(tmp_path, "bag"), make_recording(tmp_path, "mcap")
    assert open_library("humble", bags=[mcap]).distro == "humble"
    with pytest.raises(DefinitionError) as error:
        open_library("humble", bags=[bag])
    assert str(error.value) == f"error: '{bag}' is a recording of ROS 1, and humble is ROS 2"
    with pytest.raises(DefinitionError) as error:
        open_library(bags=[mcap, bag])
    assert str(error.value) == (
        f"error: '{mcap}' is a recording of ROS 2, and '{bag}' of ROS 1; read them one at a time"
    )


def test_first_of_several_recordings_wins(tmp_path):
    one = record(tmp_path / "one", "p/msg/A", "int8 one\n")
    two = record(tmp_path / "two", "p/msg/A", "int8 two\n", ("p/msg/B", "int8 b\n"))
    ours = open_library(bags=[one, two])
    assert ours.names() == ["p/msg/A", "p/msg/B"]
    assert ours.message("p/A").fields[0].name == "one"


def test_texts_are_cut_at_headings_alone(tmp_path):
    text = (
        f"# {SEPARATOR}\nB b\np/C c\n\n{SEPARATOR}\nMSG: p/msg/B\nint8 x # =====\n\n"
        f"{SEPARATOR}\r\nMSG: p/C\r\nint8 y\r\n{SEPARATOR}\nMSG: p/D"
    )
    ours = open_library(bags=[record(tmp_path / "r", "p/msg/A", text)])
    assert ours.names() == ["p/msg/A", "p/msg/B", "p/msg/C", "p/msg/D"]
    assert ours.message("p/A").comment == SEPARATOR
    assert ours.source("p/A").text == f"# {SEPARATOR}\nB b\np/C c\n"
    assert ours.source("p/B").text == "int8 x # =====\n"
    assert ours.source("p/C").text == "int8 y\r\n"
    assert ours.source("p/D").text == ""


def test_mistake_is_shown_where_it_is_in_its_type(tmp_path):
    path = record(tmp_path / "r", "p/msg/A", f"B b\n{SEPARATOR}\nMSG: p/B\nint8 x\nint33 y\n")
    with pytest.raises(DefinitionError) as error:
        open_library(bags=[path]).message("p/A")
    assert str(error.value).startswith(f"<{path}>/p/msg/B.msg:2:1: error: 'int33' is not a type")


def test_definitions_in_idl(tmp_path):
    def idl(name, body):
        text = f"module p {{ module msg {{ struct {name} {{ {body} }}; }}; }};\n"
        return f"{SEPARATOR}\nIDL: p/msg/{name}\n{text}"

    text = idl("A", "p::msg::B b; float x;").replace("module", '#include "p/msg/B.idl"\nmodule', 1)
    path = record(tmp_path / "r", "p/msg/A", text + idl("B", "char c;"))
    ours = open_library(bags=[path])
    assert ours.names() == ["p/msg/A", "p/msg/B"]
    b, x = ours.message("p/A").fields
    assert (x.name, x.type.name) == ("x", "float32")
    assert [(f.name, f.type.signed) for f in b.type.fields] == [("c", True)]


def test_recording_without_definitions_says_what_to_do(tmp_path):
    path = make_old_db3(tmp_path / "old.db3", ["std_msgs/msg/String"])
    with pytest.raises(DefinitionError) as error:
        RecordingOrigin(path)
    assert str(error.value) == (
        f"error: '{path}' has no definitions of its types, like all recordings made before ROS 2 "
        "iron; name folders that have them with --depends, or the distribution with --distro humble"
    )
    path = make_old_db3(tmp_path / "none.db3", [])
    with pytest.raises(DefinitionError, match=r"has no topics, and so no definitions$"):
        RecordingOrigin(path)


@pytest.mark.parametrize(
    ("recorded", "asked"),
    [
        ("p/msg/B", "p/B"),
        ("p/msg/B", "p/msg/B"),
        # A name without its kind may also be that of a message.
        ("p/srv/B_Request", "p/B_Request"),
        ("p/action/B_Goal", "p/B_Goal"),
    ],
)
def test_topic_without_definition_is_distinguished_from_a_missing_one(tmp_path, recorded, asked):
    path = without_definition(tmp_path / "r", recorded)
    ours = open_library(bags=[path])
    assert ours.names() == ["p/msg/A"]
    for look_up in (ours.message, ours.interface, ours.source):
        with pytest.raises(DefinitionError) as error:
            look_up(asked)
        assert str(error.value) == (
            f"error: '{path}' has a topic of type '{recorded}', but not its definition: none was "
            "recorded; name a folder that has it with --depends, or a distribution with --distro"
        )


def without_definition(path, name):
    """Record two topics, and remove the definition of one."""
    with Writer2(path, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        for topic in ("p/msg/A", name):
            writer.add_connection(f"/{topic}", topic, msgdef="int8 a\n", rihs01="RIHS01_0")
    (file,) = path.glob("*.db3")
    database = sqlite3.connect(file)
    database.execute("DELETE FROM message_definitions WHERE topic_type = ?", [name])
    database.commit()
    database.close()
    return path


@pytest.mark.parametrize("storage", list(StoragePlugin))
def test_messages_without_fields_have_definitions_without_text(tmp_path, storage):
    path = tmp_path / "r"
    with Writer2(path, version=9, storage_plugin=storage) as writer:
        writer.add_connection("/t", "std_msgs/msg/Empty", msgdef="", rihs01="RIHS01_0")
    ours = open_library(bags=[path])
    assert ours.names() == ["std_msgs/msg/Empty"]
    assert ours.message("std_msgs/Empty").fields == ()


@pytest.mark.parametrize("name", ["a/b/c/d", "plain", "p::msg::A"])
def test_topics_whose_types_have_no_name_in_ros_are_named(tmp_path, name):
    path = record(tmp_path / "r", name, "int8 a\n")
    with pytest.raises(DefinitionError) as error:
        open_library(bags=[path])
    message = f"error: '{path}' has a topic of type '{name}', which is not the name of a type"
    assert str(error.value) == message
    both = record(tmp_path / "both", name, "int8 a\n", ("p/msg/B", "int8 b\n"))
    assert open_library(bags=[both]).names() == ["p/msg/B"]


def test_damaged_recording_ends_in_definitions_or_in_an_error(recording, tmp_path):
    """Cut the file or flip a bit: the reader gives definitions or an error, nothing else."""
    file = recording if recording.is_file() else next(recording.glob(f"*.{recording.name}"))
    data, draw = file.read_bytes(), random.Random(1)
    outcomes = set()
    for number in range(40):
        damaged = bytearray(data[: draw.randrange(len(data))] if number % 2 else data)
        for _ in range(draw.randrange(1, 20)):
            damaged[draw.randrange(len(damaged))] = draw.randrange(256)
        path = tmp_path / f"damaged{number}{file.suffix}"
        path.write_bytes(damaged)
        try:
            ours = open_library(bags=[path])
            for name in ours.interfaces():
                ours.interface(name)
            outcomes.add("definitions")
        except DefinitionError:
            outcomes.add("error")
    assert "error" in outcomes


def test_first_text_of_a_type_in_a_recording_counts(tmp_path):
    def with_part(field):
        return f"B b\n{SEPARATOR}\nMSG: p/B\nint8 {field}\n"

    path = record(
        tmp_path / "r", "p/msg/A", with_part("one"), ("p/msg/C", with_part("two")),
        ("p/msg/B", "int8 three\n"),
    )  # fmt: skip
    ours = open_library(bags=[path])
    assert [field.name for field in ours.message("p/B").fields] == ["one"]
    assert ours.message("p/C").fields[0].type is ours.message("p/B")


@pytest.mark.parametrize("order", [1, -1])
def test_definition_in_that_of_another_topic_will_do(tmp_path, order):
    topics = [("p/msg/B", ""), ("p/msg/A", f"B b\n{SEPARATOR}\nMSG: p/B\nint8 x\n")][::order]
    ours = open_library(bags=[record(tmp_path / "r", *topics[0], topics[1])])
    assert ours.names() == ["p/msg/A", "p/msg/B"]
    assert [field.name for field in ours.message("p/B").fields] == ["x"]


@pytest.mark.parametrize(
    ("recorded", "distro"),
    [("humble", "humble"), ("jazzy", "jazzy"), ("noetic", None), ("rosbags", None), ("[]", None)],
)
def test_distribution_is_the_one_that_the_recording_says(tmp_path, recorded, distro):
    path = make_recording(tmp_path, "mcap")
    metadata = path / "metadata.yaml"
    text = metadata.read_text()
    assert text.count("ros_distro: rosbags\n") == 1
    metadata.write_text(text.replace("ros_distro: rosbags\n", f"ros_distro: {recorded}\n"))
    found = RecordingOrigin(path)
    assert (found.distro, found.dialect) == (distro, "ros2")
    assert open_library(bags=[path]).distro == (distro or "lyrical")


def test_a_file_that_ends_too_early_is_damaged(tmp_path):
    (file,) = make_recording(tmp_path, "mcap").glob("*.mcap")
    data = file.read_bytes()
    for size in (9, 30, 100, len(data) - 9):
        short = tmp_path / f"{size}.mcap"
        short.write_bytes(data[:size])
        with pytest.raises(DefinitionError) as error:
            RecordingOrigin(short)
        assert "Invalid argument" not in str(error.value)
