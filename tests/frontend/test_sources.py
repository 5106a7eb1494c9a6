"""Finding packages in folders."""

from __future__ import annotations

import os
import sys

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend.sources import Sources

from .workspace import make_files


def found(*roots):
    """Names that folders add to a distribution."""
    have = Sources("lyrical", roots).types
    without = Sources("lyrical").types
    names = {(p, n) for p, ns in have.items() for n in ns}
    return sorted(names - {(p, n) for p, ns in without.items() for n in ns})


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


def test_only_msg_files_count(tmp_path):
    files = ["msg/A.msg.bak", "msg/a.txt", "msg/.msg", "A.msg", "msgs/A.msg", "srv/A.srv"]
    make_files(tmp_path, {f"pkg/{file}": "" for file in files})
    assert found(tmp_path) == []


@pytest.mark.parametrize(
    ("xml", "name"),
    [
        ("<package format='3'><name> real </name></package>", "real"),
        ("<?xml version='1.0'?>\n<package>\n  <name>real</name>\n</package>\n", "real"),
        ("<package><version>1</version></package>", "folder"),
        ("<package><name/></package>", "folder"),
        ("", "folder"),
        ("<pack", "folder"),
    ],
)
def test_package_xml_names_the_package(tmp_path, xml, name):
    make_files(tmp_path, {"folder/package.xml": xml, "folder/msg/A.msg": ""})
    assert found(tmp_path) == [(name, "A")]


@pytest.mark.parametrize("marker", ["AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"])
def test_ignored_folders_are_left_out(tmp_path, marker):
    make_files(tmp_path, {f"a/{marker}": "", "a/b/pkg/msg/A.msg": "", "other/msg/A.msg": ""})
    assert found(tmp_path) == [("other", "A")]
    make_files(tmp_path, {f"other/{marker}": ""})
    assert found(tmp_path) == []


def test_hidden_folders_are_left_out(tmp_path):
    make_files(tmp_path, {".git/pkg/msg/A.msg": "", "a/.hidden/pkg/msg/A.msg": ""})
    assert found(tmp_path) == []


def test_package_contains_no_other_package(tmp_path):
    make_files(tmp_path, {"pkg/package.xml": "<package><name>pkg</name></package>"})
    make_files(tmp_path, {"pkg/msg/A.msg": "", "pkg/test/fixture/msg/B.msg": ""})
    assert found(tmp_path) == [("pkg", "A")]


def test_link_to_a_folder_above_ends(tmp_path):
    make_files(tmp_path, {"ws/src/pkg/msg/A.msg": ""})
    (tmp_path / "ws/src/back").symlink_to(tmp_path)
    (tmp_path / "ws/src/loop").symlink_to(tmp_path / "ws/src/loop")
    assert found(tmp_path) == [("pkg", "A")]


def test_links_to_packages_are_followed(tmp_path):
    make_files(tmp_path, {"elsewhere/pkg/msg/A.msg": "", "ws/keep": ""})
    (tmp_path / "ws/pkg").symlink_to(tmp_path / "elsewhere/pkg")
    assert found(tmp_path / "ws") == [("pkg", "A")]


def test_first_path_wins_type_by_type(tmp_path):
    make_files(tmp_path, {"one/pkg/msg/A.msg": "# 1", "two/pkg/msg/A.msg": "# 2"})
    make_files(tmp_path, {"two/pkg/msg/B.msg": "# 2"})
    sources = Sources("lyrical", [tmp_path / "one", tmp_path / "two"])
    assert [sources.find("pkg", n).text for n in ("A", "B")] == ["# 1", "# 2"]
    sources = Sources("lyrical", [tmp_path / "two", tmp_path / "one"])
    assert [sources.find("pkg", n).text for n in ("A", "B")] == ["# 2", "# 2"]


def test_within_a_path_the_first_folder_by_name_wins(tmp_path):
    make_files(tmp_path, {"b/pkg/msg/A.msg": "# b", "a/z/pkg/msg/A.msg": "# a", "c/x": ""})
    assert Sources("lyrical", [tmp_path]).find("pkg", "A").text == "# a"


def test_folder_overrides_the_distribution_type_by_type(tmp_path):
    make_files(tmp_path, {"std_msgs/msg/Header.msg": "# mine", "std_msgs/msg/Extra.msg": ""})
    sources = Sources("lyrical", [tmp_path])
    assert sources.find("std_msgs", "Header").text == "# mine"
    assert sources.find("std_msgs", "String").name == "<rosbags lyrical>/std_msgs/msg/String.msg"
    assert "Extra" in sources.types["std_msgs"]
    assert sources.find("std_msgs", "Nothing") is None


def test_source_is_named_as_the_user_wrote_the_path(tmp_path, monkeypatch):
    make_files(tmp_path, {"ws/src/pkg/msg/A.msg": ""})
    monkeypatch.chdir(tmp_path)
    assert Sources("lyrical", ["ws"]).find("pkg", "A").name == "ws/src/pkg/msg/A.msg"


def test_text_is_kept_as_it_is(tmp_path):
    text = "# größe\r\nint32 a\rint32 b\n"
    make_files(tmp_path, {"pkg/msg/A.msg": text})
    assert Sources("lyrical", [tmp_path]).find("pkg", "A").text == text


def test_what_is_no_folder_is_refused(tmp_path):
    make_files(tmp_path, {"file": ""})
    with pytest.raises(DefinitionError) as error:
        Sources("lyrical", [f"{tmp_path}/file", tmp_path, f"{tmp_path}/none"])
    assert str(error.value) == (
        f"error: '{tmp_path}/file' is not a folder\nerror: '{tmp_path}/none' is not a folder"
    )


def test_file_that_cannot_be_read_is_reported(tmp_path):
    (tmp_path / "pkg/msg/A.msg").mkdir(parents=True)
    with pytest.raises(DefinitionError) as error:
        Sources("lyrical", [tmp_path]).find("pkg", "A")
    assert str(error.value) == (f"error: '{tmp_path}/pkg/msg/A.msg' cannot be read: Is a directory")


@pytest.mark.skipif(
    sys.platform == "win32" or os.geteuid() == 0, reason="this user may read everything"
)
def test_folder_that_cannot_be_read_is_passed_over(tmp_path):
    make_files(tmp_path, {"a/pkg/msg/A.msg": "", "b/pkg/msg/B.msg": ""})
    (tmp_path / "a").chmod(0)
    assert found(tmp_path) == [("pkg", "B")]
    (tmp_path / "a").chmod(0o700)


def test_scanning_reads_no_definition(tmp_path):
    for number in range(300):
        (tmp_path / f"p{number}/msg/A.msg").mkdir(parents=True)
    assert len(found(tmp_path)) == 300
