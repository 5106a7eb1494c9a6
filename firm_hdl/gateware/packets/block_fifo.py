"""A FIFO in block RAM, without logic behind the memory."""

from __future__ import annotations

from amaranth.hdl import Module, ShapeLike, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware.memories import BlockMemory

__all__ = ["BlockFifo"]


class BlockFifo(wiring.Component):
    """Store transfers of a stream in block RAM, in order.

    Latency 3 cycles: one each to write the memory, to read it, and to the register of `o`.
    Throughput one transfer per cycle. `i.ready`, `o.valid` and `o.payload` are registers. One clock
    domain, `sync`; its reset discards all transfers inside.

    The output of a block RAM is late in the cycle. So only the register of `o` comes after it, and
    no multiplexer, as there is one in a FIFO of Amaranth. Both have one enable, so while `o` waits,
    nothing is read: a transfer that comes in the meantime, with none before it, takes a cycle more.

    Parameters
    ----------
    shape : shape-like
        The shape of the payload.
    depth : int
        Transfers inside: a power of two, at least 4, and one more. All but two are in the memory,
        of which one word is never used; so positions need no lap bit.

    Members
    -------
    i : In(stream.Signature(shape))
        The payload may change before the transfer.
    o : Out(stream.Signature(shape))
    is_empty : Out(1)
        Nothing is inside. Depends on registers only.
    """

    def __init__(self, shape: ShapeLike, depth: int):
        self.shape, self.words = shape, depth - 1
        if self.words < 4 or self.words & (self.words - 1):
            raise ValueError(f"Depth must be a power of two from 4 on, and 1 more, not {depth}")
        super().__init__(
            {
                "i": In(stream.Signature(shape)),
                "o": Out(stream.Signature(shape)),
                "is_empty": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        memory = BlockMemory(m, self.shape, self.words)
        bits = ceil_log2(self.words)
        # Positions of the word that is written next, and of the word that is read next.
        to = Signal(bits)
        at = Signal(bits)
        used = Signal(bits)
        room = Signal(init=1)
        arrives = Signal()
        # The memory's register has a transfer.
        fetched = Signal()
        more = Signal()
        leaves = Signal()
        m.d.comb += [
            self.i.ready.eq(room),
            arrives.eq(self.i.valid & room),
            used.eq(to - at),
            memory.write_at.eq(to),
            memory.write_word.eq(self.i.payload),
            # A word is valid when `to` has passed it. So it may be written in every cycle. The word
            # that is written is read only if the FIFO is empty; `fetched` stays 0 then, as
            # :class:`BlockMemory` wants it.
            memory.writes.eq(1),
            more.eq(to != at),
            leaves.eq(~self.o.valid | self.o.ready),
            memory.read_at.eq(at),
            memory.reads.eq(leaves),
            self.is_empty.eq(~more & ~fetched & ~self.o.valid),
        ]
        # What becomes free in this cycle is seen in the next one.
        m.d.sync += [
            to.eq(to + arrives),
            room.eq(~used.all() & ~((used == self.words - 2) & arrives)),
        ]
        with m.If(leaves):
            m.d.sync += [
                *(fetched.eq(more), at.eq(at + more)),
                *(self.o.valid.eq(fetched), Value.cast(self.o.payload).eq(memory.word)),
            ]
        return m
