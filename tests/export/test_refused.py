"""What a build refuses before it writes a file, and what it makes of processes that end early."""

from __future__ import annotations

import importlib
import json

import pytest

from firm_hdl.export.backend import Options
from firm_hdl.export.build import BuildError, build, check_size
from firm_hdl.frontend import Library
from firm_hdl.jobs.executors import ExecutorError
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.export.test_build import build_one, tree
from tests.frontend.workspace import library

# The package's face has a function of this name.
build_module = importlib.import_module("firm_hdl.export.build")

TYPES = ["std_msgs/msg/Empty", "std_msgs/msg/String", "std_msgs/msg/Bool"]


def test_the_most_input_bits_are_those_of_the_wider_converter(monkeypatch):
    # A deserializer of a Bool on a bus of 8 bytes: clock, reset, data, keep, last and valid of the
    # packets, and ready of the field and of the status.
    bits = 1 + 1 + 64 + 8 + 1 + 1 + 1 + 1
    plan = build_plan(lay_out(Library().message("std_msgs/msg/Bool")), bus_bytes=8)
    monkeypatch.setattr(build_module, "MAX_INPUT_BITS", bits)
    check_size(plan)
    monkeypatch.setattr(build_module, "MAX_INPUT_BITS", bits - 1)
    with pytest.raises(BuildError, match=rf"its deserializer has {bits} input bits"):
        check_size(plan)


def test_folders_that_differ_only_in_case_are_refused(tmp_path):
    folder = tmp_path / "src" / "my_msgs" / "msg"
    folder.mkdir(parents=True)
    for name in ("Imu", "IMU"):
        (folder / f"{name}.msg").write_text("bool x\n")
    library = Library("lyrical", [tmp_path / "src"])
    with pytest.raises(BuildError, match=r"is also that of my_msgs/msg/IMU$"):
        build(["my_msgs/msg/IMU", "my_msgs/msg/Imu"], tmp_path / "out", library=library)
    assert not (tmp_path / "out").exists()


@pytest.mark.usefixtures("quick")
def test_the_folder_of_another_type_is_refused_and_an_empty_one_is_not(tmp_path):
    folder = tmp_path / "lyrical" / "std_msgs_msg_Bool_cdr_8"
    folder.mkdir(parents=True)
    built = build_one(tmp_path)
    assert built.folder == folder and not built.was_current
    manifest = json.loads((folder / "manifest.json").read_text())
    manifest["inputs"]["message"] = "std_msgs_msg/Bool"
    (folder / "manifest.json").write_text(json.dumps(manifest))
    before = tree(tmp_path)
    with pytest.raises(BuildError, match=r"is the folder of std_msgs_msg/Bool$"):
        build_one(tmp_path, force=True)
    assert tree(tmp_path) == before


@pytest.mark.usefixtures("quick")
def test_folders_are_returned_in_the_order_of_the_types_whichever_ends_first(tmp_path, monkeypatch):
    def backwards(work, items, jobs):
        assert jobs == 3
        yield from ((number, work(*given)) for number, given in reversed(items))

    monkeypatch.setattr(build_module, "run_each", backwards)
    reported = []
    built = build(TYPES, tmp_path, jobs=3, report=reported.append)
    assert [each.name for each in built] == TYPES
    assert [each.name for each in reported] == TYPES[::-1]
    # Other processes are asked to write what is current, too.
    for force in (False, True):
        again = build(TYPES, tmp_path, jobs=3, force=force)
        assert [each.was_current for each in again] == [not force] * 3


def test_a_process_that_died_makes_the_build_fail(tmp_path, monkeypatch):
    def died(work, items, jobs):
        yield 1, ExecutorError("the process died")

    monkeypatch.setattr(build_module, "run_each", died)
    with pytest.raises(BuildError, match=r"^std_msgs/msg/String: the process died$"):
        build(TYPES, tmp_path, jobs=2)


# `A` and `B` have types whose VHDL packages have the same name.
SIMILAR = {
    "p/Inner": "uint8 x\n",
    "p/INNER": "uint16 x\n",
    "p/A": "Inner a\n",
    "p/B": "INNER b\n",
}


@pytest.mark.usefixtures("quick")
def test_flat_ports_need_no_packages_so_none_of_them_meet(tmp_path):
    similar = library(tmp_path / "src", SIMILAR, "ros1")
    with pytest.raises(BuildError, match="the VHDL package 'p_inner_ros1_8_pkg' would be"):
        build(["p/A", "p/B"], tmp_path / "out", library=similar)
    flat = Options(ports="flat")
    assert len(build(["p/A", "p/B"], tmp_path / "out", library=similar, options=flat)) == 2


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    ("folder", "message", "fails"),
    [
        ("p_B_ros1_8", "p/INNER", True),
        ("p_B_ros1_8", "p/Inner", False),
        # What a killed build has left is no folder of a type.
        (".firm-hdl.0123456789abcdef.0123456789abcdef.new", "p/INNER", False),
    ],
)
def test_folders_of_types_beside_a_new_one_count(tmp_path, folder, message, fails):
    beside = tmp_path / "noetic" / folder
    (beside / "vhdl").mkdir(parents=True)
    (beside / "vhdl" / "p_inner_ros1_8_pkg.vhd").write_text("")
    # Names of other packages say nothing about this one.
    shared = [("p_other_ros1_8_pkg", "p/Other"), ("p_inner_ros1_8_pkg", message)]
    section = {"shared_packages": [{"name": name, "message": type_} for name, type_ in shared]}
    manifest = {"inputs_sha256": "", "inputs": {}, "files": {}, "vhdl": section}
    (beside / "manifest.json").write_text(json.dumps(manifest))
    options = {"library": library(tmp_path / "src", SIMILAR, "ros1")}
    if fails:
        with pytest.raises(BuildError, match=rf"but in '.*{folder}' it is that of p/INNER; build"):
            build(["p/A"], tmp_path, **options)
    else:
        assert len(build(["p/A"], tmp_path, **options)) == 1
