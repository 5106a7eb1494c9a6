# amaranth: UnusedElaboratable=no
"""The parser, compared with the plan's interpreter, and its bounds in cycles."""

from __future__ import annotations

import random
from dataclasses import dataclass
from functools import cache

import pytest
from amaranth.hdl import Cat, Value
from amaranth.sim import Simulator
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from firm_hdl import Parser, Status, load_message
from firm_hdl.gateware.parse import OrderQueue
from firm_hdl.gateware.parser import PacketSizes
from firm_hdl.model import PRIMITIVES, Field, Message, Sequence
from firm_hdl.plan import Loop, build_plan, decode, encode
from firm_hdl.sim import Stalls, to_transfers
from firm_hdl.sim.bench import Job, RunOptions
from firm_hdl.sim.payloads import all_beats, beats_of
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.traffic import has_path, is_quick, parser_bench
from tests.plan.test_random_messages import damaged, typed_values
from tests.strategies import BUS_WIDTHS

few = settings(
    deadline=None,
    max_examples=by_depth(2, 12),
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
LATENCY = 4
ERROR = 4
"""Cycles from the last beat to the status, and the most cycles that an error adds."""

SOME_WIDTHS = by_depth([1, 8], [1, 2, 4, 8, 64])

MOST = 10_000
"""Most bytes of a message: the interpreter completes what a damaged length claims."""

GAP = Stalls.bits("0" * by_depth(9, 15) + "1")
HEADER = "std_msgs/msg/Header"


@cache
def header_parser(bus_bytes):
    return Parser(load_message(HEADER), bus_bytes=bus_bytes)


@dataclass
class Trace:
    """The record of a run: statuses, sizes, and the cycles of beats and statuses."""

    statuses: list[Status]
    sizes: list[int]
    trailing: list[int]
    beats: list[int]
    times: list[int]

    def late(self, packets, bus_bytes):
        """Return the cycles from the last beat of each packet to its status."""
        ends, beat = [], -1
        for packet in packets:
            beat += beats_of(len(packet), bus_bytes)
            ends.append(self.beats[beat])
        return [time - end for time, end in zip(self.times, ends, strict=True)]


def run(parser, packets, **options):
    """Send packets, with random bytes in lanes that are not valid."""
    seen = Trace([], [], [], [], [])

    def take(cycle, bits):
        seen.times.append(cycle)
        seen.statuses.append(Status(bits & 7))
        seen.sizes.append(bits >> 3 & 0xFFFFFFFF)
        seen.trailing.append(bits >> 35)

    job = Job(
        sources={"packets": all_beats(packets, parser.plan.bus_bytes, counts=True)},
        takes={"packets": lambda cycle, _: seen.beats.append(cycle), "status": take},
        finished=lambda: len(seen.times) == len(packets),
        outstanding=lambda: f"{len(packets) - len(seen.times)} statuses",
        options=RunOptions(**options),
    )
    parser_bench(parser).run(job)
    assert seen.sizes == [len(packet) for packet in packets]
    return seen


@pytest.mark.sampled(3)
@pytest.mark.parametrize("bus_bytes", by_depth((1, 8, 64), BUS_WIDTHS))
def test_a_wrong_header_is_found_when_its_packet_has_filled_the_ring(bus_bytes):
    # The end of the third packet waits for a status to be taken. Meanwhile, the fourth one fills
    # the ring; what it has there is as much as the ring can hold.
    good, bad = bytes([0, 1]) + bytes(14), bytes([0xFF]) + bytes(63 * bus_bytes)
    packets = [good, good, good, bad, good]
    stalls = {"status": Stalls.bits("0" * 600 + "1" * 100)}
    seen = run(header_parser(bus_bytes), packets, stalls=stalls)
    assert seen.statuses == [Status.OK] * 3 + [Status.ENCAPSULATION, Status.OK]


def agree(plan, packets, seen):
    """Check statuses and trailing bytes against the interpreter of a converter's plan."""
    decoded = [decode(plan, packet) for packet in packets]
    assert seen.statuses == [Status[str(one.status)] for one in decoded]
    for packet, one, trailing in zip(packets, decoded, seen.trailing, strict=True):
        if one.status == "OK":
            whole = {leaf: iter(payloads) for leaf, payloads in one.streams.items()}
            assert len(packet) - trailing == len(encode(plan, whole)[0])


@pytest.mark.sampled(2)
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@few
@given(
    data=st.data(),
    case=typed_values(wide=True),
    bus_bytes=st.sampled_from(BUS_WIDTHS),
    probability=st.sampled_from([0.0, 0.3, 0.8]),
)
def test_random_packets_get_the_status_of_the_interpreter(wire, data, case, bus_bytes, probability):
    definition, value = case
    layout = lay_out(definition.message, wire)
    plan = build_plan(layout, bus_bytes=bus_bytes, max_message_bytes=100_000)
    assume(is_quick(plan))
    good = encode(plan, to_transfers(plan, definition.message, value))[0]
    packets = [good]
    for packet in data.draw(st.lists(damaged(good), min_size=1, max_size=6)):
        packets += [packet, good]
    parser = Parser(definition.message, wire=wire, bus_bytes=bus_bytes, max_message_bytes=100_000)
    stalls = Stalls(probability=probability, max_cycles=5, seed=1)
    agree(plan, packets, run(parser, packets, stalls=stalls))


def random_packets(message, bus_bytes, count):
    """Return packets of random values, with damaged packets between them."""
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes, max_message_bytes=MOST)
    rng = random.Random(f"{message.name} {bus_bytes}")
    counts = {
        begin.count.leaf: [0, 1, 2, 3] if isinstance(begin, Loop) else [0, 1, 3, 5, 9, 20]
        for begin in plan.begins.values()
    }

    def payloads(index, leaf):
        items = 1 << (1 if leaf.type == "bool" else 8 * leaf.item_bytes)
        low = items // 2 if leaf.signed else 0
        while True:
            if leaf.kind == "length":
                yield rng.choice(counts[index])
            elif leaf.kind == "items":
                yield tuple(rng.randrange(items) - low for _ in range(leaf.lanes)), False
            else:
                yield 1 if leaf.kind == "trigger" else rng.randrange(items) - low

    packets = []
    for _ in range(count):
        streams = {index: payloads(index, leaf) for index, leaf in enumerate(plan.leaves)}
        good = encode(plan, streams)[0]
        bad = bytearray(good)
        match rng.randrange(3):
            case 0:
                del bad[rng.randrange(len(bad) + 1) :]
            case 1:
                bad += rng.randbytes(rng.randrange(1, 3 * bus_bytes + 4))
            case _ if bad:
                bad[rng.randrange(len(bad))] ^= 1 << rng.randrange(8)
        packets += [good, bytes(bad)]
    return plan, packets


def test_another_status_is_noticed():
    message = load_message(HEADER)
    plan, packets = random_packets(message, 8, 4)
    seen = run(Parser(message, max_message_bytes=16), packets)
    with pytest.raises(AssertionError):
        agree(plan, packets, seen)


# Each type, and the width on which `make test` sends it: one type of each kind.
ROS_TYPES = [
    ("std_msgs/msg/Header", "lyrical", 1),
    ("sensor_msgs/msg/Imu", "lyrical", None),
    ("sensor_msgs/Imu", "noetic", None),
    ("diagnostic_msgs/msg/DiagnosticArray", "lyrical", 8),
    ("sensor_msgs/msg/PointCloud2", "lyrical", 1),
    ("rcl_interfaces/msg/ParameterValue", "lyrical", None),
    ("geometry_msgs/Polygon", "noetic", 8),
    ("std_msgs/Empty", "noetic", 1),
]


@pytest.mark.parametrize(
    ("name", "distro", "bus_bytes"),
    [
        pytest.param(name, distro, bus, marks=[] if bus == usual else [pytest.mark.thorough])
        for name, distro, usual in ROS_TYPES
        for bus in SOME_WIDTHS
    ],
)
@pytest.mark.sampled(6)
def test_damaged_packets_of_ros_types(name, distro, bus_bytes):
    message = load_message(name, distro=distro)
    plan, packets = random_packets(message, bus_bytes, by_depth(2 if bus_bytes == 1 else 4, 16))
    parser = Parser(message, bus_bytes=bus_bytes, max_message_bytes=MOST)
    for stalls in (None, {"status": Stalls.bits("0000001")}):
        agree(plan, packets, run(parser, packets, stalls=stalls))


GOOD = "00010000 01000000 02000000 05000000 61626364 00"
BAD = {
    "cut in a number": (GOOD[:22], "TRUNCATED"),
    "empty": ("", "TRUNCATED"),
    "long": (GOOD + "000000" + "00", "TRAILING"),
    "very long": (GOOD + 50 * "00", "TRAILING"),
    "long string": (GOOD.replace("05000000", "ffffffff"), "LENGTH"),
    "other encapsulation": ("0003" + GOOD[4:], "ENCAPSULATION"),
    "no NUL": (GOOD[:-2] + "61", "STRING"),
    "no NUL, and cut": (GOOD.replace("05000000", "04000000")[:-3], "STRING"),
}


@pytest.mark.parametrize(("bus_bytes", "more"), [(1, 0), (2, 0), (4, 0), (8, 0), (64, 1)])
@pytest.mark.sampled(6)
def test_latency_is_exact(bus_bytes, more):
    packets = [bytes.fromhex(GOOD)] * 3
    seen = run(header_parser(bus_bytes), packets, stalls={"packets": GAP})
    assert seen.statuses == [Status.OK] * 3
    # A bus of 64 bytes has two steps in the only beat, one of which is the rest of the string.
    assert seen.late(packets, bus_bytes) == [LATENCY + more] * 3


@pytest.mark.parametrize("bus_bytes", SOME_WIDTHS)
@pytest.mark.parametrize(("text", "status"), BAD.values(), ids=BAD)
@pytest.mark.sampled(9)
def test_error_delays_its_status_by_a_few_cycles_and_no_other(text, status, bus_bytes):
    good, bad = bytes.fromhex(GOOD), bytes.fromhex(text)
    packets = [bad, good, bad, bad, good]
    seen = run(header_parser(bus_bytes), packets, stalls={"packets": GAP})
    assert [each.name for each in seen.statuses] == [status, "OK", status, status, "OK"]
    late = seen.late(packets, bus_bytes)
    # The first packet of each has no packet before it.
    assert LATENCY <= late[0] <= LATENCY + ERROR
    assert late[0] == late[2] == late[3]
    assert late[1] == late[4] == LATENCY + (bus_bytes == 64)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", by_depth((1, 8), BUS_WIDTHS))
def test_a_packet_that_claims_nearly_a_million_elements_costs_its_own_beats(bus_bytes):
    name = "diagnostic_msgs/msg/DiagnosticArray"
    text = "00010000 01000000 02000000 01000000 00 000000 00350c00"
    bomb = bytes.fromhex(text).ljust(60, b"\0")
    good = bytes.fromhex(text[:-8] + "00000000")
    message = load_message(name)
    # A deserializer has to complete the sequence: it gives 800,000 elements.
    packets = [bomb, good, bomb, good]
    seen = run(Parser(message, bus_bytes=bus_bytes), packets)
    assert [status.name for status in seen.statuses] == ["TRUNCATED", "OK"] * 2
    beats = sum(beats_of(len(packet), bus_bytes) for packet in packets)
    # An empty string of zeros is a step, so that a wide bus has several steps per beat.
    steps = 2 * (len(bomb) // 4 + 4)
    assert max(seen.times) <= max(beats, steps) + LATENCY + 2 * ERROR
    if bus_bytes == 8:
        # The cycles in `docs/reference/parts.md`.
        assert run(Parser(message), [bomb] * 3).times == [19, 34, 49]


@pytest.mark.parametrize("bus_bytes", BUS_WIDTHS)
@pytest.mark.parametrize("kind", ["uint8", "float64"])
@pytest.mark.sampled(15)
def test_a_beat_per_cycle_through_long_arrays(kind, bus_bytes):
    fields = (Field(name="data", type=Sequence(element=PRIMITIVES["ros1"][kind])),)
    message = Message(name="p/Long", dialect="ros1", fields=fields)
    size = PRIMITIVES["ros1"][kind].bytes
    most = by_depth(max(200, 11 * bus_bytes), 700)
    counts = (most, 64, most + 1)
    packets = [count.to_bytes(4, "little") + bytes(count * size) for count in counts]
    seen = run(Parser(message, wire="ros1", bus_bytes=bus_bytes), packets)
    assert seen.statuses == [Status.OK] * 3
    assert seen.beats == list(range(seen.beats[0], seen.beats[0] + len(seen.beats)))
    assert seen.late(packets, bus_bytes)[-1] <= LATENCY + 2


def test_a_packet_per_cycle():
    packets = [b"\0\1\0\0\1"] * 50
    seen = run(Parser(load_message("std_msgs/msg/Bool"), bus_bytes=8), packets)
    assert seen.beats == list(range(seen.beats[0], seen.beats[0] + 50))
    assert seen.late(packets, 8) == [LATENCY] * 50


def test_a_status_that_is_not_taken_holds_the_end_of_the_next_packet_but_one():
    good = bytes.fromhex(GOOD)
    packets = [good] * 4
    parser = Parser(load_message(HEADER), bus_bytes=1)
    waits = 5 * len(good)
    seen = run(parser, packets, stalls={"status": Stalls.bits("0" * waits + "1" * 1000)})
    # Beats after the third packet fill the buffer.
    end_of_third = 3 * len(good)
    assert seen.beats[:end_of_third] == list(range(end_of_third))
    assert end_of_third < sum(beat < waits for beat in seen.beats) < end_of_third + 20
    # The third packet ends when the first status has been taken.
    assert seen.times[:3] == [waits, waits + 1, waits + 3]
    assert seen.statuses == [Status.OK] * 4


def test_no_output_depends_on_an_input_in_the_same_cycle():
    parser = Parser(load_message(HEADER), bus_bytes=4)
    packets, status = parser.packets, parser.status
    inputs = Cat(Value.cast(packets.payload), packets.valid, status.ready)
    held = Cat(status.valid, Value.cast(status.payload), Value.cast(parser.sizes))
    assert not has_path(parser, inputs, Cat(packets.ready, held))
    # An existing path is found.
    queue = OrderQueue(parser.plan)
    assert has_path(queue, queue.oldest, queue.freed)


def test_the_size_of_a_packet_saturates():
    parser = Parser(load_message("std_msgs/msg/Bool"), bus_bytes=8)
    sizes = PacketSizes(parser.plan)
    seen = []

    async def bench(ctx):
        for count in (8, 7, 8):
            # Start at a count of 2**32 - 8 bytes.
            ctx.set(sizes.beats, (1 << 29) - 1)
            ctx.set(sizes.beat, {"valid": 1, "last": 1, "count": count})
            await ctx.tick()
            ctx.set(sizes.beat, {"valid": 0})
            seen.append(ctx.get(sizes.bytes))
            ctx.set(sizes.next, 1)
            await ctx.tick()
            ctx.set(sizes.next, 0)
        # Beats in the middle of such a packet.
        ctx.set(sizes.beats, (1 << 29) - 1)
        ctx.set(sizes.beat, {"valid": 1, "last": 0, "count": 8})
        await ctx.tick().repeat(3)
        ctx.set(sizes.beat, {"valid": 1, "last": 1, "count": 1})
        await ctx.tick()
        seen.append(ctx.get(sizes.bytes))
        # The packet after it begins at 0.
        ctx.set(sizes.beat, {"valid": 1, "last": 1, "count": 5})
        ctx.set(sizes.next, 1)
        await ctx.tick()
        seen.append(ctx.get(sizes.bytes))

    simulator = Simulator(sizes)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    assert seen == [*[(1 << 32) - 1] * 4, 5]


def test_parameters_are_those_of_converters():
    message = load_message(HEADER)
    with pytest.raises(ValueError, match=r"^Bus width must be one of .* bytes, not 3$"):
        Parser(message, bus_bytes=3)
    with pytest.raises(ValueError, match=r"^Maximum message size must be from 16 bytes"):
        Parser(message, max_message_bytes=15)
    with pytest.raises(ValueError, match=r"^Wire must be one of"):
        Parser(message, wire="xcdr2")
    with pytest.raises(TypeError, match=r"^Message must be a Message"):
        Parser("std_msgs/msg/Header")
