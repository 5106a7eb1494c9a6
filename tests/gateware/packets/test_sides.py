# amaranth: UnusedElaboratable=no
"""What comes beside a beat leaves beside the same beat, through every part of one stream."""

from __future__ import annotations

import pytest
from amaranth.hdl import Cat

from firm_hdl import PacketCrossing, PacketFifo, PacketGate, PacketWidth, load_message
from firm_hdl.plan import build_plan
from firm_hdl.sim import Stalls
from firm_hdl.sim.payloads import beats_of
from firm_hdl.wire import lay_out
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.gateware.traffic import random_packets

HEADER = load_message("std_msgs/msg/Header")
BITS = 20
MEMORY = {"memory_bytes": 4096, "packets": 64, "side_bits": BITS}
# The part, and the bytes of its input and of its output. `test_part_ports` has the crossing.
PARTS = {
    "fifo": (lambda: PacketFifo(2, **MEMORY), 2, 2),
    "gate": (lambda: PacketGate(HEADER, bus_bytes=2, **MEMORY), 2, 2),
    "gate that drops": (
        lambda: PacketGate(HEADER, bus_bytes=2, when_full="drop", **MEMORY),
        *(2, 2),
    ),
    "up": (lambda: PacketWidth(2, 8, side_bits=BITS), 2, 8),
    "down": (lambda: PacketWidth(8, 2, side_bits=BITS), 8, 2),
    "same": (lambda: PacketWidth(2, 2, side_bits=BITS), 2, 2),
}


@pytest.mark.parametrize("kind", PARTS)
def test_what_comes_beside_a_beat_leaves_beside_it(kind):
    make, came, gone = PARTS[kind]
    part = make()
    good = random_packets(build_plan(lay_out(HEADER), bus_bytes=came), 9)
    # A gate drops those that are cut.
    sent = [packet for each in good for packet in (each, each[:-1])]
    kept = good if kind.startswith("gate") else sent
    # The last beat of a packet has another value beside it.
    sides = [lambda last, number=number: 999 * number + last for number in range(len(sent))]
    bench = PacketBench(
        part,
        {"in": with_side(part.packets_in, part.side_in)},
        {"out": (part.packets_out, gone, part.side_out)},
        others={"status": part.status} if kind.startswith("gate") else {},
    )
    stalls = None if kind == "gate that drops" else Stalls(0.3, seed=4)
    seen = bench.run({"in": beats(sent, came, sides)}, {"out": len(kept)}, stalls=stalls)
    assert seen.packets["out"] == kept
    want = []
    for number, packet in enumerate(sent):
        # Beats of a narrow bus that are one beat of the wide one have the same value.
        has_more = min(beats_of(len(packet), came), beats_of(len(packet), gone)) > 1
        if packet in kept:
            want.append({999 * number + 1, *([999 * number] if has_more else [])})
    assert seen.sides["out"] == want


def test_a_fifo_still_drops_packets():
    fifo = PacketFifo(2, **MEMORY)
    port = with_side(fifo.packets_in, Cat(fifo.abort, fifo.side_in))
    bench = PacketBench(fifo, {"in": port}, {"out": (fifo.packets_out, 2, fifo.side_out)})
    packets = [bytes([number]) * (number + 1) for number in range(9)]
    sides = [int(number % 3 == 1) | (number + 7) << 1 for number in range(9)]
    seen = bench.run({"in": beats(packets, 2, sides)}, {"out": 6})
    assert seen.sides["out"] == [{number + 7} for number in range(9) if number % 3 != 1]


@pytest.mark.parametrize("part", [PacketCrossing, PacketFifo, PacketGate, PacketWidth])
def test_the_number_of_bits_is_checked(part):
    first = {PacketGate: [HEADER], PacketFifo: [8, 64, 2], PacketWidth: [8, 4]}.get(part, [8])
    with pytest.raises(ValueError, match=r"^Number of side bits must be at least 0, not -1$"):
        part(*first, side_bits=-1)
    assert "side_in" not in part(*first).signature.members
