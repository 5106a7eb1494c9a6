"""A packet FIFO that keeps a tag with each packet."""

from __future__ import annotations

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.fifo import SyncFIFO
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketFifo, PacketSignature
from firm_hdl.gateware.packets import Outcome
from firm_hdl.gateware.packets.counters import counters_layout
from firm_hdl.gateware.packets.memory import WhenFull
from firm_hdl.node.description import Store
from firm_hdl.node.gateware.streams import TAG_BITS

__all__ = ["TaggedFifo"]


class TaggedFifo(wiring.Component):
    """A :class:`PacketFifo` whose packets have tags.

    Latency 5 cycles from the last beat of a packet to its first one, if nothing is before it. All
    else is as in :class:`PacketFifo`.

    Parameters
    ----------
    bus_bytes : int
    store : Store
        Memory and policy.
    when_full : "wait", "drop" or None
        A policy in place of that of the store.

    Members
    -------
    packets_in : In(PacketSignature(bus_bytes))
    tag_in : In(32)
        Tag of the packet; counts with its last beat.
    abort : In(1)
        Drop the packet; counts with its last beat.
    packets_out : Out(PacketSignature(bus_bytes))
    tag_out : Out(32)
        Tag of the packet on `packets_out`, in all its beats.
    size : Out(range(memory_bytes + 1))
        Bytes of the packet on `packets_out`, in all its beats.
    counters : Out(counters_layout("passed", "aborted", "full", "large"))
    """

    def __init__(self, bus_bytes: int, store: Store, *, when_full: WhenFull | None = None):
        self.bus_bytes, self.store = bus_bytes, store
        self.when_full: WhenFull = when_full or store.when_full
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)),
                "tag_in": In(TAG_BITS),
                "abort": In(1),
                "packets_out": Out(PacketSignature(bus_bytes)),
                "tag_out": Out(TAG_BITS),
                "size": Out(range(store.memory_bytes + 1)),
                "counters": Out(counters_layout("passed", "aborted", "full", "large")),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        store = self.store
        m.submodules.fifo = fifo = PacketFifo(
            self.bus_bytes,
            store.memory_bytes,
            store.packets,
            when_full=self.when_full,
        )
        # Besides the packets that are stored, one is sent, and one has just been kept.
        m.submodules.tags = tags = SyncFIFO(width=TAG_BITS, depth=store.packets + 2)
        # The FIFO says what it did with a packet two cycles after its last beat.
        tag, tag_ended = Signal(TAG_BITS), Signal(TAG_BITS)
        out = self.packets_out
        m.d.sync += [tag.eq(self.tag_in), tag_ended.eq(tag)]
        m.d.comb += [
            fifo.packets_in.payload.eq(self.packets_in.payload),
            fifo.packets_in.valid.eq(self.packets_in.valid),
            self.packets_in.ready.eq(fifo.packets_in.ready),
            fifo.abort.eq(self.abort),
            tags.w_data.eq(tag_ended),
            tags.w_en.eq(fifo.ended & (fifo.outcome == Outcome.KEPT)),
            out.payload.eq(fifo.packets_out.payload),
            out.valid.eq(fifo.packets_out.valid & tags.r_rdy),
            fifo.packets_out.ready.eq(out.ready & tags.r_rdy),
            self.tag_out.eq(tags.r_data),
            tags.r_en.eq(out.valid & out.ready & out.payload.last),
            self.size.eq(fifo.size),
            self.counters.eq(fifo.counters),
        ]
        return m
