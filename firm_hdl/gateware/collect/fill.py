"""The two words that the collector hands to the packer: their bytes, sizes and distances."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from amaranth.hdl import Cat, Const, Mux, Signal, Value
from amaranth.lib import stream

from firm_hdl.gateware.collect.state import CollectState
from firm_hdl.gateware.positions import Ring, align_addend, any_of, pick
from firm_hdl.plan import BeginRun, Fixed, Part, RunStep, Step
from firm_hdl.plan.geometry import first_step

__all__ = ["Filler"]


@dataclass(frozen=True, slots=True)
class _Byte:
    """A byte of a step's words.

    Attributes
    ----------
    leaf : int or None
        Index of the leaf that the byte belongs to; `None` for a constant.
    at : int
        Number of the byte in the transfer, or the value of the constant.
    slot : int
        Number of the byte's transfer in the step; -1 for a constant, or if a later step takes the
        transfer.
    """

    leaf: int | None
    at: int
    slot: int


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
        self._write_bytes()
        self._compute_sizes()

    # Bytes.

    def _write_bytes(self) -> None:
        """Write the bytes that the step selects to the words, until their leaf is taken."""
        m, state = self.m, self.state
        lanes: dict[str, list[dict[int, _Byte]]] = {}
        for index, step in enumerate(self.plan.steps):
            for name, lane, byte in self._bytes(step):
                word = lanes.setdefault(name, [{} for _ in range(self.plan.bus_bytes)])
                word[lane][index] = byte
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

    def _selected(self, stretch: list[dict[int, _Byte]]) -> Value:
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

    def _bytes(self, step: Step) -> Iterator[tuple[str, int, _Byte]]:
        """Yield the bytes of a step's words: the word, the lane, and the byte."""
        plan, bus = self.plan, self.plan.bus_bytes
        slot = 0
        if step.rest is not None:
            yield from (("items", *each) for each in self._word(plan.runs[step.rest].items, slot))
            slot += 1
        for item in step.slices:
            found = [_Byte(None, 0, -1)] * item.bytes
            if isinstance(item, Fixed):
                found = [_Byte(None, value, -1) for value in item.data]
            elif isinstance(item, Part):
                number = slot if item.completes else -1
                found = [_Byte(item.leaf, item.first + k, number) for k in range(item.bytes)]
                slot += item.completes
            for k, byte in enumerate(found, item.at):
                name = "items" if step.bytes > bus > k else "map"
                yield name, k % bus if step.bytes > bus else k, byte
        if isinstance(step, RunStep):
            run = plan.runs[step.run]
            name = "items" if run.counted else "map"
            yield from ((name, *each) for each in self._word(run.items, slot))

    def _word(self, leaf: int, slot: int) -> Iterator[tuple[int, _Byte]]:
        """Yield the bytes of a transfer of items, with their lanes."""
        items = self.plan.leaves[leaf]
        return ((k, _Byte(leaf, k, slot)) for k in range(items.lanes * items.item_bytes))

    def _wire_bits(self, leaf: int) -> Value:
        """Return the bits of a leaf's transfer on the wire."""
        plan, payload = self.plan, self.state.streams[leaf].payload
        match plan.leaves[leaf].kind:
            case "items":
                return Cat(_item_bits(item) for item in payload.data)
            case "length":
                return (payload + plan.has_nul(plan.begins[leaf]))[:32]
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
                words.waits.eq(any_of([self.step[i] for i in range(first_step(self.plan))])),
            ]

    def _items_align(self) -> tuple[Value, Value]:
        """Return the addend and the mask that align the first item of the run that the step begins.

        Both are 3 bits, and 0 for an empty run, which has no padding.
        """
        plan = self.plan
        cases: list[tuple[Value, int, int]] = []
        for index, step in enumerate(plan.steps):
            if isinstance(step.begin, BeginRun) and step.begin.align > 1:
                align = step.begin.align
                addend = align_addend(align, plan.header_bytes) if plan.bus_bytes >= 8 else 0
                not_empty = self.step[index] & ~self.state.lengths[step.begin.length].zero
                cases.append((not_empty, addend, align - 1))
        return (
            pick([(not_empty, addend) for not_empty, addend, _ in cases], 3),
            pick([(not_empty, mask) for not_empty, _, mask in cases], 3),
        )


def _stretches(word: list[dict[int, _Byte]]) -> Iterator[tuple[int, list[dict[int, _Byte]]]]:
    """Divide a word into stretches of lanes with common selects; yield first lane and stretch."""
    first = 0
    for lane in range(1, len(word) + 1):
        if lane < len(word) and _follows(word[lane - 1], word[lane]):
            continue
        if word[first]:
            yield first, word[first:lane]
        first = lane


def _follows(before: dict[int, _Byte], after: dict[int, _Byte]) -> bool:
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
