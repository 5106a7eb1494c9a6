"""A participant with nodes of ROS 2, and the nodes of its peers."""

from __future__ import annotations

import threading
from contextlib import suppress
from dataclasses import replace
from typing import Any

from firm_hdl.rtps.endpoints import ClosedError
from firm_hdl.rtps.events import Event, PeerLost, Sample
from firm_hdl.rtps.participant import OnEvent, Participant
from firm_hdl.rtps.ros import graph, names
from firm_hdl.rtps.ros.graph import GraphInfo, NodeInfo
from firm_hdl.rtps.wire.guid import PARTICIPANT, Guid
from firm_hdl.rtps.wire.octets import MalformedError

__all__ = ["Context"]


class Context:
    """A participant that several nodes can share. It is also a context manager, which closes it.

    Parameters
    ----------
    domain : int
        The domain (``ROS_DOMAIN_ID``), from 0 to 232.
    enclave : str
        The enclave of its nodes.
    gid_bytes : int
        16, or 24 for peers of releases before Iron, which otherwise do not see the nodes by name.
    on_event : callable or None
        As of :class:`firm_hdl.rtps.participant.Participant`.
    options
        Further parameters of the participant, such as `interface`.
    """

    def __init__(
        self,
        domain: int = 0,
        enclave: str = "/",
        gid_bytes: int = graph.GID_BYTES[0],
        on_event: OnEvent | None = None,
        **options: Any,
    ):
        if gid_bytes not in graph.GID_BYTES:
            raise ValueError(f"A GID has 16 or 24 bytes, not {gid_bytes}")
        self._gid_bytes = gid_bytes
        # The order of locks is `_publishing`, the participant's, `_lock`.
        self._publishing = threading.Lock()
        self._lock = threading.Lock()
        self._own: dict[tuple[str, str], NodeInfo] = {}
        self._others: dict[bytes, GraphInfo] = {}
        self._on_event = on_event
        self.participant = Participant(
            domain, name=enclave, user_data=names.enclave(enclave), on_event=self._event, **options
        )
        data = names.user_data(graph.TYPE_HASH)
        self._writer = self.participant.writer(graph.TOPIC, graph.TYPE, graph.QOS, user_data=data)
        self._reader = self.participant.reader(
            graph.TOPIC,
            graph.TYPE,
            self._on_graph,
            replace(graph.QOS, depth=0),
            user_data=data,
            most_bytes=graph.MOST_BYTES,
        )
        self._publish()

    def __enter__(self) -> Context:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def update(self, node: NodeInfo) -> None:
        """Tell peers which endpoints a node has."""
        with self._lock:
            self._own[node.namespace, node.name] = node
        self._publish()

    def has(self, name: str, namespace: str) -> bool:
        """Whether there is a node of this name here."""
        with self._lock:
            return (namespace, name) in self._own

    def remove(self, name: str, namespace: str) -> None:
        """Tell peers that a node is gone."""
        with self._lock:
            self._own.pop((namespace, name), None)
        self._publish()

    def nodes(self) -> tuple[NodeInfo, ...]:
        """Return the nodes of this participant and of all peers."""
        with self._lock:
            others = [node for info in self._others.values() for node in info.nodes]
            return (*self._own.values(), *others)

    def topics(self) -> dict[str, set[str]]:
        """Return the topics of all peers: full names, with the names of their types."""
        found: dict[str, set[str]] = {}
        for writers in (True, False):
            for endpoint in self.participant.remotes(writers):
                name = names.demangled_topic(endpoint.topic)
                type_name = names.demangled_type(endpoint.type_name)
                if name is not None and type_name is not None:
                    found.setdefault(name, set()).add(type_name)
        return found

    def type_hashes(self, topic: str) -> set[str]:
        """Return the type hashes that peers announce for a topic with its full name."""
        return {
            found
            for writers in (True, False)
            for endpoint in self.participant.remotes(writers)
            if endpoint.topic == names.topic(topic)
            and (found := names.type_hash_of(endpoint.user_data)) is not None
        }

    def wait_for_node(self, name: str, timeout: float = 10.0) -> bool:
        """Wait until there is a node of this name, at most `timeout` seconds."""
        return self.participant.wait_until(
            lambda: any(node.name == name for node in self.nodes()), timeout
        )

    def close(self) -> None:
        """Leave the domain."""
        self.participant.close()

    def _publish(self) -> None:
        guid = Guid(self.participant.prefix, PARTICIPANT)
        with self._publishing, suppress(ClosedError):
            with self._lock:
                nodes = tuple(self._own.values())
            self._writer.write(GraphInfo(participant=guid, nodes=nodes).encode(self._gid_bytes))

    def _on_graph(self, sample: Sample) -> None:
        if sample.writer.prefix == self.participant.prefix:
            return
        try:
            info = GraphInfo.decode(sample.payload)
        except MalformedError:
            self.participant.count("malformed")
            return
        with self._lock:
            self._others[sample.writer.prefix] = info

    def _event(self, event: Event) -> None:
        if isinstance(event, PeerLost):
            with self._lock:
                self._others.pop(event.peer.prefix, None)
        if self._on_event is not None:
            self._on_event(event)
