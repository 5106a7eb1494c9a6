"""The header of Ethernet: whom a frame is for, and what it carries (IEEE 802.3, 3.2.3 to 3.2.6)."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.streams import FrameSignature, compare

__all__ = ["ARP", "BROADCAST", "IPV4", "HeaderReceiver"]

IPV4, ARP = 0x0800, 0x0806
"""Types of Ethernet (RFC 894, RFC 826)."""

BROADCAST = (1 << 48) - 1
_MULTICAST = 0x01005E
"""First bytes of the addresses of IPv4 groups (RFC 1112, 6.4)."""

_HEADER_BYTES = 14


class HeaderReceiver(wiring.Component):
    """Strip the header of frames, and drop those for others and of other protocols.

    A frame is for this node if its destination is the node's address, broadcast, or that of an IPv4
    group; which group, IPv4 tells. Frames with VLAN tags are of another protocol.

    A byte per cycle; latency 1 cycle. Outputs are registers.

    Parameters
    ----------
    mac : int
        The node's address, 48 bits.

    Members
    -------
    frames : In(FrameSignature())
    ipv4, arp : Out(FrameSignature())
        Payloads, without padding removed. Of a dropped frame, nothing comes.
    is_arp : Out(1)
    to_node, to_group, to_all : Out(1)
        The kind of destination. Like `is_arp`, they keep their values with all bytes of a payload.
    other : Out(1)
        A good frame was dropped.
    """

    def __init__(self, mac: int):
        self.mac = mac
        super().__init__(
            {
                "frames": In(FrameSignature()),
                "ipv4": Out(FrameSignature()),
                "arp": Out(FrameSignature()),
                "is_arp": Out(1),
                "to_node": Out(1),
                "to_group": Out(1),
                "to_all": Out(1),
                "other": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came = self.frames
        place = Signal(range(_HEADER_BYTES + 1))
        inside, ours, is_ipv4 = Signal(), Signal(), Signal()
        m.d.comb += [
            inside.eq(place == _HEADER_BYTES),
            ours.eq(inside & (self.to_node | self.to_group | self.to_all)),
        ]
        for out, is_kind in ((self.ipv4, is_ipv4), (self.arp, self.is_arp)):
            m.d.sync += [out.valid.eq(came.valid & ours & is_kind), out.payload.eq(came.payload)]
        is_known = ours & (is_ipv4 | self.is_arp)
        m.d.sync += self.other.eq(came.valid & came.payload.end & came.payload.good & ~is_known)
        with m.If(came.valid & came.payload.end):
            m.d.sync += place.eq(0)
        with m.Elif(came.valid):
            m.d.sync += place.eq(Mux(inside, place, place + 1))
            byte = came.payload.data
            compare(m, self.to_node, byte, place, 0, self.mac, 6)
            compare(m, self.to_all, byte, place, 0, BROADCAST, 6)
            compare(m, self.to_group, byte, place, 0, _MULTICAST, 3)
            compare(m, is_ipv4, byte, place, 12, IPV4, 2)
            compare(m, self.is_arp, byte, place, 12, ARP, 2)
        return m
