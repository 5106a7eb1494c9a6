"""The link over UDP: datagrams at the interface of LiteEth's raw UDP port."""

from __future__ import annotations

from ipaddress import IPv4Address
from typing import Any

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.datagrams import DatagramSignature
from firm_hdl.gateware import PacketWidth
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.node.description import Link
from firm_hdl.node.gateware.fragments import Fragmenter
from firm_hdl.node.gateware.header import HeaderInsert
from firm_hdl.node.gateware.streams import link_members, passes
from firm_hdl.node.links.receive import FrameReceiver

__all__ = ["UdpLink"]


class UdpLink(wiring.Component):
    """Frames as datagrams.

    A message that does not fit into a datagram is sent in several. A lost one loses its message, is
    counted, and loses nothing else.

    The node answers the address and the port that `link` names; if it names none, those from which
    the last whole message came. Until then, what is sent is dropped and counted as `unsent`.

    The core below has to deliver only datagrams of the node's port. LiteEth delivers those of the
    port that `datagrams_out` has as `dst_port`. So this is the node's own port while no datagram is
    sent, and the host should have the same port: then nothing is missed while one is sent.

    The core has to take `ready` into account: a datagram waits about 20 words for its header to be
    checked (with words of 1 byte).

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat of the messages: 1, 2, 4, 8 or 16.
    link : Link
        Its `data_bytes` are the bytes per word of the datagrams.

    Members
    -------
    received : Out(LinkSignature(bus_bytes))
    sent : In(LinkSignature(bus_bytes))
    counters : Out(link_counters_layout())
    datagrams_in, datagrams_out : In and Out(DatagramSignature(data_bytes))
    """

    def __init__(self, bus_bytes: int, link: Link):
        self.bus_bytes, self.link = bus_bytes, link
        super().__init__(
            {
                **link_members(bus_bytes),
                **self.medium(link),
            }
        )

    @staticmethod
    def medium(link: Link) -> dict[str, Any]:
        """Return the members that face the medium."""
        return {
            "datagrams_in": In(DatagramSignature(link.data_bytes)),
            "datagrams_out": Out(DatagramSignature(link.data_bytes)),
        }

    def elaborate(self, platform: object) -> Module:
        m = Module()
        words, came = self.link.data_bytes, self.datagrams_in
        m.submodules.receiver = receiver = FrameReceiver(words, self.bus_bytes, self.link)
        frames = receiver.frames
        rest = came.payload.length[: (words - 1).bit_length()]
        m.d.comb += [
            Value.cast(frames.payload.data).eq(came.payload.data),
            frames.payload.count.eq(Mux(came.payload.last & (rest != 0), rest, words)),
            frames.payload.last.eq(came.payload.last),
            frames.valid.eq(came.valid),
            came.ready.eq(frames.ready),
            receiver.bad.eq(came.payload.error),
            *passes(receiver.received, self.received),
            self.counters.eq(receiver.counters),
        ]
        self._send(m, *self._peer(m, receiver))
        return m

    def _peer(self, m: Module, receiver: FrameReceiver) -> tuple[Value, Value, Value]:
        """Return whether there is a host, its address and its port."""
        if self.link.host:
            address = Const(int(IPv4Address(self.link.host)), 32)
            return Const(1), address, Const(self.link.host_port, 16)
        came = self.datagrams_in.payload
        known = Signal()
        address = Signal(32)
        port = Signal(16)
        new_address = Signal(32)
        new_port = Signal(16)
        # Where a datagram comes from is noted with its first word and counts once a whole message
        # has passed its checks: a stray datagram does not turn the replies away from the host.
        with m.If(receiver.begins):
            m.d.sync += [new_address.eq(came.ip_address), new_port.eq(came.src_port)]
        with m.If(receiver.passes):
            # A frame without bytes after its header ends after its last word was taken.
            m.d.sync += [known.eq(1), address.eq(new_address), port.eq(new_port)]
        return known, address, port

    def _send(self, m: Module, known: Value, address: Value, port: Value) -> None:
        """Send messages as datagrams to the host, if there is one."""
        words, out = self.link.data_bytes, self.datagrams_out
        m.submodules.insert = insert = HeaderInsert(self.bus_bytes)
        m.submodules.width = width = PacketWidth(self.bus_bytes, words)
        m.submodules.fragmenter = fragments = Fragmenter(words, self.link.datagram_bytes)
        frames = fragments.frames
        # The host of a datagram does not change between its first and its last word: it is noted in
        # the cycle before the first word moves.
        #
        #     frames     A0   A0   A1   A2(last)  B0   B0
        #     inside     0    1    1    1         0    1
        #     ready      0    1    1    1         0    1
        inside = Signal()
        sends = Signal()
        drops = Signal()
        to = Signal.like(self.datagrams_out.payload.ip_address)
        to_port = Signal(16)
        moves = Signal()
        m.d.comb += [
            *passes(self.sent, insert.i),
            *passes(insert.frames, width.packets_in),
            *passes(width.packets_out, fragments.i),
            out.valid.eq(frames.valid & sends),
            frames.ready.eq(Mux(sends, out.ready, drops)),
            moves.eq(frames.valid & frames.ready),
            out.payload.data.eq(Value.cast(frames.payload.data)),
            out.payload.last.eq(frames.payload.last),
            out.payload.last_be.eq(
                Mux(frames.payload.last, Const(1, words) << (frames.payload.count - 1)[:4], 0)
            ),
            out.payload.length.eq(fragments.size),
            out.payload.ip_address.eq(to),
            out.payload.src_port.eq(self.link.port),
            # A raw port of LiteEth receives what comes for the port that is on `dst_port`.
            out.payload.dst_port.eq(Mux(sends, to_port, self.link.port)),
        ]
        with m.If(~inside):
            m.d.sync += [
                inside.eq(frames.valid),
                sends.eq(frames.valid & known),
                drops.eq(frames.valid & ~known),
                to.eq(address),
                to_port.eq(port),
            ]
        with m.Elif(moves & frames.payload.last):
            m.d.sync += [inside.eq(0), sends.eq(0), drops.eq(0)]
        unsent = Signal(counters_layout("unsent"))
        add_counters(m, unsent, {"unsent": moves & frames.payload.last & drops})
        m.d.comb += self.counters.unsent.eq(unsent.unsent)
