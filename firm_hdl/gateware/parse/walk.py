"""The way through a packet and a program: what the two sequencers have in common."""

from __future__ import annotations

from dataclasses import dataclass
from operator import attrgetter
from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from firm_hdl.gateware.flow import Flow, exceeds
from firm_hdl.gateware.parse.byte_flags import ByteFlags
from firm_hdl.gateware.parse.lengths import length_of_step
from firm_hdl.gateware.parse.next_position import next_positions
from firm_hdl.gateware.positions import Ring, align_up, any_of, named
from firm_hdl.names.attributes import REMARK
from firm_hdl.program import DeserializerProgram

__all__ = ["Findings", "Walk"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """What is wrong with the bytes of a state. Combinational.

    An error is found as soon as its byte has come, even if the state waits for later bytes.
    """

    header: Value  # A checked byte of the encapsulation header is wrong.
    nul: Value  # A string has no terminator.
    cut: Value  # The packet has ended, and bytes of the state are missing.
    # All bytes of the state are present, and more bytes follow than may follow the message.
    trailing: Value
    # The state begins a run or loop with a length above its limit. Valid if the state is executed.
    over: Value
    good: Value  # All bytes of the state are present, and none of them is wrong.


class Walk:
    """The place of a sequencer in the packet and in the program. Not a component.

    The registers say where the state ends, not where it starts::

                          last_at
                             |
        ... | rest | pad | map | items of the next run ...
              |                |
           first_at        step_end

    A length is the end of its state's map. So `last_at` is the length's last byte as well: a table
    of lengths is read there at the start of the cycle, and says where the next state ends.

    Call :meth:`advance` once.

    * `bad`: the packet has an error. Lengths are 0 from then on, and positions have no meaning.
    """

    def __init__(self, m: Module, program: DeserializerProgram, arrival: Any, bad: Value):
        self.m, self.program, self.arrival, self.bad = m, program, arrival, bad
        plan = program.plan
        self.ring = ring = Ring(plan)
        self.flow = flow = Flow(m, program)  # State and counters.
        # After a length that claims too much, its state begins nothing: `advance` writes the flag.
        self.may_revisit = program.has_leaves and plan.has_claims
        # Constants of the state; see `DeserializerState`.
        self.begins_nothing = flow.register(
            "begins_nothing",
            1,
            lambda s: s.begins_nothing,
            written=self.may_revisit,
            remark="the step begins neither a run nor a loop",
        )
        self.begins_run, self.begins_loop, self.is_words, self.takes_rest, self.at_end = (
            flow.register(name, 1, attrgetter(name), remark=remark)
            for name, remark in (
                ("begins_run", "the step ends with a length that counts items"),
                ("begins_loop", "the step ends with a length that counts elements"),
                ("is_words", "the step is a bus word of a run, and is repeated"),
                ("takes_rest", "the step begins with the rest of the run before it"),
                ("at_end", "the message is over, but not the packet"),
            )
        )

        start = program.states[program.start.to or 0].last_offset
        # Last byte of the state's map or word.
        self.last_at = ring.position(
            "last_at", init=start % (1 << ring.bits), remark="last byte of the step's map or word"
        )
        # First byte after the previous state, or the first item of a run.
        self.first_at = ring.position("first_at", remark="first byte after the step before")
        # Items in the rest of the run that the state takes.
        self.rest = Signal(
            program.rest_bits, name="rest", attrs={REMARK: "items in the rest of the run"}
        )
        # First byte after the items of the rest, which has a meaning only in the state that takes
        # it; and whether a NUL must be there.
        self.nul_at, self.has_nul = ring.position("nul_at"), Signal(name="has_nul")
        # The state is that of a length again, which claimed too much: it is left at once. Constants
        # of the state are those of the state after it.
        self.revisits: Value = Signal(name="revisits") if self.may_revisit else Const(0, 1)
        # Position after the packet's encapsulation header, modulo 8; a constant if the bus has 8
        # bytes or more.
        self.phase: Value | int = plan.header_bytes
        if plan.bus_bytes < 8:
            self.phase = Const(plan.header_bytes % 8, 3)
            if program.aligns:
                self.phase = Signal(3, name="phase", init=plan.header_bytes % 8)

        # The state's length, decoded. It is looked up at a register, so the read of the table
        # starts with the cycle.
        self.length = length_of_step(m, program, flow, Value.cast(arrival.beat), self.last_at)
        self.not_last_at = named(m, "not_last_at", ~self.last_at, "-1 - last_at")
        # First byte after the state's map or word; bytes in the buffer from there on, negative if
        # bytes of the state are missing.
        self.step_end, self.left = ring.position("step_end"), ring.position("left")
        # A state without bytes ends where the ring begins. If the ring is full, the distance from
        # there to the limit is all of it, and looks negative:
        #
        #   | word 0 | word 1 | ... | word 7 |
        #   ^ step_end                       ^ limit
        #
        self.fills_ring: Value | None = None
        if program.may_have_no_bytes:
            full = self.left == 1 << (ring.bits - 1)
            self.fills_ring = named(m, "fills_ring", full, "a step without bytes, a full buffer")
        self.present = Signal(name="present")  # All bytes of the state are in the buffer.
        # The next state is an exit of this one: whatever the length is; always, or because of the
        # length. Else it is its body.
        self.exits_always, self.done = Signal(name="exits_always"), Signal(name="done")
        # The message ends with this state, and the packet has ended as well.
        self.ends_message, self.ends_packet = (
            Signal(name="ends_message"),
            Signal(name="ends_packet"),
        )
        m.d.comb += [
            self.step_end.eq(self.last_at + 1),
            # limit - last_at - 1.
            self.left.eq(arrival.limit + self.not_last_at),
            self.present.eq(self._or_full(~self.left[-1])),
            self.exits_always.eq(self.begins_nothing | (self.is_words & flow.words.last)),
            self.done.eq(
                self.exits_always
                | ((self.begins_run | self.begins_loop) & bad)
                | self.length.run_skips
                | self.length.loop_skips
            ),
            # Whether a length of 0 ends the message is known late; then the end is its own state.
            self.ends_message.eq(self.at_end | (flow.exit_ends & self.exits_always)),
            self.ends_packet.eq(self.ends_message & arrival.ended),
        ]

    def _or_full(self, value: Value) -> Value:
        return value if self.fills_ring is None else value | self.fills_ring

    @property
    def too_early(self) -> Value:
        """The packet has not begun to arrive.

        Only for the leading states without bytes: others wait for their bytes.
        """
        leading = self.flow.on(lambda state: state.is_leading)
        return leading & ~self.left.any() & ~self.arrival.ended

    def find(self) -> Findings:
        """Check the bytes of the state; call this once."""
        m, ring, arrival = self.m, self.ring, self.arrival
        m.submodules.byte_flags = flags = ByteFlags(self.program)
        wrong_nul, header, cut = (
            Signal(name="wrong_nul"),
            Signal(name="header_error"),
            Signal(name="cut"),
        )
        trailing, within = Signal(name="trailing"), ring.position("nul_within")
        too_many = self._or_full(exceeds(self.left[:-1], self.program.plan.max_trailing_bytes))
        good = Signal(name="bytes_good")
        wrong_header = any_of(
            [self.flow.step[state] & flags.mismatch[k] for k, state in enumerate(flags.states)]
        )
        m.d.comb += [
            Value.cast(flags.beat).eq(Value.cast(arrival.beat)),
            flags.nul_at.eq(self.nul_at),
            flags.header_at.eq(ring.beat(self.first_at)),
            wrong_nul.eq(self.has_nul & self.takes_rest & flags.nonzero),
            within.eq(arrival.limit - self.nul_at),
            # The checked bytes of a header are the first bytes of its state, and nothing before the
            # state is missing. So some of them are there unless the limit is at the state's start.
            # In a full ring, the distance between the two looks negative.
            header.eq(wrong_header & (arrival.limit != self.first_at)),
            cut.eq(arrival.ended & ~self.present),
            trailing.eq(self.present & too_many),
            good.eq(self.present & ~wrong_nul & ~wrong_header),
        ]
        return Findings(
            header=header,
            # The string's last byte is in the buffer, even if later bytes of the state are not.
            nul=named(m, "nul_error", wrong_nul & (self.present | (~within[-1] & within.any()))),
            cut=cut,
            trailing=trailing,
            over=(self.begins_run | self.begins_loop) & self.length.over,
            good=good,
        )

    def advance(
        self, issue: Value, *, aborts: Value | None = None, revisit: Value | None = None
    ) -> None:
        """Add the logic that goes to the next state.

        * `issue`: the state is executed in this cycle.
        * `aborts`: the next state is the end of the packet, unless it has ended.
        * `revisit`: the length of the state before claims too much: go back to its state, which
          then begins nothing. Nothing is executed in this cycle.
        """
        m, length = self.m, self.length
        self._take_rest(issue)
        self._move_on(issue)
        self.flow.advance(
            moves=issue,
            ends=self.ends_packet,
            done=self.done,
            count=length.count,
            single=length.at_most_one_pass,
            double=length.two_passes,
            nul=True,
            aborts=aborts,
        )
        if revisit is not None:
            # A length that is charged is large, so the state after it is its body, and tells which
            # length it was. The flag sends the state of the length to its exit.
            states = self.program.states
            begun = {s.body.to: s.number for s in states if s.length is not None and s.body}
            m.d.sync += self.revisits.eq(revisit | (self.revisits & ~issue))
            with m.If(revisit):
                m.d.sync += self.begins_nothing.eq(1)
                self.flow.go_to({s: self.flow.step[k] for k, s in begun.items() if k is not None})

    def _take_rest(self, issue: Value) -> None:
        """Store the rest of a run that begins; clear it after the state that takes it."""
        m, length = self.m, self.length
        good = named(m, "length_accepted", ~self.bad & ~length.over)
        is_string = self.flow.on(lambda state: state.begins_string)
        with m.If(issue):
            with m.If(self.ends_packet):
                m.d.sync += [self.rest.eq(0), self.has_nul.eq(0)]
            with m.Elif(self.begins_run):
                m.d.sync += [
                    self.rest.eq(Mux(good, length.rest, 0)),
                    self.has_nul.eq(is_string & good & ~length.zero),
                ]
            with m.Elif(self.takes_rest | self.revisits):
                m.d.sync += [self.rest.eq(0), self.has_nul.eq(0)]

    def _move_on(self, issue: Value) -> None:
        """Compute the positions of the next state."""
        m, program, ring, plan = self.m, self.program, self.ring, self.program.plan
        arrival, length, bad = self.arrival, self.length, self.bad
        start = Signal(ring.bits, name="next_packet")
        m.d.comb += start.eq(Cat(Const(0, ring.lane_bits), arrival.following))
        nexts = next_positions(
            m, program, self.flow, self.last_at, self.phase, length, self.begins_run
        )
        # Decisions by a length are late in the cycle, so what they select from comes first.
        early, last = ring.position("early_last_at"), ring.position("next_last_at")
        offset = program.states[program.start.to or 0].last_offset
        begin = named(
            m,
            "last_at_of_next_packet",
            (start + offset)[: ring.bits],
            f"its first step ends {offset} bytes after its first byte",
        )
        exit_or_body = Mux(self.exits_always, nexts.exit, nexts.body)
        exit_or_skipped = Mux(length.loop_skips, nexts.exit, early)
        m.d.comb += [
            early.eq(Mux(self.ends_packet, begin, exit_or_body)),
            last.eq(Mux(length.run_skips, nexts.after_rest, exit_or_skipped)),
        ]
        # The first item of the run that the state begins; else the end of the state.
        items_at: Value = self.step_end
        for align in sorted({each.align for each in program.lengths.values()} - {1}):
            aligned = align_up(m, f"items_at_{align}", self.step_end, 0, align, self.phase)
            chosen = any_of(
                [self.flow.step[k] for k, each in program.lengths.items() if each.align == align]
            )
            items_at = Mux(chosen & ~length.zero, aligned, items_at)
        # After an error, `first_at` only frees beats. It must not pass the packet's end; so it
        # stays until the end state, which drops the rest of the packet as it arrives.
        kept = named(m, "first_at_if_bad", Mux(self.at_end, arrival.limit, self.first_at))
        items_at = named(m, "first_at_if_good", items_at)
        with m.If(issue | (bad & self.at_end)):
            m.d.sync += self.first_at.eq(Mux(self.ends_packet, start, Mux(bad, kept, items_at)))
        with m.If(issue):
            m.d.sync += self.last_at.eq(last)
            if program.has_strings:
                rest = Mux(self.is_words, self.rest, length.rest)
                m.d.sync += self.nul_at.eq(self.step_end + rest)
            if isinstance(self.phase, Signal):
                with m.If(self.ends_packet):
                    m.d.sync += self.phase.eq(start + plan.header_bytes)
