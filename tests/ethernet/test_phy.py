"""PHYs: a frame comes back through looped pins, whatever the phase and the rate of the clocks."""

from __future__ import annotations

import shutil

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from firm_hdl import verilog
from firm_hdl.ethernet.mac import MacReceiver, MacTransmitter
from firm_hdl.ethernet.phy import GmiiPhy, MiiPhy, RgmiiPhy
from firm_hdl.ethernet.streams import SendSignature
from firm_hdl.jobs.processes import run_tool
from tests.tools import need

FRAMES = [bytes(range(k, k + size)) for k, size in ((1, 60), (2, 60), (3, 100))]


class Loop(wiring.Component):
    """A MAC at a PHY whose pins are looped; the PHY's clocks come from outside."""

    def __init__(self, phy):
        self.phy = phy
        super().__init__(
            {
                "clock": In(1),
                "sent": In(SendSignature()),
                "octet": Out(8),
                "valid": Out(1),
                "ends": Out(1),
                "good": Out(1),
                "bad": Out(1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.phy = phy = self.phy
        m.submodules.transmitter = transmitter = MacTransmitter()
        m.submodules.receiver = receiver = MacReceiver()
        wiring.connect(m, wiring.flipped(self.sent), transmitter.frames)
        wiring.connect(m, transmitter.symbols, phy.sent)
        wiring.connect(m, phy.received, receiver.symbols)
        frames = receiver.frames
        m.d.comb += [
            self.octet.eq(frames.payload.data),
            self.valid.eq(frames.valid),
            self.ends.eq(frames.payload.end),
            self.good.eq(frames.payload.good),
            self.bad.eq(receiver.damaged | receiver.runt | receiver.giant),
        ]
        pins = phy.pins
        if isinstance(phy, RgmiiPhy):
            m.d.comb += [pins.rxc.eq(pins.txc), pins.rxd.eq(pins.txd), pins.rx_ctl.eq(pins.tx_ctl)]
            return m
        m.d.comb += [
            pins.rx_clk.eq(self.clock),
            pins.rxd.eq(pins.txd),
            pins.rx_dv.eq(pins.tx_en),
            pins.rx_er.eq(pins.tx_er),
        ]
        if isinstance(phy, MiiPhy):
            m.d.comb += pins.tx_clk.eq(self.clock)
        return m


@pytest.mark.parametrize(
    ("phy", "ratio", "phase"), [(GmiiPhy, 1, 0.37), (MiiPhy, 5, 0.1), (MiiPhy, 1.003, 0.6)]
)
def test_frames_come_back_through_looped_pins(phy, ratio, phase):
    loop = Loop(phy())
    found, part, bad = [], bytearray(), []

    async def send(ctx):
        for frame in FRAMES:
            for place, byte in enumerate(frame):
                ctx.set(loop.sent.payload, {"data": byte, "last": place == len(frame) - 1})
                ctx.set(loop.sent.valid, 1)
                await ctx.tick().until(loop.sent.ready)
            ctx.set(loop.sent.valid, 0)
        for _ in range(3000):
            await ctx.tick()
            if len(found) == len(FRAMES):
                return

    async def clock(ctx):
        await ctx.delay(phase * 1e-8)
        while True:
            ctx.set(loop.clock, 1)
            await ctx.delay(ratio * 0.5e-8)
            ctx.set(loop.clock, 0)
            await ctx.delay(ratio * 0.5e-8)

    async def receive(ctx):
        values = (loop.valid, loop.ends, loop.good, loop.octet, loop.bad)
        while True:
            _, _, valid, end, good, byte, wrong = await ctx.tick().sample(*values)
            bad.append(wrong)
            if valid and end:
                assert good
                found.append(bytes(part))
                part.clear()
            elif valid:
                part.append(byte)

    simulator = Simulator(loop)
    simulator.add_clock(1e-8)
    simulator.add_testbench(send)
    simulator.add_testbench(clock, background=True)
    simulator.add_testbench(receive, background=True)
    simulator.run()
    assert found == FRAMES and not any(bad)


CELLS = """
module IDDRX1F(input D, SCLK, RST, output reg Q0, output reg Q1);
  initial {Q0, Q1} = 0;
  reg first = 0, second = 0;
  always @(posedge SCLK) first <= D;
  always @(negedge SCLK) second <= D;
  always @(posedge SCLK) begin Q0 <= first; Q1 <= second; end
endmodule
module ODDRX1F(input D0, D1, SCLK, RST, output Q);
  reg first = 0, second = 0;
  always @(posedge SCLK) begin first <= D0; second <= D1; end
  assign Q = SCLK ? first : second;
endmodule
module DELAYG(input A, output Z);
  parameter DEL_MODE = "", DEL_VALUE = 0;
  assign #(DEL_VALUE * 0.025) Z = A;
endmodule
"""

BENCH = """
`timescale 1ns / 1ps
module bench;
  reg clk = 0, rst = 1;
  always #4 clk = ~clk;
  reg [9:0] place = 0;
  wire ready, valid, end_, good, bad;
  wire [7:0] out;
  wire [8:0] in = {place == 69, 8'(place * 3)};
  loop dut(.clk(clk), .rst(rst), .clock(1'b0), .sent__payload(in), .sent__valid(!rst && place < 70),
    .sent__ready(ready), .octet(out), .valid(valid), .ends(end_), .good(good), .bad(bad));
  reg [9:0] got = 0;
  always @(posedge clk) begin
    rst <= 0;
    if (!rst && place < 70 && ready) place <= place + 1;
    if (valid && !end_) begin
      got <= got + 1;
      if (out !== 8'(got * 3)) $display("FAIL byte %0d", got);
    end
    if (valid && end_) begin
      $display("%s %0d", good ? "PASS" : "FAIL", got);
      $finish;
    end
  end
  initial #4000 begin $display("FAIL silent"); $finish; end
endmodule
"""


def test_an_rgmii_has_a_byte_at_two_edges(tmp_path):
    iverilog = need("Icarus Verilog", shutil.which("iverilog"))
    # Whoever delays the data by less than half a period samples them where they are stable.
    text = verilog.convert(Loop(RgmiiPhy(rx_delay_ns=0, tx_delay_ns=2)), name="loop")
    (tmp_path / "loop.v").write_text("`timescale 1ns / 1ps\n" + text)
    (tmp_path / "cells.v").write_text("`timescale 1ns / 1ps\n" + CELLS)
    (tmp_path / "bench.v").write_text(BENCH)
    command = [iverilog, "-g2012", "-o", "bench", "-s", "bench", "loop.v", "cells.v", "bench.v"]
    run_tool(command, tmp_path)
    assert run_tool(["vvp", "bench"], tmp_path).splitlines()[-1].strip() == "PASS 70"
