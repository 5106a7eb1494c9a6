"""A filter that drops points of a PointCloud2: an output of another length than the input.

The width of a cloud and the length of its data come before the points, so they have to be known
before the first point leaves. Each packet is read twice: the first time, the points to keep are
counted, while a FIFO stores the packet; the second time, they are sent. Run the example with
``python examples/cloud_filter.py``.
"""

from __future__ import annotations

import struct
import sys
from typing import Any

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import data, enum, stream, wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator, SimulatorContext

from firm_hdl import (
    Deserializer,
    MessageInterface,
    PacketFifo,
    PacketGate,
    PacketSignature,
    Serializer,
    Stream,
    load_message,
)
from firm_hdl.accelerator import Fork, tie_off
from firm_hdl.sim import Stalls, encode, receive_packets, send_packets

__all__ = ["CloudFilter", "main"]

CLOUD = load_message("sensor_msgs/msg/PointCloud2")
BUS_BYTES = 16  # As many as a point has: so a transfer of `data` is a point.
MEMORY_BYTES = 1 << 12


class Part(enum.Enum):
    """Which part of a cloud is sent."""

    HEAD, LENGTHS, POINTS = range(3)


class CloudFilter(wiring.Component):
    """Drop the points whose x, a float32 in their first bytes, is beyond a limit, or NaN.

    Clouds of which a point has not 16 bytes pass unchanged. Damaged packets are dropped.

    Parameters
    ----------
    limit : float
        Largest absolute value of x.
    """

    def __init__(self, limit: float) -> None:
        (self.limit_bits,) = struct.unpack("<I", struct.pack("<f", limit))
        packets = PacketSignature(BUS_BYTES)
        super().__init__({"packets_in": In(packets), "packets_out": Out(packets)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.gate = gate = PacketGate(CLOUD, bus_bytes=BUS_BYTES, memory_bytes=MEMORY_BYTES)
        m.submodules.fork = fork = Fork(gate.packets_out.payload.shape(), 2)
        # What leaves the gate fits into a FIFO of the same size, which so drops nothing.
        m.submodules.fifo = fifo = PacketFifo(BUS_BYTES, MEMORY_BYTES, 2)
        m.submodules.first = first = Deserializer(CLOUD, bus_bytes=BUS_BYTES)
        m.submodules.second = second = Deserializer(CLOUD, bus_bytes=BUS_BYTES)
        m.submodules.tx = tx = Serializer(CLOUD, bus_bytes=BUS_BYTES)
        connect(m, flipped(self.packets_in), gate.packets_in)
        connect(m, gate.packets_out, fork.i)
        connect(m, fork.o[0], first.packets)
        connect(m, fork.o[1], fifo.packets_in)
        connect(m, fifo.packets_out, second.packets)
        connect(m, tx.packets, flipped(self.packets_out))
        m.d.comb += [part.status.ready.eq(1) for part in (gate, first, second, tx)]
        self.send(m, second.message, tx.message, self.count(m, first.message))
        return m

    def keeps(self, items: MessageInterface) -> Value:
        """Return whether a point is kept; floats without sign have the order of their bits."""
        return Value.cast(items.payload.data)[:31] <= self.limit_bits

    def count(self, m: Module, cloud: MessageInterface) -> Stream[Any]:
        """Take a cloud; return the stream of whether it is filtered, and how many points stay."""
        length, items, step = cloud.data.length, cloud.data.items, cloud.point_step
        tie_off(
            m,
            *(getattr(cloud, f.name) for f in CLOUD.fields if f.name[:5] not in ("data", "point")),
        )
        layout = data.StructLayout({"filtered": 1, "kept": 32})
        result: Stream[Any] = stream.Signature(layout).create(path=("result",))
        kept, total, is_over = Signal(32), Signal(32), Signal()
        # Both are held until the points are over, so that those of the next cloud are not seen.
        known = length.valid & step.valid & ~result.valid
        m.d.comb += [
            items.ready.eq(known),
            total.eq(kept + (items.valid & self.keeps(items))),
            is_over.eq(known & ((length.payload == 0) | (items.valid & items.payload.last))),
            length.ready.eq(is_over),
            step.ready.eq(is_over),
        ]
        with m.If(items.valid & items.ready):
            m.d.sync += kept.eq(total)
        with m.If(is_over):
            is_filtered = (step.payload == BUS_BYTES) & (length.payload[:4] == 0)
            m.d.sync += [kept.eq(0), result.valid.eq(1)]
            m.d.sync += [result.payload.kept.eq(total), result.payload.filtered.eq(is_filtered)]
        with m.Elif(result.ready):
            m.d.sync += result.valid.eq(0)
        return result

    def send(
        self, m: Module, old: MessageInterface, new: MessageInterface, result: Stream[Any]
    ) -> None:
        """Send the cloud again, with the points that are kept, and take the result with its end."""
        part, sent = Signal(Part), Signal(32)
        is_filtered, kept = result.payload.filtered, result.payload.kept
        size = kept * BUS_BYTES
        changed = {"height": 1, "width": kept, "row_step": size}
        for field in CLOUD.fields:
            if field.name not in (*changed, "data"):
                connect(m, getattr(old, field.name), getattr(new, field.name))
        leaves = [(getattr(old, each), getattr(new, each), changed[each]) for each in changed]
        for source, target, value in [*leaves, (old.data.length, new.data.length, size)]:
            # The height is the first of them. All that follows waits for the result with it.
            is_first = source is old.height
            passes = (part == Part.HEAD) & result.valid if is_first else part == Part.LENGTHS
            m.d.comb += [
                target.payload.eq(Mux(is_filtered, value, source.payload)),
                target.valid.eq(source.valid & passes),
                source.ready.eq(target.ready & passes),
            ]
        came, gone = old.data.items, new.data.items
        keeps = self.keeps(came) | ~is_filtered
        m.d.comb += [
            gone.payload.data.eq(came.payload.data),
            gone.payload.last.eq(Mux(is_filtered, sent + 1 == kept, came.payload.last)),
            gone.valid.eq(came.valid & keeps & (part == Part.POINTS)),
            came.ready.eq((gone.ready | ~keeps) & (part == Part.POINTS)),
        ]
        with m.If(new.height.valid & new.height.ready):
            m.d.sync += [part.eq(Part.LENGTHS), sent.eq(0)]
        with m.If(gone.valid & gone.ready):
            m.d.sync += sent.eq(sent + 1)
        length_ends = old.data.length.valid & old.data.length.ready
        with m.If(length_ends):
            m.d.sync += part.eq(Part.POINTS)
        is_empty = length_ends & (old.data.length.payload == 0)
        with m.If(is_empty | (came.valid & came.ready & came.payload.last)):
            m.d.sync += part.eq(Part.HEAD)
            m.d.comb += result.ready.eq(1)


def main() -> int:
    """Send good and damaged clouds; return 1 if a point is wrong."""

    def cloud(xs: list[float], point_step: int = 16) -> dict[str, Any]:
        points = b"".join(struct.pack("<ffff", x, 1.0, 2.0, 3.0) for x in xs)
        names = [(name, 4 * place) for place, name in enumerate(("x", "y", "z", "intensity"))]
        return {
            "header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "lidar"},
            "height": 1,
            "width": len(points) // point_step,
            "fields": [{"name": n, "offset": at, "datatype": 7, "count": 1} for n, at in names],
            "is_bigendian": False,
            "point_step": point_step,
            "row_step": len(points),
            "data": list(points),
            "is_dense": False,
        }

    limit, nan = 10.0, float("nan")
    came = [[1.0, -10.0, 10.5, nan, 3.0, 11.0], [99.0, 98.0], [], [5.0], [-10.5, 0.0]]
    others = [cloud([50.0, 60.0], point_step=32)]
    gone = [[x for x in xs if abs(x) <= limit] for xs in came]
    clouds = [*map(cloud, came), *others, *map(cloud, gone), *others]
    packets = encode(CLOUD, clouds, bus_bytes=BUS_BYTES).packets
    sent, expected = packets[: len(packets) // 2], packets[len(packets) // 2 :]
    received: list[bytes] = []
    dut = CloudFilter(limit)

    async def source(ctx: SimulatorContext) -> None:
        # The last byte of one packet is missing.
        await send_packets(ctx, dut.packets_in, [sent[0], sent[0][:-1], *sent[1:]])

    async def sink(ctx: SimulatorContext) -> None:
        stalls = Stalls(probability=0.2, max_cycles=9, seed=1)
        count = len(expected)
        received.extend(await receive_packets(ctx, dut.packets_out, count, stalls=stalls))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(source)
    simulator.add_testbench(sink)
    simulator.run()
    for xs, packet, right in zip(gone, received, expected, strict=False):
        print(f"x = {xs}: {'right' if packet == right else 'wrong'}")
    return 0 if received == expected else 1


if __name__ == "__main__":
    sys.exit(main())
