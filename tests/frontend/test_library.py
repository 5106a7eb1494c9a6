"""The front end's face."""

from __future__ import annotations

import pytest

import firm_hdl.frontend
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DISTROS, Library, load_message

from .workspace import library, make_files


def refused(function, *args):
    with pytest.raises(DefinitionError) as error:
        function(*args)
    assert all(d.span is None for d in error.value.diagnostics)
    return str(error.value)


def test_public_names():
    assert firm_hdl.frontend.__all__ == [
        "DEFAULT_DISTRO", "DISTROS", "Distro", "Library", "load_message", "show",
    ]  # fmt: skip


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


@pytest.mark.parametrize("name", ["sensor_msgs/Imu", "sensor_msgs/msg/Imu"])
def test_both_forms_of_a_name_are_taken(name):
    assert Library("noetic").message(name).name == "sensor_msgs/Imu"
    assert Library("humble").message(name).name == "sensor_msgs/msg/Imu"
    assert load_message(name).name == "sensor_msgs/msg/Imu"
    assert load_message(name, distro="noetic").name == "sensor_msgs/Imu"


def test_load_message_takes_paths(tmp_path):
    make_files(tmp_path, {"p/msg/A.msg": "int8 x"})
    assert load_message("p/A", distro="foxy", paths=[tmp_path]).fields[0].name == "x"


@pytest.mark.parametrize("name", ["", "/", "a//b", "/a/b", "a/b/", "a/b/c", "a/b/c/d", "time"])
def test_malformed_names(name):
    assert refused(Library("noetic").message, name) == (
        f"error: '{name}' is not the name of a message type, which is 'package/Name'"
    )
    assert refused(Library("noetic").source, name).startswith(f"error: '{name}' is not the name")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("Imu", "'Imu' is not the name of a message type, which is 'package/msg/Name'; "
                "did you mean 'sensor_msgs/msg/Imu'?"),
        ("sensor_msgs/srv/Imu",
         "'sensor_msgs/srv/Imu' is not the name of a message type, which is 'package/msg/Name'; "
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
         "'nothing/At/All' is not the name of a message type, which is 'package/msg/Name'"),
        ("nothing/Similar", "package 'nothing' is not found"),
    ],
)  # fmt: skip
def test_unknown_names_get_suggestions(name, message):
    lib = Library("lyrical")
    assert refused(lib.message, name) == f"error: {message}"
    assert refused(lib.source, name) == f"error: {message}"
    assert refused(lib.definition_hash, name) == f"error: {message}"


def test_long_and_invisible_names_are_shown_shortened_and_escaped():
    message = refused(Library().message, "p/\x00" + "x" * 5000)
    assert message == "error: package 'p' is not found"
    message = refused(Library().message, "\x00" + "x" * 5000)
    assert message.startswith("error: '\\x00xxx") and len(message) < 200


def test_unknown_distribution():
    with pytest.raises(ValueError) as error:
        Library("melodic")
    assert str(error.value) == (
        "Distribution must be one of noetic, foxy, humble, iron, jazzy, kilted, lyrical, "
        "not 'melodic'"
    )


def test_path_that_is_no_folder(tmp_path):
    assert refused(Library, "lyrical", [f"{tmp_path}/x"]) == (
        f"error: '{tmp_path}/x' is not a folder"
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
        ("lyrical", "8c748789e0404ba01378bfd6e0f63f938b6bcf08f5418cceb512a88bc841c20b"),
    ],
)
def test_hash_stays_what_it_is(distro, digest):
    # A change of this rebuilds what users have generated: it must be on purpose.
    assert Library(distro).definition_hash("sensor_msgs/Imu") == digest
