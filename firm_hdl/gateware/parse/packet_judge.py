"""The verdict on a packet of which no leaf is extracted: errors may be found after their step."""

from __future__ import annotations

from amaranth.hdl import Const, Mux, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.parse.judge import Judge
from firm_hdl.gateware.parse.state import ParseState
from firm_hdl.gateware.parse.step_length import StepLength
from firm_hdl.gateware.positions import any_of
from firm_hdl.gateware.signatures import Status

__all__ = ["PacketJudge", "verdict_layout"]


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


class PacketJudge(Judge):
    """Find the packet's first error in wire order, a cycle late. Not a component.

    After an error, only the status is output. So a step waits only for its bytes, and the
    checks of the bytes are not in the loop that limits the clock rate: what they find is registered
    (`found`), and judged in the next cycle. Meanwhile one more step may be executed, and may even
    end the packet; so the end of a packet takes the same register.

    Only a length over its limit stops the sequencer at once (`stops`): the positions after it have
    no meaning.

    Parameters
    ----------
    state, length, beat, limit, ended
        As for :class:`Judge`.

    Attributes
    ----------
    good : Signal(1)
        All bytes of the step are in the buffer.
    stops : Value(1)
        No step must be executed in this cycle. A register.
    verdict : View(verdict_layout())
        Depends on registers only.
    """

    def __init__(
        self,
        state: ParseState,
        length: StepLength,
        beat: data.View,
        limit: Value,
        ended: Value,
    ):
        self.verdict = Signal(verdict_layout(), name="verdict")
        super().__init__(state, length, beat, limit, ended, Const(1))

    def _is_good(self, wrong_header: Value) -> Value:
        return self.state.present

    def _judge(self) -> None:
        """Register what is found in a step; judge it in the next cycle."""
        m, state = self.m, self.state
        missing_nul, cut, begins = self._find()
        errors = ("header", "nul", "cut", "trails", "over")
        found = Signal(
            data.StructLayout({"ends": 1, "trailing": 2, **dict.fromkeys(errors, 1)}), name="found"
        )
        self.stops = found.over
        m.d.sync += [
            found.ends.eq(state.issue & state.ends_packet),
            found.trailing.eq(state.left),
            found.header.eq(self.mismatch),
            found.nul.eq(missing_nul),
            found.cut.eq(cut),
            # More bytes than may follow the message have come, whether or not they are all.
            found.trails.eq(state.ends_message & self.has_trailing),
            found.over.eq(begins & self.length.over & ~state.bad),
        ]
        # What was found in the packet before: the first error in wire order counts.
        failed, first = Signal(name="failed"), Signal(Status, name="first_error", reset_less=True)
        code = Mux(found.trails, Status.TRAILING, Status.LENGTH)
        code = Mux(found.cut, Status.TRUNCATED, code)
        code = Mux(found.nul, Status.STRING, code)
        code = Mux(found.header, Status.ENCAPSULATION, code)
        m.d.comb += [
            self.code.eq(Mux(failed, first, code)),
            state.fails.eq(failed | any_of([found[name] for name in errors])),
            self.verdict.ends.eq(found.ends),
            self.verdict.status.eq(Mux(state.fails, self.code, Status.OK)),
            self.verdict.trailing.eq(found.trailing),
        ]
        m.d.sync += [
            first.eq(self.code),
            failed.eq(state.fails & ~found.ends),
            state.bad.eq(state.fails & ~found.ends & ~(state.issue & state.ends_packet)),
        ]
        if self.length.claims is not None:
            # An error that was found before is later in wire order. No packet ends in this cycle.
            with m.If(self.length.claims.fails):
                m.d.sync += [failed.eq(1), first.eq(Status.LENGTH), state.bad.eq(1)]

    def _keep_good(self, ready: Value) -> None:
        """There are no leaves, so it does not matter which bytes are good."""
