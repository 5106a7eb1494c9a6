"""The converters of a node: messages on one side, the core's packets on the other."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.fifo import SyncFIFO
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import Deserializer, MessageSignature, PacketSignature, Serializer
from firm_hdl.node.description import Description, Kind, Store, Topic
from firm_hdl.node.gateware.streams import (
    TAG_BITS,
    RequestSignature,
    ResponseSignature,
    passes,
)

__all__ = ["NodeConverters", "message_groups"]


def message_groups(description: Description) -> dict[str, wiring.Signature]:
    """Return the message ports of a node, as its converters have them.

    A subscription sends its message, a publication takes one. A service sends its `request`, and
    takes its `response`. All are below the name of the group and the port of the topic.
    """

    def message(topic: Topic, direction: Any) -> MessageSignature:
        message = topic.store(direction).message
        return MessageSignature(message, description.bus_bytes, description.wire)

    def port(topic: Topic) -> wiring.Member:
        if topic.kind == "serve":
            request, response = Out(message(topic, "in")), In(message(topic, "out"))
            return Out(wiring.Signature({"request": request, "response": response}))
        return Out(message(topic, "in")) if topic.kind == "subscribe" else In(message(topic, "out"))

    kinds: tuple[Kind, ...] = ("subscribe", "publish", "serve")
    return {
        kind: wiring.Signature({topic.port: port(topic) for topic in description.of_kind(kind)})
        for kind in kinds
        if description.of_kind(kind)
    }


class NodeConverters(wiring.Component):
    """A deserializer for each topic from the host, and a serializer for each topic to the host.

    Behind the gates of the core, every packet is good, so no status is given. A message that the
    serializer finds wrong is dropped by the core, and counted.

    Responses of a service are given in the order of its requests: the tag of a request waits until
    its response is sent. So many requests can be under way as the description says (`packets`),
    and 4 more.

    Parameters
    ----------
    description : Description

    Members
    -------
    packets : members `subscribe`, `publish` and `serve` with those of :class:`NodeCore`, the other
        way round
    subscribe, publish, serve : as `message_groups` has them
    """

    def __init__(self, description: Description):
        self.description = description
        bus = description.bus_bytes
        shapes: dict[Kind, Any] = {
            "subscribe": In(PacketSignature(bus)),
            "publish": Out(ResponseSignature(bus)),
            "serve": Out(
                wiring.Signature(
                    {"request": In(RequestSignature(bus)), "response": Out(ResponseSignature(bus))}
                )
            ),
        }
        packets: dict[str, Any] = {
            kind: Out(wiring.Signature({topic.port: shape for topic in description.of_kind(kind)}))
            for kind, shape in shapes.items()
            if description.of_kind(kind)
        }
        groups = {name: Out(group) for name, group in message_groups(description).items()}
        super().__init__({"packets": Out(wiring.Signature(packets)), **groups})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for topic in self.description.topics:
            packets = getattr(getattr(self.packets, topic.kind), topic.port)
            message = getattr(getattr(self, topic.kind), topic.port)
            if topic.kind == "subscribe":
                self._deserialize(m, topic, packets, message)
            elif topic.kind == "publish":
                m.d.comb += packets.tag.eq(0)
                self._serialize(m, topic, packets, message)
            else:
                self._serve(m, topic, packets, message)
        return m

    def _options(self, store: Store) -> dict[str, Any]:
        return {
            "wire": self.description.wire,
            "bus_bytes": self.description.bus_bytes,
            "max_message_bytes": store.max_message_bytes,
        }

    def _deserialize(self, m: Module, topic: Topic, packets: Any, message: Any) -> None:
        store = topic.store("in")
        rx = Deserializer(store.message, **self._options(store))
        m.submodules[f"{topic.kind}_{topic.port}_in"] = rx
        m.d.comb += [*passes(packets, rx.packets), rx.status.ready.eq(1)]
        wiring.connect(m, rx.message, wiring.flipped(message))

    def _serialize(self, m: Module, topic: Topic, packets: Any, message: Any) -> None:
        store = topic.store("out")
        tx = Serializer(store.message, **self._options(store))
        m.submodules[f"{topic.kind}_{topic.port}_out"] = tx
        m.d.comb += [
            *passes(tx.packets, packets.packets),
            packets.abort.eq(tx.packet_error),
            tx.status.ready.eq(1),
        ]
        wiring.connect(m, wiring.flipped(message), tx.message)

    def _serve(self, m: Module, topic: Topic, packets: Any, message: Any) -> None:
        """Convert requests and responses; a response has the tag of the oldest request."""
        store = topic.store("in")
        depth = store.packets + 4
        m.submodules[f"tags_{topic.port}"] = tags = SyncFIFO(width=TAG_BITS, depth=depth)
        asked, answered = packets.request.packets, packets.response.packets
        requests = PacketSignature(self.description.bus_bytes).create(path=("requests",))
        responses = ResponseSignature(self.description.bus_bytes).create(path=("responses",))
        inside, goes = Signal(name=f"inside_{topic.port}"), Signal(name=f"goes_{topic.port}")
        m.d.comb += [
            # The tag is kept with the first beat, before anything can be answered.
            goes.eq(inside | tags.w_rdy),
            requests.payload.eq(asked.payload),
            requests.valid.eq(asked.valid & goes),
            asked.ready.eq(requests.ready & goes),
            tags.w_data.eq(packets.request.tag),
            tags.w_en.eq(asked.valid & asked.ready & ~inside),
            answered.payload.eq(responses.packets.payload),
            answered.valid.eq(responses.packets.valid & tags.r_rdy),
            responses.packets.ready.eq(answered.ready & tags.r_rdy),
            packets.response.tag.eq(tags.r_data),
            packets.response.abort.eq(responses.abort),
            tags.r_en.eq(answered.valid & answered.ready & answered.payload.last),
        ]
        with m.If(asked.valid & asked.ready):
            m.d.sync += inside.eq(~asked.payload.last)
        self._deserialize(m, topic, requests, message.request)
        self._serialize(m, topic, responses, message.response)
