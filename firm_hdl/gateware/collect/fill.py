"""The two words that the collector hands to the packer: their bytes, sizes and distances."""

from __future__ import annotations

from collections.abc import Iterator

from amaranth.hdl import Cat, Const, Mux, Signal, Value
from amaranth.lib import stream

from firm_hdl.gateware.collect.progress import Progress
from firm_hdl.gateware.positions import Ring, any_of, pick, raised_by
from firm_hdl.plan import BeginRun, Fixed, Part, RunStep, Step

__all__ = ["Filler"]


class Filler:
    """Fill the words of each step. Not a component: logic of one module.

    It writes `words` in every cycle in which `now.free`, and `words.valid` with `now.complete`.

    Parameters
    ----------
    now : Progress
    words : stream.Interface
        See :func:`words_layout`.
    """

    def __init__(self, now: Progress, words: stream.Interface):
        self.m, self.now, self.words = now.m, now, words
        self.plan, self.step = now.plan, now.step
        self._gather()
        self._measure()

    def _gather(self) -> None:
        """Select each byte of the words by the step, until its leaf is taken."""
        m = self.m
        lanes: dict[tuple[str, int], list[tuple[int, int, Value | int]]] = {}
        for index, step in enumerate(self.plan.steps):
            for name, lane, slot, value in self._bytes(step):
                lanes.setdefault((name, lane), []).append((index, slot, value))
        for (name, lane), cases in lanes.items():
            byte = Signal(8, name=f"{name}_{lane}", reset_less=True)
            taken = [
                any_of([self.step[i] for i, s, _ in cases if s == slot]) & flag
                for slot, flag in enumerate(self.now.served)
                if any(s == slot for _, s, _ in cases)
            ]
            with m.If(self.now.free & ~any_of(taken)):
                m.d.sync += byte.eq(self._byte([(i, value) for i, _, value in cases]))
            m.d.comb += getattr(self.words.payload, name)[8 * lane : 8 * lane + 8].eq(byte)

    def _byte(self, cases: list[tuple[int, Value | int]]) -> Value:
        """Select a byte by the step; don't care where the step has no such byte."""
        groups: dict[str, tuple[Value | int, list[Value]]] = {}
        for index, value in cases:
            groups.setdefault(repr(value), (value, []))[1].append(self.step[index])
        found = [(any_of(on), value) for value, on in groups.values()]
        if len(found) == 1:
            ((_, value),) = found
            return Const(value, 8) if isinstance(value, int) else value
        return pick(found, 8)

    def _bytes(self, step: Step) -> Iterator[tuple[str, int, int, Value | int]]:
        """Yield the bytes of a step's words: the word, the lane, the slot, and the value.

        Bytes that are not of a transfer that this step takes have the slot -1.
        """
        plan, bus = self.plan, self.plan.bus_bytes
        slot = 0
        if step.rest is not None:
            items = self._word(plan.runs[step.rest].items)
            yield from (("items", k, slot, byte) for k, byte in enumerate(items))
            slot += 1
        for item in step.slices:
            where = -1
            values: list[Value | int] = [0] * item.bytes
            if isinstance(item, Fixed):
                values = list(item.data)
            elif isinstance(item, Part):
                bits = self._bits(item)
                first = item.first
                values = [bits[8 * k : 8 * k + 8] for k in range(first, first + item.bytes)]
                where = slot if item.completes else -1
                slot += item.completes
            for k, value in enumerate(values, item.at):
                name = "items" if step.bytes > bus > k else "map"
                yield name, k % bus if step.bytes > bus else k, where, value
        if isinstance(step, RunStep):
            run = plan.runs[step.run]
            name = "items" if run.counted else "map"
            for k, byte in enumerate(self._word(run.items)):
                yield name, k, slot, byte

    def _word(self, leaf: int) -> list[Value]:
        """Return the bytes of a transfer of items."""
        bits = Cat(_wire_bits(item) for item in self.now.streams[leaf].payload.data)
        return [bits[k : k + 8] for k in range(0, len(bits), 8)]

    def _bits(self, part: Part) -> Value:
        """Return a transfer's bits on the wire."""
        plan, payload = self.plan, self.now.streams[part.leaf].payload
        match plan.leaves[part.leaf].kind:
            case "items":
                return Cat(_wire_bits(item) for item in payload.data)
            case "length":
                return (payload + plan.has_nul(plan.counted[part.leaf]))[:32]
            case _:
                return _wire_bits(payload)

    def _measure(self) -> None:
        """Compute the sizes of the words, and their distances."""
        m, now, state, bus = self.m, self.now, self.now.state, self.plan.bus_bytes
        words, ring = self.words.payload, Ring(self.plan)
        items = Signal(range(bus + 1), name="items_size")
        whole = Signal(range(2 * bus + 1), name="map_size")
        nul = Signal(name="nul_now")
        # The packet has bytes in front of this step, and behind it.
        begun, begins = Signal(name="begun"), Signal(name="begins")
        m.d.comb += [
            items.eq(Mux(state.rest, now.flow.rest_bytes(now.rest), state.items_bytes)),
            whole.eq(state.map_bytes + Mux(state.lead, bus, 0)),
            nul.eq(now.has_nul & state.rest),
            begins.eq(begun | items.any() | nul | state.map_bytes.any()),
        ]
        with m.If(now.complete):
            m.d.sync += begun.eq(begins & ~now.ends)
        raised, mask = self._items_align()
        to_end = Signal.like(words.to_end, name="to_end")
        end_mask = Signal(max(3, ring.lane_bits), name="end_mask")
        to_map = Signal.like(words.to_map, name="to_map")
        m.d.comb += to_map.eq(Mux(state.lead, 0, items) + nul + state.raised)
        with m.If(now.ends):
            m.d.comb += [to_end.eq(Mux(begins, whole + (bus - 1), bus)), end_mask.eq(bus - 1)]
        with m.Else():
            m.d.comb += [to_end.eq(whole + raised), end_mask.eq(mask)]
        with m.If(now.free):
            m.d.sync += [
                self.words.valid.eq(now.complete),
                words.items_bytes.eq(items),
                words.map_bytes.eq(state.map_bytes),
                words.lead.eq(state.lead),
                words.to_map.eq(to_map),
                words.max_beats.eq((to_map + to_end + (bus - 1)) >> ring.lane_bits),
                words.map_mask.eq(state.mask),
                words.to_end.eq(to_end),
                words.end_mask.eq(end_mask),
                words.last.eq(now.ends),
                words.empty.eq(~begins),
            ]

    def _items_align(self) -> tuple[Value, Value]:
        """Return what aligns the items that the step counts: an addend, and the mask.

        An empty run has no padding.
        """
        plan = self.plan
        cases: list[tuple[Value, int, int]] = []
        for index, step in enumerate(plan.steps):
            if isinstance(step.begin, BeginRun) and step.begin.align > 1:
                align = step.begin.align
                raised = raised_by(align, plan.header_bytes) if plan.bus_bytes >= 8 else 0
                some = self.step[index] & ~self.now.lengths[step.begin.length].zero
                cases.append((some, raised, align - 1))
        return (
            pick([(some, raised) for some, raised, _ in cases], 3),
            pick([(some, mask) for some, _, mask in cases], 3),
        )


def _wire_bits(item: Value) -> Value:
    """Return an item's bits on the wire; a bool takes a whole byte."""
    value = Value.cast(item)
    return Cat(value, Const(0, -len(value) % 8))
