"""Recordings like those of a robot: several topics and types, and packets of different writers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

__all__ = ["FORMATS", "Sent", "robot", "store_of", "write"]

FORMATS = ["bag", "bag-lz4", "bag-bz2", "mcap", "mcap-storage", "db3", "db3-message", "db3-file"]
"""Kinds of files, with the compression that rosbags writes."""

Sent = "tuple[str, str, int, bytes]"
"""Topic, type, time in nanoseconds, and bytes."""

_WHEELS = "std_msgs/Header header\nmy_msgs/Wheel[2] wheels\nstring<=8 mode\nbool[] flags\n"
_WHEEL = "float32 speed\nuint8 state\nfloat64[] history\n"


def store_of(form: str) -> Typestore:
    """Return the types for a kind of file, including two of the robot's own."""
    is_bag = form.startswith("bag")
    store = get_typestore(Stores.ROS1_NOETIC if is_bag else Stores.ROS2_JAZZY)
    wheels = _WHEELS.replace("<=8", "") if is_bag else _WHEELS
    store.register(
        get_types_from_msg(wheels, "my_msgs/msg/Wheels")
        | get_types_from_msg(_WHEEL, "my_msgs/msg/Wheel")
    )
    return store


def write(path: Path, form: str, messages: Sequence[Any], topics: Sequence[Any] = ()) -> Path:
    """Write a recording.

    Parameters
    ----------
    path : Path
        Without the extension.
    messages : sequence of (topic, type, nanoseconds, bytes)
    topics : sequence of (topic, type)
        Topics without messages.
    """
    store = store_of(form)
    kind, _, compression = form.partition("-")
    if kind == "bag":
        path = path.with_suffix(".bag")
        writer: Any = Writer1(path)
        if compression:
            writer.set_compression(Writer1.CompressionFormat[compression.upper()])
    else:
        plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
        writer = Writer2(path, version=9, storage_plugin=plugin)
        if compression:
            writer.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
    with writer:
        connections = {
            (topic, name): writer.add_connection(topic, name, typestore=store)
            for topic, name in dict.fromkeys([*(each[:2] for each in messages), *topics])
        }
        for topic, name, nanoseconds, data in messages:
            writer.write(connections[topic, name], nanoseconds, data)
    return path


def robot(form: str, seconds: int = 6) -> list[Any]:
    """Return the messages of a robot that drives in a circle: types of fixed and of any size."""
    store = store_of(form)
    is_bag = form.startswith("bag")
    types = store.types
    found = []

    def header(frame: str, number: int) -> Any:
        stamp = types["builtin_interfaces/msg/Time"](sec=1_700_000_000 + number, nanosec=999)
        more = {"seq": number} if is_bag else {}
        return types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame, **more)

    def add(topic: str, name: str, number: int, delay: int, **fields: Any) -> None:
        value = types[name](**fields)
        data = store.serialize_ros1(value, name) if is_bag else store.serialize_cdr(value, name)
        nanoseconds = (1_700_000_000 + number) * 10**9 + delay
        found.append((topic, name, nanoseconds, bytes(data)))

    vector = types["geometry_msgs/msg/Vector3"]
    for number in range(seconds):
        x, y = math.cos(number / 5), math.sin(number / 5)
        add(
            "/cmd_vel",
            "geometry_msgs/msg/Twist",
            number,
            1,
            linear=vector(x=x, y=y, z=-0.0),
            angular=vector(x=0.0, y=0.0, z=math.nan),
        )
        ranges = np.array([x * beam for beam in range(number * 3)], dtype=np.float32)
        scan = {"angle_min": -1.5, "angle_max": 1.5, "angle_increment": 0.1, "scan_time": 0.1}
        for topic, size in (("/front/scan", 1), ("/rear/scan", 2)):
            if number % size == 0:
                add(
                    topic,
                    "sensor_msgs/msg/LaserScan",
                    number,
                    1 + size,
                    header=header(topic.strip("/"), number),
                    time_increment=0.0,
                    range_min=0.1,
                    range_max=30.0,
                    ranges=ranges,
                    intensities=ranges[::2].copy(),
                    **scan,
                )
        wheel = types["my_msgs/msg/Wheel"]
        wheels = [wheel(speed=x, state=number, history=np.array([y] * n)) for n in (number, 0)]
        add(
            "/wheels",
            "my_msgs/msg/Wheels",
            number,
            4,
            header=header("wheels", number),
            wheels=wheels,
            mode="älter"[: number + 1],
            flags=np.array([n % 3 == 0 for n in range(number)], dtype=np.bool_),
        )
        add("/log", "std_msgs/msg/String", number, 5, data="tick " * number)
    return found
