"""The graph of ROS 2 through the participant of firm-hdl, without ROS."""

from __future__ import annotations

from collections import Counter
from concurrent.futures import Future
from typing import Any

from firm_hdl.errors import UserError
from firm_hdl.identity import type_hash
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.graph import FutureGraph, GraphError, OnMessage, domain_of
from firm_hdl.node.graphs.mismatch import OwnEndpoint, own_endpoints, qos_of
from firm_hdl.rtps import (
    ClosedError,
    DataReader,
    DataWriter,
    HistoryFullError,
    Sample,
    TransportError,
)
from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.ros import Node, names
from firm_hdl.rtps.wire.guid import Guid, is_keyed

__all__ = ["RtpsGraph"]

_ROOM_SECONDS = 0.1
"""How long a writer that keeps all samples waits for room, as ROS 2 does by default."""


class RtpsGraph(FutureGraph):
    """A node in the graph of ROS 2 by :mod:`firm_hdl.rtps`.

    * `domain`: as of :func:`.domain_of`.
    * `interface`: as of :class:`firm_hdl.rtps.Participant`.
    * `options`: further parameters of the participant.

    Raises `UserError` if the domain is none.
    """

    def __init__(
        self,
        description: Description,
        *,
        domain: int | None = None,
        interface: str | None = None,
        **options: Any,
    ) -> None:
        super().__init__("rtps")
        self._description = description
        self._options = {"domain": domain_of(domain), "interface": interface, **options}
        self._node: Node | None = None
        self._writers: dict[int, DataWriter] = {}
        self._readers: list[DataReader] = []
        self._full: set[int] = set()
        # What was counted before the graph was joined again.
        self._past: Counter[str] = Counter()
        # Endpoints of peers that did not fit, and whose nodes were not known yet.
        self._nameless: set[Guid] = set()
        # Our endpoints by the names of their topics on the wire.
        self._own: dict[str, list[OwnEndpoint]] = {}
        for own in own_endpoints(description):
            self._own.setdefault(own.name, []).append(own)

    def open(self, on_message: OnMessage) -> None:
        self.close()
        description = self._description
        try:
            self._node = Node(description.node, description.namespace, **self._options)
        except TransportError as error:
            raise GraphError(str(error)) from None
        except ValueError as error:
            raise UserError(str(error)) from None
        for topic in description.topics:
            try:
                self._add(self._node, topic, on_message)
            except ValueError as error:
                raise UserError(str(error)) from None

    def _add(self, node: Node, topic: Topic, on_message: OnMessage) -> None:
        if topic.kind == "serve":

            def handle(request: bytes) -> Future[bytes]:
                answer: Future[bytes] = Future()
                on_message(topic, request, answer)
                return answer

            hashes = {direction: type_hash(store.message) for direction, store in topic.stores}
            node.service(
                topic.name,
                topic.type,
                handle,
                request_hash=hashes["in"],
                response_hash=hashes["out"],
            )
            return
        (_, store), qos = topic.stores[0], qos_of(topic)
        options = {"type_hash": type_hash(store.message)}
        if topic.kind == "publish":
            self._writers[topic.id] = node.publisher(topic.name, topic.type, qos, **options)
            return

        def take(sample: Sample) -> None:
            on_message(topic, sample.payload, None)

        self._readers.append(node.subscription(topic.name, topic.type, take, qos, **options))

    def publish(self, topic: Topic, packet: bytes) -> bool:
        writer = self._writers.get(topic.id)
        if writer is None:
            raise GraphError("the participant is closed")
        # A reader that has died takes nothing until its lease ends. Others are not kept waiting.
        patience = 0.0 if topic.id in self._full else _ROOM_SECONDS
        try:
            writer.write(packet, timeout=patience)
        except HistoryFullError:
            self._full.add(topic.id)
            return False
        except ValueError:
            # Such as a packet without an encapsulation header.
            return False
        except ClosedError:
            raise GraphError("the participant is closed") from None
        self._full.discard(topic.id)
        return True

    def check(self) -> None:
        lost = sum(reader.lost for reader in self._readers)
        overwritten = sum(writer.overwritten for writer in self._writers.values())
        self.counters = self._past + Counter({"lost": lost, "overwritten": overwritten})
        if self._node is not None:
            self._tell_mismatches(self._node)

    def _tell_mismatches(self, node: Node) -> None:
        """Name the endpoints of peers that do not fit; their nodes may be known a little later."""
        there = node.context.participant
        wrong = [
            (own, each, writes)
            for writes in (True, False)
            for each in there.remotes(writes)
            for own in self._own.get(each.topic, ())
            if _mismatch("", own, each, writes)
        ]
        if wrong:
            owners = {
                guid: f"{each.namespace.rstrip('/')}/{each.name}"
                for each in node.context.nodes()
                for guid in (*each.readers, *each.writers)
            }
            for own, each, writes in wrong:
                if each.guid in owners or each.guid in self._nameless:
                    self.tell(_mismatch(owners.get(each.guid, ""), own, each, writes) or "")
        self._nameless = {each.guid for _, each, _ in wrong}

    def close(self) -> None:
        self.check()
        self._past = self.counters
        if self._node is not None:
            self._node.close()
        self._node = None
        self._writers, self._readers = {}, []
        self._full.clear()


def _mismatch(node: str, own: OwnEndpoint, each: EndpointData, writes: bool) -> str | None:
    # Types of ROS have no keys, and a type that has one is another.
    key = " with a key" if is_keyed(each.guid.entity) else ""
    found = names.type_hash_of(each.user_data)
    return own.mismatch(node, writes, each.type_name + key, found, each.qos)
