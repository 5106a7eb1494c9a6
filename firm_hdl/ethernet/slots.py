"""Slots in which frames wait to be sent: the bytes that their headers need, and their payload."""

from __future__ import annotations

from amaranth.hdl import Array, Cat, Module, Signal
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.memories import BlockMemory

__all__ = [
    "ARP_REPLY",
    "DATAGRAM",
    "ECHO",
    "ECHO_REST",
    "PAYLOAD_BYTES",
    "FrameSlots",
    "SlotReaderSignature",
    "SlotWriterSignature",
]

ARP_REPLY, ECHO, ECHO_REST, DATAGRAM = range(4)
"""Kinds of frames; `ECHO_REST` is a fragment of an echo reply that is not its first one."""

PAYLOAD_BYTES = 2048
HEADER_BYTES = 32


def SlotWriterSignature(word_bytes: int = 1) -> wiring.Signature:
    """Return how a frame gets into a slot, seen from the writer. Its payload comes in words.

    Members
    -------
    free : In(1)
        There is a slot. Without one, writes have no effect. A slot that is free stays so until the
        commit, so a frame for which there was one with its first byte may be committed.
    header_write, header_at, header_byte : Out(1), Out(5), Out(8)
        Write a byte of the header.
    payload_write, payload_at, payload_word : Out(1), Out(11), Out(8 * word_bytes)
        Write a word of the payload, at a multiple of its size. The first byte is the lowest one.
    begins : Out(1)
        Strobe: the frame may be sent; what is missing will be there when it is its turn.
    commit : Out(1)
        Strobe: the frame is complete. May come with the last write.
    kind : Out(2)
        What the frame is; counts with `commit`.
    """
    return wiring.Signature(
        {
            "free": In(1),
            "header_write": Out(1),
            "header_at": Out(range(HEADER_BYTES)),
            "header_byte": Out(8),
            "payload_write": Out(1),
            "payload_at": Out(range(PAYLOAD_BYTES)),
            "payload_word": Out(8 * word_bytes),
            "begins": Out(1),
            "commit": Out(1),
            "kind": Out(2),
        }
    )


def SlotReaderSignature() -> wiring.Signature:
    """Return how a frame gets out of a slot, seen from the reader.

    Members
    -------
    full : In(1)
        There is a frame, the oldest one.
    kind : In(2)
    header_at : Out(5)
    header_byte : In(8)
        Depends combinationally on `header_at`.
    payload_at : Out(11)
    payload_moves : Out(1)
    payload_byte : In(8)
        That of `payload_at` in the last but one cycle with `payload_moves`.
    release : Out(1)
        Strobe: the frame is done.
    """
    return wiring.Signature(
        {
            "full": In(1),
            "kind": In(2),
            "header_at": Out(range(HEADER_BYTES)),
            "header_byte": In(8),
            "payload_at": Out(range(PAYLOAD_BYTES)),
            "payload_moves": Out(1),
            "payload_byte": In(8),
            "release": Out(1),
        }
    )


class FrameSlots(wiring.Component):
    """Frames that wait to be sent, in order.

    Payloads lie in block RAM, 2 KiB a slot, headers in distributed RAM. A slot is written or read,
    never both.

    Parameters
    ----------
    slots : int
        A power of two.
    header_bytes : int
        Bytes of a header that are kept: 16 or 32.
    word_bytes : int
        1 or 4.

    Members
    -------
    writer : In(SlotWriterSignature(word_bytes))
    reader : In(SlotReaderSignature())
    """

    def __init__(self, slots: int, header_bytes: int, word_bytes: int = 1):
        self.slots, self.header_bytes, self.word_bytes = slots, header_bytes, word_bytes
        super().__init__(
            {
                "writer": In(SlotWriterSignature(word_bytes)),
                "reader": In(SlotReaderSignature()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, goes = self.writer, self.reader
        m.submodules.headers = headers = memory.Memory(
            shape=8, depth=self.slots * self.header_bytes, init=[]
        )
        words = self.slots * PAYLOAD_BYTES // self.word_bytes
        payloads = BlockMemory(m, 8 * self.word_bytes, words)
        # The word is in a register, because memories are slow; and which one of its bytes counts.
        lanes = (self.word_bytes - 1).bit_length()
        held, lane, lane_before = Signal.like(payloads.word), Signal(lanes), Signal(lanes)
        header_in, header_out = headers.write_port(), headers.read_port(domain="comb")
        # Of the slots, the one that is written, and the one that is read.
        written, read = Signal(range(self.slots)), Signal(range(self.slots))
        full = Signal(self.slots)
        kinds = Array(Signal(2, name=f"kind_{slot}") for slot in range(self.slots))
        # A frame counts a cycle after its `commit`: it is a long way to that.
        free, commits, kind = Signal(), Signal(), Signal(2)
        # A frame that counts already is still written.
        begun, writes = Signal(), Signal()
        header_bits = range(self.header_bytes)[-1].bit_length()
        m.d.comb += [
            free.eq(~full.bit_select(written, 1) & ~commits),
            came.free.eq(free),
            writes.eq(free | begun),
            header_in.addr.eq(Cat(came.header_at[:header_bits], written)),
            header_in.data.eq(came.header_byte),
            header_in.en.eq(came.header_write & writes),
            payloads.write_at.eq(Cat(came.payload_at[lanes:], written)),
            payloads.write_word.eq(came.payload_word),
            payloads.writes.eq(came.payload_write & writes),
            goes.full.eq(full.bit_select(read, 1)),
            goes.kind.eq(kinds[read]),
            header_out.addr.eq(Cat(goes.header_at[:header_bits], read)),
            goes.header_byte.eq(header_out.data),
            payloads.read_at.eq(Cat(goes.payload_at[lanes:], read)),
            payloads.reads.eq(goes.payload_moves),
            goes.payload_byte.eq(held.word_select(lane, 8)),
        ]
        m.d.sync += [commits.eq(came.commit & writes), kind.eq(came.kind)]
        with m.If(goes.payload_moves):
            m.d.sync += [
                held.eq(payloads.word),
                lane_before.eq(goes.payload_at[:lanes]),
                lane.eq(lane_before),
            ]
        with m.If(commits | (came.begins & free)):
            m.d.sync += begun.eq(~commits)
            with m.If(~begun):
                m.d.sync += full.bit_select(written, 1).eq(1)
        with m.If(commits):
            m.d.sync += [kinds[written].eq(kind), written.eq(written + 1)]
        with m.If(goes.release):
            m.d.sync += [full.bit_select(read, 1).eq(0), read.eq(read + 1)]
        return m
