"""The reading side of a packet memory."""

from __future__ import annotations

from amaranth.hdl import Module, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.packets.memory import MemoryShape

__all__ = ["PacketReader"]


class PacketReader(wiring.Component):
    """Read packets from a memory with a synchronous read port.

    Latency 2 cycles: one in the memory, and one to the register of `packets`. Throughput one beat
    per cycle. The memory and the register have one enable, so while `packets` waits, nothing is
    read: a beat that is stored in the meantime, with none before it, comes a cycle later.

    Parameters
    ----------
    shape : MemoryShape

    Members
    -------
    kept : In(position)
        All words before this position may be read.
    at : Out(position)
        The word that is read next; all words before this position are free. A register.
    reads : Out(1)
        Enable of the read port. Reads that are not needed are harmless.
    word : In(shape.beat)
        The word of the last read.
    next_size : In(range(memory_bytes + 1))
        Size of the first packet whose first beat was not sent.
    begins : Out(1)
        The first beat of a packet is sent to `packets`, and `next_size` is taken.
    packets : Out(stream.Signature(shape.beat))
        `valid` and `payload` are registers.
    size : Out(range(memory_bytes + 1))
        Bytes of the packet on `packets`; valid with `packets`.
    """

    def __init__(self, shape: MemoryShape):
        size = range(shape.memory_bytes + 1)
        super().__init__(
            {
                "kept": In(shape.position_bits),
                "at": Out(shape.position_bits),
                "reads": Out(1),
                "word": In(shape.beat),
                "next_size": In(size),
                "begins": Out(1),
                "packets": Out(stream.Signature(shape.beat)),
                "size": Out(size),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        packets = self.packets
        # `word` has a beat of a packet; the next beat is the first one of its packet.
        fetched = Signal()
        starts = Signal(init=1)
        more = Signal()
        leaves = Signal()
        m.d.comb += [
            more.eq(self.at != self.kept),
            leaves.eq(~packets.valid | packets.ready),
            self.reads.eq(leaves),
            self.begins.eq(leaves & fetched & starts),
        ]
        with m.If(leaves):
            m.d.sync += [
                *(fetched.eq(more), self.at.eq(self.at + more)),
                *(packets.valid.eq(fetched), packets.payload.eq(self.word)),
            ]
        with m.If(leaves & fetched):
            m.d.sync += starts.eq(self.word.last)
        with m.If(self.begins):
            m.d.sync += self.size.eq(self.next_size)
        return m
