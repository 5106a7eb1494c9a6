"""The checker: a sequencer of which no leaf is extracted. It only says whether packets are good."""

from __future__ import annotations

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.parse.budget import Budget
from firm_hdl.gateware.parse.buffer import ArrivalSignature
from firm_hdl.gateware.parse.walk import Walk
from firm_hdl.gateware.positions import Ring
from firm_hdl.gateware.signatures import Status
from firm_hdl.program import DeserializerProgram

__all__ = ["Checker", "verdict_layout"]


def verdict_layout() -> data.StructLayout:
    """Return the verdict on a packet.

    Members
    -------
    ends : unsigned(1)
        A packet has ended in the cycle before.
    status : Status
        The result of this packet.
    trailing : unsigned(2)
        Its bytes after the message, if the status is `OK`.
    """
    return data.StructLayout({"ends": 1, "status": Status, "trailing": 2})


class Checker(wiring.Component):
    """Run a program without leaves over the packets in the buffer, and give a verdict on each.

    After an error, only the status is output. So a state waits only for its bytes, and the checks
    of the bytes are not in the loop that limits the clock rate: what they find is registered, and
    judged in the next cycle. Meanwhile one more state may be executed, and may even end the packet;
    so the end of a packet takes the same register::

        cycle         | 0        | 1         | 2            | 3
        state         | s        | next one  | end          | end, until the packet has ended
        found.*       |          | of s      |              |
        fails         |          | 1         | 1            | 1
        bad           |          |           | 1            | 1

    Only a length over its limit stops the checker at once: the positions after it have no meaning.
    Nothing waits for the :class:`Budget` but the end of the packet.

    Parameters
    ----------
    program : DeserializerProgram
        Without leaves: elements without bytes are skipped.

    Members
    -------
    arrival : In(ArrivalSignature(plan))
        `next` is high as the packet's last state is executed.
    oldest : Out(beat)
        The checker needs no beat before this one.
    may_end : In(1)
        A packet may end in this cycle.
    verdict : Out(verdict_layout())
        Depends on registers only.
    """

    def __init__(self, program: DeserializerProgram):
        self.program = program
        super().__init__(
            {
                "arrival": In(ArrivalSignature(program.plan)),
                "oldest": Out(Ring(program.plan).beat_bits),
                "may_end": In(1),
                "verdict": Out(verdict_layout()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        program, arrival = self.program, self.arrival
        bad = Signal()
        walk = Walk(m, program, arrival, bad)
        now = walk.find()
        issue = Signal()

        # What was found in the cycle before. More bytes than may follow the message have come,
        # whether or not they are all (`trails`).
        errors = ("header", "nul", "cut", "trails", "over")
        found = Signal(
            data.StructLayout({"ends": 1, "trailing": 2, **dict.fromkeys(errors, 1)}), name="found"
        )
        m.d.sync += [
            found.ends.eq(issue & walk.ends_packet),
            found.trailing.eq(walk.left),
            found.header.eq(now.header),
            found.nul.eq(now.nul),
            found.cut.eq(now.cut),
            found.trails.eq(walk.ends_message & now.trailing),
            found.over.eq(issue & now.over & ~bad),
        ]
        # The packet's first error in wire order, of this cycle or an earlier one.
        failed = Signal()
        first_code = Signal(Status, reset_less=True)
        fails = Signal()
        code = Signal(Status)
        m.d.comb += [
            fails.eq(failed | found.header | found.nul | found.cut | found.trails | found.over),
            code.eq(Mux(found.trails, Status.TRAILING, Status.LENGTH)),
        ]
        with m.If(failed):
            m.d.comb += code.eq(first_code)
        with m.Elif(found.header):
            m.d.comb += code.eq(Status.ENCAPSULATION)
        with m.Elif(found.nul):
            m.d.comb += code.eq(Status.STRING)
        with m.Elif(found.cut):
            m.d.comb += code.eq(Status.TRUNCATED)
        m.d.comb += [
            self.verdict.ends.eq(found.ends),
            self.verdict.status.eq(Mux(fails, code, Status.OK)),
            self.verdict.trailing.eq(found.trailing),
        ]
        m.d.sync += [
            first_code.eq(code),
            failed.eq(fails & ~found.ends),
            bad.eq(fails & ~found.ends & ~(issue & walk.ends_packet)),
        ]

        # The budget: only the end of the packet waits, because the check may still find an error.
        pending: Value = Const(0, 1)
        if program.plan.has_claims:
            m.submodules.budget = budget = Budget(program)
            pending = budget.pending
            m.d.comb += [
                budget.step.eq(walk.flow.bits),
                budget.starts.eq(issue & walk.length.charged & ~bad),
                budget.cancels.eq(fails),
                budget.count.eq(walk.length.count),
            ]
            # An error that was found before is later in wire order. No packet ends in this cycle.
            with m.If(budget.fails):
                m.d.sync += [failed.eq(1), first_code.eq(Status.LENGTH), bad.eq(1)]

        # Execute the state if its bytes are present; after an error, only its end waits.
        ready = Signal()
        allowed = Signal()
        drains = Signal()
        m.d.comb += [
            ready.eq((self.may_end | ~walk.ends_packet) & ~found.over),
            allowed.eq(
                ~bad
                & (~walk.ends_message | arrival.ended)
                & ~walk.too_early
                & ~(pending & walk.ends_message)
            ),
            drains.eq(bad & (~walk.at_end | arrival.ended) & ~pending),
            issue.eq((drains & ready) | (allowed & ready & walk.present)),
            arrival.next.eq(
                (drains & ready & walk.ends_packet)
                | (allowed & ready & walk.ends_packet & walk.present)
            ),
            self.oldest.eq(walk.ring.beat(walk.first_at)),
        ]
        walk.advance(issue, aborts=bad)
        return m
