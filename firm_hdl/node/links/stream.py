"""The link over AXI4-Stream: for a DMA, or any core that carries packets."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.packets.counters import add_counters
from firm_hdl.node.gateware.header import HeaderInsert, HeaderStrip
from firm_hdl.node.gateware.streams import TOPIC_BITS, link_members, passes

__all__ = ["StreamLink"]


class StreamLink(wiring.Component):
    """Frames as packets of a stream that loses nothing.

    A message is one frame, whatever its size. `dest` is TDEST of AXI4-Stream, for a DMA with
    several channels; what comes needs none, as its header has the topic. No memory is needed: the
    gate of each topic judges the bytes.

    Latency 1 cycle in each direction, besides the header. A beat per cycle in both. One clock
    domain, `sync`.

    Parameters
    ----------
    bus_bytes : int
        1, 2, 4, 8 or 16.

    Members
    -------
    received : Out(LinkSignature(bus_bytes))
    sent : In(LinkSignature(bus_bytes))
    counters : Out(link_counters_layout())
        `passed` and `malformed`.
    frames_in, frames_out : In and Out(PacketSignature(bus_bytes))
    dest : Out(16)
        Topic of the frame on `frames_out`, in all its beats.
    """

    def __init__(self, bus_bytes: int):
        self.bus_bytes = bus_bytes
        super().__init__(
            {
                **link_members(bus_bytes),
                **self.medium(bus_bytes),
            }
        )

    @staticmethod
    def medium(bus_bytes: int) -> dict[str, Any]:
        """Return the members that face the medium."""
        return {
            "frames_in": In(PacketSignature(bus_bytes)),
            "frames_out": Out(PacketSignature(bus_bytes)),
            "dest": Out(TOPIC_BITS),
        }

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.strip = strip = HeaderStrip(self.bus_bytes)
        m.submodules.insert = insert = HeaderInsert(self.bus_bytes)
        m.d.comb += [
            *passes(self.frames_in, strip.frames),
            *passes(strip.o, self.received),
            *passes(self.sent, insert.i),
            *passes(insert.frames, self.frames_out),
            self.dest.eq(insert.topic),
        ]
        add_counters(m, self.counters, {"passed": strip.passes, "malformed": strip.malformed})
        return m
