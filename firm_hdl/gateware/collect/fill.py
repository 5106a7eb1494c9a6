"""The two words that the collector hands to the packer: their bytes, sizes and distances."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from amaranth.hdl import Cat, Const, Mux, Signal, Value
from amaranth.lib import stream

from firm_hdl.gateware.collect.state import CollectState
from firm_hdl.gateware.positions import Ring, any_of, pick
from firm_hdl.program import WireByte, align_addend

__all__ = ["Filler"]


class Filler:
    """Fill the words of each step. Not a component: logic of one module.

    While `state.free`, sizes are written in every cycle, and bytes until their leaf is taken.
    `words.valid` becomes high one cycle after `state.complete`. The collector writes `error`.

    Parameters
    ----------
    state : CollectState
    words : stream.Interface
        See :func:`words_layout`.
    """

    def __init__(self, state: CollectState, words: stream.Interface):
        self.m, self.state, self.words = state.m, state, words
        self.plan, self.step = state.plan, state.step
        lengths = state.program.lengths.values()
        self.counts_nul = {each.leaf for each in lengths if each.has_nul}
        self._write_bytes()
        self._compute_sizes()

    # Bytes.

    def _write_bytes(self) -> None:
        """Write the bytes that the step selects to the words, until their leaf is taken."""
        m, state = self.m, self.state
        lanes: dict[str, list[dict[int, WireByte]]] = {}
        for each in state.program.states:
            for name, found in (("items", each.items), ("map", each.map)):
                for lane, byte in found:
                    word = lanes.setdefault(name, [{} for _ in range(self.plan.bus_bytes)])
                    word[lane][each.number] = byte
        for name, word in lanes.items():
            for lane, stretch in _stretches(word):
                cases = stretch[0]
                register = Signal(8 * len(stretch), name=f"{name}_{lane}", reset_less=True)
                taken = [
                    any_of([self.step[i] for i, byte in cases.items() if byte.slot == slot]) & flag
                    for slot, flag in enumerate(state.served)
                    if any(byte.slot == slot for byte in cases.values())
                ]
                with m.If(state.free & ~any_of(taken)):
                    m.d.sync += register.eq(self._selected(stretch))
                bits = getattr(self.words.payload, name)[8 * lane :]
                m.d.comb += bits[: len(register)].eq(register)

    def _selected(self, stretch: list[dict[int, WireByte]]) -> Value:
        """Return the bytes of a stretch that the step selects; don't care if there are none."""
        size = len(stretch)
        groups: dict[tuple[int, int], tuple[Value, list[Value]]] = {}
        for index, byte in stretch[0].items():
            if byte.leaf is None:
                constant = sum(lane[index].at << 8 * k for k, lane in enumerate(stretch))
                key, value = (-1, constant), Value.cast(Const(constant, 8 * size))
            else:
                key = (byte.leaf, byte.at)
                value = self._wire_bits(byte.leaf)[8 * byte.at : 8 * (byte.at + size)]
            groups.setdefault(key, (value, []))[1].append(self.step[index])
        found = [(any_of(on), value) for value, on in groups.values()]
        return found[0][1] if len(found) == 1 else pick(found, 8 * size)

    def _wire_bits(self, leaf: int) -> Value:
        """Return the bits of a leaf's transfer on the wire."""
        plan, payload = self.plan, self.state.streams[leaf].payload
        match plan.leaves[leaf].kind:
            case "items":
                return Cat(_item_bits(item) for item in payload.data)
            case "length":
                return (payload + (leaf in self.counts_nul))[:32]
            case _:
                return _item_bits(payload)

    # Sizes.

    def _compute_sizes(self) -> None:
        """Compute the sizes of the words, and the distances between their positions."""
        m, state, traits, bus = self.m, self.state, self.state.traits, self.plan.bus_bytes
        words, ring = self.words.payload, Ring(self.plan)
        items = Signal(range(bus + 1), name="items_size")
        map_size = Signal(range(2 * bus + 1), name="map_size")
        nul = Signal(name="nul_now")
        # Whether the packet has a byte before this step, and whether it has one after the step.
        begun, begins = Signal(name="begun"), Signal(name="begins")
        m.d.comb += [
            items.eq(Mux(traits.takes_rest, state.flow.rest_bytes(state.rest), traits.items_bytes)),
            map_size.eq(traits.map_bytes + Mux(traits.two_word_map, bus, 0)),
            nul.eq(state.has_nul & traits.takes_rest),
            begins.eq(begun | items.any() | nul | traits.map_bytes.any()),
        ]
        with m.If(state.complete):
            m.d.sync += begun.eq(begins & ~state.ends)
        addend, mask = self._items_align()
        to_end = Signal.like(words.to_end, name="to_end")
        end_mask = Signal(max(3, ring.lane_bits), name="end_mask")
        to_map = Signal.like(words.to_map, name="to_map")
        m.d.comb += to_map.eq(Mux(traits.two_word_map, 0, items) + nul + traits.map_addend)
        with m.If(state.ends):
            m.d.comb += [to_end.eq(Mux(begins, map_size + (bus - 1), bus)), end_mask.eq(bus - 1)]
        with m.Else():
            m.d.comb += [to_end.eq(map_size + addend), end_mask.eq(mask)]
        with m.If(state.free):
            m.d.sync += [
                self.words.valid.eq(state.complete),
                words.items_bytes.eq(items),
                words.map_bytes.eq(traits.map_bytes),
                words.lead.eq(traits.two_word_map),
                words.to_map.eq(to_map),
                words.max_beats.eq((to_map + to_end + (bus - 1)) >> ring.lane_bits),
                words.map_mask.eq(traits.map_mask),
                words.to_end.eq(to_end),
                words.end_mask.eq(end_mask),
                words.last.eq(state.ends),
                words.empty.eq(~begins),
                words.waits.eq(state.flow.on(lambda s: s.precedes_leaves)),
            ]

    def _items_align(self) -> tuple[Value, Value]:
        """Return the addend and the mask that align the first item of the run that the step begins.

        Both are 3 bits, and 0 for an empty run, which has no padding.
        """
        plan = self.plan
        cases: list[tuple[Value, int, int]] = []
        for index, length in self.state.program.lengths.items():
            if length.align > 1:
                align = length.align
                addend = align_addend(align, plan.header_bytes) if plan.bus_bytes >= 8 else 0
                not_empty = self.step[index] & ~self.state.lengths[length.leaf].zero
                cases.append((not_empty, addend, align - 1))
        return (
            pick([(not_empty, addend) for not_empty, addend, _ in cases], 3),
            pick([(not_empty, mask) for not_empty, _, mask in cases], 3),
        )


def _stretches(word: list[dict[int, WireByte]]) -> Iterator[tuple[int, list[dict[int, WireByte]]]]:
    """Divide a word into stretches of lanes with common selects; yield first lane and stretch."""
    first = 0
    for lane in range(1, len(word) + 1):
        if lane < len(word) and _follows(word[lane - 1], word[lane]):
            continue
        if word[first]:
            yield first, word[first:lane]
        first = lane


def _follows(before: dict[int, WireByte], after: dict[int, WireByte]) -> bool:
    """Tell whether two lanes have consecutive bytes of the same leaves in the same steps."""
    return before.keys() == after.keys() and all(
        after[index] == replace(byte, at=byte.at + 1)
        if byte.leaf is not None
        else after[index].leaf is None
        for index, byte in before.items()
    )


def _item_bits(item: Value) -> Value:
    """Return the bits of an item on the wire; a bool is extended to a byte."""
    value = Value.cast(item)
    return Cat(value, Const(0, -len(value) % 8))
