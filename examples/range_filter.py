"""A filter over the ranges of a LaserScan: ranges over a limit become infinite.

The example shows an accelerator that changes the items of a sequence, while all other fields pass.
It also shows how to drop a damaged message of any size: the new packet is held back until the
status is known. Run it with ``python examples/range_filter.py``.
"""

from __future__ import annotations

import math
import struct
import sys
from typing import Any

import numpy as np
from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator, SimulatorContext
from rosbags.typesys import Stores, get_typestore

from firm_hdl import Deserializer, PacketSignature, Serializer, Status, load_message
from firm_hdl.sim import Stalls, receive_packets, send_packets

__all__ = ["PacketBuffer", "RangeFilter", "main"]

LASER_SCAN = load_message("sensor_msgs/msg/LaserScan")
INFINITE = 0x7F800000


class PacketBuffer(wiring.Component):
    """Hold packets back until their verdict is known, and drop those that are not good.

    A packet longer than the memory is dropped, too. Latency from a verdict to the first beat: 2
    cycles.

    Parameters
    ----------
    bus_bytes : int
    depth : int
        Size of the memory in beats, a power of two.

    Members
    -------
    i : In(PacketSignature(bus_bytes))
    o : Out(PacketSignature(bus_bytes))
    verdict : In(stream.Signature(1))
        One transfer per packet: 1 if the packet may leave. Taken after the last beat.
    """

    def __init__(self, bus_bytes: int, depth: int) -> None:
        packets = PacketSignature(bus_bytes)
        super().__init__({"i": In(packets), "o": Out(packets), "verdict": In(stream.Signature(1))})
        self.depth = depth

    def elaborate(self, platform: object) -> Module:
        m = Module()
        shape = self.i.payload.shape()
        m.submodules.memory = memory = Memory(shape=shape, depth=self.depth, init=[])
        write, read = memory.write_port(), memory.read_port()

        # Pointers have one bit more than an address, so that full and empty differ. Beats from
        # `taken` to `good` may leave; beats from `good` to `written` wait for their verdict.
        taken, good, written = (
            Signal(range(2 * self.depth), name=name) for name in ("taken", "good", "written")
        )
        too_long, is_over, is_full = Signal(), Signal(), Signal()
        m.d.comb += [
            is_full.eq((written - taken)[: len(taken)] == self.depth),
            self.i.ready.eq(~is_over & (too_long | ~is_full)),
            self.verdict.ready.eq(is_over),
            write.addr.eq(written),
            write.data.eq(self.i.payload),
            write.en.eq(self.i.valid & self.i.ready & ~too_long),
        ]
        m.d.sync += written.eq(written + write.en)
        with m.If(self.i.valid & self.i.ready):
            m.d.sync += is_over.eq(self.i.payload.last)
        with m.If(is_full & ~is_over & (taken == good)):
            m.d.sync += too_long.eq(1)
        with m.If(is_over & self.verdict.valid):
            m.d.sync += [is_over.eq(0), too_long.eq(0)]
            with m.If(self.verdict.payload & ~too_long):
                m.d.sync += good.eq(written)
            with m.Else():
                m.d.sync += written.eq(good)

        m.d.comb += [
            read.addr.eq(taken),
            read.en.eq(self.o.ready | ~self.o.valid),
            self.o.payload.eq(read.data),
        ]
        with m.If(read.en):
            m.d.sync += [self.o.valid.eq(taken != good), taken.eq(taken + (taken != good))]
        return m


class RangeFilter(wiring.Component):
    """Make ranges of LaserScan messages that exceed a limit infinite.

    Damaged packets and packets of more than `depth` beats are dropped.

    Parameters
    ----------
    limit : float
        Limit in metres, not negative.
    """

    def __init__(self, limit: float, *, bus_bytes: int = 8, depth: int = 256) -> None:
        packets = PacketSignature(bus_bytes)
        super().__init__({"packets_in": In(packets), "packets_out": Out(packets)})
        (self.limit_bits,) = struct.unpack("<I", struct.pack("<f", limit))
        self.bus_bytes, self.depth = bus_bytes, depth

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.rx = rx = Deserializer(LASER_SCAN, bus_bytes=self.bus_bytes)
        m.submodules.tx = tx = Serializer(LASER_SCAN, bus_bytes=self.bus_bytes)
        m.submodules.held = held = PacketBuffer(self.bus_bytes, self.depth)
        connect(m, flipped(self.packets_in), rx.packets)
        connect(m, tx.packets, held.i)
        connect(m, held.o, flipped(self.packets_out))

        # All fields pass, and so does the length of the ranges. Only their items are filtered.
        for field in LASER_SCAN.fields:
            if field.name != "ranges":
                connect(m, getattr(rx.message, field.name), getattr(tx.message, field.name))
        connect(m, rx.message.ranges.length, tx.message.ranges.length)
        items, filtered = rx.message.ranges.items, tx.message.ranges.items
        m.d.comb += [
            filtered.payload.last.eq(items.payload.last),
            filtered.valid.eq(items.valid),
            items.ready.eq(filtered.ready),
        ]
        for lane in range(len(items.payload.data)):
            m.d.comb += filtered.payload.data[lane].eq(self.filtered(items.payload.data[lane]))

        # The fields pass before the end of the packet is seen. So the new packet waits for the
        # statuses of both converters, and all three are taken together.
        statuses = rx.status, tx.status
        good = (rx.status.payload == Status.OK) & (tx.status.payload == Status.OK)
        m.d.comb += [
            held.verdict.payload.eq(good),
            held.verdict.valid.eq(rx.status.valid & tx.status.valid),
            *(status.ready.eq(held.verdict.valid & held.verdict.ready) for status in statuses),
        ]
        return m

    def filtered(self, bits: Value) -> Value:
        """Filter a float32; numbers that are not negative have the same order as their bits."""
        return Mux((bits > self.limit_bits) & (bits < INFINITE), INFINITE, bits)


def main() -> int:
    """Send good and damaged scans; return 1 if a byte is wrong."""
    store = get_typestore(Stores.ROS2_LYRICAL)

    def packet(ranges: list[float], frame: str = "laser") -> bytes:
        stamp = store.types["builtin_interfaces/msg/Time"](sec=1, nanosec=2)
        header = store.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)
        given = np.array(ranges, dtype=np.float32)
        intensities = np.full(2, 9e9, dtype=np.float32)
        scan = store.types["sensor_msgs/msg/LaserScan"](
            header, -1.5, 1.5, 0.5, 0.0, 0.1, 0.0, 100.0, given, intensities
        )
        return bytes(store.serialize_cdr(scan, "sensor_msgs/msg/LaserScan"))

    near, far, edge = 0.5, 17.0, 10.0
    beyond = float(np.nextafter(np.float32(edge), np.float32(far)))
    good = packet([far] * 9)
    sent = [
        packet([near, far, edge, beyond, math.inf, math.nan, -far]),
        good[:-1],  # The last byte is missing.
        good[:70],  # Most of the ranges are missing.
        packet([far], "another frame"),
        good + bytes(8),
        packet([near] * 600),  # More than the buffer holds.
        b"\0\2" + good[2:],  # Another encapsulation.
        packet([], ""),
    ]
    expected = [
        packet([near, math.inf, edge, math.inf, math.inf, math.nan, -far]),
        packet([math.inf], "another frame"),
        packet([], ""),
    ]
    received: list[bytes] = []
    dut = RangeFilter(edge)

    async def source(ctx: SimulatorContext) -> None:
        await send_packets(ctx, dut.packets_in, sent, stalls=Stalls(probability=0.3, seed=1))

    async def sink(ctx: SimulatorContext) -> None:
        stalls = Stalls(probability=0.3, seed=2)
        received.extend(await receive_packets(ctx, dut.packets_out, len(expected), stalls=stalls))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(source, background=True)
    simulator.add_testbench(sink)
    simulator.run()
    for data in received:
        message: Any = store.deserialize_cdr(data, "sensor_msgs/msg/LaserScan")
        print(f"{message.header.frame_id!r}: {message.ranges.tolist()}")
    return 0 if received == expected else 1


if __name__ == "__main__":
    sys.exit(main())
