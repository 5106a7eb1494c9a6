"""The graph of ROS 2: which nodes a participant has, and which endpoints are theirs.

Each participant writes a sample of ``rmw_dds_common/msg/ParticipantEntitiesInfo`` to a
transient-local topic whenever its nodes change. `ros2 node list` reads these samples.
"""

from __future__ import annotations

import struct
from contextlib import suppress
from dataclasses import dataclass

from firm_hdl.rtps.qos import Durability, Qos
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.octets import Cursor, MalformedError

__all__ = [
    "GID_BYTES",
    "MOST_BYTES",
    "QOS",
    "TOPIC",
    "TYPE",
    "TYPE_HASH",
    "GraphInfo",
    "NodeInfo",
]

TOPIC = "ros_discovery_info"
"""The topic, which has no prefix."""

TYPE = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"
"""Its type on the wire."""

TYPE_HASH = "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"
"""Its type hash since Iron; before, there was none."""

MOST_BYTES = 1 << 16
"""The largest sample of a peer: nodes with 4,000 endpoints."""

QOS = Qos(durability=Durability.TRANSIENT_LOCAL, depth=1)
"""Policies of its writers and readers."""

_MAX_ENTRIES = 4096

GID_BYTES = (16, 24)
"""Sizes of a GID: since Iron, and before, with zeros behind the GUID."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeInfo:
    """A node and its endpoints."""

    # Such as `talker` and `/`.
    name: str
    namespace: str
    # The endpoints, those of services included.
    readers: tuple[Guid, ...] = ()
    writers: tuple[Guid, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphInfo:
    """The nodes of a participant."""

    participant: Guid
    nodes: tuple[NodeInfo, ...]

    def encode(self, gid_bytes: int = GID_BYTES[0]) -> bytes:
        """Return the sample, as CDR, little-endian, with GIDs of a size."""
        body = bytearray(bytes(self.participant).ljust(gid_bytes, b"\0"))
        body += struct.pack("<I", len(self.nodes))
        for node in self.nodes:
            for text in (node.namespace, node.name):
                data = text.encode() + b"\0"
                body += bytes(-len(body) % 4) + struct.pack("<I", len(data)) + data
            for guids in (node.readers, node.writers):
                body += bytes(-len(body) % 4) + struct.pack("<I", len(guids))
                body += b"".join(bytes(each).ljust(gid_bytes, b"\0") for each in guids)
        return b"\x00\x01\x00\x00" + bytes(body) + bytes(-len(body) % 4)

    @classmethod
    def decode(cls, payload: bytes) -> GraphInfo:
        """Read a sample of either byte order, with GIDs of either size.

        Raises
        ------
        MalformedError
            It is no CDR of this type.
        """
        if payload[:2] not in (b"\x00\x00", b"\x00\x01"):
            raise MalformedError(f"encapsulation {payload[:2].hex()}")
        for gid_bytes in GID_BYTES:
            cursor = Cursor(payload[4:], payload[1] == 1)
            with suppress(MalformedError):
                participant = Guid.parse(cursor.take(gid_bytes))
                nodes = tuple(_node(cursor, gid_bytes) for _ in range(_count(cursor)))
                # What is left of the right size is padding.
                if cursor.left < 4:
                    return cls(participant=participant, nodes=nodes)
        raise MalformedError(f"no graph in {len(payload)} bytes")


def _node(cursor: Cursor, gid_bytes: int) -> NodeInfo:
    namespace, name = _string(cursor), _string(cursor)
    readers, writers = _guids(cursor, gid_bytes), _guids(cursor, gid_bytes)
    return NodeInfo(namespace=namespace, name=name, readers=readers, writers=writers)


def _string(cursor: Cursor) -> str:
    cursor.align(4)
    return cursor.string()


def _guids(cursor: Cursor, gid_bytes: int) -> tuple[Guid, ...]:
    cursor.align(4)
    return tuple(Guid.parse(cursor.take(gid_bytes)) for _ in range(_count(cursor)))


def _count(cursor: Cursor) -> int:
    count = cursor.u32()
    if count > _MAX_ENTRIES:
        raise MalformedError(f"{count} entries, where {_MAX_ENTRIES} may be")
    return count
