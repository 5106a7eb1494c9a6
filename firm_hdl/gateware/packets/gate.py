"""A gate that forwards good packets only."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.fifo import SyncFIFO, SyncFIFOBuffered
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream, StatusStream
from firm_hdl.gateware.packets.block_fifo import BlockFifo
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.gateware.packets.fifo import PacketFifo
from firm_hdl.gateware.packets.memory import MemoryShape, Outcome, WhenFull, check_policy
from firm_hdl.gateware.packets.sides import beat_in, put_in, side_members
from firm_hdl.gateware.packets.status import GateStatus, GateStatusSignature
from firm_hdl.gateware.packets.tail_drop import MOST_DROPPED, TailDrop, tail_drop_layout
from firm_hdl.gateware.parser import Parser, parser_plan
from firm_hdl.gateware.signatures import PacketSignature, Status
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.timing.rings import ring_beats
from firm_hdl.wire import Wire, lay_out

__all__ = ["PacketGate"]

STATUSES = 8
"""Statuses that wait until they are taken."""

BACKLOG_BEATS = 257
"""Beats that wait for the parser, if the link cannot be held, those in registers included."""

COUNTED = {
    "passed": GateStatus.OK,
    "truncated": GateStatus.TRUNCATED,
    "trailing": GateStatus.TRAILING,
    "length": GateStatus.LENGTH,
    "encapsulation": GateStatus.ENCAPSULATION,
    "string": GateStatus.STRING,
    "full": GateStatus.FULL,
    "large": GateStatus.LARGE,
}


class PacketGate(Component):
    """Forward only the good packets of a message type.

    A :class:`Parser` judges each packet while it is stored in a :class:`PacketFifo`, which drops
    the packets that are not `OK`. Forwarded packets are unchanged and in order. So
    behind a gate, the status of a :class:`Deserializer` with the same parameters is always `OK`.

    Both the first beat of a packet and its status are valid 5 cycles after the parser's status: 9
    cycles after the transfer of the last beat, if one step of the parser's plan ends in this beat,
    and nothing is before the packet; 13 cycles with `"drop"`. A beat is taken per cycle and leaves
    per cycle, without gaps between packets, as long as there are no more steps than beats.

    A bad packet occupies the gate for as many cycles as it has beats, or the parser has steps
    before its first error, whichever is more, and at most 4 cycles more: 6 if lengths claim too
    much together. What they claim does not count. Then its memory is free.

    The policy is that of :class:`PacketFifo`. With `"wait"`, `packets_in.ready` is also low while
    the parser is behind, or while statuses wait: 8 statuses are stored, and the packets after them
    wait for these to be taken. A gate whose statuses are not needed has a constant 1 at
    `status.ready`. With `"drop"`, `packets_in.ready` is always high. 257 beats wait for the parser;
    packets that come while there is no room for more are dropped with the status `OVERRUN`.

    Each packet has exactly one transfer on `status`, in the order of the packets. There is one
    exception: with `"drop"`, packets are counted but have no status if more than 255 in a row are
    dropped whole, because nobody takes statuses.

    All outputs depend on registers only. One clock domain, `sync`; its reset discards all packets
    inside. The first beat after the reset begins a packet.

    Parameters
    ----------
    message, wire, bus_bytes, max_message_bytes
        As for :class:`Deserializer`.
    memory_bytes, packets, when_full, side_bits
        As for :class:`PacketFifo`.

    Members
    -------
    packets_in : In(PacketSignature(bus_bytes))
    side_in : In(side_bits)
        Only with `side_bits`. As stable as the payload.
    packets_out : Out(PacketSignature(bus_bytes))
    side_out : Out(side_bits)
        Only with `side_bits`. What came beside the beat; valid with it.
    size : Out(range(memory_bytes + 1))
        Bytes of the packet on `packets_out`, from its first beat to its last one.
    status : Out(GateStatusSignature())
        One transfer per packet.
    counters : Out(counters_layout("passed", "truncated", ..., "full", "large", "overrun"))
        Packets by status, each with 32 bits; a counter stops at its largest value. A packet is
        counted when its status becomes valid, or would if those before it were taken; with
        `OVERRUN`, 3 cycles after its last beat.

    Attributes
    ----------
    plan : Plan
        The plan of the parser.

    Raises
    ------
    TypeError, ValueError
        If a parameter is not what it has to be, or the memory has no room for any packet.
    """

    packets_in: PacketStream
    packets_out: PacketStream
    side_in: Value
    side_out: Value
    size: Value
    status: StatusStream
    counters: Any

    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None = None,
        bus_bytes: int = 8,
        memory_bytes: int = 1 << 16,
        packets: int = 64,
        when_full: WhenFull = "wait",
        max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
        side_bits: int = 0,
    ):
        check_policy(when_full)
        sides = side_members(side_bits)
        self.message, self.bus_bytes, self.when_full = message, bus_bytes, when_full
        self.plan = parser_plan(message, wire, bus_bytes, max_message_bytes)
        self.shape = MemoryShape(bus_bytes, memory_bytes, packets, side_bits)
        least = lay_out(message, wire).least_bytes
        if memory_bytes < least:
            raise ValueError(
                f"Memory size must be at least {least} bytes, the least that a {message.name} has, "
                f"not {memory_bytes}"
            )
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)),
                "packets_out": Out(PacketSignature(bus_bytes)),
                "size": Out(range(memory_bytes + 1)),
                "status": Out(GateStatusSignature()),
                "counters": Out(counters_layout(*COUNTED, "overrun")),
                **sides,
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.parser = parser = Parser(self.message, plan=self.plan)
        m.submodules.fifo = fifo = PacketFifo(
            self.bus_bytes,
            self.shape.memory_bytes,
            self.shape.packets,
            when_full=self.when_full,
            side_bits=self.shape.side_bits,
        )
        # Beats that the parser has, and the memory has not. Only the last beat of a packet waits
        # for a verdict, and beats after it. While a packet is not judged, the beats after it are in
        # the parser's ring, too.
        layout = _layout(self)
        m.submodules.waiting = waiting = SyncFIFO(
            width=layout.size, depth=2 * ring_beats(self.bus_bytes)
        )
        beats = stream.Signature(layout).create(path=("beats",))
        m.d.comb += [
            waiting.w_data.eq(Value.cast(beats.payload)),
            waiting.w_en.eq(beats.valid & parser.packets.ready),
            # The parser has no use for what is beside a beat, in the highest bits.
            Value.cast(parser.packets.payload).eq(Value.cast(beats.payload.beat)),
            parser.packets.valid.eq(beats.valid & waiting.w_rdy),
            beats.ready.eq(parser.packets.ready & waiting.w_rdy),
            self.size.eq(fifo.size),
        ]
        wiring.connect(m, fifo.packets_out, wiring.flipped(self.packets_out))
        if self.shape.side_bits:
            m.d.comb += self.side_out.eq(fifo.side_out)
        verdicts = _Verdicts(m, self, parser, fifo, waiting)
        verdicts.give_statuses()
        if self.when_full == "wait":
            put_in(m, self, beats)
        else:
            m.submodules.tail_drop = tail_drop = TailDrop(self.bus_bytes, self.shape.side_bits)
            m.submodules.backlog = backlog = BlockFifo(layout, BACKLOG_BEATS)
            put_in(m, self, tail_drop.packets_in)
            wiring.connect(m, tail_drop.packets_out, backlog.i)
            wiring.connect(m, backlog.o, wiring.flipped(beats))
            verdicts.report_dropped(tail_drop, backlog.is_empty)
        return m


def _layout(gate: PacketGate) -> data.StructLayout:
    """Return the shape of beats that wait for the memory."""
    beat = gate.shape.beat
    return tail_drop_layout(beat) if gate.when_full == "drop" else data.StructLayout({"beat": beat})


class _Verdicts:
    """The logic between beats that wait and the memory: the verdict on each packet, and its status.

    * `parser`, `fifo`: those of the gate.
    * `waiting`: beats, of `_layout`.
    """

    def __init__(
        self,
        m: Module,
        gate: PacketGate,
        parser: Parser,
        fifo: PacketFifo,
        waiting: SyncFIFO,
    ):
        self.m, self.gate, self.parser, self.fifo = m, gate, parser, fifo
        self.waiting = waiting
        # The oldest beat is in a register, because it decides whether the parser's verdict leaves,
        # and the memory of look-up tables is late.
        self.head = Signal(_layout(gate), name="head", reset_less=True)
        self.has_head, self.takes = Signal(name="has_head"), Signal(name="takes_head")
        # The beat is the end of a packet whose rest was dropped.
        self.aborted = Signal(name="aborted")
        # There is room for a status, with those on the way.
        self.room = Signal(name="room")
        # Packets that were dropped whole before the packet of this beat have no status yet.
        self.report_due = Signal(name="report_due")
        # The status of such a packet is given.
        self.reports = Signal(name="reports")
        # The first beat of a packet is next.
        self.starts = Signal(name="starts", init=1)
        self.ends = Signal(name="ends")
        # The beat that the memory takes next, in a register: whether it has room depends on it.
        self.judged = Signal(gate.shape.beat, name="judged_beat", reset_less=True)
        self.has_judged = Signal(name="has_judged")
        # A packet of which beats were dropped ends now.
        self.overrun = Signal(name="overrun")
        m.d.comb += waiting.r_en.eq(~self.has_head | self.takes)
        with m.If(waiting.r_en):
            m.d.sync += [self.has_head.eq(waiting.r_rdy), self.head.eq(waiting.r_data)]
        self._store()

    def _store(self) -> None:
        """Give beats to the memory; the last one of a packet only with the verdict."""
        m, head, fifo, status = self.m, self.head, self.fifo, self.parser.status
        store, offers, aborts = fifo.packets_in, Signal(name="offers"), Signal(name="aborts")
        m.d.comb += [
            offers.eq(
                self.has_head & ~self.report_due & (~head.beat.last | (status.valid & self.room))
            ),
            beat_in(fifo).eq(Value.cast(self.judged)),
            store.valid.eq(self.has_judged),
            fifo.abort.eq(aborts),
            self.takes.eq(offers & (~self.has_judged | store.ready)),
            self.ends.eq(self.takes & head.beat.last),
            status.ready.eq(self.ends),
        ]
        with m.If(~self.has_judged | store.ready):
            m.d.sync += [
                self.has_judged.eq(offers),
                self.judged.eq(head.beat),
                aborts.eq((status.payload != Status.OK) | self.aborted),
            ]
        with m.If(self.takes):
            m.d.sync += self.starts.eq(head.beat.last)

    def report_dropped(self, tail_drop: TailDrop, none_waits: Value) -> None:
        """Give the statuses of packets that were dropped whole, before the packet after them.

        * `none_waits`: no beat is between the tail drop and the parser.
        """
        m, head = self.m, self.head
        reported = Signal(range(MOST_DROPPED + 1), name="reported")
        # A register, because the number in the beat is late in the cycle.
        all_reported = Signal(name="all_reported")
        directly = Signal(name="directly")
        m.d.comb += [
            self.aborted.eq(head.aborted),
            self.overrun.eq(tail_drop.drops),
            self.report_due.eq(self.starts & head.any_dropped & ~all_reported),
            # No packet waits, and none comes.
            directly.eq(
                none_waits
                & ~self.waiting.r_rdy
                & ~self.has_head
                & tail_drop.dropped.any()
                & ~tail_drop.packets_out.valid
            ),
            tail_drop.report.eq(directly & self.starts & self.room),
            self.reports.eq(
                self.room & self.starts & (directly | (self.has_head & self.report_due))
            ),
        ]
        with m.If(self.takes):
            m.d.sync += [reported.eq(0), all_reported.eq(0)]
        with m.Elif(self.has_head & self.report_due & self.room):
            m.d.sync += [
                reported.eq(reported + 1),
                all_reported.eq(reported + 1 == head.dropped),
            ]

    def give_statuses(self) -> None:
        """Join the parser's verdict with what the memory did, 2 cycles after it took the packet."""
        #   cycle                     | 0         | 1            | 2     | 3
        #   head                      | last beat |              |       |
        #   judged beat, given        |           | of packet    |       |
        #   memory takes it: leaves   |           | 1            |       |
        #   is_due, code              |           |              | valid |
        #   is_ready, judged, outcome |           |              |       | valid
        #
        # `unsent` counts the packet from cycle 1 on, so its status finds a place in cycle 3.
        m, gate, parsed = self.m, self.gate, self.parser.status.payload
        unsent = Signal(range(2 * STATUSES), name="unsent")
        enters, is_due, is_ready = Signal(name="enters"), Signal(name="is_due"), Signal(name="due")
        code, judged = Signal(GateStatus, name="code"), Signal(GateStatus, name="judged")
        final, given = Signal(GateStatus, name="final"), Signal(GateStatus, name="given")
        reported, leaves = Signal(name="reported_before"), Signal(name="leaves")
        store = self.fifo.packets_in
        bits = GateStatus.as_shape().width
        m.submodules.statuses = statuses = SyncFIFOBuffered(width=bits, depth=STATUSES + 1)
        m.d.comb += [
            self.room.eq(unsent < STATUSES),
            enters.eq(self.ends | self.reports),
            # If packets are dropped whole, the memory never waits: `given` is of this packet.
            leaves.eq(reported | (store.valid & store.ready & store.payload.last)),
            final.eq(judged),
            statuses.w_en.eq(is_ready),
            statuses.w_data.eq(Value.cast(final)),
            Value.cast(gate.status.payload).eq(statuses.r_data),
            gate.status.valid.eq(statuses.r_rdy),
            statuses.r_en.eq(gate.status.ready),
        ]
        sent = Signal(name="sent")
        m.d.comb += sent.eq(gate.status.valid & gate.status.ready)
        m.d.sync += [
            # `enters` is late in the cycle, so it selects, and no sum or enable depends on it.
            unsent.eq(Mux(enters, Mux(sent, unsent, unsent + 1), Mux(sent, unsent - 1, unsent))),
            reported.eq(self.reports),
            is_due.eq(leaves),
            code.eq(given),
            is_ready.eq(is_due),
            judged.eq(code),
        ]
        # As long as the judged beat; reports only come if the memory never waits.
        with m.If(~self.has_judged | store.ready):
            m.d.sync += Value.cast(given).eq(
                Mux(self.reports | self.aborted, Value.cast(GateStatus.OVERRUN), Value.cast(parsed))
            )
        # `outcome` is of this packet, if it was not aborted.
        with m.If((judged == GateStatus.OK) & (self.fifo.outcome == Outcome.FULL)):
            m.d.comb += final.eq(GateStatus.FULL)
        with m.If((judged == GateStatus.OK) & (self.fifo.outcome == Outcome.LARGE)):
            m.d.comb += final.eq(GateStatus.LARGE)
        events = {name: is_ready & (final == each) for name, each in COUNTED.items()}
        events["overrun"] = self.overrun
        add_counters(m, gate.counters, events)
