"""The class `Library`: names, suggestions, origins and hashes."""

from __future__ import annotations

from typing import ClassVar

import pytest

from firm_hdl.errors import DefinitionError, Source
from firm_hdl.frontend import DISTROS, Library
from firm_hdl.frontend.sources import Definition
from firm_hdl.model import Action, Message, Service

from .workspace import library, make_files


def refused(function, *args):
    with pytest.raises(DefinitionError) as error:
        function(*args)
    assert all(d.span is None for d in error.value.diagnostics)
    return str(error.value)


def test_names_are_canonical_and_sorted(tmp_path):
    for distro in DISTROS:
        lib = Library(distro)
        names = lib.names()
        assert names == sorted(names)
        assert lib.distro == distro
        part = "/msg/" if lib.dialect == "ros2" else "/"
        assert f"sensor_msgs{part}Imu" in names
    assert "p/msg/A" in library(tmp_path, {"p/A": ""}).names()


def test_builtin_types_of_ros1_are_not_listed():
    assert not any("builtin_interfaces" in name for name in Library("noetic").names())


@pytest.mark.parametrize(
    "name",
    ["", "/", "/b", "a/", "a//b", "/a/b", "a/b/", "a/b/c", "a/b/c/d", "/msg/b", "a/msg/"],
)
def test_malformed_names(name):
    assert refused(Library("noetic").message, name) == (
        f"error: '{name}' is not the name of a type, which is 'package/Name'"
    )
    assert refused(Library("noetic").source, name).startswith(f"error: '{name}' is not the name")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("Imu", "'Imu' is not the name of a type, which is 'package/msg/Name'; "
                "did you mean 'sensor_msgs/msg/Imu'?"),
        ("sensor_msgs/srv/Imu",
         "type 'Imu' is not defined in package 'sensor_msgs'; "
         "did you mean 'sensor_msgs/msg/Imu'?"),
        ("sensor_msgs/msg/Imuu", "type 'Imuu' is not defined in package 'sensor_msgs'; "
                                 "did you mean 'sensor_msgs/msg/Imu'?"),
        ("sensor_msgs/imu", "type 'imu' is not defined in package 'sensor_msgs'; "
                            "did you mean 'sensor_msgs/msg/Imu'?"),
        ("sensor_msg/Imu", "package 'sensor_msg' is not found; "
                           "did you mean 'sensor_msgs/msg/Imu'?"),
        ("geometry_msg/Pos", "package 'geometry_msg' is not found; "
                             "did you mean 'geometry_msgs/msg/Pose'?"),
        ("std_msgs/Pose", "type 'Pose' is not defined in package 'std_msgs'; "
                          "did you mean 'geometry_msgs/msg/Pose'?"),
        ("nothing/At/All",
         "'nothing/At/All' is not the name of a type, which is 'package/msg/Name'"),
        ("nothing/Similar", "package 'nothing' is not found; "
         "--path names a folder that has it (in a node: 'paths')"),
    ],
)  # fmt: skip
def test_unknown_names_get_suggestions(name, message):
    lib = Library("lyrical")
    assert refused(lib.message, name) == f"error: {message}"
    assert refused(lib.source, name) == f"error: {message}"
    assert refused(lib.definition_hash, name) == f"error: {message}"


def test_long_and_invisible_names_are_shown_shortened_and_escaped():
    message = refused(Library().message, "p/\x00" + "x" * 5000)
    hint = "; --path names a folder that has it (in a node: 'paths')"
    assert message == f"error: package 'p' is not found{hint}"
    shown = rf"\x00{'x' * 56}..."
    message = refused(Library().message, "std_msgs/\x00" + "x" * 5000)
    assert message == f"error: type '{shown}' is not defined in package 'std_msgs'"
    message = refused(Library().message, "\x00" + "x" * 5000 + "/A")
    assert message == f"error: package '{shown}' is not found{hint}"
    message = refused(Library().message, "\x00" + "x" * 5000)
    assert message.startswith("error: '\\x00xxx") and len(message) < 200


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_interfaces_are_all_definitions(tmp_path, distro):
    files = {"p/msg/A.msg": "", "p/srv/B.srv": "---", "p/action/C.action": "---\n---"}
    lib = Library(distro, [make_files(tmp_path, files)])
    names = [name for name in lib.interfaces() if name.startswith("p/")]
    if distro == "noetic":
        assert names == ["p/A", "p/B", "p/C"]
    else:
        assert names == ["p/action/C", "p/msg/A", "p/srv/B"]
    assert [name for name in lib.names() if name.startswith("p/")] == [names[distro != "noetic"]]
    assert [lib.interface(name).name for name in names] == names


def test_same_name_of_several_kinds(tmp_path):
    files = {"p/msg/A.msg": "int8 a", "p/srv/A.srv": "---", "p/action/A.action": "---\n---"}
    lib = Library("noetic", [make_files(tmp_path, files)])
    names = [name for name in lib.interfaces() if name.startswith("p/")]
    assert names == ["p/A", "p/action/A", "p/srv/A"]
    assert [type(lib.interface(name)) for name in names] == [Message, Action, Service]
    assert [lib.interface(name).name for name in names] == ["p/A"] * 3


def test_a_name_without_a_kind_is_that_of_the_first_folder_that_has_the_package(tmp_path):
    one = make_files(tmp_path / "1", {"p/srv/A.srv": "int8 a\n---\n", "p/action/B.action": ""})
    idl = "module p { module msg { struct A { long b; }; }; };"
    two = make_files(tmp_path / "2", {"p/msg/A.idl": idl, "p/srv/B.srv": "---\n"})
    for paths, kind in (([one, two], Service), ([two, one], Message)):
        lib = Library("lyrical", paths)
        assert type(lib.interface("p/A")) is kind
        assert lib.is_idl("p/A") is (kind is Message)
        assert lib.source("p/A").text == (idl if kind is Message else "int8 a\n---\n")
        assert lib.source("p/B").text == ("---\n" if kind is Message else "")
    # As in ROS, the package of the second folder is hidden as a whole.
    assert refused(lib.interface, "p/srv/A") == (
        f"error: type 'A' is not defined in package 'p', which is taken from '{two}/p' and hides "
        f"that of '{one}/p', where the type is; as in ROS, a package comes from one place as a "
        "whole; did you mean 'p/msg/A'?"
    )


@pytest.mark.parametrize("name", ["p/B", "p/srv/B"])
def test_a_service_is_no_message(tmp_path, name):
    make_files(tmp_path, {"p/srv/B.srv": "---"})
    assert refused(Library("lyrical", [tmp_path]).message, name) == (
        "error: 'p/srv/B' is a service, not a message; "
        "did you mean 'p/srv/B_Request', 'p/srv/B_Response' or 'p/srv/B_Event'?"
    )
    assert refused(Library("noetic", [tmp_path]).message, name) == (
        "error: 'p/B' is a service, not a message; did you mean 'p/BRequest' or 'p/BResponse'?"
    )


def test_messages_of_services_are_the_same_objects_however_asked_for(tmp_path):
    make_files(tmp_path, {"p/srv/B.srv": "int8 a\n---", "p/action/C.action": "---\n---"})
    for distro, request, goal in (
        ("noetic", "p/BRequest", "p/CGoal"),
        ("humble", "p/srv/B_Request", "p/action/C_Goal"),
    ):
        lib = Library(distro, [tmp_path])
        assert lib.message(request) is lib.interface("p/B").request is lib.interface(request)
        assert lib.message(goal) is lib.interface("p/C").goal
        assert lib.interface("p/C") is lib.interface("p/action/C")
        assert lib.interface("p/B") is lib.interface("p/srv/B")
        assert [lib.interface(n).name[-1] for n in ("p/B", "p/C", "p/B")] == ["B", "C", "B"]
        assert lib.source(request).text == "int8 a\n---"
        assert lib.source(goal).text == lib.source("p/C").text == "---\n---"
    assert Library("noetic", [tmp_path]).message("p/srv/BRequest").name == "p/BRequest"
    assert Library("noetic", [tmp_path]).message("p/action/CGoal").name == "p/CGoal"


def test_hash_of_services_is_that_of_all_their_messages(tmp_path):
    def hashes(text, name):
        root = make_files(tmp_path / str(len(list(tmp_path.iterdir()))), {"p/srv/B.srv": text})
        return Library("lyrical", [root]).definition_hash(name)

    before, after = "Header a\n---\nint8 b", "Header a\n---\nint8 c"
    before, after = (text.replace("Header", "std_msgs/Header") for text in (before, after))
    assert hashes(before, "p/srv/B_Request") == hashes(after, "p/srv/B_Request")
    for name in ("p/srv/B_Response", "p/srv/B_Event", "p/srv/B"):
        assert hashes(before, name) != hashes(after, name)
    lib = Library("lyrical", [make_files(tmp_path / "x", {"p/srv/B.srv": before})])
    assert lib.definition_hash(lib.interface("p/B")) == lib.definition_hash("p/B")


class Texts:
    """A minimal origin of definitions."""

    packages: ClassVar = {}

    def __init__(self, texts):
        self.texts = texts

    def names(self):
        return list(self.texts)

    def find(self, package, kind, name):
        text = self.texts.get((package, kind, name))
        source = Source(name=f"<texts>/{name}", text=text or "")
        return None if text is None else Definition(source=source, language="msg")


def test_origins_replace_the_types_of_the_distribution(tmp_path):
    origin = Texts({("p", "msg", "A"): "q/B b", ("q", "msg", "B"): "int8 x"})
    lib = Library("lyrical", origins=[origin])
    assert lib.interfaces() == ["p/msg/A", "q/msg/B"]
    assert lib.message("p/A").fields[0].type is lib.message("q/B")
    assert refused(lib.message, "std_msgs/String").startswith(
        "error: package 'std_msgs' is not found"
    )
    lib = Library("lyrical", [make_files(tmp_path, {"q/msg/B.msg": "int8 y"})], origins=[origin])
    assert lib.message("q/B").fields[0].name == "y"
    # Without other origins there are the folders alone.
    assert Library("lyrical", [tmp_path], origins=()).interfaces() == ["q/msg/B"]


def test_origins_may_have_messages_of_services_by_themselves():
    # Recordings have such messages.
    names = ["S_Event", "S_Request", "S_Response"]
    lib = Library("lyrical", origins=[Texts({("p", "srv", n): f"int8 x{len(n)}" for n in names})])
    assert lib.interfaces() == [f"p/srv/{name}" for name in names]
    for name in lib.interfaces():
        assert lib.message(name) is lib.interface(name)
    assert refused(lib.interface, "p/srv/S").startswith("error: type 'S' is not defined")


def test_unknown_distribution():
    with pytest.raises(ValueError) as error:
        Library("melodic")
    assert str(error.value) == (
        "Distribution must be one of noetic, foxy, humble, iron, jazzy, kilted, lyrical, "
        "not 'melodic'"
    )


def test_paths_that_are_no_folders(tmp_path):
    assert refused(Library, "lyrical", [f"{tmp_path}/x", tmp_path, f"{tmp_path}/y"]) == (
        f"error: '{tmp_path}/x' is not a folder\nerror: '{tmp_path}/y' is not a folder"
    )


def test_hash_depends_on_neither_place_nor_line_ends(tmp_path):
    files = {"p/A": "# c\nq/B b\n", "q/B": "int8 x\nint8 y\n"}
    crlf = {name: text.replace("\n", "\r\n") for name, text in files.items()}
    cr = {name: text.replace("\n", "\r") for name, text in files.items()}
    hashes = {
        library(tmp_path / str(i), texts).definition_hash("p/A")
        for i, texts in enumerate([files, crlf, cr])
    }
    assert len(hashes) == 1
    (digest,) = hashes
    assert len(digest) == 64 and set(digest) <= set("0123456789abcdef")


def test_hash_changes_with_every_text_that_matters_and_no_other(tmp_path):
    files = {"p/A": "q/B b\nC[] c", "q/B": "r/D d", "r/D": "", "p/C": "r/D d", "p/E": ""}
    before = library(tmp_path / "0", files).definition_hash("p/A")
    for number, name in enumerate(files, 1):
        changed = files | {name: files[name] + "\n# more"}
        after = library(tmp_path / str(number), changed).definition_hash("p/A")
        assert (after == before) is (name == "p/E")


def test_hash_tells_where_a_text_ends(tmp_path):
    one = library(tmp_path / "1", {"p/A": "B b\n#", "p/B": "#\n"})
    two = library(tmp_path / "2", {"p/A": "B b\n", "p/B": "##\n"})
    assert one.definition_hash("p/A") != two.definition_hash("p/A")


@pytest.mark.parametrize(
    ("distro", "digest"),
    [
        ("noetic", "c01ac0acf9e427ed8b1007d7879be43173ebe6e297efff92b21ae1154872c09d"),
        ("lyrical", "f8a3beaa0541e9c3302db3a774fd9c52a2090183497d1eda18cdf05650d06a09"),
    ],
)
def test_hash_is_stable(distro, digest):
    # A change of this hash makes users rebuild all generated code: it must be on purpose.
    assert Library(distro).definition_hash("sensor_msgs/Imu") == digest


@pytest.mark.parametrize("name", [5, None, ["std_msgs/msg/Bool"]])
def test_names_of_types_are_strings(name):
    with pytest.raises(TypeError, match=r"^Name of a type must be a string, not "):
        Library().message(name)
