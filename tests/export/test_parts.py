# amaranth: UnusedElaboratable=no
"""Packet parts as designs of their own: their files compile; which parts there are not."""

from __future__ import annotations

import json
import re
import shutil
import subprocess

import pytest

from firm_hdl import load_message
from firm_hdl.cli import main
from firm_hdl.errors import UserError
from firm_hdl.export.parts import build_part, make_part, part_ports
from firm_hdl.vhdl.convert import Vhdl
from tests.export.strikes import left_when_outdated
from tests.export.verilog.test_verilog import PORT
from tests.tools import need
from tests.vhdl.ghdl import GHDL, analyse

MEMORY = {"memory_bytes": 32, "packets": 2, "when_full": "drop"}
PARTS = {
    "gate": {"message": load_message("std_msgs/msg/UInt16"), "bus_bytes": 4, **MEMORY},
    "fifo": {"bus_bytes": 2, **MEMORY},
    "width": {"in_bytes": 1, "out_bytes": 4},
    "crossing": {"bus_bytes": 2, "beats": 4},
    "arbiter": {"bus_bytes": 1, "inputs": 3, "side_bits": 5},
    "router": {"bus_bytes": 1, "topics": 3, "topic_bits": 4, "side_bits": 2},
}

NAMES = {
    "gate": "packet_gate_std_msgs_msg_uint16_4",
    "fifo": "packet_fifo_2",
    "width": "packet_width_1_4",
    "crossing": "packet_crossing_2",
    "arbiter": "packet_arbiter_1_3",
    "router": "packet_router_1_3",
}


@pytest.fixture(scope="module", params=PARTS)
def built(request, tmp_path_factory):
    part = make_part(request.param, **PARTS[request.param])
    return build_part(part, tmp_path_factory.mktemp("out")).folder


def run(command, folder):
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False, timeout=60
    )
    return done.returncode, done.stderr


def verilator_finds(folder, file, top):
    verilator = need("verilator", shutil.which("verilator"))
    # Some comparisons of a FIFO are constant for its number of packets.
    waived = ("WIDTH", "UNUSEDSIGNAL", "VARHIDDEN", "DECLFILENAME", "UNDRIVEN", "UNSIGNED")
    waivers = [f"-Wno-{name}" for name in waived]
    return run([verilator, "--lint-only", "-Wall", *waivers, "--top-module", top, file], folder)


@pytest.mark.sampled(6)
def test_the_verilog_compiles_in_both_languages(built, tmp_path):
    iverilog = need("iverilog", shutil.which("iverilog"))
    file = built / f"{built.name}_verilog.v"
    for language in ("-g2005", "-g2012"):
        assert run([iverilog, language, "-Wall", "-o", "o", file], tmp_path) == (0, "")


def test_each_file_goes_when_it_is_outdated(built, tmp_path):
    assert left_when_outdated(built, tmp_path / built.name) == set()


@pytest.mark.sampled(2)
def test_verilator_finds_nothing(built, tmp_path):
    top = f"{built.name}_verilog"
    assert verilator_finds(tmp_path, built / f"{top}.v", top) == (0, "")


def test_verilator_finds_a_wire_that_does_not_exist(tmp_path):
    folder = build_part(make_part("width", in_bytes=1, out_bytes=1), tmp_path).folder
    top = f"{folder.name}_verilog"
    text = (folder / f"{top}.v").read_text()
    assert text.count("  assign m_axis_tlast = ") == 1
    (tmp_path / "bad.v").write_text(text.replace("  assign m_axis_tlast", "  assign m_axis_tlost"))
    status, found = verilator_finds(tmp_path, "bad.v", top)
    assert status and "m_axis_tlost" in found


def test_the_vhdl_compiles_in_the_order_of_its_list(built, tmp_path):
    need("ghdl", GHDL)
    names = (built / "vhdl" / "files.txt").read_text().split()
    files = {name: (built / "vhdl" / name).read_text() for name in names}
    analyse(Vhdl(top=built.name, files=files, entities={}), tmp_path)


def test_the_manifest_lists_the_ports_of_the_verilog(built):
    manifest = json.loads((built / "manifest.json").read_text())
    text = (built / manifest["verilog"]["file"]).read_text()
    top = text.partition(f"module {manifest['verilog']['module']} (")[2]
    found = re.findall(PORT, top, re.MULTILINE)
    ports = {name: (flow, int(high or 0) + 1) for flow, high, name in found}
    assert ports == {port["name"]: (port["direction"], port["width"]) for port in manifest["ports"]}
    assert all(port["meaning"] not in ("", port["name"]) for port in manifest["ports"])
    # Every clock is listed, with its own reset.
    assert sorted((each["clock"], each["reset"]) for each in manifest["clocks"]) == sorted(
        (name, f"{name.removesuffix('clk')}resetn") for name in ports if name.endswith("aclk")
    )
    assert (built / f"{built.name}.core").read_text().startswith("CAPI=2:\n")


JUDGED = ("OK", "TRUNCATED", "TRAILING", "LENGTH", "ENCAPSULATION", "STRING")
CODES = {
    "fifo": {"KEPT": 0, "ABORTED": 1, "FULL": 2, "LARGE": 3},
    "gate": {**dict(zip(JUDGED, range(6), strict=True)), "FULL": 8, "LARGE": 9, "OVERRUN": 10},
}


def test_the_manifest_has_the_parameters_and_the_codes(built):
    manifest = json.loads((built / "manifest.json").read_text())
    kind = manifest["part"]
    given = {name: value for name, value in PARTS[kind].items() if name != "message"}
    if kind == "gate":
        given |= {"type": "std_msgs/msg/UInt16", "dialect": "ros2"}
    assert manifest["parameters"] == given
    assert manifest.get("codes") == CODES.get(kind)
    assert built.name == NAMES[kind]
    head = (built / f"{built.name}_verilog.v").read_text()[:400]
    assert f"{built.name}: packet {kind}: " in head
    assert all(f"{name} {value}" in head for name, value in given.items())


def test_the_widest_part_has_65535_input_bits():
    given = {"bus_bytes": 1, "topics": 2, "topic_bits": 16}
    # Clock, reset, data, tkeep, tlast, tvalid, tdest, and two of tready.
    rest = 2 + 8 + 1 + 1 + 1 + 16 + 2
    assert part_ports(make_part("router", side_bits=65535 - rest, **given))
    with pytest.raises(UserError, match=r"^The part has 65536 input bits, and Amaranth"):
        part_ports(make_part("router", side_bits=65536 - rest, **given))


def test_a_part_that_is_current_is_written_if_it_is_asked_for(tmp_path):
    part = make_part("width", in_bytes=1, out_bytes=2)
    written = [build_part(part, tmp_path, force=force) for force in (False, False, True)]
    assert [each.was_current for each in written] == [False, True, False]


def test_the_command_writes_a_part_once(tmp_path, capsys):
    words = ["part", "crossing", "--bus-bytes", "1", "--out", str(tmp_path)]
    assert main(words) == 0 and main(words) == 0
    folder = tmp_path / "packet_crossing_1"
    assert capsys.readouterr().out == f"wrote   {folder}/\ncurrent {folder}/\n"
    assert main([*words, "--force"]) == 0
    assert capsys.readouterr().out == f"wrote   {folder}/\n"
    # Another memory is another design.
    assert main([*words, "--beats", "8"]) == 0
    assert capsys.readouterr().out == f"wrote   {folder}/\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("fifo --memory-bytes 100", "Memory size must be a power of two from 16 bytes on, not 100"),
        ("crossing --beats 5", "Number of beats must be a power of two from 4 on, not 5"),
        ("router --topics 3 --topic-bits 1", "3 topics do not fit into 1 bits"),
        ("fifo --name mux", "The VHDL of every part uses the name 'mux' itself"),
        (
            "arbiter --inputs 64 --bus-bytes 64 --side-bits 1000",
            "The part has 100995 input bits, and Amaranth elaborates at most 65535",
        ),
    ],
)
def test_parameters_that_no_part_has_are_refused(words, message, tmp_path, capsys):
    assert main(["part", *words.split(), "--out", str(tmp_path)]) == 1
    assert capsys.readouterr().err == f"error: {message}\n"
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("width --in-bytes 3 --out-bytes 4", "invalid choice: 3"),
        ("width --in-bytes 4", "required: --out-bytes"),
        ("fifo --memory-bytes 33554432", "must be from 1 to 1048576, not 33554432"),
        ("fifo --name entity", "'entity' is not a name in VHDL and Verilog"),
        ("gates a/B", "invalid choice: 'gates'"),
    ],
)
def test_wrong_arguments_are_refused(words, message, capsys):
    with pytest.raises(SystemExit, match="2"):
        main(["part", *words.split()])
    assert message in capsys.readouterr().err


def test_a_folder_of_others_is_left_alone(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "x").write_text("")
    with pytest.raises(UserError, match="is not a folder that firm-hdl made; move it away"):
        build_part(make_part("width", in_bytes=1, out_bytes=2, name="mine"), tmp_path)
