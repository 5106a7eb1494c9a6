# amaranth: UnusedElaboratable=no
"""The packet gate: only good packets pass, whole; each has a status; none blocks the gate."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Cat, Value

from firm_hdl import Deserializer, GateStatus, PacketGate, load_message
from firm_hdl.gateware.packets.gate import _Verdicts
from firm_hdl.model import PRIMITIVES, Field, Message, Sequence
from firm_hdl.sim import DeadlineError, Harness, RunOptions, Stalls
from firm_hdl.sim.payloads import beats_of
from tests.depth import by_depth
from tests.gateware.packets.bench import beats
from tests.gateware.packets.gates import (
    BACKLOG,
    BOMB,
    DIAGNOSTICS,
    ERROR,
    FULL,
    LARGE,
    LATENCY,
    NO_BOMB,
    OK,
    OVERRUN,
    GateRun,
    expected_statuses,
    gate_bench,
)
from tests.gateware.test_parser import BAD, GOOD, HEADER, random_packets
from tests.gateware.traffic import has_path
from tests.strategies import BUS_WIDTHS, make

TYPES = [
    (HEADER, "lyrical"),
    ("sensor_msgs/Imu", "noetic"),
    (DIAGNOSTICS, "lyrical"),
    ("sensor_msgs/msg/PointCloud2", "lyrical"),
    ("std_msgs/Empty", "noetic"),
]


@pytest.mark.parametrize(
    ("name", "distro", "bus_bytes"),
    # Large packets on a narrow bus, small ones on a wide one, and more of fixed size are left to
    # thorough tests.
    [
        pytest.param(*each, bus, marks=[pytest.mark.thorough] if is_left else [])
        for each in TYPES
        for small in [each[0] in (HEADER, "std_msgs/Empty")]
        for bus in (2, 8)
        for is_left in [small == (bus == 8) or each[0] == "sensor_msgs/Imu"]
    ],
)
@pytest.mark.sampled(4)
def test_only_good_packets_pass_whole_and_in_order_under_any_stall(name, distro, bus_bytes):
    message = load_message(name, distro=distro)
    most = 10_000
    _, packets = random_packets(message, bus_bytes, by_depth(3, 4))
    want = expected_statuses(message, packets, bus_bytes, most)
    largest = max(map(len, packets))
    memory = max(2 * bus_bytes, 1 << largest.bit_length())
    gate = PacketGate(
        message, bus_bytes=bus_bytes, memory_bytes=memory, packets=4, max_message_bytes=most
    )
    bench = gate_bench(gate)
    for stalls in (
        None,
        Stalls(0.3, max_cycles=9, seed=2),
        {"out": Stalls(0.8, max_cycles=5), "in": Stalls(0.1)},
        {"status": Stalls.bits("0" * 40 + "1")},
    ):
        assert GateRun(gate, packets, bench, stalls=stalls).statuses == want


@pytest.mark.parametrize("when_full", ["wait", "drop"])
@pytest.mark.parametrize("bus_bytes", BUS_WIDTHS)
@pytest.mark.sampled(14)
def test_bad_packets_of_each_kind_between_good_ones(bus_bytes, when_full):
    good = bytes.fromhex(GOOD)
    packets, want = [good], [OK]
    for text, status in BAD.values():
        packets += [bytes.fromhex(text), good]
        want += [GateStatus[status], OK]
    gate = PacketGate(
        load_message(HEADER), bus_bytes=bus_bytes, memory_bytes=256, when_full=when_full
    )
    gap = None if when_full == "wait" else {"in": Stalls.bits("01")}
    run = GateRun(gate, packets, stalls=gap)
    assert run.statuses == want
    # The cycles of an error are fewer than the beats of these packets on a narrow bus.
    if when_full == "wait" and bus_bytes < 4:
        assert run.taken == list(range(run.taken[0], run.taken[0] + len(run.taken)))


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("bus_bytes", "more"),
    by_depth([(1, 0), (8, 0), (64, 1)], [(1, 0), (2, 0), (4, 0), (8, 0), (64, 1)]),
)
def test_latency_is_exact(bus_bytes, more):
    good, bad = bytes.fromhex(GOOD), bytes.fromhex(GOOD)[:11]
    packets = [good, bad, good]
    gate = PacketGate(load_message(HEADER), bus_bytes=bus_bytes, memory_bytes=1024)
    run = GateRun(gate, packets, stalls={"in": Stalls.bits("0" * 15 + "1")})
    late = [time - last for time, last in zip(run.times, run.lasts, strict=True)]
    assert late[0] == late[2] == LATENCY + more
    assert LATENCY <= late[1] <= LATENCY + ERROR
    first = [run.left[0], run.left[beats_of(len(good), bus_bytes)]]
    assert first == [run.times[0], run.times[2]]


@pytest.mark.parametrize("bus_bytes", by_depth((1, 8, 64), BUS_WIDTHS))
@pytest.mark.sampled(3)
def test_a_beat_per_cycle_through_long_packets(bus_bytes):
    fields = (Field(name="data", type=Sequence(element=PRIMITIVES["ros1"]["uint8"])),)
    message = Message(name="p/Long", dialect="ros1", fields=fields)
    sizes = [700, 64, 701, 300] if bus_bytes > 1 else by_depth([200, 64, 201], [700, 64, 701, 300])
    packets = [size.to_bytes(4, "little") + random.Random(size).randbytes(size) for size in sizes]
    gate = PacketGate(message, bus_bytes=bus_bytes, memory_bytes=4096)
    run = GateRun(gate, packets)
    total = sum(beats_of(len(packet), bus_bytes) for packet in packets)
    assert run.taken == list(range(run.taken[0], run.taken[0] + total))
    free = 0
    for packet, status, last in zip(packets, run.times, run.lasts, strict=True):
        assert LATENCY <= status - last <= LATENCY + 2
        begin = max(status, free)
        free = begin + beats_of(len(packet), bus_bytes)
        assert run.left[: free - begin] == list(range(begin, free))
        del run.left[: free - begin]


@pytest.mark.parametrize("bus_bytes", by_depth((8,), BUS_WIDTHS))
def test_a_packet_that_claims_nearly_a_million_elements_costs_its_beats_and_a_few_cycles(bus_bytes):
    gate = PacketGate(load_message(DIAGNOSTICS), bus_bytes=bus_bytes, memory_bytes=256)
    packets = [BOMB, NO_BOMB, BOMB, BOMB, NO_BOMB]
    bench = gate_bench(gate)
    run = GateRun(gate, packets, bench)
    assert [status.name for status in run.statuses] == "TRUNCATED OK TRUNCATED TRUNCATED OK".split()
    # The gate is free again: the next packet is in, whole, and has its status.
    own, next_own = beats_of(len(BOMB), bus_bytes), beats_of(len(NO_BOMB), bus_bytes)
    assert run.lasts[1] - run.taken[0] + 1 <= own + 16 + next_own
    assert run.times[0] - run.taken[0] + 1 <= own + 16 + LATENCY
    if bus_bytes == 8:
        # The parser takes 15 cycles for a bomb, and 3 for the beats of the other packet.
        assert run.times == [24, 27, 42, 57, 60]
    # The delays of many bombs do not add up.
    many = GateRun(gate, [BOMB] * 20 + [NO_BOMB], bench)
    steps = len(BOMB) // 4 + 4
    assert many.times[-1] <= 20 * max(own, steps) + next_own + LATENCY + ERROR


@pytest.mark.parametrize("bus_bytes", by_depth([1, 8], [1, 8, 64]))
@pytest.mark.parametrize("when_full", ["wait", "drop"])
@pytest.mark.sampled(4)
def test_a_packet_as_large_as_the_memory_passes_and_a_larger_one_does_not(bus_bytes, when_full):
    fields = (Field(name="data", type=Sequence(element=PRIMITIVES["ros1"]["uint8"])),)
    message = Message(name="p/Long", dialect="ros1", fields=fields)
    memory = 32 * bus_bytes

    def packet(size):
        return (size - 4).to_bytes(4, "little") + bytes(size - 4)

    whole, more, small = packet(memory), packet(memory + 1), packet(10)
    cut = more[:-1]
    packets = [small, more, small, whole, more, whole, cut, small]
    want = [OK, LARGE, OK, OK, LARGE, OK, GateStatus.TRUNCATED, OK]
    gate = PacketGate(message, bus_bytes=bus_bytes, memory_bytes=memory, when_full=when_full)
    gap = {"in": Stalls.bits("0" * 80 + "1" * beats_of(memory + 1, bus_bytes))}
    bench = gate_bench(gate)
    if when_full == "wait":
        assert GateRun(gate, packets, bench).statuses == want
    for each, status in zip(packets, want, strict=True):
        assert GateRun(gate, [each], bench, stalls=gap).statuses == [status]


def test_the_link_is_held_exactly_when_nothing_has_room():
    memory, bus = 256, 8
    good, bad = bytes.fromhex(GOOD), bytes.fromhex(GOOD)[:11]
    gate = PacketGate(load_message(HEADER), bus_bytes=bus, memory_bytes=memory)
    waits = 200
    # Bad packets need no memory, whatever precedes them.
    packets = [good, *[bad] * 30, *[good] * 20]
    stalls = {"out": Stalls.bits("0" * waits + "1" * 1000)}
    run = GateRun(gate, packets, stalls=stalls, deadline=400)
    inside = sum(cycle < waits for cycle in run.taken)
    # Two words are in the registers of the reader. The parser has 2 statuses, and its ring is full.
    assert inside == 30 * 2 + memory // bus + 2 + 15
    # The link was held long before the output starts, and is free soon afterwards.
    assert run.taken[inside - 1] < waits - 30 < run.taken[inside] <= waits + 6


@pytest.mark.thorough
def test_behind_a_gate_the_status_of_a_deserializer_is_ok():
    message = load_message("sensor_msgs/msg/PointCloud2")
    _, packets = random_packets(message, 8, 8)
    gate = PacketGate(message, memory_bytes=4096, max_message_bytes=10_000)
    passed = GateRun(gate, packets).packets
    rx = Deserializer(message, max_message_bytes=10_000)
    seen = Harness(rx, None, message=message).run_packets(passed, RunOptions())
    assert {status.name for status in seen.statuses} == {"OK"}
    assert len(seen.statuses) == len(passed) < len(packets)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("when_full", ["wait", "drop"])
def test_reset_in_the_middle_discards_all(when_full, monkeypatch):
    # A reset of one cycle leaves no time for what a register without a reset could hide.
    monkeypatch.setattr("firm_hdl.sim.bench.RESET_CYCLES", 1)
    good, bad = bytes.fromhex(GOOD), bytes.fromhex(GOOD)[:11]
    packets = [good, bad, BOMB, good]
    gate = PacketGate(load_message(HEADER), bus_bytes=4, memory_bytes=128, when_full=when_full)
    bench = gate_bench(gate, keeps_state=True)
    want = expected_statuses(load_message(HEADER), packets, 4)
    source = list(beats(packets, 4))
    for count in range(1, len(source), by_depth(3, 1)):
        with pytest.raises(DeadlineError):
            stuck = {"out": Stalls.bits("0" * 99 + "1"), "status": Stalls.bits("0" * 99 + "1")}
            bench.run({"in": source[:count]}, {"in": 99}, stalls=stuck, limit=count + 2 + count % 7)
        run = GateRun(gate, packets, bench)
        assert run.statuses == want
        assert run.left[0] == run.lasts[0] + LATENCY + (BACKLOG if when_full == "drop" else 0)


# The gate of seed 0 reads packets of 300 bytes on a narrow bus.
@pytest.mark.parametrize(
    "seed", [*(pytest.param(seed, marks=pytest.mark.thorough) for seed in (0, 1)), 2, 3, 4]
)
@pytest.mark.sampled(3)
def test_random_gates_with_random_stalls_and_resets(seed):
    rng = random.Random(seed)
    name, distro = rng.choice([("std_msgs/msg/Bool", "lyrical"), *TYPES])
    message, bus = load_message(name, distro=distro), rng.choice(BUS_WIDTHS)
    most = 10_000
    packets = rng.choices(random_packets(message, bus, 5)[1], k=20)
    memory = 1 << rng.randrange((2 * bus).bit_length() - 1, 11)
    when_full = "wait" if seed % 2 else "drop"
    gate = PacketGate(
        message,
        bus_bytes=bus,
        memory_bytes=memory,
        packets=rng.choice([1, 2, 3, 8]),
        when_full=when_full,
        max_message_bytes=most,
    )
    bench = gate_bench(gate, keeps_state=True)
    bad = expected_statuses(message, packets, bus, most)
    for _ in range(2):
        stalls = {
            each: Stalls(rng.choice([0, 0.3, 0.8]), max_cycles=rng.choice([1, 5, 40]), seed=seed)
            for each in ("in", "out", "status")
        }
        run = GateRun(gate, packets, bench, stalls=stalls, deadline=3000)
        for packet, status, alone in zip(packets, run.statuses, bad, strict=True):
            large = beats_of(len(packet), bus) * bus > memory
            want = LARGE if large and alone == OK else alone
            lost = {OVERRUN} | ({FULL} if alone == OK else set())
            assert status == want or (when_full == "drop" and status in lost)
        # Stop somewhere; the next run begins with a reset.
        source = list(beats(packets, bus))[: rng.randrange(1, 60)]
        with pytest.raises(DeadlineError):
            bench.run({"in": source}, {"in": 1000}, stalls=stalls, limit=rng.randrange(100))


@pytest.mark.parametrize("when_full", ["wait", "drop"])
@pytest.mark.sampled(2)
def test_no_output_depends_on_an_input_in_the_same_cycle(when_full):
    gate = PacketGate(load_message(HEADER), bus_bytes=4, memory_bytes=64, when_full=when_full)
    came, out, status = gate.packets_in, gate.packets_out, gate.status
    inputs = Cat(Value.cast(came.payload), came.valid, out.ready, status.ready)
    held = Cat(out.valid, Value.cast(out.payload), gate.size)
    status_bits = Cat(status.valid, Value.cast(status.payload))
    assert not has_path(gate, inputs, Cat(came.ready, held, status_bits))


def test_a_gate_judges_by_the_wire_that_is_asked_for():
    message = make("ros2", {"a": "uint8", "s": "string"})
    packets = [b"\7\2\0\0\0hi", b"\0\1\0\0\7\0\0\0\3\0\0\0hi\0"]
    for wire, want in (("ros1", [OK, GateStatus.LENGTH]), ("cdr", [GateStatus.ENCAPSULATION, OK])):
        assert GateRun(PacketGate(message, wire=wire, memory_bytes=64), packets).statuses == want


def test_parameters_are_checked():
    message = load_message(HEADER)
    with pytest.raises(ValueError, match=r"^Policy must be 'wait' or 'drop', not 'hold'$"):
        PacketGate(message, when_full="hold")
    with pytest.raises(ValueError, match=r"^Memory size must be a power of two from 16 bytes"):
        PacketGate(message, memory_bytes=100)
    least = r"^Memory size must be at least 16 bytes, the least that a .*Header has, not 8$"
    with pytest.raises(ValueError, match=least):
        PacketGate(message, bus_bytes=4, memory_bytes=8)
    assert PacketGate(message, memory_bytes=16).shape.beats == 2
    with pytest.raises(TypeError, match=r"^Message must be a Message"):
        PacketGate("std_msgs/msg/Header")


# Must-fail twins: a gate with a fault, which the checks find.


class _DoesNotWaitForTheVerdict(_Verdicts):
    def __init__(self, m, gate, *others):
        super().__init__(m, gate, *others)
        m.d.comb += self.fifo.packets_in.valid.eq(self.has_head)


def check_text_gate():
    message, bus, good, cut, count = by_depth(
        (make("ros1", {"s": "string"}, "Text"), 4, b"\2\0\0\0ab", 5, 12),
        (load_message(HEADER), 8, bytes.fromhex(GOOD), 11, 20),
    )
    packets = [good, good[:cut]] * count
    gate = PacketGate(message, bus_bytes=bus, memory_bytes=64)
    run = GateRun(gate, packets, stalls={"status": Stalls.bits("0" * by_depth(60, 150) + "1" * 3)})
    assert run.statuses == expected_statuses(message, packets, bus)


@pytest.fixture(scope="module")
def right_gate():
    """See that the check passes without a fault, once for all faults."""
    check_text_gate()


@pytest.mark.usefixtures("right_gate")
@pytest.mark.parametrize("fault", [_DoesNotWaitForTheVerdict])
def test_a_fault_of_the_gate_is_found(monkeypatch, fault):
    monkeypatch.setattr("firm_hdl.gateware.packets.gate._Verdicts", fault)
    with pytest.raises(AssertionError):
        check_text_gate()
