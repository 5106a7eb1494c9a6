"""Headers: added to packets on the way to the host, and taken off on the way back."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.node.frame import FLAG_LAST, FLAG_START, HEADER_BYTES, VERSION
from firm_hdl.node.gateware.streams import (
    TOPIC_BITS,
    LinkSignature,
    header_layout,
    link_layout,
    passes,
)

__all__ = ["HeaderInsert", "HeaderStrip", "frame_output", "header_beats"]


def header_beats(bus_bytes: int) -> int:
    """Return the number of beats of a header.

    Raises `ValueError` if the header does not fill whole beats.
    """
    if HEADER_BYTES % bus_bytes:
        raise ValueError(f"Bus width must be at most {HEADER_BYTES} bytes, not {bus_bytes}")
    return HEADER_BYTES // bus_bytes


def frame_output(m: Module, frames: stream.Interface, beside: Value, name: str) -> StreamSlice:
    """Return a slice before an output of frames; its payload also has what is beside each beat."""
    layout = data.StructLayout({"beat": frames.payload.shape(), name: len(beside)})
    m.submodules.slice = out = StreamSlice(layout)
    m.d.comb += [
        frames.payload.eq(out.o.payload.beat),
        frames.valid.eq(out.o.valid),
        out.o.ready.eq(frames.ready),
        beside.eq(out.o.payload[name]),
    ]
    return out


class HeaderInsert(wiring.Component):
    """Make a frame of each message: its header, then its bytes.

    A message is one frame, whatever its size. Messages are numbered from 0, and the first one after
    a reset says that the sender has started.

    Latency 1 cycle to the first beat of the header. A beat leaves per cycle. `i.ready` depends on
    registers and on `i.payload`; outputs are registers. One clock domain, `sync`.

    Parameters
    ----------
    bus_bytes : int
        1, 2, 4, 8 or 16.

    Members
    -------
    i : In(LinkSignature(bus_bytes))
    frames : Out(PacketSignature(bus_bytes))
    topic : Out(16)
        Topic of the frame, in all its beats.
    """

    def __init__(self, bus_bytes: int):
        self.bus_bytes, self.beats = bus_bytes, header_beats(bus_bytes)
        super().__init__(
            {
                "i": In(LinkSignature(bus_bytes)),
                "frames": Out(PacketSignature(bus_bytes)),
                "topic": Out(TOPIC_BITS),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        out = frame_output(m, self.frames, self.topic, "topic")
        came, beat, bits = self.i.payload, self.i.payload.beat, 8 * self.bus_bytes
        # The first beat of a message waits on `i` while its header is sent:
        #
        #     i        b0  b0  b0  b1  b2        sent   0  1  2  2  2    (a header of 2 beats)
        #     slice    H   H   b0  b1  b2
        header = Signal(header_layout())
        sequence = Signal(16)
        starts = Signal(init=1)
        # Beats of the header that were sent.
        sent = Signal(range(self.beats + 1))
        in_header = Signal()
        is_empty = Signal()
        ends_header = sent == self.beats - 1
        m.d.comb += [
            header.version.eq(VERSION),
            header.flags.eq(Mux(starts, FLAG_LAST | FLAG_START, FLAG_LAST)),
            header.topic.eq(came.topic),
            header.length.eq(came.length),
            header.tag.eq(came.tag),
            header.sequence.eq(sequence),
            in_header.eq(sent != self.beats),
            is_empty.eq(beat.last & (beat.count == 0)),
            out.i.payload.topic.eq(came.topic),
            out.i.valid.eq(self.i.valid),
            # A message without bytes ends with its header.
            self.i.ready.eq(out.i.ready & (~in_header | (is_empty & ends_header))),
        ]
        with m.If(in_header):
            word = Value.cast(header).word_select(sent[: (self.beats - 1).bit_length()], bits)
            m.d.comb += [
                Value.cast(out.i.payload.beat.data).eq(word),
                out.i.payload.beat.count.eq(self.bus_bytes),
                out.i.payload.beat.last.eq(is_empty & ends_header),
            ]
        with m.Else():
            m.d.comb += out.i.payload.beat.eq(beat)
        with m.If(out.i.valid & out.i.ready):
            m.d.sync += sent.eq(Mux(in_header, sent + 1, sent))
            with m.If(out.i.payload.beat.last):
                m.d.sync += [sent.eq(0), sequence.eq(sequence + 1), starts.eq(0)]
        return m


class HeaderStrip(wiring.Component):
    """Take the header off a frame that is a whole message.

    A frame that is shorter than a header, of another version, or a part of a message only, is
    dropped. Whether it has as many bytes as its header says is not checked.

    Latency 1 cycle from a beat to the same beat on `o`. A beat is taken per cycle. All outputs are
    registers. One clock domain, `sync`; its reset discards the frame inside, and the next beat
    begins a frame.

    Parameters
    ----------
    bus_bytes : int
        1, 2, 4, 8 or 16.

    Members
    -------
    frames : In(PacketSignature(bus_bytes))
    o : Out(LinkSignature(bus_bytes))
    passes, malformed : Out(1)
        High in the cycle in which the last beat of a frame is taken that is passed on or dropped.
    """

    def __init__(self, bus_bytes: int):
        self.bus_bytes, self.beats = bus_bytes, header_beats(bus_bytes)
        super().__init__(
            {
                "frames": In(PacketSignature(bus_bytes)),
                "o": Out(LinkSignature(bus_bytes)),
                "passes": Out(1),
                "malformed": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.slice = out = StreamSlice(link_layout(self.bus_bytes))
        beat, bits = self.frames.payload, 8 * self.bus_bytes
        # `words` is a shift register of the header. The frame is judged with the last beat of its
        # header, whose bytes are still on `frames`, so no cycle is lost:
        #
        #     frames   H   H   b0  b1            took   0  1  2  2       (a header of 2 beats)
        #     slice            b0  b1            `good` is a register from the beat b0 on
        words = Signal(header_layout())
        header = Signal(header_layout())
        took = Signal(range(self.beats + 1))
        in_header = Signal()
        ends_header = Signal()
        is_good = Signal()
        good = Signal()
        is_empty = Signal()
        emits = Signal()
        shifted = Cat(Value.cast(words)[bits:], Value.cast(beat.data))
        m.d.comb += [
            in_header.eq(took != self.beats),
            ends_header.eq(took == self.beats - 1),
            # With its last beat, the header is complete.
            Value.cast(header).eq(Mux(in_header, shifted, Value.cast(words))),
            is_good.eq((header.version == VERSION) & header.flags[0] & (header.fragment == 0)),
            is_empty.eq(ends_header & beat.last & (beat.count == self.bus_bytes) & is_good),
            emits.eq(Mux(in_header, is_empty, good)),
            self.frames.ready.eq(out.i.ready),
            out.i.valid.eq(self.frames.valid & emits),
            out.i.payload.beat.data.eq(beat.data),
            out.i.payload.beat.count.eq(Mux(in_header, 0, beat.count)),
            out.i.payload.beat.last.eq(beat.last),
            out.i.payload.topic.eq(header.topic),
            out.i.payload.tag.eq(header.tag),
            out.i.payload.length.eq(header.length),
            *passes(out.o, self.o),
        ]
        with m.If(self.frames.valid & self.frames.ready):
            with m.If(in_header):
                m.d.sync += [words.eq(header), took.eq(took + 1), good.eq(is_good)]
            with m.If(beat.last):
                m.d.sync += took.eq(0)
                m.d.comb += [self.passes.eq(emits), self.malformed.eq(~emits)]
        return m
