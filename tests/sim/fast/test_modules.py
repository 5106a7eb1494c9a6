# amaranth: UnusedElaboratable=no
"""Designs with instances of modules in Verilog."""

from __future__ import annotations

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
def test_verilator_compiles_them_too(programs, verilator):
    options = {"engine": "verilator", "options": ["-O0"], "cache": programs}
    with FastSimulation(Sum(), modules=MODULES, **options) as simulation:
        simulation.send("i", [1, 2, 30])
        simulation.run(5)
        assert simulation.get("o") == 33


def test_amaranth_has_no_verilog():
    with pytest.raises(BuildError, match=r"^Amaranth's simulator takes no modules of Verilog$"):
        FastSimulation(Sum(), modules=MODULES, engine="amaranth")
