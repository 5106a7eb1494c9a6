"""What the links for media with losses share: from frames to checked messages."""

from __future__ import annotations

from typing import Literal

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketFifo, PacketSignature, PacketWidth
from firm_hdl.node.description import Link
from firm_hdl.node.gateware.fragments import REASSEMBLER_COUNTERS, Reassembler
from firm_hdl.node.gateware.header import HeaderStrip
from firm_hdl.node.gateware.streams import LinkSignature, link_counters_layout, passes

__all__ = ["FrameReceiver"]


class FrameReceiver(wiring.Component):
    """Put messages together, store them, and pass on those that are whole.

    Nothing of a message that is damaged or not whole gets out.

    Parameters
    ----------
    in_bytes : int
        Bytes per beat of the frames: 1, 2, 4, 8 or 16.
    bus_bytes : int
        Bytes per beat of the messages, likewise.
    link : Link
        Its memory.
    when_full : "drop" or "wait"
        What becomes of a message without room.

    Members
    -------
    frames : In(PacketSignature(in_bytes))
    bad : In(1)
        The frame is damaged; counts with its last beat.
    received : Out(LinkSignature(bus_bytes))
    begins, passes : Out(1)
        As those of a :class:`Reassembler`.
    counters : Out(link_counters_layout())
    """

    def __init__(
        self,
        in_bytes: int,
        bus_bytes: int,
        link: Link,
        when_full: Literal["wait", "drop"] = "drop",
    ):
        self.in_bytes, self.bus_bytes, self.link = in_bytes, bus_bytes, link
        self.when_full = when_full
        super().__init__(
            {
                "frames": In(PacketSignature(in_bytes)),
                "bad": In(1),
                "received": Out(LinkSignature(bus_bytes)),
                "begins": Out(1),
                "passes": Out(1),
                "counters": Out(link_counters_layout()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.reassembler = whole = Reassembler(self.in_bytes)
        m.submodules.fifo = fifo = PacketFifo(
            self.in_bytes, self.link.memory_bytes, self.link.packets, when_full=self.when_full
        )
        m.submodules.strip = strip = HeaderStrip(self.bus_bytes)
        last = fifo.packets_out
        if self.in_bytes != self.bus_bytes:
            m.submodules.width = width = PacketWidth(self.in_bytes, self.bus_bytes)
            m.d.comb += passes(fifo.packets_out, width.packets_in)
            last = width.packets_out
        m.d.comb += [
            *passes(self.frames, whole.i),
            whole.bad.eq(self.bad),
            *passes(whole.o, fifo.packets_in),
            fifo.abort.eq(whole.abort),
            *passes(last, strip.frames),
            *passes(strip.o, self.received),
            self.begins.eq(whole.begins),
            self.passes.eq(whole.passes),
            self.counters.lost.eq(whole.lost),
            *(self.counters[name].eq(fifo.counters[name]) for name in ("passed", "full", "large")),
            *(self.counters[name].eq(whole.counters[name]) for name in REASSEMBLER_COUNTERS),
        ]
        return m
