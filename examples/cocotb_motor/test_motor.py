"""A cocotb bench: cocotbext-axi sends packets from rosbags to the motor, with random pauses."""

import random
import struct

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, FallingEdge, ValueChange
from cocotbext.axi import AxiStreamBus, AxiStreamFrame, AxiStreamSource
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_LYRICAL)
TWIST, VECTOR = (STORE.types[f"geometry_msgs/msg/{name}"] for name in ("Twist", "Vector3"))


def packet(speed):
    """Serialize a Twist."""
    message = TWIST(linear=VECTOR(x=speed, y=0.5, z=-1.0), angular=VECTOR(x=2.0, y=0.0, z=3.0))
    return bytes(STORE.serialize_cdr(message, "geometry_msgs/msg/Twist"))


def frame(data, lanes):
    """Return a frame; the lanes that are left in its last beat are not kept, and have any bytes."""
    left = -len(data) % lanes
    return AxiStreamFrame(data + random.randbytes(left), tkeep=[1] * len(data) + [0] * left)


def pauses(seed):
    """Pause in four of ten cycles."""
    chosen = random.Random(seed)
    while True:
        yield chosen.random() < 0.4


@cocotb.test()
async def only_good_packets_move_the_motor(dut):
    cocotb.start_soon(Clock(dut.aclk, 10, "ns").start())
    bus = AxiStreamBus.from_prefix(dut, "s_axis")
    source = AxiStreamSource(bus, dut.aclk, reset=dut.aresetn, reset_active_level=False)
    source.set_pause_generator(pauses(1))
    dut.aresetn.value = 0
    await ClockCycles(dut.aclk, 3)
    dut.aresetn.value = 1
    await FallingEdge(dut.aclk)

    seen = []

    async def watch():
        while True:
            await ValueChange(dut.speed)
            seen.append(struct.unpack("<d", dut.speed.value.to_unsigned().to_bytes(8, "little"))[0])

    cocotb.start_soon(watch())
    bad = packet(9.0)
    damaged = [bad[:-1], bad[:5], bad + bytes(8), b"\0\2" + bad[2:]]
    good = [1.0, 0.75, -2.5, 1e300]
    for speed, harm in zip(good, damaged, strict=True):
        await source.send(frame(harm, source.byte_lanes))
        await source.send(frame(packet(speed), source.byte_lanes))
    await source.wait()
    await ClockCycles(dut.aclk, 10)
    assert seen == good
