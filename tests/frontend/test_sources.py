"""The search for packages in folders."""

from __future__ import annotations

import os
import sys

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend.names import TypeName
from firm_hdl.frontend.sources import EmbeddedOrigin, FolderOrigin, Sources

from .workspace import make_files


def sources(*roots):
    """Return the sources of some folders and of a distribution."""
    return Sources([*map(FolderOrigin, roots), EmbeddedOrigin("lyrical")])


def found(*roots):
    """Return the names of the messages in folders."""
    names = Sources(map(FolderOrigin, roots)).names
    assert all(kind == "msg" for _, kind, _ in names)
    return sorted((package, name) for package, _, name in names)


@pytest.mark.parametrize(
    "folder", ["pkg", "src/pkg", "ws/src/repo/deep/er/pkg", "install/pkg/share/pkg", "share/pkg"]
)
def test_package_is_found_at_any_depth(tmp_path, folder):
    make_files(tmp_path, {f"{folder}/msg/A.msg": "", f"{folder}/msg/B.msg": ""})
    assert found(tmp_path) == [("pkg", "A"), ("pkg", "B")]


def test_folder_may_be_the_package_itself(tmp_path):
    make_files(tmp_path, {"pkg/msg/A.msg": ""})
    assert found(tmp_path / "pkg") == [("pkg", "A")]
    assert found(str(tmp_path / "pkg") + os.sep) == [("pkg", "A")]


def test_current_folder_may_be_the_package(tmp_path, monkeypatch):
    make_files(tmp_path, {"pkg/msg/A.msg": ""})
    monkeypatch.chdir(tmp_path / "pkg")
    assert found(".") == [("pkg", "A")]


def test_only_definitions_in_the_folder_of_their_kind_count(tmp_path):
    files = ["msg/A.msg.bak", "msg/a.txt", "msg/.msg", "A.msg", "msgs/A.msg", "msg/A.srv"]
    files += ["srv/A.msg", "msg/.idl", "action/A.srv", "srv/A.action"]
    make_files(tmp_path, {f"pkg/{file}": "" for file in files})
    assert found(tmp_path) == []
    # A file may have the name of a kind, and hides nothing.
    make_files(tmp_path, {"tool/msg": "", "tool/srv": "", "tool/inner/msg/B.msg": ""})
    assert found(tmp_path) == [("inner", "B")]


@pytest.mark.parametrize(
    ("xml", "name"),
    [
        ("<package format='3'><name> real </name></package>", "real"),
        ("<?xml version='1.0'?>\n<package>\n  <name>real</name>\n</package>\n", "real"),
        ("<package><version>1</version></package>", "folder"),
        ("<package><name/></package>", "folder"),
        ("<package><name> \n </name></package>", "folder"),
        ("", "folder"),
        ("<pack", "folder"),
    ],
)
def test_package_xml_names_the_package(tmp_path, xml, name):
    make_files(tmp_path, {"folder/package.xml": xml, "folder/msg/A.msg": ""})
    assert found(tmp_path) == [(name, "A")]
    assert sources(tmp_path).find(name, "msg", "A").source.text == ""


@pytest.mark.parametrize("marker", ["AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"])
def test_ignored_folders_are_left_out(tmp_path, marker):
    make_files(tmp_path, {f"a/{marker}": "", "a/b/pkg/msg/A.msg": "", "other/msg/A.msg": ""})
    assert found(tmp_path) == [("other", "A")]
    make_files(tmp_path, {f"other/{marker}": ""})
    assert found(tmp_path) == []
    # The same holds for the folder that is searched.
    assert found(tmp_path / "a") == found(tmp_path / "other") == []


def test_hidden_folders_are_left_out(tmp_path):
    make_files(tmp_path, {".git/pkg/msg/A.msg": "", "a/.hidden/pkg/msg/A.msg": ""})
    assert found(tmp_path) == []


def test_package_contains_no_other_package(tmp_path):
    make_files(tmp_path, {"pkg/package.xml": "<package><name>pkg</name></package>"})
    make_files(tmp_path, {"pkg/msg/A.msg": "", "pkg/test/fixture/msg/B.msg": ""})
    assert found(tmp_path) == [("pkg", "A")]
    # This holds for packages without definitions, too, but not for folders that are no packages.
    make_files(tmp_path, {"meta/package.xml": "", "meta/inner/msg/C.msg": ""})
    make_files(tmp_path, {"outer/msg/D.msg": "", "outer/inner/msg/E.msg": ""})
    assert found(tmp_path) == [("inner", "E"), ("outer", "D"), ("pkg", "A")]


def test_link_to_a_folder_above_ends(tmp_path, monkeypatch):
    make_files(tmp_path, {"ws/src/pkg/msg/A.msg": ""})
    (tmp_path / "ws/src/back").symlink_to(tmp_path)
    (tmp_path / "ws/src/loop").symlink_to(tmp_path / "ws/src/loop")
    scanned, scandir = [], os.scandir
    monkeypatch.setattr(os, "scandir", lambda folder: scanned.append(folder) or scandir(folder))
    assert found(tmp_path) == [("pkg", "A")]
    # Each of the folders once, and the one above once more.
    assert len(scanned) == len(["root", "ws", "src", "pkg"]) + 1


def test_only_the_last_ending_of_a_file_is_not_of_its_name(tmp_path):
    make_files(tmp_path, {"p/msg/A.old.msg": "# old", "p/msg/A.msg": "# new", "p/msg/B.v2.idl": ""})
    assert found(tmp_path) == [("p", "A"), ("p", "A.old"), ("p", "B.v2")]
    assert sources(tmp_path).find("p", "msg", "A").source.text == "# new"


def test_links_to_packages_are_followed(tmp_path):
    make_files(tmp_path, {"elsewhere/pkg/msg/A.msg": "", "ws/keep": ""})
    (tmp_path / "ws/pkg").symlink_to(tmp_path / "elsewhere/pkg")
    assert found(tmp_path / "ws") == [("pkg", "A")]


def test_first_path_wins_type_by_type(tmp_path):
    make_files(tmp_path, {"one/pkg/msg/A.msg": "# 1", "two/pkg/msg/A.msg": "# 2"})
    make_files(tmp_path, {"two/pkg/msg/B.msg": "# 2"})
    have = sources(tmp_path / "one", tmp_path / "two")
    assert [have.find("pkg", "msg", n).source.text for n in ("A", "B")] == ["# 1", "# 2"]
    have = sources(tmp_path / "two", tmp_path / "one")
    assert [have.find("pkg", "msg", n).source.text for n in ("A", "B")] == ["# 2", "# 2"]


def test_within_a_path_the_first_folder_by_name_wins(tmp_path):
    make_files(tmp_path, {"b/pkg/msg/A.msg": "# b", "a/z/pkg/msg/A.msg": "# a", "c/x": ""})
    assert sources(tmp_path).find("pkg", "msg", "A").source.text == "# a"


def test_folder_overrides_the_distribution_type_by_type(tmp_path):
    make_files(tmp_path, {"std_msgs/msg/Header.msg": "# mine", "std_msgs/msg/Extra.msg": ""})
    have = sources(tmp_path)
    assert have.find("std_msgs", "msg", "Header").source.text == "# mine"
    embedded = have.find("std_msgs", "msg", "String")
    assert embedded.source.name == "<rosbags lyrical>/std_msgs/msg/String.msg"
    assert ("msg", "Extra") in have.types["std_msgs"]
    assert have.find("std_msgs", "msg", "Nothing") is None


def test_source_is_named_as_the_user_wrote_the_path(tmp_path, monkeypatch):
    make_files(tmp_path, {"ws/src/pkg/msg/A.msg": ""})
    monkeypatch.chdir(tmp_path)
    assert sources("ws").find("pkg", "msg", "A").source.name == "ws/src/pkg/msg/A.msg"


def test_text_is_kept_as_it_is(tmp_path):
    text = "# größe\r\nint32 a\rint32 b\n"
    make_files(tmp_path, {"pkg/msg/A.msg": text})
    assert sources(tmp_path).find("pkg", "msg", "A").source.text == text


@pytest.mark.parametrize("name", ["file", "none"])
def test_paths_that_are_no_folders_are_refused(tmp_path, name):
    make_files(tmp_path, {"file": ""})
    with pytest.raises(DefinitionError) as error:
        FolderOrigin(tmp_path / name)
    assert str(error.value) == f"error: '{tmp_path}/{name}' is not a folder"


def test_file_that_cannot_be_read_is_reported(tmp_path):
    (tmp_path / "pkg/msg/A.msg").mkdir(parents=True)
    with pytest.raises(DefinitionError) as error:
        sources(tmp_path).find("pkg", "msg", "A")
    assert str(error.value) == (
        f"error: '{tmp_path}/pkg/msg/A.msg' cannot be read: it is a folder, not a regular file"
    )


@pytest.mark.skipif(
    sys.platform == "win32" or os.geteuid() == 0, reason="this user may read everything"
)
def test_folder_that_cannot_be_read_is_passed_over(tmp_path):
    make_files(tmp_path, {"a/pkg/msg/A.msg": "", "b/pkg/msg/B.msg": ""})
    (tmp_path / "a").chmod(0)
    assert found(tmp_path) == [("pkg", "B")]
    (tmp_path / "a").chmod(0o700)


def test_search_goes_on_after_a_folder_that_cannot_be_read(tmp_path, monkeypatch):
    make_files(tmp_path, {"a/pkg/msg/A.msg": "", "b/pkg/msg/B.msg": "", "c/pkg/msg/C.msg": ""})
    scandir = os.scandir

    def refuse(folder):
        if os.path.basename(folder) == "b":
            raise PermissionError(13, "Permission denied", folder)
        return scandir(folder)

    monkeypatch.setattr(os, "scandir", refuse)
    assert found(tmp_path) == [("pkg", "A"), ("pkg", "C")]


KLINGON = "<?xml version='1.0' encoding='klingon'?><package><name>p</name></package>"


# Python's reader of XML has no such encoding, or has it for single bytes alone.
@pytest.mark.parametrize("encoding", ["klingon", "gb2312"])
def test_package_whose_name_cannot_be_read_is_refused_when_it_is_used(tmp_path, encoding):
    xml = KLINGON.replace("klingon", encoding)
    make_files(tmp_path, {"p/package.xml": xml, "p/msg/A.msg": "", "q/msg/B.msg": "# q"})
    have = sources(tmp_path)
    assert have.find("q", "msg", "B").source.text == "# q"
    with pytest.raises(DefinitionError) as error:
        have.find("p", "msg", "A")
    assert str(error.value) == (
        f"error: '{tmp_path}/p/package.xml' is in an encoding that is not known"
    )
    assert have.find("p", "msg", "C") is None


def test_package_whose_package_xml_is_no_file_is_refused_when_it_is_used(tmp_path):
    make_files(tmp_path, {"p/package.xml/x": "", "p/msg/A.msg": "", "q/msg/B.msg": "# q"})
    have = sources(tmp_path)
    assert have.find("q", "msg", "B").source.text == "# q"
    with pytest.raises(DefinitionError) as error:
        have.find("p", "msg", "A")
    reason = "it is a folder, not a regular file"
    assert str(error.value) == f"error: '{tmp_path}/p/package.xml' cannot be read: {reason}"


@pytest.mark.parametrize("good", ["one", "two"])
def test_of_two_packages_of_a_name_the_first_is_the_one_that_counts(tmp_path, good):
    names = {"one": KLINGON, "two": KLINGON, good: "<package><name>p</name></package>"}
    make_files(tmp_path, {f"{place}/p/package.xml": xml for place, xml in names.items()})
    make_files(tmp_path, {"one/p/msg/A.msg": "# one", "two/p/msg/A.msg": "# two"})
    if good == "one":
        assert sources(tmp_path).find("p", "msg", "A").source.text == "# one"
    else:
        with pytest.raises(DefinitionError, match=r"one/p/package\.xml"):
            sources(tmp_path).find("p", "msg", "A")


def test_scanning_reads_no_definition(tmp_path):
    for number in range(300):
        (tmp_path / f"p{number}/msg/A.msg").mkdir(parents=True)
    assert len(found(tmp_path)) == 300


def test_services_actions_and_idl_are_found(tmp_path):
    files = ["pkg/msg/A.msg", "pkg/srv/B.srv", "pkg/msg/I.idl", "pkg/action/J.idl"]
    files += ["src/only/srv/S.srv", "install/act/share/act/action/C.action"]
    origin = FolderOrigin(make_files(tmp_path, dict.fromkeys(files, "")))
    found = {name: origin.find(*name).language for name in origin.names()}
    assert found == {
        ("act", "action", "C"): "action",
        ("only", "srv", "S"): "srv",
        ("pkg", "action", "J"): "idl",
        ("pkg", "msg", "A"): "msg",
        ("pkg", "msg", "I"): "idl",
        ("pkg", "srv", "B"): "srv",
    }
    assert origin.find("pkg", "srv", "A") is None


def test_folder_called_like_a_kind_may_contain_packages(tmp_path):
    make_files(tmp_path, {"action/pkg/msg/A.msg": "", "msg/other/msg/B.msg": ""})
    assert found(tmp_path) == [("other", "B"), ("pkg", "A")]


def test_ros_form_of_a_type_wins_over_the_idl_made_of_it(tmp_path):
    make_files(tmp_path, {"pkg/msg/A.idl": "idl", "pkg/msg/A.msg": "# msg"})
    assert FolderOrigin(tmp_path).find("pkg", "msg", "A").source.text == "# msg"


def test_includes_are_read_from_folders_first(tmp_path):
    files = {"pkg/msg/A.idl": "// a", "pkg/idl/common.idl": "// c", "pkg/msg/B.msg": "int8 b"}
    have = sources(make_files(tmp_path / "ws", files))
    make_files(tmp_path, {"secret.idl": ""})
    assert have.include("pkg/msg/A.idl").text == "// a"
    assert have.include("pkg/idl/common.idl").text == "// c"
    # Files in ROS's own form need no IDL text: their types are found by name.
    assert have.include("pkg/msg/B.idl").text == ""
    assert have.include("std_msgs/msg/String.idl").text == ""
    make_files(tmp_path / "two", {"own/srv/S.srv": "---", "own/action/A.action": "---\n---"})
    make_files(tmp_path / "two", {"own/action/B.idl": "// b"})
    others = sources(tmp_path / "ws", tmp_path / "two")
    found = [others.include(f"own/{name}.idl").text for name in ("srv/S", "action/A", "action/B")]
    assert found == ["", "", "// b"]
    assert others.include("own/msg/S.idl") is None
    absent = ["pkg/msg/C.idl", "pkg/srv/A.idl", "none/msg/A.idl", "A.idl", "", "pkg/msg"]
    absent += ["pkg/msg/B", "pkg/msg/B.msg/x.idl", "/pkg/msg/A.idl"]
    for path in absent:
        assert have.include(path) is None
    # Only files of the package are read, whatever their names.
    for path in (
        "pkg/../../secret.idl",
        "pkg/idl/../../../secret.idl",
        f"pkg/{tmp_path}/secret.idl",
    ):
        assert have.include(path) is None
    make_files(tmp_path / "ws", {"pkg/idl/a..b.idl": "// d", "pkg/idl/folder/c": ""})
    assert have.include("pkg/idl/a..b.idl").text == "// d"
    assert have.include("pkg/idl/folder") is None


def test_names_are_sorted_by_their_first_origin(tmp_path):
    make_files(tmp_path, {"std_msgs/srv/String.srv": "", "p/msg/A.msg": ""})
    names = [TypeName("std_msgs", kind, "String", "ros2") for kind in ("msg", "srv", "action")]
    assert sources(tmp_path).by_origin(names) == [names[1], names[0]]


def test_of_packages_with_a_type_those_of_the_last_origin_come_first(tmp_path):
    files = {
        f"{root}/{name}/msg/Bool.msg": "" for root, name in (("a", "z"), ("a", "b"), ("c", "y"))
    }
    make_files(tmp_path, files)
    have = sources(tmp_path / "a", tmp_path / "c")
    assert have.packages_of["msg", "Bool"] == ["std_msgs", "y", "b", "z"]


def test_a_byte_that_is_no_text_is_at_its_character(tmp_path):
    make_files(tmp_path, {"p/msg/A.msg": ""})
    (tmp_path / "p/msg/A.msg").write_bytes("# \u00e9\u4e2d\nint8 \u00e9".encode() + b"\xff b\n")
    with pytest.raises(DefinitionError) as error:
        sources(tmp_path).find("p", "msg", "A")
    (problem,) = error.value.diagnostics
    assert str(problem).startswith(f"{tmp_path}/p/msg/A.msg:2:7: error: byte 0xff is not UTF-8")
    # The byte has a place in the line that is shown, and is all that is marked.
    assert str(problem).splitlines()[1:] == ["int8 \u00e9\ufffd b", "      ^"]


def test_a_sequence_of_bytes_that_is_cut_off_is_shown_by_its_first(tmp_path):
    make_files(tmp_path, {"p/msg/A.msg": ""})
    (tmp_path / "p/msg/A.msg").write_bytes(b"int8 a\n\xe4\xb8 b\n")
    with pytest.raises(DefinitionError, match=r"A\.msg:2:1: error: byte 0xe4 is not UTF-8 text"):
        sources(tmp_path).find("p", "msg", "A")


def test_types_of_a_package_are_sorted_with_messages_first(tmp_path):
    files = ["action/B.action", "msg/Z.msg", "srv/C.srv", "msg/Y.msg", "action/A.action"]
    make_files(tmp_path, {f"p/{file}": "" for file in files})
    assert Sources([FolderOrigin(tmp_path)]).types == {
        "p": [("msg", "Y"), ("msg", "Z"), ("srv", "C"), ("action", "A"), ("action", "B")]
    }


def test_files_have_at_most_four_mebibytes(tmp_path):
    make_files(tmp_path, {"p/msg/A.msg": "#" * (1 << 22), "p/msg/B.msg": "#" * ((1 << 22) + 1)})
    have = sources(tmp_path)
    assert len(have.find("p", "msg", "A").source.text) == 1 << 22
    with pytest.raises(DefinitionError, match=r"B\.msg' cannot be read"):
        have.find("p", "msg", "B")
