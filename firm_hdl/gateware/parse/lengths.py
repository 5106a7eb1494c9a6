"""Predecode: a length in every lane where one can end, decoded as beats arrive.

The sequencer has one cycle from a length to the position after the items that the length counts.
So all that follows from the value alone is computed here, before the sequencer needs it:
comparisons, the size of the rest, and the position of the next state. The sequencer then selects an
entry by its position, and columns of the entry by its state.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.flow import Flow, exceeds, last_word
from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.positions import (
    Ring,
    align_up,
    any_of,
    beat_layout,
    constant_low_lane_bits,
    named,
    pick,
)
from firm_hdl.names.attributes import REMARK
from firm_hdl.program import DeserializerProgram, DeserializerState, Length, lane_remark

__all__ = ["Lengths", "StepLength", "length_of_step"]

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
    key : In(position)
        Last byte of a length.
    entry : Out
        The columns that :class:`Length` names, and `zero`.
    count : Out(count_bits)
        The length that was looked up in the cycle before. The number is not needed earlier, and its
        memories do not load `key`, which is late in the cycle.
    """

    def __init__(self, program: DeserializerProgram):
        self.program, self.plan, self.ring = program, program.plan, Ring(program.plan)
        columns = {"zero": 1}
        for each in program.lengths.values():
            columns |= {each.over: 1, each.skips: 1}
            columns |= {each.at_most_one_pass: 1, each.two_passes: 1}
            if each.charged is not None:
                columns[each.charged] = 1
            if each.level is None:
                columns[each.rest] = each.lanes.bit_length()
                columns |= {
                    each.next_last_at(following): self.ring.bits for following in each.nexts
                }
        self.layout = data.StructLayout(columns)
        super().__init__(
            {
                "beat": In(beat_layout(self.plan)),
                "key": In(self.ring.bits),
                "entry": Out(self.layout),
                "count": Out(program.count_bits),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        ring, lanes = self.ring, tuple(self.program.length_lanes)
        phase = self._phase(m)
        # The first bytes of a length may be in earlier beats. A lane stands for its last byte:
        #
        #   history | a b c | beat 0 1 2 3 4 5 6 7      lane 1: b c 0 1, lane 7: 4 5 6 7
        #
        history: Value = Const(0, 8 * (LENGTH_BYTES - 1))
        if any(lane < LENGTH_BYTES - 1 for lane in lanes):
            history = Signal(len(history), name="history", reset_less=True)
        stream = Cat(history, self.beat.data)
        if isinstance(history, Signal):
            with m.If(self.beat.valid):
                m.d.sync += history.eq(stream[-len(history) :])
        entries, counts = [], []
        key = ring.position("key_before")
        m.d.sync += key.eq(self.key)
        for lane in lanes:
            length = Signal(8 * LENGTH_BYTES, name=f"length_{lane}")
            entry = Signal(
                self.layout,
                name=f"entry_{lane}",
                attrs={REMARK: lane_remark(self.program, lane)},
            )
            m.d.comb += length.eq(stream[8 * lane : 8 * (lane + LENGTH_BYTES)])
            self._decode(m, length, lane, phase, entry)
            entries.append(self._store(m, f"entry_{lane}_table", Value.cast(entry), self.key))
            counts.append(self._store(m, f"count_{lane}_table", length[: len(self.count)], key))
        # Select the lane of the key. Only lanes in which lengths end occur, so the last one needs
        # no comparison, and bits that all of them share are not compared.
        _, constant = constant_low_lane_bits(lanes, self.plan.bus_bytes)
        selections = (Value.cast(self.entry), self.key, entries), (self.count, key, counts)
        for target, at, values in selections:
            with m.Switch(ring.lane(at)[constant:]):
                for lane, value in zip(lanes[:-1], values, strict=False):
                    with m.Case(lane >> constant):
                        m.d.comb += target.eq(value)
                with m.Default():
                    m.d.comb += target.eq(values[-1])
        return m

    def _phase(self, m: Module) -> Value | int:
        """Return the position after the encapsulation header of the beat's packet, modulo 8.

        Packets start at a bus word; so the position is a constant on a bus of 8 bytes or more.
        """
        header, beat = self.plan.header_bytes, self.beat
        if self.plan.bus_bytes >= 8 or not self.program.aligns:
            return header
        phase = Signal(3, name="phase", init=header % 8)
        with m.If(beat.valid & beat.last):
            at = Cat(Const(0, self.ring.lane_bits), beat.at)
            m.d.sync += phase.eq(at + self.plan.bus_bytes + header)
        return phase

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

    def _decode(
        self, m: Module, length: Signal, lane: int, phase: Value | int, entry: data.View
    ) -> None:
        """Decode all columns of an entry, as if a length ended in a lane of the beat."""
        # Every lane is decoded in every beat, whether or not a length ends there: an entry that is
        # no length is never looked up. So no decision about the packet comes before the write.
        zero = ~named(m, f"length_{lane}_not_0", length.any())
        columns: dict[str, Value] = {"zero": zero}
        for each in self.program.lengths.values():
            over = exceeds(length, each.max_count)
            # An illegal length skips the body, too: then the state takes an exit, and the error
            # code is all that remains of the length.
            if each.level is not None:
                skips = Const(1, 1) if each.counts_nothing else zero
                one, two = length == 1, length == 2
            else:
                # A word and its NUL are the rest, so n passes take n words more.
                skips, one, two = (
                    ~exceeds(length, n * each.lanes + each.most_in_rest) for n in range(3)
                )
                if each.rest not in columns:
                    nul = int(each.has_nul)
                    items = last_word(length[:8] - nul, each.lanes)
                    columns[each.rest] = Mux(exceeds(length, nul), items, 0)
                columns |= self._next_last_at(m, length, lane, phase, each, columns)
            columns |= {
                each.over: over,
                each.skips: skips | over,
                each.at_most_one_pass: one,
                each.two_passes: two,
            }
            if each.charge is not None and each.charged is not None:
                columns[each.charged] = exceeds(length, each.charge.charged_from - 1)
        m.d.comb += [entry[name].eq(value) for name, value in columns.items()]

    def _next_last_at(
        self,
        m: Module,
        length: Signal,
        lane: int,
        phase: Value | int,
        of: Length,
        known: dict[str, Value],
    ) -> dict[str, Value]:
        """Return the last byte of each next state, if no word comes before the rest."""
        nexts = {of.next_last_at(each): each for each in of.nexts}
        if nexts.keys() <= known.keys():
            return {}
        ring = self.ring
        items_name = f"items_{lane}_{of.kind}"
        items = Signal(ring.bits, name=items_name)
        items_end = Signal(ring.bits, name=f"items_end_{lane}_{of.kind}")
        beat = Cat(Const(0, ring.lane_bits), self.beat.at)
        count = length[: of.most_in_rest.bit_length()]
        aligned = align_up(m, items_name, beat, lane + 1, of.align, phase)
        # An empty run has no padding.
        m.d.comb += [
            items.eq(Mux(length.any(), aligned, beat + (lane + 1)) if of.align > 1 else aligned),
            items_end.eq(items + (count << (of.item_bytes.bit_length() - 1))),
        ]
        return {
            name: align_up(
                m, f"entry_{lane}_{name}", items_end, 0, each.align, phase, each.last_offset
            )
            for name, each in nexts.items()
            if name not in known
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class StepLength:
    """The length of the current state.

    All values are combinational, from registers and the table. In a state without a length,
    `run_skips`, `loop_skips` and `charged` are 0, and the other values have no meaning.
    """

    # The columns that `Length` names; `None` if the program has no lengths.
    entry: data.View | None
    count: Value  # The length on the wire, a cycle later. It includes the NUL of a CDR `string`.
    # The length is 0; the length is above the largest legal value.
    zero: Value
    over: Value
    charged: Value  # The length is legal by itself, and large enough to be charged to the budget.
    # The body of the run or of the loop is skipped: no element, no word before the rest, or an
    # illegal length.
    run_skips: Value
    loop_skips: Value
    # Passes of the body; `two_passes` is valid only if the other one is 0.
    at_most_one_pass: Value
    two_passes: Value
    rest: Value  # Items in the rest.


def length_of_step(
    m: Module,
    program: DeserializerProgram,
    flow: Flow[DeserializerState],
    beat: Value,
    last_at: Value,
) -> StepLength:
    """Return the length of the current state, of which `last_at` is the last byte."""
    lengths = program.lengths
    if not lengths:
        names = [field.name for field in fields(StepLength)]
        return StepLength(**{**dict.fromkeys(names, Const(0, 1)), "entry": None})
    m.submodules.lengths = table = Lengths(program)
    m.d.comb += [Value.cast(table.beat).eq(beat), table.key.eq(last_at)]
    entry = table.entry

    def chosen(column: str, states: list[Value]) -> Value:
        """Return, by name, whether the length of the state has a column."""
        return (
            states[0]
            if len(states) == 1
            else named(m, f"has_{column.removeprefix('over_')}", any_of(states))
        )

    def select(
        column: Callable[[Length], str | None], width: int = 1, *, exact: bool = False
    ) -> Value:
        """Select a column by the state; 0 in states that have none, if `exact`."""
        states: dict[str, list[Value]] = {}
        for number, length in lengths.items():
            name = column(length)
            if name is not None:
                states.setdefault(name, []).append(flow.step[number])
        cases = [(chosen(name, on), Value.cast(entry[name])) for name, on in states.items()]
        return cases[0][1] if len(cases) == 1 and not exact else pick(cases, width)

    over = select(lambda each: each.over)
    values = {
        "over": over,
        "charged": select(lambda each: each.charged, exact=True) & ~over,
        "run_skips": select(lambda each: each.skips if each.level is None else None, exact=True),
        "loop_skips": select(lambda each: None if each.level is None else each.skips, exact=True),
        "at_most_one_pass": select(lambda each: each.at_most_one_pass),
        "two_passes": select(lambda each: each.two_passes),
        "rest": select(lambda each: each.rest if each.level is None else None, program.rest_bits),
    }
    selected = {name: named(m, f"length_{name}", value) for name, value in values.items()}
    return StepLength(entry=entry, count=table.count, zero=entry.zero, **selected)
