"""Split one packet stream into several, by topic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream
from firm_hdl.gateware.limits import check_bits, check_integer
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.gateware.packets.sides import side_members
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.signatures import PacketSignature, packet_layout

__all__ = ["PacketRouter"]


class PacketRouter(Component):
    """Send each packet to the output of its topic.

    `topic` travels with the packet; the value beside its first beat counts. A packet whose topic
    has no output is dropped whole, a beat per cycle, and counted.

    Latency 1 cycle. Throughput one beat per cycle, without gaps between packets. An output
    that does not take its packet holds all that come after it, whatever their topics. Behind a
    router, a :class:`PacketFifo` with the policy `"drop"` never does.

    `packets_in.ready`, and `valid` and `payload` of the outputs, are registers. One clock domain,
    `sync`; its reset discards the beats inside, and the next beat begins a packet.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    topics : int
        Number of outputs, at least 1. A packet goes to the output with the number `topic`.
    topic_bits : int
        Bits of `topic`.
    side_bits : int
        Bits that travel beside each beat, such as a tag. 0: there are none.

    Members
    -------
    packets_in : In(PacketSignature(bus_bytes))
    side_in : In(side_bits)
        Only with `side_bits`. As stable as the payload.
    topic : In(topic_bits)
        Topic of the packet; has to be stable while a first beat is offered.
    packets_out : array(topics) of Out(PacketSignature(bus_bytes))
    side_out : Out(side_bits)
        Only with `side_bits`. What came beside the beat that an output offers; valid with it.
    counters : Out(counters_layout("routed", "unknown"))
        Packets that were sent to an output, and those that were dropped, each with 32 bits; a
        counter stops at its largest value. Counted 2 cycles after the last beat was taken.
    """

    packets_in: PacketStream
    side_in: Value
    topic: Value
    packets_out: Sequence[PacketStream]
    side_out: Value
    counters: Any

    def __init__(self, bus_bytes: int, topics: int, *, topic_bits: int = 16, side_bits: int = 0):
        check_integer("Number of topics", topics)
        check_bits("Number of topic bits", topic_bits)
        sides = side_members(side_bits)
        if topics < 1:
            raise ValueError(f"Number of topics must be at least 1, not {topics}")
        if topics > 1 << topic_bits:
            raise ValueError(f"{topics} topics do not fit into {topic_bits} bits")
        self.bus_bytes, self.topics, self.side_bits = bus_bytes, topics, side_bits
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)),
                "topic": In(topic_bits),
                "packets_out": Out(PacketSignature(bus_bytes)).array(topics),
                "counters": Out(counters_layout("routed", "unknown")),
                **sides,
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        packets, count = self.packets_in, self.topics
        layout = data.StructLayout(
            {
                "beat": packet_layout(self.bus_bytes),
                "to": count,
                **({"side": self.side_bits} if self.side_bits else {}),
            }
        )
        m.submodules.slice = out = StreamSlice(layout)
        # A bit for each output: that of the topic, that of the packet that has begun, and which of
        # both counts.
        named = Signal(count)
        begun = Signal(count)
        to = Signal(count)
        inside = Signal()
        ends = Signal()
        m.d.comb += [
            named.eq(Cat(self.topic == number for number in range(count))),
            to.eq(Mux(inside, begun, named)),
            out.i.payload.beat.eq(packets.payload),
            out.i.payload.to.eq(to),
            out.i.valid.eq(packets.valid),
            packets.ready.eq(out.i.ready),
            ends.eq(packets.valid & packets.ready & packets.payload.last),
        ]
        if self.side_bits:
            m.d.comb += [
                out.i.payload.side.eq(self.side_in),
                self.side_out.eq(out.o.payload.side),
            ]
        takes = []
        for number, port in enumerate(self.packets_out):
            m.d.comb += [
                port.payload.eq(out.o.payload.beat),
                port.valid.eq(out.o.valid & out.o.payload.to[number]),
            ]
            takes.append(port.ready & out.o.payload.to[number])
        # Beats of a packet without an output are dropped here: `topic` may come late in a cycle.
        m.d.comb += out.o.ready.eq(Cat(takes).any() | ~out.o.payload.to.any())
        with m.If(packets.valid & packets.ready):
            m.d.sync += [inside.eq(~packets.payload.last), begun.eq(to)]
        add_counters(m, self.counters, {"routed": ends & to.any(), "unknown": ends & ~to.any()})
        return m
