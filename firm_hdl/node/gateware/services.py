"""Requests and responses of services: packets with a tag each."""

from __future__ import annotations

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.fifo import SyncFIFO
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import GateStatus, PacketFifo, PacketGate, PacketSignature
from firm_hdl.gateware.packets import Outcome
from firm_hdl.gateware.packets.counters import counters_layout
from firm_hdl.gateware.packets.memory import WhenFull
from firm_hdl.node.control import GATE_COUNTERS
from firm_hdl.node.description import Store
from firm_hdl.node.gateware.streams import TAG_BITS, passes
from firm_hdl.timing.rings import ring_beats
from firm_hdl.wire import Wire

__all__ = ["RequestGate", "TaggedFifo"]


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
        tag = Signal(TAG_BITS)
        tag_ended = Signal(TAG_BITS)
        out = self.packets_out
        m.d.sync += [tag.eq(self.tag_in), tag_ended.eq(tag)]
        m.d.comb += [
            *passes(self.packets_in, fifo.packets_in),
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


class RequestGate(wiring.Component):
    """Forward only the good requests of a service, each with its tag.

    A FIFO that drops what has no room stands before a :class:`PacketGate`, so that requests that
    nobody takes hold nothing else. Both have the memory of the store.

    Parameters
    ----------
    bus_bytes : int
    store : Store
    wire : Wire

    Members
    -------
    packets_in : In(PacketSignature(bus_bytes))
        `ready` is always high.
    tag_in : In(32)
        Counts with the last beat.
    packets_out : Out(PacketSignature(bus_bytes))
    tag_out : Out(32)
        Tag of the request, in all its beats.
    size : Out(range(memory_bytes + 1))
    counters : Out(counters_layout(*GATE_COUNTERS))
        As those of a gate; `overrun` stays 0.
    """

    def __init__(self, bus_bytes: int, store: Store, wire: Wire):
        self.bus_bytes, self.store, self.wire = bus_bytes, store, wire
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)),
                "tag_in": In(TAG_BITS),
                "packets_out": Out(PacketSignature(bus_bytes)),
                "tag_out": Out(TAG_BITS),
                "size": Out(range(store.memory_bytes + 1)),
                "counters": Out(counters_layout(*GATE_COUNTERS)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        store = self.store
        m.submodules.fifo = fifo = TaggedFifo(self.bus_bytes, store, when_full="drop")
        m.submodules.gate = gate = PacketGate(
            store.message,
            wire=self.wire,
            bus_bytes=self.bus_bytes,
            memory_bytes=store.memory_bytes,
            packets=store.packets,
            max_message_bytes=store.max_message_bytes,
        )
        # A gate has no place for a tag. Its verdicts and its packets leave in the order in which
        # they came, so two FIFOs of tags keep step with it:
        #
        #     fifo ---> packets ------> gate ---> status ---> packets_out
        #        \---> tag ---> judged -----------> | ok ---> good ---> tag_out
        #                                           \ else: the tag is dropped, as the packet
        #
        # Requests in the gate that have no status yet: at most one for each beat that waits there.
        m.submodules.judged = judged = SyncFIFO(
            width=TAG_BITS, depth=4 * ring_beats(self.bus_bytes)
        )
        # Good requests: those in the gate's memory, the one that leaves, and the next one.
        m.submodules.good = good = SyncFIFO(width=TAG_BITS, depth=store.packets + 2)
        took, out = fifo.packets_out, self.packets_out
        m.d.comb += [
            *passes(self.packets_in, fifo.packets_in),
            fifo.tag_in.eq(self.tag_in),
            gate.packets_in.payload.eq(took.payload),
            gate.packets_in.valid.eq(took.valid & judged.w_rdy),
            took.ready.eq(gate.packets_in.ready & judged.w_rdy),
            judged.w_data.eq(fifo.tag_out),
            judged.w_en.eq(took.valid & took.ready & took.payload.last),
            good.w_data.eq(judged.r_data),
            good.w_en.eq(gate.status.valid & good.w_rdy & (gate.status.payload == GateStatus.OK)),
            gate.status.ready.eq(good.w_rdy),
            judged.r_en.eq(gate.status.valid & good.w_rdy),
            out.payload.eq(gate.packets_out.payload),
            out.valid.eq(gate.packets_out.valid & good.r_rdy),
            gate.packets_out.ready.eq(out.ready & good.r_rdy),
            self.tag_out.eq(good.r_data),
            good.r_en.eq(out.valid & out.ready & out.payload.last),
            self.size.eq(gate.size),
        ]
        for name in GATE_COUNTERS:
            # The FIFO drops what has no room; the gate behind it waits.
            owner = fifo.counters if name in ("full", "large") else gate.counters
            m.d.comb += self.counters[name].eq(owner[name])
        return m
