"""Synthesis of the output: no latches, no gated clocks, one clock, one kind of reset."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.export.build import build
from firm_hdl.export.options import Options
from firm_hdl.jobs.programs import ProgramMissingError, find_yosys
from firm_hdl.names.keywords import KEYWORDS, VERILOG, VHDL
from tests.depth import by_depth
from tests.export.conftest import EVERYTHING
from tests.tools import need

# Strings and nested sequences; a fixed size, so a record view; arrays in a record view.
TYPES = by_depth(
    ("std_msgs/msg/MultiArrayLayout", "shape_msgs/msg/Plane"),
    (
        "sensor_msgs/msg/JointState",
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/PoseWithCovariance",
    ),
)


@pytest.fixture(scope="module")
def folders(tmp_path_factory) -> list[Path]:
    out = tmp_path_factory.mktemp("built")
    made = build(TYPES, out, options=Options(extras=EVERYTHING))
    # On a narrow bus, a string needs no alignment, but a sequence does.
    for bus_bytes in by_depth((), (1, 4)):
        options = Options(bus_bytes=bus_bytes, extras=EVERYTHING)
        made += build(["std_msgs/msg/String", "sensor_msgs/msg/Joy"], out, options=options)
    return [each.folder for each in made]


def synthesized(ghdl: str, folder: Path, work: Path, entity: str) -> str:
    """Return the netlist that GHDL synthesizes from an entity, as VHDL."""
    files = (folder / "files.txt").read_text().splitlines()
    options = ["--std=08", f"--workdir={work}"]
    subprocess.run([ghdl, "-a", *options, *files], cwd=folder, check=True)
    command = [ghdl, "--synth", *options, "--out=raw-vhdl", entity]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


def flaws(text: str) -> list[str]:
    """List the flaws in GHDL's netlist."""
    # GHDL 2.0 stops at a latch that drives a port, and makes X of one that drives a signal.
    latch = "latch" in text.lower() or re.search(r"<= ['\"]X+['\"]; -- \(signal\)", text)
    found = ["latch"] if latch else []
    edges = {edge.strip() for edge in re.findall(r"(?:rising|falling)_edge *\([^)]*\)", text)}
    edges = {edge.replace(" ", "") for edge in edges}
    found += sorted(edges - {"rising_edge(aclk)"})
    return found if edges else [*found, "no register"]


# The views with records have the flat one inside.
@pytest.mark.parametrize(
    "kind",
    # The layer with a record for each field has the flat one inside.
    ["record", *(pytest.param(each, marks=pytest.mark.thorough) for each in ("flat", "records"))],
)
def test_vhdl_has_one_clock_and_no_latch(ghdl, folders, tmp_path, kind):
    tried = 0
    for folder in folders:
        entities = json.loads((folder / "manifest.json").read_text())["vhdl"]["entities"]
        for entity in (each[kind] for each in entities.values() if kind in each):
            assert flaws(synthesized(ghdl, folder / "vhdl", tmp_path, entity)) == [], entity
            tried += 1
    assert tried == (by_depth(2, 4) if kind == "record" else 2 * len(folders))


FLAWED = """\
library ieee;
use ieee.std_logic_1164.all;
entity flawed is
  port (aclk, enable, d : in std_logic; q : out std_logic);
end entity;
architecture rtl of flawed is
  signal gated, kept : std_logic;
begin
  gated <= aclk and enable;
  {what}
  q <= kept;
end architecture;
"""


@pytest.mark.parametrize(
    ("what", "flaw"),
    [
        ("kept <= d when rising_edge(aclk);", []),
        ("kept <= d when rising_edge(gated);", ["rising_edge(gated)"]),
        ("kept <= d when falling_edge(aclk);", ["falling_edge(aclk)"]),
        ("process (all) begin if enable = '1' then kept <= d; end if; end process;", ["latch"]),
        ("kept <= d;", ["no register"]),
    ],
)
def test_flaws_are_found(ghdl, tmp_path, what, flaw):
    (tmp_path / "flawed.vhd").write_text(FLAWED.format(what=what))
    (tmp_path / "files.txt").write_text("flawed.vhd\n")
    assert flaws(synthesized(ghdl, tmp_path, tmp_path, "flawed"))[: len(flaw) or None] == flaw


YOSYS = """\
read_verilog {file}; hierarchy -auto-top; proc; flatten; opt_clean; check -assert;
select -assert-none t:$dlatch t:$adlatch t:$dlatchsr t:$sr t:$adff t:$dffsr t:$aldff;
write_json out.json
"""


def test_verilog_has_one_clock_and_no_latch(folders, tmp_path):
    try:
        yosys = find_yosys("").command
    except ProgramMissingError as error:
        need(str(error), None)
    for source in sorted(folders[0].glob("*.v")):
        shutil.copy(source, tmp_path / "top.v")
        script = YOSYS.format(file="top.v").replace("\n", " ")
        done = subprocess.run(
            [*yosys, "-q", "-p", script], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
        modules: dict[str, Any] = json.loads((tmp_path / "out.json").read_text())["modules"]
        [top] = [module for module in modules.values() if module["attributes"].get("top")]
        flops = [cell for cell in top["cells"].values() if cell["type"] == "$dff"]
        assert flops
        clock = top["ports"]["aclk"]["bits"]
        assert all(cell["connections"]["CLK"] == clock for cell in flops)
        assert {cell["parameters"]["CLK_POLARITY"][-1] for cell in flops} == {"1"}


@pytest.mark.usefixtures("verilator", "iverilog")
def test_verilog_linters_find_nothing(folders):
    for folder in folders:
        for source in sorted(folder.glob("*.v")):
            for command in (
                ["verilator", "--lint-only", "-Wall", "waivers.vlt", source.name],
                ["iverilog", "-Wall", "-g2005", "-o", "/dev/null", source.name],
                ["iverilog", "-Wall", "-g2012", "-o", "/dev/null", source.name],
            ):
                done = subprocess.run(
                    command, cwd=folder, capture_output=True, text=True, check=False
                )
                assert (done.returncode, done.stdout + done.stderr) == (0, ""), command


@pytest.mark.thorough
@pytest.mark.usefixtures("verilator")
def test_each_waiver_is_needed_and_has_its_reason(folders, tmp_path):
    # Several lengths in one bus word need one-hot choices.
    wide = build(
        ["sensor_msgs/msg/JointState"], tmp_path, options=Options(bus_bytes=16, extras=EVERYTHING)
    )
    folders = [*folders, *(each.folder for each in wide)]
    rules = re.findall(r"-rule (\w+)", (folders[0] / "waivers.vlt").read_text())
    assert len(set(rules)) == 4
    for rule in dict.fromkeys(rules):
        output = ""
        for folder in folders:
            text = (folder / "waivers.vlt").read_text()
            [block] = [block for block in text.split("\n\n") if f"-rule {rule} " in block]
            assert block.startswith("// ") and block.splitlines()[0].endswith(".")
            (tmp_path / "left.vlt").write_text(text.replace(block, ""))
            for source in sorted(folder.glob("*.v")):
                waivers = str(tmp_path / "left.vlt")
                command = ["verilator", "--lint-only", "-Wall", waivers, source.name]
                done = subprocess.run(
                    command, cwd=folder, capture_output=True, text=True, check=False
                )
                output += done.stderr
        assert f"%Warning-{rule}" in output, rule


def units(folder: Path) -> tuple[set[str], set[str]]:
    """Return the names of the Verilog modules of a folder, and of its VHDL units."""
    verilog = "".join(path.read_text() for path in sorted(folder.glob("*.v")))
    vhdl = "".join(path.read_text() for path in sorted((folder / "vhdl").glob("*.vhd")))
    return (
        {name.strip("\\") for name in re.findall(r"^module (\S+?) ?\(", verilog, re.M)},
        set(re.findall(r"^(?:entity|package|context) (\w+) is$", vhdl, re.M)),
    )


def test_no_module_has_the_name_of_an_entity_in_another_case(folders):
    for folder in folders:
        modules, entities = units(folder)
        assert len(modules) >= 4 and len(entities) >= 8
        assert not {name.lower() for name in modules} & {name.lower() for name in entities}


_OF_VERILOG = (
    r"^ *(?:input wire|output wire|input|wire|reg|function)\b *(?:\[\d+:\d+\])? *"
    r"(?!wire\b)(\w+) ?(?:[;=,\[]|$| //)"
)


def declared(folder: Path) -> set[str]:
    """Return the names that a folder's texts declare without an escape."""
    found: set[str] = set()
    for path in sorted(folder.rglob("*.v")):
        found.update(re.findall(_OF_VERILOG, path.read_text(), re.M))
    for path in sorted((folder / "vhdl").glob("*.vhd")):
        text = re.sub("--.*", "", path.read_text())
        found.update(re.findall(r"^ *(?:signal|variable|constant) (\w+)", text, re.M))
        found.update(re.findall(r"^ *type (\w+) is", text, re.M))
        # Labels, ports and members.
        found.update(re.findall(r"^ *(\w+) *:(?!=)", text, re.M))
    return {name.lower() for name in found}


def test_no_name_is_a_keyword_of_either_language(folders):
    # Number of keywords in the standards: IEEE Std 1076-2008, 15.10, and 1800-2017, annex B.
    assert len(VERILOG) == 248 and len(VHDL) >= 115
    for folder in folders:
        names = declared(folder)
        assert {"aclk", "core", "map_offset", "packer", "ends_array"} <= names
        assert names & KEYWORDS == set()
