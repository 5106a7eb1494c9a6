"""The checks of a packet, and what is good of it after an error."""

from __future__ import annotations

from amaranth.hdl import Mux, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.flow import exceeds
from firm_hdl.gateware.parse.marks import Marks
from firm_hdl.gateware.parse.progress import Progress
from firm_hdl.gateware.parse.step_length import StepLength
from firm_hdl.gateware.positions import any_of, sum_of_three
from firm_hdl.gateware.signatures import Status

__all__ = ["Judge"]


class Judge:
    """Find the packet's first error in wire order. Not a component: logic of one module.

    It writes `now.bad` and `now.noted`; the sequencer clears `now.bad` after the packet.

    Parameters
    ----------
    now : Progress
    length : StepLength
    beat, limit, ended
        As of :class:`Sequencer`.
    ready : Value(1)
        The order of the step would be taken.

    Attributes
    ----------
    good : Signal(1)
        All bytes of the step are there, and none of them is wrong. Combinational.
    trailing : Signal(1)
        They are there, and too many bytes follow. Combinational.
    code : Signal(Status)
        The error, if `now.bad`.
    items_room, map_room : Signal(range(bus_bytes + 1))
        Bytes of the word of items and of the map that are good, if `now.bad` and not `now.noted`.
    """

    def __init__(
        self,
        now: Progress,
        length: StepLength,
        beat: data.View,
        limit: Value,
        ended: Value,
        ready: Value,
    ):
        self.m, self.now, self.length = now.m, now, length
        self.limit, self.ended = limit, ended
        bus = now.plan.bus_bytes
        self.mismatch, self.wrong_nul = Signal(name="mismatch"), Signal(name="wrong_nul")
        self.good = Signal(name="good")
        self.trailing, self.code = Signal(name="trailing"), Signal(Status, name="code")
        self.items_room = Signal(range(bus + 1), name="items_room")
        self.map_room = Signal(range(bus + 1), name="map_room")
        self._look(beat)
        self._judge()
        self._keep_good(ready)

    def _look(self, beat: data.View) -> None:
        """Look at the bytes of the step."""
        m, now, ring = self.m, self.now, self.now.ring
        m.submodules.marks = marks = Marks(now.plan)
        too_many = exceeds(now.left[:-1], now.plan.max_trailing_bytes)
        m.d.comb += [
            marks.beat.eq(beat),
            marks.nul_at.eq(now.nul_at),
            marks.header_at.eq(ring.beat(now.first)),
            self.wrong_nul.eq(now.has_nul & now.state.rest & marks.nonzero),
            self.trailing.eq(now.present & too_many),
        ]
        headers = [now.step[i] & marks.mismatch[k] for k, i in enumerate(marks.steps)]
        wrong_header = any_of(headers)
        if headers:
            # Nothing is in front of the bytes of a header that is checked.
            begun = ring.position("header_within")
            m.d.comb += [
                begun.eq(self.limit - now.first),
                self.mismatch.eq(wrong_header & ~begun[-1] & begun.any()),
            ]
        m.d.comb += self.good.eq(now.present & ~self.wrong_nul & ~wrong_header)

    def _judge(self) -> None:
        """Find the error of the step, if any; the first one in wire order counts."""
        m, now = self.m, self.now
        within, cut = now.ring.position("nul_within"), Signal(name="cut")
        begins = Signal(name="begins")
        m.d.comb += [
            within.eq(self.limit - now.nul_at),
            cut.eq(self.ended & ~now.present),
            begins.eq(now.issue & (now.state.run_begin | now.state.loop_begin)),
        ]
        # The string has its last byte, although the step may lack others.
        missing_nul = self.wrong_nul & (now.present | (~within[-1] & within.any()))
        overrun = now.ends & ~self.ended & self.trailing
        early = self.mismatch | missing_nul | cut | overrun
        code = Mux(now.ends, Status.TRAILING, Status.LENGTH)
        code = Mux(cut, Status.TRUNCATED, code)
        code = Mux(missing_nul, Status.STRING, code)
        code = Mux(self.mismatch, Status.ENCAPSULATION, code)
        with m.If(~now.bad):
            # A length over its limit does not stop the step: the step is as if it was 0.
            m.d.sync += [
                now.bad.eq(early | (begins & self.length.over)),
                now.noted.eq(early),
                self.code.eq(code),
            ]

    def _keep_good(self, ready: Value) -> None:
        """After an error, find out how much of the step's words is good."""
        m, now, ring, bus = self.m, self.now, self.now.ring, self.now.plan.bus_bytes
        state = now.state
        # Bytes from the first one of the map's last word to the packet's end.
        map_left = ring.position("map_left")
        back = state.back.as_signed()
        m.d.comb += map_left.eq(sum_of_three(self.limit, ~now.last, (1 - back)))
        map_room = self._room(map_left)
        items_room = Mux(state.rest, self._room(self.limit - now.first), map_room)
        # Of two words, that of items is in front of the map's.
        in_front = Mux(ring.beat(map_left).all(), ring.lane(map_left), 0)
        items_room = Mux(state.lead, Mux(map_left[-1], in_front, bus), items_room)
        is_cut, trails = self.code == Status.TRUNCATED, self.code == Status.TRAILING
        whole = Mux(trails | (self.code == Status.STRING), bus, 0)
        with m.If(now.bad):
            m.d.sync += now.noted.eq(0)
            with m.If(now.noted):
                m.d.sync += [
                    self.items_room.eq(Mux(is_cut, items_room, whole)),
                    self.map_room.eq(Mux(is_cut, map_room, Mux(trails, bus, 0))),
                ]
            with m.Elif(now.blind & ready):
                m.d.sync += [self.items_room.eq(0), self.map_room.eq(0)]

    def _room(self, room: Value) -> Value:
        """Return how many bytes of a word are in front of the packet's end, from its start on."""
        bus, room = self.now.plan.bus_bytes, room[: self.now.ring.bits]
        return Mux(room[-1], 0, Mux(room >= bus, bus, room[: bus.bit_length()]))
