"""Send real ROS messages through hardware that is generated from their definitions.

The demo builds three types. It sends messages that rosbags serialized through their simulated
deserializer and serializer, and compares the packets that come out byte for byte. If GHDL is
installed, the test benches of the generated VHDL do the same there. At the end, a simulated node
answers a message. ``make demo`` runs this.
"""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

from firm_hdl import load_message
from firm_hdl.cli import main as firm_hdl
from firm_hdl.gateware.signatures import Status
from firm_hdl.names.identifiers import identifier
from firm_hdl.sim import loopback

__all__ = ["main"]

OUT = "vhdl_out"
BUS_BYTES = 8
MESSAGES = 20
NODE = Path(__file__).parent / "nodes" / "double" / "double.yaml"
NEXT = """
Next:
  the lesson "Your first converter"    docs/tutorial/first-converter.md, or `make docs`
  this node in a graph of ROS 2        .venv/bin/firm-hdl node run examples/nodes/double/double.yaml
  the converters of any other type     .venv/bin/firm-hdl build sensor_msgs/msg/LaserScan"""
GHDLS = ("ghdl", "ghdl-mcode", "ghdl-llvm", "ghdl-gcc")


@dataclass(frozen=True, kw_only=True)
class Example:
    """A type, and a function that makes its messages."""

    type: str
    distro: str
    store: Stores
    make: Callable[[dict[str, Any], int], Any]


def stamp(types: dict[str, Any], k: int) -> Any:
    """Make the time of the k-th message, at 100 Hz, from a day in 2026 on."""
    return types["builtin_interfaces/msg/Time"](
        sec=1_767_225_600 + k // 100, nanosec=k % 100 * 10_000_000
    )


def vector(types: dict[str, Any], x: float, y: float, z: float) -> Any:
    """Make a vector."""
    return types["geometry_msgs/msg/Vector3"](x=x, y=y, z=z)


def turned(types: dict[str, Any], angle: float) -> Any:
    """Make the quaternion of a rotation around z."""
    return types["geometry_msgs/msg/Quaternion"](
        x=0.0, y=0.0, z=math.sin(angle / 2), w=math.cos(angle / 2)
    )


def imu(types: dict[str, Any], k: int) -> Any:
    """Make the data of an IMU that turns slowly and shakes a little."""
    header = types["std_msgs/msg/Header"](stamp=stamp(types, k), frame_id="imu_link"[: k % 9])
    return types["sensor_msgs/msg/Imu"](
        header=header,
        orientation=turned(types, 0.01 * k),
        orientation_covariance=np.diag([1e-4, 1e-4, 4e-4]).ravel(),
        angular_velocity=vector(types, 0.001 * k, -0.002, 1.0),
        angular_velocity_covariance=np.diag([1e-6, 1e-6, 1e-6]).ravel(),
        linear_acceleration=vector(types, 0.02 * math.sin(k), 0.0, 9.81),
        linear_acceleration_covariance=np.full(9, -1.0),
    )


def cloud(types: dict[str, Any], k: int) -> Any:
    """Make a point cloud of x, y, z and intensity; the first one is empty."""
    points = np.zeros(40 * k, dtype=[(name, "<f4") for name in ("x", "y", "z", "intensity")])
    angles = np.linspace(0, math.tau, len(points), dtype=np.float32)
    points["x"], points["y"], points["intensity"] = np.cos(angles), np.sin(angles), k
    field = types["sensor_msgs/msg/PointField"]
    names = points.dtype.names or ()
    return types["sensor_msgs/msg/PointCloud2"](
        header=types["std_msgs/msg/Header"](stamp=stamp(types, k), frame_id="lidar"),
        height=1,
        width=len(points),
        fields=[
            field(name=name, offset=4 * index, datatype=7, count=1)
            for index, name in enumerate(names)
        ],
        is_bigendian=False,
        point_step=16,
        row_step=16 * len(points),
        data=np.frombuffer(points.tobytes(), dtype=np.uint8),
        is_dense=True,
    )


def odometry(types: dict[str, Any], k: int) -> Any:
    """Make the odometry of a robot that drives in a circle."""
    geometry = {name.rpartition("/")[2]: kind for name, kind in types.items() if "geometry" in name}
    position = geometry["Point"](x=math.cos(0.1 * k), y=math.sin(0.1 * k), z=0.0)
    pose = geometry["Pose"](position=position, orientation=turned(types, 0.1 * k))
    twist = geometry["Twist"](linear=vector(types, 0.5, 0, 0), angular=vector(types, 0, 0, 0.1))
    covariance = np.diag([0.01, 0.01, 1e6, 1e6, 1e6, 0.03]).ravel()
    return types["nav_msgs/msg/Odometry"](
        header=types["std_msgs/msg/Header"](seq=k, stamp=stamp(types, k), frame_id="odom"),
        child_frame_id="base_link",
        pose=geometry["PoseWithCovariance"](pose=pose, covariance=covariance),
        twist=geometry["TwistWithCovariance"](twist=twist, covariance=covariance),
    )


EXAMPLES = (
    Example(type="sensor_msgs/msg/Imu", distro="lyrical", store=Stores.ROS2_LYRICAL, make=imu),
    Example(
        type="sensor_msgs/msg/PointCloud2", distro="lyrical", store=Stores.ROS2_LYRICAL, make=cloud
    ),
    Example(type="nav_msgs/Odometry", distro="noetic", store=Stores.ROS1_NOETIC, make=odometry),
)


def main() -> int:
    """Run the demo; return 1 if a byte is wrong."""
    for distro in dict.fromkeys(example.distro for example in EXAMPLES):
        types = [example.type for example in EXAMPLES if example.distro == distro]
        options = ["--distro", distro, "--bus-bytes", str(BUS_BYTES), "--out", OUT, "--force"]
        status = firm_hdl(["build", *types, *options])
        if status:
            return status
    print(f"\nThrough deserializer and serializer, {8 * BUS_BYTES}-bit bus, back to back:\n")
    row = "{:<29}{:<6}{:>9}{:>9}{:>8}{:>9}{:>13}  {}"
    heads = ("type", "wire", "messages", "bytes", "beats", "cycles", "cycles/beat", "bytes equal")
    print(row.format(*heads), flush=True)
    failures = 0
    for example in EXAMPLES:
        cells, is_equal = run(example)
        failures += not is_equal
        print(row.format(*cells, "yes" if is_equal else "NO"), flush=True)
    failures += run_vhdl()
    failures += run_node(21)
    print(NEXT)
    return 1 if failures else 0


def run_node(number: int) -> int:
    """Send a number to a simulated node that doubles it; return the number of failures."""
    print("\nA node that doubles numbers, simulated, without ROS:\n", flush=True)
    store = get_typestore(Stores.ROS2_JAZZY)
    kind = "std_msgs/msg/Int32"
    packet = bytes(store.serialize_cdr(store.types[kind](data=number), kind))
    line = json.dumps({"topic": "/number", "packet": packet.hex()})
    run = "from firm_hdl.cli import main; raise SystemExit(main())"
    options = ["--graph", "none", "--engine", "amaranth"]
    done = subprocess.run(
        [sys.executable, "-c", run, "node", "run", str(NODE), *options],
        input=f"{line}\n", capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode or not done.stdout:
        print(f"FAIL no answer: {done.stderr}", flush=True)
        return 1
    answer = json.loads(done.stdout)
    value: Any = store.deserialize_cdr(bytes.fromhex(answer["packet"]), kind)
    print(f"to   /number  data: {number}\nfrom {answer['topic']}  data: {value.data}", flush=True)
    return 0 if value.data == 2 * number else 1


def run_vhdl() -> int:
    """Run the benches of the VHDL; return the number of failures."""
    if not any(map(shutil.which, GHDLS)):
        print("\nGHDL is not installed, so the VHDL's test benches did not run (apt install ghdl).")
        return 0
    print("\nThe VHDL's own test benches in GHDL, with random stalls:\n", flush=True)
    failures = 0
    for example in EXAMPLES:
        wire = "ros1" if example.distro == "noetic" else "cdr"
        name = f"{identifier(example.type)}_{wire}_{BUS_BYTES}"
        script = Path(OUT) / example.distro / name / "vhdl" / "run_ghdl.sh"
        status = subprocess.run(["sh", str(script)], check=False).returncode
        if status:
            print(f"FAIL {example.type}: {script} ended with {status}", flush=True)
            failures += 1
    return failures


def run(example: Example) -> tuple[Iterator[str], bool]:
    """Send messages through a type's converters; return figures, and whether all are equal."""
    message = load_message(example.type, distro=example.distro)
    sent = serialize(example)
    seen = loopback(message, sent, bus_bytes=BUS_BYTES)
    is_equal = seen.packets == sent and all(
        status is Status.OK for status in (*seen.statuses, *seen.sent_statuses)
    )
    ratio = f"{seen.cycles / seen.beats_in:.3f}"
    figures = (len(sent), sum(map(len, sent)), seen.beats_in, seen.cycles, ratio)
    return map(str, (example.type, message.wire, *figures)), is_equal


def serialize(example: Example) -> list[bytes]:
    """Serialize an example's messages with rosbags, without code of firm-hdl."""
    store = get_typestore(example.store)
    package, _, name = example.type.replace("/msg/", "/").partition("/")
    full_name = f"{package}/msg/{name}"
    write = store.serialize_ros1 if example.distro == "noetic" else store.serialize_cdr
    made = (example.make(dict(store.types), k) for k in range(MESSAGES))
    return [bytes(write(message, full_name)) for message in made]


if __name__ == "__main__":
    sys.exit(main())
