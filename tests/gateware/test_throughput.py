# amaranth: UnusedElaboratable=no
"""Cycles are exact: one bus word per cycle, packet after packet."""

from __future__ import annotations

import random

import pytest

from firm_hdl import Deserializer, Library, Serializer, load_message
from firm_hdl.plan import decode, encode
from firm_hdl.sim import Harness, to_transfers

PACKETS = 40
BLOB_BYTES = 1 << 16
DISTROS = ("noetic", "foxy", "humble", "iron", "jazzy", "kilted", "lyrical")


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


@pytest.mark.parametrize("message", list(fixed_types()))
def test_types_of_fixed_size_run_at_line_rate(message):
    seen = run(message, fixed_packets(message, PACKETS))
    # A constant for filling the pipeline, nothing per packet.
    assert seen.cycles - seen.beats_in <= 6


@pytest.mark.parametrize(
    ("name", "distro", "beats", "cycles"),
    [
        ("std_msgs/msg/Bool", "lyrical", 1, 4),
        ("geometry_msgs/msg/Twist", "lyrical", 7, 5),
        ("geometry_msgs/msg/PoseWithCovariance", "lyrical", 44, 6),
        ("unique_identifier_msgs/msg/UUID", "lyrical", 3, 5),
        ("geometry_msgs/Twist", "noetic", 6, 4),
        ("std_msgs/Empty", "noetic", 1, 4),
    ],
)
def test_exact_cycles(name, distro, beats, cycles):
    packets = fixed_packets(load_message(name, distro=distro), PACKETS)
    seen = run(load_message(name, distro=distro), packets)
    assert seen.beats_in == seen.beats_out == PACKETS * beats
    assert seen.cycles == PACKETS * beats + cycles


def blob(name, frame_id):
    header = {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": frame_id}
    data = bytes(range(256)) * (BLOB_BYTES // 256)
    fields = [{"name": axis, "offset": 4, "datatype": 7, "count": 1} for axis in "xyz"]
    return {
        "sensor_msgs/msg/Image": {
            "header": header,
            "height": 256,
            "width": 256,
            "encoding": "mono8",
            "is_bigendian": 0,
            "step": 256,
            "data": data,
        },
        "sensor_msgs/msg/CompressedImage": {"header": header, "format": "jpeg", "data": data},
        "sensor_msgs/msg/PointCloud2": {
            "header": header,
            "height": 1,
            "width": 4096,
            "fields": fields,
            "is_bigendian": False,
            "point_step": 16,
            "row_step": BLOB_BYTES,
            "data": data,
            "is_dense": True,
        },
    }[name]


@pytest.mark.parametrize(
    ("name", "extra"),
    [
        ("sensor_msgs/msg/Image", 7),
        ("sensor_msgs/msg/CompressedImage", 7),
        ("sensor_msgs/msg/PointCloud2", 15),
    ],
)
def test_blobs_of_64_kib_run_at_line_rate(name, extra):
    message = load_message(name)
    plan = Deserializer(message).plan
    packets = [
        encode(plan, to_transfers(plan, message, blob(name, frame_id)))[0]
        for frame_id in ("camera", "")
    ]
    seen = run(message, packets)
    assert seen.cycles - seen.beats_in == extra
    assert seen.cycles <= seen.beats_in * 1.02 + 16
