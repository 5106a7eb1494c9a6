"""The search path of definitions, and its order."""

from __future__ import annotations

import os
import re

import pytest

from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import all_names, load_all, open_library
from firm_hdl.frontend.search import workspace_folders

from .recordings import record
from .workspace import make_files


def named(where):
    """Return a definition whose field has the name of its place."""
    return f"int8 {where}\n"


@pytest.fixture
def ros1(tmp_path):
    """Workspaces of ROS 1, and a folder."""
    make_files(tmp_path, {"one/src/p/msg/A.msg": named("one"), "two/p/msg/A.msg": named("two")})
    make_files(tmp_path, {"two/p/msg/B.msg": named("two"), "dir/p/msg/A.msg": named("dir")})
    make_files(tmp_path, {"two/std_msgs/msg/Bool.msg": named("two"), "two/p/srv/S.srv": "---\n"})
    return tmp_path


@pytest.fixture
def ros2(tmp_path):
    """Prefixes of ROS 2, and a folder."""
    make_files(tmp_path, {"one/share/p/msg/A.msg": named("one")})
    make_files(tmp_path, {"two/share/p/msg/A.msg": named("two"), "two/src/q/msg/Q.msg": ""})
    make_files(tmp_path, {"two/share/p/msg/B.msg": named("two"), "dir/p/msg/A.msg": named("dir")})
    make_files(tmp_path, {"two/share/std_msgs/msg/Bool.msg": named("two")})
    make_files(tmp_path, {"two/share/p/srv/S.srv": "---\n", "two/share/doc/x/p/msg/C.msg": ""})
    return tmp_path


CASES = [("ros1", "noetic", "ROS_PACKAGE_PATH"), ("ros2", "lyrical", "AMENT_PREFIX_PATH")]


@pytest.mark.parametrize(("fixture", "distro", "variable"), CASES)
def test_folders_come_first_then_the_environment_then_the_distribution(
    fixture, distro, variable, request
):
    root = request.getfixturevalue(fixture)
    environment = {variable: os.pathsep.join([str(root / "one"), str(root / "two")])}

    def where(name, *paths):
        ours = open_library(distro, paths, environment=environment)
        return ours.message(name).fields[0].name

    assert where("p/A") == "one"
    assert where("p/A", root / "dir") == "dir"
    assert where("std_msgs/Bool") == "two"
    assert where("geometry_msgs/Point") == "x"
    assert where("std_msgs/Bool", root / "dir") == "two"
    # Of copies of a package, only the first counts.
    for name, first, second in (
        ("p/B", "one", "two"), ("p/srv/S", "one", "two"), ("std_msgs/String", "two", distro),
    ):  # fmt: skip
        with pytest.raises(DefinitionError) as error:
            where(name)
        taken, hides = re.search(
            "taken from '(.*)' and hides that of '(.*)'", str(error.value)
        ).groups()
        assert f"{root}/{first}" in taken and (f"{root}/{second}" in hides or second == hides)
    with pytest.raises(DefinitionError, match="hides that of"):
        where("p/B", root / "dir")
    environment = {}
    assert where("std_msgs/Bool") == "data"
    with pytest.raises(DefinitionError, match="package 'p' is not found"):
        where("p/A")


@pytest.mark.parametrize(("fixture", "distro", "variable"), CASES)
def test_services_are_found_and_other_folders_are_not(fixture, distro, variable, request):
    root = request.getfixturevalue(fixture)
    found = open_library(distro, environment={variable: str(root / "two")}).interfaces()
    own = [name for name in found if name.startswith(("p/", "q/"))]
    middle = "/" if distro == "noetic" else "/{}/"
    assert own == [
        f"p{middle.format(kind)}{name}" for kind, name in (("msg", "A"), ("msg", "B"), ("srv", "S"))
    ]
    both = os.pathsep.join([str(root / "one"), str(root / "two")])
    found = open_library(distro, environment={variable: both}).interfaces()
    assert [name for name in found if name.startswith("p/")] == own[:1]


@pytest.mark.parametrize(("fixture", "distro", "variable"), CASES)
def test_the_first_folder_of_a_package_is_that_of_the_workspace(fixture, distro, variable, request):
    root = request.getfixturevalue(fixture)
    environment = {variable: os.pathsep.join([str(root / "two"), str(root / "one")])}
    inside = {"ros1": "p", "ros2": "share/p"}[fixture]
    assert workspace_folders(distro, {"p"}, environment) == [str(root / "two" / inside)]
    assert workspace_folders(distro, {"p"}, {}) == []
    assert workspace_folders(distro, {"no_msgs"}, environment) == []
    # If it cannot be used, the error tells so.
    make_files(root, {f"two/copy/{inside}/msg/A.msg": ""})
    if fixture == "ros1":
        assert workspace_folders(distro, {"p"}, environment) == [str(root / "two")]


def test_an_index_of_ament_lists_packages_that_have_no_folder(ros2):
    """As in ROS, such a package hides the others."""
    index = "share/ament_index/resource_index/packages"
    make_files(ros2, {f"empty/{index}/p": "", "empty/share/ament_index/x/msg/A.msg": ""})
    both = os.pathsep.join([str(ros2 / "empty"), str(ros2 / "one")])
    ours = open_library("lyrical", environment={"AMENT_PREFIX_PATH": both})
    with pytest.raises(DefinitionError, match=f"taken from '{ros2}/empty/share/p' and hides"):
        ours.message("p/A")
    assert workspace_folders("lyrical", {"p"}, {"AMENT_PREFIX_PATH": both}) == []


@pytest.mark.parametrize(("fixture", "distro", "variable"), CASES)
def test_each_ros_has_its_own_variable(fixture, distro, variable, request):
    root = request.getfixturevalue(fixture)
    other = {"ROS_PACKAGE_PATH": "lyrical", "AMENT_PREFIX_PATH": "noetic"}[variable]
    ours = open_library(other, environment={variable: str(root / "two")})
    assert not [name for name in ours.interfaces() if name.startswith("p/")]


def test_entries_that_are_no_folders_are_left_out(ros1):
    (ros1 / "file").write_text("")
    entries = [str(ros1 / "none"), "", str(ros1 / "file"), str(ros1 / "one")]
    ours = open_library("noetic", environment={"ROS_PACKAGE_PATH": os.pathsep.join(entries)})
    assert ours.message("p/A").fields[0].name == "one"
    prefixes = {"AMENT_PREFIX_PATH": os.pathsep.join(entries)}
    assert "std_msgs/msg/Bool" in open_library("lyrical", environment=prefixes).names()


def test_commands_read_the_environment(ros2, monkeypatch, capsys):
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(ros2 / "one"))
    assert main(["show", "p/msg/A"]) == 0
    assert capsys.readouterr().out == "int8 one\n"
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    assert main(["show", "p/msg/A"]) == 1


def test_recordings_are_read_without_the_environment(ros2, monkeypatch):
    from .recordings import make_recording

    path = make_recording(ros2, "mcap")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(ros2 / "one"))
    assert "p/msg/A" not in open_library(bags=[path]).names()


@pytest.mark.parametrize(("fixture", "distro", "variable"), CASES)
def test_dependencies_come_after_the_folders_and_before_the_environment(
    fixture, distro, variable, request
):
    root = request.getfixturevalue(fixture)
    make_files(root, {"depends/p/msg/A.msg": "", "depends/q/msg/B.msg": named("depends")})
    make_files(root, {"two/share/q/msg/B.msg": ""})
    environment = {variable: str(root / "two")}
    ours = open_library(distro, [root / "dir"], depends=[root / "depends"], environment=environment)
    found = {name: ours.message(name).fields[0].name for name in ("p/A", "q/B", "std_msgs/Bool")}
    assert found == {"p/A": "dir", "q/B": "depends", "std_msgs/Bool": "two"}


def test_dependencies_come_after_the_recordings(tmp_path):
    path = record(tmp_path / "r", "p/msg/A", "int8 recorded\n")
    root = make_files(tmp_path / "ws", {"p/msg/A.msg": named("ws"), "p/msg/B.msg": named("ws")})
    ours = open_library(bags=[path], depends=[root])
    assert [ours.message(name).fields[0].name for name in ("p/A", "p/B")] == ["recorded", "ws"]


@pytest.mark.parametrize(("fixture", "distro", "variable"), CASES)
def test_an_environment_that_is_given_replaces_that_of_the_process(
    fixture, distro, variable, request, monkeypatch
):
    root = request.getfixturevalue(fixture)
    monkeypatch.setenv(variable, str(root / "one"))
    assert open_library(distro).message("p/A").fields[0].name == "one"
    assert len(workspace_folders(distro, {"p"})) == 1
    assert workspace_folders(distro, {"p"}, {}) == []
    with pytest.raises(DefinitionError, match="package 'p' is not found"):
        open_library(distro, environment={}).message("p/A")


def test_packages_with_services_or_actions_alone_are_found_in_the_order_of_their_names(tmp_path):
    make_files(tmp_path, {"share/c/action/C.action": "---\n---\n", "share/a/srv/A.srv": "---\n"})
    make_files(tmp_path, {"share/b/msg/B.msg": "", "share/d/include/D.msg": ""})
    environment = {"AMENT_PREFIX_PATH": str(tmp_path)}
    folders = workspace_folders("lyrical", {"d", "c", "b", "a"}, environment)
    assert folders == [str(tmp_path / "share" / name) for name in "abc"]
    ours = open_library("lyrical", environment=environment)
    assert ours.interface("c/C").name == "c/action/C"


def test_all_types_are_those_of_the_folders_if_there_are_any(ros1, monkeypatch):
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(ros1 / "one"))
    assert all_names("noetic", [ros1 / "dir", ros1 / "two"], ()) == ["p/A", "std_msgs/Bool"]
    assert all_names(None, [ros1 / "dir"], ()) == ["p/msg/A"]
    everywhere = all_names("noetic", (), ())
    assert "p/A" in everywhere and "std_msgs/String" in everywhere and "p/B" not in everywhere
    assert "std_msgs/msg/String" in all_names(None, (), ())


def test_all_types_of_recordings_are_those_in_them(tmp_path):
    one = record(tmp_path / "one", "p/msg/A", "int8 a\n")
    two = record(tmp_path / "two", "p/srv/S_Request", "int8 b\n")
    assert all_names(None, (), [one, two]) == ["p/msg/A", "p/srv/S_Request"]


def test_all_messages_of_all_types_are_loaded_once(tmp_path):
    files = {"p/srv/S.srv": "p/A a\n---\n", "p/msg/A.msg": "B b\n", "p/msg/B.msg": ""}
    ours = open_library("humble", [make_files(tmp_path, files)], environment={})
    found = load_all(ours, ["p/srv/S", "p/msg/A", "p/S", "p/srv/S_Response"])
    assert [each.name for each in found] == ["p/srv/S_Request", "p/srv/S_Response", "p/msg/A"]
    assert load_all(ours, []) == []


def test_errors_of_all_types_are_reported_with_those_of_every_message(tmp_path):
    idl = (
        "module p { module srv { struct S_Request { long a; }; "
        "struct S_Response { long b; long double c; }; }; };"
    )
    files = {"p/srv/S.idl": idl, "p/msg/A.msg": "int33 a\nint34 b\n", "p/msg/B.msg": "int33 a\n"}
    ours = open_library("humble", [make_files(tmp_path, files)], environment={})
    with pytest.raises(DefinitionError) as error:
        load_all(ours, ["p/A", "p/srv/S", "p/B", "p/A", "p/Nothing"])
    lines = [line for line in str(error.value).splitlines() if "error:" in line]
    places = [line.replace(f"{tmp_path}/", "").partition(": ")[0] for line in lines]
    assert places == [
        "p/msg/A.msg:1:1", "p/msg/A.msg:2:1", f"p/srv/S.idl:1:{idl.index('c;') + 1}",
        "p/msg/B.msg:1:1", "error",
    ]  # fmt: skip
