# amaranth: UnusedElaboratable=no
"""The byte packer against joined bytes: any pieces, stalls, ends without a byte, and cuts."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import stream

from firm_hdl.node.gateware.byte_packer import BytePacker, pieces_layout
from firm_hdl.sim import Stalls
from tests.depth import by_depth
from tests.gateware.packets.bench import PacketBench
from tests.node.traffic import pieces_of

SIZES = (0, 1, 2, 7, 8, 9, 15, 16, 17, 40)


@pytest.mark.parametrize("bus", by_depth([1, 8], [1, 2, 4, 8, 16]))
@pytest.mark.parametrize("stalls", by_depth([Stalls(0.25, max_cycles=5)], [None, Stalls(0.3)]))
def test_pieces_become_packets_of_full_beats(bus, stalls):
    rng = random.Random(bus)
    packets = [rng.randbytes(rng.choice(SIZES)) for _ in range(40)]
    source = [bits for packet in packets for bits in pieces_of(packet, bus, rng)]
    part = BytePacker(bus)
    bench = PacketBench(part, {"i": part.i}, {"o": (part.packets, bus, part.bad)})
    seen = bench.run({"i": source}, {"o": len(packets)}, stalls=stalls, deadline=400)
    # The bench judges that only last beats are short.
    assert seen.packets["o"] == packets and set.union(*seen.sides["o"]) == {0}
    if stalls is None:
        assert seen.times["o"][-1] - seen.times["i"][0] <= len(source) + len(packets) + 4


@pytest.mark.parametrize("most", by_depth([1, 3], range(7)))
def test_a_cut_ends_the_packet_under_way_and_no_other(most):
    """The first packet is cut after `most` of its five beats; all that is whole passes."""
    bus, packets = 8, [bytes(range(40)), b"second", bytes(range(99, 130))]
    m = Module()
    m.submodules.packer = part = BytePacker(bus)
    dma = stream.Signature(pieces_layout(bus)).create()
    taken, waits = Signal(range(64)), Signal(3)
    # The cut comes when the beats before it have settled.
    is_time = (taken == most) & (waits != 7)
    m.d.comb += [
        part.i.payload.eq(dma.payload),
        part.i.valid.eq(dma.valid & ~is_time),
        dma.ready.eq(part.i.ready & ~is_time),
        part.cut.eq(is_time & (waits >= 5)),
    ]
    m.d.sync += [taken.eq(taken + (dma.valid & dma.ready)), waits.eq(waits + is_time)]
    bench = PacketBench(m, {"i": dma}, {}, others={"o": part.packets})
    flat = [bits for packet in packets for bits in pieces_of(packet, bus)]
    # A DMA sends no rest after a reset.
    source = flat[:most] + flat[max(5, most) :]
    seen = bench.run({"i": source}, {"i": len(source)}, settle=30, deadline=200)
    out, part_bytes, cut = [], b"", 0
    for bits in seen.others["o"]:
        count, last = bits >> 64 & 0xF, bits >> 68
        part_bytes += (bits & ((1 << 64) - 1)).to_bytes(8, "little")[:count]
        if last:
            is_cut = count == 0
            cut += is_cut
            out += [] if is_cut else [part_bytes]
            part_bytes = b""
    assert part_bytes == b""
    # With the sixth beat, the second packet was whole.
    assert out == packets[most < 5 :]
    assert cut == (2 <= most < 5)
