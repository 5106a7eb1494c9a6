"""What the reader of datagrams tells the engine: one event per submessage that it may act on."""

from __future__ import annotations

from amaranth.lib import data, enum

__all__ = ["EventKind", "announced_layout", "event_layout", "raw"]

_PREFIX, _ENTITY, _NUMBER = 96, 32, 32


class EventKind(enum.Enum, shape=4):  # type: ignore[call-arg]
    """What came.

    Members
    -------
    SOURCE
        The header of a datagram. The answer tells whether the sender is known.
    PARTICIPANT, PARTICIPANT_GONE
        An announcement of SPDP.
    ENDPOINT, ENDPOINT_GONE
        A sample of a writer of SEDP.
    SAMPLE
        DATA of another writer, before its payload. The answer tells whether the payload is wanted.
    FRAGMENT
        DATA_FRAG of any writer. The answer tells whether the fragments are wanted. If they complete
        a sample, `SAMPLE` follows.
    HEARTBEAT, ACKNACK, GAP, NACK_FRAG
        The submessages of these names.
    """

    SOURCE = 0
    PARTICIPANT = 1
    PARTICIPANT_GONE = 2
    ENDPOINT = 3
    ENDPOINT_GONE = 4
    SAMPLE = 5
    FRAGMENT = 6
    HEARTBEAT = 7
    ACKNACK = 8
    GAP = 9
    NACK_FRAG = 10


def event_layout() -> data.StructLayout:
    """Return an event. GUID prefixes and entity identifiers have their first byte lowest.

    Members
    -------
    kind : EventKind
    source : unsigned(96)
        GUID prefix of the sender.
    reader, writer : unsigned(32)
        Entity identifiers.
    number : unsigned(32)
        Sequence number of a sample; the first one of HEARTBEAT and GAP; the base of ACKNACK.
    last : unsigned(32)
        The last number of HEARTBEAT; the base of GAP and of NACK_FRAG; bytes of the sample of a
        DATA_FRAG.
    bits : unsigned(32)
        The first 32 bits of the set of ACKNACK, GAP or NACK_FRAG; the highest is that of the base.
        Number of the first fragment of a DATA_FRAG.
    fragments, fragment_bytes : unsigned(16)
        How many fragments a DATA_FRAG has, and their size.
    is_final, is_gone : unsigned(1)
        Flag of HEARTBEAT and ACKNACK; whether a sample is none, but the end of an instance.
    related, has_related : unsigned(128), unsigned(1)
        GUID of the related sample identity (DDS-RPC 7.6.2).
    entity : unsigned(32)
        The endpoint that is gone.
    """
    return data.StructLayout(
        {
            "kind": EventKind,
            "source": _PREFIX,
            "reader": _ENTITY,
            "writer": _ENTITY,
            "number": _NUMBER,
            "last": _NUMBER,
            "bits": 32,
            "fragments": 16,
            "fragment_bytes": 16,
            "is_final": 1,
            "is_gone": 1,
            "related": 128,
            "has_related": 1,
            "entity": _ENTITY,
        }
    )


def announced_layout() -> data.StructLayout:
    """Return what an announcement says.

    Members
    -------
    is_participant, is_endpoint : unsigned(1)
        Whether it is one that can be used.
    discovery, user : structures of `address` and `port`
        Locators of the participant; `user` that of the endpoint. A port 0 means none.
    lease : unsigned(7)
        Lease of the participant, from 1 to 100 seconds.
    entity : unsigned(32)
        The endpoint.
    topic, type : unsigned(32)
        CRC-32 of its names.
    is_reliable, durability : unsigned(1), unsigned(2)
        Its policies.
    """
    locator = data.StructLayout({"address": 32, "port": 16})
    return data.StructLayout(
        {
            "is_participant": 1,
            "is_endpoint": 1,
            "discovery": locator,
            "user": locator,
            "lease": 7,
            "entity": _ENTITY,
            "topic": 32,
            "type": 32,
            "is_reliable": 1,
            "durability": 2,
        }
    )


def raw(entity: int) -> int:
    """Return an entity identifier with its first byte in the lowest bits."""
    return int.from_bytes(entity.to_bytes(4, "big"), "little")
