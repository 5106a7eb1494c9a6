"""Measure cycles per beat of long and short messages, on buses of several widths.

One word per cycle would be 1.000. Packets go back to back through a simulated deserializer and
serializer, without stalls. ``make -C lab bench`` measures more types, with short messages.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

from firm_hdl import load_message
from firm_hdl.sim import loopback

__all__ = ["main"]

STORE = get_typestore(Stores.ROS2_LYRICAL)
BUSES = (4, 8, 16, 64)
DATA = np.arange(1 << 16, dtype=np.uint32).astype(np.uint8)


def new(type_: str, /, **fields: Any) -> Any:
    """Make a message."""
    return STORE.types[type_](**fields)


def header() -> Any:
    """Make a header with a frame name of common length."""
    stamp = new("builtin_interfaces/msg/Time", sec=1, nanosec=2)
    return new("std_msgs/msg/Header", stamp=stamp, frame_id="camera_link")


def twist() -> Any:
    """Make a message of fixed size."""
    vector = new("geometry_msgs/msg/Vector3", x=1.0, y=2.0, z=3.0)
    return new("geometry_msgs/msg/Twist", linear=vector, angular=vector)


def joints() -> Any:
    """Make the state of six joints: many short strings."""
    values = np.linspace(0, 1, 6)
    names = [f"joint_{k}" for k in range(6)]
    return new(
        "sensor_msgs/msg/JointState",
        header=header(),
        name=names,
        position=values,
        velocity=values,
        effort=values,
    )


def image() -> Any:
    """Make an image of 64 KiB."""
    return new(
        "sensor_msgs/msg/Image",
        header=header(),
        height=256,
        width=256,
        encoding="mono8",
        is_bigendian=0,
        step=256,
        data=DATA,
    )


MESSAGES: dict[str, tuple[int, Callable[[], Any]]] = {
    "geometry_msgs/msg/Twist": (200, twist),
    "sensor_msgs/msg/JointState": (50, joints),
    "sensor_msgs/msg/Image": (1, image),
}


def main() -> int:
    """Run the bench; return 1 if a byte is wrong."""
    row = "{:<28}{:>6}{:>10}{:>9}{:>9}{:>9}{:>13}{:>10}"
    heads = ("type", "bus", "messages", "bytes", "beats", "cycles", "cycles/beat", "seconds")
    print(row.format(*heads), flush=True)
    failures = 0
    for name, (count, make) in MESSAGES.items():
        packets = [bytes(STORE.serialize_cdr(make(), name))] * count
        for bus_bytes in BUSES:
            began = time.perf_counter()
            seen = loopback(load_message(name), packets, bus_bytes=bus_bytes)
            failures += seen.packets != packets
            figures = (sum(map(len, packets)), seen.beats_in, seen.cycles)
            ratio = f"{seen.cycles / seen.beats_in:.3f}"
            seconds = f"{time.perf_counter() - began:.1f}"
            print(row.format(name, bus_bytes, count, *figures, ratio, seconds), flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
