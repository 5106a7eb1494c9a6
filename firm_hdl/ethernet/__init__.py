"""Ethernet, ARP, IPv4, ICMP, IGMP and UDP in gateware: all between a PHY and datagrams.

One component per protocol, a byte per cycle; a vendor's cells only in an RGMII. Knows nothing of
messages. The whole is :class:`firm_hdl.ethernet.edge.EthernetEdge`.
"""

from __future__ import annotations

__all__ = ["arp", "datagrams", "drops", "edge", "fragments", "mac", "phy", "sender", "udp"]
