"""Predecode: a length in every lane where one can end, decoded as beats arrive.

The sequencer has one cycle from a length to the position after the items that the length counts.
So all that follows from the value alone is computed here, before the sequencer needs it:
comparisons, the size of the rest, and the position of the next step. The sequencer then selects an
entry by its position, and fields of the entry by its step.
"""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.flow import exceeds, last_word
from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import Ring, align_up, beat_layout, known_lane_bits
from firm_hdl.program import DeserializerProgram, Length

__all__ = ["Lengths"]

LENGTH_BYTES = 4


class Lengths(wiring.Component):
    """A table of decoded lengths, by the position of a length's last byte.

    An entry is written together with the beat of that byte. Each lane in which a length can end
    has a memory of its own. Entries are read combinationally.

    Parameters
    ----------
    program : DeserializerProgram

    Members
    -------
    beat : In(beat_layout(plan))
        The beat that is written to the packet buffer in this cycle.
    phase : In(3)
        Position after the encapsulation header of the beat's packet, modulo 8. Not used on a bus
        of 8 bytes or more.
    key : In(position)
        Last byte of a length.
    entry : Out
        The fields that :class:`Length` names, and `zero`.
    count : Out
        The length that was looked up in the cycle before, as wide as legal values. The number is
        not needed earlier, and its memories do not load `key`, which is late in the cycle.
    """

    def __init__(self, program: DeserializerProgram):
        self.plan, self.ring, self.lanes = program.plan, Ring(program.plan), program.length_lanes
        self.lengths = list(program.lengths.values())
        self.layout = data.StructLayout(self._fields())
        self.count_bits = max((each.max_count.bit_length() for each in self.lengths), default=1)
        super().__init__(
            {
                "beat": In(beat_layout(self.plan)),
                "phase": In(3),
                "key": In(self.ring.bits),
                "entry": Out(self.layout),
                "count": Out(self.count_bits),
            }
        )

    def _fields(self) -> dict[str, int]:
        fields = {"zero": 1}
        for each in self.lengths:
            fields |= {each.over: 1, each.skips: 1, each.single: 1, each.double: 1}
            if each.counted is not None:
                fields[each.counted] = 1
            if each.level is None:
                fields[each.rest] = each.lanes.bit_length()
                for following in each.nexts:
                    fields[each.next_last(following)] = self.ring.bits
        return fields

    def elaborate(self, platform: object) -> Module:
        m = Module()
        ring = self.ring
        # The first bytes of a length may be in earlier beats.
        history = Signal(8 * (LENGTH_BYTES - 1), reset_less=True)
        stream = Cat(history, self.beat.data)
        with m.If(self.beat.valid):
            m.d.sync += history.eq(stream[-len(history) :])
        entries, counts = [], []
        key = ring.position("key_before")
        m.d.sync += key.eq(self.key)
        for lane in self.lanes:
            length = Signal(8 * LENGTH_BYTES, name=f"length_{lane}")
            entry = Signal(self.layout, name=f"entry_{lane}")
            m.d.comb += length.eq(stream[8 * lane : 8 * (lane + LENGTH_BYTES)])
            self._decode(m, length, lane, entry)
            entries.append(self._store(m, f"entry_{lane}", Value.cast(entry), self.key))
            counts.append(self._store(m, f"count_{lane}", length[: self.count_bits], key))
        self._select(m, Value.cast(self.entry), self.key, entries)
        self._select(m, self.count, key, counts)
        return m

    def _store(self, m: Module, name: str, value: Value, key: Value) -> Value:
        """Write a value with each beat; return that of the beat with `key`."""
        ring = self.ring
        memory = LutMemory(m, name, len(value), ring.depth)
        write, read = memory.write, memory.reader()
        m.d.comb += [
            write.addr.eq(self.beat.at),
            write.data.eq(value),
            write.en.eq(self.beat.valid),
            read.addr.eq(ring.slot(key)),
        ]
        return read.data

    def _select(self, m: Module, target: Value, key: Value, values: list[Value]) -> None:
        """Select the value of the lane of `key`; only lanes in which lengths end occur."""
        _, known = known_lane_bits(self.lanes, self.plan.bus_bytes)
        lane = self.ring.lane(key)[known:]
        with m.Switch(lane):
            for number, value in zip(self.lanes[:-1], values, strict=False):
                with m.Case(number >> known):
                    m.d.comb += target.eq(value)
            with m.Default():
                m.d.comb += target.eq(values[-1])

    def _decode(self, m: Module, length: Signal, lane: int, entry: data.View) -> None:
        zero = ~length.any()
        m.d.comb += entry.zero.eq(zero)
        for each in self.lengths:
            over = exceeds(length, each.max_count)
            if each.level is not None:
                skips = Const(1, 1) if each.counts_nothing else zero
                single, double = length == 1, length == 2
            else:
                lanes, word = each.lanes, each.word
                skips, single, double = (~exceeds(length, n * lanes + word) for n in range(3))
                m.d.comb += entry[each.rest].eq(self._rest(length, lanes, each.has_nul))
                self._places(m, length, lane, entry, each)
            m.d.comb += [
                entry[each.over].eq(over),
                entry[each.skips].eq(skips | over),
                entry[each.single].eq(single),
                entry[each.double].eq(double),
            ]
            if each.claim is not None:
                m.d.comb += entry[each.counted].eq(exceeds(length, each.claim.least - 1))

    @staticmethod
    def _rest(length: Value, lanes: int, nul: int) -> Value:
        """Return the number of items in the last word; 0 if the length counts no item."""
        return Mux(exceeds(length, nul), last_word(length[:8] - nul, lanes), 0)

    def _places(self, m: Module, length: Signal, lane: int, entry: data.View, each: Length) -> None:
        """Decode the last byte of the next step, if no word comes before the rest."""
        ring = self.ring
        phase: Value | int = self.plan.header_bytes if self.plan.bus_bytes >= 8 else self.phase
        items = Signal(ring.bits, name=f"items_{lane}_{each.kind}")
        items_end = Signal(ring.bits, name=f"items_end_{lane}_{each.kind}")
        beat = Cat(Const(0, ring.lane_bits), self.beat.at)
        count = length[: each.word.bit_length()]
        first_align = each.align
        aligned = align_up(m, beat, lane + 1, first_align, phase)
        m.d.comb += [
            items.eq(Mux(length.any(), aligned, beat + (lane + 1)) if first_align > 1 else aligned),
            items_end.eq(items + (count << (each.item_bytes.bit_length() - 1))),
        ]
        for following in each.nexts:
            last = align_up(m, items_end, 0, following.align, phase, following.last_offset)
            m.d.comb += entry[each.next_last(following)].eq(last)
