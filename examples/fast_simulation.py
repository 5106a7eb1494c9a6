"""A design of one's own in a fast simulation: up to a million cycles per second.

The design reads Imu messages, counts the good ones, and writes them again. It runs in each engine
of `firm_hdl.sim.fast`, and the example prints how fast. Verilator needs a C++ compiler, which
takes some seconds in the first run. Run it with ``python examples/fast_simulation.py``.
"""

from __future__ import annotations

import sys
import time
from typing import Literal

import numpy as np
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from rosbags.typesys import Stores, get_typestore

from firm_hdl import Deserializer, PacketSignature, Serializer, Status, load_message
from firm_hdl.jobs import ProgramMissingError
from firm_hdl.sim.fast import FastSimulation

__all__ = ["Counted", "main"]

IMU = load_message("sensor_msgs/msg/Imu")
STORE = get_typestore(Stores.ROS2_LYRICAL)
PACKETS: dict[Literal["verilator", "amaranth"], int] = {"verilator": 50_000, "amaranth": 50}


class Counted(wiring.Component):
    """Read messages, count the good ones, and write them."""

    def __init__(self) -> None:
        packets = PacketSignature(8)
        super().__init__({"packets_in": In(packets), "packets_out": Out(packets), "good": Out(32)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.rx = rx = Deserializer(IMU)
        m.submodules.tx = tx = Serializer(IMU)
        connect(m, flipped(self.packets_in), rx.packets)
        connect(m, rx.message, tx.message)
        connect(m, tx.packets, flipped(self.packets_out))
        m.d.comb += [rx.status.ready.eq(1), tx.status.ready.eq(1)]
        with m.If(rx.status.valid & (rx.status.payload == Status.OK)):
            m.d.sync += self.good.eq(self.good + 1)
        return m


def packet(number: int) -> bytes:
    """Serialize an Imu."""
    new = STORE.types
    stamp = new["builtin_interfaces/msg/Time"](sec=number, nanosec=5)
    header = new["std_msgs/msg/Header"](stamp=stamp, frame_id="imu_link")
    vector = new["geometry_msgs/msg/Vector3"](x=0.5, y=-1.0, z=float(number))
    orientation = new["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)
    covariance = np.arange(9, dtype=np.float64)
    message = new["sensor_msgs/msg/Imu"](
        header=header,
        orientation=orientation,
        orientation_covariance=covariance,
        angular_velocity=vector,
        angular_velocity_covariance=covariance,
        linear_acceleration=vector,
        linear_acceleration_covariance=covariance,
    )
    return bytes(STORE.serialize_cdr(message, "sensor_msgs/msg/Imu"))


def main() -> int:
    """Run the design in each engine; return 1 if a byte is wrong."""
    for engine, count in PACKETS.items():
        packets = [packet(number % 100) for number in range(count)]
        started = time.perf_counter()
        try:
            simulation = FastSimulation(Counted(), engine=engine)
        except ProgramMissingError as error:
            print(f"{engine:9}  left out: {error}")
            continue
        with simulation:
            begin = time.perf_counter()
            simulation.send_packets("packets_in", packets)
            simulation.run_until({"packets_out": count}, limit=1000 * count)
            seconds = time.perf_counter() - begin
            is_right = simulation.receive_packets("packets_out") == packets
            if not is_right or simulation.get("good") != count:
                print(f"{engine:9}  wrong bytes")
                return 1
            rate = simulation.cycle / seconds
            print(
                f"{engine:9}  {count:6} packets  {simulation.cycle:8} cycles  "
                f"{rate:10,.0f} cycles/s  after {begin - started:.1f} s"
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
