# amaranth: UnusedElaboratable=no
"""Whatever a stream has beside a low `valid`, no part takes it for a transfer."""

from __future__ import annotations

import pytest
from amaranth.hdl import Module, Value
from amaranth.lib.wiring import Component, In, Out, connect, flipped
from amaranth.sim import Simulator

from firm_hdl import (
    Deserializer,
    PacketArbiter,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketWidth,
    Parser,
    Serializer,
)
from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.plan import decode, encode
from firm_hdl.sim import Harness, RunOptions, Stalls
from firm_hdl.sim.transfers import join_transfers
from tests.gateware import test_parser
from tests.gateware.packets import test_arbiter, test_fifo, test_router, test_width
from tests.gateware.packets.gates import GateRun
from tests.gateware.packets.noise import with_noise
from tests.gateware.test_reset import letters
from tests.strategies import make

STALLS = Stalls(0.5, max_cycles=5, seed=3)
PACKETS = [bytes(range(size)) for size in (5, 1, 2, 8, 3, 4, 12, 1, 6)]

# A bounded text, and a text that may be any; the first one is too long in some packets.
TEXTS = make("ros1", {"s": "string<=3", "t": "string", "x": "uint8"}, "Texts")


def text(size):
    return bytes((size, 0, 0, 0)) + bytes(range(65, 65 + size))


GOOD = [text(s) + text(t) + b"\7" for s, t in ((2, 3), (0, 0), (3, 9), (1, 0))]
BAD = [GOOD[0][:6], text(5) + text(1) + b"\7", GOOD[2] + b"\7\7"]
MIXED = [packet for pair in zip(GOOD, BAD, strict=False) for packet in pair] + GOOD


class Wire(Component):
    """Passes a packet stream on, with the payload as it is."""

    def __init__(self):
        super().__init__({"i": In(PacketSignature(1)), "o": Out(PacketSignature(1))})

    def elaborate(self, platform):
        m = Module()
        connect(m, flipped(self.i), flipped(self.o))
        return m


def test_there_is_noise_beside_a_low_valid_alone():
    """Otherwise the tests below would find nothing."""
    part = with_noise(Wire)
    came, left = Value.cast(part.i.payload), Value.cast(part.o.payload)

    async def testbench(ctx):
        for valid, want in ((0, ~0x2A5 & 0x3FF), (1, 0x2A5)):
            ctx.set(came, 0x2A5)
            ctx.set(part.i.valid, valid)
            await ctx.delay(1e-6)
            assert (ctx.get(left), ctx.get(part.o.valid)) == (want, valid)

    simulator = Simulator(part)
    simulator.add_testbench(testbench)
    simulator.run()


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", [1, 4])
def test_a_deserializer_reads_nothing_between_transfers(bus_bytes):
    rx = with_noise(Deserializer, TEXTS, bus_bytes=bus_bytes)
    seen = Harness(rx, None).run_packets(MIXED, RunOptions(stalls=STALLS))
    decoded = [decode(rx.plan, packet) for packet in MIXED]
    assert [status.name for status in seen.statuses] == [str(each.status) for each in decoded]
    carried = {leaf: payloads for leaf, payloads in seen.transfers.items() if payloads}
    assert carried == join_transfers(each.streams for each in decoded)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", [1, 4])
def test_a_serializer_takes_nothing_between_transfers(bus_bytes):
    tx = with_noise(Serializer, TEXTS, bus_bytes=bus_bytes)
    # A text that is too long, and one whose last letter is not marked, between good ones.
    messages = [
        {
            0: [s],
            1: letters(bytes(s), bus_bytes),
            2: [t],
            3: [(lanes, last ^ wrong) for lanes, last in letters(bytes(t), bus_bytes)],
            4: [9],
        }
        for s, t, wrong in [
            (2, 3, 0),
            (5, 1, 0),
            (1, 4, 0),
            (0, 6, 1),
            (3, 0, 0),
            (4, 0, 0),
            (1, 1, 0),
        ]
    ]
    want = [encode(tx.plan, {k: iter(v) for k, v in message.items()}) for message in messages]
    assert [status for _, status in want][1::2] == ["LENGTH", "ITEMS", "LENGTH"]
    harness = Harness(None, tx)
    # The serializer waits for each length, or for each transfer of items.
    for kind in ("length", "items"):
        rare = dict.fromkeys(
            (f"message.s.{kind}", f"message.t.{kind}"), Stalls.bits("0" * 30 + "1")
        )
        seen = harness.run_messages(messages, RunOptions(stalls=rare))
        assert seen.packets == [packet for packet, _ in want]
        assert [status.name for status in seen.statuses] == [status for _, status in want]
        assert seen.packet_errors == [status != "OK" for _, status in want]


def test_a_parser_and_a_gate_read_nothing_between_transfers():
    parser = with_noise(Parser, TEXTS, bus_bytes=2)
    want = ["OK", "TRUNCATED", "OK", "LENGTH", "OK", "TRAILING", *["OK"] * 4]
    seen = test_parser.run(parser, MIXED, stalls=STALLS)
    assert [status.name for status in seen.statuses] == want
    for when_full in ("wait", "drop"):
        gate = with_noise(PacketGate, TEXTS, bus_bytes=2, memory_bytes=256, when_full=when_full)
        run = GateRun(gate, MIXED, stalls={"in": STALLS})
        assert [status.name for status in run.statuses] == want


@pytest.mark.parametrize("when_full", ["wait", "drop"])
def test_a_fifo_stores_nothing_between_transfers(when_full):
    fifo = with_noise(PacketFifo, 2, 16, 8, when_full=when_full)
    # The third packet is larger than the memory; there is room for all others.
    packets = [*PACKETS[:2], bytes(30), *PACKETS[2:]]
    slow = Stalls(0.8, max_cycles=9, seed=1)
    run = test_fifo.Run(fifo, packets, bad={1, 5}, stalls={"in": slow})
    want = [test_fifo.LARGE if len(each) > 16 else test_fifo.KEPT for each in packets]
    want[1] = want[5] = test_fifo.ABORTED
    assert run.outcomes == want


def test_packets_are_joined_divided_and_converted_without_the_noise_between_them():
    test_arbiter.run(with_noise(PacketArbiter, 2, 2), [PACKETS, PACKETS[::-1]], STALLS)
    topics = [0, 1, 2, 0, 0, 2, 1, 1, 0]
    test_router.run(with_noise(PacketRouter, 2, 2), PACKETS, topics, STALLS)
    for widths in ((2, 8), (8, 2), (2, 2)):
        test_width.run(with_noise(PacketWidth, *widths), PACKETS, STALLS)
