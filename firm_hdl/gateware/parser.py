"""The parser: packets in; status and sizes of each packet out."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream, StatusStream
from firm_hdl.gateware.memories import LutMemory
from firm_hdl.gateware.parse import Buffer, Checker, verdict_layout
from firm_hdl.gateware.positions import Ring, beat_layout
from firm_hdl.gateware.signatures import PacketSignature, StatusSignature
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan, build_plan, check_bus_bytes
from firm_hdl.plan.outline import outline
from firm_hdl.program import deserializer_program
from firm_hdl.wire import Wire, lay_out

__all__ = [
    "Parser",
    "parser_plan",
]

SIZE_BITS = 32


def sizes_layout() -> data.StructLayout:
    """Return the sizes of a packet.

    Members
    -------
    packet : unsigned(32)
        Bytes of the packet with its encapsulation header, at most 2**32 - 1: larger packets count
        as this size.
    trailing : unsigned(2)
        Bytes of the packet after the message, if the status is `OK`.
    """
    return data.StructLayout({"packet": SIZE_BITS, "trailing": 2})


def parser_plan(
    message: Message, wire: Wire | None, bus_bytes: int, max_message_bytes: int
) -> Plan:
    """Return the plan of a parser with these parameters.

    Raises `TypeError` or `ValueError`.
    """
    layout = lay_out(message, wire)
    check_bus_bytes(bus_bytes)
    return build_plan(
        outline(layout, bus_bytes), bus_bytes=bus_bytes, max_message_bytes=max_message_bytes
    )


class Parser(Component):
    """Judge packets, without extracting their messages.

    Each packet ends in one transfer on `status`, the same as from a :class:`Deserializer` with the
    same parameters. `status` becomes valid 4 cycles after the transfer of the packet's last beat,
    if one step of `plan` ends in this beat. Each further step adds a cycle, and an error at most 4.

    Each step takes a cycle, and one beat per cycle is accepted. A bus word with several lengths has
    several steps: for example two for two empty strings on a bus of 8 bytes. So a packet occupies
    the parser for as many cycles as it has beats, or steps before its first error, whichever is
    more, and for at most 4 cycles more after an error: 6 if lengths claim too much together. Bytes
    that lengths claim but that never arrive cost nothing. Up to 8 beats (16 on a bus of 1 or 2
    bytes) wait in a buffer while the parser catches up; then `packets.ready` goes low.

    `packets.ready`, `status.valid`, `status.payload` and `sizes` are registers; no path leads from
    an input to an output. While a status waits, only one more packet can end, or two in
    consecutive cycles. One clock domain, `sync`; its reset discards all packets inside.

    Parameters
    ----------
    message, wire, bus_bytes, max_message_bytes
        As for :class:`Deserializer`.
    plan : Plan or None
        The plan by :func:`parser_plan`, if there is one; the other parameters do not count then.

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
    status : Out(StatusSignature())
    sizes : Out(sizes_layout())
        Sizes of the packet of `status`; valid with `status`.

    Attributes
    ----------
    plan : Plan
        The plan of the message's outline: arrays of bytes stand for the fields between lengths.
    """

    packets: PacketStream
    status: StatusStream
    sizes: Any

    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None = None,
        bus_bytes: int = 8,
        max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
        plan: Plan | None = None,
    ):
        if plan is None:
            plan = parser_plan(message, wire, bus_bytes, max_message_bytes)
        self.plan = plan
        super().__init__(
            {
                "packets": In(PacketSignature(plan.bus_bytes)),
                "status": Out(StatusSignature()),
                "sizes": Out(sizes_layout()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        program = deserializer_program(self.plan, has_leaves=False)
        m.submodules.buffer = buffer = Buffer(self.plan)
        m.submodules.checker = checker = Checker(program)
        m.submodules.packet_sizes = sizes = PacketSizes(self.plan)
        m.submodules.verdicts = verdicts = VerdictQueue()
        wiring.connect(m, wiring.flipped(self.packets), buffer.packets)
        wiring.connect(m, buffer.arrival, checker.arrival)
        m.d.comb += [
            checker.may_end.eq(verdicts.has_room),
            buffer.freed.eq(checker.oldest),
            sizes.beat.eq(buffer.arrival.beat),
            sizes.next.eq(verdicts.moves),
            verdicts.came.eq(checker.verdict),
            verdicts.ready.eq(self.status.ready),
            self.status.valid.eq(verdicts.first.ends),
            self.status.payload.eq(verdicts.first.status),
            self.sizes.trailing.eq(verdicts.first.trailing),
        ]
        with m.If(verdicts.moves):
            m.d.sync += self.sizes.packet.eq(sizes.bytes)
        return m


class VerdictQueue(wiring.Component):
    """Three verdicts: one that is offered, and two that wait.

    A verdict comes a cycle after the end of its packet. So when a verdict begins to wait, one more
    packet is ending, and its verdict needs a place, too. No path leads from `ready` to `has_room`.

    Members
    -------
    came : In(verdict_layout())
        A verdict comes if `ends`.
    has_room : Out(1)
        A packet may end in this cycle. A register.
    first : Out(verdict_layout())
        The oldest verdict; it is offered if `ends`. Registers.
    ready : In(1)
    moves : Out(1)
        The verdict that is offered in the next cycle is another one than in this cycle.
    """

    def __init__(self) -> None:
        layout = verdict_layout()
        super().__init__(
            {
                "came": In(layout),
                "has_room": Out(1),
                "first": Out(layout),
                "ready": In(1),
                "moves": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, first = self.came, self.first
        second = Signal(came.shape())
        third = Signal(came.shape())
        takes = Signal()
        m.d.comb += [
            self.has_room.eq(~second.ends),
            takes.eq(~first.ends | self.ready),
            self.moves.eq(takes & (second.ends | came.ends)),
        ]
        # Nothing comes while three verdicts are inside.
        with m.If(takes):
            m.d.sync += [
                first.eq(Mux(second.ends, Value.cast(second), Value.cast(came))),
                second.eq(Mux(third.ends, Value.cast(third), Value.cast(came))),
            ]
            # Then `came` goes to `first`, and must not be kept twice.
            with m.If(~second.ends):
                m.d.sync += second.ends.eq(0)
        with m.Elif(~second.ends):
            m.d.sync += second.eq(came)
        # `ready` is late in the cycle, so only the flag depends on it.
        with m.If(~third.ends):
            m.d.sync += third.eq(came)
        m.d.sync += third.ends.eq(~takes & (third.ends | (second.ends & came.ends)))
        return m


class PacketSizes(wiring.Component):
    """Count the bytes of packets, and store the counts until the packets are judged.

    Parameters
    ----------
    plan : Plan

    Members
    -------
    beat : In(beat_layout(plan))
        The beat that is written to the packet buffer in this cycle.
    next : In(1)
        Drop the oldest count.
    bytes : Out(32)
        Bytes of the oldest packet that has ended, a cycle after its last beat; at most 2**32 - 1.
        Combinational from a memory.
    """

    def __init__(self, plan: Plan):
        self.ring = Ring(plan)
        super().__init__({"beat": In(beat_layout(plan)), "next": In(1), "bytes": Out(SIZE_BITS)})
        # Beats of the arriving packet before the current one.
        self.beats = Signal(SIZE_BITS - self.ring.lane_bits)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        ring, beat = self.ring, self.beat
        # The counter of beats has overflowed.
        over = Signal()
        total = Signal(SIZE_BITS + 1)
        # A packet has at least one beat, so the ring holds at most `depth` packets. Three packets
        # that are judged may wait as well.
        memory = LutMemory(m, "ends", SIZE_BITS, 2 * ring.depth)
        write, read = memory.write, memory.reader()
        m.d.comb += [
            total.eq(Cat(Const(0, ring.lane_bits), self.beats) + beat.count),
            write.data.eq(total[:SIZE_BITS] | (over | total[SIZE_BITS]).replicate(SIZE_BITS)),
            write.en.eq(beat.valid & beat.last),
            self.bytes.eq(read.data),
        ]
        with m.If(beat.valid):
            with m.If(beat.last):
                m.d.sync += [self.beats.eq(0), over.eq(0), write.addr.eq(write.addr + 1)]
            with m.Else():
                m.d.sync += [self.beats.eq(self.beats + 1), over.eq(over | self.beats.all())]
        with m.If(self.next):
            m.d.sync += read.addr.eq(read.addr + 1)
        return m
