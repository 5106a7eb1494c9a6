"""The collector: leaves of a message to words, as the plan says."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.flow import Flow, exceeds
from firm_hdl.gateware.positions import Ring, any_of, pick, raised_by
from firm_hdl.gateware.signatures import Status, StatusSignature, leaf_shape
from firm_hdl.gateware.words import words_layout
from firm_hdl.plan import BeginLoop, BeginRun, Fixed, Part, Plan, RunStep, Step

__all__ = ["Collector"]

COUNT_BITS = 32
"""A length over its limit is counted, too."""


class Collector(wiring.Component):
    """Take the leaves of each step of a plan, and put them into two words.

    Leaves are taken in wire order, each as soon as it is offered. A length is decoded in the cycle
    before it is taken, so it is taken one cycle after it is offered at the earliest. Latency 1
    cycle from the last leaf of a step to its words.

    Parameters
    ----------
    plan : Plan

    Members
    -------
    leaf_0, leaf_1, ... : In(stream.Signature(leaf_shape(leaf)))
        `ready` depends on the `valid` of this leaf and of earlier ones of the same step.
    words : Out(stream.Signature(words_layout(plan)))
    status : Out(StatusSignature)
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        leaves = {
            f"leaf_{k}": In(stream.Signature(leaf_shape(leaf)))
            for k, leaf in enumerate(plan.leaves)
        }
        super().__init__(
            {
                **leaves,
                "words": Out(stream.Signature(words_layout(plan))),
                "status": Out(StatusSignature),
            }
        )

    def elaborate(self, platform: object) -> Module:
        return _Circuit(self).m


class _Length:
    """A length that is offered, decoded in registers.

    Attributes
    ----------
    known : Signal
        The fields are those of the length that is offered now.
    zero, over : Signal
    skips : Signal
        The body is skipped: there is none, or all of it is the rest.
    single : Signal
        The body is one element, or one word in front of the rest.
    rest : Signal
        Items of the rest.
    """

    def __init__(self, m: Module, plan: Plan, leaf: int, port: stream.Interface, taken: Value):
        begin, length = plan.counted[leaf], port.payload
        self.known = Signal(name=f"known_{leaf}")
        names = ("zero", "over", "skips", "single")
        self.zero, self.over, self.skips, self.single = (
            Signal(name=f"{name}_{leaf}", reset_less=True) for name in names
        )
        zero = ~length.any()
        m.d.sync += [
            self.known.eq(port.valid & ~taken),
            self.zero.eq(zero),
            self.over.eq(exceeds(length, begin.limit)),
        ]
        if isinstance(begin, BeginLoop):
            self.rest = Signal(1, name=f"rest_{leaf}")
            m.d.sync += [self.skips.eq(zero), self.single.eq(length == 1)]
            return
        lanes = plan.leaves[plan.runs[begin.run].items].lanes
        low = length[: lanes.bit_length() - 1]
        full = Mux(low.any(), low, lanes) if len(low) else Const(lanes)
        self.rest = Signal(range(lanes + 1), name=f"rest_{leaf}", reset_less=True)
        m.d.sync += [
            self.skips.eq(~exceeds(length, lanes)),
            self.single.eq(~exceeds(length, 2 * lanes)),
            self.rest.eq(Mux(zero, 0, full)),
        ]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Reader:
    """A transfer that a step takes.

    Attributes
    ----------
    leaf : int
    last : Value
        What `items.last` has to be.
    optional : bool
        It is the rest of a run, of which there may be none.
    """

    leaf: int
    last: Value
    optional: bool = False


class _Circuit:
    """The collector's logic, built by one method for each part of it."""

    def __init__(self, collector: Collector):
        self.c, self.plan = collector, collector.plan
        plan = self.plan
        self.m = m = Module()
        self.streams = [getattr(collector, f"leaf_{k}") for k in range(len(plan.leaves))]
        self.lengths = {
            leaf: _Length(m, plan, leaf, self.streams[leaf], self.streams[leaf].ready)
            for leaf in plan.counted
        }
        self.flow = self._flow()
        self.state, self.step = self.flow.state, self.flow.step
        lanes = max((plan.leaves[run.items].lanes for run in plan.runs), default=1)
        # Items of the rest of a run, and whether a NUL follows them.
        self.rest, self.has_nul = Signal(range(lanes + 1), name="rest"), Signal(name="has_nul")
        self.done, self.ends = Signal(name="done"), Signal(name="ends")
        # The words can be written; they are, and the step is left.
        self.free, self.complete = Signal(name="free"), Signal(name="complete")
        most = max(len(self._readers(step)) for step in plan.steps)
        self.served = [Signal(name=f"served_{k}") for k in range(most)]
        self._decide()
        self._serve()
        self._gather()
        self._measure()
        self._proceed()

    def _flow(self) -> Flow:
        size = self.plan.bus_bytes.bit_length()
        flags = "run_begin loop_begin words plain rest terminated lead"
        fields = {"map_bytes": size, "items_bytes": size, "mask": 3, "raised": 3}
        fields |= dict.fromkeys(flags.split(), 1)
        return Flow(self.m, self.plan, COUNT_BITS, fields, self._traits, has_end=False)

    def _traits(self, index: int | None) -> dict[str, int]:
        if index is None:
            return {}
        plan, bus = self.plan, self.plan.bus_bytes
        step = plan.steps[index]
        is_words = isinstance(step, RunStep)
        counted = isinstance(step, RunStep) and plan.runs[step.run].counted
        lead = step.bytes > bus
        begin = step.begin
        raised = step.align - 1 - plan.header_bytes % step.align if bus >= 8 else 0
        return {
            "map_bytes": bus if is_words and not counted else step.bytes - bus * lead,
            "items_bytes": bus if lead or counted else 0,
            "mask": step.align - 1,
            "raised": raised,
            "run_begin": isinstance(begin, BeginRun),
            "loop_begin": isinstance(begin, BeginLoop),
            "words": is_words,
            "plain": begin is None and not is_words,
            "rest": step.rest is not None,
            "terminated": isinstance(begin, BeginRun) and plan.runs[begin.run].terminated,
            "lead": lead,
        }

    def _select(
        self, field: Callable[[_Length], Value], width: int = 1, kind: type = object
    ) -> Value:
        """Select a field of the step's length; 0 if the step has none of the kind."""
        begins = ((i, step.begin) for i, step in enumerate(self.plan.steps))
        cases = [
            (self.step[i], field(self.lengths[begin.length]))
            for i, begin in begins
            if begin is not None and isinstance(begin, kind)
        ]
        return pick(cases, width)

    # The step.

    def _decide(self) -> None:
        m, flow, state, plan = self.m, self.flow, self.state, self.plan
        is_begin = state.run_begin | state.loop_begin
        skips = self._select(lambda length: length.skips)
        zero = self._select(lambda length: length.zero)
        # A last step that only takes a rest is left out where there is none.
        rests = {
            i
            for i, step in enumerate(plan.steps)
            if step.rest is not None and not step.bytes and step.exits.default.step is None
        }
        to_rest = any_of([taken for taken, _, jump in flow.exits if jump.step in rests])
        nothing = is_begin & zero & ~state.terminated & to_rest
        m.d.comb += [
            self.done.eq(state.plain | (is_begin & skips) | (state.words & flow.words.last)),
            self.ends.eq(self.done & (flow.exit_ends | nothing)),
        ]
        self.zero = zero

    def _readers(self, step: Step) -> list[_Reader]:
        """Return the transfers of a step, in wire order."""
        plan, flow = self.plan, self.flow
        found = []
        if step.rest is not None:
            last = Const(1, 1)
            found.append(_Reader(leaf=plan.runs[step.rest].items, last=last, optional=True))
        for part in step.parts:
            if part.completes:
                level = part.last_level
                last = Const(part.last, 1) if level is None else flow.levels[level].last
                found.append(_Reader(leaf=part.leaf, last=last))
        if isinstance(step, RunStep):
            run = plan.runs[step.run]
            last = Const(0, 1) if run.counted else flow.words.last & run.last
            found.append(_Reader(leaf=run.items, last=last))
        return found

    def _serve(self) -> None:
        """Take the leaves of a step in wire order, each as soon as it is offered.

        A producer may offer a leaf only after an earlier one was taken. So a step must not wait
        until all its leaves are offered; it remembers which are taken.
        """
        m, c = self.m, self.c
        goes: list[list[Value]] = [[] for _ in self.served]
        ready: dict[int, list[Value]] = {}
        missing: list[Value] = []
        wrong: list[Value] = []
        for index, step in enumerate(self.plan.steps):
            earlier: list[Value] = []
            for slot, reader in enumerate(self._readers(step)):
                port = self.streams[reader.leaf]
                valid = port.valid
                if reader.leaf in self.lengths:
                    valid = valid & self.lengths[reader.leaf].known
                left, lacks, go = (
                    Signal(name=f"{name}_{index}_{slot}") for name in ("left", "lacks", "go")
                )
                wanted = self.rest.any() if reader.optional else Const(1, 1)
                m.d.comb += [
                    left.eq(self.step[index] & wanted & ~self.served[slot]),
                    lacks.eq(left & ~valid),
                    go.eq(left & valid & self.free & ~any_of(earlier)),
                ]
                earlier.append(lacks)
                goes[slot].append(go)
                ready.setdefault(reader.leaf, []).append(go)
                if self.plan.leaves[reader.leaf].kind == "items":
                    wrong.append(go & (port.payload.last != reader.last))
            missing += earlier
            # A transfer that goes on in the next step is taken there.
            for part in step.parts:
                if not part.completes:
                    missing.append(self.step[index] & ~self.streams[part.leaf].valid)
            if not self._readers(step) and step.slices and index < self._first_step:
                # A packet begins only when the first leaf of its message is offered.
                missing.append(self.step[index] & ~self.streams[0].valid)
        for leaf, cases in ready.items():
            m.d.comb += self.streams[leaf].ready.eq(any_of(cases))
        status_free = ~c.status.valid | c.status.ready
        m.d.comb += [
            self.free.eq(~c.words.valid | c.words.ready),
            self.complete.eq(self.free & ~any_of(missing) & (~self.ends | status_free)),
        ]
        for flag, cases in zip(self.served, goes, strict=True):
            m.d.sync += flag.eq((flag | any_of(cases)) & ~self.complete)
        self._judge(any_of(wrong))

    @property
    def _first_step(self) -> int:
        """The first step with bytes of a leaf."""
        return next((i for i, step in enumerate(self.plan.steps) if step.parts), 0)

    def _judge(self, wrong_items: Value) -> None:
        """Keep the packet's first error, and report it with the last step."""
        m, c = self.m, self.c
        error, found = Signal(Status, name="error"), Signal(Status, name="found")
        took = any_of([self.streams[leaf].ready for leaf in self.lengths])
        over = took & self._select(lambda length: length.over)
        # In a step, items come before the length.
        m.d.comb += found.eq(error)
        with m.If((error == Status.OK) & wrong_items):
            m.d.comb += found.eq(Status.ITEMS)
        with m.Elif((error == Status.OK) & over):
            m.d.comb += found.eq(Status.LENGTH)
        m.d.sync += error.eq(found)
        with m.If(c.status.ready):
            m.d.sync += c.status.valid.eq(0)
        with m.If(self.complete & self.ends):
            m.d.sync += [
                c.status.valid.eq(1),
                c.status.payload.eq(found),
                error.eq(Status.OK),
            ]
        with m.If(self.free):
            m.d.sync += c.words.payload.error.eq(found != Status.OK)

    # The words.

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
                for slot, flag in enumerate(self.served)
                if any(s == slot for _, s, _ in cases)
            ]
            with m.If(self.free & ~any_of(taken)):
                m.d.sync += byte.eq(self._byte([(i, value) for i, _, value in cases]))
            m.d.comb += getattr(self.c.words.payload, name)[8 * lane : 8 * lane + 8].eq(byte)

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
            where, values = -1, [0] * item.bytes
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
        bits = Cat(_wire_bits(item) for item in self.streams[leaf].payload.data)
        return [bits[k : k + 8] for k in range(0, len(bits), 8)]

    def _bits(self, part: Part) -> Value:
        """Return a transfer's bits on the wire."""
        plan, payload = self.plan, self.streams[part.leaf].payload
        match plan.leaves[part.leaf].kind:
            case "items":
                return Cat(_wire_bits(item) for item in payload.data)
            case "length":
                return (payload + plan.has_nul(plan.counted[part.leaf]))[:32]
            case _:
                return _wire_bits(payload)

    def _measure(self) -> None:
        """Compute the sizes of the words, and their distances."""
        m, state, plan, bus = self.m, self.state, self.plan, self.plan.bus_bytes
        words, ring = self.c.words.payload, Ring(plan)
        items = Signal(range(bus + 1), name="items_size")
        whole = Signal(range(2 * bus + 1), name="map_size")
        nul = Signal(name="nul_now")
        # The packet has bytes in front of this step, and behind it.
        begun, begins = Signal(name="begun"), Signal(name="begins")
        m.d.comb += [
            items.eq(Mux(state.rest, self._rest_bytes(), state.items_bytes)),
            whole.eq(state.map_bytes + Mux(state.lead, bus, 0)),
            nul.eq(self.has_nul & state.rest),
            begins.eq(begun | items.any() | nul | state.map_bytes.any()),
        ]
        with m.If(self.complete):
            m.d.sync += begun.eq(begins & ~self.ends)
        raised, mask = self._items_align()
        to_end, end_mask = Signal.like(words.to_end), Signal(max(3, ring.lane_bits))
        with m.If(self.ends):
            m.d.comb += [to_end.eq(Mux(begins, whole + (bus - 1), bus)), end_mask.eq(bus - 1)]
        with m.Else():
            m.d.comb += [to_end.eq(whole + raised), end_mask.eq(mask)]
        with m.If(self.free):
            m.d.sync += [
                self.c.words.valid.eq(self.complete),
                words.items_bytes.eq(items),
                words.map_bytes.eq(state.map_bytes),
                words.lead.eq(state.lead),
                words.to_map.eq(Mux(state.lead, 0, items) + nul + state.raised),
                words.map_mask.eq(state.mask),
                words.to_end.eq(to_end),
                words.end_mask.eq(end_mask),
                words.last.eq(self.ends),
                words.empty.eq(~begins),
            ]

    def _rest_bytes(self) -> Value:
        """Return the bytes of the items of a rest."""
        units: dict[int, list[Value]] = {}
        for index, step in enumerate(self.plan.steps):
            if step.rest is not None:
                units.setdefault(self.plan.item_bytes(step.rest), []).append(self.step[index])
        cases = [(any_of(on), self.rest << (unit.bit_length() - 1)) for unit, on in units.items()]
        return cases[0][1] if len(cases) == 1 else pick(cases, self.plan.bus_bytes.bit_length())

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
                some = self.step[index] & ~self.lengths[step.begin.length].zero
                cases.append((some, raised, align - 1))
        return (
            pick([(some, raised) for some, raised, _ in cases], 3),
            pick([(some, mask) for some, _, mask in cases], 3),
        )

    # The next step.

    def _proceed(self) -> None:
        m, flow, state, plan = self.m, self.flow, self.state, self.plan
        next_rest = self._select(lambda length: length.rest, len(self.rest), BeginRun)
        single = self._select(lambda length: length.single)
        count = self._count()
        # A jump may load the same counter, and then counts.
        flow.load_levels(count, single)
        flow.load_words(count, single, nul_counts=False)
        with m.If(self.complete):
            m.d.sync += Value.cast(state).eq(
                Mux(self.ends, flow.start, Mux(self.done, flow.exit_state, flow.body_state))
            )
            with m.If(self.ends):
                m.d.sync += [self.rest.eq(0), self.has_nul.eq(0)]
                flow.enter(plan.start)
            with m.Else():
                with m.If(self.done):
                    flow.leave()
                with m.Else():
                    flow.go_into_body()
                with m.If(state.words & ~flow.words.last):
                    flow.words.down(m)
                with m.If(state.run_begin):
                    m.d.sync += [self.rest.eq(next_rest), self.has_nul.eq(state.terminated)]
                with m.Elif(state.rest):
                    m.d.sync += [self.rest.eq(0), self.has_nul.eq(0)]

    def _count(self) -> Value:
        """Return the length of the step, as the leaf has it."""
        cases = [
            (self.step[i], self.streams[step.begin.length].payload)
            for i, step in enumerate(self.plan.steps)
            if step.begin is not None
        ]
        return pick(cases, COUNT_BITS)


def _wire_bits(item: Value) -> Value:
    """Return an item's bits on the wire; a bool takes a whole byte."""
    value = Value.cast(item)
    return Cat(value, Const(0, -len(value) % 8))
