"""Ethernet, ARP, IPv4, ICMP, IGMP and UDP in gateware: all between a PHY and datagrams.

One component per protocol, a byte per cycle, no vendor's cells. Knows nothing of messages.
"""

from __future__ import annotations

from firm_hdl.ethernet.datagrams import DatagramSignature, datagram_layout
from firm_hdl.ethernet.edge import DROPS, EthernetEdge, EthernetSettings, drops_layout

__all__ = [
    "DROPS",
    "DatagramSignature",
    "EthernetEdge",
    "EthernetSettings",
    "datagram_layout",
    "drops_layout",
]
