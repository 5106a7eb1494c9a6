"""Cut frames that are too large for a datagram into fragments."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.signatures import packet_layout
from firm_hdl.node.frame import FRAGMENT_UNIT, HEADER_BYTES
from firm_hdl.node.gateware.header import header_beats
from firm_hdl.node.gateware.streams import header_layout

__all__ = ["Fragmenter"]

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

    def elaborate(self, platform: object) -> Module:
        m = Module()
        layout = data.StructLayout({"beat": packet_layout(self.bus_bytes), "size": SIZE_BITS})
        m.submodules.slice = out = StreamSlice(layout)
        header, is_empty = Signal(header_layout()), Signal()
        # Bytes of the message that are not sent, those of the frame included.
        rest, is_final, size = Signal(32), Signal(), Signal(SIZE_BITS)
        number = Signal(range(max(self.beats, self.room // self.bus_bytes)))
        m.d.comb += [
            out.i.payload.size.eq(size),
            self.frames.payload.eq(out.o.payload.beat),
            self.frames.valid.eq(out.o.valid),
            self.size.eq(out.o.payload.size),
            out.o.ready.eq(self.frames.ready),
        ]
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
        beat, ends = self.i.payload, Signal()
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
