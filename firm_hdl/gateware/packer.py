"""The packer joins words of any size to packets of full beats; it is the inverse of the window."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.signatures import PacketSignature
from firm_hdl.plan import Plan
from firm_hdl.plan.geometry import geometry

__all__ = ["Packer", "word_layout"]


def word_layout(window_bytes: int, skip_bytes: int) -> data.StructLayout:
    """Return the payload of a stream of words.

    Members
    -------
    data : ArrayLayout(8, window_bytes)
        The bytes of the word; the first one is in lane 0. Lanes from `count` on are 0.
    count : range(skip_bytes + 1)
        Bytes of the word. A count over `window_bytes` appends zeros.
    align : unsigned(3)
        Mask of the low bits of the position, counted from behind the encapsulation header, that
        must be 0 behind the word. Padding is added up to there.
    last : unsigned(1)
        The packet ends with this word.
    error : unsigned(1)
        Mark the packet with an error. Only looked at when `last` is set.
    """
    return data.StructLayout(
        {
            "data": data.ArrayLayout(8, window_bytes),
            "count": range(skip_bytes + 1),
            "align": 3,
            "last": 1,
            "error": 1,
        }
    )


class Packer(wiring.Component):
    """Join words into packets.

    The packer takes one word and emits one beat per cycle; latency 1 cycle. `word.ready` depends
    combinationally on `packets.ready`.

    Parameters
    ----------
    plan : Plan
        Decides all sizes.

    Members
    -------
    word : In(stream.Signature(word_layout(window_bytes, skip_bytes)))
    packets : Out(PacketSignature(bus_bytes))
    error : Out(1)
        The packet is marked with an error. Set only with the last beat of the packet.
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        self.geometry = geometry(plan)
        words = word_layout(self.geometry.window_bytes, self.geometry.skip_bytes)
        super().__init__(
            {
                "word": In(stream.Signature(words)),
                "packets": Out(PacketSignature(plan.bus_bytes)),
                "error": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus, window_bytes = self.plan.bus_bytes, self.geometry.window_bytes
        # A packet may end in a step without bytes. Its last beat must not have left by then.
        holds = any(not step.most_bytes for step in self.plan.steps)
        # Where words are not beats, one beat may wait while the next word comes, so that a short
        # word, or the start of the next packet, does not leave a hole in the stream.
        words_are_beats = self.geometry.start_alignment_bytes == bus >= window_bytes
        most_kept = 0 if words_are_beats and not holds else bus
        store = Signal(8 * max(bus, most_kept + window_bytes))
        level = Signal(range(most_kept + self.geometry.skip_bytes + 8 + bus))
        # The packet has at least one byte so far.
        inside = Signal()
        ending = Signal()
        end_beats = Signal(range(len(store) // 8 // bus + 2))
        end_count = Signal(range(bus + 1))
        marked = Signal()

        payload = self.packets.payload
        is_last = Signal()
        m.d.comb += [
            self.packets.valid.eq(ending | ((level > bus) if holds else (level >= bus))),
            is_last.eq(ending & (end_beats == 1)),
            payload.last.eq(is_last),
            payload.count.eq(Mux(is_last, end_count, bus)),
            Value.cast(payload.data).eq(store[: 8 * bus]),
            self.error.eq(is_last & marked),
        ]
        leaves = Signal()
        rest = Signal.like(level)
        kept = Signal.like(store)
        word = self.word.payload
        still_ending = Signal()
        m.d.comb += [
            leaves.eq(self.packets.valid & self.packets.ready),
            rest.eq(Mux(leaves, level - bus, level)),
            kept.eq(Mux(leaves, store >> (8 * bus), store)),
            still_ending.eq(ending & ~(leaves & is_last)),
            # The end of only one packet is remembered at a time.
            self.word.ready.eq((rest <= most_kept) & ~(still_ending & word.last)),
        ]
        position = self._position(m, rest)
        pad = Signal(3)
        m.d.comb += pad.eq(-(position + word.count)[:3] & word.align)
        m.d.sync += [store.eq(kept), level.eq(rest), ending.eq(still_ending)]
        with m.If(leaves):
            m.d.sync += end_beats.eq(end_beats - 1)
        with m.If(self.word.valid & self.word.ready):
            m.d.sync += [
                store.eq(kept | self._placed(m, rest, most_kept)),
                level.eq(rest + word.count + pad),
                inside.eq(~word.last & (inside | (word.count != 0))),
            ]
            with m.If(word.last):
                self._end(m, inside, rest, level, ending, end_beats, end_count)
                m.d.sync += marked.eq(word.error)
        return m

    def _end(
        self,
        m: Module,
        inside: Signal,
        rest: Signal,
        level: Signal,
        ending: Signal,
        end_beats: Signal,
        end_count: Signal,
    ) -> None:
        """End the packet with the word being accepted; the next packet starts a new beat."""
        bus = self.plan.bus_bytes
        low = bus.bit_length() - 1
        word = self.word.payload
        total, beats = Signal.like(level), Signal.like(level)
        empty = ~inside & (word.count == 0)
        m.d.comb += [
            total.eq(rest + word.count),
            beats.eq(((total + (bus - 1)) >> low) + empty),
        ]
        m.d.sync += [
            level.eq(beats << low),
            ending.eq(1),
            end_beats.eq(beats),
            end_count.eq(Mux(empty, 0, (total - 1)[:low] + 1)),
        ]

    def _placed(self, m: Module, rest: Value, most_kept: int) -> Value:
        """Return the word's bytes, shifted to the place behind the bytes that are kept."""
        now: Value = Value.cast(self.word.payload.data)
        for bit in range(most_kept.bit_length()):
            if 1 << bit < self.geometry.start_alignment_bytes:
                continue
            moved = Signal(len(now) + (8 << bit), name=f"moved_{1 << bit}")
            m.d.comb += moved.eq(Mux(rest[bit], now << (8 << bit), now))
            now = moved
        return now

    def _position(self, m: Module, rest: Value) -> Signal:
        """Return the position of the word behind the encapsulation header, modulo 8."""
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
