"""Scripts and core files for a folder's VHDL: tools accept them, and run the benches."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
import yaml

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.build import build
from firm_hdl.export.options import Options
from firm_hdl.export.packaging import cores, packaging
from tests.depth import by_depth
from tests.export.conftest import EVERYTHING
from tests.tools import need

ALL = Options(extras=EVERYTHING)
TYPES = ("geometry_msgs/msg/Vector3", "std_msgs/msg/Header")
VECTOR, HEADER = "geometry_msgs_msg_vector3_cdr_8", "std_msgs_msg_header_cdr_8"


@pytest.fixture(scope="module")
def folders(tmp_path_factory) -> list[Path]:
    """Folders of two types, one of them with a record view."""
    out = tmp_path_factory.mktemp("built")
    return [each.folder / "vhdl" for each in build(TYPES, out, stimuli=stimuli, options=ALL)]


def manifest_of(folder: Path) -> dict[str, Any]:
    found = json.loads((folder.parent / "manifest.json").read_text())
    assert isinstance(found, dict)
    return found


def copy_folder(folder: Path, to: Path) -> Path:
    shutil.copytree(folder.parent, to / folder.parent.name)
    return to / folder.parent.name / "vhdl"


def run(command: list[str], folder: Path) -> tuple[int, str]:
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    return done.returncode, done.stdout + done.stderr


def make_bench_fail(folder: Path) -> None:
    """Change the bench, so that it expects another byte than it sends."""
    script = folder / "firm_hdl_axis_sink.vhd"
    text = script.read_text()
    assert "assert got = byte_at" in text
    script.write_text(text.replace("assert got = byte_at", "assert got /= byte_at"))


def test_only_what_depends_on_definitions_names_the_distribution(folders):
    manifest = manifest_of(folders[1])
    other = {**manifest, "inputs": {**manifest["inputs"], "distro": "humble"}}
    assert manifest["inputs"]["distro"] != "humble"
    shared = {f"{each['name']}.core": each for each in manifest["vhdl"]["shared_packages"]}
    assert {bool(each["message"]) for each in shared.values()} == {False, True}
    one, two = packaging(manifest), packaging(other)
    for name in one:
        if name.endswith(".core"):
            is_of_bus = name in shared and not shared[name]["message"]
            is_common = name in ("firm_hdl_common.core", "firm_hdl_bench.core")
            assert (one[name] == two[name]) is (is_of_bus or is_common), name


# A message with a message in it, in the order in which files compile.
SECTION = {
    "name": "t",
    "ports": "records",
    "files": ["types.vhd", "bus.vhd", "part.vhd", "t_pkg.vhd", "t_flat.vhd", "t.vhd"],
    "common_files": ["types.vhd"],
    "shared_packages": [
        {"name": "bus", "file": "bus.vhd", "message": None, "needs": []},
        {"name": "part", "file": "part.vhd", "message": "p/Part", "needs": ["bus"]},
        {"name": "t_pkg", "file": "t_pkg.vhd", "message": "p/T", "needs": ["bus", "part"]},
    ],
    "bench": {
        "entity": "t_tb",
        "entities": ["t_tb", "t_record_tb"],
        "files": ["source.vhd", "sink.vhd", "t_tb.vhd", "t_record_tb.vhd"],
        "common_files": ["source.vhd", "sink.vhd"],
        "stimuli": "stimuli.txt",
    },
}
OPTIONS = {"wire": "cdr", "bus_bytes": 4}
INPUTS = {"message": "p/T", "distro": "humble", "options": OPTIONS, "generator": {"firm-hdl": "7"}}


def cores_of(**changes: object) -> dict[str, Any]:
    """Return the cores of FuseSoC by their files, for a section with changes."""
    made = cores({"inputs": INPUTS, "vhdl": {**SECTION, **changes}})
    assert all(text.startswith("CAPI=2:\n") for text in made.values())
    return {name: yaml.safe_load(text.partition("\n")[2]) for name, text in made.items()}


def test_each_core_has_its_own_files_and_depends_on_those_with_the_others():
    found = cores_of()
    parts = {
        (core["name"], name): (each.get("depend", []), each["files"])
        for core in found.values()
        for name, each in core["filesets"].items()
    }
    common, bus = "firm-hdl:vhdl:common:7", "firm-hdl:vhdl:bus:7"
    part, own, t = "firm-hdl:humble:part:7", "firm-hdl:humble:t_pkg:7", "firm-hdl:humble:t:7"
    bench = "firm-hdl:vhdl:bench:7"
    assert parts == {
        (common, "all"): ([], ["types.vhd"]),
        (bench, "all"): ([], ["source.vhd", "sink.vhd"]),
        (bus, "all"): ([common], ["bus.vhd"]),
        (part, "all"): ([common, bus], ["part.vhd"]),
        (own, "all"): ([common, bus, part], ["t_pkg.vhd"]),
        (t, "rtl"): ([common, bus, part, own], ["t_flat.vhd", "t.vhd"]),
        (t, "bench"): ([bench], ["t_tb.vhd", "t_record_tb.vhd"]),
        (t, "stimuli"): (
            [],
            [{"stimuli.txt": {"file_type": "user", "copyto": "stimuli.txt"}}],
        ),
    }
    targets = found["t.core"]["targets"]
    assert {name: each.get("toplevel") for name, each in targets.items()} == {
        "default": None,
        "sim": "t_tb",
        "sim_record": "t_record_tb",
    }
    assert targets["default"]["filesets"] == ["rtl"]
    assert targets["sim"]["filesets"] == ["rtl", "bench", "stimuli"]
    defaults = {name: each["default"] for name, each in found["t.core"]["parameters"].items()}
    assert defaults == {"seed": 1, "stalls": 40}


def test_lists_compile_in_their_order(ghdl, folders, tmp_path):
    for folder in folders:
        files = (folder / "files.txt").read_text().splitlines()
        bench = (folder / "bench_files.txt").read_text().splitlines()
        work = tmp_path / folder.parent.name
        work.mkdir()
        options = ["-a", "--std=08", f"--workdir={work}", "--warn-error"]
        assert run([ghdl, *options, *files, *bench], folder) == (0, "")
        # The order matters.
        other = tmp_path / f"{folder.parent.name}_other"
        other.mkdir()
        command = [ghdl, "-a", "--std=08", f"--workdir={other}", *reversed(files)]
        assert run(command, folder)[0] != 0


# The Vivado commands that the scripts use; a project knows its files.
STUBS = """\
set project {}
proc read_vhdl {args} { puts "read_vhdl $args"; lappend ::project [lindex $args end] }
proc get_files {option pattern} { return [lsearch -all -inline -glob $::project $pattern] }
foreach script $argv {
  if {$script eq "new_project"} { set project {} } else { source $script }
}
"""


def test_vivado_reads_everything_once_and_in_order(folders, tmp_path):
    tclsh = need("tclsh", shutil.which("tclsh"))
    (tmp_path / "stubs.tcl").write_text(STUBS)
    scripts = [str(folder / "vivado.tcl") for folder in folders]
    # A second project of the session gets all files again.
    status, output = run([tclsh, "stubs.tcl", *scripts, "new_project", *scripts], tmp_path)
    assert status == 0, output
    want = []
    for folder in folders:
        manifest = manifest_of(folder)["vhdl"]
        want += [
            f"read_vhdl -vhdl2008 {folder / name}"
            for name in manifest["files"]
            if not any(line.endswith(f"/{name}") for line in want)
        ]
    assert output.splitlines() == want * 2
    assert not [line for line in want if "_tb" in line or "axis_s" in line]


NASTY = "a \"b\" $c `d` 'e' \\f #g ;h %i [j] (k) & {l} *"


def test_scripts_run_in_a_folder_of_any_name(ghdl, folders, tmp_path):
    make = need("make", shutil.which("make"))
    (tmp_path / NASTY).mkdir()
    folder = copy_folder(folders[0], tmp_path / NASTY)
    status, output = run([make, f"GHDL={ghdl}"], folder)
    assert status == 0, output
    assert output.count("PASS geometry_msgs/msg/Vector3") == 2
    status, output = run([make, "lint"], folder)
    assert (status, output.count("warning")) == (0, 0), output
    # Run from another folder, with a work folder of the user's own.
    script = [str(folder / "run_ghdl.sh"), "-gstalls=0"]
    work = str(tmp_path / NASTY / "work")
    status, output = run(["env", f"WORK={work}", f"GHDL={ghdl}", *script], tmp_path)
    assert status == 0, output
    assert output.count("PASS geometry_msgs/msg/Vector3") == 1
    # Run again, now that the link exists.
    assert run(["env", f"WORK={work}", f"GHDL={ghdl}", *script], tmp_path)[0] == 0


def test_make_takes_the_ghdl_that_is_named(folders, tmp_path):
    make = need("make", shutil.which("make"))
    folder = copy_folder(folders[0], tmp_path)
    tool = tmp_path / "my ghdl"
    tool.write_text('#!/bin/sh\necho "$@" >>"$(dirname "$0")/asked"\n')
    tool.chmod(0o755)
    for target in ("lint", f"{VECTOR}_tb", f"{VECTOR}_record_tb"):
        assert run([make, target, f"GHDL={tool}", "SEED=5", "STALLS=6"], folder)[0] == 0
    lint, *benches = (tmp_path / "asked").read_text().splitlines()
    assert lint.startswith("-a --std=08 --workdir=work/lint --warn-error ")
    files = (folder / "files.txt").read_text() + (folder / "bench_files.txt").read_text()
    assert lint.endswith(f" {' '.join(files.split())}")
    for line, top in zip(benches[1::2], (f"{VECTOR}_tb", f"{VECTOR}_record_tb"), strict=True):
        assert line.startswith(f"--elab-run --std=08 {top} ")
        assert line.endswith(" -gseed=5 -gstalls=6")
    # Benches share a folder, so that even `make -j` runs one after the other.
    database = run([make, "--print-data-base", "--question"], folder)[1].splitlines()
    assert ".NOTPARALLEL:" in database


def test_make_runs_all_benches(ghdl, folders, tmp_path):
    make = need("make", shutil.which("make"))
    folder = copy_folder(folders[0], tmp_path)
    status, output = run([make, "SEED=3", "STALLS=0", f"GHDL={ghdl}"], folder)
    assert status == 0, output
    assert output.count("PASS geometry_msgs/msg/Vector3") == 2
    status, output = run([make, "lint", f"GHDL={ghdl}"], folder)
    assert (status, output.count("warning")) == (0, 0), output
    make_bench_fail(folder)
    status, output = run([make, f"GHDL={ghdl}"], folder)
    assert status != 0
    assert "FAIL packet 0" in output and "PASS" not in output
    assert run([make, "clean"], folder)[0] == 0
    assert not (folder / "work").exists()


def fusesoc() -> list[str]:
    need("FuseSoC", "here" if find_spec("fusesoc") else None)
    return [sys.executable, "-m", "fusesoc.main", "--cores-root", "."]


@pytest.mark.thorough
@pytest.mark.usefixtures("ghdl")
def test_fusesoc_runs_the_benches(folders, tmp_path):
    command = fusesoc()
    folder = copy_folder(folders[0], tmp_path)
    status, output = run([*command, "core", "list"], tmp_path)
    assert status == 0, output
    cores = ["lyrical:" + VECTOR, "vhdl:common", "vhdl:bench"]
    assert [output.count(f"firm-hdl:{name}:") for name in cores] == [1, 1, 1]
    core = f"firm-hdl:lyrical:{VECTOR}"
    for target, options, what in (
        ("sim", [], "geometry_msgs/msg/Vector3, cdr"),
        ("sim_record", ["--seed=4", "--stalls=0"], "geometry_msgs/msg/Vector3 record, cdr"),
    ):
        status, output = run([*command, "run", f"--target={target}", core, *options], tmp_path)
        assert status == 0, output
        assert output.count(f"PASS {what}") == 1
    assert "-gseed=4 -gstalls=0" in output
    make_bench_fail(folder)
    status, output = run([*command, "run", "--target=sim", core], tmp_path)
    assert status != 0
    assert "FAIL packet 0" in output and "PASS" not in output


USERS_CORE = f"""\
CAPI=2:
name: me:my:design:1.0
filesets:
  all:
    depend: ["firm-hdl:lyrical:{VECTOR}", "firm-hdl:lyrical:{HEADER}"]
    files: [design.vhd: {{file_type: vhdlSource-2008}}]
targets:
  default: {{filesets: [all]}}
  sim: {{filesets: [all], default_tool: ghdl, toplevel: design}}
"""
USERS_DESIGN = f"""\
library ieee;
use ieee.std_logic_1164.all;
use work.{VECTOR}_pkg.all;
use work.{VECTOR}_components_pkg.all;
entity design is end entity;
architecture sim of design is
  signal clk : std_logic := '0';
  signal vector : vector3_t;
  signal header : work.{HEADER}_pkg.header_t;
begin
  v : {VECTOR}_deserializer port map (
    aclk => clk, aresetn => '0', s_axis_tdata => (others => '0'), s_axis_tkeep => (others => '0'),
    s_axis_tlast => '0', s_axis_tvalid => '0', msg => vector, rdy => VECTOR3_ALL_READY,
    m_axis_status_tready => '1');
  h : work.{HEADER}_components_pkg.{HEADER}_deserializer port map (
    aclk => clk, aresetn => '0', s_axis_tdata => (others => '0'), s_axis_tkeep => (others => '0'),
    s_axis_tlast => '0', s_axis_tvalid => '0', msg => header,
    rdy => work.{HEADER}_pkg.HEADER_ALL_READY, m_axis_status_tready => '1');
  process begin
    clk <= '1';
    wait for 1 ns;
    report "BOTH " & to_string(vector.x.valid) & to_string(header.stamp.sec.valid);
    wait;
  end process;
end architecture;
"""


@pytest.mark.usefixtures("ghdl")
def test_fusesoc_takes_several_types_in_one_design(folders, tmp_path):
    command = fusesoc()
    for folder in folders:
        copy_folder(folder, tmp_path)
    (tmp_path / "design.core").write_text(USERS_CORE)
    (tmp_path / "design.vhd").write_text(USERS_DESIGN)
    status, output = run([*command, "run", "--target=sim", "me:my:design"], tmp_path)
    assert status == 0, output
    assert "BOTH 00" in output
    # Shared files are listed once.
    imported = next(line for line in output.splitlines() if "ghdl -i" in line)
    assert imported.count("firm_hdl_pkg.vhd") == imported.count("firm_hdl_types_pkg.vhd") == 1


@pytest.mark.usefixtures("ghdl")
@pytest.mark.thorough
def test_vunit_runs_the_benches(folders, tmp_path):
    need("VUnit", "here" if find_spec("vunit") else None)
    # The first folder has a record view, and so a second bench.
    place, tests = by_depth((1, 2), (0, 4))
    folder = copy_folder(folders[place], tmp_path)
    command = [sys.executable, "vunit_run.py", "--no-color", "-o", str(tmp_path / "vunit_out")]
    status, output = run(command, folder)
    assert status == 0, output
    assert f"pass {tests} of {tests}" in output
    make_bench_fail(folder)
    status, output = run(command, folder)
    assert status != 0
    assert f"fail {tests} of {tests}" in output


@pytest.mark.usefixtures("hollow")
def test_without_packets_nothing_runs_them(tmp_path):
    [built] = build(TYPES[:1], tmp_path, options=ALL)
    names = {path.name for path in (built.folder / "vhdl").iterdir()}
    assert "vunit_run.py" not in names and "stimuli.txt" not in names
    assert "sim" not in (built.folder / "vhdl" / f"{VECTOR}.core").read_text()
