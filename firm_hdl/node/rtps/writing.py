"""Our writers (8.4.9): samples and fragments for each reader, again if it asks, heartbeats."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Mux, Signal, Value, signed
from amaranth.utils import ceil_log2

from firm_hdl.node.rtps.state import (
    FIXED_WRITERS,
    MOST_SILENT,
    MOST_TIMER,
    MOST_TRIES,
    State,
    constant,
)
from firm_hdl.node.rtps.templates import Job, fragment_bytes

__all__ = ["acknack", "acknowledged", "cutting", "pass_fragment", "sampling", "writes"]

# Ticks between heartbeats to a reader that does not answer, at first.
_HEARTBEAT = 2
_READER_BIT = 2


def acknack(m: Module, s: State) -> None:
    """Take what a reader acknowledges, and asks for."""
    event, row = s.engine.events.payload, s.row
    with m.State("ACKNACK"):
        # 8.4.9.2. Base 0 is how Fast DDS greets a writer.
        with m.If(event.number > row.next):
            m.d.sync += [row.next.eq(event.number), row.silent.eq(0)]
        # A heartbeat is due if one is asked for; behind samples that are sent again, it comes
        # anyway.
        m.d.sync += [
            row.base.eq(event.number),
            row.request.eq(Mux(event.number == 0, 0, event.bits)),
            row.tries.eq(0),
            row.ask.eq(row.ask | (~event.is_final & (event.bits == 0))),
        ]
        with m.If(event.number > 1):
            m.d.sync += s.answers.bit_select(s.peer, 1).eq(1)
        m.next = "STORE_EVENT"


def acknowledged(m: Module, s: State) -> None:
    """Tell how many of a writer's oldest samples all readers have that are waited for."""
    row, asked, freed = s.row, s.engine.histories, s.freed
    with m.State("ACKNOWLEDGED"):
        is_waited = row.valid & row.writes & row.reliable & (row.silent != MOST_SILENT)
        is_of = row.local == asked.asker + FIXED_WRITERS
        ahead = Signal(signed(33))
        m.d.comb += ahead.eq(row.next - asked.oldest)
        s.scan(m, s.rows_memory)
        m.d.sync += [Value.cast(row).eq(s.rows_memory.word), s.row_at.eq(s.at_word)]
        with m.If(s.has_row & is_waited & is_of & (ahead < freed)):
            m.d.sync += freed.eq(Mux(ahead < 0, 0, ahead))
        with m.If(s.has_row & (s.row_at == s.top)):
            m.next = "FREED"
    with m.State("FREED"):
        m.d.comb += asked.answers.eq(1)
        m.next = "INTAKE"
        with m.If(freed == 0):
            m.next = "IDLE"


def writes(m: Module, s: State) -> None:
    """Serve a reader (8.4.9): samples that it asks for, new ones, heartbeats."""
    row, number = s.row, s.number
    with m.State("WRITES"):
        m.d.sync += [
            s.from_.eq(s.lower),
            s.to.eq(s.last),
            s.is_final.eq(row.next > s.last),
            s.fragment.eq(0),
            s.wanted.eq(~0),
        ]
        m.next = "NEXT"
        with m.If(row.request != 0):
            m.next = "REPAIR"
        with m.Elif(s.is_written):
            m.d.sync += s.clean.eq(0)
            with m.If(s.is_gone):
                m.d.sync += row.end.eq(s.lower)
                m.next = "STORE"
            with m.Else():
                m.d.sync += row.end.eq(row.end + 1)
                m.next = "FETCH"
        with m.Elif(row.ask):
            # Ever more seldom while the reader does not answer.
            pause = Mux(row.tries < 3, _HEARTBEAT << row.tries[:2], MOST_TIMER)
            m.d.sync += [
                row.ask.eq(0),
                row.timer.eq(pause),
                row.tries.eq(Mux(row.tries == MOST_TRIES, row.tries, row.tries + 1)),
            ]
            s.send(m, Job.HEARTBEAT)
        with m.Elif(s.tick_pass):
            m.next = "STORE"
            with m.If(row.timer != 0):
                m.d.sync += row.timer.eq(row.timer - 1)
            with m.Else():
                m.d.sync += row.ask.eq(row.reliable & (row.next <= s.last))

    with m.State("REPAIR"):
        # `number` is that of the highest bit. A bit per cycle is passed over; one that is 1 costs a
        # visit of its own, after which the next sweep goes on with the bits behind it.
        m.d.sync += [row.request.eq(row.request << 1), row.base.eq(row.base + 1)]
        with m.If(row.request == 0):
            m.next = "STORE"
        with m.Elif(~row.request[31]):
            m.d.sync += number.eq(row.base + 1)
        with m.Else():
            # The heartbeat that is due after the last one tells what is missing then.
            m.d.sync += row.ask.eq(1)
            m.next = "FETCH"
            with m.If(~s.is_written):
                m.d.sync += row.request.eq(0)
                m.next = "STORE"
            with m.Elif(s.is_gone):
                # One GAP for all that are gone. Those behind are asked for again.
                m.d.sync += [s.from_.eq(number), s.to.eq(s.lower)]
                m.d.sync += row.request.eq(0)
                s.send(m, Job.GAP)


def sampling(m: Module, s: State) -> None:
    """Find sample `number` of the row's writer, and order it, or a GAP in its place."""
    row, templates, sample = s.row, s.engine.templates, s.sample
    with m.State("FETCH"):
        firsts = [templates.writers, templates.readers, templates.graph]
        m.d.comb += s.engine.histories.fetches.eq(1)
        m.next = "FETCHED"
        # Samples that never change are templates. They have no heartbeat beside them, so one is
        # due.
        with m.If(row.local < FIXED_WRITERS):
            m.d.sync += row.ask.eq(1)
            s.send(m, constant(firsts, row.local) + s.number - 1)
    with m.State("FETCHED"):
        m.d.sync += sample.eq(s.engine.histories.sample)
        m.next = "FOUND_SAMPLE"
    services = [
        FIXED_WRITERS - 1 + number
        for number, each in enumerate(s.engine.writers)
        if each.is_service
    ]
    with m.State("FOUND_SAMPLE"):
        _send_sample(m, s, Job.SAMPLE, Job.FRAGMENT)
        if services:
            with m.If(Cat(row.local == each for each in services).any()):
                m.next = "IDENTITY"
    if services:
        _reply(m, s)


def _reply(m: Module, s: State) -> None:
    """Order a reply of a service for who asked, and a GAP for everybody else."""
    row, identity, sample = s.row, s.identity, s.sample
    with m.State("IDENTITY"):
        m.d.comb += [
            s.identities.read_at.eq(sample.tag),
            s.identities.reads.eq(1),
        ]
        m.next = "IDENTIFIED"
    with m.State("IDENTIFIED"):
        m.d.sync += Value.cast(identity).eq(s.identities.word)
        m.next = "REPLY"
    with m.State("REPLY"):
        # A client that names no reader has one in the participant that asked.
        asked = identity.guid[96:]
        is_named = asked[24 + _READER_BIT]
        is_for = (identity.tag == sample.tag) & (identity.peer == row.peer)
        _send_sample(m, s, Job.REPLY, Job.REPLY_FRAGMENT)
        with m.If(~is_for | (is_named & (asked != row.remote))):
            m.d.sync += [s.from_.eq(s.number), s.to.eq(s.number + 1)]
            with m.If(row.next == s.number):
                # Nobody waits for it.
                m.d.sync += row.next.eq(row.next + 1)
            s.send(m, Job.GAP)


def _send_sample(m: Module, s: State, whole: Job, fragment: Job) -> None:
    """Order the sample that was fetched, in fragments if it is large."""
    sample = s.sample
    s.send(m, whole)
    if s.engine.cuts:
        m.d.sync += [s.sent_at.eq(sample.at), s.sent_bytes.eq(sample.bytes)]
        with m.If(sample.bytes > s.engine.whole_bytes):
            m.d.sync += s.job.eq(fragment)
            m.next = "FRAGMENT"


def cutting(m: Module, s: State) -> None:
    """Order the wanted fragments of a sample one after another, then a heartbeat.

    They are sent without a pause, so a sample needs no state of its own in each row. A
    NACK_FRAG is answered in the same way, while its event waits.
    """
    event, row, sample = s.engine.events.payload, s.row, s.sample
    size = fragment_bytes(s.engine.description.link)
    with m.State("NACK_FRAG"):
        fragment = event.last - 1
        m.d.sync += [
            s.fragment.eq(fragment),
            s.wanted.eq(event.bits << 1),
            row.tries.eq(0),
            row.ask.eq(row.reliable),
        ]
        m.next = "STORE_EVENT"
        is_there = s.is_written & ~s.is_gone
        with m.If(is_there & (event.last != 0) & (fragment < s.engine.memory_bytes // size)):
            m.next = "FETCH"
    with m.State("FRAGMENT"):
        start, rest = Signal(s.engine.address_bits + 1), Signal(s.engine.address_bits + 1)
        m.d.comb += [
            start.eq(s.fragment << ceil_log2(size)),
            rest.eq(sample.bytes - start),
        ]
        m.d.sync += [
            s.sent_at.eq(sample.at + start),
            s.sent_bytes.eq(Mux(rest > size, size, rest)),
            s.from_.eq(s.fragment + 1),
            s.to.eq(sample.bytes),
            s.at.eq(row.peer),
        ]
        m.next = "PEER"
        with m.If((start >= sample.bytes) | (s.wanted == 0)):
            m.d.sync += row.ask.eq(row.reliable)
            m.next = "STORE"
            with m.If(s.in_event):
                m.next = "STORE_EVENT"
        with m.Elif(~s.wanted[32]):
            pass_fragment(m, s)
            m.next = "FRAGMENT"


def pass_fragment(m: Module, s: State) -> None:
    """Go on to the fragment behind. The lowest bit is that of all that have none."""
    wanted = s.wanted
    m.d.sync += [
        s.fragment.eq(s.fragment + 1),
        wanted.eq(Cat(wanted[0], wanted[0], wanted[1:32])),
    ]
