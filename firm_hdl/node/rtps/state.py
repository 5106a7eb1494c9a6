"""The registers of a participant: what it knows, and what it is at."""

from __future__ import annotations

import hashlib
from ipaddress import IPv4Address
from typing import TYPE_CHECKING, Any

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value, signed
from amaranth.utils import ceil_log2

from firm_hdl.gateware.memories import BlockMemory, LutMemory
from firm_hdl.node.rtps.endpoints import Endpoint
from firm_hdl.node.rtps.events import EventKind, raw
from firm_hdl.node.rtps.history import MOST_SAMPLES
from firm_hdl.node.rtps.intake import sample_layout
from firm_hdl.node.rtps.tables import identity_layout, peer_layout, row_layout
from firm_hdl.node.rtps.templates import HEAD_BYTES, Job, fragment_bytes
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SUBSCRIPTIONS_READER,
    SUBSCRIPTIONS_WRITER,
    VENDOR,
)

if TYPE_CHECKING:
    from firm_hdl.node.rtps.engine import Engine

__all__ = [
    "FIXED_READERS",
    "FIXED_WRITERS",
    "GRAPH",
    "MOST_PATIENCE",
    "MOST_SILENT",
    "MOST_TIMER",
    "MOST_TRIES",
    "STATIC_PARTICIPANTS",
    "TICKS_PER_SECOND",
    "State",
    "constant",
    "is_for_writer",
    "lowest",
]

TICKS_PER_SECOND = 20

FIXED_WRITERS, FIXED_READERS = 3, 2
"""Writers and readers that every participant has: SEDP, and the graph of ROS 2."""

GRAPH = 2
"""The number of the graph among our writers."""

MOST_TIMER = MOST_TRIES = 15

MOST_SILENT = 60
"""Ticks for which a new message waits for a reader that acknowledges nothing: 3 seconds."""

MOST_PATIENCE = 1023
"""How often a sample is tried whose topic has not passed on the one before."""

# Requests whose replies are awaited: a power of two.
_REQUESTS = 32
_LITTLE, _FINAL = 1, 2
STATIC_PARTICIPANTS = 4
"""Participants of each static peer that are told of this one."""


class State:
    """The registers and the memories that the states of an :class:`.Engine` share.

    * `engine`: its parameters, and the members around it.
    """

    def __init__(self, m: Module, engine: Engine):
        self.engine = engine
        self._declare(m)
        self._ticks(m)

    def _declare(self, m: Module) -> None:
        """Make the memories and the registers that several states use."""
        peers, rows, address = self.engine.peers, self.engine.rows, self.engine.address_bits
        link = self.engine.description.link
        endpoints = max(FIXED_WRITERS, FIXED_READERS) + max(
            len(self.engine.parts), len(self.engine.readers)
        )
        self.row = row = Signal(row_layout(peers, endpoints))
        self.rows_memory = _memory(m, "rows", row.shape(), rows)
        self.peers_memory = _memory(m, "peers", peer_layout(), peers)
        if self.engine.serves:
            self.identities = _memory(m, "identities", identity_layout(peers), _REQUESTS)
        # The row and the participant that are worked on, and what is known of our writer.
        self.row_at = Signal(range(rows))
        self.peer, self.peer_row = Signal(range(peers)), Signal(peer_layout())
        self.known, self.accepts = Signal(), Signal()
        self.last, self.gone, self.lower = Signal(32), Signal(32), Signal(32)
        # Whether the sample `number` was written; and whether it is not there, or not for the row.
        self.is_written, self.is_gone = Signal(), Signal()
        # A scan of a memory: the address, that of the word, and whether word and row are there.
        self.at, self.at_word = Signal(range(rows + 1)), Signal(range(rows + 1))
        self.has_word, self.has_row = Signal(), Signal()
        self.key, self.hit, self.second = Signal(32), Signal(), Signal()
        self.target, self.patience = Signal(32), Signal(range(MOST_PATIENCE + 1))
        # How far the numbers of an event are ahead of the row's `next`, and whether the first one
        # is not below its `end`.
        self.ahead, self.last_ahead = Signal(signed(33)), Signal(signed(33))
        self.is_unknown = Signal()
        self.free, self.has_free = Signal(range(rows)), Signal()
        # How many rows the peer has; for which peers a row was missing; whether one has become free
        # since the last second; and which peers are to announce their endpoints again.
        self.held, self.has_room = Signal(range(rows + 1)), Signal()
        self.refused, self.again = Signal(peers), Signal(peers)
        # Which peers there are; which are matched, have acknowledged a sample, have to be told.
        self.live, self.matched, self.due = Signal(peers), Signal(peers), Signal(peers)
        self.answers = Signal(peers)
        # Seconds that are left of the lease of each peer.
        self.leases = LutMemory(m, "leases", 7, 1 << max(1, ceil_log2(peers)))
        self.young = Array(Signal(2, name=f"young_{n}") for n in range(peers))
        self.dying = Array(Signal(2, name=f"dying_{n}") for n in range(peers))
        self.sweep, self.turn, self.in_event = Signal(range(rows)), Signal(), Signal()
        # The last row that a sweep comes to, and the last valid one that this sweep has come to.
        self.top = Signal(range(rows), init=self.engine.first_row)
        self.seen = Signal(range(rows), init=self.engine.first_row)
        # Whether a message has come since the last sweep, which no reader has been sent yet.
        self.fresh = Signal()
        # Whether a whole sweep sent no sample for the first time: then a new one is taken.
        self.quiet, self.clean = Signal(), Signal()
        # How many of the oldest samples of a writer may give way.
        self.freed = Signal(range(MOST_SAMPLES + 1))
        self.tick_due, self.tick_pass, self.second_due = Signal(), Signal(), Signal()
        self.statics = [int(IPv4Address(each)) for each in link.static_peers]
        self.most_static = STATIC_PARTICIPANTS * len(self.statics)
        self.multicast_due, self.static = Signal(), Signal(range(self.most_static + 1))
        # The datagram that is ordered.
        self.job, self.stores = Signal(range(len(self.engine.templates.every))), Signal()
        self.number, self.count = Signal(32), Signal(32)
        self.from_, self.to = Signal(32), Signal(32)
        self.bits, self.bitmap, self.is_final = Signal(32), Signal(32), Signal()
        self.address, self.port = Signal(32), Signal(16)
        self.start_at, self.size = Signal(range(len(self.engine.templates.rom))), Signal(16)
        self.sample = sample = Signal(sample_layout(self.engine.parts))
        # What is sent of it: all, or a fragment; which one is next, and which ones are wanted: a
        # bit for each from the next one on, and one for all behind.
        self.sent_at, self.sent_bytes = sample.at, sample.bytes
        if self.engine.cuts:
            self.sent_at, self.sent_bytes = Signal(address), Signal(16)
        most_fragments = self.engine.memory_bytes // fragment_bytes(link) + 1
        self.fragment, self.wanted = Signal(range(most_fragments + 1)), Signal(33)
        self.identity = Signal(identity_layout(peers))
        self.nonce, self.cycles = Signal(32), Signal(32)
        m.d.sync += self.cycles.eq(self.cycles + 1)
        m.d.comb += [
            self.engine.own.eq(Cat(Const(self._fixed_prefix(), 64), self.nonce)),
            self.engine.knows.eq(self.known),
            self.engine.wants.eq(self.accepts),
            self.rows_memory.write_at.eq(self.row_at),
            self.rows_memory.write_word.eq(row),
            self.rows_memory.read_at.eq(self.at),
            self.peers_memory.write_at.eq(self.peer),
            self.peers_memory.read_at.eq(self.at),
            self.leases.write.addr.eq(self.peer),
            self.leases.write.data.eq(self.peer_row.lease),
        ]
        self._fill_order(m)
        event, assembly = self.engine.events.payload, self.engine.assembly
        m.d.comb += [
            assembly.reader.eq(row.local - FIXED_READERS),
            assembly.row.eq(self.row_at),
            assembly.number.eq(row.next),
            assembly.first.eq(event.bits),
            assembly.fragments.eq(event.fragments),
            assembly.fragment_bytes.eq(event.fragment_bytes),
            assembly.sample_bytes.eq(event.last),
            self.engine.histories.writer.eq(row.local - FIXED_WRITERS),
            self.engine.histories.number.eq(self.number),
            self.engine.histories.free.eq(self.freed),
            self.is_written.eq(self.number <= self.last),
            self.is_gone.eq(self.number < self.lower),
        ]

    def _fixed_prefix(self) -> int:
        """Return the first 8 bytes of the GUID prefix: the vendor (9.3.1.5), and the node's own."""
        link = self.engine.description.link
        text = f"{self.engine.description.fingerprint} {link.ip} {link.domain} {link.participant}"
        return int.from_bytes(VENDOR + hashlib.sha256(text.encode()).digest()[:6], "little")

    def _ticks(self, m: Module) -> None:
        """Note that a tick or a second is over."""
        cycles = max(2, round(self.engine.description.clock_hz / TICKS_PER_SECOND))
        # A tick is noted, and counts in the sweep after (`tick_pass`), so that a row sees it about
        # once.
        left, ticks = Signal(range(cycles)), Signal(range(TICKS_PER_SECOND))
        m.d.sync += left.eq(left - 1)
        with m.If(left == 0):
            m.d.sync += [left.eq(cycles - 1), ticks.eq(ticks - 1), self.tick_due.eq(1)]
            with m.If(ticks == 0):
                m.d.sync += [ticks.eq(TICKS_PER_SECOND - 1), self.second_due.eq(1)]

    def _fill_order(self, m: Module) -> None:
        """Tell the transmitter the registers of the datagram that is ordered."""
        order, row, fields = self.engine.order, self.row, self.engine.order.fields
        parts, user = self.engine.parts, row.local - FIXED_WRITERS
        padded, head = Signal(16), Signal(16)
        m.d.comb += [
            order.start.eq(self.start_at),
            order.size.eq(self.size),
            order.address.eq(self.address),
            order.port.eq(self.port),
            order.at.eq(self.sent_at),
            order.payload_bytes.eq(self.sent_bytes),
            fields.own.eq(self.engine.own),
            fields.peer.eq(self.peer_row.prefix),
            fields.number.eq(self.number),
            fields.first.eq(self.from_),
            fields.last.eq(self.to),
            fields.count.eq(self.count),
            fields.bits.eq(self.bits),
            fields.bitmap.eq(self.bitmap),
            fields.flags[8:].eq(_LITTLE | Mux(self.is_final, _FINAL, 0)),
            fields.related.eq(self.identity.guid),
            fields.related_number.eq(self.identity.number),
            padded.eq(Cat(Const(0, 2), (self.sent_bytes + 3)[2:])),
            head.eq(constant([HEAD_BYTES.get(each, 0) for each in Job], self.job)),
            fields.size[16:].eq(head + padded),
        ]
        for number, part in enumerate(parts):
            with m.If(user == number):
                m.d.comb += [order.base.eq(part.base), order.mask.eq(part.bytes - 1)]
        own_writers = [PUBLICATIONS_WRITER, SUBSCRIPTIONS_WRITER, *_entities(self.engine.writers)]
        own_readers = [PUBLICATIONS_READER, SUBSCRIPTIONS_READER, *_entities(self.engine.readers)]
        writer, reader = (
            constant([raw(each) for each in own], row.local) for own in (own_writers, own_readers)
        )
        m.d.comb += [
            fields.reader.eq(Mux(row.writes, row.remote, reader)),
            fields.writer.eq(Mux(row.writes, writer, row.remote)),
        ]
        self.padded = padded

    def begin_scan(self, m: Module, at: int = 0) -> None:
        m.d.sync += [
            self.at.eq(at),
            self.has_word.eq(0),
            self.has_row.eq(0),
            self.has_free.eq(0),
            self.held.eq(0),
        ]

    def scan(self, m: Module, memory: BlockMemory) -> None:
        """Read the next word of a memory; it comes a cycle later, and is registered then."""
        #   cycle           | 0 | 1    | 2    | 3
        #   at              | a | a+1  | a+2  | a+3
        #   memory.word     |   | of a | a+1  | a+2       with `at_word` and `has_word`
        #   row, row_at     |   |      | of a | a+1       with `has_row`; the caller registers them
        #
        # What is looked for is two behind `at`. A caller that has found it does not register the
        # next word, so row and `row_at` are those that were found.
        m.d.comb += memory.reads.eq(1)
        m.d.sync += [
            self.at.eq(self.at + 1),
            self.at_word.eq(self.at),
            self.has_word.eq(1),
            self.has_row.eq(self.has_word),
        ]

    def kill(self, m: Module, peer: Value) -> None:
        """Forget a peer. Its place is free after two whole sweeps, which clear its rows."""
        # Two ends of sweeps are waited for, as the sweep under way may have passed some of the
        # rows. With the place given away before, they would be taken for rows of the new peer.
        m.d.sync += [
            self.live.bit_select(peer, 1).eq(0),
            self.matched.bit_select(peer, 1).eq(0),
            self.answers.bit_select(peer, 1).eq(0),
            self.due.bit_select(peer, 1).eq(0),
            self.dying[peer].eq(2),
        ]

    def send(self, m: Module, job: Any) -> None:
        """Order a datagram to the endpoint of the row, which is stored after that."""
        m.d.sync += [self.job.eq(job), self.stores.eq(1), self.at.eq(self.row.peer)]
        m.next = "PEER"


def is_for_writer(event: Any) -> Value:
    """Whether an event is what a reader answers a writer of ours."""
    return (event.kind == EventKind.ACKNACK) | (event.kind == EventKind.NACK_FRAG)


def _memory(m: Module, name: str, shape: Any, depth: int) -> BlockMemory:
    """Add a memory in a module of its own."""
    m.submodules[name] = inner = Module()
    return BlockMemory(inner, shape, 1 << max(1, ceil_log2(depth)))


def _entities(endpoints: tuple[Endpoint, ...]) -> list[int]:
    return [each.data.guid.entity for each in endpoints]


def constant(values: list[int], index: Any) -> Value:
    """Return a constant by its number."""
    width = max(each.bit_length() for each in [1, *values])
    return Array(Const(each, width) for each in values or [0])[Value.cast(index).as_unsigned()]


def lowest(bits: Value) -> Value:
    """Return the number of the lowest bit that is 1."""
    found: Value = Const(len(bits) - 1, range(len(bits)))
    for place in reversed(range(len(bits) - 1)):
        found = Mux(bits[place], place, found)
    return found
