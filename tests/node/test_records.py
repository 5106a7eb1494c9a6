# amaranth: UnusedElaboratable=no
"""A node with records of VHDL and structs of SystemVerilog: messages pass by their fields."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.errors import UserError
from firm_hdl.export.message_ports import message_ports, other_ports
from firm_hdl.node import Node, read_description_text
from firm_hdl.node.benches import bench_files, link_script
from firm_hdl.node.build import build_node
from firm_hdl.node.records import found_messages
from firm_hdl.node.top import node_ports
from tests.depth import by_depth
from tests.node.samples import RELAY, read
from tests.tools import run_script

SMALL, LARGE = "std_msgs/msg/UInt16", "sensor_msgs/msg/PointCloud2"
TYPE = by_depth(SMALL, LARGE)


def description_of(kind=TYPE):
    return read(RELAY.replace(f"{SMALL}}}", f"{kind}, memory_bytes: 1024}}"))


@pytest.fixture
def built(relay, tmp_path):
    """Return a folder of its own."""
    if TYPE == SMALL:
        return shutil.copytree(relay, tmp_path / "relay")
    return build_node(description_of(), tmp_path, stimuli=stimuli).folder


def test_types_with_one_package_of_vhdl_are_refused(tmp_path):
    for package, name in (("a_b", "C"), ("a", "b_C")):
        folder = tmp_path / package / "msg"
        folder.mkdir(parents=True)
        (folder / f"{name}.msg").write_text("int8 x\n")
    text = "node: n\nsubscribe:\n  /a: {type: a_b/C}\n  /b: {type: a/b_C}\ndistro: noetic\n"
    description = read_description_text(text, paths=[tmp_path])
    with pytest.raises(UserError, match="a/b_C and a_b/C would have one package of VHDL, 'a_"):
        message_ports(list(found_messages(description)), node_ports(Node(description)))


def test_the_manifest_names_what_is_in_the_files(relay):
    manifest = json.loads((relay / "manifest.json").read_text())
    records, ports = manifest["records"], {each["name"]: each for each in manifest["ports"]}
    vhdl = (relay / "vhdl" / f"{records['entity']}.vhd").read_text()
    structs = (relay / "systemverilog" / f"{records['module']}.sv").read_text()
    assert f"\nentity {records['entity']} is" in vhdl
    assert f"\nmodule {records['module']} (" in structs
    listed = (relay / records["sv_files"]).read_text().split()
    assert f"{records['module']}.sv" in listed
    for each in records["ports"]:
        for name, kind in (("name", "message_type"), ("ready", "ready_type")):
            way = rf"\s*: (in |out) work\.{each['package']}\.{each[kind]}\b"
            assert re.search(rf"\b{each[name]}{way}", vhdl), (each, kind)
            typed = rf"(input |output) {each['sv_package']}::{each[f'sv_{kind}']} {each[name]}\b"
            assert re.search(typed, structs), (each, kind)
        assert any(port["member"].startswith(f"{each['member']}.") for port in ports.values())
    # The clock and the reset are ports, each of its own meaning.
    assert ports[manifest["clock"]]["member"] == "clock"
    assert ports[manifest["reset"]]["member"].startswith("reset")
    bench = manifest["bench"]
    assert f"module {bench['verilog']};" in (relay / bench["verilog_file"]).read_text()
    assert f"{bench['vhdl']}.vhd" in (relay / bench["vhdl_files"]).read_text().split()
    runs = [(relay / bench[f"run_{tool}"]).read_text() for tool in ("ghdl", "iverilog")]
    assert "iverilog" in runs[1] and "iverilog" not in runs[0] and "ghdl" in runs[0].lower()


def looped(language, folder):
    """Write a design around the node with records: `looped`, whose messages go back."""
    description = description_of()
    ports = node_ports(Node(description))
    others = other_ports(ports, message_ports(list(found_messages(description)), ports))
    records = json.loads((folder / "manifest.json").read_text())["records"]["ports"]
    texts = {"vhdl": vhdl_text, "verilog": verilog_text}
    script = link_script(description, stimuli, has_accelerator=False)
    # The messages of the loop are inside.
    script = type(script)(lines=script.lines, ignores_topics=False, loops=())
    files = (folder / "vhdl" / "files.txt").read_text().split()
    made = bench_files(
        description,
        "looped",
        others,
        script,
        module="looped",
        vhdl_ports={port.name: port.name for port in ports},
        vhdl_files=[*files, "looped.vhd"],
        header="",
    )
    name = {"vhdl": "vhdl/looped.vhd", "verilog": "looped.sv"}[language]
    return {**made, name: texts[language](others, records)}


def vhdl_text(others, records):
    """Return the design in VHDL. The accelerator is an assignment of records."""
    kinds = {1: "std_logic"}
    lines = [
        f"    {port.name} : {port.direction} "
        + kinds.get(port.width, f"std_logic_vector({port.width - 1} downto 0)")
        for port in others
    ]
    signals, ties = [], []
    for each in records:
        for name, kind in (("name", "message_type"), ("ready", "ready_type")):
            signals.append(f"  signal {each[name]} : work.{each['package']}.{each[kind]};\n")
        if each["message"] == "std_msgs/msg/UInt8":
            base = each["message_type"].removesuffix("_t").upper()
            ties.append(f"  {each['ready']} <= work.{each['package']}.{base}_ALL_READY;\n")
    names = [port.name for port in others]
    names += [each[key] for each in records for key in ("name", "ready")]
    joined = ", ".join(f"{name} => {name}" for name in names)
    return (
        "library ieee;\nuse ieee.std_logic_1164.all;\nentity looped is\n  port (\n"
        + ";\n".join(lines)
        + ");\nend entity;\narchitecture sim of looped is\n"
        + "".join(signals)
        + f"begin\n  node : entity work.relay_records port map ({joined});\n"
        + "  publish_out_1 <= subscribe_in_1;\n  subscribe_in_1_rdy <= publish_out_1_rdy;\n"
        + "".join(ties)
        + "end architecture;\n"
    )


def verilog_text(others, records):
    """Return the design in SystemVerilog. The accelerator is an assignment of structs."""
    ways = {"in": "input", "out": "output"}
    lines = [f"{ways[port.direction]} logic [{port.width - 1}:0] {port.name}" for port in others]
    text = "module looped (\n  " + ",\n  ".join(lines) + ");\n"
    for each in records:
        text += f"  {each['sv_package']}::{each['sv_message_type']} {each['name']};\n"
        text += f"  {each['sv_package']}::{each['sv_ready_type']} {each['ready']};\n"
        if each["message"] == "std_msgs/msg/UInt8":
            text += f"  assign {each['ready']} = '1;\n"
    text += "  assign publish_out_1 = subscribe_in_1;\n"
    text += "  assign subscribe_in_1_rdy = publish_out_1_rdy;\n"
    return text + "  relay_sv node (.*);\nendmodule\n"


def write(folder, files):
    for name, text in files.items():
        (folder / name).write_text(text)


def test_records_pass_messages_through_in_vhdl(built, ghdl, tmp_path):
    files = looped("vhdl", built)
    write(built, files)
    work = {"GHDL": ghdl, "WORK": str(tmp_path / "work")}
    status, output = run_script(built / "vhdl/run_ghdl.sh", "-gpatience=3000", **work)
    assert status == 0 and output.startswith("PASS node looped: "), output
    # A field that does not pass is found.
    text = files["vhdl/looped.vhd"]
    wrong = text.replace(
        "  subscribe_in_1_rdy <=",
        "  process (all) begin\n    publish_out_1 <= subscribe_in_1;\n"
        "    publish_out_1.data.data <= (others => '1');\n  end process;\n"
        "  subscribe_in_1_rdy <=",
    ).replace("  publish_out_1 <= subscribe_in_1;\n  process", "  process")
    if TYPE == SMALL:
        assert wrong != text
        write(built, {"vhdl/looped.vhd": wrong})
        status, output = run_script(built / "vhdl/run_ghdl.sh", "-gpatience=3000", **work)
        assert status != 0 and "byte 20 is ff instead of 00" in output, output


def test_structs_have_no_warnings(built, verilator):
    folder = built / "systemverilog"
    command = [verilator, "--lint-only", "-Wall", "../waivers.vlt", "waivers.vlt"]
    done = subprocess.run(
        [*command, "-F", "files.f", "--top-module", "relay_sv"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


@pytest.mark.thorough
def test_structs_pass_messages_through_in_systemverilog(built, verilator, tmp_path):
    write(built, looped("verilog", built))
    sources = [str(built / name) for name in ("looped.sv", "looped_tb.v")]
    command = [verilator, "--binary", "--timing", "-Wno-fatal", "-Wno-lint", "-Wno-style", "-O0"]
    command += ["-F", str(built / "systemverilog" / "files.f"), *sources]
    options = {"cwd": tmp_path, "capture_output": True, "text": True, "timeout": 600}
    done = subprocess.run(
        [*command, "--top-module", "looped_tb", "-Mdir", "made"],
        **options,
        env={**os.environ, "OPT_FAST": "-O0"},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    (tmp_path / "link.txt").write_text((built / "link.txt").read_text())
    done = subprocess.run([tmp_path / "made" / "Vlooped_tb"], **options, check=False)
    assert "PASS node looped: " in done.stdout, done.stdout + done.stderr
