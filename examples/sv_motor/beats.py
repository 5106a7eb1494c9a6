"""Write the beats for the bench, and the speeds that the motor must have, in order.

rosbags serializes the messages. Some packets are damaged; the motor must never have their speed of
9 m/s.
"""

from __future__ import annotations

import random
import struct
import sys
from collections.abc import Iterator
from pathlib import Path

from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_LYRICAL)
TWIST, VECTOR = (STORE.types[f"geometry_msgs/msg/{name}"] for name in ("Twist", "Vector3"))
BUS_BYTES = 4
NOISE = random.Random(1)


def packet(speed: float) -> bytes:
    """Serialize a Twist."""
    message = TWIST(linear=VECTOR(x=speed, y=0.5, z=-1.0), angular=VECTOR(x=2.0, y=0.0, z=3.0))
    return bytes(STORE.serialize_cdr(message, "geometry_msgs/msg/Twist"))


def beats(data: bytes) -> Iterator[str]:
    """Yield `tdata` in hexadecimal, first byte lowest, and `tkeep` and `tlast` in binary.

    Lanes that are not kept have random bytes, which the motor has to ignore.
    """
    for place in range(0, len(data), BUS_BYTES):
        part = data[place : place + BUS_BYTES]
        is_last = place + BUS_BYTES >= len(data)
        lanes = int.from_bytes(part + NOISE.randbytes(BUS_BYTES - len(part)), "little")
        yield f"{lanes:08x} {(1 << len(part)) - 1:04b} {is_last:b}\n"


def main(folder: Path) -> None:
    """Write `beats.txt` and `speeds.txt`."""
    bad = packet(9.0)
    cut, long, foreign = bad[:-1], bad + bytes(8), b"\0\2" + bad[2:]
    packets = [packet(1.0), cut, packet(0.75), long, cut[:5], packet(-2.5), foreign, packet(1e300)]
    speeds = (1.0, 0.75, -2.5, 1e300)
    (folder / "beats.txt").write_text("".join(beat for each in packets for beat in beats(each)))
    (folder / "speeds.txt").write_text("".join(f"{struct.pack('>d', s).hex()}\n" for s in speeds))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
