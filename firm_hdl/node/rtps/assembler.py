"""Samples that come in fragments (8.4.14), put together in order."""

from __future__ import annotations

from amaranth.hdl import Array, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.memories import BlockMemory, LutMemory
from firm_hdl.node.rtps.history import Part, bytes_of

__all__ = ["Assembler", "FragmentSignature", "LookupSignature"]

_TICKS = 7
"""Ticks without a new fragment after which a sample begins again, or gives way to that of another
writer. Until then, what is missing is asked for more than once."""


def assembly_layout(rows: int, address_bits: int) -> data.StructLayout:
    """Return how far a reader has come with a sample.

    Members
    -------
    row : range(rows)
        The writer, as a row of the engine's table.
    number : unsigned(32)
        Sequence number.
    next : unsigned(address_bits + 1)
        Number of the fragment that is missing, from 1 on.
    place : unsigned(address_bits + 1)
        Bytes that came.
    fragment_bytes, sample_bytes : unsigned(16), unsigned(address_bits + 1)
        The same in all fragments of a sample (8.3.8.3).
    """
    return data.StructLayout(
        {
            "row": range(rows),
            "number": 32,
            "next": address_bits + 1,
            "place": address_bits + 1,
            "fragment_bytes": 16,
            "sample_bytes": address_bits + 1,
        }
    )


def LookupSignature(parts: tuple[Part, ...], rows: int) -> wiring.Signature:
    """Return the side of an :class:`Assembler` that the engine has.

    Members
    -------
    reader, row, number : Out
        The reader, the writer and the sequence number that the next outputs are about; of another
        `reader` in the next cycle.
    first, fragments, fragment_bytes, sample_bytes : Out
        The DATA_FRAG: its first fragment, how many there are, and sizes.
    has_room : In(1)
        The reader has memory for a sample of this size.
    fits : In(1)
        The fragments can be taken.
    holds : In(1)
        A part of this sample came, and not long ago.
    held : In(assembly_layout(...))
        How far the reader is.
    accepts : Out(1)
        Take the fragments. Only if they fit.
    forgets : Out(1)
        Forget what came for `reader`.
    tick : Out(1)
    """
    address_bits = ceil_log2(bytes_of(parts))
    return wiring.Signature(
        {
            "reader": Out(range(max(2, len(parts)))),
            "row": Out(range(rows)),
            "number": Out(32),
            "first": Out(32),
            "fragments": Out(16),
            "fragment_bytes": Out(16),
            "sample_bytes": Out(32),
            "has_room": In(1),
            "fits": In(1),
            "holds": In(1),
            "held": In(assembly_layout(rows, address_bits)),
            "accepts": Out(1),
            "forgets": Out(1),
            "tick": Out(1),
        }
    )


def FragmentSignature() -> wiring.Signature:
    """Return the side of an :class:`Assembler` that the reader of datagrams has.

    Members
    -------
    byte, takes : Out(8), Out(1)
        A byte of the fragments that were accepted; only while `wants`.
    wants : In(1)
        More bytes of them are expected.
    is_whole : In(1)
        The sample is complete.
    stores : Out(1)
        What came counts.
    plays : Out(1)
        Pass the sample on, and forget it. Only if `is_whole`.
    """
    return wiring.Signature(
        {
            "byte": Out(8),
            "takes": Out(1),
            "wants": In(1),
            "is_whole": In(1),
            "stores": Out(1),
            "plays": Out(1),
        }
    )


class Assembler(wiring.Component):
    """Store the fragment that is next of a sample, and say what does not fit.

    A reader has one sample at a time. Fragments before the next one are passed over, those behind
    it are not taken. So a sample needs no map of what came, and no size is multiplied. Another
    sample takes the place if it is of the same writer, or if nothing new came for some ticks.

    What is taken counts with `stores`. A sample that is complete is played; without that, it is as
    incomplete as before its last fragments.

    Parameters
    ----------
    parts : sequence of Part
        Memory of each reader.
    rows : int
        Of the engine's table.

    Members
    -------
    lookup : In(LookupSignature(parts, rows))
    fragments : In(FragmentSignature())
    payload : Out(PacketSignature(1))
    busy : Out(1)
        A sample is passed on.
    """

    def __init__(self, parts: tuple[Part, ...], rows: int):
        self.parts = parts
        super().__init__(
            {
                "lookup": In(LookupSignature(parts, rows)),
                "fragments": In(FragmentSignature()),
                "payload": Out(PacketSignature(1)),
                "busy": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        ask, came = self.lookup, self.fragments
        held, count = ask.held, len(self.parts)
        states = LutMemory(m, "states", held.shape(), 1 << max(1, ceil_log2(count)))
        read, valid = states.reader(), Signal(count)
        ages = Array(Signal(range(_TICKS + 1), name=f"age_{n}") for n in range(count))
        is_valid, is_old, limit = Signal(), Signal(), Signal(32)
        m.d.comb += read.addr.eq(ask.reader)
        m.d.sync += [
            held.eq(read.data),
            is_valid.eq(valid.bit_select(ask.reader, 1)),
            is_old.eq(ages[ask.reader] == 0),
            limit.eq(Array(each.bytes for each in self.parts)[ask.reader]),
        ]
        is_row, is_number = held.row == ask.row, held.number == ask.number
        is_same = (held.fragment_bytes == ask.fragment_bytes) & (
            held.sample_bytes == ask.sample_bytes
        )
        is_this, begins = Signal(), Signal()
        m.d.comb += [
            ask.has_room.eq(ask.sample_bytes <= limit),
            is_this.eq(is_valid & is_row & is_number),
            ask.holds.eq(is_this & ~is_old),
            # A sample of another writer that is still coming keeps the place. One of the same
            # writer gives it up: numbers go up, so what was begun of it will not be finished.
            begins.eq((ask.first == 1) & (~is_valid | is_old | (is_row & ~is_number))),
        ]
        goes_on = is_this & is_same & (ask.first <= held.next)
        m.d.comb += ask.fits.eq(begins | goes_on)
        with m.If(ask.tick):
            for age in ages:
                m.d.sync += age.eq(Mux(age == 0, 0, age - 1))

        # What is taken now: the fragment, and its byte; the fragments behind it; the place.
        now, reader = Signal.like(held), Signal.like(ask.reader)
        fragment, inside, left = Signal.like(held.next), Signal(16), Signal(16)
        at, is_next, ends = Signal.like(held.place), Signal(), Signal()
        address_bits = ceil_log2(bytes_of(self.parts))
        memory = BlockMemory(m, 8, 1 << address_bits)
        place = Signal(address_bits)
        # Fragments that came before are taken and counted, but not written: only `inside` moves.
        #
        #   fragment      | 1 ........ | 2 ........ | 3 ....
        #   now.next      | 2          | 2          | 3            (1 came before)
        #   at            | stays      | counts     | counts
        m.d.comb += [
            place.eq(Array(each.base for each in self.parts)[reader] | at[:address_bits]),
            memory.write_at.eq(place),
            memory.write_word.eq(came.byte),
            memory.writes.eq(came.takes & is_next),
            memory.read_at.eq(place),
            is_next.eq(fragment == now.next),
            ends.eq((inside + 1 == now.fragment_bytes) | (is_next & (at + 1 == now.sample_bytes))),
            came.is_whole.eq(now.place == now.sample_bytes),
            came.wants.eq((left != 0) & ~came.is_whole),
        ]
        with m.If(ask.accepts):
            m.d.sync += [
                reader.eq(ask.reader),
                fragment.eq(ask.first),
                left.eq(ask.fragments),
                inside.eq(0),
                # Fragments that go on have the same of what came before.
                now.row.eq(ask.row),
                now.number.eq(ask.number),
                now.fragment_bytes.eq(ask.fragment_bytes),
                now.sample_bytes.eq(ask.sample_bytes),
                now.next.eq(Mux(begins, 1, held.next)),
                now.place.eq(Mux(begins, 0, held.place)),
                at.eq(Mux(begins, 0, held.place)),
            ]
            with m.If(begins):
                # What came of another sample is overwritten.
                m.d.sync += valid.bit_select(ask.reader, 1).eq(0)
        with m.If(came.takes):
            m.d.sync += [inside.eq(inside + 1), at.eq(at + is_next)]
            with m.If(ends):
                m.d.sync += [inside.eq(0), left.eq(left - 1), fragment.eq(fragment + 1)]
                with m.If(is_next):
                    m.d.sync += [
                        now.next.eq(now.next + 1),
                        now.place.eq(at + 1),
                        ages[reader].eq(_TICKS),
                    ]
        m.d.comb += [
            states.write.addr.eq(reader),
            states.write.data.eq(now),
            states.write.en.eq(came.stores),
        ]
        with m.If(came.stores):
            m.d.sync += valid.bit_select(reader, 1).eq(1)
        with m.If(came.plays):
            m.d.sync += valid.bit_select(reader, 1).eq(0)
        with m.If(ask.forgets):
            m.d.sync += valid.bit_select(ask.reader, 1).eq(0)

        out = self.payload
        m.d.comb += [
            Value.cast(out.payload.data).eq(memory.word),
            out.payload.count.eq(1),
            out.payload.last.eq(at == now.sample_bytes),
        ]
        with m.FSM():
            with m.State("IDLE"), m.If(came.plays):
                m.d.sync += at.eq(0)
                m.next = "FIRST"
            with m.State("FIRST"):
                m.d.comb += [self.busy.eq(1), memory.reads.eq(1)]
                m.d.sync += at.eq(1)
                m.next = "PLAY"
            with m.State("PLAY"):
                # `at` is one ahead, as the memory answers a cycle later.
                m.d.comb += [self.busy.eq(1), out.valid.eq(1), memory.reads.eq(out.ready)]
                with m.If(out.ready):
                    m.d.sync += at.eq(at + 1)
                    with m.If(out.payload.last):
                        m.next = "IDLE"
        return m
