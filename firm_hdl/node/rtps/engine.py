"""The state of a participant, and all that it decides: whom it knows, what it sends, and when."""

from __future__ import annotations

import hashlib
from ipaddress import IPv4Address
from typing import Any

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value, signed
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware.memories import BlockMemory, LutMemory
from firm_hdl.node.capacity import largest_bytes
from firm_hdl.node.description import Description
from firm_hdl.node.rtps.assembler import LookupSignature
from firm_hdl.node.rtps.endpoints import Endpoint
from firm_hdl.node.rtps.events import EventKind, announced_layout, event_layout, raw
from firm_hdl.node.rtps.history import MOST_SAMPLES, Part, bytes_of
from firm_hdl.node.rtps.intake import HistoriesSignature, sample_layout
from firm_hdl.node.rtps.names import digest_of
from firm_hdl.node.rtps.tables import (
    BUILTIN_ROWS,
    identity_layout,
    peer_layout,
    row_layout,
)
from firm_hdl.node.rtps.templates import HEAD_BYTES, Job, Templates, fragment_bytes
from firm_hdl.node.rtps.transmitter import order_layout
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SUBSCRIPTIONS_READER,
    SUBSCRIPTIONS_WRITER,
    VENDOR,
)
from firm_hdl.rtps.wire.locators import MULTICAST_GROUP, Ports

__all__ = ["TICKS_PER_SECOND", "Engine"]

TICKS_PER_SECOND = 20

# Writers and readers that every participant has: SEDP, and the graph of ROS 2.
_FIXED_WRITERS, _FIXED_READERS = 3, 2
_GRAPH = 2
# Ticks: between heartbeats to a reader that does not answer, at first; between requests for what is
# missing; between greetings of a writer that has said nothing yet.
_HEARTBEAT, _REPEAT, _GREETING = 2, 2, 5
_MOST_TIMER = _MOST_TRIES = 15
# Ticks for which a new message waits for a reader that acknowledges nothing: 3 seconds.
_MOST_SILENT = 60
# Seconds after which a peer without matched endpoints may give way to another one.
_GRACE = 3
# Seconds to wait for a datagram, whose time of arrival makes the GUID prefix new.
_PATIENCE = 4
# Requests whose replies are awaited: a power of two.
_REQUESTS = 32
# How GUID prefixes of Fast DDS begin, which answers a first ACKNACK at once if its base is 0.
_FAST_DDS = 0x0F01
# How often a sample is tried whose topic has not passed on the one before.
_MOST_PATIENCE = 1023
_READER_BIT = 2
_STATIC_PARTICIPANTS = 4
_LITTLE, _FINAL = 1, 2


class Engine(wiring.Component):
    """Take events and samples; keep peers, matched endpoints and histories; order datagrams.

    One thing at a time is done: an event, a new sample, an announcement, or the next row of the
    table of matched endpoints, whose state says what is due. So each datagram that is sent, and
    each event, takes a bounded number of cycles, and nothing waits for a peer.

    A place for a peer is free after its lease. Without a free one, a stranger gives way, 3 seconds
    after it came: a peer without a matched endpoint, or that has acknowledged nothing. So
    names that somebody invents do not keep others out, and those who answer are never displaced.

    Parameters
    ----------
    description : Description
    templates : Templates
    writers, readers : sequence of Endpoint
        As :class:`.Own` has them.
    parts : sequence of Part
        The memory of each writer but the first.
    pieces : sequence of Part
        The memory of each reader for samples that come in fragments.

    Members
    -------
    events, announced, knows, wants : as of a `MessageReader`
    topic, tag : Out(16), Out(32)
        Of the payload that is wanted.
    idle : In(len(readers))
        The topic of a reader has passed on all that came. A sample waits for that, but not long:
        then a reliable one is asked for again, and any other one goes to its topic all the same.
    histories : Out(HistoriesSignature(parts))
        An :class:`.Intake`.
    nonce : In(32)
        Not 0: makes the GUID prefix of this start another one than those before. 0: the time at
        which the first datagram comes does so; without any, 4 seconds are waited for one.
    came, nears : In(1)
        A datagram is there; an event comes within some cycles, and not twice without one.
    own : Out(96)
        GUID prefix.
    assembly : Out(LookupSignature(...))
        An :class:`.Assembler`, if there is one.
    order, starts, ends : as of a `Transmitter`
    lost, late, stray, cut, unsent : Out(1)
        High for one cycle: samples that will not come; a sample that came twice; one that is for
        nobody; fragments that are not taken; what found no place, or has no way.
    """

    def __init__(
        self,
        description: Description,
        templates: Templates,
        writers: tuple[Endpoint, ...],
        readers: tuple[Endpoint, ...],
        parts: tuple[Part, ...],
        pieces: tuple[Part, ...],
    ):
        self.description, self.templates = description, templates
        self.writers, self.readers, self.parts = writers, readers, parts
        self.serves = any(each.has_tags for each in parts)
        self.memory_bytes = bytes_of(parts)
        self.address_bits = ceil_log2(self.memory_bytes)
        link = description.link
        self.peers = link.peers
        self.first_row = BUILTIN_ROWS * link.peers
        self.rows = self.first_row + link.matches
        # Bytes of the largest sample that is sent whole, with up to three bytes of padding; and
        # whether there are larger ones.
        heads = templates.every[Job.SAMPLE : Job.REPLY + 1]
        self.whole_bytes = link.datagram_bytes - max(each.size for each in heads) - 3
        stores = [each.topic.store("out") for each in writers if each.topic]
        largest = max((largest_bytes(description, each) for each in stores), default=0)
        self.cuts = largest > self.whole_bytes
        self.most_bytes = self.memory_bytes if self.cuts else max(0, self.whole_bytes)
        order = order_layout(len(templates.rom), self.memory_bytes)
        super().__init__(
            {
                "events": In(stream.Signature(event_layout())),
                "announced": In(announced_layout()),
                "knows": Out(1),
                "wants": Out(1),
                "topic": Out(16),
                "tag": Out(32),
                "idle": In(max(1, len(readers))),
                "nonce": In(32),
                "came": In(1),
                "nears": In(1),
                "own": Out(96),
                "assembly": Out(LookupSignature(pieces, self.rows)),
                "order": Out(order),
                "starts": Out(1),
                "ends": In(1),
                "histories": Out(HistoriesSignature(parts)),
                **dict.fromkeys(("lost", "late", "stray", "cut", "unsent"), Out(1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        self._declare(m)
        self._ticks(m)
        self._compare(m)
        is_builtin = self._sweep < self.first_row
        with m.FSM():
            self._start(m)
            with m.State("IDLE"):
                m.d.sync += [self._second.eq(0), self._turn.eq(1), self._in_event.eq(0)]
                self._begin_scan(m)
                with m.If(self.events.valid & self._turn):
                    m.d.sync += [self._turn.eq(0), self._in_event.eq(1)]
                    m.next = "EVENT"
                with m.Elif(self.nears & self._turn):
                    # An event comes within some cycles, and does not wait for something else.
                    m.next = "IDLE"
                with m.Elif(self._second_due):
                    m.next = "SECOND"
                with m.Elif(self._multicast_due | (self._static != 0) | self._due.any()):
                    m.next = "ANNOUNCE"
                with m.Elif(self.histories.waits & self._quiet):
                    m.next = "INTAKE"
                with m.Elif(is_builtin & ~self._live.bit_select(self._sweep[2:], 1)):
                    # Its rows are written anew before they count again.
                    m.d.sync += self._sweep.eq(Cat(Const(0, 2), self._sweep[2:] + 1))
                with m.Else():
                    m.d.sync += self._at.eq(self._sweep)
                    m.next = "ROW"
            with m.State("INTAKE"):
                m.d.comb += self.histories.takes.eq(1)
                m.d.sync += [self._quiet.eq(0), self._clean.eq(0)]
                with m.If(self.histories.ends):
                    # Those who wait for it come next.
                    m.d.sync += [self._sweep.eq(self.first_row), self._fresh.eq(1)]
                    m.next = "IDLE"
                with m.Elif(self.histories.asks):
                    self._begin_scan(m, self.first_row)
                    m.d.sync += self._freed.eq(MOST_SAMPLES)
                    m.next = "ACKNOWLEDGED"
            self._acknowledged(m)
            self._announcements(m)
            self._events(m)
            self._participants(m)
            self._listening(m)
            self._matching(m)
            self._sweeping(m)
            self._sampling(m)
            if self.cuts:
                self._cutting(m)
            self._datagrams(m)
        return m

    # What the states share.

    def _declare(self, m: Module) -> None:
        """Make the memories and the registers that several states use."""
        peers, rows, address = self.peers, self.rows, self.address_bits
        link = self.description.link
        endpoints = max(_FIXED_WRITERS, _FIXED_READERS) + max(len(self.parts), len(self.readers))
        self._row = row = Signal(row_layout(peers, endpoints))
        self._rows = _memory(m, "rows", row.shape(), rows)
        self._peers = _memory(m, "peers", peer_layout(), peers)
        if self.serves:
            self._identities = _memory(m, "identities", identity_layout(peers), _REQUESTS)
        # The row and the participant that are worked on, and what is known of our writer.
        self._row_at = Signal(range(rows))
        self._peer, self._peer_row = Signal(range(peers)), Signal(peer_layout())
        self._known, self._accepts = Signal(), Signal()
        self._last, self._gone, self._lower = Signal(32), Signal(32), Signal(32)
        # Whether the sample `_number` was written; and whether it is not there, or not for the row.
        self._is_written, self._is_gone = Signal(), Signal()
        # A scan of a memory: the address, that of the word, and whether word and row are there.
        self._at, self._at_word = Signal(range(rows + 1)), Signal(range(rows + 1))
        self._has_word, self._has_row = Signal(), Signal()
        self._key, self._hit, self._second = Signal(32), Signal(), Signal()
        self._target, self._patience = Signal(32), Signal(range(_MOST_PATIENCE + 1))
        # How far the numbers of an event are ahead of the row's `next`, and whether the first one
        # is not below its `end`.
        self._ahead, self._last_ahead = Signal(signed(33)), Signal(signed(33))
        self._is_unknown = Signal()
        self._free, self._has_free = Signal(range(rows)), Signal()
        # Which peers there are; which are matched, have acknowledged a sample, have to be told.
        self._live, self._matched, self._due = Signal(peers), Signal(peers), Signal(peers)
        self._answers = Signal(peers)
        # Seconds that are left of the lease of each peer.
        self._leases = LutMemory(m, "leases", 7, 1 << max(1, ceil_log2(peers)))
        self._young = Array(Signal(2, name=f"young_{n}") for n in range(peers))
        self._dying = Array(Signal(2, name=f"dying_{n}") for n in range(peers))
        self._sweep, self._turn, self._in_event = Signal(range(rows)), Signal(), Signal()
        # The last row that a sweep comes to, and the last valid one that this sweep has come to.
        self._top = Signal(range(rows), init=self.first_row)
        self._seen = Signal(range(rows), init=self.first_row)
        # Whether a message has come since the last sweep, which no reader has been sent yet.
        self._fresh = Signal()
        # Whether a whole sweep sent no sample for the first time: then a new one is taken.
        self._quiet, self._clean = Signal(), Signal()
        # How many of the oldest samples of a writer may give way.
        self._freed = Signal(range(MOST_SAMPLES + 1))
        self._tick_due, self._tick_pass, self._second_due = Signal(), Signal(), Signal()
        self._statics = [int(IPv4Address(each)) for each in link.static_peers]
        self._most_static = _STATIC_PARTICIPANTS * len(self._statics)
        self._multicast_due, self._static = Signal(), Signal(range(self._most_static + 1))
        # The datagram that is ordered.
        self._job, self._stores = Signal(range(len(self.templates.every))), Signal()
        self._number, self._count = Signal(32), Signal(32)
        self._from, self._to = Signal(32), Signal(32)
        self._bits, self._bitmap, self._is_final = Signal(32), Signal(32), Signal()
        self._address, self._port = Signal(32), Signal(16)
        self._start_at, self._size = Signal(range(len(self.templates.rom))), Signal(16)
        self._sample = sample = Signal(sample_layout(self.parts))
        # What is sent of it: all, or a fragment; which one is next, and which ones are wanted: a
        # bit for each from the next one on, and one for all behind.
        self._sent_at, self._sent_bytes = sample.at, sample.bytes
        if self.cuts:
            self._sent_at, self._sent_bytes = Signal(address), Signal(16)
        most_fragments = self.memory_bytes // fragment_bytes(link) + 1
        self._fragment, self._wanted = Signal(range(most_fragments + 1)), Signal(33)
        self._identity = Signal(identity_layout(peers))
        self._nonce, self._cycles = Signal(32), Signal(32)
        m.d.sync += self._cycles.eq(self._cycles + 1)
        m.d.comb += [
            self.own.eq(Cat(Const(self._fixed_prefix(), 64), self._nonce)),
            self.knows.eq(self._known),
            self.wants.eq(self._accepts),
            self._rows.write_at.eq(self._row_at),
            self._rows.write_word.eq(row),
            self._rows.read_at.eq(self._at),
            self._peers.write_at.eq(self._peer),
            self._peers.read_at.eq(self._at),
            self._leases.write.addr.eq(self._peer),
            self._leases.write.data.eq(self._peer_row.lease),
        ]
        self._fill_order(m)
        event, assembly = self.events.payload, self.assembly
        m.d.comb += [
            assembly.reader.eq(row.local - _FIXED_READERS),
            assembly.row.eq(self._row_at),
            assembly.number.eq(row.next),
            assembly.first.eq(event.bits),
            assembly.fragments.eq(event.fragments),
            assembly.fragment_bytes.eq(event.fragment_bytes),
            assembly.sample_bytes.eq(event.last),
            self.histories.writer.eq(row.local - _FIXED_WRITERS),
            self.histories.number.eq(self._number),
            self.histories.free.eq(self._freed),
            self._is_written.eq(self._number <= self._last),
            self._is_gone.eq(self._number < self._lower),
        ]

    def _fixed_prefix(self) -> int:
        """Return the first 8 bytes of the GUID prefix: the vendor (9.3.1.5), and the node's own."""
        link = self.description.link
        text = f"{self.description.fingerprint} {link.ip} {link.domain} {link.participant}"
        return int.from_bytes(VENDOR + hashlib.sha256(text.encode()).digest()[:6], "little")

    def _ticks(self, m: Module) -> None:
        """Note that a tick or a second is over."""
        cycles = max(2, round(self.description.clock_hz / TICKS_PER_SECOND))
        left, ticks = Signal(range(cycles)), Signal(range(TICKS_PER_SECOND))
        m.d.sync += left.eq(left - 1)
        with m.If(left == 0):
            m.d.sync += [left.eq(cycles - 1), ticks.eq(ticks - 1), self._tick_due.eq(1)]
            with m.If(ticks == 0):
                m.d.sync += [ticks.eq(TICKS_PER_SECOND - 1), self._second_due.eq(1)]

    def _fill_order(self, m: Module) -> None:
        """Tell the transmitter the registers of the datagram that is ordered."""
        order, row, fields = self.order, self._row, self.order.fields
        parts, user = self.parts, row.local - _FIXED_WRITERS
        padded, head = Signal(16), Signal(16)
        m.d.comb += [
            order.start.eq(self._start_at),
            order.size.eq(self._size),
            order.address.eq(self._address),
            order.port.eq(self._port),
            order.at.eq(self._sent_at),
            order.payload_bytes.eq(self._sent_bytes),
            fields.own.eq(self.own),
            fields.peer.eq(self._peer_row.prefix),
            fields.number.eq(self._number),
            fields.first.eq(self._from),
            fields.last.eq(self._to),
            fields.count.eq(self._count),
            fields.bits.eq(self._bits),
            fields.bitmap.eq(self._bitmap),
            fields.flags[8:].eq(_LITTLE | Mux(self._is_final, _FINAL, 0)),
            fields.related.eq(self._identity.guid),
            fields.related_number.eq(self._identity.number),
            padded.eq(Cat(Const(0, 2), (self._sent_bytes + 3)[2:])),
            head.eq(_at([HEAD_BYTES.get(each, 0) for each in Job], self._job)),
            fields.size[16:].eq(head + padded),
        ]
        for number, part in enumerate(parts):
            with m.If(user == number):
                m.d.comb += [order.base.eq(part.base), order.mask.eq(part.bytes - 1)]
        own_writers = [PUBLICATIONS_WRITER, SUBSCRIPTIONS_WRITER, *_entities(self.writers)]
        own_readers = [PUBLICATIONS_READER, SUBSCRIPTIONS_READER, *_entities(self.readers)]
        writer, reader = (
            _at([raw(each) for each in own], row.local) for own in (own_writers, own_readers)
        )
        m.d.comb += [
            fields.reader.eq(Mux(row.writes, row.remote, reader)),
            fields.writer.eq(Mux(row.writes, writer, row.remote)),
        ]
        self._padded = padded

    def _begin_scan(self, m: Module, at: int = 0) -> None:
        m.d.sync += [
            self._at.eq(at),
            self._has_word.eq(0),
            self._has_row.eq(0),
            self._has_free.eq(0),
        ]

    def _kill(self, m: Module, peer: Value) -> None:
        """Forget a peer. Its place is free after two whole sweeps, which clear its rows."""
        m.d.sync += [
            self._live.bit_select(peer, 1).eq(0),
            self._matched.bit_select(peer, 1).eq(0),
            self._answers.bit_select(peer, 1).eq(0),
            self._due.bit_select(peer, 1).eq(0),
            self._dying[peer].eq(2),
        ]

    def _send(self, m: Module, job: Any) -> None:
        """Order a datagram to the endpoint of the row, which is stored after that."""
        m.d.sync += [self._job.eq(job), self._stores.eq(1), self._at.eq(self._row.peer)]
        m.next = "PEER"

    # From reset to the first datagram.

    def _start(self, m: Module) -> None:
        cycles = self._cycles
        with m.State("INIT"):
            # Memories keep their content in a reset.
            m.d.comb += [
                self._rows.writes.eq(1),
                self._rows.write_at.eq(self._at),
            ]
            m.d.sync += self._at.eq(self._at + 1)
            with m.If(self._at == self.rows - 1):
                m.next = "NONCE"
        with m.State("NONCE"):
            most = min(round(_PATIENCE * self.description.clock_hz), (1 << 32) - 256)
            is_late = cycles[8:] >= most >> 8
            with m.If((self.nonce != 0) | self.came | is_late):
                m.d.sync += [
                    self._nonce.eq(Mux(self.nonce != 0, self.nonce, cycles)),
                    self._multicast_due.eq(1),
                    self._static.eq(self._most_static),
                ]
                m.next = "IDLE"

    # Announcements of this participant (8.5.3.3.1), and what else is due once per second.

    def _announcements(self, m: Module) -> None:
        with m.State("SECOND"):
            # The leases of all peers, one per cycle.
            left, write = self._leases.reader(), self._leases.write
            peer = self._at[: len(self._peer)]
            m.d.comb += [
                left.addr.eq(peer),
                write.addr.eq(peer),
                write.data.eq(left.data - 1),
                write.en.eq(1),
            ]
            m.d.sync += self._at.eq(self._at + 1)
            with m.If(self._at == self.peers - 1):
                m.d.sync += [
                    self._second_due.eq(0),
                    self._multicast_due.eq(1),
                    self._static.eq(self._most_static),
                    self._due.eq(self._live),
                    *(young.eq(Mux(young == 0, 0, young - 1)) for young in self._young),
                ]
                m.next = "IDLE"
            with m.If(self._live.bit_select(peer, 1) & (left.data == 0)):
                self._kill(m, peer)
        domain = self.description.link.domain
        ports = [Ports.of(domain, each).discovery for each in range(_STATIC_PARTICIPANTS)]
        with m.State("ANNOUNCE"):
            m.d.sync += [self._job.eq(Job.ANNOUNCE), self._stores.eq(0)]
            m.next = "JOB"
            with m.If(self._multicast_due):
                m.d.sync += [
                    self._multicast_due.eq(0),
                    self._address.eq(int(IPv4Address(MULTICAST_GROUP))),
                    self._port.eq(Ports.of(domain, 0).discovery_multicast),
                ]
            with m.Elif(self._static != 0):
                place = self._static - 1
                m.d.sync += [
                    self._static.eq(place),
                    self._address.eq(_at(self._statics, place[2:])),
                    self._port.eq(_at(ports, place[:2])),
                ]
            with m.Else():
                which = _lowest(self._due)
                m.d.sync += [self._due.bit_select(which, 1).eq(0), self._at.eq(which)]
                m.next = "PEER"

    # Events, and the scans that they need.

    def _events(self, m: Module) -> None:
        event, row = self.events.payload, self._row
        is_answer = (event.kind == EventKind.ACKNACK) | (event.kind == EventKind.NACK_FRAG)
        with m.State("EVENT"):
            key = Mux(is_answer, event.reader, event.writer)
            m.d.sync += [
                self._accepts.eq(0),
                self._key.eq(key),
            ]
            with m.If(event.kind == EventKind.SOURCE):
                m.next = "FIND_PEER"
            with m.Elif(event.kind == EventKind.PARTICIPANT):
                m.next = "PLACE"
            with m.Elif(~self._live.bit_select(self._peer, 1)):
                m.next = "DONE"
            with m.Elif(event.kind == EventKind.PARTICIPANT_GONE):
                self._kill(m, self._peer)
                m.next = "DONE"
            with m.Else():
                # Endpoints of SEDP have their rows, and all others those behind.
                is_builtin = key[30:] == 3
                m.d.sync += self._at.eq(
                    Mux(is_builtin, Cat(Const(0, 2), self._peer), self.first_row)
                )
                m.next = "FIND"

        with m.State("FIND"):
            is_same = row.valid & (row.peer == self._peer) & (row.remote == self._key)
            is_free = ~row.valid & (self._row_at >= self.first_row)
            self._scan(m, self._rows)
            with m.If(self._has_row & is_free & ~self._has_free):
                m.d.sync += [self._free.eq(self._row_at), self._has_free.eq(1)]
            with m.If(self._has_row & (is_same | (self._row_at == self.rows - 1))):
                m.d.sync += self._hit.eq(is_same)
                m.next = "FOUND"
            with m.Else():
                m.d.sync += [
                    Value.cast(row).eq(self._rows.word),
                    self._row_at.eq(self._at_word),
                ]

        with m.State("FOUND"):
            m.d.sync += [
                self._ahead.eq(event.number - row.next),
                self._last_ahead.eq(event.last - row.next),
                self._is_unknown.eq(event.number >= row.end),
            ]
            with m.If(self._second):
                m.next = "MATCH"
            with m.Elif(~self._hit | (row.writes != is_answer)):
                m.d.comb += self.stray.eq(1)
                m.next = "DONE"
            with m.Else(), m.Switch(event.kind):
                with m.Case(EventKind.HEARTBEAT):
                    m.next = "HEARTBEAT"
                with m.Case(EventKind.GAP):
                    m.next = "GAP"
                with m.Case(EventKind.ACKNACK):
                    m.next = "ACKNACK"
                with m.Case(EventKind.NACK_FRAG):
                    m.next = "ROW_STATE" if self.cuts else "DONE"
                with m.Default():
                    m.next = "SAMPLE"

        with m.State("STORE_EVENT"):
            m.d.comb += self._rows.writes.eq(1)
            m.next = "DONE"
        with m.State("DONE"):
            m.d.comb += self.events.ready.eq(1)
            m.d.sync += self._patience.eq(_MOST_PATIENCE)
            m.next = "IDLE"

    def _scan(self, m: Module, memory: BlockMemory) -> None:
        """Read the next word of a memory; it comes a cycle later, and is registered then."""
        m.d.comb += memory.reads.eq(1)
        m.d.sync += [
            self._at.eq(self._at + 1),
            self._at_word.eq(self._at),
            self._has_word.eq(1),
            self._has_row.eq(self._has_word),
        ]

    # Participants (8.5.3.3.2).

    def _participants(self, m: Module) -> None:
        event, announced = self.events.payload, self.announced
        peer, peer_row = self._peer, self._peer_row
        with m.State("FIND_PEER"):
            is_same = self._live.bit_select(peer, 1) & (peer_row.prefix == event.source)
            self._scan(m, self._peers)
            with m.If(self._has_row & (is_same | (peer == self.peers - 1))):
                m.d.sync += self._known.eq(is_same)
                with m.If(is_same):
                    m.d.comb += self._leases.write.en.eq(1)
                m.next = "DONE"
            with m.Else():
                m.d.sync += [
                    Value.cast(peer_row).eq(self._peers.word),
                    peer.eq(self._at_word),
                ]

        with m.State("PLACE"):
            is_free = Cat(~self._live[n] & (self._dying[n] == 0) for n in range(self.peers))
            known = self._matched & self._answers
            strangers = self._live & ~known & Cat(each == 0 for each in self._young)
            m.next = "PLACED"
            with m.If(~announced.is_participant):
                m.next = "DONE"
            with m.Elif(~self._known & is_free.any()):
                m.d.sync += peer.eq(_lowest(is_free))
            with m.Elif(~self._known):
                m.d.comb += self.unsent.eq(1)
                with m.If(strangers.any()):
                    # Its place is free when the newcomer announces itself again.
                    self._kill(m, _lowest(strangers))
                m.next = "DONE"

        with m.State("PLACED"):
            word, user = self._peers.write_word, announced.user
            m.d.comb += [
                self._peers.writes.eq(1),
                word.prefix.eq(event.source),
                word.discovery.eq(announced.discovery),
                word.user.eq(Mux(user.port == 0, announced.discovery.as_value(), user.as_value())),
                word.lease.eq(announced.lease),
            ]
            m.d.comb += [
                self._leases.write.en.eq(1),
                self._leases.write.data.eq(announced.lease),
            ]
            m.next = "DONE"
            with m.If(~self._known):
                m.d.sync += [
                    self._known.eq(1),
                    self._live.bit_select(peer, 1).eq(1),
                    self._due.bit_select(peer, 1).eq(1),
                    self._young[peer].eq(_GRACE),
                ]
                m.next = "BUILTIN"

        with m.State("BUILTIN"):
            # 8.5.5.1: the endpoints of SEDP are matched with those of each participant.
            writers = [PUBLICATIONS_WRITER, SUBSCRIPTIONS_WRITER]
            readers = [PUBLICATIONS_READER, SUBSCRIPTIONS_READER]
            place, word = self._at[:2], self._rows.write_word
            m.d.comb += [
                self._rows.writes.eq(1),
                self._rows.write_at.eq(Cat(place, peer)),
                Value.cast(word).eq(0),
                word.valid.eq(1),
                word.writes.eq(place[1]),
                word.local.eq(place[0]),
                word.peer.eq(peer),
                word.remote.eq(_at([raw(each) for each in (*writers, *readers)], place)),
                word.reliable.eq(1),
                word.next.eq(1),
                word.end.eq(1),
                word.first.eq(1),
                word.ask.eq(1),
            ]
            m.d.sync += self._at.eq(self._at + 1)
            with m.If(place == BUILTIN_ROWS - 1):
                m.next = "DONE"

    # Our readers (8.4.12): what comes of a writer, and what is missing. Samples of topics are taken
    # in order, those of SEDP as they come; `request` has those behind `next` that need not come.

    def _listening(self, m: Module) -> None:
        event, row, assembly = self.events.payload, self._row, self.assembly
        number, target, ahead = event.number, self._target, self._ahead
        is_sedp, is_gap = self._row_at < self.first_row, event.kind == EventKind.GAP
        shifts = Signal(6)
        with m.State("HEARTBEAT"):
            m.d.sync += [target.eq(number), row.synced.eq(row.synced | row.reliable)]
            m.next = "HEARTBEAT_END"
            with m.If(row.reliable & (ahead > 0)):
                # What the writer no longer has is lost.
                m.d.comb += self.lost.eq(row.synced)
                m.next = "ADVANCE"
        with m.State("HEARTBEAT_END"):
            end = Mux(event.last >= row.end, event.last + 1, row.end)
            with m.If(row.reliable):
                m.d.sync += [
                    row.end.eq(end),
                    row.ask.eq(row.ask | ~event.is_final | (row.next != end)),
                ]
            m.next = "STORE_EVENT"

        with m.State("GAP"):
            # 8.3.8.4: from `number` to below `last`, and the bits from `last` on.
            m.d.sync += target.eq(event.last)
            m.next = "STORE_EVENT"
            with m.If(row.reliable & (ahead <= 0) & (self._last_ahead >= 0)):
                m.next = "ADVANCE"

        with m.State("SAMPLE"):
            is_new, is_fragment = ahead >= 0, event.kind == EventKind.FRAGMENT
            takes, bit, is_busy = Signal(), Signal(32), Signal()
            user = (row.local - _FIXED_READERS)[: len(row.local)]
            m.d.comb += [
                bit.eq(Const(1 << 31, 32) >> ahead[:5]),
                takes.eq(Mux(row.reliable, row.synced & (ahead == 0), is_new)),
                is_busy.eq(~is_sedp & ~is_fragment & ~self.idle.bit_select(user, 1)),
            ]
            m.d.comb += assembly.number.eq(number)
            m.d.sync += [self._accepts.eq(takes & ~is_fragment), target.eq(number + 1)]
            m.next = "SAMPLED"
            with m.If(is_sedp):
                m.d.comb += takes.eq(is_new & (ahead < 32) & ((row.request & bit) == 0))
            with m.If(takes & is_busy & (self._patience != 0)):
                # The event is taken again after something else was done.
                m.d.sync += self._patience.eq(self._patience - 1)
                m.next = "IDLE"
            with m.Elif(takes & is_busy & row.reliable):
                m.d.sync += [self._accepts.eq(0), row.ask.eq(row.ask | (row.timer == 0))]
            with m.Elif(takes & is_sedp):
                m.d.sync += row.request.eq(row.request | bit)
                m.next = "SETTLE"
            with m.Elif(takes & is_fragment & (assembly.has_room | assembly.holds)):
                m.d.comb += [assembly.accepts.eq(assembly.fits), self.cut.eq(~assembly.fits)]
                with m.If(assembly.fits):
                    m.d.sync += [self._accepts.eq(1), row.tries.eq(0)]
                with m.Else():
                    m.d.sync += row.ask.eq(row.ask | (row.reliable & (row.timer == 0)))
            with m.Elif(takes):
                m.d.comb += [self.cut.eq(is_fragment), self.lost.eq(row.synced & (ahead != 0))]
                # Of a best-effort writer, the first sample says where its samples begin.
                m.d.sync += row.synced.eq(1)
                m.next = "ADVANCE"
            with m.Elif(is_new & row.synced):
                # Something before it is missing. A request for it may be on its way.
                m.d.sync += row.ask.eq(row.ask | (row.timer == 0))
            with m.Elif(~is_new & ~is_fragment):
                m.d.comb += self.late.eq(1)
            with m.If((takes | (is_new & row.synced)) & self._is_unknown):
                m.d.sync += row.end.eq(number + 1)

        with m.State("ADVANCE"):
            # A sample of a reliable writer is the next one, and best-effort ones have no requests.
            step = Mux(is_gap, self._last_ahead, Mux(event.kind == EventKind.HEARTBEAT, ahead, 1))
            m.d.sync += [row.next.eq(target), row.tries.eq(0), shifts.eq(Mux(step < 32, step, 32))]
            m.next = "SETTLE"
            with m.If(is_gap | (row.request != 0)):
                m.next = "SHIFT"
        with m.State("SHIFT"):
            with m.If((shifts != 0) & (row.request != 0)):
                m.d.sync += [row.request.eq(row.request << 1), shifts.eq(shifts - 1)]
            with m.Else():
                m.d.sync += row.request.eq(row.request | Mux(is_gap, event.bits, 0))
                m.next = "SETTLE"
        with m.State("SETTLE"):
            with m.If(row.request[31]):
                m.d.sync += [row.request.eq(row.request << 1), row.next.eq(row.next + 1)]
            with m.Else():
                with m.If(row.next > row.end):
                    m.d.sync += row.end.eq(row.next)
                with m.Switch(event.kind):
                    with m.Case(EventKind.HEARTBEAT):
                        m.next = "HEARTBEAT_END"
                    with m.Case(EventKind.GAP):
                        m.next = "STORE_EVENT"
                    with m.Default():
                        m.next = "SAMPLED"

        with m.State("SAMPLED"):
            m.d.comb += self._rows.writes.eq(1)
            self._begin_scan(m, self.first_row)
            m.next = "DONE"
            with m.If(self._accepts), m.Switch(event.kind):
                with m.Case(EventKind.ENDPOINT):
                    m.d.sync += [self._second.eq(1), self._key.eq(self.announced.entity)]
                    m.next = "FIND"
                with m.Case(EventKind.ENDPOINT_GONE):
                    m.d.sync += [self._second.eq(1), self._key.eq(event.entity)]
                    m.next = "FIND"
                with m.Case(EventKind.SAMPLE):
                    self._deliver(m)

    def _deliver(self, m: Module) -> None:
        """Tell topic and tag of a sample. The tag of a request leads to what its reply names."""
        event, row = self.events.payload, self._row
        if self.serves:
            named = event.has_related & (event.related != 0)
            word = self._identities.write_word
            m.d.comb += [
                self._identities.writes.eq(1),
                self._identities.write_at.eq(self.tag + 1),
                word.tag.eq(self.tag + 1),
                word.peer.eq(self._peer),
                word.guid.eq(Mux(named, event.related, Cat(event.source, event.writer))),
                word.number.eq(event.number),
            ]
        topics = [each.topic.id for each in self.readers if each.topic]
        m.d.sync += [
            self.topic.eq(_at(topics, row.local - _FIXED_READERS)),
            self.tag.eq(self.tag + 1),
        ]

    # Endpoints of peers (8.5.5.2): which of ours they match, if any.

    def _compare(self, m: Module) -> None:
        """Find the endpoint of ours that has the topic and the type of what is announced."""
        event, announced = self.events.payload, self.announced
        is_writer = event.writer == raw(PUBLICATIONS_WRITER)
        self._is_same, self._local = Signal(), Signal.like(self._row.local)
        self._depth = Signal(range(MOST_SAMPLES + 2))
        self._is_reliable, self._is_durable = Signal(), Signal()
        m.d.sync += self._is_same.eq(0)
        writers = [(_GRAPH + n, each, False) for n, each in enumerate(self.writers)]
        readers = [(_FIXED_READERS + n, each, True) for n, each in enumerate(self.readers)]
        for number, own, listens in (*writers, *readers):
            data, part = own.data, number - _FIXED_WRITERS
            is_same = (announced.topic == digest_of(data.topic)) & (
                announced.type == digest_of(data.type_name)
            )
            with m.If(is_same & (is_writer == listens)):
                m.d.sync += [
                    self._is_same.eq(1),
                    self._local.eq(number),
                    self._is_reliable.eq(data.qos.reliable),
                    self._is_durable.eq(data.qos.durability),
                    self._depth.eq(1 if listens or part < 0 else self.parts[part].depth),
                ]

    def _matching(self, m: Module) -> None:
        event, announced, row = self.events.payload, self.announced, self._row
        is_writer = event.writer == raw(PUBLICATIONS_WRITER)
        # DDS 2.2.3: what is offered is at least what is asked for.
        reliable, durable = announced.is_reliable, announced.durability
        fits = Mux(
            is_writer,
            (reliable | ~self._is_reliable) & (durable >= self._is_durable),
            (self._is_reliable | ~reliable) & (durable <= self._is_durable),
        )
        local, depth = self._local, self._depth
        with m.State("MATCH"):
            is_graph = local == _GRAPH
            m.d.comb += self.histories.writer.eq(local - _FIXED_WRITERS)
            m.d.sync += [
                self._last.eq(Mux(is_graph, 1, self.histories.state.last)),
                self._gone.eq(Mux(is_graph, 0, self.histories.state.gone)),
            ]
            m.next = "DONE"
            is_gone = event.kind == EventKind.ENDPOINT_GONE
            with m.If(is_gone & self._hit & (self._row_at >= self.first_row)):
                m.d.sync += row.valid.eq(0)
                m.next = "STORE_EVENT"
            with m.Elif(~is_gone & ~self._hit & announced.is_endpoint & self._is_same & fits):
                m.d.comb += self.unsent.eq(~self._has_free)
                with m.If(self._has_free):
                    m.d.sync += self._row_at.eq(self._free)
                    for last in (self._top, self._seen):
                        with m.If(self._free > last):
                            m.d.sync += last.eq(self._free)
                    m.next = "MATCHED"
        with m.State("MATCHED"):
            # A volatile reader begins with the next sample, any other one with the history.
            kept, first = Signal(32), Signal(32)
            replays = (durable != 0) & self._is_durable
            m.d.comb += [
                # The row may have been that of another writer.
                self.assembly.reader.eq(local - _FIXED_READERS),
                self.assembly.forgets.eq(is_writer),
                kept.eq(self._last - self._gone),
                first.eq(self._last + 1 - Mux(replays, Mux(kept > depth, depth, kept), 0)),
            ]
            m.d.sync += [
                *(row[name].eq(0) for name in ("base", "request", "synced", "timer", "tries")),
                row.silent.eq(0),
                row.valid.eq(1),
                row.writes.eq(~is_writer),
                row.peer.eq(self._peer),
                row.remote.eq(announced.entity),
                row.local.eq(local),
                row.reliable.eq(reliable & self._is_reliable),
                row.next.eq(Mux(is_writer, 1, first)),
                row.end.eq(Mux(is_writer, 1, first)),
                row.first.eq(first),
                row.ask.eq(reliable & self._is_reliable),
                row.user.eq(announced.user),
                self._matched.bit_select(self._peer, 1).eq(1),
            ]
            m.next = "STORE_EVENT"

        with m.State("ACKNACK"):
            # 8.4.9.2. Base 0 is how Fast DDS greets a writer.
            with m.If(event.number > row.next):
                m.d.sync += [row.next.eq(event.number), row.silent.eq(0)]
            m.d.sync += [
                row.base.eq(event.number),
                row.request.eq(Mux(event.number == 0, 0, event.bits)),
                row.tries.eq(0),
                row.ask.eq(row.ask | (~event.is_final & (event.bits == 0))),
            ]
            with m.If(event.number > 1):
                m.d.sync += self._answers.bit_select(self._peer, 1).eq(1)
            m.next = "STORE_EVENT"

    # The rows in turn, and what is due for each.

    def _sweeping(self, m: Module) -> None:
        row = self._row
        with m.State("ROW"):
            m.d.comb += self._rows.reads.eq(1)
            m.d.sync += self._row_at.eq(self._at)
            m.next = "ROW_READ"
        with m.State("ROW_READ"):
            m.d.sync += Value.cast(row).eq(self._rows.word)
            m.next = "ROW_STATE"
            # Behind a new message, only those wait whom it is for.
            is_passed = self._fresh & ~self._rows.word[1]
            with m.If(~self._rows.word[0] | is_passed):
                m.next = "NEXT"
            with m.If(self._rows.word[0] & (self._row_at > self._seen)):
                m.d.sync += self._seen.eq(self._row_at)
        with m.State("ROW_STATE"):
            counts = [len(self.writers), len(self.readers), 1]
            is_fixed = row.local < _FIXED_WRITERS
            m.d.sync += [
                self._last.eq(Mux(is_fixed, _at(counts, row.local), self.histories.state.last)),
                self._gone.eq(Mux(is_fixed, 0, self.histories.state.gone)),
            ]
            m.next = "ROW_LOWER"
            with m.If(~self._live.bit_select(row.peer, 1)):
                m.d.sync += row.valid.eq(0)
                m.next = "STORE"
        with m.State("ROW_LOWER"):
            m.d.sync += self._lower.eq(Mux(row.first > self._gone, row.first, self._gone + 1))
            m.d.sync += self._number.eq(Mux(row.request == 0, row.end, row.base))
            with m.If(self._tick_pass & ~self._in_event):
                silent = Mux(row.silent == _MOST_SILENT, row.silent, row.silent + 1)
                m.d.sync += row.silent.eq(Mux(row.next <= self._last, silent, 0))
            m.next = "LISTENS"
            with m.If(row.writes):
                m.next = "WRITES"
            if self.cuts:
                with m.If(self._in_event):
                    m.d.sync += self._number.eq(self.events.payload.number)
                    m.next = "NACK_FRAG"
        self._writes_state(m)
        self._listens_state(m)
        with m.State("STORE"):
            m.d.comb += self._rows.writes.eq(1)
            m.next = "NEXT"
        with m.State("NEXT"):
            m.d.sync += self._sweep.eq(self._sweep + 1)
            with m.If(self._sweep == self._top):
                m.d.comb += self.assembly.tick.eq(self._tick_due)
                m.d.sync += [
                    self._sweep.eq(0),
                    self._top.eq(self._seen),
                    self._seen.eq(self.first_row),
                    self._fresh.eq(0),
                    self._quiet.eq(self._clean),
                    self._clean.eq(1),
                    self._tick_pass.eq(self._tick_due),
                    self._tick_due.eq(0),
                ]
                for each in self._dying:
                    with m.If((each != 0) & ~self._fresh):
                        m.d.sync += each.eq(each - 1)
            m.next = "IDLE"

    def _writes_state(self, m: Module) -> None:
        """Serve a reader (8.4.9): samples that it asks for, new ones, heartbeats."""
        row, number = self._row, self._number
        with m.State("WRITES"):
            m.d.sync += [
                self._from.eq(self._lower),
                self._to.eq(self._last),
                self._is_final.eq(row.next > self._last),
                self._fragment.eq(0),
                self._wanted.eq(~0),
            ]
            m.next = "NEXT"
            with m.If(row.request != 0):
                m.next = "REPAIR"
            with m.Elif(self._is_written):
                m.d.sync += self._clean.eq(0)
                with m.If(self._is_gone):
                    m.d.sync += row.end.eq(self._lower)
                    m.next = "STORE"
                with m.Else():
                    m.d.sync += row.end.eq(row.end + 1)
                    m.next = "FETCH"
            with m.Elif(row.ask):
                # Ever more seldom while the reader does not answer.
                pause = Mux(row.tries < 3, _HEARTBEAT << row.tries[:2], _MOST_TIMER)
                m.d.sync += [
                    row.ask.eq(0),
                    row.timer.eq(pause),
                    row.tries.eq(Mux(row.tries == _MOST_TRIES, row.tries, row.tries + 1)),
                ]
                self._send(m, Job.HEARTBEAT)
            with m.Elif(self._tick_pass):
                m.next = "STORE"
                with m.If(row.timer != 0):
                    m.d.sync += row.timer.eq(row.timer - 1)
                with m.Else():
                    m.d.sync += row.ask.eq(row.reliable & (row.next <= self._last))

        with m.State("REPAIR"):
            # `number` is that of the highest bit.
            m.d.sync += [row.request.eq(row.request << 1), row.base.eq(row.base + 1)]
            with m.If(row.request == 0):
                m.next = "STORE"
            with m.Elif(~row.request[31]):
                m.d.sync += number.eq(row.base + 1)
            with m.Else():
                # The heartbeat that is due after the last one tells what is missing then.
                m.d.sync += row.ask.eq(1)
                m.next = "FETCH"
                with m.If(~self._is_written):
                    m.d.sync += row.request.eq(0)
                    m.next = "STORE"
                with m.Elif(self._is_gone):
                    m.d.sync += [self._from.eq(number), self._to.eq(self._lower)]
                    m.d.sync += row.request.eq(0)
                    self._send(m, Job.GAP)

    def _listens_state(self, m: Module) -> None:
        """Answer a writer (8.4.12.2): acknowledge what came, and ask for what is missing."""
        row, assembly = self._row, self.assembly
        with m.State("LISTENS"):
            missing, most, asked = Signal(32), Signal(6), Signal(6)
            lacks = row.synced & (missing != 0)
            m.d.comb += [
                missing.eq(row.end - row.next),
                # Fast DDS sends them in one datagram of up to 64 KiB, which may have no room here.
                most.eq(Mux(row.tries < 5, Const(32, 6) >> row.tries[:3], 1)),
                asked.eq(Mux(missing < most, missing, most)),
            ]
            m.d.sync += [
                self._number.eq(row.next),
                self._to.eq(asked),
                self._bits.eq(0),
                self._bitmap.eq(0),
                self._is_final.eq(row.synced),
            ]
            m.next = "NEXT"
            # Each HEARTBEAT asks for an answer, and each sample that comes again may bring one. So
            # several that were asked for are waited for, or they would make ever more of them.
            waits = lacks & (row.timer != 0) & (missing != 1) & (row.next < row.base)
            is_due = row.ask & ~waits
            with m.If(is_due & lacks & (row.tries == _MOST_TRIES)):
                # Such as a sample that is larger than the memory: it will never come.
                m.d.comb += self.lost.eq(1)
                m.d.sync += [
                    row.next.eq(row.next + 1),
                    row.request.eq(row.request << 1),
                    row.tries.eq(0),
                ]
                m.next = "STORE"
            with m.Elif(is_due):
                m.d.sync += [
                    row.ask.eq(0),
                    row.base.eq(row.next + asked),
                ]
                with m.If(row.timer == 0):
                    m.d.sync += [
                        row.timer.eq(Mux(row.synced, _REPEAT, _GREETING)),
                        row.tries.eq(row.tries + lacks),
                    ]
                self._send(m, Job.ACKNACK)
                with m.If(lacks):
                    m.d.sync += self._job.eq(Job.ACKNACK_MISSING)
                    m.next = "COUNT"
                    with m.If(assembly.holds):
                        m.d.sync += [
                            self._job.eq(Job.NACK_FRAG),
                            self._from.eq(assembly.held.next),
                            self._to.eq(assembly.held.sample_bytes - assembly.held.place),
                        ]
            with m.Elif(self._tick_pass):
                m.next = "STORE"
                with m.If(row.timer != 0):
                    m.d.sync += row.timer.eq(row.timer - 1)
                with m.Else():
                    m.d.sync += row.ask.eq(row.ask | (row.reliable & (lacks | ~row.synced)))

        with m.State("COUNT"):
            # `_to` samples that are missing; or of the fragments that make up `_to` bytes, those
            # that one word can name.
            rest, is_part = self._to, self._job == Job.NACK_FRAG
            step = Mux(is_part, assembly.held.fragment_bytes, 1)
            with m.If((rest == 0) | self._bits[5]):
                m.d.sync += self._bitmap.eq(self._bitmap & Mux(is_part, ~0, ~row.request))
                self._send(m, self._job)
            with m.Else():
                m.d.sync += [
                    self._bits.eq(self._bits + 1),
                    self._bitmap.eq(Cat(self._bitmap[1:], 1)),
                    rest.eq(Mux(rest > step, rest - step, 0)),
                ]

    # Samples of our writers.

    def _acknowledged(self, m: Module) -> None:
        """Tell how many of a writer's oldest samples all readers have that are waited for."""
        row, asked, freed = self._row, self.histories, self._freed
        with m.State("ACKNOWLEDGED"):
            is_waited = row.valid & row.writes & row.reliable & (row.silent != _MOST_SILENT)
            is_of = row.local == asked.asker + _FIXED_WRITERS
            ahead = Signal(signed(33))
            m.d.comb += ahead.eq(row.next - asked.oldest)
            self._scan(m, self._rows)
            m.d.sync += [Value.cast(row).eq(self._rows.word), self._row_at.eq(self._at_word)]
            with m.If(self._has_row & is_waited & is_of & (ahead < freed)):
                m.d.sync += freed.eq(Mux(ahead < 0, 0, ahead))
            with m.If(self._has_row & (self._row_at == self._top)):
                m.next = "FREED"
        with m.State("FREED"):
            m.d.comb += asked.answers.eq(1)
            m.next = "INTAKE"
            with m.If(freed == 0):
                m.next = "IDLE"

    def _sampling(self, m: Module) -> None:
        """Find sample `_number` of the row's writer, and order it, or a GAP in its place."""
        row, templates, sample = self._row, self.templates, self._sample
        with m.State("FETCH"):
            firsts = [templates.writers, templates.readers, templates.graph]
            m.d.comb += self.histories.fetches.eq(1)
            m.next = "FETCHED"
            with m.If(row.local < _FIXED_WRITERS):
                m.d.sync += row.ask.eq(1)
                self._send(m, _at(firsts, row.local) + self._number - 1)
        with m.State("FETCHED"):
            m.d.sync += sample.eq(self.histories.sample)
            m.next = "FOUND_SAMPLE"
        services = [
            _FIXED_WRITERS - 1 + number
            for number, each in enumerate(self.writers)
            if each.is_service
        ]
        with m.State("FOUND_SAMPLE"):
            self._send_sample(m, Job.SAMPLE, Job.FRAGMENT)
            if services:
                with m.If(Cat(row.local == each for each in services).any()):
                    m.next = "IDENTITY"
        if services:
            self._replying(m)

    def _replying(self, m: Module) -> None:
        """Order a reply of a service for who asked, and a GAP for everybody else."""
        row, identity, sample = self._row, self._identity, self._sample
        with m.State("IDENTITY"):
            m.d.comb += [
                self._identities.read_at.eq(sample.tag),
                self._identities.reads.eq(1),
            ]
            m.next = "IDENTIFIED"
        with m.State("IDENTIFIED"):
            m.d.sync += Value.cast(identity).eq(self._identities.word)
            m.next = "REPLY"
        with m.State("REPLY"):
            # A client that names no reader has one in the participant that asked.
            asked = identity.guid[96:]
            is_named = asked[24 + _READER_BIT]
            is_for = (identity.tag == sample.tag) & (identity.peer == row.peer)
            self._send_sample(m, Job.REPLY, Job.REPLY_FRAGMENT)
            with m.If(~is_for | (is_named & (asked != row.remote))):
                m.d.sync += [self._from.eq(self._number), self._to.eq(self._number + 1)]
                with m.If(row.next == self._number):
                    # Nobody waits for it.
                    m.d.sync += row.next.eq(row.next + 1)
                self._send(m, Job.GAP)

    def _send_sample(self, m: Module, whole: Job, fragment: Job) -> None:
        """Order the sample that was fetched, in fragments if it is large."""
        sample = self._sample
        self._send(m, whole)
        if self.cuts:
            m.d.sync += [self._sent_at.eq(sample.at), self._sent_bytes.eq(sample.bytes)]
            with m.If(sample.bytes > self.whole_bytes):
                m.d.sync += self._job.eq(fragment)
                m.next = "FRAGMENT"

    # Fragments (8.4.14).

    def _cutting(self, m: Module) -> None:
        """Order the wanted fragments of a sample one after another, then a heartbeat.

        They are sent without a pause, so a sample needs no state of its own in each row. A
        NACK_FRAG is answered in the same way, while its event waits.
        """
        event, row, sample = self.events.payload, self._row, self._sample
        size = fragment_bytes(self.description.link)
        with m.State("NACK_FRAG"):
            fragment = event.last - 1
            m.d.sync += [
                self._fragment.eq(fragment),
                self._wanted.eq(event.bits << 1),
                row.tries.eq(0),
                row.ask.eq(row.reliable),
            ]
            m.next = "STORE_EVENT"
            is_there = self._is_written & ~self._is_gone
            with m.If(is_there & (event.last != 0) & (fragment < self.memory_bytes // size)):
                m.next = "FETCH"
        with m.State("FRAGMENT"):
            start, rest = Signal(self.address_bits + 1), Signal(self.address_bits + 1)
            m.d.comb += [
                start.eq(self._fragment << ceil_log2(size)),
                rest.eq(sample.bytes - start),
            ]
            m.d.sync += [
                self._sent_at.eq(sample.at + start),
                self._sent_bytes.eq(Mux(rest > size, size, rest)),
                self._from.eq(self._fragment + 1),
                self._to.eq(sample.bytes),
                self._at.eq(row.peer),
            ]
            m.next = "PEER"
            with m.If((start >= sample.bytes) | (self._wanted == 0)):
                m.d.sync += row.ask.eq(row.reliable)
                m.next = "STORE"
                with m.If(self._in_event):
                    m.next = "STORE_EVENT"
            with m.Elif(~self._wanted[32]):
                self._pass_fragment(m)
                m.next = "FRAGMENT"

    def _pass_fragment(self, m: Module) -> None:
        """Go on to the fragment behind. The lowest bit is that of all that have none."""
        wanted = self._wanted
        m.d.sync += [
            self._fragment.eq(self._fragment + 1),
            wanted.eq(Cat(wanted[0], wanted[0], wanted[1:32])),
        ]

    # Datagrams.

    def _datagrams(self, m: Module) -> None:
        row, peer_row, job = self._row, self._peer_row, self._job
        with m.State("PEER"):
            m.d.comb += self._peers.reads.eq(1)
            m.next = "PEER_READ"
        with m.State("PEER_READ"):
            m.d.sync += Value.cast(peer_row).eq(self._peers.word)
            m.next = "WAY"
        with m.State("WAY"):
            is_user = self._stores & (self._row_at >= self.first_row)
            own_way = Mux(row.user.port == 0, peer_row.user.as_value(), row.user.as_value())
            m.d.sync += Cat(self._address, self._port).eq(
                Mux(is_user, own_way, peer_row.discovery.as_value())
            )
            is_greeting = self._stores & (job == Job.ACKNACK) & ~row.synced
            with m.If(is_greeting & (peer_row.prefix[:16] == _FAST_DDS)):
                m.d.sync += self._number.eq(0)
            m.next = "JOB"
        with m.State("JOB"):
            every = self.templates.every
            has_payload = Cat(job == each for each in HEAD_BYTES).any()
            m.d.sync += [
                self._start_at.eq(_at(self.templates.starts, job)),
                self._size.eq(
                    _at([each.size for each in every], job) + Mux(has_payload, self._padded, 0)
                ),
            ]
            m.next = "SEND"
        with m.State("SEND"):
            m.d.comb += self.starts.eq(1)
            m.next = "SENDING"
        with m.State("SENDING"), m.If(self.ends):
            m.d.sync += self._count.eq(self._count + 1)
            m.next = "IDLE"
            with m.If(self._stores):
                m.next = "STORE"
                if self.cuts:
                    with m.If(self._in_event):
                        m.next = "STORE_EVENT"
                    with m.If((job == Job.FRAGMENT) | (job == Job.REPLY_FRAGMENT)):
                        self._pass_fragment(m)
                        m.next = "FRAGMENT"


def _memory(m: Module, name: str, shape: Any, depth: int) -> BlockMemory:
    """Add a memory in a module of its own."""
    m.submodules[name] = inner = Module()
    return BlockMemory(inner, shape, 1 << max(1, ceil_log2(depth)))


def _entities(endpoints: tuple[Endpoint, ...]) -> list[int]:
    return [each.data.guid.entity for each in endpoints]


def _at(values: list[int], index: Any) -> Value:
    """Return a constant by its number."""
    width = max(each.bit_length() for each in [1, *values])
    return Array(Const(each, width) for each in values or [0])[Value.cast(index).as_unsigned()]


def _lowest(bits: Value) -> Value:
    """Return the number of the lowest bit that is 1."""
    found: Value = Const(len(bits) - 1, range(len(bits)))
    for place in reversed(range(len(bits) - 1)):
        found = Mux(bits[place], place, found)
    return found
