"""The VHDL files that are the same for every type, each analysed by itself."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl.export.primitives import TYPES_NAME
from firm_hdl.export.vhdl.bench import PARTS
from firm_hdl.vhdl.package import PACKAGE, PACKAGE_NAME

FOLDER = Path(firm_hdl.__file__).parent
TYPES = f"{TYPES_NAME}.vhd"
FILES = {
    "vhdl/firm_hdl_pkg.vhd",
    "export/vhdl/firm_hdl_types_pkg.vhd",
    "export/vhdl/firm_hdl_bench_pkg.vhd",
    "export/vhdl/firm_hdl_axis_source.vhd",
    "export/vhdl/firm_hdl_axis_sink.vhd",
}


def analyse(ghdl, place, paths):
    for path in paths:
        subprocess.run(
            [ghdl, "-a", "--std=08", "--warn-error", "-Wno-hide", str(path)],
            cwd=place,
            check=True,
            capture_output=True,
        )


def test_there_are_these_files_and_no_others():
    assert {str(path.relative_to(FOLDER)) for path in FOLDER.rglob("*.vhd")} == FILES
    assert (FOLDER / "vhdl" / f"{PACKAGE_NAME}.vhd").read_text() == PACKAGE
    assert {f"export/vhdl/{name}" for name in (*PARTS, TYPES)} | {"vhdl/firm_hdl_pkg.vhd"} == FILES


def test_ghdl_analyses_each_in_the_order_of_use_without_a_warning(ghdl, tmp_path):
    analyse(ghdl, tmp_path, [FOLDER / "vhdl" / "firm_hdl_pkg.vhd"])
    analyse(ghdl, tmp_path, [FOLDER / "export" / "vhdl" / name for name in (TYPES, *PARTS)])


def test_a_mistake_in_one_is_seen(ghdl, tmp_path):
    (tmp_path / "broken.vhd").write_text(PACKAGE.replace("return result;", "return resul;", 1))
    with pytest.raises(subprocess.CalledProcessError):
        analyse(ghdl, tmp_path, [tmp_path / "broken.vhd"])
