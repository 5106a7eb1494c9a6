"""The edge of a node to Ethernet: all from the symbols of a PHY up to datagrams of UDP."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.arp import ArpCache, ArpReceiver
from firm_hdl.ethernet.datagrams import DatagramSignature
from firm_hdl.ethernet.drops import DROPS
from firm_hdl.ethernet.fragments import Reassembler
from firm_hdl.ethernet.header import HeaderReceiver
from firm_hdl.ethernet.icmp import EchoReceiver
from firm_hdl.ethernet.igmp import IgmpHost
from firm_hdl.ethernet.ipv4 import ALL_SYSTEMS, Ipv4Receiver, PayloadCheck
from firm_hdl.ethernet.mac import MacReceiver, MacTransmitter
from firm_hdl.ethernet.sender import FrameSender
from firm_hdl.ethernet.slots import FrameSlots
from firm_hdl.ethernet.streams import SymbolSignature
from firm_hdl.ethernet.udp import (
    WORD_BYTES,
    DatagramReader,
    UdpForwarder,
    UdpReceiver,
    UdpTransmitter,
    join_words,
)

__all__ = ["EthernetEdge", "EthernetSettings", "drops_layout"]


def drops_layout() -> data.StructLayout:
    """Return a bit for each of `DROPS`."""
    return data.StructLayout(dict.fromkeys(DROPS, 1))


@dataclass(frozen=True, slots=True, kw_only=True)
class EthernetSettings:
    """Addresses, ports and memories of a node on Ethernet."""

    mac: int  # 48 bits.
    address: int  # 32 bits, as all addresses of IPv4.
    prefix_bits: int = 24  # Bits of the address that are those of the network.
    gateway: int = 0  # 0: nothing leaves the network.
    ports: tuple[int, ...]  # Ports of UDP on which datagrams come.
    groups: tuple[int, ...] = ()  # Groups that the node joins.
    # For whole datagrams that wait to be read: a power of two, at least 2,048. 0: they are passed
    # on as they come, before it is known whether they are right.
    memory_bytes: int = 4096
    # For datagrams in fragments, as a `firm_hdl.ethernet.fragments.Reassembler` has it. 0:
    # fragments are dropped.
    fragment_bytes: int = 0
    # A tick has `1 << tick_bits` cycles. It should be 50 to 100 ms: 23 bits at 125 MHz.
    tick_bits: int = 23

    # Bytes of a word of datagrams, received and sent: 1 or 4.
    word_bytes: int = 1
    # So many bytes of a datagram may be missing when its frame begins. If it is not 0, datagrams to
    # send must not pause, and be no larger than a frame.
    ahead_bytes: int = 0

    @property
    def is_split(self) -> bool:
        """Whether datagrams in one piece and those in fragments come apart."""
        return not self.memory_bytes and bool(self.fragment_bytes)


_ARP_TICK_BITS = 4
"""Ticks of an :class:`ArpCache` are 16 of the edge's, about a second."""

_WAIT_BITS = 6
"""A datagram waits for ARP a 64th of a tick, about 1 ms."""


class EthernetEdge(wiring.Component):
    """Ethernet, ARP, IPv4, ICMP echo, IGMP and UDP, a byte per cycle.

    What comes is judged as it passes, and cannot be held. State changes only at the end of a frame,
    when all was right: a bad frame leaves no trace but a count.

    From the end of a frame to the first byte of its datagram on `received`: 24 cycles; without
    memory, to the last one: 5 cycles. From the last byte of a datagram on `sent` to the first
    symbol: about 30 cycles. A byte per cycle in both directions, at 125 MHz those of 1 Gbit/s.

    One clock domain, `sync`. Its reset discards all datagrams inside.

    Parameters
    ----------
    settings : EthernetSettings

    Members
    -------
    symbols_in : In(SymbolSignature())
    symbols_out : Out(SymbolSignature())
    received : Out(DatagramSignature(settings.word_bytes))
        `dst_port` is one of the node's ports, and `error` is 0. May be held; datagrams for which
        there is no room then are dropped. Without memory, it cannot be held, and has `error`.
    joined : Out(DatagramSignature(1))
        Only without memory, but with some for fragments: datagrams that came in fragments. May be
        held.
    sent : In(DatagramSignature(settings.word_bytes))
        `ip_address` is a machine or a group.
    drops : Out(drops_layout())
        Strobes.
    """

    def __init__(self, settings: EthernetSettings):
        self.settings = settings
        super().__init__(
            {
                "symbols_in": In(SymbolSignature()),
                "symbols_out": Out(SymbolSignature()),
                "received": Out(DatagramSignature(settings.word_bytes)),
                **({"joined": Out(DatagramSignature(1))} if settings.is_split else {}),
                "sent": In(DatagramSignature(settings.word_bytes)),
                "drops": Out(drops_layout()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        own = self.settings
        groups = (*own.groups, ALL_SYSTEMS) if own.groups else ()
        m.submodules.mac_receiver = mac = MacReceiver()
        m.submodules.header = header = HeaderReceiver(own.mac)
        m.submodules.arp = arp = ArpReceiver(own.mac, own.address)
        m.submodules.cache = cache = ArpCache()
        m.submodules.ipv4 = ipv4 = Ipv4Receiver(own.address, groups)
        m.submodules.check = check = PayloadCheck(own.ports)
        m.submodules.echo = echo = EchoReceiver()
        udp: UdpReceiver | UdpForwarder
        udp = UdpReceiver(own.memory_bytes) if own.memory_bytes else UdpForwarder()
        m.submodules.udp_receiver = udp
        m.submodules.udp_transmitter = transmitter = UdpTransmitter(own.address, own.ahead_bytes)
        m.submodules.replies = replies = FrameSlots(4, header_bytes=16)
        m.submodules.datagrams = datagrams = FrameSlots(2, header_bytes=32, word_bytes=WORD_BYTES)
        m.submodules.sender = sender = FrameSender(
            own.mac,
            own.address,
            own.prefix_bits,
            own.gateway,
            own.groups,
            1 << own.tick_bits - _WAIT_BITS,
        )
        m.submodules.mac_transmitter = mac_transmitter = MacTransmitter()

        tick, arp_tick = Signal(), Signal()
        ticks = Signal(own.tick_bits + _ARP_TICK_BITS)
        m.d.sync += [
            ticks.eq(ticks + 1),
            tick.eq(ticks[: own.tick_bits].all()),
            arp_tick.eq(ticks.all()),
        ]

        wiring.connect(m, wiring.flipped(self.symbols_in), mac.symbols)
        wiring.connect(m, mac.frames, header.frames)
        wiring.connect(m, header.arp, arp.payloads)
        wiring.connect(m, header.ipv4, ipv4.payloads)
        m.d.comb += [
            ipv4.to_node.eq(header.to_node),
            ipv4.to_group.eq(header.to_group),
            cache.peer.eq(arp.peer),
            cache.learns.eq(arp.learns),
            cache.inserts.eq(arp.inserts),
            cache.tick.eq(arp_tick),
        ]
        for part in (check, echo, udp):
            m.d.comb += _watch_datagrams(ipv4.datagrams, part.datagrams)
        m.d.comb += [
            echo.right.eq(check.right),
            udp.right.eq(check.right),
            udp.check.eq(check.state),
        ]
        stores: list[Any] = []
        if isinstance(udp, UdpReceiver):
            stores.append(udp.store)
        else:
            self._receive(m, udp.received)

        dropped = Signal()
        if own.fragment_bytes:
            m.submodules.reassembler = reassembler = Reassembler(own.fragment_bytes)
            m.d.comb += [
                *_watch_datagrams(ipv4.datagrams, reassembler.datagrams),
                reassembler.check.eq(check.state),
                reassembler.right.eq(check.right),
                reassembler.tick.eq(tick),
                check.load.eq(reassembler.load),
                check.loaded.eq(reassembler.loaded),
                dropped.eq(reassembler.dropped),
            ]
            stores.append(reassembler.store)
        else:
            came, about = ipv4.datagrams.bytes, ipv4.datagrams.header
            ends = came.valid & came.payload.end & came.payload.good
            is_fragment = ~about.first | about.more
            m.d.comb += dropped.eq(ends & about.udp & is_fragment)
        if stores:
            m.submodules.reader = reader = DatagramReader(len(stores))
            for store, read in zip(stores, reader.stores, strict=True):
                wiring.connect(m, store, read)
            if own.is_split:
                wiring.connect(m, reader.datagrams, wiring.flipped(self.joined))
            else:
                self._receive(m, reader.datagrams)

        # Requests of ARP and of an echo never come at the same time, nor do their replies.
        wiring.connect(m, replies.reader, sender.replies)
        wiring.connect(m, datagrams.reader, sender.datagrams)
        wiring.connect(m, transmitter.slot, datagrams.writer)
        if own.word_bytes == WORD_BYTES:
            wiring.connect(m, wiring.flipped(self.sent), transmitter.datagrams)
        else:
            join_words(m, self.sent, transmitter.datagrams)
        for name, flow in replies.writer.signature.members.items():
            if flow.flow == In:
                parts = [getattr(part.reply, name) for part in (arp, echo)]
                m.d.sync += getattr(replies.writer, name).eq(Mux(header.is_arp, *parts))
        m.d.comb += [
            arp.reply.free.eq(replies.writer.free),
            echo.reply.free.eq(replies.writer.free),
        ]
        m.d.comb += [
            cache.ip.eq(sender.ip),
            cache.look.eq(sender.look),
            cache.absent.eq(sender.absent),
            *(getattr(sender, name).eq(getattr(cache, name)) for name in _OF_CACHE),
            sender.learned.eq(arp.learns),
            sender.tick.eq(tick),
        ]
        wiring.connect(m, sender.frames, mac_transmitter.frames)
        wiring.connect(m, mac_transmitter.symbols, wiring.flipped(self.symbols_out))

        drops: dict[str, Any] = {
            "damaged": mac.damaged,
            "runt": mac.runt,
            "giant": mac.giant,
            "other": header.other | arp.other | ipv4.other | echo.other | udp.empty,
            "malformed": ipv4.malformed,
            "checksum": echo.wrong | udp.wrong,
            "port": udp.no_port,
            "fragment": dropped,
            "full": arp.full | echo.full | (udp.full if isinstance(udp, UdpReceiver) else 0),
            "unresolved": sender.unresolved,
            "unfit": transmitter.unfit,
        }
        if own.groups:
            m.submodules.igmp = igmp = IgmpHost(own.groups)
            m.d.comb += [
                *_watch_datagrams(ipv4.datagrams, igmp.datagrams),
                igmp.right.eq(check.right),
                igmp.tick.eq(tick),
                sender.report.eq(igmp.pending),
                sender.group.eq(igmp.group),
                igmp.sent.eq(sender.reported),
            ]
            drops["other"] |= igmp.other
            drops["checksum"] |= igmp.wrong
        m.d.comb += [self.drops[name].eq(value) for name, value in drops.items()]
        return m

    def _receive(self, m: Module, datagrams: Any) -> None:
        """Pass on what was received."""
        if self.settings.word_bytes == WORD_BYTES:
            join_words(m, datagrams, self.received)
        else:
            wiring.connect(m, datagrams, wiring.flipped(self.received))


_OF_CACHE = ("done", "found", "gone", "stale", "mac")


def _watch(source: Any, target: Any) -> list[Any]:
    """Return the statements that show a stream, which cannot be held, to one of several targets."""
    return [target.payload.eq(source.payload), target.valid.eq(source.valid)]


def _watch_datagrams(source: Any, target: Any) -> list[Any]:
    return [*_watch(source.bytes, target.bytes), target.header.eq(source.header)]
