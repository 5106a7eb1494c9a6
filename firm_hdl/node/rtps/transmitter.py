"""From templates, fields and payloads to datagrams."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Signal
from amaranth.lib import data, wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.ethernet.datagrams import DatagramSignature
from firm_hdl.gateware.packets.slice import StreamSlice
from firm_hdl.node.rtps.templates import PAYLOAD, Templates, fields_layout, op_layout

__all__ = ["Transmitter", "order_layout"]


def order_layout(rom_words: int, memory_bytes: int) -> data.StructLayout:
    """Return what is to be sent.

    Members
    -------
    start : range(rom_words)
        Place of the template.
    size : unsigned(16)
        Bytes of the datagram.
    address, port : unsigned(32), unsigned(16)
        Where to.
    base, mask, at : bits of an address in the memory of samples
        Byte n of the payload is at ``base | ((at + n) & mask)``; `at` is a multiple of 4.
    payload_bytes : unsigned(16)
    fields : fields_layout()
    """
    address = max(1, ceil_log2(memory_bytes))
    return data.StructLayout(
        {
            "start": range(rom_words),
            "size": 16,
            "address": 32,
            "port": 16,
            "base": address,
            "mask": address,
            "at": address,
            "payload_bytes": 16,
            "fields": fields_layout(),
        }
    )


class Transmitter(wiring.Component):
    """Play a template, word by word.

    A word per cycle; 2 cycles from `starts` to the first one, and 2 more before and behind a
    payload. A payload is padded to a multiple of 4 bytes (9.4.1), as it is in the memory.

    Parameters
    ----------
    templates : Templates
    memory_bytes : int
        Of the memory of samples.
    port : int
        Where datagrams come from.

    Members
    -------
    order : In(order_layout(...))
        Must not change from `starts` to `ends`.
    starts : In(1)
        Send; only while nothing is sent.
    ends : Out(1)
        High for one cycle when the last word has been passed on.
    read_at, reads, word : Out, Out(1), In(32)
        Port of the memory of samples, whose word comes a cycle later.
    datagrams : Out(DatagramSignature(4))
    """

    def __init__(self, templates: Templates, memory_bytes: int, port: int):
        self.rom, self.port = templates.rom, port
        layout = order_layout(len(self.rom), memory_bytes)
        super().__init__(
            {
                "order": In(layout),
                "starts": In(1),
                "ends": Out(1),
                "read_at": Out(layout.members["at"]),
                "reads": Out(1),
                "word": In(32),
                "datagrams": Out(DatagramSignature(4)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        order = self.order
        m.submodules.slice = out = StreamSlice(data.StructLayout({"data": 32, "last": 1}))
        datagrams, word = self.datagrams, self.datagrams.payload
        m.submodules.rom = rom = Memory(shape=op_layout(), depth=len(self.rom), init=self.rom)
        op_port = rom.read_port()
        op = op_port.data
        at = Signal(range(len(self.rom) + 1))
        place = Signal(15)
        moves, is_end, is_last = Signal(), Signal(), Signal()
        # The first word of the fields has the number 1.
        field = Cat(Const(0, 32), order.fields).word_select(op.field, 32)
        m.d.comb += [
            datagrams.valid.eq(out.o.valid),
            out.o.ready.eq(datagrams.ready),
            word.data.eq(out.o.payload.data),
            word.last.eq(out.o.payload.last),
            word.last_be.eq(Cat(Const(0, 3), word.last)),
            word.length.eq(order.size),
            word.ip_address.eq(order.address),
            word.src_port.eq(self.port),
            word.dst_port.eq(order.port),
            self.ends.eq(datagrams.valid & datagrams.ready & word.last),
            moves.eq(out.i.valid & out.i.ready),
            op_port.addr.eq(at),
            is_end.eq(Cat(Const(0, 2), place) >= order.payload_bytes),
            self.read_at.eq(order.base | ((order.at + Cat(Const(0, 2), place)) & order.mask)),
        ]
        # Each state reads the word of the next cycle.
        with m.FSM():
            with m.State("IDLE"):
                m.d.comb += op_port.en.eq(0)
                m.d.sync += at.eq(order.start)
                with m.If(self.starts):
                    m.next = "READ"
            with m.State("READ"):
                m.d.comb += op_port.en.eq(1)
                m.d.sync += [at.eq(at + 1), place.eq(0)]
                m.next = "PLAY"
            with m.State("PLAY"):
                is_payload = op.field == PAYLOAD
                m.d.comb += [
                    out.i.valid.eq(~is_payload),
                    out.i.payload.data.eq(op.value | field),
                    out.i.payload.last.eq(op.last),
                    op_port.en.eq(moves),
                ]
                with m.If(moves):
                    m.d.sync += at.eq(at + 1)
                    with m.If(op.last):
                        m.next = "IDLE"
                with m.If(is_payload):
                    m.d.comb += [op_port.en.eq(1), self.reads.eq(1)]
                    m.d.sync += [at.eq(at + 1), place.eq(1), is_last.eq(op.last)]
                    m.next = "PAYLOAD"
            with m.State("PAYLOAD"):
                # `place` is one ahead, as the memory answers a cycle later.
                m.d.comb += [
                    out.i.payload.last.eq(is_last & is_end),
                    out.i.valid.eq(1),
                    out.i.payload.data.eq(self.word),
                    op_port.en.eq(0),
                    self.reads.eq(moves),
                ]
                with m.If(moves):
                    m.d.sync += place.eq(place + 1)
                    with m.If(is_end):
                        m.next = "PLAY"
                        with m.If(is_last):
                            m.next = "IDLE"
        return m
