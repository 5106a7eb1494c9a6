"""A FIFO that keeps or drops whole packets."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Signal, Value
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream
from firm_hdl.gateware.memories import BlockMemory, LutMemory
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.gateware.packets.memory import MemoryShape, Outcome, WhenFull, check_policy
from firm_hdl.gateware.packets.reader import PacketReader
from firm_hdl.gateware.packets.sides import put_in, put_out, side_members
from firm_hdl.gateware.packets.writer import PacketWriter
from firm_hdl.gateware.signatures import PacketSignature

__all__ = ["PacketFifo"]


class PacketFifo(Component):
    """Store-and-forward FIFO for packets, in block RAM.

    A packet is sent after its last beat was stored, and only if it is kept. `abort` drops the
    packet. So for packets of a :class:`Serializer`, connect `packet_error` to `abort`: then only
    good packets are sent.

    The first beat of a packet is valid 4 cycles after the transfer of its last beat, if no packet
    is before it. A beat is taken per cycle, and a beat is sent per cycle, at the same time and
    without gaps between packets. Only a packet that is stored while the last beat of the one before
    it waits on `packets_out` begins a cycle later. The memory of a packet that is dropped is free
    at once.

    There is room for a beat if the memory has a free word, and fewer than `packets` packets are
    stored. A packet of exactly `memory_bytes` has room. Without room, the policy decides:

    * `"wait"`: `packets_in.ready` is low until there is room.
    * `"drop"`: the packet is dropped whole. `packets_in.ready` is always high.

    A packet that is larger than the memory is dropped with either policy. Its memory is free again
    when a beat too many would be stored, and then the rest of its beats are taken one per cycle.
    With `"wait"`, this is after all packets before it were sent.

    The memory has one write port and one synchronous read port; it is never initialized. All
    outputs are registers, or constant. No path leads from an input to an output. One clock domain,
    `sync`; its reset discards all packets inside. The first beat after the reset begins a packet.

    Parameters
    ----------
    bus_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    memory_bytes : int
        Size of the memory: a power of two, and at least two beats.
    packets : int
        Most packets that are stored, besides the one that is sent. At least 1.
    when_full : "wait" or "drop"
    side_bits : int
        Bits that travel beside each beat, such as a tag. 0: there are none.

    Members
    -------
    packets_in : In(PacketSignature(bus_bytes))
    side_in : In(side_bits)
        Only with `side_bits`. As stable as the payload.
    abort : In(1)
        Drop the packet. Only counts in the transfer of a last beat.
    packets_out : Out(PacketSignature(bus_bytes))
    side_out : Out(side_bits)
        Only with `side_bits`. What came beside the beat; valid with it.
    size : Out(range(memory_bytes + 1))
        Bytes of the packet on `packets_out`, from its first beat to its last one.
    ended : Out(1)
        High for one cycle per packet, 2 cycles after the transfer of its last beat.
    outcome : Out(Outcome)
        Whether the packet was kept, or why it was dropped; valid with `ended`.
    counters : Out(counters_layout("passed", "aborted", "full", "large"))
        Packets by outcome, each with 32 bits; a counter stops at its largest value. Counted 2
        cycles after `ended`.
    """

    packets_in: PacketStream
    packets_out: PacketStream
    side_in: Value
    side_out: Value
    abort: Value
    size: Value
    ended: Value
    outcome: Value
    counters: Any

    def __init__(
        self,
        bus_bytes: int,
        memory_bytes: int,
        packets: int,
        *,
        when_full: WhenFull = "wait",
        side_bits: int = 0,
    ):
        sides = side_members(side_bits)
        self.shape = MemoryShape(bus_bytes, memory_bytes, packets, side_bits)
        check_policy(when_full)
        self.when_full = when_full
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)),
                "abort": In(1),
                "packets_out": Out(PacketSignature(bus_bytes)),
                "size": Out(range(memory_bytes + 1)),
                "ended": Out(1),
                "outcome": Out(Outcome),
                "counters": Out(counters_layout("passed", "aborted", "full", "large")),
                **sides,
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        shape = self.shape
        memory = BlockMemory(m, shape.beat, shape.beats)
        m.submodules.writer = writer = PacketWriter(shape, self.when_full)
        m.submodules.reader = reader = PacketReader(shape)
        put_in(m, self, writer.packets)
        put_out(m, reader.packets, self)
        # `kept` passes a word only after the cycle in which it is written. So the reader never
        # reads a word while it is written, as :class:`BlockMemory` wants it, but for reads whose
        # word it ignores (`at` is `kept`).
        m.d.comb += [
            writer.abort.eq(self.abort),
            memory.write_at.eq(writer.at),
            memory.write_word.eq(writer.word),
            memory.writes.eq(writer.writes),
            writer.freed.eq(reader.at),
            reader.kept.eq(writer.kept),
            memory.read_at.eq(reader.at),
            memory.reads.eq(reader.reads),
            Value.cast(reader.word).eq(memory.word),
            self.size.eq(reader.size),
            self.ended.eq(writer.ended),
            self.outcome.eq(writer.outcome),
        ]
        self._store_sizes(m, writer, reader)
        outcomes = {"passed": Outcome.KEPT, "aborted": Outcome.ABORTED}
        outcomes |= {"full": Outcome.FULL, "large": Outcome.LARGE}
        events = {name: self.ended & (self.outcome == each) for name, each in outcomes.items()}
        add_counters(m, self.counters, events)
        return m

    def _store_sizes(self, m: Module, writer: PacketWriter, reader: PacketReader) -> None:
        """Store the sizes of packets whose first beat was not sent."""
        packets = self.shape.packets
        # Whether a packet began in the cycle before; `stored` still counts the packet.
        stored, begun = Signal(range(packets + 2), name="stored"), Signal(name="begun")
        sizes = LutMemory(m, "sizes", writer.size.shape(), 1 << max(1, ceil_log2(packets)))
        write, read = sizes.write, sizes.reader()
        m.d.comb += [
            write.data.eq(writer.size),
            write.en.eq(writer.keeps),
            reader.next_size.eq(read.data),
            writer.stored.eq(stored),
            writer.begun.eq(begun),
        ]
        # `begins` is late in the cycle, so no sum depends on it.
        m.d.sync += [
            begun.eq(reader.begins),
            write.addr.eq(write.addr + writer.keeps),
            stored.eq(stored + writer.keeps - begun),
        ]
        with m.If(reader.begins):
            m.d.sync += read.addr.eq(read.addr + 1)
