"""Frames on a stream of bytes: COBS with a CRC, as `firm_hdl.node.bytestream` writes them."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.crc.catalog import CRC32_ETHERNET
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.gateware.signatures import packet_layout
from firm_hdl.node.bytestream import CRC_BYTES, MOST_IN_BLOCK
from firm_hdl.node.gateware.streams import passes

__all__ = ["ByteFrameReader", "ByteFrameWriter", "CobsDecoder", "CobsEncoder"]

BYTES = stream.Signature(8)


class CobsEncoder(wiring.Component):
    """Stuff the bytes of each packet, so that none is 0; send 0 before and after it.

    A block, at most 254 bytes, is stored before it is sent. So n bytes take about 2 n cycles.
    Outputs are registers. One clock domain, `sync`; its reset discards the packet inside.

    Members
    -------
    i : In(PacketSignature(1))
        Packets with a byte at least.
    o : Out(stream.Signature(8))
    """

    def __init__(self) -> None:
        super().__init__({"i": In(PacketSignature(1)), "o": Out(BYTES)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.slice = out = StreamSlice(8)
        m.submodules.block = block = Memory(shape=8, depth=256, init=[])
        write, read = block.write_port(), block.read_port(domain="comb")
        byte = self.i.payload.data[0]
        # A block begins with a code, one more than its bytes, so all of them come first:
        #
        #     i        11 22 00 33(last)
        #     state    FILL     CODE BYTES  FILL CODE BYTES END
        #     out               03   11 22       02   33    00      (a 00 came before)
        #
        # Bytes in the block, and those that were sent. The block ends with a 0, which it stands
        # for, or the packet ends with it.
        size = Signal(8)
        sent = Signal(8)
        ends_packet = Signal()
        # One more block follows the last byte, if that is a 0 or fills its block.
        needs_block = (byte == 0) | (size == MOST_IN_BLOCK - 1)
        more = Signal()
        m.d.comb += [
            write.addr.eq(size),
            write.data.eq(byte),
            read.addr.eq(sent),
            *passes(out.o, self.o),
        ]
        with m.FSM():
            with m.State("BEGIN"):
                m.d.comb += out.i.valid.eq(self.i.valid)
                m.d.sync += [size.eq(0), more.eq(0), ends_packet.eq(0)]
                with m.If(self.i.valid & out.i.ready):
                    m.next = "FILL"
            with m.State("FILL"):
                m.d.comb += [self.i.ready.eq(1), write.en.eq(self.i.valid & (byte != 0))]
                with m.If(self.i.valid):
                    m.d.sync += [
                        size.eq(size + (byte != 0)),
                        ends_packet.eq(self.i.payload.last & ~needs_block),
                        more.eq(self.i.payload.last & needs_block),
                    ]
                    with m.If(needs_block | self.i.payload.last):
                        m.next = "CODE"
            with m.State("CODE"):
                m.d.comb += [out.i.valid.eq(1), out.i.payload.eq(size + 1)]
                m.d.sync += sent.eq(0)
                with m.If(out.i.ready):
                    m.next = "BYTES"
            with m.State("BYTES"):
                m.d.comb += [out.i.valid.eq(sent != size), out.i.payload.eq(read.data)]
                with m.If(sent == size):
                    m.d.sync += size.eq(0)
                    m.next = "FILL"
                    with m.If(more):
                        m.d.sync += [more.eq(0), ends_packet.eq(1)]
                        m.next = "CODE"
                    with m.Elif(ends_packet):
                        m.next = "END"
                with m.Elif(out.i.ready):
                    m.d.sync += sent.eq(sent + 1)
            with m.State("END"):
                m.d.comb += out.i.valid.eq(1)
                with m.If(out.i.ready):
                    m.next = "BEGIN"
        return m


class CobsDecoder(wiring.Component):
    """Undo COBS. Zeros end frames; what is between two of them is no frame if it is empty.

    A byte is taken per cycle. Latency 1 cycle. Outputs are registers. One clock domain, `sync`.

    Members
    -------
    i : In(stream.Signature(8))
    o : Out(stream.Signature(StructLayout({"byte": 8, "ends": 1, "bad": 1})))
        A byte of a frame; or, with `ends`, the end of a frame, and whether its last block was cut.
    """

    def __init__(self) -> None:
        layout = data.StructLayout({"byte": 8, "ends": 1, "bad": 1})
        super().__init__({"i": In(BYTES), "o": Out(stream.Signature(layout))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.slice = out = StreamSlice(self.o.payload.shape())
        byte = self.i.payload
        moves = Signal()
        # Bytes of the block that are missing; the frame has begun; a 0 follows the block. A block's
        # 0 is given out in place of the next code, as the last block of a frame stands for none:
        # whether it was the last is known by then.
        #
        #     i       03 11 22 02 33 00
        #     left    0  2  1  0  1  0
        #     out        11 22 00 33 ends
        left = Signal(8)
        inside = Signal()
        zero = Signal()
        is_end, is_code = byte == 0, left == 0
        m.d.comb += [
            moves.eq(self.i.valid & self.i.ready),
            self.i.ready.eq(out.i.ready),
            out.i.payload.byte.eq(Mux(is_code, 0, byte)),
            out.i.payload.ends.eq(is_end),
            out.i.payload.bad.eq(~is_code),
            out.i.valid.eq(self.i.valid & Mux(is_end | is_code, inside & (is_end | zero), 1)),
            *passes(out.o, self.o),
        ]
        with m.If(moves):
            m.d.sync += inside.eq(~is_end)
            with m.If(is_end):
                m.d.sync += left.eq(0)
            with m.Elif(is_code):
                m.d.sync += [left.eq(byte - 1), zero.eq(byte != MOST_IN_BLOCK + 1)]
            with m.Else():
                m.d.sync += left.eq(left - 1)
        return m


class ByteFrameWriter(wiring.Component):
    """Write frames to a stream of bytes: CRC, then COBS.

    Members
    -------
    frames : In(PacketSignature(1))
        Frames with a byte at least.
    o : Out(stream.Signature(8))
    """

    def __init__(self) -> None:
        super().__init__({"frames": In(PacketSignature(1)), "o": Out(BYTES)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.crc = crc = CRC32_ETHERNET(8).create()
        m.submodules.cobs = cobs = CobsEncoder()
        beat, out = self.frames.payload, cobs.i
        number = Signal(range(CRC_BYTES))
        m.d.comb += [
            out.payload.count.eq(1),
            crc.data.eq(beat.data[0]),
            *passes(cobs.o, self.o),
        ]
        with m.FSM():
            with m.State("FRAME"):
                m.d.comb += [
                    out.payload.data.eq(beat.data),
                    out.valid.eq(self.frames.valid),
                    self.frames.ready.eq(out.ready),
                    crc.valid.eq(self.frames.valid & out.ready),
                ]
                with m.If(self.frames.valid & out.ready & beat.last):
                    m.next = "CRC"
            with m.State("CRC"):
                m.d.comb += [
                    Value.cast(out.payload.data).eq(crc.crc.word_select(number, 8)),
                    out.valid.eq(1),
                    out.payload.last.eq(number == CRC_BYTES - 1),
                ]
                with m.If(out.ready):
                    m.d.sync += number.eq(number + 1)
                    with m.If(number == CRC_BYTES - 1):
                        m.d.comb += crc.start.eq(1)
                        m.next = "FRAME"
        return m


class ByteFrameReader(wiring.Component):
    """Read frames from a stream of bytes, after any garbage: COBS, then CRC.

    Outputs are registers. One clock domain, `sync`; its reset discards the frame inside.

    Members
    -------
    i : In(stream.Signature(8))
    frames : Out(PacketSignature(1))
    bad : Out(1)
        With the last beat: the CRC is wrong, or a block was cut.
    short : Out(1)
        High for a cycle for each frame that has no byte before its CRC; it has no beats.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "i": In(BYTES),
                "frames": Out(PacketSignature(1)),
                "bad": Out(1),
                "short": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.cobs = cobs = CobsDecoder()
        m.submodules.crc = crc = CRC32_ETHERNET(8).create()
        layout = data.StructLayout({"beat": packet_layout(1), "bad": 1})
        m.submodules.slice = out = StreamSlice(layout)
        came = cobs.o
        moves = Signal()
        # Only the end of a frame tells that the four bytes before it were the CRC, and that the one
        # before them was its last. So five bytes wait, and each further one lets the oldest pass.
        waiting = Signal(8 * (CRC_BYTES + 1))
        count = Signal(range(CRC_BYTES + 2))
        is_full, ends = count == CRC_BYTES + 1, came.payload.ends
        m.d.comb += [
            *passes(self.i, cobs.i),
            moves.eq(came.valid & came.ready),
            came.ready.eq(out.i.ready),
            crc.data.eq(came.payload.byte),
            crc.valid.eq(moves & ~ends),
            crc.start.eq(moves & ends),
            out.i.valid.eq(came.valid & is_full),
            Value.cast(out.i.payload.beat.data).eq(waiting[:8]),
            out.i.payload.beat.count.eq(1),
            out.i.payload.beat.last.eq(ends),
            out.i.payload.bad.eq(came.payload.bad | ~crc.match_detected),
            self.frames.payload.eq(out.o.payload.beat),
            self.bad.eq(out.o.payload.bad),
            self.frames.valid.eq(out.o.valid),
            out.o.ready.eq(self.frames.ready),
        ]
        m.d.sync += self.short.eq(moves & ends & ~is_full)
        with m.If(moves):
            with m.If(ends):
                m.d.sync += count.eq(0)
            with m.Else():
                m.d.sync += [
                    waiting.eq(Cat(waiting[8:], came.payload.byte)),
                    count.eq(Mux(is_full, count, count + 1)),
                ]
        return m
