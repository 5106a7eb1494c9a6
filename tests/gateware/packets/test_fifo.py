# amaranth: UnusedElaboratable=no
"""The packet FIFO: whole packets leave in order; which packets are dropped, and when."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.sim import Simulator

from firm_hdl import PacketFifo, load_message
from firm_hdl.gateware.packets import Outcome
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.gateware.packets.writer import PacketWriter
from firm_hdl.plan import build_plan
from firm_hdl.sim import DeadlineError, Stalls
from firm_hdl.sim.payloads import beats_of
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.gateware.traffic import has_path, random_packets
from tests.strategies import BUS_WIDTHS

LATENCY = 4
"""Cycles from the transfer of the last beat to the first beat on the other side."""
RESULT = 2
"""Cycles from the transfer of the last beat to `ended`."""

KEPT, ABORTED, FULL, LARGE = (each.value for each in Outcome)
COUNTERS = ("passed", "aborted", "full", "large")


def bench_of(fifo, **options):
    return PacketBench(
        fifo,
        {"in": with_side(fifo.packets_in, fifo.abort)},
        {"out": (fifo.packets_out, fifo.shape.bus_bytes, fifo.size)},
        events={"ended": (fifo.ended, Value.cast(fifo.outcome))},
        final={name: fifo.counters[name] for name in COUNTERS},
        **options,
    )


class Run:
    """Packets through a FIFO; `bad` has the numbers of those to be aborted."""

    def __init__(self, fifo, packets, bad=(), bench=None, want=None, **options):
        bus = fifo.shape.bus_bytes
        noise = random.Random(1)
        # `abort` means nothing before the last beat.
        sides = [
            lambda last, bad=number in bad: bad if last else noise.getrandbits(1)
            for number in range(len(packets))
        ]
        total = sum(beats_of(len(packet), bus) for packet in packets)
        bench = bench or bench_of(fifo)
        goal = {"in": total} if want is None else {"in": total, "out": want}
        source = beats(packets, bus, sides, noise=noise)
        seen = bench.run({"in": source}, goal, **options)
        self.packets, self.outcomes = seen.packets["out"], seen.values("ended")
        self.taken, self.left = seen.times["in"], seen.times["out"]
        self.ended = [cycle for cycle, _ in seen.events["ended"]]
        self.counters = tuple(bench.state[name] for name in COUNTERS)
        self.lasts = []
        for packet in packets:
            before = sum(beats_of(len(each), bus) for each in packets[: len(self.lasts)])
            self.lasts.append(self.taken[before + beats_of(len(packet), bus) - 1])
        # One decision per packet, in time; the kept packets leave, with their sizes.
        assert len(self.outcomes) == len(packets)
        assert self.ended == [cycle + RESULT for cycle in self.lasts]
        pairs = list(zip(packets, self.outcomes, strict=True))
        assert self.packets == [packet for packet, outcome in pairs if outcome == KEPT]
        assert seen.sides["out"] == [{len(packet)} for packet in self.packets]
        assert self.counters == tuple(self.outcomes.count(each) for each in range(4))
        for number, outcome in enumerate(self.outcomes):
            assert (outcome == ABORTED) == (number in bad)


def of_beats(number, bus_bytes, seed=0):
    """Return a packet of that many beats, with one byte missing."""
    return random.Random(f"{number} {seed}").randbytes(number * bus_bytes - (bus_bytes > 1))


def ros_packets(name, bus_bytes, count):
    plan = build_plan(lay_out(load_message(name)), bus_bytes=bus_bytes)
    return random_packets(plan, count)


@pytest.mark.parametrize("when_full", ["wait", "drop"])
@pytest.mark.parametrize("bus_bytes", BUS_WIDTHS)
@pytest.mark.sampled(14)
def test_packets_of_ros_leave_whole_and_in_order_under_any_stall(bus_bytes, when_full):
    # On a narrow bus, each packet takes many cycles.
    count = min(30, 5 + 3 * bus_bytes)
    packets = ros_packets("sensor_msgs/msg/JointState", bus_bytes, count)
    largest = max(map(len, packets))
    memory = max(2 * bus_bytes, 1 << (largest - 1).bit_length())
    fifo = PacketFifo(bus_bytes, memory, 3, when_full=when_full)
    bench = bench_of(fifo)
    bad = set(random.Random(bus_bytes).sample(range(count), count // 3))
    for stalls in (
        None,
        Stalls(0.3, max_cycles=9, seed=2),
        {"in": Stalls(0.7, max_cycles=5)},
        {"out": Stalls(0.7, max_cycles=5)},
    ):
        run = Run(fifo, packets, bad, bench, stalls=stalls)
        assert LARGE not in run.outcomes
        assert when_full == "drop" or FULL not in run.outcomes


@pytest.mark.parametrize("bus_bytes", BUS_WIDTHS)
@pytest.mark.sampled(3)
def test_latency_and_throughput_are_exact(bus_bytes):
    sizes = [1, 1, 1, 5, 1, 16, 2, 1, 8, 1, 1]
    packets = [of_beats(size, bus_bytes) for size in sizes]
    run = Run(PacketFifo(bus_bytes, 32 * bus_bytes, 16), packets)
    assert run.taken == list(range(run.taken[0], run.taken[0] + sum(sizes)))
    # Each packet leaves 4 cycles after its end, or directly after the one before it.
    free, want = 0, []
    for last, size in zip(run.lasts, sizes, strict=True):
        begin = max(free, last + LATENCY)
        want += range(begin, begin + size)
        free = begin + size
    assert run.left == want


@pytest.mark.parametrize("size", [1, 3, 16])
def test_a_beat_comes_and_a_beat_leaves_in_each_cycle(size):
    packets = [of_beats(size, 8, seed) for seed in range(120 // size)]
    run = Run(PacketFifo(8, 32 * 8, 32), packets)
    first, total = run.taken[0], size * len(packets)
    assert run.taken == list(range(first, first + total))
    begin = first + size - 1 + LATENCY
    assert run.left == list(range(begin, begin + total))


def test_aborted_packets_cost_their_beats_and_no_more():
    packets = [of_beats(size, 8) for size in (1, 7, 1, 1, 4, 8, 1) * 5]
    bad = set(range(len(packets))) - {5, 20}
    # The memory has two words more than the largest packet: aborted ones must leave nothing behind.
    run = Run(PacketFifo(8, 16 * 8, 4), packets, bad)
    assert run.taken == list(range(run.taken[0], run.taken[0] + len(run.taken)))


@pytest.mark.parametrize("bus_bytes", by_depth([1, 64], [1, 2, 8, 64]))
@pytest.mark.parametrize("when_full", ["wait", "drop"])
@pytest.mark.sampled(4)
def test_a_packet_as_large_as_the_memory_passes_and_a_larger_one_does_not(bus_bytes, when_full):
    whole = bytes(range(64)) * bus_bytes
    fifo = PacketFifo(bus_bytes, 64 * bus_bytes, 4, when_full=when_full)
    bench = bench_of(fifo)
    more, small = whole + b"!", b"ab"
    gap = {"in": Stalls.bits("0" * 200 + "1" * (beats_of(len(whole), bus_bytes)))}
    run = Run(fifo, [whole], bench=bench)
    assert run.outcomes == [KEPT]
    run = Run(fifo, [whole, whole, whole], bench=bench, stalls=gap, deadline=500)
    assert run.outcomes == [KEPT] * 3
    packets = [small, more, small, 5 * whole, small]
    slow = {"in": Stalls.bits("1110")}
    run = Run(fifo, packets, bench=bench, stalls=slow)
    assert run.outcomes == [KEPT, LARGE, KEPT, LARGE, KEPT]
    # A packet that is aborted and too large counts as bad.
    run = Run(fifo, packets, {1}, bench=bench)
    assert run.outcomes[1] == ABORTED


def test_without_a_consumer_the_link_is_held_exactly_when_nothing_has_room():
    bus, most = 4, 16
    fifo = PacketFifo(bus, most * bus, 64)
    packets = [of_beats(3, bus, seed) for seed in range(12)]
    waits = 100
    run = Run(fifo, packets, stalls={"out": Stalls.bits("0" * waits + "1" * 1000)})
    assert run.outcomes == [KEPT] * 12
    # Two words are in the registers of the reader.
    held = most + 2
    assert run.taken[:held] == list(range(held))
    assert run.taken[held] == waits + 2


@pytest.mark.parametrize("packets", [1, 2, 3, 8])
@pytest.mark.sampled(2)
def test_the_number_of_packets_is_a_limit(packets):
    fifo = PacketFifo(4, 1024, packets)
    # No size is that of a packet a power of two before.
    sent = [random.Random(seed).randbytes(1 + seed % 3) for seed in range(20)]
    waits = 60
    run = Run(fifo, sent, stalls={"out": Stalls.bits("0" * waits + "1" * 1000)})
    assert run.outcomes == [KEPT] * 20
    # One more packet is leaving already.
    assert sum(cycle < waits for cycle in run.taken) == packets + 1
    fifo = PacketFifo(4, 1024, packets, when_full="drop")
    gap = {"in": Stalls.bits("00001"), "out": Stalls.bits("0" * 200 + "1" * 1000)}
    run = Run(fifo, sent, stalls=gap, deadline=300)
    assert run.outcomes == [KEPT] * (packets + 1) + [FULL] * (19 - packets)


def check_room(fifo):
    """Check in each cycle that a beat is taken if, and only if, one more packet may be stored."""
    sizes = [1] * 20 + [1, 1, 2, 1, 3, 1, 1, 1, 5, 1, 1] * 2
    packets = [of_beats(size, 4, seed) for seed, size in enumerate(sizes)]
    run = Run(fifo, packets)
    firsts = [run.left[sum(sizes[:number])] for number in range(len(sizes))]
    limited = 0
    for cycle in range(run.taken[0], run.taken[-1] + 1):
        ended = sum(last < cycle for last in run.lasts)
        begun = sum(first < cycle for first in firsts)
        has_room = ended - begun < fifo.shape.packets
        assert (cycle in run.taken) == has_room
        limited += not has_room
    assert limited


@pytest.mark.parametrize("packets", [1, 2, 3, 4])
@pytest.mark.sampled(2)
def test_a_packet_that_begins_to_leave_makes_room_in_the_next_cycle(packets):
    check_room(PacketFifo(4, 1024, packets))


def test_a_link_that_cannot_be_held_loses_whole_packets():
    fifo = PacketFifo(8, 16 * 8, 16, when_full="drop")
    sizes = [5, 5, 5, 5, 1, 1, 7, 2, 40, 1]
    packets = [of_beats(size, 8) for size in sizes]
    run = Run(fifo, packets, stalls={"out": Stalls.bits("0" * 300 + "1" * 1000)}, deadline=500)
    # 16 words, and two of the first packet in registers.
    want = [KEPT, KEPT, KEPT, FULL, KEPT, KEPT, FULL, FULL, FULL, KEPT]
    assert run.outcomes == want
    assert run.taken == list(range(run.taken[0], run.taken[0] + sum(sizes)))


def test_many_packets_of_random_sizes_in_a_small_memory():
    rng = random.Random(5)
    sizes = rng.choices([1, 2, 3, 7, 8, 9, 30], [6, 4, 4, 2, 2, 1, 1], k=300)
    packets = [of_beats(size, 2, seed) for seed, size in enumerate(sizes)]
    bad = {number for number in range(300) if rng.random() < 0.3}
    for when_full in ("wait", "drop"):
        fifo = PacketFifo(2, 16, 3, when_full=when_full)
        run = Run(fifo, packets, bad, stalls={"out": Stalls(0.4, max_cycles=3)})
        for number, (outcome, size) in enumerate(zip(run.outcomes, sizes, strict=True)):
            if number not in bad and when_full == "wait":
                assert outcome == (LARGE if size > 8 else KEPT)
        assert set(run.outcomes) == {KEPT, ABORTED, LARGE} | ({FULL} & {*run.outcomes})


def test_an_empty_packet_and_counts_that_are_not_kept():
    fifo = PacketFifo(8, 64, 4)
    run = Run(fifo, [b"", b"x", b"", b"12345678", b""])
    assert run.outcomes == [KEPT] * 5
    # A beat in the middle with another count leaves as a full one.
    bench = bench_of(fifo)
    wrong = [1 | 3 << 64, 2 | 0 << 64, 3 | 1 << 64 | 1 << 68]
    seen = bench.run({"in": wrong}, {"in": 3})
    assert [len(packet) for packet in seen.packets["out"]] == [17]


def test_reset_discards_all_and_the_next_beat_begins_a_packet(monkeypatch):
    monkeypatch.setattr("firm_hdl.sim.bench.RESET_CYCLES", 1)
    packets = [of_beats(size, 8, size) for size in (3, 5, 2)]
    for when_full in ("wait", "drop"):
        fifo, source = PacketFifo(8, 8 * 8, 2, when_full=when_full), list(beats(packets, 8))
        bench = bench_of(fifo, keeps_state=True)
        stuck = {"out": Stalls.bits("0" * 1000 + "1")}
        for count in range(1, 11):
            # A cut packet, and then one that is too large.
            for most in (source[:count], list(beats([of_beats(30, 8)], 8))[: count + 5]):
                with pytest.raises(DeadlineError):
                    bench.run({"in": most}, {"in": 99}, stalls=stuck, limit=50)
                run = Run(fifo, packets, {1}, bench)
                assert run.outcomes == [KEPT, ABORTED, KEPT]
                assert run.left[0] == run.lasts[0] + LATENCY


def test_counters_stop_at_their_largest_value():
    m, counters, event = Module(), Signal(counters_layout("a", "b")), Signal()
    add_counters(m, counters, {"a": event, "b": Const(0)})
    seen = []

    async def bench(ctx):
        ctx.set(counters.a, (1 << 32) - 3)
        ctx.set(event, 1)
        for _ in range(6):
            await ctx.tick()
            seen.append((1 << 32) - ctx.get(counters.a))

    simulator = Simulator(m)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    assert seen == [3, 2, 1, 1, 1, 1]


@pytest.mark.parametrize("when_full", ["wait", "drop"])
def test_no_output_depends_on_an_input_in_the_same_cycle(when_full):
    fifo = PacketFifo(4, 64, 4, when_full=when_full)
    came, out = fifo.packets_in, fifo.packets_out
    inputs = Cat(Value.cast(came.payload), came.valid, fifo.abort, out.ready)
    held = Cat(out.valid, Value.cast(out.payload), fifo.size, fifo.ended, Value.cast(fifo.outcome))
    assert not has_path(fifo, inputs, Cat(came.ready, held))


# Must-fail twins: a FIFO with a fault, which the checks find.


class _Broken(PacketWriter):
    """A writer with a further assignment, which overrides earlier ones."""

    def elaborate(self, platform):
        m = super().elaborate(platform)
        self.inject_fault(m)
        return m


class _ForgetsToAbort(_Broken):
    def inject_fault(self, m):
        came = self.packets
        ends = came.valid & came.ready & came.payload.last
        m.d.sync += [self.aborts.eq(0), self.keeps.eq(ends & ~self.drops)]
        with m.If(ends & ~self.drops):
            m.d.sync += self.rewinds.eq(0)


@pytest.mark.parametrize(
    "fault",
    [_ForgetsToAbort],
)
def test_a_fault_of_the_writer_is_found(monkeypatch, fault):
    packets = [of_beats(size, 8, size) for size in (3, 9, 2, 4, 8, 1, 1, 5, 3, 5)]
    stalls = {"out": Stalls.bits("0001")}
    assert LARGE in Run(PacketFifo(8, 64, 4), packets, {2, 4}, stalls=stalls).outcomes
    monkeypatch.setattr("firm_hdl.gateware.packets.fifo.PacketWriter", fault)
    with pytest.raises(AssertionError):
        Run(PacketFifo(8, 64, 4), packets, {2, 4}, stalls=stalls)


def test_parameters_are_checked():
    with pytest.raises(ValueError, match=r"^Bus width must be one of .* bytes, not 3$"):
        PacketFifo(3, 64, 4)
    for size in (8, 15, 100):
        with pytest.raises(ValueError, match=f"^Memory size .* two from 16 bytes on, not {size}$"):
            PacketFifo(8, size, 4)
    with pytest.raises(ValueError, match=r"^Number of packets must be at least 1, not 0$"):
        PacketFifo(8, 64, 0)
    for other in ("64", 64.0):
        with pytest.raises(TypeError, match=f"^Memory size must be an integer, not {other!r}$"):
            PacketFifo(8, other, 4)
        with pytest.raises(TypeError, match=f"^Number of packets must .* integer, not {other!r}$"):
            PacketFifo(8, 64, other)
    with pytest.raises(ValueError, match=r"^Policy must be 'wait' or 'drop', not 'hold'$"):
        PacketFifo(8, 64, 4, when_full="hold")
