"""Why the edge drops something. A host can read this without Amaranth."""

from __future__ import annotations

__all__ = ["DROPS"]

DROPS = {
    "damaged": "frames with a wrong check sequence, without start, or with an error of the PHY",
    "runt": "frames of fewer than 64 bytes",
    "giant": "frames of more than 1518 bytes",
    "other": "good frames for others, of other protocols, or empty",
    "malformed": "datagrams with a wrong header of IPv4",
    "checksum": "messages of UDP, ICMP and IGMP with a wrong checksum or length",
    "port": "datagrams for ports that the node does not have",
    "fragment": "fragments and unfinished datagrams that could not be put together",
    "full": "datagrams and requests without room in memory",
    "unresolved": "datagrams whose destination did not answer ARP",
    "unfit": "datagrams to send that are too large, or have another length than stated",
}
"""Why the edge drops something; `unresolved` and `unfit` are of the way out."""
