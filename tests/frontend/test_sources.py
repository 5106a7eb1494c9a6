"""The search for packages in folders."""

from __future__ import annotations

import os

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library, scan
from firm_hdl.frontend.names import TypeName
from firm_hdl.frontend.sources import EmbeddedOrigin, FolderOrigin, Sources

from .workspace import make_files


def sources(*roots):
    """Return the sources of some folders and of a distribution."""
    return Sources([*map(FolderOrigin, roots), EmbeddedOrigin("lyrical")])


def package(name):
    """Return the ``package.xml`` of a package."""
    return f"<package><name>{name}</name></package>"


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


@pytest.mark.parametrize("marker", ["AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"])
def test_a_folder_that_is_named_is_searched_even_if_colcon_leaves_it_out(tmp_path, marker):
    share = "install/p/share/p"
    make_files(tmp_path, {f"{share}/msg/A.msg": "", f"{share}/package.xml": package("p")})
    make_files(tmp_path, {f"install/{marker}": "", f"install/old/{marker}": ""})
    make_files(tmp_path, {"install/old/q/msg/A.msg": ""})
    assert found(tmp_path) == []
    assert found(tmp_path / "install") == [("p", "A")]
    assert found(tmp_path / "install/old") == [("q", "A")]


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
    scanned, listdir = [], os.listdir
    monkeypatch.setattr(os, "listdir", lambda folder: scanned.append(folder) or listdir(folder))
    assert found(tmp_path) == [("pkg", "A")]
    assert len(scanned) == len(["root", "ws", "src", "pkg", "msg"])


@pytest.mark.parametrize(
    "name", ["._A", ".#A", "#A#", "A~", "A (copy)", "A 2", "A(1)", "A.old", "A-1", "1A", "_A", "Ä"]
)
def test_files_whose_names_cannot_be_types_are_ignored(tmp_path, name):
    make_files(tmp_path, {f"p/msg/{name}.{ending}": "\x00" for ending in ("msg", "idl")})
    make_files(tmp_path, {f"p/srv/{name}.srv": "", "p/msg/A.msg": "# new"})
    assert found(tmp_path) == [("p", "A")]
    assert sources(tmp_path).find("p", "msg", "A").source.text == "# new"


def test_copies_of_hidden_files_are_no_copy_of_a_package(tmp_path):
    make_files(tmp_path, {"ws/p/msg/A.msg": "# A", "__MACOSX/ws/p/msg/._A.msg": "\x00"})
    assert sources(tmp_path).find("p", "msg", "A").source.text == "# A"


def test_links_to_packages_are_followed(tmp_path):
    make_files(tmp_path, {"elsewhere/pkg/msg/A.msg": "", "ws/keep": ""})
    (tmp_path / "ws/pkg").symlink_to(tmp_path / "elsewhere/pkg")
    assert found(tmp_path / "ws") == [("pkg", "A")]


def test_the_first_path_with_a_package_hides_the_others(tmp_path):
    make_files(tmp_path, {"one/pkg/msg/A.msg": "# 1", "two/pkg/msg/A.msg": "# 2"})
    make_files(tmp_path, {"two/pkg/msg/B.msg": "# 2", "two/other/msg/B.msg": "# 2"})
    one, two = tmp_path / "one", tmp_path / "two"
    have = sources(one, two)
    assert have.find("pkg", "msg", "A").source.text == "# 1"
    assert have.find("pkg", "msg", "B") is None and have.types["pkg"] == [("msg", "A")]
    assert have.find("other", "msg", "B").source.text == "# 2"
    have = sources(two, one)
    assert [have.find("pkg", "msg", n).source.text for n in ("A", "B")] == ["# 2", "# 2"]


def test_a_package_without_definitions_hides_others_too(tmp_path):
    make_files(tmp_path, {"one/p/package.xml": package("p"), "one/p/p/node.py": ""})
    make_files(tmp_path, {"two/p/msg/A.msg": "# 2"})
    assert found(tmp_path / "one", tmp_path / "two") == []
    assert found(tmp_path / "two", tmp_path / "one") == [("p", "A")]


@pytest.mark.parametrize("xml", [package("p"), None])
def test_two_copies_of_a_package_below_a_path_are_refused_with_both_places(tmp_path, xml):
    make_files(tmp_path, {"b/p/msg/A.msg": "# b", "a/z/p/msg/A.msg": "# a", "c/q/msg/B.msg": "# q"})
    make_files(tmp_path, {"b/p/srv/S.srv": "---", "b/p/sizes.idl": ""})
    if xml is not None:
        make_files(tmp_path, {"b/p/package.xml": xml, "a/z/p/package.xml": xml})
    have = sources(tmp_path)
    wanted = (
        f"error: package 'p' has 2 folders below '{tmp_path}': '{tmp_path}/a/z/p', "
        f"'{tmp_path}/b/p'; name one of them, or put a file COLCON_IGNORE into the others"
    )
    for kind, name in (("msg", "A"), ("srv", "S")):
        with pytest.raises(DefinitionError) as error:
            have.find("p", kind, name)
        assert str(error.value) == wanted
    with pytest.raises(DefinitionError):
        have.include("p/sizes.idl")
    assert list(map(str, have.problems)) == [wanted]
    assert have.find("q", "msg", "B").source.text == "# q"
    # Below a path of its own, each copy can be used, and a workspace is built with such a file.
    assert sources(tmp_path / "b", tmp_path).find("p", "msg", "A").source.text == "# b"
    make_files(tmp_path, {"a/COLCON_IGNORE": ""})
    assert sources(tmp_path).find("p", "msg", "A").source.text == "# b"


def test_what_a_catkin_build_adds_to_a_package_hides_nothing(tmp_path):
    make_files(tmp_path, {"src/p/package.xml": package("p"), "src/p/msg/A.msg": "# A"})
    make_files(tmp_path, {"devel/share/p/cmake/pConfig.cmake": ""})
    make_files(tmp_path, {"devel/share/p/msg/DoGoal.msg": "# Do", "devel/share/p/msg/A.msg": ""})
    src, devel = tmp_path / "src", tmp_path / "devel"
    for paths in ([tmp_path], [src, devel]):
        have = sources(*paths)
        assert [have.find("p", "msg", n).source.text for n in ("A", "DoGoal")] == ["# A", "# Do"]
        assert have.problems == []
    assert found(devel, src) == [("p", "A"), ("p", "DoGoal")]


def test_a_package_in_a_folder_hides_that_of_the_distribution(tmp_path):
    make_files(tmp_path, {"std_msgs/msg/Header.msg": "# mine", "std_msgs/msg/Extra.msg": ""})
    have = sources(tmp_path)
    assert have.find("std_msgs", "msg", "Header").source.text == "# mine"
    assert have.find("std_msgs", "msg", "String") is None
    assert have.types["std_msgs"] == [("msg", "Extra"), ("msg", "Header")]
    embedded = have.find("geometry_msgs", "msg", "Point")
    assert embedded.source.name == "<rosbags lyrical>/geometry_msgs/msg/Point.msg"


@pytest.mark.parametrize("xml", [package("p"), None])
def test_definitions_in_subfolders_belong_to_the_package(tmp_path, xml):
    files = ["msg/A.msg", "msg/a/b/B.msg", "srv/io/C.srv", "action/x/D.action", "msg/a/E.idl"]
    make_files(tmp_path, {f"p/{file}": f"# {file}" for file in files})
    # These are of other packages, of nobody, or for DDS.
    others = ["msg/.svn/F.msg", "msg/dds_connext/G_.idl", "msg/old/COLCON_IGNORE", "msg/old/H.msg"]
    others += [
        "msg/q/package.xml",
        "msg/q/I.msg",
        "msg/srv.txt/J.srv",
        "srv/io/K.msg",
        "other/L.msg",
    ]
    make_files(tmp_path, {f"p/{file}": "" for file in others})
    if xml is not None:
        make_files(tmp_path, {"p/package.xml": xml})
    origin = FolderOrigin(tmp_path)
    texts = {"/".join(name): origin.find(*name).source.text for name in origin.names()}
    assert texts == {
        "p/msg/A": "# msg/A.msg", "p/msg/B": "# msg/a/b/B.msg", "p/msg/E": "# msg/a/E.idl",
        "p/srv/C": "# srv/io/C.srv", "p/action/D": "# action/x/D.action",
    }  # fmt: skip
    have = sources(tmp_path)
    assert have.include("p/msg/E.idl").text == "# msg/a/E.idl"
    assert have.include("p/srv/C.idl").text == ""


def test_two_definitions_of_one_name_are_refused_with_both_places(tmp_path):
    make_files(tmp_path, {"p/srv/X.srv": "---", "p/srv/io/X.srv": "---", "p/srv/Y.srv": "# Y"})
    make_files(tmp_path, {"p/msg/x/X.msg": "# X", "p/msg/X.idl": ""})
    have = sources(tmp_path)
    with pytest.raises(DefinitionError) as error:
        have.find("p", "srv", "X")
    both = f"'{tmp_path}/p/srv/X.srv', '{tmp_path}/p/srv/io/X.srv'"
    assert str(error.value) == f"error: 'p/srv/X' has 2 definitions: {both}"
    assert [str(problem) for problem in have.problems] == [str(error.value)]
    assert have.find("p", "srv", "Y").source.text == "# Y"
    assert have.find("p", "msg", "X").source.text == "# X"
    # A link to the other file is no second definition.
    (tmp_path / "p/srv/io/X.srv").unlink()
    (tmp_path / "p/srv/io/X.srv").symlink_to("../X.srv")
    assert sources(tmp_path).find("p", "srv", "X").source.text == "---"


def test_links_in_a_package_lead_to_no_folder_above(tmp_path):
    make_files(tmp_path, {"ws/p/msg/A.msg": "# A", "ws/q/msg/B.msg": "", "shared/C.msg": ""})
    for name, place in (("up", ".."), ("all", "../.."), ("loop", "loop"), ("more", "more/x")):
        (tmp_path / "ws/p/msg" / name).symlink_to(place)
    (tmp_path / "ws/p/msg/shared").symlink_to(tmp_path / "shared")
    assert found(tmp_path / "ws") == [("p", "A"), ("p", "C"), ("q", "B")]
    assert sources(tmp_path / "ws").find("p", "msg", "A").source.text == "# A"


def test_a_folder_with_too_many_folders_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(scan, "MAX_FOLDERS", 8)
    make_files(tmp_path, {"a/b/c/d/p/msg/A.msg": ""})
    assert found(tmp_path) == [("p", "A")]
    make_files(tmp_path, {"a/b/c/d/p/msg/x/y/B.msg": ""})
    with pytest.raises(DefinitionError, match="has more than 8 folders: name a folder with fewer"):
        FolderOrigin(tmp_path)


def test_source_is_named_as_the_user_wrote_the_path(tmp_path, monkeypatch):
    make_files(tmp_path, {"ws/src/pkg/msg/A.msg": ""})
    monkeypatch.chdir(tmp_path)
    assert sources("ws").find("pkg", "msg", "A").source.name == "ws/src/pkg/msg/A.msg"


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


def test_search_goes_on_after_a_folder_that_cannot_be_read(tmp_path, monkeypatch):
    make_files(tmp_path, {"a/p/msg/A.msg": "", "b/q/msg/B.msg": "", "c/r/msg/C.msg": ""})
    listdir = os.listdir

    def refuse(folder):
        if os.path.basename(folder) == hidden:
            raise PermissionError(13, "Permission denied", folder)
        return listdir(folder)

    monkeypatch.setattr(os, "listdir", refuse)
    hidden = "b"
    assert found(tmp_path) == [("p", "A"), ("r", "C")]
    with pytest.raises(DefinitionError) as error:
        Library("lyrical", [tmp_path]).message("q/B")
    assert str(error.value) == (
        f"error: package 'q' is not found; '{tmp_path}/b' cannot be read, and may have it"
    )
    with pytest.raises(DefinitionError) as error:
        FolderOrigin(tmp_path / "b")
    assert str(error.value) == f"error: '{tmp_path}/b' cannot be read: Permission denied"
    make_files(tmp_path, {"a/p/msg/x/D.msg": ""})
    hidden = "x"
    ours = Library("lyrical", [tmp_path])
    assert ours.message("p/A").fields == ()
    with pytest.raises(DefinitionError) as error:
        ours.message("p/D")
    assert str(error.value) == (
        "error: type 'D' is not defined in package 'p'; "
        f"'{tmp_path}/a/p/msg/x' cannot be read, and may have it"
    )


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
    make_files(tmp_path, {"p/srv/A.srv": ""})
    names = [TypeName(*name, "ros2") for name in (("std_msgs", "msg", "Bool"), ("p", "srv", "A"))]
    assert sources(tmp_path).by_origin([*names, TypeName("p", "msg", "A", "ros2")]) == names[::-1]


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
