"""What a build refuses before it writes a file, and what it makes of processes that end early."""

from __future__ import annotations

import json

import pytest

from firm_hdl.export.build import BuildError, build
from firm_hdl.export.options import Options
from firm_hdl.frontend import Library
from tests.export.test_build import build_one, tree
from tests.frontend.workspace import library


def test_folders_that_differ_only_in_case_are_refused(tmp_path):
    folder = tmp_path / "src" / "my_msgs" / "msg"
    folder.mkdir(parents=True)
    for name in ("Imu", "IMU"):
        (folder / f"{name}.msg").write_text("bool x\n")
    library = Library("lyrical", [tmp_path / "src"])
    with pytest.raises(BuildError, match=r"is also that of my_msgs/msg/IMU$"):
        build(["my_msgs/msg/IMU", "my_msgs/msg/Imu"], tmp_path / "out", library=library)
    assert not (tmp_path / "out").exists()


@pytest.mark.usefixtures("hollow")
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


# `A` and `B` have types whose VHDL packages have the same name.
SIMILAR = {
    "p/Inner": "uint8 x\n",
    "p/INNER": "uint16 x\n",
    "p/A": "Inner a\n",
    "p/B": "INNER b\n",
}


@pytest.mark.usefixtures("hollow")
def test_flat_ports_need_no_packages_so_none_of_them_meet(tmp_path):
    similar = library(tmp_path / "src", SIMILAR, "ros1")
    with pytest.raises(BuildError, match="the VHDL package 'p_inner_ros1_8_pkg' would be"):
        build(["p/A", "p/B"], tmp_path / "out", library=similar)
    flat = Options(ports="flat")
    assert len(build(["p/A", "p/B"], tmp_path / "out", library=similar, options=flat)) == 2


@pytest.mark.usefixtures("hollow")
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
