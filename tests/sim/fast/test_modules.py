# amaranth: UnusedElaboratable=no
"""Designs with instances of modules in Verilog."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from amaranth.hdl import ClockSignal, Instance, Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.sim.fast import BuildError, FastSimulation

# `bit` is a keyword of SystemVerilog.
MODULES = {
    "add.v": "module add(input aclk, input [7:0] bit, output reg [7:0] sum = 0);\n"
    "  always @(posedge aclk) sum <= sum + bit;\nendmodule\n"
}


class Sum(wiring.Component):
    """Offer the sum of what came until then, always."""

    def __init__(self):
        super().__init__({"i": In(stream.Signature(8)), "o": Out(8)})

    def elaborate(self, platform):
        m = Module()
        m.d.comb += self.i.ready.eq(1)
        added = self.i.payload & self.i.valid.replicate(8)
        m.submodules.add = Instance("add", i_aclk=ClockSignal(), i_bit=added, o_sum=self.o)
        return m


@pytest.mark.thorough
@pytest.mark.parametrize("suffix", ["vcd", "fst"])
def test_verilator_compiles_them_too(programs, verilator, tmp_path, suffix):
    if suffix == "fst" and not Path("/usr/include/lz4.h").exists():
        pytest.skip("there is no lz4")
    options = {"engine": "verilator", "options": ["-O0"], "cache": programs}
    wave = tmp_path / f"sum.{suffix}"
    with FastSimulation(Sum(), modules=MODULES, wave=wave, **options) as simulation:
        simulation.send("i", [1, 2, 30])
        simulation.run(5)
        assert simulation.get("o") == 33
    if suffix == "fst":
        assert wave.read_bytes().startswith(b"\0\0\0\0\0\0\0\1\x49")
        return
    # What is inside of the module is in the waveform.
    assert re.search(r"\$timescale\s+1ns", wave.read_text()) and "#10\n" in wave.read_text()
    assert "scope module add" in wave.read_text() and "b00100001 " in wave.read_text()


def test_amaranth_has_no_verilog(tmp_path):
    with pytest.raises(BuildError, match=r"^Amaranth's simulator writes no waveform while"):
        FastSimulation(Sum(), wave=tmp_path / "sum.vcd", engine="amaranth")
    with pytest.raises(BuildError, match=r"^Amaranth's simulator takes no modules of Verilog$"):
        FastSimulation(Sum(), modules=MODULES, engine="amaranth")
