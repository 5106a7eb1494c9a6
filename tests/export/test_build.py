"""Built folders: complete or absent, and identical on every machine."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, Built, build
from firm_hdl.export.options import Options
from firm_hdl.frontend import Library
from tests.depth import by_depth
from tests.export.conftest import hollow_converters
from tests.export.test_sample import SAMPLE, files

ROOT = Path(firm_hdl.__file__).parent.parent


def tree(folder: Path) -> dict[str, bytes]:
    """Return every file below a folder."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def build_one(out: Path, type_: str = "std_msgs/msg/Bool", **options: object) -> Built:
    """Build a type; other arguments go to `Library` or `Options`."""
    library = Library("lyrical", options.pop("paths", ()))
    rest = {name: options.pop(name) for name in ("force", "stimuli") if name in options}
    [built] = build([type_], out, library=library, options=Options(**options), **rest)
    return built


@pytest.mark.usefixtures("hollow")
def test_without_a_folder_the_output_is_in_vhdl_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (built,) = build(("std_msgs/msg/Bool",))
    assert built.folder.parts[:2] == ("vhdl_out", Library().distro)
    assert [path.name for path in tmp_path.iterdir()] == ["vhdl_out"]
    assert (tmp_path / built.folder / "manifest.json").is_file()


def test_folder_is_complete(tmp_path):
    seen: list[Built] = []
    built = build(
        ["geometry_msgs/msg/Twist", "geometry_msgs/Twist"], tmp_path / "out", report=seen.append
    )
    assert seen == built
    assert [one.folder for one in built] == [
        tmp_path / "out" / "lyrical" / "geometry_msgs_msg_Twist_cdr_8"
    ]
    # The committed sample has the packets, too.
    assert {*tree(built[0].folder)} == {*files(SAMPLE)} - {"vhdl/stimuli.txt"}


def test_vhdl_compiles_in_the_order_of_the_manifest_and_stimuli_are_the_callers(
    tmp_path, monkeypatch
):
    options = {"stimuli": lambda message, plan: [b"\x00\x01\x00\x00\x01"]}
    built = build_one(tmp_path, **options)
    vhdl = json.loads((built.folder / "manifest.json").read_text())["vhdl"]
    there = {path.name for path in (built.folder / "vhdl").glob("*.vhd")}
    listed = [*vhdl["files"], *vhdl["bench"]["files"]]
    assert there == {*listed}
    for place, name in enumerate(listed):
        text = (built.folder / "vhdl" / name).read_text()
        for later in listed[place:]:
            assert f"use work.{later.removesuffix('.vhd')}." not in text
            assert f"entity work.{later.removesuffix('.vhd')}\n" not in text
    assert (built.folder / "vhdl" / "run_ghdl.sh").stat().st_mode & 0o111
    assert (built.folder / "vhdl" / "stimuli.txt").read_text().splitlines()[1:] == ["0001000001"]
    assert build_one(tmp_path, **options).was_current
    hollow_converters(monkeypatch)
    assert not build_one(tmp_path).was_current
    assert not (built.folder / "vhdl" / "stimuli.txt").exists()


@pytest.mark.usefixtures("hollow")
def test_files_that_users_added_stay(tmp_path):
    built = build_one(tmp_path)
    (built.folder / "notes.txt").write_text("mine")
    (built.folder / "sim").mkdir()
    (built.folder / "sim" / "run.do").write_text("run")
    (built.folder / "vhdl" / "mine.vhd").write_text("mine")
    (built.folder / "vhdl" / "work").mkdir()
    (built.folder / "vhdl" / "work" / "results.txt").write_text("00")
    build_one(tmp_path, force=True)
    assert (built.folder / "vhdl" / "mine.vhd").read_text() == "mine"
    assert (built.folder / "vhdl" / "work" / "results.txt").read_text() == "00"
    assert (built.folder / "notes.txt").read_text() == "mine"
    assert (built.folder / "sim" / "run.do").read_text() == "run"
    assert sorted(path.name for path in built.folder.parent.iterdir()) == [built.folder.name]


@pytest.mark.usefixtures("hollow")
def test_folder_of_another_program_is_refused(tmp_path):
    folder = tmp_path / "lyrical" / "std_msgs_msg_Bool_cdr_8"
    folder.mkdir(parents=True)
    (folder / "thesis.tex").write_text("ten years")
    with pytest.raises(BuildError, match=r"is not a folder that firm-hdl made; move it away$"):
        build_one(tmp_path)
    assert tree(tmp_path) == {"lyrical/std_msgs_msg_Bool_cdr_8/thesis.tex": b"ten years"}


@pytest.mark.parametrize("place", ["lyrical", "lyrical/std_msgs_msg_Bool_cdr_8"])
@pytest.mark.usefixtures("hollow")
def test_a_link_below_the_output_is_not_followed(tmp_path, place):
    """Such as one in a cloned repository, to a folder that is the user's."""
    (tmp_path / "home").mkdir()
    (tmp_path / "out" / place).parent.mkdir(parents=True)
    (tmp_path / "out" / place).symlink_to(tmp_path / "home")
    name = Path(place).name
    with pytest.raises(BuildError, match=rf"cannot be written: a link, .* \('{name}'\)$"):
        build_one(tmp_path / "out")
    assert [*(tmp_path / "home").iterdir()] == []


@pytest.mark.usefixtures("hollow")
def test_a_changed_file_is_kept_and_named(tmp_path):
    built = build_one(tmp_path)
    (built.folder / "vhdl" / "files.txt").write_text("mine")
    for options in ({"force": True}, {"max_message_bytes": 1000}):
        with pytest.raises(BuildError, match=r"has files of yours, .*: vhdl/files\.txt$"):
            build_one(tmp_path, **options)
    assert (built.folder / "vhdl" / "files.txt").read_text() == "mine"


def test_wrong_types_change_no_file_and_are_all_reported(tmp_path):
    with pytest.raises(DefinitionError) as caught:
        build(["std_msgs/msg/Bool", "std_msgs/msg/Boo", "nothing/msg/Here"], tmp_path / "out")
    assert [diagnostic.message for diagnostic in caught.value.diagnostics] == [
        "type 'Boo' is not defined in package 'std_msgs'; did you mean 'std_msgs/msg/Bool'?",
        "package 'nothing' is not found; --path names a folder that has it (in a node: 'paths')",
    ]
    assert not (tmp_path / "out").exists()


def test_type_that_amaranth_cannot_elaborate_is_refused_before_writing(tmp_path):
    folder = tmp_path / "src" / "big_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Big.msg").write_text("".join(f"uint8[] f{k}\n" for k in range(120)))
    with pytest.raises(BuildError) as caught:
        build(
            ["std_msgs/msg/Bool", "big_msgs/msg/Big"],
            tmp_path / "out",
            library=Library("lyrical", [tmp_path / "src"]),
            options=Options(bus_bytes=64),
        )
    assert str(caught.value) == (
        "big_msgs/msg/Big: its serializer has 65644 input bits on a bus of 64 bytes, "
        "and Amaranth elaborates at most 65535"
    )
    assert not (tmp_path / "out").exists()


def test_output_is_the_same_everywhere(tmp_path):
    types = by_depth(["std_msgs/msg/UInt8"], ["sensor_msgs/msg/JointState", "std_msgs/msg/Empty"])
    build(types, tmp_path / "a" / "out")
    # Another process, with other hashes of texts, in another folder and language.
    home = tmp_path / "b" / "c"
    home.mkdir(parents=True)
    script = f"import sys; from firm_hdl.export.build import build\nbuild({types}, sys.argv[1])"
    environment = {**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": str(ROOT), "LC_ALL": "C"}
    command = [sys.executable, "-c", script, "out"]
    subprocess.run(command, cwd=home, env=environment, check=True)
    trees = [tree(tmp_path / "a" / "out"), tree(home / "out")]
    folders = {f"{name.replace('/', '_')}_cdr_8" for name in types}
    assert {name.split("/")[1] for name in trees[0]} == folders
    assert len(trees[0]) >= 18 * len(types)
    assert trees[0] == trees[1]
    for text in trees[0].values():
        assert str(ROOT).encode() not in text
        assert str(tmp_path).encode() not in text


@pytest.mark.usefixtures(by_depth("hollow", "tmp_path"))
def test_several_processes_write_the_same_files(tmp_path):
    types = ["std_msgs/msg/Empty", *by_depth([], ["std_msgs/msg/String"]), "std_msgs/msg/Bool"]
    reported = []
    for jobs in (1, 2):
        built = build(types, tmp_path / str(jobs), jobs=jobs, report=reported.append)
        assert [each.name for each in built] == types
    assert sorted(each.name for each in reported) == sorted(2 * types)
    assert tree(tmp_path / "1") == tree(tmp_path / "2")
