"""The search path of definitions, and its order."""

from __future__ import annotations

import os

import pytest

from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import open_library
from firm_hdl.frontend.search import workspace_folders

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
    assert where("p/B") == "two"
    assert where("p/A", root / "dir") == "dir"
    assert where("p/B", root / "dir") == "two"
    assert where("std_msgs/Bool") == "two"
    assert where("std_msgs/String") == "data"
    assert where("std_msgs/Bool", root / "dir") == "two"
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


@pytest.mark.parametrize(("fixture", "distro", "variable"), CASES)
def test_folders_of_packages_are_named_in_their_order(fixture, distro, variable, request):
    root = request.getfixturevalue(fixture)
    environment = {variable: os.pathsep.join([str(root / "two"), str(root / "one")])}
    inside = {"ros1": "", "ros2": "share/p"}[fixture]
    folders = [str(root / place / inside) for place in ("two", "one")]
    assert workspace_folders(distro, {"p"}, environment) == folders
    assert workspace_folders(distro, {"p"}, {}) == []
    assert workspace_folders(distro, {"no_msgs"}, environment) == []


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
