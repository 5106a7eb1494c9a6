"""From words of any size to packets of full beats: the mirror of the window."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.plan import Plan
from firm_hdl.plan.geometry import geometry

__all__ = ["Packer", "word_layout"]


def word_layout(word_bytes: int) -> data.StructLayout:
    """Return the payload of a stream of words.

    Members
    -------
    data : ArrayLayout(8, word_bytes)
        The first `count` lanes are the word; the others are 0.
    count : range(word_bytes + 1)
    align : unsigned(3)
        Padding follows up to a position behind the encapsulation header that has these bits 0.
    last : unsigned(1)
        The packet ends with this word.
    error : unsigned(1)
        Mark the packet, if `last`.
    """
    return data.StructLayout(
        {
            "data": data.ArrayLayout(8, word_bytes),
            "count": range(word_bytes + 1),
            "align": 3,
            "last": 1,
            "error": 1,
        }
    )


class Packer(wiring.Component):
    """Join words into packets.

    Takes one word and gives one beat per cycle; latency 1 cycle. `word.ready` depends
    combinationally on `packets.ready`.

    Parameters
    ----------
    plan : Plan
        Decides all sizes.

    Members
    -------
    word : In(stream.Signature(word_layout(word_bytes)))
    packets : Out(PacketSignature(bus_bytes))
    error : Out(1)
        The packet of the beat on `packets` is marked; set with its last beat only.
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        self.geometry = geometry(plan)
        super().__init__(
            {
                "word": In(stream.Signature(word_layout(self.geometry.word_bytes))),
                "packets": Out(PacketSignature(plan.bus_bytes)),
                "error": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus, word_bytes = self.plan.bus_bytes, self.geometry.word_bytes
        granule = self.geometry.granule_bytes
        # A packet may end in a step without bytes. Its last beat must then still be here.
        holds = any(not step.most_bytes for step in self.plan.steps)
        store_bytes = (bus if holds else bus - granule) + word_bytes
        store = Signal(8 * max(bus, store_bytes))
        level = Signal(range(bus + word_bytes + 8))
        ending = Signal()
        marked = Signal()

        payload = self.packets.payload
        is_last = Signal()
        m.d.comb += [
            self.packets.valid.eq(ending | ((level > bus) if holds else (level >= bus))),
            is_last.eq(ending & (level <= bus)),
            payload.last.eq(is_last),
            payload.count.eq(Mux(level > bus, bus, level)),
            Value.cast(payload.data).eq(store[: 8 * bus]),
            self.error.eq(is_last & marked),
        ]
        leaves = Signal()
        rest = Signal.like(level)
        kept = Signal.like(store)
        m.d.comb += [
            leaves.eq(self.packets.valid & self.packets.ready),
            rest.eq(Mux(leaves, Mux(is_last, 0, level - bus), level)),
            kept.eq(Mux(leaves, store >> (8 * bus), store)),
            # Nothing may be accepted behind a packet that is not gone, nor in front of a full beat.
            self.word.ready.eq(
                (~ending | (leaves & is_last)) & ((rest <= bus) if holds else (rest < bus))
            ),
        ]
        word = self.word.payload
        position = self._position(m, rest)
        pad = Signal(3)
        m.d.comb += pad.eq(-(position + word.count)[:3] & word.align)
        low = granule.bit_length() - 1
        m.d.sync += [store.eq(kept), level.eq(rest)]
        with m.If(leaves & is_last):
            m.d.sync += ending.eq(0)
        with m.If(self.word.valid & self.word.ready):
            m.d.sync += [
                store.eq(kept | self._placed(m, Cat(Const(0, low), rest[low:]))),
                level.eq(rest + word.count + pad),
                ending.eq(word.last),
                marked.eq(word.error),
            ]
        return m

    def _placed(self, m: Module, offset: Value) -> Value:
        """Return the word's bytes, moved up by an offset of at most a beat."""
        now: Value = Value.cast(self.word.payload.data)
        for bit in range(self.plan.bus_bytes.bit_length()):
            if 1 << bit < self.geometry.granule_bytes:
                continue
            if 1 << bit == self.plan.bus_bytes and self.geometry.granule_bytes == 1 << bit:
                break
            moved = Signal(len(now) + (8 << bit), name=f"moved_{1 << bit}")
            m.d.comb += moved.eq(Mux(offset[bit], now << (8 << bit), now))
            now = moved
        return now

    def _position(self, m: Module, rest: Value) -> Signal:
        """Return where the word starts, behind the encapsulation header and modulo 8."""
        header = self.plan.header_bytes
        position = Signal(unsigned(3))
        if not self.geometry.aligns:
            return position
        if self.plan.bus_bytes >= 8:
            m.d.comb += position.eq(rest - header)
            return position
        now = Signal(unsigned(3), init=-header % 8)
        m.d.comb += position.eq(now)
        word = self.word.payload
        with m.If(self.word.valid & self.word.ready):
            behind = Signal(unsigned(3))
            m.d.comb += behind.eq(now + word.count)
            m.d.sync += now.eq(behind + (-behind & word.align))
            with m.If(word.last):
                m.d.sync += now.eq(-header % 8)
        return position
