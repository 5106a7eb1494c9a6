"""Links over UDP with an Ethernet of their own: from the pins of a PHY to messages."""

from __future__ import annotations

from ipaddress import IPv4Address, IPv4Interface
from typing import Any

from amaranth.hdl import ClockDomain, DomainRenamer, Module, ResetSignal, Signal, Value
from amaranth.lib import memory, wiring
from amaranth.lib.cdc import PulseSynchronizer, ResetSynchronizer
from amaranth.lib.fifo import AsyncFIFO
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.datagrams import datagram_layout
from firm_hdl.ethernet.edge import EthernetEdge, EthernetSettings
from firm_hdl.ethernet.phy import PHYS
from firm_hdl.gateware.packets.counters import add_counters
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.node.control import ethernet_counter
from firm_hdl.node.description import Description, Link
from firm_hdl.node.gateware.streams import link_members, passes
from firm_hdl.node.links.rtps import RtpsLink, idle_bits
from firm_hdl.node.links.udp import UdpLink
from firm_hdl.node.rtps.endpoints import ports_of_link
from firm_hdl.rtps.wire.locators import MULTICAST_GROUP

__all__ = ["EthernetLink"]

_ONE_FRAME_BYTES = 2048
"""Memory of a topic whose messages are meant to fit into a frame."""

_GIGABIT_HZ = 125e6

_APART = "ethernet"
"""The clock domain of an edge whose clock is not that of the node."""

_WORD_BYTES = 4
"""What a participant takes and sends per cycle."""

_AHEAD_BYTES, _PAUSE_BYTES = 180, 20
"""Bytes that a participant with the clock of the edge sends from the beginning of a frame until the
checksum of its datagram is due, and those that it would send while it reads the payload."""

_WORDS = 16
"""Words between two clock domains: enough for a word per cycle."""


class EthernetLink(wiring.Component):
    """A :class:`.UdpLink` or a :class:`.RtpsLink` on top of an edge to Ethernet.

    The edge takes a byte per cycle, at 1 Gbit/s with 125 MHz. A node with another clock has its
    edge in the domain of what the PHY receives; datagrams cross between the two. What comes faster
    than the node reads waits in the edge, as far as there is room.

    The other clock domains are those of the PHY, whose clocks are pins. The reset of `sync` is
    enough.

    Parameters
    ----------
    description : Description
        Its link has an `ethernet`.

    Members
    -------
    received : Out(LinkSignature(bus_bytes))
    sent : In(LinkSignature(bus_bytes))
    counters : Out(link_counters_layout(link))
    gmii, rgmii or mii : Out(the signature of the pins)
    nonce, idle : In
        Those of an :class:`.RtpsLink`.
    """

    def __init__(self, description: Description):
        self.description = description
        bus, link = description.bus_bytes, description.link
        super().__init__(
            {
                **link_members(bus, link),
                **self.medium(link),
                **({"idle": In(idle_bits(description))} if link.kind == "rtps" else {}),
            }
        )

    @staticmethod
    def medium(link: Link) -> dict[str, Any]:
        """Return the members that face the medium."""
        nonce = {"nonce": In(32)} if link.kind == "rtps" else {}
        return {link.ethernet: Out(PHYS[link.ethernet].pin_signature()), **nonce}

    def elaborate(self, platform: object) -> Module:
        m = Module()
        link = self.description.link
        own = IPv4Interface(link.address)
        is_apart = link.ethernet != "mii" and self.description.clock_hz != _GIGABIT_HZ
        # A participant stores datagrams by itself, if it takes them as fast as they come.
        fragment_bytes, stores = _fragment_bytes(self.description), True
        word_bytes, ahead_bytes = 1, 0
        if link.kind == "rtps":
            word_bytes = _WORD_BYTES
            rate = self.description.clock_hz / _GIGABIT_HZ if is_apart else 1.0
            # Clocks of two crystals differ a little: a participant that is only just fast enough
            # counts as too slow.
            stores = rate * _WORD_BYTES < 1.02
            ahead_bytes = max(0, round(_AHEAD_BYTES * min(1.0, rate)) - _PAUSE_BYTES)
        is_split = not stores and fragment_bytes > 0
        upper: UdpLink | RtpsLink
        ports: tuple[int, ...] = (link.port,)
        groups: tuple[int, ...] = ()
        if link.kind == "rtps":
            ports = tuple(ports_of_link(self.description))
            groups = (int(IPv4Address(MULTICAST_GROUP)),)
            m.submodules.rtps = upper = RtpsLink(
                self.description, has_joined=is_split, word_bytes=_WORD_BYTES
            )
            m.d.comb += [upper.nonce.eq(self.nonce), upper.idle.eq(self.idle)]
        else:
            m.submodules.udp = upper = UdpLink(self.description.bus_bytes, link)
        phy = PHYS[link.ethernet]()
        network = EthernetEdge(
            EthernetSettings(
                mac=int(link.mac.replace(":", ""), 16),
                address=int(own.ip),
                prefix_bits=own.network.prefixlen,
                gateway=int(IPv4Address(link.gateway)) if link.gateway else 0,
                ports=ports,
                groups=groups,
                memory_bytes=(1 << 14 if is_apart else 1 << 12) if stores else 0,
                fragment_bytes=fragment_bytes,
                word_bytes=word_bytes,
                ahead_bytes=ahead_bytes,
            )
        )
        wiring.connect(m, phy.pins, wiring.flipped(getattr(self, link.ethernet)))
        wiring.connect(m, phy.received, network.symbols_in)
        wiring.connect(m, network.symbols_out, phy.sent)
        drops: Any = network.drops
        if is_apart:
            drops = self._cross(m, phy, network, upper)
        else:
            m.submodules.phy, m.submodules.network = phy, network
            wiring.connect(m, network.received, upper.datagrams_in)
            wiring.connect(m, upper.datagrams_out, network.sent)
            if is_split:
                wiring.connect(m, network.joined, upper.joined_in)
        m.d.comb += [*passes(upper.received, self.received), *passes(self.sent, upper.sent)]
        for name in upper.counters.shape().members:
            m.d.comb += self.counters[name].eq(upper.counters[name])
        names = network.drops.shape().members
        add_counters(m, self.counters, {ethernet_counter(name): drops[name] for name in names})
        return m

    def _cross(self, m: Module, phy: Any, network: EthernetEdge, upper: Any) -> dict[str, Signal]:
        """Put PHY and edge into a domain of their own; return the edge's strobes in `sync`."""
        domain = ClockDomain(_APART, local=True)
        domain.clk = getattr(phy.pins, phy.received_clock)
        m.domains += domain
        # A stage more than a FIFO has: else Yosys makes one register of both, and the positions of
        # the FIFO wait for that of all resets, far away.
        m.submodules.reset = ResetSynchronizer(ResetSignal(), domain=_APART, stages=3)
        m.submodules.phy = DomainRenamer(_APART)(phy)
        m.submodules.network = DomainRenamer(_APART)(network)
        # Without registers between, it is too long a way from the edge into a FIFO.
        before = StreamSlice(datagram_layout(network.settings.word_bytes))
        m.submodules.before = DomainRenamer(_APART)(before)
        wiring.connect(m, network.received, before.i)
        ways = [("to_node", before.o, upper.datagrams_in)]
        if network.settings.is_split:
            ways.append(("joined_to_node", network.joined, upper.joined_in))
        for name, source, target in ways:
            m.submodules[name] = fifo = AsyncFIFO(
                width=len(Value.cast(source.payload)),
                depth=_WORDS,
                w_domain=_APART,
                r_domain="sync",
            )
            m.d.comb += [
                fifo.w_data.eq(source.payload),
                fifo.w_en.eq(source.valid),
                source.ready.eq(fifo.w_rdy),
                Value.cast(target.payload).eq(fifo.r_data),
                target.valid.eq(fifo.r_rdy),
                fifo.r_en.eq(target.ready),
            ]
        self._cross_to_edge(m, upper.datagrams_out, network.sent)
        drops = {}
        for name in network.drops.shape().members:
            # At most one per frame, so a strobe has passed before the next one.
            m.submodules[f"drop_{name}"] = strobe = PulseSynchronizer(_APART, "sync")
            m.d.comb += strobe.i.eq(network.drops[name])
            drops[name] = strobe.o
        return drops

    def _cross_to_edge(self, m: Module, source: Any, target: Any) -> None:
        """Carry datagrams into the domain of the edge.

        The FIFO has the places of words in a memory, so that the address of what is read is a
        register: from the positions of a FIFO through a wide memory it is too long a way.
        """
        m.submodules.to_edge = fifo = AsyncFIFO(
            width=range(_WORDS)[-1].bit_length(), depth=_WORDS, w_domain="sync", r_domain=_APART
        )
        m.submodules.to_edge_words = words = memory.Memory(
            shape=source.payload.shape(), depth=_WORDS, init=[]
        )
        write, read = words.write_port(), words.read_port(domain=_APART)
        moves = Signal()
        m.d.comb += [
            fifo.w_en.eq(source.valid),
            fifo.w_data.eq(write.addr),
            write.en.eq(source.valid & fifo.w_rdy),
            write.data.eq(source.payload),
            source.ready.eq(fifo.w_rdy),
            moves.eq(~target.valid | target.ready),
            fifo.r_en.eq(moves),
            read.addr.eq(fifo.r_data),
            read.en.eq(moves),
            target.payload.eq(read.data),
        ]
        with m.If(write.en):
            m.d.sync += write.addr.eq(write.addr + 1)
        with m.If(moves):
            m.d[_APART] += target.valid.eq(fifo.r_rdy)


def _fragment_bytes(description: Description) -> int:
    """Return the memory for datagrams in fragments of IPv4; 0 if the node needs none.

    The host of a link `udp` sends none. Peers of ROS 2 send a sample of up to 65 kB as one
    datagram, which their system cuts.
    """
    link = description.link
    sizes = [topic.store("in").memory_bytes for topic in description.topics if topic.has("in")]
    if link.kind != "rtps" or max(sizes, default=0) <= _ONE_FRAME_BYTES:
        return 0
    return min(max(link.memory_bytes, 1 << 12), 1 << 16)
