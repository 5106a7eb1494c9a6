"""The sequencer: the control flow of a plan over the packets in the buffer, without their data."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.parse.judge import Judge
from firm_hdl.gateware.parse.orders import order_layout
from firm_hdl.gateware.parse.packet_judge import PacketJudge, verdict_layout
from firm_hdl.gateware.parse.places import NextPlace
from firm_hdl.gateware.parse.state import ParseState
from firm_hdl.gateware.parse.step_length import StepLength
from firm_hdl.gateware.positions import (
    Ring,
    align_up,
    any_of,
    beat_layout,
    pick,
)
from firm_hdl.gateware.signatures import Status
from firm_hdl.program import DeserializerProgram

__all__ = ["Sequencer"]


class Sequencer(wiring.Component):
    """Run a plan over the packets in the buffer: check them, and give orders to the mover.

    Each step gives one order, once all its bytes are in the buffer. The sequencer waits only for
    bytes and for `orders.ready`. The last order of a packet carries its status.

    An error in the bytes of a step takes two cycles: one finds it, and one computes which bytes are
    good. Then the step is ordered with its good bytes. A length over its limit takes no cycle: its
    step transfers it as 0. All later steps are ordered without bytes and with lengths of 0, and the
    rest of the packet is dropped.

    A counted length (:class:`Claims`) holds the sequencer before the next step. Its order must
    wait, too (`holds`). If the length claims too much, the order must transfer it as 0 (`refuses`),
    and the sequencer goes back to the length's step, and leaves it with an order that has no step.

    Without leaves, there are no orders, but a verdict per packet (:class:`PacketJudge`), and
    nothing is held but the end of the packet.

    Parameters
    ----------
    program : DeserializerProgram
        With leaves, there are orders. Without leaves, no steps are executed after an error, and
        elements without bytes are skipped.

    Members
    -------
    beat : In(beat_layout(plan))
        The beat that is written to the buffer in this cycle.
    limit : In(position)
        Bytes of the packet before this position are in the buffer.
    ended : In(1)
        The packet ends at `limit`.
    following : In(beat)
        First beat of the next packet, if `ended`.
    next : Out(1)
        The packet's last order is taken, or its last step is executed; go to the next packet.
    trailing : Out(2)
        Bytes of the packet after the message, if `next` and the status is `OK`.
    oldest : Out(beat)
        The sequencer needs no beat before this one.
    holds : Out(1)
        The newest order must wait: its length is not checked yet. Only if the plan has claims and
        orders write leaves, as for `refuses`.
    refuses : Out(1)
        The newest order must transfer its length as 0. Only in the last cycle of `holds`.
    orders : Out(stream.Signature(order_layout(plan)))
        Only with leaves. `valid` does not depend on `ready`; the payload is stable only with
        `valid`.
    may_end : In(1)
        Only without leaves: a packet may end in this cycle.
    verdict : Out(verdict_layout())
        Only without leaves. Depends on registers only.
    """

    def __init__(self, program: DeserializerProgram):
        self.program, self.plan, self.has_leaves = program, program.plan, program.has_leaves
        plan, has_leaves = self.plan, self.has_leaves
        ring = Ring(plan)
        has_holds = plan.has_claims and has_leaves
        checks = {"holds": Out(1), "refuses": Out(1)} if has_holds else {}
        orders = stream.Signature(order_layout(plan))
        results: dict[str, Any] = {"may_end": In(1), "verdict": Out(verdict_layout())}
        if has_leaves:
            results = {"orders": Out(orders)}
        super().__init__(
            {
                "beat": In(beat_layout(plan)),
                "limit": In(ring.bits),
                "ended": In(1),
                "following": In(ring.beat_bits),
                "next": Out(1),
                "trailing": Out(2),
                "oldest": Out(ring.beat_bits),
                **results,
                **checks,
            }
        )

    def elaborate(self, platform: object) -> Module:
        return _SequencerLogic(self).m


class _SequencerLogic:
    """The sequencer's logic, built by one method for each part of it.

    Few decisions come late in a cycle: whether the body of a length is skipped, whether all bytes
    are present, and whether a NUL is missing. What they select from is ready early.
    """

    def __init__(self, sequencer: Sequencer):
        self.c = c = sequencer
        self.m, self.plan = m, _ = Module(), sequencer.plan
        self.state = state = ParseState(m, sequencer.program)
        self.length = StepLength(state, c.beat)
        self.claims = self.length.claims
        self._decide()
        given = state, self.length, c.beat, c.limit, c.ended
        if sequencer.has_leaves:
            self.judge = Judge(*given, c.orders.ready)
            self._allow(c.orders.ready)
            self._order()
        else:
            self.judge = late = PacketJudge(*given)
            m.d.comb += [
                c.verdict.eq(late.verdict),
                c.oldest.eq(state.ring.beat(state.first_at)),
            ]
            self._allow((c.may_end | ~state.ends_packet) & ~late.stops)
        self._proceed()
        self._move_on()

    # The step.

    def _decide(self) -> None:
        """Decide whether all bytes are present, and what follows the step."""
        m, c, state = self.m, self.c, self.state
        ring, traits, flow = state.ring, state.traits, state.flow
        is_begin = traits.begins_run | traits.begins_loop
        items_at: Value = Cat(
            ring.lane(state.map_at), ring.beat(state.map_at) - traits.two_word_map
        )
        # A choice whose condition is a constant would hide the concatenation from the Verilog back
        # end, which gives such vectors a net of their own.
        if not isinstance(traits.takes_rest, Const):
            items_at = Mux(traits.takes_rest, state.first_at, items_at)
        m.d.comb += [
            state.step_end.eq(state.last_at + 1),
            # limit - last_at - 1.
            state.left.eq(c.limit + ~state.last_at),
            c.trailing.eq(state.left),
            state.present.eq(~state.left[-1]),
            state.exits_always.eq(traits.begins_nothing | (traits.is_words & flow.words.last)),
            state.done.eq(
                state.exits_always
                | (is_begin & state.bad)
                | self.length.run_skips
                | self.length.loop_skips
            ),
            # Whether a length of 0 ends the message is known late; then the end is its own step.
            state.ends_message.eq(traits.at_end | (flow.exit_ends & state.exits_always)),
            state.ends_packet.eq(state.ends_message & c.ended),
            state.map_at.eq(state.last_at + traits.map_offset.as_signed()),
            state.items_at.eq(items_at),
        ]

    def _allow(self, ready: Value) -> None:
        """Decide whether the step is executed.

        Parameters
        ----------
        ready : Value
            The order is taken if there is one.
        """
        m, c, state, traits = self.m, self.c, self.state, self.state.traits
        # Without an error, a step is ordered if it is allowed and its bytes are good. `good` is
        # late in the cycle; so it is a factor of its own, and all else is computed before it.
        allowed = Signal(name="allowed")
        drains, good, ends, bad = state.drains, self.judge.good, state.ends_packet, state.bad
        may_proceed = ~bad & (~state.ends_message | c.ended) & ~self._too_early()
        may_drain = bad & ~state.new_error & (~traits.at_end | c.ended)
        if self.claims is not None:
            waits = self.claims.pending
            if c.has_leaves:
                may_proceed = may_proceed & ~waits
                m.d.comb += [c.holds.eq(waits), c.refuses.eq(self.claims.fails)]
            else:
                # Only the end of the packet waits: the check may still find an error.
                may_proceed = may_proceed & ~(waits & state.ends_message)
                may_drain = may_drain & ~waits
        offers = [c.orders.valid.eq(drains | (allowed & good))] if c.has_leaves else []
        m.d.comb += [
            drains.eq(may_drain),
            allowed.eq(may_proceed),
            *offers,
            state.issue.eq((drains & ready) | (allowed & ready & good)),
            c.next.eq((drains & ready & ends) | (allowed & ready & ends & good)),
        ]

    def _order(self) -> None:
        m, c, state = self.m, self.c, self.state
        ring, traits, flow = state.ring, state.traits, state.flow
        order, bus, bad = c.orders.payload, self.plan.bus_bytes, state.bad
        blank = traits.at_end if state.refused is None else traits.at_end | state.refused
        wanted = Signal(range(bus + 1), name="items_wanted")
        fits = self.judge.items_room >= wanted
        m.d.comb += [
            wanted.eq(Mux(traits.takes_rest, flow.rest_bytes(state.rest), bus)),
            order.step.eq(
                pick([(state.step[i], i) for i in range(len(self.plan.steps))], len(order.step))
            ),
            order.blank.eq(blank),
            order.items_at.eq(state.items_at),
            order.map_at.eq(state.map_at),
            order.items_next.eq(ring.slot(state.items_at) + 1),
            order.map_next.eq(ring.slot(state.map_at) + 1),
            order.items_bytes.eq(Mux(bad & ~fits, self.judge.items_room, wanted)),
            order.map_bytes.eq(Mux(bad, self.judge.map_room, bus)),
            order.items.eq((traits.takes_rest & state.rest.any()) | traits.is_counted),
            order.last.eq(traits.takes_rest | (flow.words.last & ~traits.is_counted)),
            order.length_good.eq(~bad & ~self.length.zero & ~self.length.over),
            order.final.eq(Cat(level.last for level in flow.levels)),
            order.first.eq(ring.beat(state.first_at)),
            order.ends.eq(state.ends_packet),
            order.status.eq(
                Mux(bad, self.judge.code, Mux(self.judge.has_trailing, Status.TRAILING, Status.OK))
            ),
            c.oldest.eq(ring.beat(state.first_at)),
        ]

    def _too_early(self) -> Value:
        """Return whether the packet has not begun to arrive.

        Only for the leading steps without bytes: others wait for their bytes.
        """
        state = self.state
        leading = state.flow.on(lambda each: each.is_leading)
        return leading & ~state.left.any() & ~self.c.ended

    # The next step.

    def _proceed(self) -> None:
        """Go to the next step, and count."""
        m, state, flow = self.m, self.state, self.state.flow
        flow.count(
            moves=state.issue,
            ends=state.ends_packet,
            done=state.done,
            count=self.length.count,
            single=self.length.single,
            double=self.length.double,
            nul=True,
        )
        aborts = None if self.c.has_leaves else state.bad
        with m.If(state.issue):
            flow.go(ends=state.ends_packet, done=state.done, aborts=aborts)
        if state.refused is not None and self.claims is not None:
            # Back to the step of the length. It begins nothing, and is left at once.
            states = state.program.states
            back = {s.body.to: s.number for s in states if s.length and s.body}
            begun = {i: state.step[k] for k, i in back.items() if k}
            with m.If(self.claims.fails):
                m.d.sync += state.traits.begins_nothing.eq(1)
                flow.go_to(begun)
        with m.If(state.issue):
            with m.If(state.ends_packet):
                m.d.sync += [state.rest.eq(0), state.has_nul.eq(0)]
            with m.Else():
                self._begin_run()

    def _begin_run(self) -> None:
        """Store the rest of a run that begins; clear it after the step that takes it."""
        m, state = self.m, self.state
        good = ~state.bad & ~self.length.over
        terminated = state.flow.on(lambda each: each.begins_string)
        with m.If(state.traits.begins_run):
            m.d.sync += [
                state.rest.eq(Mux(good, self.length.rest, 0)),
                state.has_nul.eq(terminated & good & ~self.length.zero),
            ]
        ends: Value = state.traits.takes_rest
        with m.Elif(ends if state.refused is None else ends | state.refused):
            m.d.sync += [state.rest.eq(0), state.has_nul.eq(0)]

    def _move_on(self) -> None:
        """Compute the positions of the next step."""
        m, c, state, ring, plan = self.m, self.c, self.state, self.state.ring, self.plan
        start = Signal(ring.bits, name="next_packet")
        m.d.comb += start.eq(Cat(Const(0, ring.lane_bits), c.following))
        places = NextPlace(
            m, state.program, state.flow, state.last_at, state.phase, self.length.entry
        )
        # Decisions by a length are late. After an error, `last_at` has no meaning.
        early, last = ring.position("early_last"), ring.position("next_last")
        first_state = state.program.states[state.program.start.to or 0]
        begin = start + first_state.last_offset
        m.d.comb += [
            early.eq(
                Mux(state.ends_packet, begin, Mux(state.exits_always, places.exit, places.body))
            ),
            last.eq(
                Mux(
                    self.length.run_skips,
                    places.after_rest,
                    Mux(self.length.loop_skips, places.exit, early),
                )
            ),
        ]
        # After an error, `first_at` only frees beats; the end step drops the rest of the packet.
        kept = Mux(state.traits.at_end, c.limit, state.first_at)
        first = Mux(state.ends_packet, start, Mux(state.bad, kept, self._items_start()))
        with m.If(state.issue | (state.bad & state.traits.at_end)):
            m.d.sync += state.first_at.eq(first)
        with m.If(state.issue):
            m.d.sync += state.last_at.eq(last)
            if state.program.has_strings:
                rest = Mux(state.traits.is_words, state.rest, self.length.rest)
                m.d.sync += state.nul_at.eq(state.step_end + rest)
            if isinstance(state.phase, Signal):
                with m.If(state.ends_packet):
                    m.d.sync += state.phase.eq(start + plan.header_bytes)

    def _items_start(self) -> Value:
        """Return the first item of the run that the step begins; else the end of the step."""
        state = self.state
        start: Value = state.step_end
        aligns: dict[int, list[Value]] = {}
        for number, length in state.program.lengths.items():
            aligns.setdefault(length.align, []).append(state.step[number])
        for align in sorted(aligns.keys() - {1}):
            chosen = any_of(aligns[align])
            aligned = align_up(self.m, state.step_end, 0, align, state.phase)
            start = Mux(chosen & ~self.length.zero, aligned, start)
        return start
