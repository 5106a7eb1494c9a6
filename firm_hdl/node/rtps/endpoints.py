"""The endpoints of a node with a participant of its own, and what they announce."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.frontend import DISTROS
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.mismatch import own_endpoints, qos_of
from firm_hdl.rtps import Qos
from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.ros import graph, names
from firm_hdl.rtps.wire.guid import PARTICIPANT, Guid, user_reader, user_writer
from firm_hdl.rtps.wire.locators import Address, Ports

__all__ = ["LEASE_SECONDS", "Endpoint", "Own", "own_of", "ports_of_link"]

LEASE_SECONDS = 20.0
"""Seconds after which peers take a node for gone that is silent."""

_SUFFIXES = {True: "_Response", False: "_Request"}
_ENCLAVE = "/"
# As participants of the host have it for services.
_SERVICE_QOS = Qos(depth=256)


@dataclass(frozen=True, slots=True, kw_only=True)
class Endpoint:
    """A writer or a reader of the node."""

    data: EndpointData  # What it announces.
    topic: Topic | None  # `None` for the writer of the graph of ROS 2.

    @property
    def is_service(self) -> bool:
        """Whether it belongs to a service."""
        return self.topic is not None and self.topic.kind == "serve"


@dataclass(frozen=True, slots=True, kw_only=True)
class Own:
    """What a node announces."""

    participant: ParticipantData
    # The first writer is that of the graph; the others are in the order of topics.
    writers: tuple[Endpoint, ...]
    readers: tuple[Endpoint, ...]
    graph: bytes  # The sample of the graph: the name of the node, and its endpoints.


def ports_of_link(description: Description) -> Ports:
    """Return the UDP ports of a node with a link of kind `rtps`."""
    return Ports.of(description.link.domain, description.link.participant)


def own_of(description: Description, prefix: bytes) -> Own:
    """Return what a node announces if it has the GUID prefix `prefix`."""
    link, ports = description.link, ports_of_link(description)
    data = graph_writer(description, prefix)
    endpoints = [Endpoint(data=data, topic=None), *_endpoints(description, prefix)]
    writers = tuple(each for each in endpoints if each.data.guid.entity & 0x3F == 3)
    readers = tuple(each for each in endpoints if each.data.guid.entity & 0x3F == 4)
    node = graph.NodeInfo(
        name=description.node,
        namespace=description.namespace,
        readers=tuple(each.data.guid for each in readers),
        writers=tuple(each.data.guid for each in writers[1:]),
    )
    info = graph.GraphInfo(participant=Guid(prefix, PARTICIPANT), nodes=(node,))
    # Releases before Iron have longer GIDs, and no events of services.
    size = graph.GID_BYTES[not DISTROS[description.distro].has_events]
    return Own(
        participant=ParticipantData(
            prefix=prefix,
            discovery=(Address(link.ip, ports.discovery),),
            user=(Address(link.ip, ports.user),),
            lease=LEASE_SECONDS,
            user_data=names.enclave(_ENCLAVE),
            name=_ENCLAVE,
            domain=link.domain,
        ),
        writers=writers,
        readers=readers,
        graph=info.encode(size),
    )


def graph_writer(description: Description, prefix: bytes) -> EndpointData:
    """Return the writer of the graph, whose key follows those of the topics."""
    return EndpointData(
        guid=Guid(prefix, user_writer(1 + len(description.topics))),
        topic=graph.TOPIC,
        type_name=graph.TYPE,
        qos=graph.QOS,
        user_data=names.user_data(graph.TYPE_HASH),
    )


def _endpoints(description: Description, prefix: bytes) -> Iterator[Endpoint]:
    """Yield the endpoints of topics. The key of an endpoint is the id of its topic."""
    for own in own_endpoints(description):
        topic, is_service = own.topic, own.topic.kind == "serve"
        entity = (user_writer if own.writes else user_reader)(topic.id)
        data = EndpointData(
            guid=Guid(prefix, entity),
            topic=own.name,
            type_name=names.type_name(topic.type, _SUFFIXES[own.writes] if is_service else ""),
            qos=_SERVICE_QOS if is_service else qos_of(topic),
            user_data=names.user_data(own.type_hash),
        )
        yield Endpoint(data=data, topic=topic)
