"""An accelerator between a deserializer and a serializer: it halves every velocity of a Twist.

The example shows the record view, the use of `status`, and a simulation with `firm_hdl.sim`. Run it
with ``python examples/half_speed.py``.
"""

from __future__ import annotations

import sys
from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator, SimulatorContext
from rosbags.typesys import Stores, get_typestore

from firm_hdl import (
    Deserializer,
    PacketSignature,
    RecordReader,
    RecordWriter,
    Serializer,
    Status,
    load_message,
)
from firm_hdl.sim import receive_packets, send_packets

__all__ = ["HalfSpeed", "half", "main"]

TWIST = load_message("geometry_msgs/msg/Twist")


def half(bits: Value) -> Value:
    """Halve a float64 by subtracting 1 from its exponent. Subnormal results become zero."""
    exponent, sign = bits[52:63], bits[63]
    halved = Cat(bits[:52], (exponent - 1)[:11], sign)
    kept = Mux(exponent == 0x7FF, bits, halved)
    return Mux(exponent <= 1, Cat(Const(0, 63), sign), kept)


class HalfSpeed(wiring.Component):
    """Halve every velocity of Twist messages, and drop damaged packets."""

    def __init__(self) -> None:
        packets = PacketSignature(8)
        super().__init__({"packets_in": In(packets), "packets_out": Out(packets)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.rx = rx = Deserializer(TWIST)
        m.submodules.reader = reader = RecordReader(TWIST)
        m.submodules.writer = writer = RecordWriter(TWIST)
        m.submodules.tx = tx = Serializer(TWIST)
        connect(m, flipped(self.packets_in), rx.packets)
        connect(m, rx.message, reader.message)
        connect(m, writer.message, tx.message)
        connect(m, tx.packets, flipped(self.packets_out))

        # One record and one status come for each packet. They are taken together, and the record
        # is passed on only if its packet was good. It waits for the serializer in a register, so
        # that the deserializer can fill its own registers with the next message meanwhile.
        good = rx.status.payload == Status.OK
        both = reader.record.valid & rx.status.valid
        free = ~writer.record.valid | writer.record.ready
        m.d.comb += [
            reader.record.ready.eq(both & free),
            rx.status.ready.eq(both & free),
            tx.status.ready.eq(1),
        ]
        with m.If(free):
            m.d.sync += writer.record.valid.eq(both & good)
            for part in ("linear", "angular"):
                for axis in ("x", "y", "z"):
                    velocity = reader.record.payload[part][axis]
                    m.d.sync += writer.record.payload[part][axis].eq(half(velocity))
        return m


def main() -> int:
    """Send three messages and a truncated packet; return 1 if a byte is wrong."""
    store = get_typestore(Stores.ROS2_LYRICAL)
    twist, vector = (store.types[f"geometry_msgs/msg/{name}"] for name in ("Twist", "Vector3"))

    def packet(speed: float) -> bytes:
        linear, angular = vector(x=speed, y=0.0, z=0.0), vector(x=0.0, y=0.0, z=-speed)
        message = twist(linear=linear, angular=angular)
        return bytes(store.serialize_cdr(message, "geometry_msgs/msg/Twist"))

    speeds = (1.0, 0.75, 1e300)
    sent = [packet(speeds[0]), packet(9.0)[:-1], packet(speeds[1]), packet(speeds[2])]
    received: list[bytes] = []
    dut = HalfSpeed()

    async def source(ctx: SimulatorContext) -> None:
        await send_packets(ctx, dut.packets_in, sent)

    async def sink(ctx: SimulatorContext) -> None:
        received.extend(await receive_packets(ctx, dut.packets_out, len(speeds)))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(source)
    simulator.add_testbench(sink)
    simulator.run()
    for data in received:
        message: Any = store.deserialize_cdr(data, "geometry_msgs/msg/Twist")
        print(f"linear.x {message.linear.x}, angular.z {message.angular.z}")
    return 0 if received == [packet(speed / 2) for speed in speeds] else 1


if __name__ == "__main__":
    sys.exit(main())
