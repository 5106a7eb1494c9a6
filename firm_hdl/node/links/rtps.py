"""The link that is a participant of DDS: the node is in the graph of ROS 2 without a host."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.datagrams import DatagramSignature
from firm_hdl.gateware import PacketFifo, PacketSignature, PacketWidth
from firm_hdl.gateware.packets.counters import add_counters
from firm_hdl.node.description import Description
from firm_hdl.node.gateware.streams import link_members, passes
from firm_hdl.node.rtps.assembler import Assembler
from firm_hdl.node.rtps.endpoints import own_of, ports_of_link
from firm_hdl.node.rtps.engine import Engine
from firm_hdl.node.rtps.history import History, assembly_parts, parts_of
from firm_hdl.node.rtps.intake import Intake
from firm_hdl.node.rtps.messages import WORD_BYTES, MessageReader
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
    datagrams_in, datagrams_out : In and Out(DatagramSignature(word_bytes))
        A byte, as a core of LiteEth has it, or 4, also of what comes with the right `last_be`.
    joined_in : In(DatagramSignature(1))
        Only with `has_joined`: other datagrams, without `error`, which are read as they come.
    idle : In(number of subscriptions and services)
        The topic has passed on, or dropped, all that came; see :class:`.TopicIdle`.
    nonce : In(32)
        Makes the GUID prefix of each start another one; see :class:`.Engine`. It has to be stable
        from the end of the reset on.
    """

    def __init__(self, description: Description, has_joined: bool = False, word_bytes: int = 1):
        self.description, self.has_joined = description, has_joined
        self.word_bytes = word_bytes
        bus = description.bus_bytes
        super().__init__(
            {
                **link_members(bus),
                "idle": In(idle_bits(description)),
                **self.medium(),
                "datagrams_in": In(DatagramSignature(word_bytes)),
                "datagrams_out": Out(DatagramSignature(word_bytes)),
                **({"joined_in": In(DatagramSignature(1))} if has_joined else {}),
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
        m.submodules.fifo = fifo = PacketFifo(
            WORD_BYTES, link.memory_bytes, link.packets, when_full="drop"
        )
        m.submodules.reader = reader = MessageReader(link)
        m.submodules.width = width = PacketWidth(WORD_BYTES, description.bus_bytes)
        topics = tuple(each.topic.id for each in own.writers if each.topic)
        m.submodules.intake = intake = Intake(
            description.bus_bytes, topics, parts, engine.most_bytes
        )
        wiring.connect(m, engine.histories, intake.histories)
        m.submodules.history = history = History(engine.memory_bytes)
        m.submodules.transmitter = transmitter = Transmitter(
            templates, engine.memory_bytes, ports.discovery
        )
        came = self.datagrams_in
        ends, foreign = Signal(), Signal()
        packets, size = fifo.packets_out, fifo.size
        if self.has_joined:
            packets, size = self._join(m, fifo)
        m.d.comb += [
            ends.eq(came.valid & came.ready & came.payload.last),
            foreign.eq(~_is_one_of(came.payload.dst_port, ports)),
            *passes(packets, reader.packets),
            reader.size.eq(size),
            reader.own.eq(engine.own),
            *passes(reader.events, engine.events),
            engine.announced.eq(reader.announced),
            reader.knows.eq(engine.knows),
            reader.wants.eq(engine.wants),
            engine.came.eq(packets.valid),
            engine.nears.eq(reader.nears),
            engine.nonce.eq(self.nonce),
            engine.idle.eq(self.idle),
            *passes(self.sent, intake.sent),
            transmitter.order.eq(engine.order),
            transmitter.starts.eq(engine.starts),
            history.write_at.eq(intake.write_at),
            history.write_word.eq(intake.write_word),
            history.writes.eq(intake.writes),
            history.read_at.eq(transmitter.read_at),
            history.reads.eq(transmitter.reads),
            transmitter.word.eq(history.word),
        ]
        assembler = None
        if any(each.bytes for each in pieces):
            m.submodules.assembler = assembler = Assembler(pieces, engine.rows)
            wiring.connect(m, engine.assembly, assembler.lookup)
            wiring.connect(m, reader.fragments, assembler.fragments)
        # An edge of the node counts what it drops itself.
        is_judged = Const(0) if link.has_ethernet else ends & ~foreign
        self._store(m, fifo, came.payload.error | foreign)
        sent = self.datagrams_out
        if self.word_bytes == WORD_BYTES:
            m.d.comb += passes(transmitter.datagrams, sent)
        else:
            self._send_bytes(m, transmitter.datagrams)
        m.d.comb += engine.ends.eq(sent.valid & sent.ready & sent.payload.last)
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
                "malformed": reader.malformed | (came.payload.error & is_judged),
                "unsent": engine.unsent | intake.unsent,
            },
        )
        m.d.comb += [
            self.counters.full.eq(fifo.counters.full),
            self.counters.large.eq(fifo.counters.large),
        ]
        return m

    def _store(self, m: Module, fifo: PacketFifo, abort: Value) -> None:
        """Store datagrams as words."""
        came, packets = self.datagrams_in, fifo.packets_in
        if self.word_bytes == 1:
            m.submodules.words = words = PacketWidth(1, WORD_BYTES, side_bits=1)
            m.d.comb += [
                *passes(words.packets_out, fifo.packets_in),
                words.side_in.eq(abort),
                fifo.abort.eq(words.side_out),
            ]
            packets = words.packets_in
        else:
            m.d.comb += fifo.abort.eq(abort)
        m.d.comb += [
            Value.cast(packets.payload.data).eq(came.payload.data),
            packets.payload.count.eq(self.word_bytes),
            packets.payload.last.eq(came.payload.last),
            packets.valid.eq(came.valid),
            came.ready.eq(packets.ready),
        ]
        for size, ends in enumerate(came.payload.last_be[:-1], 1):
            with m.If(came.payload.last & ends):
                m.d.comb += packets.payload.count.eq(size)

    def _join(self, m: Module, fifo: PacketFifo) -> tuple[Any, Signal]:
        """Take datagrams of `joined_in`, too, in turn; return packets and their sizes."""
        came = self.joined_in
        m.submodules.joined = words = PacketWidth(1, WORD_BYTES)
        packets, size = PacketSignature(WORD_BYTES).create(), Signal(16)
        chosen, inside, ends = Signal(), Signal(), Signal()
        # The size is that of the datagram that comes, so the next one waits.
        is_full, joined_size = Signal(), Signal(16)
        sources = fifo.packets_out, words.packets_out
        beat = words.packets_in.payload
        m.d.comb += [
            Value.cast(beat.data).eq(came.payload.data),
            beat.count.eq(1),
            beat.last.eq(came.payload.last),
            words.packets_in.valid.eq(came.valid & ~is_full),
            came.ready.eq(words.packets_in.ready & ~is_full),
            ends.eq(packets.valid & packets.ready & packets.payload.last),
        ]
        for number, source in enumerate(sources):
            with m.If(chosen == number):
                m.d.comb += passes(source, packets)
                m.d.comb += size.eq(joined_size if number else fifo.size)
        with m.If(packets.valid & packets.ready):
            m.d.sync += inside.eq(~packets.payload.last)
        other = Mux(chosen, sources[0].valid, sources[1].valid)
        with m.If(other & (ends | (~inside & ~packets.valid))):
            m.d.sync += chosen.eq(~chosen)
        with m.If(came.valid & came.ready):
            m.d.sync += [is_full.eq(came.payload.last), joined_size.eq(came.payload.length)]
        with m.Elif(ends & chosen):
            m.d.sync += is_full.eq(0)
        return packets, size

    def _send_bytes(self, m: Module, words: Any) -> None:
        """Divide the words of datagrams into bytes. All else is the same during a datagram."""
        m.submodules.bytes = width = PacketWidth(WORD_BYTES, 1)
        out, wide, narrow = self.datagrams_out, width.packets_in, width.packets_out
        m.d.comb += [
            out.payload.eq(0),
            Value.cast(wide.payload.data).eq(words.payload.data),
            wide.payload.count.eq(WORD_BYTES),
            wide.payload.last.eq(words.payload.last),
            wide.valid.eq(words.valid),
            words.ready.eq(wide.ready),
            out.payload.data.eq(Value.cast(narrow.payload.data)),
            out.payload.last.eq(narrow.payload.last),
            out.payload.last_be.eq(narrow.payload.last),
            out.valid.eq(narrow.valid),
            narrow.ready.eq(out.ready),
            *(
                out.payload[name].eq(words.payload[name])
                for name in ("length", "ip_address", "src_port", "dst_port")
            ),
        ]

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
            m.submodules.assembled = words = PacketWidth(1, WORD_BYTES)
            whole, is_whole = words.packets_out, assembler.busy | words.packets_out.valid
            m.d.comb += [
                *passes(assembler.payload, words.packets_in),
                reader.drained.eq(~inside & ~is_whole),
            ]
            with m.If(is_whole):
                m.d.comb += passes(whole, width.packets_in)
        with m.If(width.packets_in.valid & width.packets_in.ready):
            m.d.sync += inside.eq(1)
        with m.If(passed):
            m.d.sync += inside.eq(0)
        return passed


def _is_one_of(port: Value, ports: tuple[int, ...]) -> Value:
    found = [port == each for each in ports]
    return found[0] | found[1] | found[2]
