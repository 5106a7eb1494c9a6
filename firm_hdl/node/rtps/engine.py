"""All that a participant decides: what it does next, and what it sends."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.node.capacity import largest_bytes
from firm_hdl.node.description import Description
from firm_hdl.node.rtps.assembler import LookupSignature
from firm_hdl.node.rtps.endpoints import Endpoint
from firm_hdl.node.rtps.events import EventKind, announced_layout, event_layout
from firm_hdl.node.rtps.history import MOST_SAMPLES, Part, bytes_of
from firm_hdl.node.rtps.intake import HistoriesSignature
from firm_hdl.node.rtps.listening import listening, listens
from firm_hdl.node.rtps.matches import compare, find, matching
from firm_hdl.node.rtps.peers import announcements, participants, start
from firm_hdl.node.rtps.state import (
    FIXED_WRITERS,
    MOST_PATIENCE,
    MOST_SILENT,
    State,
    constant,
    is_for_writer,
)
from firm_hdl.node.rtps.tables import BUILTIN_ROWS
from firm_hdl.node.rtps.templates import HEAD_BYTES, Job, Templates
from firm_hdl.node.rtps.transmitter import order_layout
from firm_hdl.node.rtps.writing import (
    acknack,
    acknowledged,
    cutting,
    pass_fragment,
    sampling,
    writes,
)

__all__ = ["Engine"]

# How GUID prefixes of Fast DDS begin, which answers a first ACKNACK at once if its base is 0.
_FAST_DDS = 0x0F01


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
        # All states lead to `IDLE` again:
        #
        #   EVENT    -> FIND_PEER | PLACE -> PLACED -> BUILTIN | FIND -> FOUND -> by kind -> DONE
        #   SECOND
        #   INTAKE  <-> ACKNOWLEDGED -> FREED
        #   ANNOUNCE -> datagram
        #   ROW      -> ROW_READ -> ROW_STATE -> ROW_LOWER -> WRITES | LISTENS -> STORE -> NEXT
        #   WRITES   -> REPAIR | FETCH -> FETCHED -> FOUND_SAMPLE (-> IDENTITY ..) -> datagram
        #   LISTENS  -> COUNT -> datagram
        #   datagram =  PEER -> PEER_READ -> WAY -> JOB -> SEND -> SENDING -> STORE
        #
        # An announced endpoint goes through `FIND` twice: for the writer of SEDP, whose sample it
        # is, and for itself (`second`), which leads from `FOUND` to `MATCH` and `MATCHED`.
        m = Module()
        s = State(m, self)
        compared = compare(m, s)
        is_builtin = s.sweep < self.first_row
        with m.FSM():
            start(m, s)
            with m.State("IDLE"):
                # After an event, `turn` is 0 for one cycle, in which something else is chosen. So a
                # flood of datagrams cannot keep the engine from its other work.
                m.d.sync += [s.second.eq(0), s.turn.eq(1), s.in_event.eq(0)]
                s.begin_scan(m)
                with m.If(self.events.valid & s.turn):
                    m.d.sync += [s.turn.eq(0), s.in_event.eq(1)]
                    m.next = "EVENT"
                with m.Elif(self.nears & s.turn):
                    # An event comes within some cycles, and does not wait for something else.
                    m.next = "IDLE"
                with m.Elif(s.second_due):
                    m.next = "SECOND"
                with m.Elif(s.multicast_due | (s.static != 0) | s.due.any()):
                    m.next = "ANNOUNCE"
                # A message may take the place of an older one. So it has to wait until all readers
                # were sent those before (`quiet`).
                with m.Elif(self.histories.waits & s.quiet):
                    m.next = "INTAKE"
                with m.Elif(is_builtin & ~s.live.bit_select(s.sweep[2:], 1)):
                    # Its rows are written anew before they count again.
                    m.d.sync += s.sweep.eq(Cat(Const(0, 2), s.sweep[2:] + 1))
                with m.Else():
                    m.d.sync += s.at.eq(s.sweep)
                    m.next = "ROW"
            with m.State("INTAKE"):
                m.d.comb += self.histories.takes.eq(1)
                m.d.sync += [s.quiet.eq(0), s.clean.eq(0)]
                with m.If(self.histories.ends):
                    # Those who wait for it come next.
                    m.d.sync += [s.sweep.eq(self.first_row), s.fresh.eq(1)]
                    m.next = "IDLE"
                with m.Elif(self.histories.asks):
                    s.begin_scan(m, self.first_row)
                    m.d.sync += s.freed.eq(MOST_SAMPLES)
                    m.next = "ACKNOWLEDGED"
            acknowledged(m, s)
            announcements(m, s)
            _events(m, s)
            participants(m, s)
            listening(m, s)
            matching(m, s, compared)
            acknack(m, s)
            _sweep(m, s)
            sampling(m, s)
            if self.cuts:
                cutting(m, s)
            _datagrams(m, s)
        return m


def _events(m: Module, s: State) -> None:
    """Take an event, and say that it is done."""
    event = s.engine.events.payload
    with m.State("EVENT"):
        key = Mux(is_for_writer(event), event.reader, event.writer)
        m.d.sync += [
            s.accepts.eq(0),
            s.key.eq(key),
        ]
        with m.If(event.kind == EventKind.SOURCE):
            m.next = "FIND_PEER"
        with m.Elif(event.kind == EventKind.PARTICIPANT):
            m.next = "PLACE"
        with m.Elif(~s.live.bit_select(s.peer, 1)):
            m.next = "DONE"
        with m.Elif(event.kind == EventKind.PARTICIPANT_GONE):
            s.kill(m, s.peer)
            m.next = "DONE"
        with m.Else():
            # Endpoints of SEDP have their rows, and all others those behind. The upper two bits of
            # an entity's kind say that it is one of the standard's own (table 9.1).
            is_builtin = key[30:] == 3
            m.d.sync += s.at.eq(Mux(is_builtin, Cat(Const(0, 2), s.peer), s.engine.first_row))
            m.next = "FIND"
    find(m, s)
    with m.State("STORE_EVENT"):
        m.d.comb += s.rows_memory.writes.eq(1)
        m.next = "DONE"
    with m.State("DONE"):
        m.d.comb += s.engine.events.ready.eq(1)
        m.d.sync += s.patience.eq(MOST_PATIENCE)
        m.next = "IDLE"


def _sweep(m: Module, s: State) -> None:
    """Look at a row of the table of endpoints, and at what is due for it."""
    row = s.row
    with m.State("ROW"):
        m.d.comb += s.rows_memory.reads.eq(1)
        m.d.sync += s.row_at.eq(s.at)
        m.next = "ROW_READ"
    with m.State("ROW_READ"):
        m.d.sync += Value.cast(row).eq(s.rows_memory.word)
        m.next = "ROW_STATE"
        # Behind a new message, only those wait whom it is for. The bits 0 and 1 of a row are
        # `valid` and `writes`.
        is_passed = s.fresh & ~s.rows_memory.word[1]
        with m.If(~s.rows_memory.word[0] | is_passed):
            m.next = "NEXT"
        with m.If(s.rows_memory.word[0] & (s.row_at > s.seen)):
            m.d.sync += s.seen.eq(s.row_at)
    with m.State("ROW_STATE"):
        # Sample n of a writer of SEDP announces our endpoint n; the graph has one sample.
        counts = [len(s.engine.writers), len(s.engine.readers), 1]
        is_fixed = row.local < FIXED_WRITERS
        m.d.sync += [
            s.last.eq(Mux(is_fixed, constant(counts, row.local), s.engine.histories.state.last)),
            s.gone.eq(Mux(is_fixed, 0, s.engine.histories.state.gone)),
        ]
        m.next = "ROW_LOWER"
        # A row outlives its peer until a sweep comes to it; `kill` waits for that.
        with m.If(~s.live.bit_select(row.peer, 1)):
            m.d.sync += [row.valid.eq(0), s.has_room.eq(1)]
            m.next = "STORE"
    with m.State("ROW_LOWER"):
        m.d.sync += s.lower.eq(Mux(row.first > s.gone, row.first, s.gone + 1))
        m.d.sync += s.number.eq(Mux(row.request == 0, row.end, row.base))
        with m.If(s.tick_pass & ~s.in_event):
            silent = Mux(row.silent == MOST_SILENT, row.silent, row.silent + 1)
            m.d.sync += row.silent.eq(Mux(row.next <= s.last, silent, 0))
        m.next = "LISTENS"
        with m.If(row.writes):
            m.next = "WRITES"
        if s.engine.cuts:
            with m.If(s.in_event):
                m.d.sync += s.number.eq(s.engine.events.payload.number)
                m.next = "NACK_FRAG"
    writes(m, s)
    listens(m, s)
    with m.State("STORE"):
        m.d.comb += s.rows_memory.writes.eq(1)
        m.next = "NEXT"
    with m.State("NEXT"):
        m.d.sync += s.sweep.eq(s.sweep + 1)
        with m.If(s.sweep == s.top):
            m.d.comb += s.engine.assembly.tick.eq(s.tick_due)
            m.d.sync += [
                s.sweep.eq(0),
                s.top.eq(s.seen),
                s.seen.eq(s.engine.first_row),
                s.fresh.eq(0),
                s.quiet.eq(s.clean),
                s.clean.eq(1),
                s.tick_pass.eq(s.tick_due),
                s.tick_due.eq(0),
            ]
            # A sweep behind a new message passes rows over, so it clears none.
            for each in s.dying:
                with m.If((each != 0) & ~s.fresh):
                    m.d.sync += each.eq(each - 1)
        m.next = "IDLE"


def _datagrams(m: Module, s: State) -> None:
    """Order the datagram that was chosen."""
    row, peer_row, job = s.row, s.peer_row, s.job
    with m.State("PEER"):
        m.d.comb += s.peers_memory.reads.eq(1)
        m.next = "PEER_READ"
    with m.State("PEER_READ"):
        m.d.sync += Value.cast(peer_row).eq(s.peers_memory.word)
        m.next = "WAY"
    with m.State("WAY"):
        # Discovery goes to the metatraffic locator of a participant, samples to the default one, or
        # to that of the endpoint if it has named one.
        is_user = s.stores & (s.row_at >= s.engine.first_row)
        own_way = Mux(row.user.port == 0, peer_row.user.as_value(), row.user.as_value())
        m.d.sync += Cat(s.address, s.port).eq(Mux(is_user, own_way, peer_row.discovery.as_value()))
        is_greeting = s.stores & (job == Job.ACKNACK) & ~row.synced
        with m.If(is_greeting & (peer_row.prefix[:16] == _FAST_DDS)):
            m.d.sync += s.number.eq(0)
        m.next = "JOB"
    with m.State("JOB"):
        every = s.engine.templates.every
        has_payload = Cat(job == each for each in HEAD_BYTES).any()
        m.d.sync += [
            s.start_at.eq(constant(s.engine.templates.starts, job)),
            s.size.eq(constant([each.size for each in every], job) + Mux(has_payload, s.padded, 0)),
        ]
        m.next = "SEND"
    with m.State("SEND"):
        m.d.comb += s.engine.starts.eq(1)
        m.next = "SENDING"
    with m.State("SENDING"), m.If(s.engine.ends):
        m.d.sync += s.count.eq(s.count + 1)
        m.next = "IDLE"
        with m.If(s.stores):
            m.next = "STORE"
            if s.engine.cuts:
                with m.If(s.in_event):
                    m.next = "STORE_EVENT"
                with m.If((job == Job.FRAGMENT) | (job == Job.REPLY_FRAGMENT)):
                    pass_fragment(m, s)
                    m.next = "FRAGMENT"
