"""Echo of ICMP (RFC 792, RFC 1122, 3.2.2.6)."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.ipv4 import Ipv4Signature, in_payload
from firm_hdl.ethernet.slots import ECHO, ECHO_REST, SlotWriterSignature
from firm_hdl.ethernet.streams import add_word

__all__ = ["EchoReceiver"]

_REQUEST = 8
_HEADER_BYTES = 8


class EchoReceiver(wiring.Component):
    """Turn requests for an echo into replies.

    The checksum of a request is checked. That of the reply is the request's, changed by what the
    type changes (RFC 1624).

    A request in fragments is answered by as many, each as it comes, without putting them together:
    a fragment is answered if it continues the last request that began. Its checksum cannot be
    checked then; if it is wrong, so is that of the reply.

    A request to a group, or with options of IPv4, is not answered.

    Members
    -------
    datagrams : In(Ipv4Signature())
    right : In(1)
        As that of a :class:`firm_hdl.ethernet.ipv4.PayloadCheck`.
    reply : Out(SlotWriterSignature())
        Bytes 0 and 1 of the header are the checksum, 6 to 9 the destination, 10 to 15 length,
        identification and fragment. The payload is what follows the checksum, or all of it in a
        later fragment.
    wrong, other, full : Out(1)
        Strobes: a request had a wrong checksum; a message is none that is answered; there was no
        free slot.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "datagrams": In(Ipv4Signature()),
                "right": In(1),
                "reply": Out(SlotWriterSignature()),
                "wrong": Out(1),
                "other": Out(1),
                "full": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, header, reply = self.datagrams.bytes, self.datagrams.header, self.reply
        byte, place = came.payload.data, header.place
        is_payload, first = in_payload(header), header.first
        count = Signal.like(reply.payload_at)
        request, room, continues, answers = Signal(), Signal(), Signal(), Signal()
        checksum = Signal(16)
        # The request that may go on, and where.
        source, identification = Signal(32), Signal(16)
        next_offset, more = Signal(13), Signal()
        ends, writes_sum = Signal(), Signal(3)
        m.d.comb += [
            reply.kind.eq(Mux(first, ECHO, ECHO_REST)),
            # Bytes 2 to 7 go to 10 to 15, and those of the source to 6 to 9.
            reply.header_at.eq(
                Mux(place[3], Cat(place[0], ~place[1], ~place[1], place[1]), place[:3] | 8)
            ),
            reply.header_byte.eq(byte),
            reply.payload_at.eq(count),
            reply.payload_word.eq(byte),
        ]
        m.d.sync += [
            continues.eq(
                more
                & (source == header.source)
                & (identification == header.identification)
                & (next_offset == header.offset)
            ),
            # All of it is there a cycle before `ends`.
            answers.eq(
                ~header.options
                & header.to_node
                & Mux(first, request & (header.length >= _HEADER_BYTES), continues)
            ),
            writes_sum.eq(writes_sum << 1),
            ends.eq(came.valid & came.payload.end & came.payload.good & header.icmp),
            self.wrong.eq(0),
            self.other.eq(0),
            self.full.eq(0),
        ]
        with m.If(came.valid & ~came.payload.end & ~is_payload):
            m.d.sync += count.eq(0)
            with m.Switch(place):
                with m.Case(0):
                    m.d.sync += room.eq(reply.free)
                with m.Case(2, 3, 4, 5, 6, 7, 12, 13, 14, 15):
                    m.d.comb += reply.header_write.eq(1)
            # The bit that RFC 791 reserves is sent as 0.
            with m.If(place == 6):
                m.d.comb += reply.header_byte.eq(byte & 0x7F)
        with m.Elif(came.valid & ~came.payload.end):
            with m.If(first & (header.index < 4)), m.Switch(header.index):
                with m.Case(0):
                    m.d.sync += request.eq(byte == _REQUEST)
                with m.Case(1):
                    m.d.sync += request.eq(request & (byte == 0))
                with m.Case(2):
                    m.d.sync += checksum[8:].eq(byte)
                with m.Case(3):
                    m.d.sync += checksum[:8].eq(byte)
                    m.d.sync += writes_sum.eq(1)
            with m.Else():
                m.d.comb += reply.payload_write.eq(header.icmp)
                m.d.sync += count.eq(count + 1)
        # The sum is known when no other byte of the header comes. The type goes from 8 to 0, so the
        # checksum, which is the complement of a sum, rises by 8 << 8.
        with m.If(writes_sum[0]):
            total = add_word(Cat(checksum, Const(0, 1)), Const(_REQUEST << 8, 16))
            m.d.sync += checksum.eq(total[:16] + total[16])
        with m.If(writes_sum[1:].any()):
            m.d.comb += [
                reply.header_write.eq(header.icmp),
                reply.header_at.eq(writes_sum[2]),
                reply.header_byte.eq(Mux(writes_sum[1], checksum[8:], checksum[:8])),
            ]
        with m.If(ends):
            whole = first & ~header.more
            checked = answers & (self.right | ~whole)
            m.d.comb += reply.commit.eq(checked & room)
            m.d.sync += [
                self.other.eq(~answers),
                self.wrong.eq(answers & ~checked),
                self.full.eq(checked & ~room),
            ]
            with m.If(checked):
                m.d.sync += [
                    source.eq(header.source),
                    identification.eq(header.identification),
                    next_offset.eq(header.offset + header.length[3:]),
                    more.eq(header.more & room),
                ]
        return m
