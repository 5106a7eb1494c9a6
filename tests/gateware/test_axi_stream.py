# amaranth: UnusedElaboratable=no
"""AXI4-Stream and packet streams: the same packets on both, and the same values beside them."""

from __future__ import annotations

import pytest
from amaranth.hdl import Cat, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator

from firm_hdl import (
    AxiStreamSignature,
    AxiStreamToPackets,
    PacketSignature,
    PacketsToAxiStream,
)
from firm_hdl.sim import Stalls
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.strategies import BUS_WIDTHS


class _Through(wiring.Component):
    """Packets that pass an AXI4-Stream."""

    def __init__(self, bus_bytes, **bits):
        self.to = PacketsToAxiStream(bus_bytes, **bits)
        self.back = AxiStreamToPackets(bus_bytes, **bits)
        self.bus_bytes, beside = bus_bytes, sum(bits.values())
        packets = PacketSignature(bus_bytes)
        sides = {"side_in": In(beside), "side_out": Out(beside)}
        super().__init__({"packets_in": In(packets), "packets_out": Out(packets), **sides})

    def elaborate(self, platform):
        m = Module()
        m.submodules += [self.to, self.back]
        connect(m, flipped(self.packets_in), self.to.packets)
        connect(m, self.to.axis, self.back.axis)
        connect(m, self.back.packets, flipped(self.packets_out))
        if self.to.side_bits:
            m.d.comb += Cat(self.to.side_in, self.to.dest_in).eq(self.side_in)
            m.d.comb += self.side_out.eq(Cat(self.back.side_out, self.back.dest_out))
        return m


@pytest.mark.parametrize("bus_bytes", BUS_WIDTHS)
@pytest.mark.sampled(3)
def test_packets_are_the_same_behind_an_axi_stream(bus_bytes):
    packets = [bytes([size]) * size for size in range(2 * bus_bytes + 2)]
    design = _Through(bus_bytes, side_bits=3, dest_bits=5)
    bench = PacketBench(
        design,
        {"in": with_side(design.packets_in, design.side_in)},
        {"out": (design.packets_out, bus_bytes, design.side_out)},
    )
    sides = [37 * number % 256 for number in range(len(packets))]
    source = beats(packets, bus_bytes, sides)
    seen = bench.run({"in": source}, {"out": len(packets)}, stalls=Stalls(0.3), deadline=999)
    assert seen.packets["out"] == packets
    assert seen.sides["out"] == [{side} for side in sides]


def test_tkeep_counts_from_lane_0_up_to_the_first_zero_in_the_last_beat_only():
    adapter, seen = AxiStreamToPackets(4), []

    async def bench(ctx):
        for last in (0, 1):
            for keep in range(16):
                ctx.set(Cat(adapter.axis.tkeep, adapter.axis.tlast), keep | last << 4)
                seen.append(ctx.get(adapter.packets.payload.count))

    simulator = Simulator(adapter)
    simulator.add_testbench(bench)
    simulator.run()
    ones = [next(n for n in range(5) if n == 4 or not keep >> n & 1) for keep in range(16)]
    assert seen == [4] * 16 + ones


def test_signatures_of_equal_parameters_are_equal():
    assert AxiStreamSignature(8) == PacketsToAxiStream(8).axis.signature
    assert AxiStreamSignature(8, user_bits=1) != AxiStreamSignature(8, dest_bits=1)
    assert "tuser" not in AxiStreamSignature(8).members
    with pytest.raises(wiring.ConnectionError, match=r"tuser"):
        connect(Module(), PacketsToAxiStream(8, side_bits=1).axis, AxiStreamToPackets(8).axis)


@pytest.mark.parametrize("adapter", [AxiStreamToPackets, PacketsToAxiStream])
def test_parameters_are_checked(adapter):
    with pytest.raises(ValueError, match=r"^Bus width must be one of .* bytes, not 3$"):
        adapter(3)
    with pytest.raises(ValueError, match=r"^Number of user bits must be at least 0, not -1$"):
        adapter(8, side_bits=-1)
    with pytest.raises(TypeError, match=r"^Number of destination bits must be an integer"):
        adapter(8, dest_bits="4")
