"""The checks of a packet, and which bytes are good after an error."""

from __future__ import annotations

from amaranth.hdl import Mux, Signal, Value
from amaranth.lib import data

from firm_hdl.gateware.flow import exceeds
from firm_hdl.gateware.parse.marks import Marks
from firm_hdl.gateware.parse.state import ParseState
from firm_hdl.gateware.parse.step_length import StepLength
from firm_hdl.gateware.positions import any_of, sum_of_three
from firm_hdl.gateware.signatures import Status

__all__ = ["Judge"]


class Judge:
    """Find the packet's first error in wire order. Not a component: logic of one module.

    The judge drives `state.bad` and `state.new_error`.

    Parameters
    ----------
    state : ParseState
    length : StepLength
    beat, limit, ended
        As for :class:`Sequencer`.
    ready : Value(1)
        An order of this step would be taken in this cycle.

    Attributes
    ----------
    good : Signal(1)
        All bytes of the step are in the buffer, and none of them is wrong. Combinational.
    has_trailing : Signal(1)
        All bytes of the step are in the buffer, and more bytes follow than may follow the message.
        Combinational.
    code : Signal(Status)
        The error, if `state.bad`.
    items_room, map_room : Signal(range(bus_bytes + 1))
        Good bytes of the word of items and of the map, if `state.bad` and not `state.new_error`.
    """

    def __init__(
        self,
        state: ParseState,
        length: StepLength,
        beat: data.View,
        limit: Value,
        ended: Value,
        ready: Value,
    ):
        self.m, self.state, self.length = state.m, state, length
        self.limit, self.ended = limit, ended
        bus = state.plan.bus_bytes
        self.mismatch, self.wrong_nul = Signal(name="mismatch"), Signal(name="wrong_nul")
        self.good = Signal(name="good")
        self.has_trailing, self.code = Signal(name="trailing"), Signal(Status, name="code")
        self.items_room = Signal(range(bus + 1), name="items_room")
        self.map_room = Signal(range(bus + 1), name="map_room")
        self._check_bytes(beat)
        self._judge()
        self._keep_good(ready)

    def _check_bytes(self, beat: data.View) -> None:
        """Check the bytes of the step."""
        m, state, ring = self.m, self.state, self.state.ring
        m.submodules.marks = marks = Marks(state.program)
        too_many = exceeds(state.left[:-1], state.plan.max_trailing_bytes)
        m.d.comb += [
            marks.beat.eq(beat),
            marks.nul_at.eq(state.nul_at),
            marks.header_at.eq(ring.beat(state.first_at)),
            self.wrong_nul.eq(state.has_nul & state.traits.takes_rest & marks.nonzero),
            self.has_trailing.eq(state.present & too_many),
        ]
        headers = [state.step[i] & marks.mismatch[k] for k, i in enumerate(marks.states)]
        wrong_header = any_of(headers)
        if headers:
            # The checked bytes of a header are the first bytes of its step, and nothing before the
            # step is missing. So some of them are there unless the limit is at the step's start. In
            # a full ring, the distance between the two looks negative.
            m.d.comb += self.mismatch.eq(wrong_header & (self.limit != state.first_at))
        m.d.comb += self.good.eq(self._is_good(wrong_header))

    def _is_good(self, wrong_header: Value) -> Value:
        return self.state.present & ~self.wrong_nul & ~wrong_header

    def _find(self) -> tuple[Value, Value, Value]:
        """Return whether a NUL is missing, the packet is cut, and a length is taken in this cycle.

        These, a wrong header and trailing bytes are found while a step waits for its bytes, too.
        """
        m, state = self.m, self.state
        within, cut = state.ring.position("nul_within"), Signal(name="cut")
        begins = Signal(name="begins")
        m.d.comb += [
            within.eq(self.limit - state.nul_at),
            cut.eq(self.ended & ~state.present),
            begins.eq(state.issue & (state.traits.begins_run | state.traits.begins_loop)),
        ]
        # The string's last byte is in the buffer, even if later bytes of the step are not.
        missing_nul = self.wrong_nul & (state.present | (~within[-1] & within.any()))
        return missing_nul, cut, begins

    def _judge(self) -> None:
        """Find the first error of the step in wire order."""
        m, state = self.m, self.state
        missing_nul, cut, begins = self._find()
        overrun = state.ends_message & ~self.ended & self.has_trailing
        early = self.mismatch | missing_nul | cut | overrun
        claims = self.length.claims
        if claims is not None and state.has_leaves:
            # The length before this step is not checked yet; its error would be the first one.
            early = early & ~claims.pending
        # What is left if no other error is found: trailing bytes, or a length over its limit.
        code = Mux(state.ends_message, Status.TRAILING, Status.LENGTH)
        code = Mux(cut, Status.TRUNCATED, code)
        code = Mux(missing_nul, Status.STRING, code)
        code = Mux(self.mismatch, Status.ENCAPSULATION, code)
        with m.If(state.issue & state.ends_packet):
            m.d.sync += state.bad.eq(0)
        with m.Elif(~state.bad):
            # A length above its limit does not stop the step; the step takes the length as 0.
            m.d.sync += state.bad.eq(early | (begins & self.length.over))
        with m.If(~state.bad):
            m.d.sync += [state.new_error.eq(early), self.code.eq(code)]
        if claims is not None:
            # An error that was found before is later in wire order. No packet ends in this cycle.
            with m.If(claims.fails):
                m.d.sync += [state.bad.eq(1), self.code.eq(Status.LENGTH)]

    def _keep_good(self, ready: Value) -> None:
        """After an error, compute how many bytes of the step's words are good."""
        m, state, ring, bus = self.m, self.state, self.state.ring, self.state.plan.bus_bytes
        traits = state.traits
        # Bytes from the first one of the map's last word to the packet's end.
        map_left = ring.position("map_left")
        back = traits.map_offset.as_signed()
        m.d.comb += map_left.eq(sum_of_three(self.limit, ~state.last_at, (1 - back)))
        map_room = self._room(map_left)
        items_room = Mux(traits.takes_rest, self._room(self.limit - state.first_at), map_room)
        # If the map has two words, the word of items is the first one. A negative `map_left` is at
        # least -bus: the packet ends within the first word.
        in_front = Mux(ring.beat(map_left).all(), ring.lane(map_left), 0)
        items_room = Mux(traits.two_word_map, Mux(map_left[-1], in_front, bus), items_room)
        is_cut, trails = self.code == Status.TRUNCATED, self.code == Status.TRAILING
        whole = Mux(trails | (self.code == Status.STRING), bus, 0)
        with m.If(state.bad):
            m.d.sync += state.new_error.eq(0)
            with m.If(state.new_error):
                m.d.sync += [
                    self.items_room.eq(Mux(is_cut, items_room, whole)),
                    self.map_room.eq(Mux(is_cut, map_room, Mux(trails, bus, 0))),
                ]
            with m.Elif(state.drains & ready):
                m.d.sync += [self.items_room.eq(0), self.map_room.eq(0)]

    def _room(self, room: Value) -> Value:
        """Return how many bytes of a word come before the packet's end.

        Parameters
        ----------
        room : Value
            Distance from the word's first byte to the packet's end; may be negative.
        """
        bus, room = self.state.plan.bus_bytes, room[: self.state.ring.bits]
        return Mux(room[-1], 0, Mux(room >= bus, bus, room[: bus.bit_length()]))
