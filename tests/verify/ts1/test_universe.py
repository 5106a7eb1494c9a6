"""The definitions that oracles judge, and the files that oracles get."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.verify.ts1.universe import DefinitionCase, Universe, write_definitions
from tests.frontend.workspace import make_files

FILES = {
    "p/msg/A.msg": "q/B b\n",
    "p/msg/Both.msg": "int8 m\n",
    "p/srv/Both.srv": "int8 s\n---\n",
    "p/action/Both.action": "int8 a\n---\n---\n",
    "p/srv/S.srv": "int8 a\n---\n",
    "p/action/F.action": "int8 g\n---\n---\n",
    "q/msg/B.msg": "int8 x\n",
}


@pytest.fixture
def universe_of(tmp_path):
    def make(distro, files):
        (tmp_path / "src").mkdir()
        make_files(tmp_path / "src", files)
        return Universe(distro, [str(tmp_path / "src")])

    return make


def test_types_come_in_the_order_in_which_they_are_named_and_all_in_that_of_their_names(
    universe_of,
):
    universe = universe_of("lyrical", FILES)
    names = [case.spelled_name for case in universe.select(["q/B", "p/F", "p/A"])]
    assert names == ["q/msg/B", "p/action/F", "p/msg/A"]
    names = [case.spelled_name for case in universe.select([])]
    assert names == sorted(name.rpartition(".")[0] for name in FILES)


def test_definitions_of_an_active_workspace_come_after_those_of_the_folders(tmp_path, monkeypatch):
    files = {
        "own/p/msg/A.msg": "q/B b\nr/C c\nstd_msgs/Empty e\n",
        "own/q/msg/B.msg": "int8 own\n",
        "active/q/msg/B.msg": "int8 active\n",
        "active/r/msg/C.msg": "int8 active\n",
        "active/std_msgs/msg/Empty.msg": "int8 active\n",
        **{f"active/{name}/package.xml": f"<name>{name}</name>" for name in ("q", "std_msgs")},
    }
    make_files(tmp_path, files)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "active"))
    universe = Universe("noetic", [str(tmp_path / "own")], str(tmp_path / "all"))
    (case,) = universe.select(["p/A"])
    fields = {each.name: each.type.fields for each in universe.interface(case).fields}
    assert [[each.name for each in found] for found in fields.values()] == [
        ["own"],
        ["active"],
        ["active"],
    ]
    texts = [each.text for each in universe.select(["q/B", "r/C", "std_msgs/Empty"])]
    assert texts == ["int8 own\n", "int8 active\n", "int8 active\n"]
    # Without names, only the folders count. Oracles get the same definitions as we.
    assert [each.full_name for each in universe.select([])] == ["p/A", "q/B"]
    write_definitions(universe)
    for name, text in (
        ("q/msg/B", texts[0]),
        ("r/msg/C", texts[1]),
        ("std_msgs/msg/Empty", texts[2]),
    ):
        assert (tmp_path / "all" / f"{name}.msg").read_text() == text


def test_a_file_that_is_no_text_is_a_definition_as_well(universe_of, tmp_path):
    universe_of("lyrical", {"p/msg/A.msg": "int8 x\n"})
    folder = tmp_path / "src" / "p"
    (folder / "msg" / "Bad.msg").write_bytes(b"int8 \xff\n")
    (folder / "msg" / "Worse.idl").write_bytes(b"\xff\n")
    universe = Universe("lyrical", [str(folder.parent)])
    cases = {case.name: case for case in universe.select([])}
    assert {name: case.language for name, case in cases.items()} == {
        "A": "msg",
        "Bad": "msg",
        "Worse": "idl",
    }
    with pytest.raises(DefinitionError):
        universe.interface(cases["Bad"])


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_a_definition_without_any_text_is_an_error(universe_of, tmp_path, distro):
    """There is nothing that an oracle could be asked about."""
    universe_of(distro, {"p/msg/A.msg": "int8 x\n", "p/msg/B.msg": "p/A a\n"})
    file = tmp_path / "src" / "p" / "msg" / "A.msg"
    file.unlink()
    file.symlink_to("A.msg")
    universe = Universe(distro, [str(tmp_path / "src")], str(tmp_path / "all"))
    message = rf"^error: '{re.escape(str(file))}' cannot be read: .*symbolic links"
    for names in (["p/A"], []):
        with pytest.raises(DefinitionError, match=message):
            universe.select(names)
    # Other definitions can be judged nevertheless.
    write_definitions(universe)
    assert (tmp_path / "all/p/msg/B.msg").exists()
    assert [case.name for case in universe.select(["p/B"])] == ["B"]


def test_definitions_are_written_as_they_are_wherever_they_are_from(tmp_path):
    files = {
        "one/p/msg/A.msg": "int8 x\n",
        "one/p/msg/more/B.msg": "int8 y\n",
        "two/p/msg/A.msg": "int16 other\n",
        "two/p/msg/C.msg": "int8 z\n",
        "two/std_msgs/msg/Own.msg": "int8 own\n",
        "two/q/srv/S.srv": "int8 s\n---\n",
    }
    make_files(tmp_path, files)
    paths = [str(tmp_path / name) for name in ("one", "two")]
    universe = Universe("lyrical", paths, str(tmp_path / "all"))
    write_definitions(universe)
    folder = tmp_path / "all"
    texts = {path.name: path.read_text() for path in (folder / "p" / "msg").iterdir()}
    # The first folder with a package counts.
    assert texts == {"A.msg": "int8 x\n", "B.msg": "int8 y\n"}
    assert (folder / "std_msgs" / "msg" / "Own.msg").read_text() == "int8 own\n"
    assert not (folder / "std_msgs" / "msg" / "String.msg").exists()
    # A complete folder is linked.
    assert (folder / "q" / "srv").is_symlink()
    assert (folder / "q" / "srv" / "S.srv").read_text() == "int8 s\n---\n"
    for case in universe.select([]):
        assert (folder / case.package / case.kind / case.file).read_text() == case.text


def test_a_case_has_the_names_of_its_dialect():
    case = DefinitionCase(
        dialect="ros1", package="p", kind="srv", name="S", language="srv", text="a\n"
    )
    assert (case.full_name, case.spelled_name, case.file) == ("p/S", "p/srv/S", "S.srv")
    ros2 = replace(case, dialect="ros2", kind="msg", language="idl")
    assert (ros2.full_name, ros2.spelled_name, ros2.file) == ("p/msg/S", "p/msg/S", "S.idl")
    assert replace(case, source="other") == case
