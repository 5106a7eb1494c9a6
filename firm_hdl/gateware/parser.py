"""The parser: the control flow of a plan over the packets of a buffer, without their data."""

from __future__ import annotations

from collections.abc import Callable

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.flow import Flow, exceeds
from firm_hdl.gateware.lengths import Lengths, Meaning, shift_of
from firm_hdl.gateware.marks import Marks
from firm_hdl.gateware.orders import order_layout
from firm_hdl.gateware.places import NextPlace
from firm_hdl.gateware.positions import (
    Ring,
    align_up,
    any_of,
    beat_layout,
    pick,
    sum_of_three,
)
from firm_hdl.gateware.signatures import Status
from firm_hdl.plan import BeginLoop, BeginRun, MapStep, Plan, RunStep
from firm_hdl.plan.geometry import geometry

__all__ = ["Parser"]


class Parser(wiring.Component):
    """Run a plan over the packets of a buffer: check them, and order what is to be done.

    An order is issued for each step when all bytes of the step are in the buffer. The parser waits
    for nothing but bytes and `orders.ready`, and a packet is judged when its last order is issued.

    An error is noted first, and takes two cycles. Then the step is executed with what is good of
    it, and the steps behind it with no data and all lengths 0. What is left of the packet is
    dropped.

    Parameters
    ----------
    plan : Plan

    Members
    -------
    beat : In(beat_layout(plan))
        The beat that is written to the buffer in this cycle.
    limit : In(position)
        Bytes of the packet in front of this position are in the buffer.
    ended : In(1)
        The packet ends at `limit`.
    following : In(beat)
        Where the next packet starts, if `ended`.
    next : Out(1)
        The packet is done.
    at : Out(beat)
        Beats in front of this one are not needed by the parser.
    orders : Out(stream.Signature(order_layout(plan)))
        `valid` does not depend on `ready`; the payload is stable only with `valid`.
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        ring = Ring(plan)
        super().__init__(
            {
                "beat": In(beat_layout(plan)),
                "limit": In(ring.bits),
                "ended": In(1),
                "following": In(ring.beat_bits),
                "next": Out(1),
                "at": Out(ring.beat_bits),
                "orders": Out(stream.Signature(order_layout(plan))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        return _Circuit(self).m


class _Circuit:
    """The parser's logic, built by one method for each part of it.

    Decisions that come late in a cycle are few: whether a length is skipped, whether all bytes are
    present, and whether a NUL is missing. All else that a decision selects from is ready before.
    """

    def __init__(self, parser: Parser):
        self.c, self.plan = parser, parser.plan
        self.ring = ring = Ring(parser.plan)
        self.m = Module()
        plan = parser.plan
        self.meanings = {
            index: Meaning(plan, step)
            for index, step in enumerate(plan.steps)
            if isinstance(step, MapStep) and step.begin is not None
        }
        self.flow = self._flow()
        self.state, self.step = self.flow.state, self.flow.step
        # The last byte of the step's map or word, which is that of its length, and the byte behind
        # the step before it, or the first item of a run.
        self.last = ring.position("last", init=shift_of(plan, plan.start.step) % (1 << ring.bits))
        self.first = ring.position("first")
        # Items of the rest of a run, and the position of its NUL, if one must be there.
        lanes = max((plan.leaves[run.items].lanes for run in plan.runs), default=1)
        self.rest = Signal(range(lanes + 1), name="rest")
        self.nul_at, self.has_nul = ring.position("nul_at"), Signal(name="has_nul")
        self.bad, self.noted = Signal(name="bad"), Signal(name="noted")
        self.code = Signal(Status, name="code")
        self.items_room = Signal(range(plan.bus_bytes + 1), name="items_room")
        self.map_room = Signal(range(plan.bus_bytes + 1), name="map_room")
        self.phase = self._phase()
        self.behind, self.left = ring.position("behind"), ring.position("left")
        self.present, self.good = Signal(name="present"), Signal(name="good")
        self.done = Signal(name="done")
        self.leaves = Signal(name="leaves")
        self.ends, self.closes = Signal(name="ends"), Signal(name="closes")
        self.issue, self.blind = Signal(name="issue"), Signal(name="blind")
        self._look_up()
        self._decide()
        self._judge()
        self._note()
        self._order()
        self._proceed()
        self._move_on()

    def _flow(self) -> Flow:
        plan = self.plan
        counts = [meaning.max_count for meaning in self.meanings.values()]
        counts += [count for jump in plan.jumps() for _, count in jump.enter]
        flags = "run_begin loop_begin words counted rest lead plain end"
        # `back` is in two's complement.
        fields = {"back": plan.bus_bytes.bit_length() + 1} | dict.fromkeys(flags.split(), 1)
        bits = max(counts, default=1).bit_length()
        return Flow(self.m, plan, bits, fields, self._traits, has_end=True)

    def _traits(self, index: int | None) -> dict[str, int]:
        plan, bus = self.plan, self.plan.bus_bytes
        if index is None:
            return {"end": 1, "back": 1}
        step = plan.steps[index]
        is_words = isinstance(step, RunStep)
        is_lead = step.bytes > bus
        return {
            # From the last byte to the first one of the map's last word.
            "back": is_lead * bus - shift_of(plan, index),
            "run_begin": isinstance(step.begin, BeginRun),
            "loop_begin": isinstance(step.begin, BeginLoop),
            "words": is_words,
            "counted": isinstance(step, RunStep) and plan.runs[step.run].counted,
            "rest": step.rest is not None,
            "lead": is_lead,
            "plain": step.begin is None and not is_words,
        }

    def _phase(self) -> Value | int:
        """Return the position behind the packet's encapsulation header, modulo 8."""
        header = self.plan.header_bytes
        if self.plan.bus_bytes >= 8:
            return header
        return Signal(3, name="phase", init=header % 8)

    # Lengths.

    def _look_up(self) -> None:
        m, c, plan = self.m, self.c, self.plan
        if not self.meanings:
            self.zero = self.over = self.single = self.count = Const(0, 1)
            self.run_skips = self.loop_skips = self.next_rest = Const(0, 1)
            self.entry = None
            return
        m.submodules.lengths = lengths = Lengths(plan, geometry(plan))
        m.d.comb += [lengths.beat.eq(c.beat), lengths.key.eq(self.last)]
        if plan.bus_bytes < 8:
            # The phase of the packet that arrives.
            phase = Signal(3, name="arriving_phase", init=plan.header_bytes % 8)
            m.d.comb += lengths.phase.eq(phase)
            with m.If(c.beat.valid & c.beat.last):
                beat = Cat(Const(0, self.ring.lane_bits), c.beat.at)
                m.d.sync += phase.eq(beat + plan.bus_bytes + plan.header_bytes)
        self.entry = lengths.entry
        self.zero, self.count = self.entry.zero, self.entry.count
        self.over = self._select(lambda meaning: meaning.over)
        good = ~self.bad
        self.run_skips = self._select(
            lambda meaning: meaning.skips if meaning.run is not None else None, on=good
        )
        self.loop_skips = self._select(
            lambda meaning: meaning.skips if meaning.run is None else None, on=good
        )
        self.single = self._select(lambda meaning: meaning.single)
        self.next_rest = self._select(
            lambda meaning: meaning.rest if meaning.run is not None else None, len(self.rest)
        )

    def _select(
        self, name: Callable[[Meaning], str | None], width: int = 1, on: Value | None = None
    ) -> Value:
        """Select a field of the entry by the step. With `on`, it is 0 without, and in other steps.

        A field is late in the cycle, and what selects it is not.
        """
        fields: dict[str, list[Value]] = {}
        for index, meaning in self.meanings.items():
            field = name(meaning)
            if field is not None:
                fields.setdefault(field, []).append(self.step[index])
        if len(fields) == 1 and on is None:
            return Value.cast(self.entry[next(iter(fields))])
        return pick(
            [
                (any_of(chosen) & (1 if on is None else on), Value.cast(self.entry[field]))
                for field, chosen in fields.items()
            ],
            width,
        )

    # The step.

    def _decide(self) -> None:
        """Decide whether all bytes are present, and which way the step is left."""
        m, c, state, flow = self.m, self.c, self.state, self.flow
        is_begin = state.run_begin | state.loop_begin
        m.d.comb += [
            self.behind.eq(self.last + 1),
            # limit - last - 1.
            self.left.eq(c.limit + ~self.last),
            self.present.eq(~self.left[-1]),
            self.leaves.eq(state.plain | (state.words & flow.words.last)),
            self.done.eq(
                self.leaves | (is_begin & self.bad) | self.run_skips | self.loop_skips
            ),
            # Where a length ends the packet, the end is a step of its own: it is known too late.
            self.ends.eq(state.end | (flow.exit_ends & self.leaves)),
            self.closes.eq(self.ends & c.ended),
        ]

    def _judge(self) -> None:
        """Find the error of the step, if any; the first one in wire order counts."""
        m, c, plan = self.m, self.c, self.plan
        m.submodules.marks = marks = Marks(plan)
        within = self.ring.position("nul_within")
        mismatch, trailing, cut = (Signal(name=n) for n in ("mismatch", "trailing", "cut"))
        wrong_nul, begins = Signal(name="wrong_nul"), Signal(name="begins")
        too_many = exceeds(self.left[:-1], plan.max_trailing_bytes)
        m.d.comb += [
            marks.beat.eq(c.beat),
            marks.nul_at.eq(self.nul_at),
            marks.header_at.eq(self.ring.beat(self.first)),
            within.eq(c.limit - self.nul_at),
            wrong_nul.eq(self.has_nul & self.state.rest & marks.nonzero),
            trailing.eq(self.present & too_many),
            cut.eq(c.ended & ~self.present),
        ]
        headers = [self.step[i] & marks.mismatch[k] for k, i in enumerate(marks.steps)]
        wrong_header = any_of(headers)
        if headers:
            # Nothing is in front of the bytes of a header that is checked.
            begun = self.ring.position("header_within")
            m.d.comb += [
                begun.eq(c.limit - self.first),
                mismatch.eq(wrong_header & ~begun[-1] & begun.any()),
            ]
        m.d.comb += self.good.eq(self.present & ~wrong_nul & ~wrong_header)
        m.d.comb += begins.eq(self.issue & (self.state.run_begin | self.state.loop_begin))
        self.trailing = trailing
        # The string has its last byte, although the step may lack others.
        missing_nul = wrong_nul & (self.present | (~within[-1] & within.any()))
        overrun = self.ends & ~c.ended & trailing
        with m.If(~self.bad):
            early = mismatch | missing_nul | cut | overrun
            # A length over its limit does not stop the step: the step is as if it was 0.
            m.d.sync += [
                self.bad.eq(early | (begins & self.over)),
                self.noted.eq(early),
                self.code.eq(
                    Mux(
                        mismatch,
                        Status.ENCAPSULATION,
                        Mux(
                            missing_nul,
                            Status.STRING,
                            Mux(
                                cut,
                                Status.TRUNCATED,
                                Mux(self.ends, Status.TRAILING, Status.LENGTH),
                            ),
                        ),
                    )
                ),
            ]

    def _note(self) -> None:
        """After an error, find out how much of the step's words is good."""
        m, bus, state = self.m, self.plan.bus_bytes, self.state
        ring, code, limit = self.ring, self.code, self.c.limit
        self.items_at, self.map_at = ring.position("items_at"), ring.position("map_at")
        back = state.back.as_signed()
        m.d.comb += [
            self.map_at.eq(self.last + back),
            self.items_at.eq(
                Mux(
                    state.rest,
                    self.first,
                    Cat(ring.lane(self.map_at), ring.beat(self.map_at) - state.lead),
                )
            ),
        ]
        # Bytes from the first one of the map's last word to the packet's end.
        behind_map = ring.position("behind_map")
        m.d.comb += behind_map.eq(sum_of_three(limit, ~self.last, (1 - back)))
        map_room = self._room(behind_map)
        items_room = Mux(state.rest, self._room(limit - self.first), map_room)
        # Of two words, that of items is in front of the map's.
        in_front = Mux(ring.beat(behind_map).all(), ring.lane(behind_map), 0)
        items_room = Mux(state.lead, Mux(behind_map[-1], in_front, bus), items_room)
        with m.If(self.bad):
            m.d.sync += self.noted.eq(0)
            with m.If(self.noted):
                is_cut, trails = code == Status.TRUNCATED, code == Status.TRAILING
                whole = Mux(trails | (code == Status.STRING), bus, 0)
                m.d.sync += [
                    self.items_room.eq(Mux(is_cut, items_room, whole)),
                    self.map_room.eq(Mux(is_cut, map_room, Mux(trails, bus, 0))),
                ]
            with m.Elif(self.blind & self.c.orders.ready):
                m.d.sync += [self.items_room.eq(0), self.map_room.eq(0)]

    def _room(self, room: Value) -> Value:
        """Return how many bytes of a word are in front of the packet's end, from its start on."""
        bus, room = self.plan.bus_bytes, room[: self.ring.bits]
        return Mux(room[-1], 0, Mux(room >= bus, bus, room[: bus.bit_length()]))

    def _order(self) -> None:
        m, c, state, flow = self.m, self.c, self.state, self.flow
        order, bus, bad = c.orders.payload, self.plan.bus_bytes, self.bad
        # After an error, steps look at nothing; before, at whether all is here and good. What is
        # late in the cycle is kept apart, as `ready` and `closes` are early.
        blind, sighted = self.blind, Signal(name="sighted")
        ready, good = c.orders.ready, self.good
        m.d.comb += [
            blind.eq(bad & ~self.noted & (~state.end | c.ended)),
            sighted.eq(~bad & (~self.ends | c.ended)),
            c.orders.valid.eq(blind | (sighted & good)),
            self.issue.eq((blind & ready) | (sighted & ready & good)),
            c.next.eq((blind & ready & self.closes) | (sighted & ready & self.closes & good)),
        ]
        wanted = Signal(range(bus + 1), name="items_wanted")
        fits = self.items_room >= wanted
        m.d.comb += [
            wanted.eq(Mux(state.rest, self._rest_bytes(), bus)),
            order.step.eq(
                pick([(self.step[i], i) for i in range(len(self.plan.steps))], len(order.step))
            ),
            order.blank.eq(state.end),
            order.items_at.eq(self.items_at),
            order.map_at.eq(self.map_at),
            order.items_bytes.eq(Mux(bad & ~fits, self.items_room, wanted)),
            order.map_bytes.eq(Mux(bad, self.map_room, bus)),
            order.items.eq((state.rest & self.rest.any()) | state.counted),
            order.last.eq(state.rest | (flow.words.last & ~state.counted)),
            order.counted.eq(~bad & ~self.zero & ~self.over),
            order.final.eq(Cat(level.last for level in flow.levels)),
            order.first.eq(self.ring.beat(self.first)),
            order.ends.eq(self.closes),
            order.status.eq(Mux(bad, self.code, Mux(self.trailing, Status.TRAILING, Status.OK))),
            c.at.eq(self.ring.beat(self.first)),
        ]

    def _rest_bytes(self) -> Value:
        """Return the bytes of the items of a rest."""
        units: dict[int, list[Value]] = {}
        for index, step in enumerate(self.plan.steps):
            if step.rest is not None:
                units.setdefault(self.plan.item_bytes(step.rest), []).append(self.step[index])
        cases = [(any_of(on), self.rest << (unit.bit_length() - 1)) for unit, on in units.items()]
        return cases[0][1] if len(cases) == 1 else pick(cases, self.plan.bus_bytes.bit_length())

    # The next step.

    def _proceed(self) -> None:
        """Go to the next step, and count."""
        m, state, flow = self.m, self.state, self.flow
        next_state = Signal(flow.layout.size, name="next_state")
        m.d.comb += next_state.eq(
            Mux(self.closes, flow.start, Mux(self.done, flow.exit_state, flow.body_state))
        )
        # A jump may load the same counter, and then counts.
        flow.load_levels(self.count, self.single)
        flow.load_words(self.count, self.single, nul_counts=True)
        with m.If(self.issue):
            m.d.sync += Value.cast(state).eq(next_state)
            with m.If(self.closes):
                m.d.sync += [self.bad.eq(0), self.rest.eq(0), self.has_nul.eq(0)]
                flow.enter(self.plan.start)
            with m.Else():
                with m.If(self.done):
                    flow.leave()
                with m.Else():
                    flow.go_into_body()
                with m.If(state.words & ~flow.words.last):
                    flow.words.down(m)
                self._begin_run()

    def _begin_run(self) -> None:
        """Keep the rest of a run that begins; a rest is gone after its step."""
        m = self.m
        good = ~self.bad & ~self.over
        terminated = self.flow.on(
            lambda s: isinstance(s.begin, BeginRun) and self.plan.runs[s.begin.run].terminated
        )
        with m.If(self.state.run_begin):
            m.d.sync += [
                self.rest.eq(Mux(good, self.next_rest, 0)),
                self.has_nul.eq(terminated & good & ~self.zero),
            ]
        with m.Elif(self.state.rest):
            m.d.sync += [self.rest.eq(0), self.has_nul.eq(0)]

    def _move_on(self) -> None:
        """Compute the positions of the next step."""
        m, c, ring, plan = self.m, self.c, self.ring, self.plan
        start = Signal(ring.bits, name="next_packet")
        m.d.comb += start.eq(Cat(Const(0, ring.lane_bits), c.following))
        ways = NextPlace(m, self.flow, self.last, self.phase, self.meanings, self.entry)
        # What a length decides is late.
        early, last = ring.position("early_last"), ring.position("next_last")
        begin = start + shift_of(plan, plan.start.step)
        m.d.comb += [
            early.eq(
                Mux(
                    self.closes,
                    begin,
                    Mux(self.bad, self.last, Mux(self.leaves, ways.exit, ways.body)),
                )
            ),
            last.eq(
                Mux(self.run_skips, ways.after_rest, Mux(self.loop_skips, ways.exit, early))
            ),
        ]
        # After an error, nothing is read; the end step drops what is left of the packet.
        kept = Mux(self.state.end, c.limit, self.first)
        first = Mux(self.closes, start, Mux(self.bad, kept, self._items_start()))
        with m.If(self.issue | (self.bad & self.state.end)):
            m.d.sync += self.first.eq(first)
        with m.If(self.issue):
            m.d.sync += self.last.eq(last)
            if any(run.terminated for run in plan.runs):
                rest = Mux(self.state.words, self.rest, self.next_rest)
                m.d.sync += self.nul_at.eq(self.behind + rest)
            if plan.bus_bytes < 8:
                with m.If(self.closes):
                    m.d.sync += self.phase.eq(start + plan.header_bytes)

    def _items_start(self) -> Value:
        """Return where items start that the step counts; else where the step ends."""
        start: Value = self.behind
        aligns = {s.begin.align for s in self.plan.steps if isinstance(s.begin, BeginRun)} - {1}
        for align in sorted(aligns):
            chosen = self.flow.on(
                lambda s, a=align: isinstance(s.begin, BeginRun) and s.begin.align == a
            )
            aligned = align_up(self.m, self.behind, 0, align, self.phase)
            start = Mux(chosen & ~self.zero, aligned, start)
        return start
