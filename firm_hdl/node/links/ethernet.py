"""The link over UDP with an Ethernet of its own: from the pins of a PHY to messages."""

from __future__ import annotations

from ipaddress import IPv4Address, IPv4Interface
from typing import Any

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.edge import EthernetEdge, EthernetSettings
from firm_hdl.ethernet.phy import PHYS, GmiiSignature, MiiSignature, RgmiiSignature
from firm_hdl.gateware.packets.counters import add_counters
from firm_hdl.node.control import ethernet_counter
from firm_hdl.node.description import Link
from firm_hdl.node.gateware.streams import LinkSignature, link_counters_layout, passes
from firm_hdl.node.links.udp import UdpLink

__all__ = ["EthernetLink"]

_PINS = {"gmii": GmiiSignature, "rgmii": RgmiiSignature, "mii": MiiSignature}


class EthernetLink(wiring.Component):
    """A :class:`firm_hdl.node.links.UdpLink` on top of an edge to Ethernet.

    Two clock domains or three: `sync`, and those of the PHY, whose clocks are pins. The reset of
    `sync` is enough.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat of the messages: 1, 2, 4, 8 or 16.
    link : Link
        With `ethernet`.

    Members
    -------
    received : Out(LinkSignature(bus_bytes))
    sent : In(LinkSignature(bus_bytes))
    counters : Out(link_counters_layout(link))
    gmii, rgmii or mii : Out(the signature of the pins)
    """

    def __init__(self, bus_bytes: int, link: Link):
        self.bus_bytes, self.link = bus_bytes, link
        super().__init__(
            {
                "received": Out(LinkSignature(bus_bytes)),
                "sent": In(LinkSignature(bus_bytes)),
                "counters": Out(link_counters_layout(link)),
                **self.medium(link),
            }
        )

    @staticmethod
    def medium(link: Link) -> dict[str, Any]:
        """Return the members that face the medium."""
        return {link.ethernet: Out(_PINS[link.ethernet]())}

    def elaborate(self, platform: object) -> Module:
        m = Module()
        link = self.link
        own = IPv4Interface(link.address)
        m.submodules.phy = phy = PHYS[link.ethernet]()
        m.submodules.network = network = EthernetEdge(
            EthernetSettings(
                mac=int(link.mac.replace(":", ""), 16),
                address=int(own.ip),
                prefix_bits=own.network.prefixlen,
                gateway=int(IPv4Address(link.gateway)) if link.gateway else 0,
                ports=(link.port,),
            )
        )
        m.submodules.udp = udp = UdpLink(self.bus_bytes, link)
        wiring.connect(m, phy.pins, wiring.flipped(getattr(self, link.ethernet)))
        wiring.connect(m, phy.received, network.symbols_in)
        wiring.connect(m, network.symbols_out, phy.sent)
        wiring.connect(m, network.received, udp.datagrams_in)
        wiring.connect(m, udp.datagrams_out, network.sent)
        m.d.comb += [*passes(udp.received, self.received), *passes(self.sent, udp.sent)]
        for name in udp.counters.shape().members:
            m.d.comb += self.counters[name].eq(udp.counters[name])
        names = network.drops.shape().members
        add_counters(
            m, self.counters, {ethernet_counter(name): network.drops[name] for name in names}
        )
        return m
