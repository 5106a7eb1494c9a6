"""Datagrams of UDP that IPv4 cut into fragments (RFC 791, 3.2; RFC 815)."""

from __future__ import annotations

from amaranth.hdl import Array, Cat, Module, Mux, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.ipv4 import Ipv4Signature, check_state_layout, in_payload
from firm_hdl.ethernet.udp import HEADER_BYTES, StoreSignature
from firm_hdl.gateware.memories import BlockMemory

__all__ = ["Reassembler"]

_SOURCE_BYTES = 4
_BANK_BITS = 14
"""A bank has 16 K bytes, so that each of its bits is one block RAM, with a register behind: the way
from a block RAM is long."""

_MOST_AGE = 3


class Reassembler(wiring.Component):
    """Put datagrams together whose fragments come in order.

    Two datagrams of two sources can be under way, or wait to be read. They share the memory: one
    grows from its start, the other one from its end. A source has one datagram under way: a new
    first fragment ends what came before. A fragment that is not the next one ends its datagram, as
    does a silence of 3 ticks. A datagram without a payload is dropped.

    A fragment is written as it comes, and counts when its frame has ended well. So a first one goes
    where nothing is, and the state after a fragment has a checksum that goes on with the next one.

    A byte per cycle. A datagram can be read 8 cycles after the `end` of its last fragment.

    Parameters
    ----------
    memory_bytes : int
        A power of two from 4,096 to 65,536. The largest datagram has 12 bytes less.

    Members
    -------
    datagrams : In(Ipv4Signature())
    check : In(check_state_layout())
    right : In(1)
        As those of a :class:`firm_hdl.ethernet.ipv4.PayloadCheck`.
    load : Out(1)
    loaded : Out(check_state_layout())
        The state with which it goes on.
    tick : In(1)
        Strobe.
    store : Out(StoreSignature())
    dropped : Out(1)
        Strobe: a fragment was of no use, or a datagram was given up.
    """

    def __init__(self, memory_bytes: int):
        if memory_bytes & (memory_bytes - 1) or not 4096 <= memory_bytes <= 65536:
            raise ValueError(
                f"Memory must be a power of two from 4096 to 65536 bytes, not {memory_bytes}"
            )
        self.memory_bytes = memory_bytes
        super().__init__(
            {
                "datagrams": In(Ipv4Signature()),
                "check": In(check_state_layout()),
                "right": In(1),
                "load": Out(1),
                "loaded": Out(check_state_layout()),
                "tick": In(1),
                "store": Out(StoreSignature()),
                "dropped": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, header, check = self.datagrams.bytes, self.datagrams.header, self.check
        address_bits = self.memory_bytes.bit_length() - 1
        # Of a datagram under way: `next` is the offset of the next fragment, in units of 8 bytes;
        # with the source's address in front, that is one unit less than it takes.
        layout = data.StructLayout(
            {
                "busy": 1,
                "done": 1,
                "age": range(_MOST_AGE + 1),
                "source": 32,
                "identification": 16,
                "next": 13,
                "check": check_state_layout(),
            }
        )
        parts = [Signal(layout, name=f"part_{k}") for k in range(2)]
        same, hit, follows = Signal(2), Signal(2), Signal(2)
        for k, part in enumerate(parts):
            m.d.sync += [
                same[k].eq(part.busy & ~part.done & (part.source == header.source)),
                hit[k].eq(part.identification == header.identification),
                follows[k].eq(part.next == header.offset),
            ]
        busy = Cat(part.busy for part in parts)

        # Which part a fragment belongs to, as its header passes: the source is known at byte 15.
        first, slot, chosen, gives_up = header.first, Signal(), Signal(), Signal(2)
        limit = Signal(range(self.memory_bytes // 8 + 1))
        at = Signal(17)
        fits = Signal()
        fragment = Signal()
        hits = same & hit
        m.d.comb += [
            fragment.eq(header.udp & (~first | header.more)),
            self.loaded.eq(Mux(slot, parts[1].check, parts[0].check)),
        ]
        with m.If(came.valid & ~came.payload.end & fragment), m.Switch(header.place):
            with m.Case(17):
                with m.If(first):
                    m.d.sync += [
                        slot.eq(busy[0]),
                        chosen.eq(~busy.all()),
                        gives_up.eq(same),
                    ]
                with m.Else():
                    m.d.sync += [
                        slot.eq(hits[1]),
                        chosen.eq((hits & follows).any()),
                        gives_up.eq(hits & ~follows),
                    ]
            with m.Case(18):
                units, other = self.memory_bytes // 8, Mux(slot, parts[0].next, parts[1].next)
                other_busy = Mux(slot, busy[0], busy[1])
                # One that fills the memory has as many as there are, and none follows.
                rest = Mux(other < units, units - 1 - other, 0)
                m.d.sync += limit.eq(Mux(other_busy, rest, units))
                m.d.sync += [at.eq((header.offset << 3) + _SOURCE_BYTES), fits.eq(1)]
                m.d.comb += self.load.eq(~first)
            with m.Case(20):
                m.d.sync += at.eq(at + 1)
                with m.If(at[3:] >= limit):
                    m.d.sync += fits.eq(0)

        # What is written: the payload, and at the end the source, in front of it.
        write_at, write_byte, writes = Signal(address_bits), Signal(8), Signal()
        source_left = Signal(range(_SOURCE_BYTES + 1))
        source = Signal(32)
        m.d.comb += [
            write_at.eq(at),
            write_byte.eq(came.payload.data),
            writes.eq(
                came.valid
                & ~came.payload.end
                & fragment
                & in_payload(header)
                & chosen
                & fits
                & (at[3:] < limit)
            ),
        ]
        with m.If(source_left != 0):
            m.d.comb += [
                write_at.eq(_SOURCE_BYTES - source_left),
                write_byte.eq(source[24:]),
                writes.eq(1),
            ]
            m.d.sync += [source_left.eq(source_left - 1), source.eq(source << 8)]

        # All bytes have come a cycle before `ends`. A fragment that others follow has a multiple of
        # 8 bytes (RFC 791, 3.2), and at least 8; the last one ends where the length of UDP says.
        ends, more, last = Signal(), Signal(), Signal()
        gone = Signal(2)
        m.d.sync += [
            more.eq((at[:3] == _SOURCE_BYTES) & (at[3:] != header.offset) & check.port),
            last.eq((check.length == at - _SOURCE_BYTES) & (check.length != HEADER_BYTES)),
            ends.eq(came.valid & came.payload.end & came.payload.good & fragment),
            self.dropped.eq(gone.any()),
        ]
        reading = Signal()
        for k, part in enumerate(parts):
            with m.If(self.tick & part.busy & ~part.done):
                m.d.sync += part.age.eq(part.age + 1)
                with m.If(part.age == _MOST_AGE):
                    m.d.sync += part.busy.eq(0)
                    m.d.comb += gone[k].eq(1)
            with m.If(self.store.release & (reading == k)):
                m.d.sync += [part.busy.eq(0), part.done.eq(0)]
            with m.If((source_left == 1) & (slot == k)):
                m.d.sync += part.done.eq(1)
        with m.If(ends):
            good = chosen & fits & Mux(header.more, more, last & self.right)
            m.d.sync += self.dropped.eq(~good)
            for k, part in enumerate(parts):
                with m.If(gives_up[k]):
                    m.d.sync += part.busy.eq(0)
                with m.If(chosen & (slot == k)):
                    m.d.sync += [
                        part.busy.eq(good),
                        part.age.eq(0),
                        part.source.eq(header.source),
                        part.identification.eq(header.identification),
                        part.next.eq(at[3:]),
                        part.check.eq(check),
                    ]
            with m.If(good & ~header.more):
                m.d.sync += [source_left.eq(_SOURCE_BYTES), source.eq(header.source)]

        # The part of number 1 lies upside down: its byte n is n bytes before the last one of the
        # memory. So both have the same addresses, which are inverted for that part.
        store = self.store
        bank_bits = min(address_bits, _BANK_BITS)
        head, to, at_byte = (Signal(address_bits, name=n) for n in ("head", "to", "at_byte"))
        full = Signal()
        m.d.comb += [
            store.full.eq(full),
            to.eq(write_at ^ slot.replicate(address_bits)),
            at_byte.eq(head ^ reading.replicate(address_bits)),
        ]
        bank, bank_before = Signal(range(4)), Signal(range(4))
        words = []
        for number in range(1 << address_bits - bank_bits):
            m.submodules[f"bank_{number}"] = memory = _Bank(1 << bank_bits)
            words.append(word := Signal(8, name=f"word_{number}", reset_less=True))
            m.d.comb += [
                memory.write_at.eq(to),
                memory.write_byte.eq(write_byte),
                memory.writes.eq(writes & (to[bank_bits:] == number)),
                memory.read_at.eq(at_byte),
                memory.reads.eq(store.moves),
            ]
            with m.If(store.moves):
                m.d.sync += word.eq(memory.byte)
        with m.If(store.moves):
            m.d.sync += [
                head.eq(head + store.takes),
                bank_before.eq(at_byte[bank_bits:]),
                bank.eq(bank_before),
            ]
        m.d.comb += store.byte.eq(Array(words)[bank])
        with m.If(~full):
            m.d.sync += [full.eq((Cat(part.done for part in parts)).any()), head.eq(0)]
            m.d.sync += reading.eq(~parts[0].done)
        with m.If(store.release):
            m.d.sync += full.eq(0)
        return m


class _Bank(wiring.Component):
    """A memory of bytes: `byte` is that of `read_at` in the last cycle with `reads`."""

    def __init__(self, size: int):
        self.size = size
        super().__init__(
            {
                "write_at": In(range(size)),
                "write_byte": In(8),
                "writes": In(1),
                "read_at": In(range(size)),
                "reads": In(1),
                "byte": Out(8),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        memory = BlockMemory(m, 8, self.size)
        m.d.comb += [
            memory.write_at.eq(self.write_at),
            memory.write_word.eq(self.write_byte),
            memory.writes.eq(self.writes),
            memory.read_at.eq(self.read_at),
            memory.reads.eq(self.reads),
            self.byte.eq(memory.word),
        ]
        return m
