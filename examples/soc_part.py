"""A part of an SoC with three clocks: commands come in, samples and answers leave.

A motor and a sensor have clocks of their own, and the rest of the SoC has AXI4-Stream at a third
one. Only packets cross between clocks, in three crossings. The sensor's message has constant
texts. Run the example with ``python examples/soc_part.py``.
"""

from __future__ import annotations

import sys

from amaranth.hdl import DomainRenamer, Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out, connect, flipped
from amaranth.sim import Simulator, SimulatorContext

from firm_hdl import (
    AxiStreamSignature,
    AxiStreamToPackets,
    Deserializer,
    PacketArbiter,
    PacketCrossing,
    PacketGate,
    PacketRouter,
    PacketSignature,
    PacketsToAxiStream,
    Serializer,
    load_message,
)
from firm_hdl.accelerator import Fixed, FixedToFloat, offer_message, take_message
from firm_hdl.sim import encode, receive_packets, send, send_packets

__all__ = ["Motor", "SocPart", "Thermometer", "main"]

TWIST = load_message("geometry_msgs/msg/Twist")
SPEED = load_message("std_msgs/msg/Float64")
TEMPERATURE = load_message("sensor_msgs/msg/Temperature")
CELSIUS = Fixed(16, 8)
BUS_BYTES = 4


class Motor(wiring.Component):
    """Take the forward speed of good commands, and answer each with the speed."""

    def __init__(self) -> None:
        packets = PacketSignature(BUS_BYTES)
        super().__init__({"packets_in": In(packets), "packets_out": Out(packets), "speed": Out(64)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.gate = gate = PacketGate(TWIST, bus_bytes=BUS_BYTES, memory_bytes=256)
        m.submodules.rx = rx = Deserializer(TWIST, bus_bytes=BUS_BYTES)
        m.submodules.tx = tx = Serializer(SPEED, bus_bytes=BUS_BYTES)
        connect(m, flipped(self.packets_in), gate.packets_in)
        connect(m, gate.packets_out, rx.packets)
        connect(m, tx.packets, flipped(self.packets_out))
        m.d.comb += [part.status.ready.eq(1) for part in (gate, rx, tx)]
        command = take_message(m, rx.message, fields=["linear.x"])
        answer = offer_message(m, tx.message)
        m.d.comb += [
            answer.payload.data.eq(command.payload.linear.x),
            answer.valid.eq(command.valid),
            command.ready.eq(answer.ready),
        ]
        with m.If(command.valid & command.ready):
            m.d.sync += self.speed.eq(command.payload.linear.x)
        return m


class Thermometer(wiring.Component):
    """Make a message of each sample."""

    def __init__(self) -> None:
        packets = PacketSignature(BUS_BYTES)
        super().__init__({"samples": In(stream.Signature(CELSIUS)), "packets_out": Out(packets)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.number = number = FixedToFloat(CELSIUS, 64)
        m.submodules.tx = tx = Serializer(TEMPERATURE, bus_bytes=BUS_BYTES)
        connect(m, flipped(self.samples), number.i)
        connect(m, tx.packets, flipped(self.packets_out))
        constants = {"header.frame_id": "board", "variance": 0.25}
        sample = offer_message(m, tx.message, fields=["temperature"], constants=constants)
        m.d.comb += [
            sample.payload.temperature.eq(number.o.payload),
            sample.valid.eq(number.o.valid),
            number.o.ready.eq(sample.ready),
            tx.status.ready.eq(1),
        ]
        return m


class SocPart(wiring.Component):
    """Motor and thermometer behind AXI4-Stream; TDEST is 0 for answers, and 1 for samples.

    The clock domains are `link` for AXI4-Stream, `motor` and `sensor`.
    """

    def __init__(self) -> None:
        axis, samples = AxiStreamSignature(BUS_BYTES), stream.Signature(CELSIUS)
        out = AxiStreamSignature(BUS_BYTES, dest_bits=1)
        members = {"s_axis": In(axis), "m_axis": Out(out), "samples": In(samples)}
        super().__init__({**members, "speed": Out(64)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # Parts have the domain `sync`, which gets the name of their clock here.
        m.submodules.motor = motor = DomainRenamer("motor")(Motor())
        m.submodules.sensor = sensor = DomainRenamer("sensor")(Thermometer())
        m.submodules.both = both = DomainRenamer("link")(PacketArbiter(BUS_BYTES, 2))
        m.submodules.from_axis = from_axis = AxiStreamToPackets(BUS_BYTES)
        m.submodules.to_axis = to_axis = PacketsToAxiStream(BUS_BYTES, dest_bits=1)
        for source, write, target, read in (
            (from_axis.packets, "link", motor.packets_in, "motor"),
            (motor.packets_out, "motor", both.packets_in[0], "link"),
            (sensor.packets_out, "sensor", both.packets_in[1], "link"),
        ):
            crossing = PacketCrossing(BUS_BYTES, write_domain=write, read_domain=read)
            m.submodules[f"{write}_to_{read}"] = crossing
            connect(m, source, crossing.packets_in)
            connect(m, crossing.packets_out, target)
        connect(m, flipped(self.s_axis), from_axis.axis)
        connect(m, both.packets_out, to_axis.packets)
        connect(m, to_axis.axis, flipped(self.m_axis))
        connect(m, flipped(self.samples), sensor.samples)
        m.d.comb += [to_axis.dest_in.eq(both.source), self.speed.eq(motor.speed)]
        return m


def main() -> int:
    """Send commands and samples; return 1 if an answer is wrong."""
    speeds, samples = [1.5, -2.0, 0.25], [21.5, -3.75]
    zeros = {"x": 0.0, "y": 0.0, "z": 0.0}
    twists = [{"linear": {**zeros, "x": speed}, "angular": zeros} for speed in speeds]
    commands = encode(TWIST, twists).packets
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "board"}
    want = (
        encode(SPEED, [{"data": speed} for speed in speeds]).packets,
        encode(
            TEMPERATURE,
            [{"header": header, "temperature": each, "variance": 0.25} for each in samples],
        ).packets,
    )
    # The rest of the SoC: it sends and takes packets, and looks at TDEST.
    top, soc = Module(), SocPart()
    top.submodules.soc = soc
    top.submodules.to_axis = to_axis = PacketsToAxiStream(BUS_BYTES)
    top.submodules.from_axis = from_axis = AxiStreamToPackets(BUS_BYTES, dest_bits=1)
    top.submodules.router = router = DomainRenamer("link")(PacketRouter(BUS_BYTES, 2, topic_bits=1))
    connect(top, to_axis.axis, soc.s_axis)
    connect(top, soc.m_axis, from_axis.axis)
    connect(top, from_axis.packets, router.packets_in)
    top.d.comb += router.topic.eq(from_axis.dest_out)
    got: list[list[bytes]] = [[], []]

    async def command(ctx: SimulatorContext) -> None:
        # A damaged packet is dropped.
        packets = [commands[0][:-1], *commands]
        await send_packets(ctx, to_axis.packets, packets, domain="link")

    async def sample(ctx: SimulatorContext) -> None:
        payloads = [CELSIUS.raw(each) for each in samples]
        await send(ctx, soc.samples, payloads, domain="sensor")

    async def answers(ctx: SimulatorContext) -> None:
        port = router.packets_out[0]
        got[0] = await receive_packets(ctx, port, len(speeds), domain="link")

    async def temperatures(ctx: SimulatorContext) -> None:
        port = router.packets_out[1]
        got[1] = await receive_packets(ctx, port, len(samples), domain="link")

    simulator = Simulator(top)
    for domain, period in (("link", 8e-9), ("motor", 10e-9), ("sensor", 31e-9)):
        simulator.add_clock(period, domain=domain)
    for bench in (command, sample, answers, temperatures):
        simulator.add_testbench(bench)
    simulator.run()
    for name, packets, right in zip(("speeds", "samples"), got, want, strict=True):
        print(f"{name}: {len(packets)} packets, {'right' if packets == right else 'wrong'}")
    return 0 if tuple(got) == want else 1


if __name__ == "__main__":
    sys.exit(main())
