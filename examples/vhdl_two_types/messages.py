"""Write scans and clouds for the bench, and the clouds that must come out.

rosbags serializes the messages. Some packets are damaged: neither they nor the packets that are
paired with them may lead to an output.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_LYRICAL)
SCAN, CLOUD = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"


def scan(number: int, frame: str) -> bytes:
    """Serialize a scan."""
    ranges = np.arange(number, dtype=np.float32)
    message = STORE.types[SCAN](header(number, frame), *(0.5,) * 7, ranges, ranges[:2])
    return bytes(STORE.serialize_cdr(message, SCAN))


def cloud(number: int, frame: str, points: int) -> bytes:
    """Serialize a cloud; apart from the header, it depends only on the number of points."""
    field = STORE.types["sensor_msgs/msg/PointField"]
    fields = [field(name=name, offset=4 * k, datatype=7, count=1) for k, name in enumerate("xyz")]
    data = np.arange(12 * points, dtype=np.uint32).astype(np.uint8)
    message = STORE.types[CLOUD](
        header(number, frame), 1, points, fields, False, 12, len(data), data, True
    )
    return bytes(STORE.serialize_cdr(message, CLOUD))


def header(number: int, frame: str) -> Any:
    """Make a header."""
    stamp = STORE.types["builtin_interfaces/msg/Time"](sec=100 + number, nanosec=number)
    return STORE.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)


def main(folder: Path) -> None:
    """Write `scans.txt`, `clouds.txt` and `expected.txt`: one packet per line, in hexadecimal."""
    good_scan, good_cloud = scan(9, "broken"), cloud(9, "broken", 7)
    pairs = [
        (scan(1, "laser"), cloud(50, "lidar", 3)),
        (good_scan[:20], good_cloud),  # The scan ends within its header.
        (good_scan, good_cloud[:-1]),  # The last byte of the cloud is missing.
        (scan(2, "another laser"), cloud(51, "", 0)),
        (good_scan + bytes(8), good_cloud),  # Bytes follow the scan.
        (good_scan, cloud(52, "lidar", 100)),  # More than the buffer holds.
        (good_scan, b"\0\2" + good_cloud[2:]),  # Another encapsulation.
        (scan(3, ""), cloud(53, "a longer name than that", 20)),
    ]
    expected = [cloud(1, "laser", 3), cloud(2, "another laser", 0), cloud(3, "", 20)]
    files = {
        "scans": [pair[0] for pair in pairs],
        "clouds": [pair[1] for pair in pairs],
        "expected": expected,
    }
    for name, packets in files.items():
        text = "".join(f"{packet.hex()}\n" for packet in packets)
        (folder / f"{name}.txt").write_text(text)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
