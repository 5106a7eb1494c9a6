"""Our readers (8.4.12): what comes of a writer, and what is missing."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal

from firm_hdl.node.rtps.events import EventKind
from firm_hdl.node.rtps.state import FIXED_READERS, MOST_TRIES, State, constant
from firm_hdl.node.rtps.templates import Job

__all__ = ["listening", "listens"]

# Ticks: between requests for what is missing; between greetings of a writer that has said nothing
# yet.
_REPEAT, _GREETING = 2, 5


def listening(m: Module, s: State) -> None:
    """Take what a writer says.

    Samples of topics are taken in order, those of SEDP as they come; `request` has those behind
    `next` that need not come::

        number     | 4 | 5 (next) | 6       | 7       | 8       | 9 (end)
                   | came         | missing | came    | missing |
        request    |   | bit 31: 0| 30: 0   | 29: 1   | 28: 0   |

    When 5 and 6 have come as well, `SETTLE` moves `next` on to 8: bit 31 is always that of `next`.
    """
    event, row, assembly = s.engine.events.payload, s.row, s.engine.assembly
    number, target, ahead = event.number, s.target, s.ahead
    is_sedp, is_gap = s.row_at < s.engine.first_row, event.kind == EventKind.GAP
    shifts = Signal(6)
    with m.State("HEARTBEAT"):
        m.d.sync += [target.eq(number), row.synced.eq(row.synced | row.reliable)]
        m.next = "HEARTBEAT_END"
        with m.If(row.reliable & (ahead > 0)):
            # What the writer no longer has is lost.
            m.d.comb += s.engine.lost.eq(row.synced)
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
        # 8.3.8.4: from `number` to below `last`, and the bits from `last` on. A GAP that begins
        # behind `next` is not kept: it is sent again when these numbers are asked for.
        m.d.sync += target.eq(event.last)
        m.next = "STORE_EVENT"
        with m.If(row.reliable & (ahead <= 0) & (s.last_ahead >= 0)):
            m.next = "ADVANCE"

    with m.State("SAMPLE"):
        is_new, is_fragment = ahead >= 0, event.kind == EventKind.FRAGMENT
        takes, bit, is_busy = Signal(), Signal(32), Signal()
        user = (row.local - FIXED_READERS)[: len(row.local)]
        m.d.comb += [
            bit.eq(Const(1 << 31, 32) >> ahead[:5]),
            takes.eq(Mux(row.reliable, row.synced & (ahead == 0), is_new)),
            is_busy.eq(~is_sedp & ~is_fragment & ~s.engine.idle.bit_select(user, 1)),
        ]
        m.d.comb += assembly.number.eq(number)
        m.d.sync += [s.accepts.eq(takes & ~is_fragment), target.eq(number + 1)]
        m.next = "SAMPLED"
        with m.If(is_sedp):
            m.d.comb += takes.eq(is_new & (ahead < 32) & ((row.request & bit) == 0))
        with m.If(takes & is_busy & (s.patience != 0)):
            # The event is taken again after something else was done.
            m.d.sync += s.patience.eq(s.patience - 1)
            m.next = "IDLE"
        with m.Elif(takes & is_busy & row.reliable):
            m.d.sync += [s.accepts.eq(0), row.ask.eq(row.ask | (row.timer == 0))]
        # Announcements in fragments are not read. They count as come, or they would be asked for
        # again in vain.
        with m.Elif(takes & is_sedp):
            m.d.sync += row.request.eq(row.request | bit)
            m.next = "SETTLE"
        with m.Elif(takes & is_fragment & (assembly.has_room | assembly.holds)):
            m.d.comb += [assembly.accepts.eq(assembly.fits), s.engine.cut.eq(~assembly.fits)]
            with m.If(assembly.fits):
                m.d.sync += [s.accepts.eq(1), row.tries.eq(0)]
            with m.Else():
                m.d.sync += row.ask.eq(row.ask | (row.reliable & (row.timer == 0)))
        with m.Elif(takes):
            m.d.comb += [s.engine.cut.eq(is_fragment), s.engine.lost.eq(row.synced & (ahead != 0))]
            # Of a best-effort writer, the first sample says where its samples begin.
            m.d.sync += row.synced.eq(1)
            m.next = "ADVANCE"
        with m.Elif(is_new & row.synced):
            # Something before it is missing. A request for it may be on its way.
            m.d.sync += row.ask.eq(row.ask | (row.timer == 0))
        with m.Elif(~is_new & ~is_fragment):
            m.d.comb += s.engine.late.eq(1)
        with m.If((takes | (is_new & row.synced)) & s.is_unknown):
            m.d.sync += row.end.eq(number + 1)

    with m.State("ADVANCE"):
        # A sample of a reliable writer is the next one, and best-effort ones have no requests.
        step = Mux(is_gap, s.last_ahead, Mux(event.kind == EventKind.HEARTBEAT, ahead, 1))
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
        m.d.comb += s.rows_memory.writes.eq(1)
        s.begin_scan(m, s.engine.first_row)
        m.next = "DONE"
        with m.If(s.accepts), m.Switch(event.kind):
            with m.Case(EventKind.ENDPOINT):
                m.d.sync += [s.second.eq(1), s.key.eq(s.engine.announced.entity)]
                m.next = "FIND"
            with m.Case(EventKind.ENDPOINT_GONE):
                m.d.sync += [s.second.eq(1), s.key.eq(event.entity)]
                m.next = "FIND"
            with m.Case(EventKind.SAMPLE):
                _deliver(m, s)


def _deliver(m: Module, s: State) -> None:
    """Tell topic and tag of a sample. The tag of a request leads to what its reply names."""
    event, row = s.engine.events.payload, s.row
    if s.engine.serves:
        named = event.has_related & (event.related != 0)
        word = s.identities.write_word
        m.d.comb += [
            s.identities.writes.eq(1),
            s.identities.write_at.eq(s.engine.tag + 1),
            word.tag.eq(s.engine.tag + 1),
            word.peer.eq(s.peer),
            word.guid.eq(Mux(named, event.related, Cat(event.source, event.writer))),
            word.number.eq(event.number),
        ]
    topics = [each.topic.id for each in s.engine.readers if each.topic]
    m.d.sync += [
        s.engine.topic.eq(constant(topics, row.local - FIXED_READERS)),
        s.engine.tag.eq(s.engine.tag + 1),
    ]


def listens(m: Module, s: State) -> None:
    """Answer a writer (8.4.12.2): acknowledge what came, and ask for what is missing."""
    row, assembly = s.row, s.engine.assembly
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
            s.number.eq(row.next),
            s.to.eq(asked),
            s.bits.eq(0),
            s.bitmap.eq(0),
            # Without Final, the writer has to answer with a HEARTBEAT (8.3.8.1), which says where
            # its samples begin.
            s.is_final.eq(row.synced),
        ]
        m.next = "NEXT"
        # Each HEARTBEAT asks for an answer, and each sample that comes again may bring one. So
        # several that were asked for are waited for, or they would make ever more of them.
        waits = lacks & (row.timer != 0) & (missing != 1) & (row.next < row.base)
        is_due = row.ask & ~waits
        with m.If(is_due & lacks & (row.tries == MOST_TRIES)):
            # Such as a sample that is larger than the memory: it will never come.
            m.d.comb += s.engine.lost.eq(1)
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
            s.send(m, Job.ACKNACK)
            with m.If(lacks):
                m.d.sync += s.job.eq(Job.ACKNACK_MISSING)
                m.next = "COUNT"
                with m.If(assembly.holds):
                    m.d.sync += [
                        s.job.eq(Job.NACK_FRAG),
                        s.from_.eq(assembly.held.next),
                        s.to.eq(assembly.held.sample_bytes - assembly.held.place),
                    ]
        with m.Elif(s.tick_pass):
            m.next = "STORE"
            with m.If(row.timer != 0):
                m.d.sync += row.timer.eq(row.timer - 1)
            with m.Else():
                m.d.sync += row.ask.eq(row.ask | (row.reliable & (lacks | ~row.synced)))

    with m.State("COUNT"):
        # `to` samples that are missing; or of the fragments that make up `to` bytes, those
        # that one word can name. A bit per cycle is added on top: no size is divided.
        rest, is_part = s.to, s.job == Job.NACK_FRAG
        step = Mux(is_part, assembly.held.fragment_bytes, 1)
        with m.If((rest == 0) | s.bits[5]):
            m.d.sync += s.bitmap.eq(s.bitmap & Mux(is_part, ~0, ~row.request))
            s.send(m, s.job)
        with m.Else():
            m.d.sync += [
                s.bits.eq(s.bits + 1),
                s.bitmap.eq(Cat(s.bitmap[1:], 1)),
                rest.eq(Mux(rest > step, rest - step, 0)),
            ]
