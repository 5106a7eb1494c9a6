"""Rows of the engine's tables: peers, matched endpoints, and requests."""

from __future__ import annotations

from amaranth.lib import data

__all__ = [
    "BUILTIN_ROWS",
    "identity_layout",
    "peer_layout",
    "row_layout",
]

BUILTIN_ROWS = 4
"""Rows of each peer for SEDP: its two writers, then its two readers."""


def peer_layout() -> data.StructLayout:
    """Return a participant: its GUID prefix, its locators, and its lease in seconds."""
    locator = data.StructLayout({"address": 32, "port": 16})
    return data.StructLayout({"prefix": 96, "discovery": locator, "user": locator, "lease": 7})


def row_layout(peers: int, endpoints: int) -> data.StructLayout:
    """Return an endpoint of a peer that is matched with one of ours (8.4.7.5, 8.4.10.4).

    Numbers are the lower half of sequence numbers.

    Members
    -------
    valid : unsigned(1)
    writes : unsigned(1)
        It is a reader, and our endpoint writes to it; else it is a writer, to which ours listens.
    peer : range(peers)
    remote : unsigned(32)
        Its entity identifier, the first byte lowest.
    local : range(endpoints)
        Number of our writer or reader.
    reliable : unsigned(1)
        Whether both sides are.
    next : unsigned(32)
        The lowest number that was not acknowledged, or that we still wait for.
    end : unsigned(32)
        The lowest number that was never sent, or that the writer is not known to have.
    first : unsigned(32)
        The lowest number that is for this reader.
    base, request : unsigned(32)
        Of a reader: the number of the highest bit of `request`, whose bits are samples to send
        again. Of a writer: the lowest number that was never asked for; the highest bit of `request`
        is that of `next`, and bits are samples that need not come.
    synced : unsigned(1)
        Whether the writer has said where its samples begin.
    ask : unsigned(1)
        A HEARTBEAT or an ACKNACK is due.
    timer : unsigned(4)
        Ticks to the next one that nothing else causes.
    tries : unsigned(4)
        How often one was sent since the last progress.
    silent : unsigned(6)
        Of a reader: ticks for which it has lacked a sample, and acknowledged none.
    user : structure of `address` and `port`
        Where it wants to be sent to; port 0 means where its participant says.
    """
    locator = data.StructLayout({"address": 32, "port": 16})
    return data.StructLayout(
        {
            "valid": 1,
            "writes": 1,
            "peer": range(peers),
            "remote": 32,
            "local": range(endpoints),
            "reliable": 1,
            "next": 32,
            "end": 32,
            "first": 32,
            "base": 32,
            "request": 32,
            "synced": 1,
            "ask": 1,
            "timer": 4,
            "tries": 4,
            "silent": 6,
            "user": locator,
        }
    )


def identity_layout(peers: int) -> data.StructLayout:
    """Return the identity of a request (DDS-RPC 7.6.2).

    `tag` is what the topic knows it by, `peer` its sender, and `guid` and `number` are what the
    reply has to name.
    """
    return data.StructLayout({"tag": 32, "peer": range(peers), "guid": 128, "number": 32})
