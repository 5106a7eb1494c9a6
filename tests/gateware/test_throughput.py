# amaranth: UnusedElaboratable=no
"""Exact cycles: those of the plan, and the latency."""

from __future__ import annotations

import random
from functools import lru_cache

import pytest

from firm_hdl import Deserializer, Library, Serializer, load_message
from firm_hdl.gateware.signatures import LATENCY_CYCLES
from firm_hdl.plan import build_plan, decode, encode
from firm_hdl.sim import Harness, Stalls, leaf_name, to_transfers
from firm_hdl.sim.bench import Job, RunOptions
from firm_hdl.sim.payloads import all_beats, encoder_of
from firm_hdl.timing.cycles import (
    cycles_between,
    deserializer_cycles,
    packet_of,
    serializer_cycles,
)
from firm_hdl.wire import lay_out
from tests.depth import THOROUGH, by_depth
from tests.gateware.traffic import random_packets
from tests.strategies import make

PACKETS = by_depth(12, 40)
PAUSE = 16
BOTH = sum(LATENCY_CYCLES.values())
DISTROS = ("noetic", "foxy", "humble", "iron", "jazzy", "kilted", "lyrical")


# Both converters, connected in series.


def run(message, packets, **options):
    harness = Harness(Deserializer(message, **options), Serializer(message, **options))
    seen = harness.run_packets(packets)
    assert seen.packets == packets
    return seen


def fixed_packets(message, count):
    """Return packets of a type of fixed size: random values, padding zero."""
    plan = Deserializer(message).plan
    rng = random.Random(message.name)
    size = len(encode(plan, decode(plan, b"\0\1\0\0" * (plan.header_bytes // 4)).streams)[0])
    header = size - plan.header_bytes
    packets = [plan.header_bytes // 4 * b"\0\1\0\0" + rng.randbytes(header) for _ in range(count)]
    return [encode(plan, decode(plan, packet).streams)[0] for packet in packets]


def fixed_types():
    """Yield each distinct definition of fixed size of every distribution."""
    seen = set()
    for distro in DISTROS:
        library = Library(distro)
        for name in library.names():
            key = (name, library.definition_hash(name))
            if key not in seen and library.message(name).is_fixed_size:
                seen.add(key)
                yield pytest.param(library.message(name), id=f"{distro}-{name}")


@pytest.mark.parametrize(
    "message",
    fixed_types() if THOROUGH else [Library("noetic").message("geometry_msgs/Pose2D")],
)
def test_types_of_fixed_size_run_at_line_rate(message):
    packets = fixed_packets(message, PACKETS)
    found = packet_of(build_plan(lay_out(message), bus_bytes=8), packets[0])
    assert cycles_between(found) == found.beats
    seen = run(message, packets)
    # No cycles per packet. The serializer may wait for the second half of a value, and its last
    # step may have two beats, which leave one after the other.
    assert seen.cycles - seen.beats_in - BOTH in (0, 1, 2)


# Each converter alone, compared with the plan.


def events(harness, sources, finished, stalls=None):
    """Return the cycles in which each stream transfers."""
    found = {name: [] for name in harness.bench.names}
    harness.bench.run(
        Job(
            sources=sources,
            takes={name: lambda cycle, bits, to=to: to.append(cycle) for name, to in found.items()},
            finished=lambda: finished(found),
            outstanding=lambda: "",
            options=RunOptions(stalls=stalls),
        )
    )
    return found


@lru_cache(maxsize=1)
def harness_of(rx):
    """Return a harness of a deserializer alone, the same one as long as it is the same."""
    return Harness(rx, None)


def measure_deserializer(rx, packets):
    """Return the cycle of each packet's status, counted from the first beat."""
    bus_bytes, count = rx.plan.bus_bytes, len(packets)
    sources = {"packets_in": list(all_beats(packets, bus_bytes))}
    found = events(harness_of(rx), sources, lambda found: len(found["status"]) == count)
    return [cycle - found["packets_in"][0] for cycle in found["status"]]


def measure_serializer(tx, packets):
    """Return the cycle of each packet's last beat, counted from the offer of all leaves."""
    plan = tx.plan
    sources = {leaf_name(plan, leaf): [] for leaf in range(len(plan.leaves))}
    for packet in packets:
        for leaf, payload in decode(plan, packet).transfers:
            sources[leaf_name(plan, leaf)].append(encoder_of(plan.leaves[leaf])(payload))
    ends, beats = [], 0
    for packet in packets:
        beats += packet_of(plan, packet).beats
        ends.append(beats - 1)
    out = events(
        Harness(None, tx),
        sources,
        lambda found: len(found["packets_out"]) == beats,
        stalls={"message": Stalls.bits("0" * PAUSE + "1" * 100_000)},
    )
    return [out["packets_out"][beat] - PAUSE for beat in ends]


def check(message, packets, bus_bytes):
    """Compare both converters with the plan; return the last cycle of each."""
    rx = Deserializer(message, bus_bytes=bus_bytes)
    tx = Serializer(message, bus_bytes=bus_bytes)
    traffic = [packet_of(rx.plan, packet) for packet in packets]
    read, write = deserializer_cycles(traffic), serializer_cycles(traffic)
    want = [cycle + LATENCY_CYCLES["deserializer"] for cycle in read]
    assert measure_deserializer(rx, packets) == want
    want = [cycle + LATENCY_CYCLES["serializer"] for cycle in write]
    assert measure_serializer(tx, packets) == want
    return read[-1], write[-1]


# Strings alone and in sequences, arrays in sequences, alignment, an empty end, and no rotator.
VARIED = [
    ("std_msgs/msg/String", "lyrical"),
    ("std_msgs/String", "noetic"),
    ("sensor_msgs/msg/JointState", "lyrical"),
    ("rcl_interfaces/msg/ParameterValue", "lyrical"),
    ("rosgraph_msgs/Log", "noetic"),
    ("shape_msgs/Mesh", "noetic"),
    ("std_msgs/msg/UInt64MultiArray", "lyrical"),
    ("action_msgs/msg/GoalStatusArray", "lyrical"),
    ("trajectory_msgs/msg/JointTrajectoryPoint", "lyrical"),
    ("geometry_msgs/msg/Twist", "lyrical"),
]
# More of the same, with many steps.
LARGE = [("rosgraph_msgs/Log", "noetic"), ("sensor_msgs/msg/JointState", "lyrical")]


@pytest.mark.parametrize(
    ("name", "distro", "bus_bytes"),
    [
        *((*each, 8) for each in VARIED if each not in LARGE),
        *(pytest.param(*each, 8, marks=pytest.mark.thorough) for each in LARGE),
        *((*each, bus) for each in VARIED[:3] for bus in by_depth((4,), (1, 2, 4, 16))),
        *((*each, 2) for each in VARIED[4:6]),
        (*VARIED[0], 64),
        pytest.param(*VARIED[2], 64, marks=pytest.mark.thorough),
    ],
)
@pytest.mark.sampled(16)
def test_each_packet_takes_the_cycles_of_the_plan(name, distro, bus_bytes):
    message = load_message(name, distro=distro)
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    check(message, random_packets(plan, by_depth(5, 8)), bus_bytes)


EMPTY = make("ros1", {}, "Empty")


@pytest.mark.parametrize("bus_bytes", by_depth([1, 8], [1, 4, 8]))
@pytest.mark.parametrize(
    "fields",
    [
        # Packets of lengths only, packets that may end in steps without bytes, and empty ones.
        {"a": "string", "b": "uint8[]", "c": (EMPTY, "[]")},
        {"a": "uint32", "e": (EMPTY, "[]")},
        {"e": EMPTY},
    ],
)
@pytest.mark.sampled(6)
def test_packets_with_few_bytes_take_the_cycles_of_the_plan(fields, bus_bytes):
    message = make("ros1", fields)
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    check(message, random_packets(plan, 12), bus_bytes)


def header(frame_id):
    return {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": frame_id}


def joints(count):
    names = [f"joint_{index}" for index in range(count)]
    numbers = [0.5] * count
    return {
        "header": header("base"),
        "name": names,
        "position": numbers,
        "velocity": numbers,
        "effort": numbers,
    }


TRANSFORM = {
    "header": header("odom"),
    "child_frame_id": "base_link",
    "transform": {
        "translation": {"x": 1.0, "y": 2.0, "z": 3.0},
        "rotation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
    },
}
VALUES = {
    "std_msgs/msg/String": {"data": "hello"},
    "std_msgs/msg/Header": header("camera"),
    "sensor_msgs/msg/JointState": joints(6),
    "tf2_msgs/msg/TFMessage": {"transforms": [TRANSFORM] * 3},
    "rcl_interfaces/msg/ListParametersResult": {"names": [], "prefixes": [""] * 10},
    "geometry_msgs/msg/Polygon": {"points": [{"x": 1.0, "y": 2.0, "z": 3.0}] * 10},
}
# Type, bytes of the bus, beats and steps of a packet, cycles from one to the next, and the last
# cycle of ten packets in the deserializer and in the serializer, without the latency.
TABLE = [
    ("std_msgs/msg/String", 1, 14, 12, 14, 139, 139),
    ("std_msgs/msg/String", 4, 4, 3, 4, 39, 40),
    ("std_msgs/msg/String", 8, 2, 2, 2, 19, 20),
    ("std_msgs/msg/String", 64, 1, 2, 2, 19, 20),
    ("std_msgs/msg/Header", 4, 6, 5, 6, 59, 59),
    ("std_msgs/msg/Header", 8, 3, 2, 3, 29, 30),
    ("sensor_msgs/msg/JointState", 2, 134, 97, 134, 1339, 1339),
    ("sensor_msgs/msg/JointState", 8, 34, 27, 36, 339, 360),
    ("sensor_msgs/msg/JointState", 16, 17, 18, 23, 179, 232),
    ("sensor_msgs/msg/JointState", 64, 5, 12, 17, 119, 171),
    ("tf2_msgs/msg/TFMessage", 4, 73, 55, 73, 729, 730),
    ("tf2_msgs/msg/TFMessage", 8, 37, 28, 37, 369, 370),
    ("tf2_msgs/msg/TFMessage", 16, 19, 16, 19, 189, 191),
    ("tf2_msgs/msg/TFMessage", 64, 5, 10, 10, 99, 101),
    # The same length again and again.
    ("rcl_interfaces/msg/ListParametersResult", 8, 12, 13, 22, 129, 220),
    ("rcl_interfaces/msg/ListParametersResult", 64, 2, 13, 22, 129, 220),
    ("geometry_msgs/msg/Polygon", 8, 16, 11, 16, 159, 160),
    ("geometry_msgs/msg/Polygon", 16, 8, 11, 11, 109, 110),
]


# Rows of small circuits and few beats: beats or steps are more, or the serializer's pauses.
QUICK = (
    ("std_msgs/msg/String", 1),
    ("std_msgs/msg/Header", 4),
    ("rcl_interfaces/msg/ListParametersResult", 8),
    ("geometry_msgs/msg/Polygon", 16),
)


@pytest.mark.parametrize(
    ("name", "bus_bytes", "beats", "steps", "cycles", "read", "write"),
    [pytest.param(*row, marks=[] if row[:2] in QUICK else [pytest.mark.thorough]) for row in TABLE],
)
@pytest.mark.sampled(4)
def test_table_of_cycles(name, bus_bytes, beats, steps, cycles, read, write):
    message = load_message(name)
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    packet = encode(plan, to_transfers(plan, message, VALUES[name]))[0]
    found = packet_of(plan, packet)
    assert (found.beats, len(found.visits), cycles_between(found)) == (beats, steps, cycles)
    assert check(message, [packet] * 10, bus_bytes) == (read, write)
