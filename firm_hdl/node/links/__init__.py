"""The links of a node: each has a stream of messages in both directions on its inside."""

from __future__ import annotations

from typing import Any

from firm_hdl.node.description import Description
from firm_hdl.node.links.axi_dma import AxiDmaLink
from firm_hdl.node.links.bytestream import ByteLink, UartLink
from firm_hdl.node.links.ethernet import EthernetLink
from firm_hdl.node.links.rtps import RtpsLink
from firm_hdl.node.links.stream import StreamLink
from firm_hdl.node.links.udp import UdpLink

__all__ = [
    "AxiDmaLink",
    "ByteLink",
    "EthernetLink",
    "RtpsLink",
    "StreamLink",
    "UartLink",
    "UdpLink",
    "link_of",
    "medium_of",
]


def link_of(description: Description) -> Any:
    """Return the link of a description, a component with `received`, `sent` and `counters`."""
    link, bus = description.link, description.bus_bytes
    if link.has_ethernet:
        return EthernetLink(description)
    match link.kind:
        case "stream":
            return StreamLink(bus)
        case "axi_dma":
            return AxiDmaLink(bus, link)
        case "udp":
            return UdpLink(bus, link)
        case "uart":
            return UartLink(bus, link, description.clock_hz)
        case "rtps":
            return RtpsLink(description)
        case _:
            raise ValueError(f"no component for a link of kind '{link.kind}'")


def medium_of(description: Description) -> dict[str, Any]:
    """Return the members of a description's link that face the medium, without making the link."""
    link = description.link
    if link.has_ethernet:
        return EthernetLink.medium(link)
    match link.kind:
        case "stream":
            return StreamLink.medium(description.bus_bytes)
        case "axi_dma":
            return AxiDmaLink.medium(description.bus_bytes)
        case "udp":
            return UdpLink.medium(link)
        case "uart":
            return UartLink.medium()
        case "rtps":
            return RtpsLink.medium()
        case _:
            raise ValueError(f"no component for a link of kind '{link.kind}'")
