"""Fragments: what is too large for a datagram is cut, and what comes is put together again."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.signatures import packet_layout
from firm_hdl.node.frame import FRAGMENT_UNIT, HEADER_BYTES, LATE_MESSAGES, VERSION
from firm_hdl.node.gateware.header import frame_output, header_beats
from firm_hdl.node.gateware.streams import header_layout

__all__ = ["REASSEMBLER_COUNTERS", "Fragmenter", "Reassembler"]

SIZE_BITS = 16


class Fragmenter(wiring.Component):
    """Send each frame of a whole message as one or more frames of limited size.

    A beat leaves per cycle. A message costs as many cycles more as a header has beats, and 2; each
    further fragment 1. On Ethernet, preamble, addresses and gap take longer.

    Outputs are registers. One clock domain, `sync`; its reset discards the message inside.

    Parameters
    ----------
    bus_bytes : int
        1, 2, 4, 8 or 16.
    frame_bytes : int
        Most bytes of a frame, header included: 16 and a multiple of 16, at most 65,520.

    Members
    -------
    i : In(PacketSignature(bus_bytes))
        Frames of whole messages, as :class:`HeaderInsert` makes them.
    frames : Out(PacketSignature(bus_bytes))
    size : Out(16)
        Bytes of the frame, header included, in all its beats.
    """

    def __init__(self, bus_bytes: int, frame_bytes: int):
        self.bus_bytes, self.beats = bus_bytes, header_beats(bus_bytes)
        self.room = frame_bytes - HEADER_BYTES
        if self.room < FRAGMENT_UNIT or self.room % FRAGMENT_UNIT or frame_bytes >= 1 << SIZE_BITS:
            raise ValueError(
                f"Frame size must be {HEADER_BYTES} and a multiple of {FRAGMENT_UNIT} bytes, not "
                f"{frame_bytes}"
            )
        super().__init__(
            {
                "i": In(PacketSignature(bus_bytes)),
                "frames": Out(PacketSignature(bus_bytes)),
                "size": Out(SIZE_BITS),
            }
        )

    # With a room of two beats, and a header of two, a message of five beats leaves as
    #
    #     i        H H               b b                   b b                   b
    #     state    TAKE  LENGTH PLAN                 PLAN                  PLAN
    #     frames                H0 H0 b b            H1 H1 b b             H2 H2 b
    #
    # `rest` is subtracted from while a frame leaves, and compared in `PLAN`: a path with both would
    # be too long for a cycle.

    def elaborate(self, platform: object) -> Module:
        m = Module()
        out = frame_output(m, self.frames, self.size, "size")
        header = Signal(header_layout())
        is_empty = Signal()
        # Bytes of the message that are not sent, those of the frame included.
        rest = Signal(32)
        is_final = Signal()
        size = Signal(SIZE_BITS)
        number = Signal(range(max(self.beats, self.room // self.bus_bytes)))
        m.d.comb += out.i.payload.size.eq(size)
        with m.FSM():
            with m.State("TAKE"):
                self._take(m, header, is_empty, number)
            with m.State("LENGTH"):
                m.d.sync += rest.eq(header.length)
                m.next = "PLAN"
            with m.State("PLAN"):
                m.d.sync += [
                    is_final.eq(rest <= self.room),
                    size.eq(HEADER_BYTES + Mux(rest <= self.room, rest[:SIZE_BITS], self.room)),
                ]
                m.next = "HEADER"
            with m.State("HEADER"):
                self._send_header(m, out, header, is_final, is_empty, number)
            with m.State("BODY"):
                self._send_body(m, out, header, rest, is_final, number)
        return m

    def _take(self, m: Module, header: data.View, is_empty: Signal, number: Signal) -> None:
        """Take the header of a message."""
        beat, bits = self.i.payload, 8 * self.bus_bytes
        words = Value.cast(header)
        m.d.comb += self.i.ready.eq(1)
        with m.If(self.i.valid):
            m.d.sync += [
                words.eq(Cat(words[bits:], Value.cast(beat.data))),
                number.eq(number + 1),
                is_empty.eq(beat.last),
            ]
            with m.If(number == self.beats - 1):
                m.d.sync += number.eq(0)
                m.next = "LENGTH"

    def _send_header(
        self,
        m: Module,
        out: StreamSlice,
        header: data.View,
        is_final: Signal,
        is_empty: Signal,
        number: Signal,
    ) -> None:
        """Send the header of a frame."""
        bits = 8 * self.bus_bytes
        sent = Signal(header_layout())
        ends = number == self.beats - 1
        m.d.comb += [
            sent.eq(header),
            sent.flags[0].eq(header.flags[0] & is_final),
            out.i.valid.eq(1),
            Value.cast(out.i.payload.beat.data).eq(
                Value.cast(sent).word_select(number[: (self.beats - 1).bit_length()], bits)
            ),
            out.i.payload.beat.count.eq(self.bus_bytes),
            out.i.payload.beat.last.eq(is_empty & ends),
        ]
        with m.If(out.i.ready):
            m.d.sync += number.eq(Mux(ends, 0, number + 1))
            with m.If(ends):
                m.next = "BODY"
                with m.If(is_empty):
                    m.next = "TAKE"

    def _send_body(
        self,
        m: Module,
        out: StreamSlice,
        header: data.View,
        rest: Signal,
        is_final: Signal,
        number: Signal,
    ) -> None:
        """Send the bytes of a frame; go on with the next one or with the next message."""
        beat = self.i.payload
        ends = Signal()
        m.d.comb += [
            ends.eq(beat.last | (~is_final & (number == self.room // self.bus_bytes - 1))),
            out.i.valid.eq(self.i.valid),
            self.i.ready.eq(out.i.ready),
            out.i.payload.beat.eq(beat),
            out.i.payload.beat.last.eq(ends),
        ]
        with m.If(out.i.valid & out.i.ready):
            m.d.sync += number.eq(Mux(ends, 0, number + 1))
            with m.If(beat.last):
                m.next = "TAKE"
            with m.Elif(ends):
                m.d.sync += [rest.eq(rest - self.room), header.fragment.eq(header.fragment + 1)]
                m.next = "PLAN"


REASSEMBLER_COUNTERS = ("late", "cut", "stray", "malformed")


class Reassembler(wiring.Component):
    """Turn frames into frames of whole messages; mark those that are not whole.

    The rules are those of receivers in ``docs/reference/frame.md``, for fragments in their order.
    The first frame of a message decides whether its number is believed.
    A message is sent on while its fragments come, so the last beat says whether it counts: connect
    `abort` with that of a :class:`PacketFifo`.

    A frame takes as many cycles as it has beats, and 3 more; the first one of a message as many
    again as a header has beats; one that cuts another message 1 more. On Ethernet, preamble,
    addresses and gap take longer.

    Outputs are registers; `i.ready` depends on registers only. One clock domain, `sync`; its reset
    discards the message inside.

    Parameters
    ----------
    bus_bytes : int
        1, 2, 4, 8 or 16.

    Members
    -------
    i : In(PacketSignature(bus_bytes))
        Frames.
    bad : In(1)
        The medium says that the frame is damaged; counts with its last beat.
    o : Out(PacketSignature(bus_bytes))
        Frames of whole messages.
    abort : Out(1)
        With the last beat: the message is not whole.
    passes : Out(1)
        A frame has completed a message that is whole; high for a cycle, which comes before that
        of any later frame.
    begins : Out(1)
        The first beat of a frame is taken in this cycle.
    lost : Out(32)
        Messages that are missing; stops at its largest value.
    counters : Out(counters_layout("late", "cut", "stray", "malformed"))
    """

    def __init__(self, bus_bytes: int):
        self.bus_bytes, self.beats = bus_bytes, header_beats(bus_bytes)
        super().__init__(
            {
                "i": In(PacketSignature(bus_bytes)),
                "bad": In(1),
                "o": Out(PacketSignature(bus_bytes)),
                "abort": Out(1),
                "passes": Out(1),
                "begins": Out(1),
                "lost": Out(32),
                "counters": Out(counters_layout(*REASSEMBLER_COUNTERS)),
            }
        )

    # A frame goes through these states. Each comparison of 16 or 32 bits has a cycle of its own,
    # and its result is a register.
    #
    #     TAKE --> COMPARE --> DECIDE --> HEADER --> BODY --> TAKE     first fragment of a message
    #                  |         |  \------------> BODY --> TAKE       the fragment that is next
    #                  |         |\--> CUT --> DECIDE                  any other, while one is open
    #                  \-> SKIP <-/                                    malformed, late, stray
    #
    # The output has one message at a time. So a frame that does not continue the open message ends
    # it: `CUT` sends a last beat with `abort`, upon which the FIFO behind forgets what it has got,
    # and the frame is decided upon again.

    def elaborate(self, platform: object) -> Module:
        m = Module()
        layout = data.StructLayout({"beat": packet_layout(self.bus_bytes), "abort": 1})
        m.submodules.slice = self._out = out = StreamSlice(layout)
        self._header = Signal(header_layout())
        self._number = Signal(range(self.beats))
        # The frame ended with its header; and it was damaged.
        self._is_empty = Signal()
        self._was_bad = Signal()
        # The message under way: its number, its topic, its next fragment and its missing bytes.
        self._open = Signal()
        self._left = Signal(32)
        self._under_way = Signal(data.StructLayout({"sequence": 16, "topic": 16, "next": 16}))
        # The number that is expected, once a message was whole; how far ahead the frame's is.
        self._expected = Signal(16)
        self._synced = Signal()
        self._ahead = Signal(16)
        # The number that would confirm the last one that was too far away to be believed.
        self._confirms = Signal(16)
        self._doubts = Signal()
        self._continues = Signal()
        self._late = Signal()
        self._far = Signal()
        self._events = {name: Signal(name=f"is_{name}") for name in REASSEMBLER_COUNTERS}
        m.d.comb += [
            self.o.payload.eq(out.o.payload.beat),
            self.abort.eq(out.o.payload.abort),
            self.o.valid.eq(out.o.valid),
            out.o.ready.eq(self.o.ready),
        ]
        with m.FSM():
            with m.State("TAKE"):
                self._take(m)
            with m.State("COMPARE"):
                self._compare(m)
            with m.State("DECIDE"):
                self._decide(m)
            with m.State("CUT"):
                self._cut(m)
            with m.State("HEADER"):
                self._send_header(m)
            with m.State("BODY"):
                self._send_body(m)
            with m.State("SKIP"):
                m.d.comb += self.i.ready.eq(1)
                with m.If(self.i.valid & self.i.payload.last):
                    m.next = "TAKE"
        add_counters(m, self.counters, self._events)
        self._count_lost(m)
        return m

    def _take(self, m: Module) -> None:
        """Take the header of a frame."""
        beat, bits = self.i.payload, 8 * self.bus_bytes
        words, number = Value.cast(self._header), self._number
        ends = number == self.beats - 1
        m.d.comb += [self.i.ready.eq(1), self.begins.eq(self.i.valid & (number == 0))]
        with m.If(self.i.valid):
            m.d.sync += [
                words.eq(Cat(words[bits:], Value.cast(beat.data))),
                number.eq(Mux(beat.last | ends, 0, number + 1)),
                self._is_empty.eq(beat.last),
                self._was_bad.eq(self.bad),
            ]
            with m.If(beat.last & (~ends | (beat.count != self.bus_bytes))):
                m.d.comb += self._events["malformed"].eq(1)
            with m.Elif(ends):
                m.next = "COMPARE"

    def _compare(self, m: Module) -> None:
        """Compare the header with the message under way, and its number with the expected one."""
        header, under_way = self._header, self._under_way
        # The difference is taken modulo 2 ** 16, so what is late is just below that. What starts a
        # sequence, or is the first of all, is what was expected.
        ahead = Signal(16)
        confirmed = Signal()
        starts = header.flags[1]
        late = ahead >= (1 << 16) - LATE_MESSAGES
        m.d.comb += [
            ahead.eq(Mux(self._synced & ~starts, header.sequence - self._expected, 0)),
            confirmed.eq(self._doubts & (header.sequence == self._confirms)),
        ]
        m.d.sync += [
            self._continues.eq(
                self._open
                & (header.sequence == under_way.sequence)
                & (header.topic == under_way.topic)
                & (header.fragment == under_way.next)
                & (header.fragment != 0)
            ),
            self._ahead.eq(ahead),
            self._late.eq(late & ~confirmed),
            self._far.eq(~late & (ahead > LATE_MESSAGES) & ~confirmed),
        ]
        m.next = "DECIDE"
        with m.If(header.version != VERSION):
            m.d.comb += self._events["malformed"].eq(1)
            m.next = "SKIP"
            with m.If(self._is_empty):
                m.next = "TAKE"

    def _decide(self, m: Module) -> None:
        """Decide what becomes of the frame."""
        header = self._header
        begins = (header.fragment == 0) & ~self._late & ~self._far
        with m.If(self._continues):
            m.next = "BODY"
            with m.If(self._is_empty):
                # A fragment without bytes: only a sender that is wrong sends one.
                m.d.comb += self._events["stray"].eq(1)
                m.next = "TAKE"
        with m.Elif(self._open):
            m.next = "CUT"
        with m.Elif(begins):
            self._begin(m)
        with m.Else():
            m.d.comb += [
                self._events["late"].eq(header.fragment == 0),
                self._events["stray"].eq(header.fragment != 0),
            ]
            with m.If(self._far & (header.fragment == 0)):
                m.d.sync += [self._confirms.eq(header.sequence + 1), self._doubts.eq(1)]
            m.next = "SKIP"
            with m.If(self._is_empty):
                m.next = "TAKE"

    def _begin(self, m: Module) -> None:
        header = self._header
        m.d.sync += [
            self._left.eq(header.length),
            self._under_way.sequence.eq(header.sequence),
            self._under_way.topic.eq(header.topic),
            self._under_way.next.eq(0),
        ]
        m.next = "HEADER"

    def _cut(self, m: Module) -> None:
        """End the message under way, which will never be whole."""
        out = self._out.i
        m.d.comb += [
            out.valid.eq(1),
            out.payload.beat.count.eq(self.bus_bytes),
            out.payload.beat.last.eq(1),
            out.payload.abort.eq(1),
            self._events["cut"].eq(out.ready),
        ]
        with m.If(out.ready):
            m.d.sync += self._open.eq(0)
            m.next = "DECIDE"

    def _send_header(self, m: Module) -> None:
        """Send the header of a message, as that of a single frame."""
        out, bits, number = self._out.i, 8 * self.bus_bytes, self._number
        sent = Signal(header_layout())
        ends = number == self.beats - 1
        m.d.comb += [
            sent.eq(self._header),
            sent.flags[0].eq(1),
            out.valid.eq(1),
            Value.cast(out.payload.beat.data).eq(
                Value.cast(sent).word_select(number[: (self.beats - 1).bit_length()], bits)
            ),
            out.payload.beat.count.eq(self.bus_bytes),
        ]
        with m.If(self._is_empty & ends):
            self._end(m, self._left == 0, self._was_bad)
        with m.If(out.ready):
            m.d.sync += number.eq(Mux(ends, 0, number + 1))
            with m.If(ends):
                m.next = "BODY"
                with m.If(self._is_empty):
                    m.next = "TAKE"

    def _send_body(self, m: Module) -> None:
        """Send the bytes of a frame."""
        out, beat = self._out.i, self.i.payload
        is_last_frame = self._header.flags[0]
        m.d.comb += [
            out.valid.eq(self.i.valid),
            self.i.ready.eq(out.ready),
            out.payload.beat.data.eq(beat.data),
            out.payload.beat.count.eq(Mux(beat.last, beat.count, self.bus_bytes)),
        ]
        with m.If(beat.last):
            whole = Mux(is_last_frame, self._left == beat.count, beat.count == self.bus_bytes)
            self._end(m, whole, self.bad)
        with m.If(out.valid & out.ready):
            m.d.sync += self._left.eq(self._left - self.bus_bytes)
            with m.If(beat.last):
                m.next = "TAKE"

    def _end(self, m: Module, whole: Value, bad: Value) -> None:
        """End a frame: with the last one of a message, or a wrong one, the message ends, too.

        Only the last beat of a message has `last`, so its fragments become one packet.
        """
        out, header = self._out.i, self._header
        is_last_frame = header.flags[0]
        fails = Signal()
        moves = Signal()
        m.d.comb += [
            fails.eq(~whole | bad),
            moves.eq(out.valid & out.ready),
            out.payload.beat.last.eq(is_last_frame | fails),
            out.payload.abort.eq(fails),
            self._events["cut"].eq(moves & fails),
            self.passes.eq(moves & is_last_frame & ~fails),
        ]
        with m.If(moves):
            m.d.sync += [
                self._open.eq(~is_last_frame & ~fails),
                self._under_way.next.eq(self._under_way.next + 1),
            ]

    def _count_lost(self, m: Module) -> None:
        """Count the messages between the last one that was whole and this one."""
        gap = Signal(16)
        total = Signal(33)
        # Behind is a new sequence. Of that, only the message that was not believed is missing.
        missing = Mux(self._ahead[15], 1, self._ahead)
        m.d.sync += gap.eq(Mux(self.passes, missing, 0))
        m.d.comb += total.eq(self.lost + gap)
        m.d.sync += self.lost.eq(Mux(total[32], 0xFFFF_FFFF, total[:32]))
        with m.If(self.passes):
            m.d.sync += [
                self._expected.eq(self._header.sequence + 1),
                self._synced.eq(1),
                self._doubts.eq(0),
            ]
