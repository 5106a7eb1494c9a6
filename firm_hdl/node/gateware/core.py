"""The core of a node: packets between the link and the topics."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketArbiter, PacketFifo, PacketGate, PacketRouter, PacketSignature
from firm_hdl.node.control import (
    CONTROL_BYTES,
    COUNTERS_FROM,
    IDENTITY,
    counter_path,
    link_counters,
    registers,
)
from firm_hdl.node.description import (
    CONTROL_TOPIC,
    Description,
    Kind,
    Topic,
)
from firm_hdl.node.frame import VERSION
from firm_hdl.node.gateware.clock import NodeClock
from firm_hdl.node.gateware.control_unit import ByteCounter, ControlUnit, RegisterReader
from firm_hdl.node.gateware.registers import CoreSideSignature
from firm_hdl.node.gateware.services import RequestGate, TaggedFifo
from firm_hdl.node.gateware.streams import (
    LENGTH_BITS,
    TAG_BITS,
    LinkSignature,
    RequestSignature,
    ResponseSignature,
    link_counters_layout,
    node_counters_layout,
    passes,
    time_layout,
)

__all__ = ["NodeCore"]


class NodeCore(wiring.Component):
    """Route packets from the link to gates, and collect packets for the link.

    From the link, each packet goes to the gate of its topic. Only what its gate passes comes out.
    To the link, each publication and each service has a FIFO of whole packets, and all take turns.
    Topic 0 is control. All losses are counted where they happen.

    A beat is taken per cycle and leaves per cycle. From the last beat of a packet on `received` to
    its first one at a subscription: 1 cycle more than in a :class:`PacketGate`. From the last beat
    of a publication to the first one on `sent`: 7 cycles, if it is the turn of the publication.

    Outputs depend on registers only. One clock domain, `sync`; its reset discards all packets
    inside, and sets the time to 0.

    Parameters
    ----------
    description : Description

    Members
    -------
    received : In(LinkSignature(bus_bytes))
        `ready` falls only for a subscription whose policy is `"wait"`.
    sent : Out(LinkSignature(bus_bytes))
    subscribe : members with the ports of subscriptions, each Out(PacketSignature(bus_bytes))
    publish : likewise of publications, each In(ResponseSignature(bus_bytes))
    serve : likewise of services, each with `request`, Out(RequestSignature(bus_bytes)), and
        `response`, In(ResponseSignature(bus_bytes))
        Responses may come in any order.
    time : Out(time_layout())
        The clock that the host sets.
    link_counters : In(link_counters_layout(description.link))
        Counters of the link, for the host to read.
    counters : Out(node_counters_layout(description))
    registers : Out(CoreSideSignature())
        Only if the node has registers.
    """

    def __init__(self, description: Description):
        self.description = description
        bus = description.bus_bytes
        packets, request = PacketSignature(bus), RequestSignature(bus)
        service = wiring.Signature(
            {"request": Out(request), "response": In(ResponseSignature(bus))}
        )
        shapes: dict[Kind, Any] = {
            "subscribe": Out(packets),
            "publish": In(ResponseSignature(bus)),
            "serve": Out(service),
        }
        groups: dict[str, Any] = {
            kind: Out(wiring.Signature({topic.port: shape for topic in description.of_kind(kind)}))
            for kind, shape in shapes.items()
            if description.of_kind(kind)
        }
        super().__init__(
            {
                "received": In(LinkSignature(bus)),
                "sent": Out(LinkSignature(bus)),
                **groups,
                "time": Out(time_layout()),
                "link_counters": In(link_counters_layout(description.link)),
                "counters": Out(node_counters_layout(description)),
                **({"registers": Out(CoreSideSignature())} if description.registers else {}),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus = self.description.bus_bytes
        # By id of the topic: where its packets go to, and where they come from.
        self._inputs: dict[int, Any] = {}
        self._outputs: dict[int, Any] = {}
        self._events: dict[tuple[str, str], Value] = {}
        # High while a message leaves its gate or its FIFO.
        self._leaves: list[Value] = []
        m.submodules.clock = clock = NodeClock(self.description.clock_hz)
        count = len(registers(self.description)) - len(IDENTITY)
        m.submodules.control = control = ControlUnit(bus, len(IDENTITY), COUNTERS_FROM, count)
        m.d.comb += [
            self.time.eq(clock.time),
            control.time.eq(clock.time),
        ]
        self._set_clock(m, control, clock)
        for topic in self.description.topics:
            getattr(self, f"_{topic.kind}")(m, topic)
        self._route(m, control)
        self._collect(m, control)
        self._count(m, control, clock)
        if self.description.registers:
            m.d.comb += self.registers.rate.eq(clock.rate)
            m.d.sync += self.registers.moves.eq(Cat(self._leaves).any())
        return m

    def _set_clock(self, m: Module, control: ControlUnit, clock: NodeClock) -> None:
        """Let the host set the clock, and the registers, which come first."""
        for sets, value in (("sets", "to"), ("sets_rate", "to_rate")):
            asked, new = getattr(control, sets), Value.cast(getattr(control, value))
            if self.description.registers:
                own = getattr(self.registers, sets)
                asked, new = asked | own, Mux(own, getattr(self.registers, value), new)
            m.d.comb += [
                getattr(clock, sets).eq(asked),
                Value.cast(getattr(clock, value)).eq(new),
            ]

    def _subscribe(self, m: Module, topic: Topic) -> None:
        store = topic.store("in")
        m.submodules[f"gate_{topic.port}"] = gate = PacketGate(
            store.message,
            wire=self.description.wire,
            bus_bytes=self.description.bus_bytes,
            memory_bytes=store.memory_bytes,
            packets=store.packets,
            when_full=store.when_full,
            max_message_bytes=store.max_message_bytes,
        )
        m.d.comb += gate.status.ready.eq(1)
        out = getattr(self.subscribe, topic.port)
        m.d.comb += passes(gate.packets_out, out)
        self._inputs[topic.id] = gate
        self._counted(m, f"subscribe_{topic.port}", gate, out)

    def _publish(self, m: Module, topic: Topic) -> None:
        store = topic.store("out")
        m.submodules[f"fifo_{topic.port}"] = fifo = PacketFifo(
            self.description.bus_bytes,
            store.memory_bytes,
            store.packets,
            when_full=store.when_full,
        )
        came = getattr(self.publish, topic.port)
        m.d.comb += [*passes(came.packets, fifo.packets_in), fifo.abort.eq(came.abort)]
        self._outputs[topic.id] = (fifo, Const(0, TAG_BITS))
        self._counted(m, f"publish_{topic.port}", fifo, fifo.packets_out)

    def _serve(self, m: Module, topic: Topic) -> None:
        bus = self.description.bus_bytes
        asked, answered = topic.store("in"), topic.store("out")
        gate = RequestGate(bus, asked, self.description.wire)
        fifo = TaggedFifo(bus, answered)
        m.submodules[f"gate_{topic.port}"] = gate
        m.submodules[f"fifo_{topic.port}"] = fifo
        port = getattr(self.serve, topic.port)
        m.d.comb += [
            *passes(gate.packets_out, port.request.packets),
            port.request.tag.eq(gate.tag_out),
            *passes(port.response.packets, fifo.packets_in),
            fifo.tag_in.eq(port.response.tag),
            fifo.abort.eq(port.response.abort),
        ]
        self._inputs[topic.id] = gate
        self._outputs[topic.id] = (fifo, fifo.tag_out)
        self._counted(m, f"request_{topic.port}", gate, port.request.packets)
        self._counted(m, f"response_{topic.port}", fifo, fifo.packets_out)

    def _counted(self, m: Module, owner: str, part: Any, out: Any) -> None:
        """Note the counters of a gate or a FIFO, and count the bytes of what leaves it."""
        m.submodules[f"bytes_{owner}"] = total = ByteCounter(len(part.size))
        self._leaves.append(total.adds)
        m.d.comb += [
            total.adds.eq(out.valid & out.ready & out.payload.last),
            total.size.eq(part.size),
        ]
        for name in part.counters.shape().members:
            self._events[owner, name] = part.counters[name]
        self._events[owner, "bytes_low"] = total.low
        self._events[owner, "bytes_high"] = total.high

    def _route(self, m: Module, control: ControlUnit) -> None:
        """Send each packet to the part of its topic.

        A gate takes what comes, or drops it and counts. So no topic can hold the others, except for
        a subscription with the policy `"wait"`, which a link without losses alone may have.
        """
        inputs = {CONTROL_TOPIC: control, **self._inputs}
        bits = len(inputs).bit_length()
        m.submodules.router = router = PacketRouter(
            self.description.bus_bytes, len(inputs), topic_bits=bits, side_bits=TAG_BITS
        )
        came = self.received
        number = Signal(bits, init=len(inputs))
        # Ids of publications are no inputs, so inputs are numbered anew; others are unknown.
        with m.Switch(came.payload.topic):
            for place, topic in enumerate(inputs):
                with m.Case(topic):
                    m.d.comb += number.eq(place)
        m.d.comb += [
            router.packets_in.payload.eq(came.payload.beat),
            router.packets_in.valid.eq(came.valid),
            came.ready.eq(router.packets_in.ready),
            router.topic.eq(number),
            router.side_in.eq(came.payload.tag),
        ]
        for port, part in zip(router.packets_out, inputs.values(), strict=True):
            m.d.comb += passes(port, part.packets_in)
            if hasattr(part, "tag_in"):
                m.d.comb += part.tag_in.eq(router.side_out)
        self._events["node", "unknown"] = router.counters.unknown

    def _collect(self, m: Module, control: ControlUnit) -> None:
        """Send the packets of all topics, in turn."""
        # Tag and length travel beside each beat of a packet, because the header of its frame has
        # them, and is sent first. A FIFO knows the length, as it has the whole packet.
        count = 1 + len(self._outputs)
        m.submodules.arbiter = arbiter = PacketArbiter(
            self.description.bus_bytes, count, side_bits=TAG_BITS + LENGTH_BITS
        )
        parts = [(control, control.tag_out, Const(CONTROL_BYTES, LENGTH_BITS))]
        parts += [(part, tag, part.size) for part, tag in self._outputs.values()]
        for number, (part, tag, size) in enumerate(parts):
            length = Signal(LENGTH_BITS, name=f"length_{number}")
            m.d.comb += [
                *passes(part.packets_out, arbiter.packets_in[number]),
                length.eq(size),
                arbiter.sides_in[number].eq(Cat(tag, length)),
            ]
        topics = Array(Const(topic, 16) for topic in (CONTROL_TOPIC, *self._outputs))
        sent, out = self.sent, arbiter.packets_out
        m.d.comb += [
            sent.payload.beat.eq(out.payload),
            sent.payload.topic.eq(topics[arbiter.source]),
            sent.payload.tag.eq(arbiter.side_out[:TAG_BITS]),
            sent.payload.length.eq(arbiter.side_out[TAG_BITS:]),
            sent.valid.eq(out.valid),
            out.ready.eq(sent.ready),
        ]

    def _count(self, m: Module, control: ControlUnit, clock: NodeClock) -> None:
        """Bring all counters out, and to the host."""
        self._events["node", "control"] = control.counters.control
        self._events["node", "control_full"] = control.counters.control_full
        for name in link_counters(self.description.link):
            self._events["link", name] = self.link_counters[name]
        m.submodules.reader = reader = RegisterReader(len(registers(self.description)))
        values = list(self._identity(clock))
        for each in registers(self.description)[len(IDENTITY) :]:
            owner, name = counter_path(self.description, each)
            m.d.comb += self.counters[owner][name].eq(self._events[owner, name])
            values.append(self.counters[owner][name])
        m.d.comb += [
            *(reader.values[number].eq(value) for number, value in enumerate(values)),
            reader.number.eq(control.number),
            control.value.eq(reader.value),
        ]

    def _identity(self, clock: NodeClock) -> Iterator[Value]:
        """Yield the values of the registers `IDENTITY`."""
        description = self.description
        values = {
            "version": VERSION,
            "fingerprint_low": description.fingerprint & 0xFFFF_FFFF,
            "fingerprint_high": description.fingerprint >> 32,
            "topics": len(description.topics),
            "clock_hz": round(description.clock_hz),
        }
        for name in IDENTITY:
            yield clock.rate if name == "rate" else Const(values[name], 32)
