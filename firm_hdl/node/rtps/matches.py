"""The table of matched endpoints: which of ours those of peers match, and where they are."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal, Value

from firm_hdl.node.description import Link
from firm_hdl.node.rtps.events import EventKind, raw
from firm_hdl.node.rtps.history import MOST_SAMPLES
from firm_hdl.node.rtps.names import digest_of
from firm_hdl.node.rtps.state import FIXED_READERS, FIXED_WRITERS, GRAPH, State, is_for_writer
from firm_hdl.rtps.wire.guid import PUBLICATIONS_WRITER

__all__ = ["compare", "find", "matching"]


def _most_matches(link: Link) -> int:
    """Return how many endpoints of one peer are matched: half of them, if others may come."""
    return link.matches if link.peers == 1 else (link.matches + 1) // 2


def find(m: Module, s: State) -> None:
    """Find the row of an event's endpoint, or a free one."""
    event, row = s.engine.events.payload, s.row
    is_answer = is_for_writer(event)
    with m.State("FIND"):
        is_same = row.valid & (row.peer == s.peer) & (row.remote == s.key)
        is_free = ~row.valid & (s.row_at >= s.engine.first_row)
        s.scan(m, s.rows_memory)
        with m.If(s.has_row & is_free & ~s.has_free):
            m.d.sync += [s.free.eq(s.row_at), s.has_free.eq(1)]
        with m.If(s.has_row & row.valid & (row.peer == s.peer)):
            m.d.sync += s.held.eq(s.held + 1)
        with m.If(s.has_row & (is_same | (s.row_at == s.engine.rows - 1))):
            m.d.sync += s.hit.eq(is_same)
            m.next = "FOUND"
        with m.Else():
            m.d.sync += [
                Value.cast(row).eq(s.rows_memory.word),
                s.row_at.eq(s.at_word),
            ]

    with m.State("FOUND"):
        m.d.sync += [
            s.ahead.eq(event.number - row.next),
            s.last_ahead.eq(event.last - row.next),
            s.is_unknown.eq(event.number >= row.end),
        ]
        with m.If(s.second):
            m.next = "MATCH"
        with m.Elif(~s.hit | (row.writes != is_answer)):
            m.d.comb += s.engine.stray.eq(1)
            m.next = "DONE"
        with m.Else(), m.Switch(event.kind):
            with m.Case(EventKind.HEARTBEAT):
                m.next = "HEARTBEAT"
            with m.Case(EventKind.GAP):
                m.next = "GAP"
            with m.Case(EventKind.ACKNACK):
                m.next = "ACKNACK"
            with m.Case(EventKind.NACK_FRAG):
                m.next = "ROW_STATE" if s.engine.cuts else "DONE"
            with m.Default():
                m.next = "SAMPLE"


def matching(m: Module, s: State, compared: tuple[Signal, ...]) -> None:
    """Match endpoints of peers with ours (8.5.5.2), as `compare` has found them."""
    event, announced, row = s.engine.events.payload, s.engine.announced, s.row
    is_writer = event.writer == raw(PUBLICATIONS_WRITER)
    has_same, local, depth, is_reliable, is_durable = compared
    # DDS 2.2.3: what is offered is at least what is asked for.
    reliable, durable = announced.is_reliable, announced.durability
    fits = Mux(
        is_writer,
        (reliable | ~is_reliable) & (durable >= is_durable),
        (is_reliable | ~reliable) & (durable <= is_durable),
    )
    with m.State("MATCH"):
        is_graph = local == GRAPH
        m.d.comb += s.engine.histories.writer.eq(local - FIXED_WRITERS)
        m.d.sync += [
            s.last.eq(Mux(is_graph, 1, s.engine.histories.state.last)),
            s.gone.eq(Mux(is_graph, 0, s.engine.histories.state.gone)),
        ]
        m.next = "DONE"
        is_gone = event.kind == EventKind.ENDPOINT_GONE
        with m.If(is_gone & s.hit & (s.row_at >= s.engine.first_row)):
            m.d.sync += [row.valid.eq(0), s.has_room.eq(1)]
            m.next = "STORE_EVENT"
        with m.Elif(~is_gone & ~s.hit & announced.is_endpoint & has_same & fits):
            fits_in = s.has_free & (s.held < _most_matches(s.engine.description.link))
            m.d.comb += s.engine.unsent.eq(~fits_in)
            with m.If(~fits_in):
                m.d.sync += s.refused.bit_select(s.peer, 1).eq(1)
            with m.Else():
                m.d.sync += s.row_at.eq(s.free)
                # The sweep under way has to come to the row, and so has the next one.
                for last in (s.top, s.seen):
                    with m.If(s.free > last):
                        m.d.sync += last.eq(s.free)
                m.next = "MATCHED"
    with m.State("MATCHED"):
        # A volatile reader begins with the next sample, any other one with the history.
        kept, first = Signal(32), Signal(32)
        replays = (durable != 0) & is_durable
        m.d.comb += [
            # The row may have been that of another writer.
            s.engine.assembly.reader.eq(local - FIXED_READERS),
            s.engine.assembly.forgets.eq(is_writer),
            kept.eq(s.last - s.gone),
            first.eq(s.last + 1 - Mux(replays, Mux(kept > depth, depth, kept), 0)),
        ]
        m.d.sync += [
            *(row[name].eq(0) for name in ("base", "request", "synced", "timer", "tries")),
            row.silent.eq(0),
            row.valid.eq(1),
            row.writes.eq(~is_writer),
            row.peer.eq(s.peer),
            row.remote.eq(announced.entity),
            row.local.eq(local),
            row.reliable.eq(reliable & is_reliable),
            row.next.eq(Mux(is_writer, 1, first)),
            row.end.eq(Mux(is_writer, 1, first)),
            row.first.eq(first),
            row.ask.eq(reliable & is_reliable),
            row.user.eq(announced.user),
            s.matched.bit_select(s.peer, 1).eq(1),
        ]
        m.next = "STORE_EVENT"


def compare(m: Module, s: State) -> tuple[Signal, ...]:
    """Find the endpoint of ours that has the topic and the type of what is announced.

    Returns registers, which follow `announced` by a cycle: `FIND` takes more.
    """
    event, announced = s.engine.events.payload, s.engine.announced
    is_writer = event.writer == raw(PUBLICATIONS_WRITER)
    has_same, local = Signal(), Signal.like(s.row.local)
    depth = Signal(range(MOST_SAMPLES + 2))
    is_reliable, is_durable = Signal(), Signal()
    m.d.sync += has_same.eq(0)
    writers = [(GRAPH + n, each, False) for n, each in enumerate(s.engine.writers)]
    readers = [(FIXED_READERS + n, each, True) for n, each in enumerate(s.engine.readers)]
    for number, own, listens in (*writers, *readers):
        data, part = own.data, number - FIXED_WRITERS
        is_same = (announced.topic == digest_of(data.topic)) & (
            announced.type == digest_of(data.type_name)
        )
        with m.If(is_same & (is_writer == listens)):
            m.d.sync += [
                has_same.eq(1),
                local.eq(number),
                is_reliable.eq(data.qos.reliable),
                is_durable.eq(data.qos.durability),
                depth.eq(1 if listens or part < 0 else s.engine.parts[part].depth),
            ]
    return has_same, local, depth, is_reliable, is_durable
