"""The link to the memory of a processor, through an AXI DMA of Xilinx (PG021)."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.node.description import Link
from firm_hdl.node.gateware.byte_packer import BytePacker, pieces_layout
from firm_hdl.node.gateware.fragments import Fragmenter
from firm_hdl.node.gateware.header import HeaderInsert
from firm_hdl.node.gateware.streams import link_members, passes
from firm_hdl.node.links.receive import FrameReceiver

__all__ = ["AxiDmaLink"]


class AxiDmaLink(wiring.Component):
    """Frames in buffers of a processor's memory.

    A frame from the processor (MM2S) may come in pieces that start and end anywhere. A frame to the
    processor (S2MM) has at most `buffer_bytes`, and a message that needs more is sent in several;
    so none is longer than its buffer, and its header says how long it is.

    A DMA takes words before a program runs it, and loses them with its next reset. So nothing is
    sent before the first whole message has come since the last reset of S2MM: messages are dropped
    and counted as `unsent`. While a reset is low, its direction transfers nothing. It ends the
    frame under way: from the processor, the message is `cut`; to the processor, the rest of the
    frame is dropped.

    Parameters
    ----------
    bus_bytes : int
        1, 2, 4, 8 or 16.
    link : Link
        Its memory and `buffer_bytes`.

    Members
    -------
    received : Out(LinkSignature(bus_bytes))
    sent : In(LinkSignature(bus_bytes))
    counters : Out(link_counters_layout())
    pieces_in : In(stream.Signature(pieces_layout(bus_bytes)))
        M_AXIS_MM2S of the DMA.
    frames_out : Out(PacketSignature(bus_bytes))
        S_AXIS_S2MM of the DMA.
    mm2s_aresetn, s2mm_aresetn : In(1)
        Its `mm2s_prmry_reset_out_n` and `s2mm_prmry_reset_out_n`, which a reset by software makes
        low. Of the clock of `sync`.
    """

    def __init__(self, bus_bytes: int, link: Link):
        self.bus_bytes, self.link = bus_bytes, link
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
            "pieces_in": In(stream.Signature(pieces_layout(bus_bytes))),
            "frames_out": Out(PacketSignature(bus_bytes)),
            "mm2s_aresetn": In(1, init=1),
            "s2mm_aresetn": In(1, init=1),
        }

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus = self.bus_bytes
        m.submodules.packer = packer = BytePacker(bus)
        m.submodules.receiver = receiver = FrameReceiver(bus, bus, self.link, when_full="wait")
        m.submodules.insert = insert = HeaderInsert(bus)
        m.submodules.fragmenter = fragments = Fragmenter(bus, self.link.buffer_bytes)
        frames, out, runs = fragments.frames, self.frames_out, self.s2mm_aresetn
        m.d.comb += [
            *passes(self.pieces_in, packer.i),
            packer.cut.eq(~self.mm2s_aresetn),
            *passes(packer.packets, receiver.frames),
            receiver.bad.eq(packer.bad),
            *passes(receiver.received, self.received),
            self.counters.eq(receiver.counters),
            *passes(self.sent, insert.i),
            *passes(insert.frames, fragments.i),
        ]
        # Whether a frame is sent is decided with its first beat.
        has_host = Signal()
        inside = Signal()
        was_dropped = Signal()
        drops = Signal()
        moves = Signal()
        m.d.comb += [
            drops.eq(Mux(inside, was_dropped, ~has_host)),
            out.payload.eq(frames.payload),
            out.valid.eq(frames.valid & ~drops & runs),
            frames.ready.eq(drops | (out.ready & runs)),
            moves.eq(frames.valid & frames.ready),
        ]
        with m.If(moves):
            m.d.sync += [inside.eq(~frames.payload.last), was_dropped.eq(drops)]
        # A reset loses the buffer with the first beats of a frame; its rest would look like a frame
        # of its own in the next buffer.
        with m.If(~runs):
            m.d.sync += [has_host.eq(0), was_dropped.eq(1)]
        with m.Elif(receiver.passes):
            m.d.sync += has_host.eq(1)
        unsent = Signal(counters_layout("unsent"))
        add_counters(m, unsent, {"unsent": moves & frames.payload.last & drops})
        m.d.comb += self.counters.unsent.eq(unsent.unsent)
        return m
