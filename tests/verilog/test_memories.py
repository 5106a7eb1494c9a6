"""Memories in Verilog: other simulators, lint, and inference by Yosys."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

from firm_hdl.equivalence import find_tools
from firm_hdl.jobs import ProgramMissingError
from firm_hdl.verilog import convert
from tests.depth import by_depth
from tests.rtlil.memory_designs import DESIGNS, Stores, simulated
from tests.tools import need
from tests.verilog.icarus import replay

STEPS = 200
STANDARDS = ["-g2005", "-g2012"]


def _verilog(name: str) -> str:
    return convert(Stores(DESIGNS[name]), name="stores", header="Memories.\n")  # type: ignore[arg-type]


def _run(folder: Path, *command: str) -> None:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout + done.stderr) == (0, ""), done.stdout + done.stderr


def _replay(name: str, text: str, standard: str, folder: Path) -> str | None:
    """Simulate Verilog; return the first difference from Amaranth's simulator."""
    inputs, outputs, steps, wanted = simulated(DESIGNS[name], steps=STEPS, seed=len(name))
    rows = replay(text, "stores", inputs, outputs, steps, standard, folder)
    for number, (want, seen) in enumerate(zip(wanted, rows, strict=True)):
        for output, width in outputs.items():
            bits = f"{want[output]:0{width}b}"
            if seen[output] != bits:
                return f"step {number}: {output} is {seen[output]} instead of {bits}"
    return None


@pytest.mark.usefixtures("iverilog")
@pytest.mark.parametrize("standard", STANDARDS)
@pytest.mark.parametrize("name", DESIGNS)
@pytest.mark.sampled(4)
def test_memories_behave_as_in_amaranth(name: str, standard: str, tmp_path: Path) -> None:
    assert _replay(name, _verilog(name), standard, tmp_path) is None


@pytest.mark.usefixtures("iverilog")
@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("asynchronous", "mem[mem_w0_addr] <=", "mem[0] <="),
        ("lanes", "[7:6] <= mem_w0_data[7:6]", "[7:6] <= 0"),
        ("transparent", "_r0_addr == mem_w0_addr", "_r0_addr != mem_w0_addr"),
        ("synchronous", "mem_r0_data_q = 8'd0", "mem_r0_data_q = 8'd1"),
        ("odd depth", "mem[2] = 8'd3", "mem[2] = 8'd2"),
    ],
)
@pytest.mark.sampled(5)
def test_a_changed_memory_is_noticed(name: str, old: str, new: str, tmp_path: Path) -> None:
    text = _verilog(name)
    assert old in text
    assert _replay(name, text.replace(old, new), "-g2012", tmp_path) is not None


@pytest.mark.usefixtures("verilator")
@pytest.mark.parametrize("standard", ["1364-2005", "1800-2012"])
@pytest.mark.parametrize("name", ["several", "transparent", "lanes", "a structure"])
@pytest.mark.sampled(4)
def test_verilator_reads_memories(name: str, standard: str, tmp_path: Path) -> None:
    (tmp_path / "stores.v").write_text(_verilog(name))
    waived = ["-Wno-UNUSEDSIGNAL", "-Wno-WIDTH"]
    _run(tmp_path, "verilator", "--lint-only", "-Wall", *waived, f"+{standard}ext+v", "stores.v")


def test_a_memory_whose_name_is_a_keyword_is_renamed() -> None:
    text = _verilog("several")
    found = re.findall(r"^  reg \[3:0\] (\S+) \[0:\d\];$", text, re.MULTILINE)
    assert sorted(found) == ["data", "mem", "signal_sig"]
    assert "ram_style" not in text and "(*" not in text


@pytest.mark.parametrize(
    "name", ["a structure", *by_depth([], ["one bit", "asynchronous", "60 bits"])]
)
def test_yosys_infers_distributed_ram(name: str, tmp_path: Path) -> None:
    """On ECP5, an asynchronous memory takes RAM of LUTs and no register."""
    cells = _cells_on_ecp5(_verilog(name), tmp_path)
    (store,) = DESIGNS[name].values()
    width = store.shape if isinstance(store.shape, int) else store.shape.size
    assert cells.count("TRELLIS_DPR16X4") == -(-width // 4)
    assert "TRELLIS_FF" not in cells


@pytest.mark.thorough
def test_yosys_makes_registers_of_unsuitable_memories(tmp_path: Path) -> None:
    text = _verilog("asynchronous").replace(
        "always @(posedge clk)", "always @(posedge clk, posedge rst) if (rst) mem[0] <= 0; else"
    )
    assert "TRELLIS_FF" in _cells_on_ecp5(text, tmp_path)


def _cells_on_ecp5(text: str, folder: Path) -> list[str]:
    try:
        tools = find_tools()
    except ProgramMissingError as error:
        need(str(error), None)
        raise
    (folder / "stores.v").write_text(text)
    tools.run_yosys(
        folder, "read_verilog stores.v; synth_ecp5 -top stores; write_json out.json", None
    )
    (module,) = (
        m
        for m in json.loads((folder / "out.json").read_text())["modules"].values()
        if "top" in m["attributes"]
    )
    return [cell["type"] for cell in module["cells"].values()]
