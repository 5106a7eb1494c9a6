"""An image filter: images of 8 bits per pixel become black and white, all others pass unchanged.

Behind a gate, every message is good. The example shows a field that decides about a later one:
`encoding` says whether the pixels in `data` are changed. The leaves of a deserializer run ahead of
each other, so the encoding of the next image may be valid beside the last pixels of this one. Run
the example with ``python examples/image_filter.py``.
"""

from __future__ import annotations

import sys
from typing import Any

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator, SimulatorContext

from firm_hdl import Deserializer, PacketGate, PacketSignature, Serializer, load_message
from firm_hdl.sim import Stalls, encode, receive_packets, send_packets

__all__ = ["BlackAndWhite", "main"]

IMAGE = load_message("sensor_msgs/msg/Image")
MONO = b"mono8"


class BlackAndWhite(wiring.Component):
    """Make pixels of ``mono8`` images 0 or 255, and drop damaged packets.

    Parameters
    ----------
    threshold : int
        The darkest pixel that becomes white.
    """

    def __init__(self, threshold: int) -> None:
        self.threshold = threshold
        packets = PacketSignature(8)
        super().__init__({"packets_in": In(packets), "packets_out": Out(packets)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.gate = gate = PacketGate(IMAGE, memory_bytes=1 << 12)
        m.submodules.rx = rx = Deserializer(IMAGE)
        m.submodules.tx = tx = Serializer(IMAGE)
        connect(m, flipped(self.packets_in), gate.packets_in)
        connect(m, gate.packets_out, rx.packets)
        connect(m, tx.packets, flipped(self.packets_out))
        m.d.comb += [part.status.ready.eq(1) for part in (gate, rx, tx)]

        old, new = rx.message, tx.message
        for field in IMAGE.fields:
            if field.name != "data":
                connect(m, getattr(old, field.name), getattr(new, field.name))
        connect(m, old.data.length, new.data.length)

        # The serializer takes leaves in the order of the wire. So the encoding of the next image is
        # taken after the last pixels of this one. It may be valid before: only transfers count.
        name, is_mono = old.encoding, Signal()
        with m.If(name.length.valid & name.length.ready):
            m.d.sync += is_mono.eq(name.length.payload == len(MONO))
        with m.If(name.items.valid & name.items.ready):
            is_same = Value.cast(name.items.payload.data) == int.from_bytes(MONO, "little")
            m.d.sync += is_mono.eq(is_mono & is_same)

        came, sent = old.data.items, new.data.items
        m.d.comb += [
            sent.valid.eq(came.valid),
            came.ready.eq(sent.ready),
            sent.payload.last.eq(came.payload.last),
        ]
        for pixel, changed in zip(came.payload.data, sent.payload.data, strict=True):
            white = Mux(pixel >= self.threshold, 255, 0)
            m.d.comb += changed.eq(Mux(is_mono, white, pixel))
        return m


def main() -> int:
    """Send good and damaged images; return 1 if a pixel is wrong."""

    def image(encoding: str, pixels: bytes) -> dict[str, Any]:
        header = {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "camera"}
        size = {"height": 1, "width": len(pixels), "step": len(pixels), "is_bigendian": 0}
        return {"header": header, "encoding": encoding, "data": list(pixels), **size}

    pixels = bytes([127, 128, 255, 0, 99, 200, 1]) * 3
    white = bytes(255 * (pixel >= 128) for pixel in pixels)
    came = [("mono8", pixels), ("rgb8", pixels), ("mono8", b""), ("mono8", pixels)]
    came += [("not a mono8", pixels)]
    gone = [(encoding, white if data and encoding == "mono8" else data) for encoding, data in came]
    good = encode(IMAGE, [image(*each) for each in came + gone]).packets
    # The last byte of one packet is missing.
    sent = [*good[:2], good[0][:-1], *good[2 : len(came)]]
    expected, received = good[len(came) :], list[bytes]()
    dut = BlackAndWhite(128)

    async def source(ctx: SimulatorContext) -> None:
        await send_packets(ctx, dut.packets_in, sent)

    async def sink(ctx: SimulatorContext) -> None:
        stalls = Stalls(probability=0.8, max_cycles=20, seed=1)
        count = len(expected)
        received.extend(await receive_packets(ctx, dut.packets_out, count, stalls=stalls))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(source)
    simulator.add_testbench(sink)
    simulator.run()
    for (encoding, data), packet, right in zip(gone, received, expected, strict=True):
        print(f"{encoding!r}: {data.hex(' ')}: {'right' if packet == right else 'wrong'}")
    return 0 if received == expected else 1


if __name__ == "__main__":
    sys.exit(main())
