"""The graph of ROS 2: which nodes a participant has, and which endpoints are theirs.

Each participant writes a sample of ``rmw_dds_common/msg/ParticipantEntitiesInfo`` to a
transient-local topic whenever its nodes change. `ros2 node list` reads these samples.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from firm_hdl.rtps.qos import Durability, Qos
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.octets import Cursor, MalformedError

__all__ = ["QOS", "TOPIC", "TYPE", "GraphInfo", "NodeInfo"]

TOPIC = "ros_discovery_info"
"""The topic, which has no prefix."""

TYPE = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"
"""Its type on the wire."""

QOS = Qos(durability=Durability.TRANSIENT_LOCAL, depth=1)
"""Policies of its writers and readers."""

_MAX_ENTRIES = 4096
# Releases before Iron have 24, of which the last 8 are 0.
GID_BYTES = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeInfo:
    """A node and its endpoints.

    Attributes
    ----------
    name, namespace : str
        Such as ``talker`` and ``/``.
    readers, writers : tuple of Guid
        The endpoints, those of services included.
    """

    name: str
    namespace: str
    readers: tuple[Guid, ...] = ()
    writers: tuple[Guid, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphInfo:
    """The nodes of a participant."""

    participant: Guid
    nodes: tuple[NodeInfo, ...]

    def encode(self) -> bytes:
        """Return the sample, as CDR, little-endian."""
        body = bytearray(bytes(self.participant))
        body += struct.pack("<I", len(self.nodes))
        for node in self.nodes:
            for text in (node.namespace, node.name):
                data = text.encode() + b"\0"
                body += bytes(-len(body) % 4) + struct.pack("<I", len(data)) + data
            for guids in (node.readers, node.writers):
                body += bytes(-len(body) % 4) + struct.pack("<I", len(guids))
                body += b"".join(map(bytes, guids))
        return b"\x00\x01\x00\x00" + bytes(body) + bytes(-len(body) % 4)

    @classmethod
    def decode(cls, payload: bytes) -> GraphInfo:
        """Read a sample, of either byte order.

        Raises
        ------
        MalformedError
            It is no CDR of this type.
        """
        if payload[:2] not in (b"\x00\x00", b"\x00\x01"):
            raise MalformedError(f"encapsulation {payload[:2].hex()}")
        cursor = Cursor(payload[4:], payload[1] == 1)
        participant = Guid.parse(cursor.take(GID_BYTES))
        nodes = []
        for _ in range(_count(cursor)):
            texts = []
            for _ in range(2):
                cursor.align(4)
                texts.append(cursor.string())
            readers, writers = _guids(cursor), _guids(cursor)
            nodes.append(
                NodeInfo(namespace=texts[0], name=texts[1], readers=readers, writers=writers)
            )
        return cls(participant=participant, nodes=tuple(nodes))


def _guids(cursor: Cursor) -> tuple[Guid, ...]:
    cursor.align(4)
    return tuple(Guid.parse(cursor.take(GID_BYTES)) for _ in range(_count(cursor)))


def _count(cursor: Cursor) -> int:
    count = cursor.u32()
    if count > _MAX_ENTRIES:
        raise MalformedError(f"{count} entries, where {_MAX_ENTRIES} may be")
    return count
