"""The link that is a participant of DDS: the node is in the graph of ROS 2 without a host."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.datagrams import DatagramSignature
from firm_hdl.gateware import PacketFifo, PacketWidth
from firm_hdl.gateware.packets.counters import add_counters
from firm_hdl.node.description import Description
from firm_hdl.node.gateware.streams import link_members, passes
from firm_hdl.node.rtps.assembler import Assembler
from firm_hdl.node.rtps.endpoints import own_of, ports_of_link
from firm_hdl.node.rtps.engine import Engine
from firm_hdl.node.rtps.history import History, assembly_parts, parts_of
from firm_hdl.node.rtps.intake import Intake
from firm_hdl.node.rtps.messages import MessageReader
from firm_hdl.node.rtps.templates import templates_of
from firm_hdl.node.rtps.transmitter import Transmitter

__all__ = ["RtpsLink", "idle_bits"]


def idle_bits(description: Description) -> int:
    """Return the width of `idle`: a bit for each topic of a description that comes in."""
    return max(1, sum(topic.has("in") for topic in description.topics))


class RtpsLink(wiring.Component):
    """Speak RTPS over UDP (DDSI-RTPS 2.5), so that peers of ROS 2 find the node and its topics.

    The core below has to deliver the datagrams of three ports, and to join the group of the first
    one: :func:`.ports_of_link` and `MULTICAST_GROUP` of :mod:`firm_hdl.rtps.wire.locators`. A
    datagram is read when it is there as a whole, and `datagrams_in.ready` is always high.

    Parameters
    ----------
    description : Description

    Members
    -------
    received : Out(LinkSignature(bus_bytes))
        The tag of a request is a number that leads back to who asked.
    sent : In(LinkSignature(bus_bytes))
    counters : Out(link_counters_layout())
    datagrams_in, datagrams_out : In and Out(DatagramSignature(1))
    idle : In(number of subscriptions and services)
        The topic has passed on, or dropped, all that came; see :class:`.TopicIdle`.
    nonce : In(32)
        Makes the GUID prefix of each start another one; see :class:`.Engine`. It has to be stable
        from the end of the reset on.
    """

    def __init__(self, description: Description):
        self.description = description
        bus = description.bus_bytes
        super().__init__(
            {
                **link_members(bus),
                "idle": In(idle_bits(description)),
                **self.medium(),
            }
        )

    @staticmethod
    def medium() -> dict[str, Any]:
        """Return the members that face the medium."""
        return {
            "datagrams_in": In(DatagramSignature(1)),
            "datagrams_out": Out(DatagramSignature(1)),
            "nonce": In(32),
        }

    def elaborate(self, platform: object) -> Module:
        m = Module()
        description, link = self.description, self.description.link
        own, templates = own_of(description, bytes(12)), templates_of(description)
        parts, ports = parts_of(own.writers), ports_of_link(description)
        pieces = assembly_parts(description, own.readers)
        m.submodules.engine = engine = Engine(
            description, templates, own.writers, own.readers, parts, pieces
        )
        m.submodules.fifo = fifo = PacketFifo(1, link.memory_bytes, link.packets, when_full="drop")
        m.submodules.reader = reader = MessageReader(link)
        m.submodules.width = width = PacketWidth(1, description.bus_bytes)
        topics = tuple(each.topic.id for each in own.writers if each.topic)
        m.submodules.intake = intake = Intake(
            description.bus_bytes, topics, parts, engine.most_bytes
        )
        wiring.connect(m, engine.histories, intake.histories)
        m.submodules.history = history = History(engine.memory_bytes)
        m.submodules.transmitter = transmitter = Transmitter(
            templates, engine.memory_bytes, ports.discovery
        )
        came, beat = self.datagrams_in, fifo.packets_in.payload
        ends, foreign = Signal(), Signal()
        m.d.comb += [
            Value.cast(beat.data).eq(came.payload.data),
            beat.count.eq(1),
            beat.last.eq(came.payload.last),
            fifo.packets_in.valid.eq(came.valid),
            came.ready.eq(fifo.packets_in.ready),
            ends.eq(came.valid & came.ready & came.payload.last),
            foreign.eq(~_is_one_of(came.payload.dst_port, ports)),
            fifo.abort.eq(came.payload.error | foreign),
            *passes(fifo.packets_out, reader.packets),
            reader.size.eq(fifo.size),
            reader.own.eq(engine.own),
            *passes(reader.events, engine.events),
            engine.announced.eq(reader.announced),
            reader.knows.eq(engine.knows),
            reader.wants.eq(engine.wants),
            engine.came.eq(fifo.packets_out.valid),
            engine.nonce.eq(self.nonce),
            engine.idle.eq(self.idle),
            *passes(self.sent, intake.sent),
            transmitter.order.eq(engine.order),
            transmitter.starts.eq(engine.starts),
            engine.ends.eq(transmitter.ends),
            history.write_at.eq(intake.write_at),
            history.write_byte.eq(intake.write_byte),
            history.writes.eq(intake.writes),
            history.read_at.eq(transmitter.read_at),
            history.reads.eq(transmitter.reads),
            transmitter.byte.eq(history.byte),
            *passes(transmitter.datagrams, self.datagrams_out),
        ]
        assembler = None
        if any(each.bytes for each in pieces):
            m.submodules.assembler = assembler = Assembler(pieces, engine.rows)
            wiring.connect(m, engine.assembly, assembler.lookup)
            wiring.connect(m, reader.fragments, assembler.fragments)
        passed = self._deliver(m, reader, engine, width, assembler)
        add_counters(
            m,
            self.counters,
            {
                "passed": passed,
                "lost": engine.lost,
                "late": engine.late,
                "cut": engine.cut,
                "stray": engine.stray | reader.stray | (ends & foreign),
                "malformed": reader.malformed | (ends & came.payload.error & ~foreign),
                "unsent": engine.unsent | intake.unsent,
            },
        )
        m.d.comb += [
            self.counters.full.eq(fifo.counters.full),
            self.counters.large.eq(fifo.counters.large),
        ]
        return m

    def _deliver(
        self,
        m: Module,
        reader: MessageReader,
        engine: Engine,
        width: PacketWidth,
        assembler: Assembler | None,
    ) -> Value:
        """Pass payloads on to the topics. Return whether the last beat of one leaves."""
        out, inside, passed = self.received, Signal(), Signal()
        m.d.comb += [
            *passes(reader.payload, width.packets_in),
            out.valid.eq(width.packets_out.valid),
            width.packets_out.ready.eq(out.ready),
            out.payload.beat.eq(width.packets_out.payload),
            out.payload.topic.eq(engine.topic),
            out.payload.tag.eq(engine.tag),
            out.payload.length.eq(reader.payload_bytes),
            passed.eq(out.valid & out.ready & out.payload.beat.last),
            reader.drained.eq(~inside),
        ]
        if assembler is not None:
            m.d.comb += reader.drained.eq(~inside & ~assembler.busy)
            with m.If(assembler.busy):
                m.d.comb += passes(assembler.payload, width.packets_in)
        with m.If(width.packets_in.valid & width.packets_in.ready):
            m.d.sync += inside.eq(1)
        with m.If(passed):
            m.d.sync += inside.eq(0)
        return passed


def _is_one_of(port: Value, ports: tuple[int, ...]) -> Value:
    found = [port == each for each in ports]
    return found[0] | found[1] | found[2]
