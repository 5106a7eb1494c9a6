# amaranth: UnusedElaboratable=no
"""The gate on a link that cannot be held: it drops whole packets and counts them."""

from __future__ import annotations

import random

import pytest
from amaranth.sim import Simulator

from firm_hdl import GateStatus, PacketGate, load_message
from firm_hdl.gateware.packets.gate import BACKLOG_BEATS, _Verdicts
from firm_hdl.gateware.packets.tail_drop import MOST_DROPPED, TailDrop
from firm_hdl.sim import Stalls
from tests.depth import by_depth
from tests.gateware.packets.bench import beats
from tests.gateware.packets.gates import (
    BOMB,
    BOMB_HEAD,
    DIAGNOSTICS,
    FULL,
    LARGE,
    NO_BOMB,
    OK,
    OVERRUN,
    GateRun,
    expected_statuses,
    gate_bench,
)
from tests.gateware.test_parser import GOOD, HEADER
from tests.strategies import make


def test_a_link_that_cannot_be_held_drops_whole_packets():
    good, bad = bytes.fromhex(GOOD), bytes.fromhex(GOOD)[:11]
    gate = PacketGate(
        load_message(HEADER), bus_bytes=8, memory_bytes=64, when_full="drop", packets=16
    )
    stalls = {"out": Stalls.bits("0" * 200 + "1" * 1000)}
    run = GateRun(gate, [good, good, good, bad, good, good, bad], stalls=stalls, deadline=400)
    short = GateStatus.TRUNCATED
    # 8 words and 2 in registers, for packets of 3 beats.
    assert run.statuses == [OK, OK, OK, short, FULL, FULL, short]
    assert run.taken == list(range(run.taken[0], run.taken[0] + len(run.taken)))


PAIR = make("ros2", {"key": "string", "value": "string"}, "Pair")
# The header of `DIAGNOSTICS`, then shorter elements.
PAIRS = make("ros2", {"sec": "int32", "x": "uint32", "name": "string", "pairs": (PAIR, "[]")})


def strings(bus_bytes, count):
    """Return packets on which the parser falls behind, and their statuses.

    Eight bytes are two empty strings: the parser takes at least two cycles per beat.
    """
    head = bytes.fromhex(BOMB_HEAD[:-8])
    elements, size = by_depth((150, 8), (60, 20))
    long = head + elements.to_bytes(4, "little") + bytes(elements * size)
    cut = GateStatus.TRUNCATED
    verdicts = {BOMB: cut, NO_BOMB: OK, long: OK, long[:-30]: cut}
    rng = random.Random(bus_bytes)
    packets = rng.choices([*verdicts], [1, 2, 3, 3], k=count)
    return packets, [verdicts[packet] for packet in packets]


@pytest.fixture
def short_backlog(monkeypatch):
    """A small backlog for the parser, so that short traffic overruns it."""
    monkeypatch.setattr("firm_hdl.gateware.packets.gate.BACKLOG_BEATS", 33)


def check_overruns(bus_bytes, takes):
    packets, want = strings(bus_bytes, by_depth(12, 25))
    message = by_depth(PAIRS, load_message(DIAGNOSTICS))
    gate = PacketGate(message, bus_bytes=bus_bytes, memory_bytes=4096, when_full="drop")
    bench = gate_bench(gate)
    run = GateRun(gate, packets, bench, stalls={"status": Stalls.bits(takes)}, deadline=2000)
    assert run.taken == list(range(run.taken[0], run.taken[0] + len(run.taken)))
    assert OVERRUN in run.statuses and OK in run.statuses
    for status, without in zip(run.statuses, want, strict=True):
        assert status in (without, OVERRUN)
    # Afterwards, the gate works as before, with twice as many cycles per beat as it needs.
    wait, few = by_depth((bus_bytes // 2, 3), (2 * bus_bytes, 5))
    gap = {"in": Stalls.bits("0" * wait + "1"), "status": Stalls.bits(takes)}
    assert GateRun(gate, packets[-few:], bench, stalls=gap, deadline=2000).statuses == want[-few:]


@pytest.mark.usefixtures("short_backlog")
@pytest.mark.parametrize(
    ("bus_bytes", "takes"),
    [
        pytest.param(8, "1", marks=pytest.mark.thorough),
        (16, "0" * 50 + "1" * 20),
        (64, "1"),
    ],
)
@pytest.mark.sampled(2)
def test_packets_that_come_while_the_parser_is_behind_are_dropped_and_counted(bus_bytes, takes):
    check_overruns(bus_bytes, takes)


def test_statuses_that_are_not_taken_hold_the_gate_or_drop_packets():
    good = b"\0\1\0\0\1"
    message = load_message("std_msgs/msg/Bool")
    never = {"status": Stalls.bits("0" * 500 + "1" * 1000)}
    gate = PacketGate(message, memory_bytes=2048, packets=256)
    run = GateRun(gate, [good] * 60, stalls=never, deadline=600)
    # 8 statuses in the FIFO, 2 in the parser, and the beats in its buffer.
    inside = sum(cycle < 500 for cycle in run.taken)
    assert 10 <= inside <= 10 + 10
    # Of the packets whose statuses are stored, each has left, and no other.
    assert sum(cycle < 500 for cycle in run.left) == 8
    gate = PacketGate(message, memory_bytes=2048, packets=256, when_full="drop")
    bench = gate_bench(gate)
    inside += BACKLOG_BEATS
    run = GateRun(gate, [good] * 450, bench, stalls=never, deadline=600)
    assert run.statuses == [OK] * inside + [OVERRUN] * (450 - inside)
    # Packets after 255 dropped ones in a row have no status, but are counted.
    for more in (0, 1):
        sent = inside + MOST_DROPPED + more
        never = {"status": Stalls.bits("0" * 600 + "1" * 1000)}
        seen = bench.run(
            {"in": beats([good] * sent, 8)},
            {"in": sent, "status": sent - more},
            stalls=never,
            deadline=700,
        )
        assert len(seen.others["status"]) == inside + MOST_DROPPED
        assert bench.state["passed"] == inside
        assert bench.state["overrun"] == MOST_DROPPED + more


def test_a_packet_that_is_dropped_while_another_is_reported_counts():
    dut = TailDrop(8)

    async def bench(ctx):
        # A packet of one beat and one of three: `packets_out` is ready for none of them.
        ctx.set(dut.packets_in.valid, 1)
        for last in (1, 0, 0, 1):
            ctx.set(dut.packets_in.payload.last, last)
            await ctx.tick()
        ctx.set(dut.packets_in.valid, 0)
        ctx.set(dut.report, 1)
        assert (ctx.get(dut.drops), ctx.get(dut.dropped)) == (1, 1)
        await ctx.tick()
        assert (ctx.get(dut.drops), ctx.get(dut.dropped)) == (0, 1)
        await ctx.tick()
        assert ctx.get(dut.dropped) == 0

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()


TEXTS = make("ros1", dict.fromkeys("abcd", "string"), "Texts")


def texts(rng, number):
    """Return a packet of four texts, of which the first tells its number, or that has no text.

    Without text, it is a beat of 16 bytes, for which the parser takes five steps.
    """
    if rng.random() < 0.6:
        return bytes(16)
    packet = b"\2\0\0\0" + number.to_bytes(2, "little") + bytes(12)
    return packet[: rng.choice([18, 18, 18, 17, 3])]


@pytest.mark.parametrize("seed", [0, 2])
@pytest.mark.sampled(2)
def test_statuses_are_in_the_order_of_packets_however_late_they_are_taken(monkeypatch, seed):
    monkeypatch.setattr("firm_hdl.gateware.packets.gate.BACKLOG_BEATS", 5)
    rng = random.Random(seed)
    packets = [texts(rng, number) for number in range(60)]
    gate = PacketGate(TEXTS, wire="ros1", bus_bytes=16, memory_bytes=4096, when_full="drop")
    # Bursts with pauses in which all that was dropped is reported, one packet at a time.
    came = "".join("1" * rng.randrange(2, 40) + "0" * rng.randrange(99) for _ in range(6))
    stalls = {"in": Stalls.bits(came), "status": Stalls.bits(["1", "01", "0" * 9 + "1"][seed % 3])}
    run = GateRun(gate, packets, stalls=stalls, deadline=2000)
    alone = expected_statuses(TEXTS, packets, 16)
    assert OVERRUN in run.statuses and OK in run.statuses
    for status, own in zip(run.statuses, alone, strict=True):
        assert status in (own, OVERRUN)


def test_what_the_memory_did_with_a_packet_is_not_told_of_those_dropped_after_it(monkeypatch):
    monkeypatch.setattr("firm_hdl.gateware.packets.gate.BACKLOG_BEATS", 5)
    rng = random.Random(1)
    # A text of 40 letters, larger than the memory; and no text.
    long, short = b"\x28\0\0\0" + bytes(52), bytes(16)
    packets = rng.choices([long, short], [1, 3], k=32)
    gate = PacketGate(
        TEXTS, wire="ros1", bus_bytes=16, memory_bytes=32, packets=1, when_full="drop"
    )
    came = "".join("1" * rng.randrange(9, 30) + "0" * rng.randrange(60) for _ in range(6))
    stalls = {"in": Stalls.bits(came), "out": Stalls.bits("0" * 30 + "1")}
    run = GateRun(gate, packets, stalls=stalls, deadline=2000)
    pairs = [*zip(packets, run.statuses, strict=True)]
    assert {status for packet, status in pairs if packet == long} == {LARGE, FULL, OVERRUN}
    assert {status for packet, status in pairs if packet == short} == {OK, FULL, OVERRUN}


# Must-fail twins: a gate with a fault, which the checks find.


class _ForgetsThatAPacketWasAborted(_Verdicts):
    def report_dropped(self, tail_drop, none_waits):
        super().report_dropped(tail_drop, none_waits)
        self.m.d.comb += self.aborted.eq(0)


@pytest.mark.usefixtures("short_backlog")
@pytest.mark.parametrize(
    ("fault", "bus_bytes"),
    [(_ForgetsThatAPacketWasAborted, 16)],
)
def test_a_fault_of_the_tail_drop_is_found(monkeypatch, fault, bus_bytes):
    monkeypatch.setattr("firm_hdl.gateware.packets.gate._Verdicts", fault)
    with pytest.raises(AssertionError):
        check_overruns(bus_bytes, "1")
