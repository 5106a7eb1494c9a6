"""Built folders: complete or absent, and identical on every machine."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl.errors import DefinitionError
from firm_hdl.export.backend import Options
from firm_hdl.export.build import BuildError, Built, build
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan, from_yaml
from firm_hdl.wire import lay_out
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


FILES_OF_TWIST = """
geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.v
geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.veo
geometry_msgs_msg_Twist_cdr_8_serializer_verilog.v
geometry_msgs_msg_Twist_cdr_8_serializer_verilog.veo
layout.svg
manifest.json
plan.yaml
systemverilog/files.f
systemverilog/firm_hdl_bus_8_sv_pkg.sv
systemverilog/firm_hdl_sv_pkg.sv
systemverilog/geometry_msgs_msg_Twist_cdr_8_deserializer_sv.sv
systemverilog/geometry_msgs_msg_Twist_cdr_8_serializer_sv.sv
systemverilog/geometry_msgs_msg_twist_cdr_8_sv_pkg.sv
systemverilog/geometry_msgs_msg_vector3_cdr_8_sv_pkg.sv
systemverilog/waivers.vlt
vhdl/Makefile
vhdl/bench_files.txt
vhdl/files.txt
vhdl/firm_hdl_axis_sink.vhd
vhdl/firm_hdl_axis_source.vhd
vhdl/firm_hdl_bench.core
vhdl/firm_hdl_bench_pkg.vhd
vhdl/firm_hdl_bus_8_pkg.core
vhdl/firm_hdl_bus_8_pkg.vhd
vhdl/firm_hdl_common.core
vhdl/firm_hdl_pkg.vhd
vhdl/firm_hdl_types_pkg.vhd
vhdl/geometry_msgs_msg_twist_cdr_8.core
vhdl/geometry_msgs_msg_twist_cdr_8_components_pkg.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_flat.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_flat_core.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_mover.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer_byte_flags.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_buffer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_mover.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_queue.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer_byte_flags.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_pkg.core
vhdl/geometry_msgs_msg_twist_cdr_8_pkg.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_record_tb.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_flat.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_flat_core.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_flat_core_collector.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_record.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_record_flat.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_collector.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_packer.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_serializer_record_flat_record.vhd
vhdl/geometry_msgs_msg_twist_cdr_8_tb.vhd
vhdl/geometry_msgs_msg_vector3_cdr_8_pkg.core
vhdl/geometry_msgs_msg_vector3_cdr_8_pkg.vhd
vhdl/run_ghdl.sh
vhdl/vivado.tcl
waivers.vlt
"""
"""All files of Twist with default options."""


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
    # The committed sample lists them; it also has the files that need packets.
    with_packets = {
        "vhdl/stimuli.txt",
        "vhdl/tb_geometry_msgs_msg_twist_cdr_8_vunit.vhd",
        "vhdl/vunit_run.py",
    }
    found = {*tree(built[0].folder)}
    assert {*files(SAMPLE)} - found == with_packets
    assert found <= {*files(SAMPLE)}
    # A removed file must be removed here as well as in the sample.
    assert set(FILES_OF_TWIST.split()) - found == set()


def test_vhdl_compiles_in_the_order_of_the_manifest_and_stimuli_are_the_callers(
    tmp_path, monkeypatch
):
    options = {"stimuli": lambda message, plan: [b"\x00\x01\x00\x00\x01"]}
    built = build_one(tmp_path, **options)
    vhdl = json.loads((built.folder / "manifest.json").read_text())["vhdl"]
    there = {path.name for path in (built.folder / "vhdl").glob("*.vhd")}
    listed = [*vhdl["files"], *vhdl["bench"]["files"]]
    assert there == {*listed, "tb_std_msgs_msg_bool_cdr_8_vunit.vhd"}
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


@pytest.mark.usefixtures("quick")
def test_plan_and_picture_read_back(tmp_path):
    built = build_one(tmp_path, "sensor_msgs/msg/PointCloud2")
    plan = build_plan(lay_out(Library().message("sensor_msgs/msg/PointCloud2")))
    assert from_yaml((built.folder / "plan.yaml").read_text()) == plan
    picture = ElementTree.fromstring((built.folder / "layout.svg").read_text())
    texts = [element.text for element in picture.iter("{http://www.w3.org/2000/svg}text")]
    for text in ("fields.item.name.length uint32", "data: length x uint8", "fields: length times"):
        assert text in texts


@pytest.mark.usefixtures("quick")
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


@pytest.mark.usefixtures("quick")
def test_folder_of_another_program_is_refused(tmp_path):
    folder = tmp_path / "lyrical" / "std_msgs_msg_Bool_cdr_8"
    folder.mkdir(parents=True)
    (folder / "thesis.tex").write_text("ten years")
    with pytest.raises(BuildError, match=r"is not a folder that firm-hdl made; move it away$"):
        build_one(tmp_path)
    assert tree(tmp_path) == {"lyrical/std_msgs_msg_Bool_cdr_8/thesis.tex": b"ten years"}


@pytest.mark.parametrize("place", ["lyrical", "lyrical/std_msgs_msg_Bool_cdr_8"])
@pytest.mark.usefixtures("quick")
def test_a_link_below_the_output_is_not_followed(tmp_path, place):
    """Such as one in a cloned repository, to a folder that is the user's."""
    (tmp_path / "home").mkdir()
    (tmp_path / "out" / place).parent.mkdir(parents=True)
    (tmp_path / "out" / place).symlink_to(tmp_path / "home")
    name = Path(place).name
    with pytest.raises(BuildError, match=rf"cannot be written: a link, .* \('{name}'\)$"):
        build_one(tmp_path / "out")
    assert [*(tmp_path / "home").iterdir()] == []


@pytest.mark.usefixtures("quick")
def test_a_changed_file_is_kept_and_named(tmp_path):
    built = build_one(tmp_path)
    (built.folder / "plan.yaml").write_text("mine")
    for options in ({"force": True}, {"max_message_bytes": 1000}):
        with pytest.raises(BuildError, match=r"has files of yours, .*: plan\.yaml$"):
            build_one(tmp_path, **options)
    assert (built.folder / "plan.yaml").read_text() == "mine"


def test_wrong_types_change_no_file_and_are_all_reported(tmp_path):
    with pytest.raises(DefinitionError) as caught:
        build(["std_msgs/msg/Bool", "std_msgs/msg/Boo", "nothing/msg/Here"], tmp_path / "out")
    assert [diagnostic.message for diagnostic in caught.value.diagnostics] == [
        "type 'Boo' is not defined in package 'std_msgs'; did you mean 'std_msgs/msg/Bool'?",
        "package 'nothing' is not found",
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
    types = by_depth(
        ["std_msgs/msg/MultiArrayDimension"], ["sensor_msgs/msg/JointState", "std_msgs/msg/Empty"]
    )
    build(types, tmp_path / "a" / "out")
    # Another process, with other hashes of texts, in another folder and language.
    home = tmp_path / "b" / "c"
    home.mkdir(parents=True)
    script = f"import sys; from firm_hdl.export import build\nbuild({types}, sys.argv[1])"
    environment = {**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": str(ROOT), "LC_ALL": "C"}
    command = [sys.executable, "-c", script, "out"]
    subprocess.run(command, cwd=home, env=environment, check=True)
    trees = [tree(tmp_path / "a" / "out"), tree(home / "out")]
    folders = {f"{name.replace('/', '_')}_cdr_8" for name in types}
    assert {name.split("/")[1] for name in trees[0]} == folders
    # Another back end adds files, and removes none.
    assert len(trees[0]) >= 45 * len(types)
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
