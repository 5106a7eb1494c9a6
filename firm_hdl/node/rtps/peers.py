"""The table of peers: whom a participant knows, and to whom it announces itself."""

from __future__ import annotations

from ipaddress import IPv4Address

from amaranth.hdl import Cat, Module, Mux, Value

from firm_hdl.node.rtps.events import raw
from firm_hdl.node.rtps.state import STATIC_PARTICIPANTS, State, constant, lowest
from firm_hdl.node.rtps.tables import BUILTIN_ROWS
from firm_hdl.node.rtps.templates import Job
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SUBSCRIPTIONS_READER,
    SUBSCRIPTIONS_WRITER,
)
from firm_hdl.rtps.wire.locators import MULTICAST_GROUP, Ports

__all__ = ["announcements", "participants", "start"]

# Seconds after which a peer without matched endpoints may give way to another one.
_GRACE = 3
# Seconds to wait for a datagram, whose time of arrival makes the GUID prefix new.
_PATIENCE = 4


def start(m: Module, s: State) -> None:
    """Wait from the reset to the first datagram."""
    cycles = s.cycles
    with m.State("INIT"):
        # Memories keep their content in a reset. That of the peers counts only where `live` says
        # so, but a row is valid by a bit of its own.
        m.d.comb += [
            s.rows_memory.writes.eq(1),
            s.rows_memory.write_at.eq(s.at),
        ]
        m.d.sync += s.at.eq(s.at + 1)
        with m.If(s.at == s.engine.rows - 1):
            m.next = "NONCE"
    with m.State("NONCE"):
        most = min(round(_PATIENCE * s.engine.description.clock_hz), (1 << 32) - 256)
        is_late = cycles[8:] >= most >> 8
        with m.If((s.engine.nonce != 0) | s.engine.came | is_late):
            m.d.sync += [
                s.nonce.eq(Mux(s.engine.nonce != 0, s.engine.nonce, cycles)),
                s.multicast_due.eq(1),
                s.static.eq(s.most_static),
            ]
            m.next = "IDLE"


def announcements(m: Module, s: State) -> None:
    """Announce this participant (8.5.3.3.1), and do what else is due once per second."""
    with m.State("SECOND"):
        # The leases of all peers, one per cycle; `IDLE` has set `at` to 0. Those of free places
        # wrap around, and are written before they count again.
        left, write = s.leases.reader(), s.leases.write
        peer = s.at[: len(s.peer)]
        m.d.comb += [
            left.addr.eq(peer),
            write.addr.eq(peer),
            write.data.eq(left.data - 1),
            write.en.eq(1),
        ]
        m.d.sync += s.at.eq(s.at + 1)
        with m.If(s.at == s.engine.peers - 1):
            m.d.sync += [
                s.second_due.eq(0),
                s.multicast_due.eq(1),
                s.static.eq(s.most_static),
                s.due.eq(s.live),
                s.has_room.eq(0),
                *(young.eq(Mux(young == 0, 0, young - 1)) for young in s.young),
            ]
            with m.If(s.has_room):
                m.d.sync += [s.again.eq(s.again | s.refused), s.refused.eq(0)]
            m.next = "IDLE"
        with m.If(s.live.bit_select(peer, 1) & (left.data == 0)):
            s.kill(m, peer)
    domain = s.engine.description.link.domain
    ports = [Ports.of(domain, each).discovery for each in range(STATIC_PARTICIPANTS)]
    with m.State("ANNOUNCE"):
        m.d.sync += [s.job.eq(Job.ANNOUNCE), s.stores.eq(0)]
        m.next = "JOB"
        with m.If(s.multicast_due):
            m.d.sync += [
                s.multicast_due.eq(0),
                s.address.eq(int(IPv4Address(MULTICAST_GROUP))),
                s.port.eq(Ports.of(domain, 0).discovery_multicast),
            ]
        with m.Elif(s.static != 0):
            place = s.static - 1
            m.d.sync += [
                s.static.eq(place),
                s.address.eq(constant(s.statics, place[2:])),
                s.port.eq(constant(ports, place[:2])),
            ]
        with m.Else():
            which = lowest(s.due)
            m.d.sync += [s.due.bit_select(which, 1).eq(0), s.at.eq(which)]
            m.next = "PEER"


def participants(m: Module, s: State) -> None:
    """Take announcements of participants (8.5.3.3.2)."""
    event, announced = s.engine.events.payload, s.engine.announced
    peer, peer_row = s.peer, s.peer_row
    with m.State("FIND_PEER"):
        is_same = s.live.bit_select(peer, 1) & (peer_row.prefix == event.source)
        s.scan(m, s.peers_memory)
        with m.If(s.has_row & (is_same | (peer == s.engine.peers - 1))):
            m.d.sync += s.known.eq(is_same)
            m.next = "DONE"
            with m.If(is_same):
                m.d.comb += s.leases.write.en.eq(1)
                # A row that it lacked is free: its endpoints are asked for from the first one on.
                with m.If(s.again.bit_select(peer, 1)):
                    m.d.sync += [s.again.bit_select(peer, 1).eq(0), s.at.eq(0)]
                    m.next = "BUILTIN"
        with m.Else():
            m.d.sync += [
                Value.cast(peer_row).eq(s.peers_memory.word),
                peer.eq(s.at_word),
            ]

    # `known` and `peer` are what `FIND_PEER` has found for the datagram of the announcement.
    with m.State("PLACE"):
        is_free = Cat(~s.live[n] & (s.dying[n] == 0) for n in range(s.engine.peers))
        known = s.matched & s.answers
        strangers = s.live & ~known & Cat(each == 0 for each in s.young)
        m.next = "PLACED"
        with m.If(~announced.is_participant):
            m.next = "DONE"
        with m.Elif(~s.known & is_free.any()):
            m.d.sync += peer.eq(lowest(is_free))
        with m.Elif(~s.known):
            m.d.comb += s.engine.unsent.eq(1)
            with m.If(strangers.any()):
                # Its place is free when the newcomer announces itself again.
                s.kill(m, lowest(strangers))
            m.next = "DONE"

    with m.State("PLACED"):
        word, user = s.peers_memory.write_word, announced.user
        m.d.comb += [
            s.peers_memory.writes.eq(1),
            word.prefix.eq(event.source),
            word.discovery.eq(announced.discovery),
            word.user.eq(Mux(user.port == 0, announced.discovery.as_value(), user.as_value())),
            word.lease.eq(announced.lease),
        ]
        m.d.comb += [
            s.leases.write.en.eq(1),
            s.leases.write.data.eq(announced.lease),
        ]
        m.next = "DONE"
        with m.If(~s.known):
            m.d.sync += [
                s.known.eq(1),
                s.live.bit_select(peer, 1).eq(1),
                s.due.bit_select(peer, 1).eq(1),
                s.young[peer].eq(_GRACE),
            ]
            m.next = "BUILTIN"

    with m.State("BUILTIN"):
        # 8.5.5.1: the endpoints of SEDP are matched with those of each participant. `at` is 0.
        #
        #   row of the peer | 0             | 1              | 2             | 3
        #   its endpoint    | pubs writer   | subs writer    | pubs reader   | subs reader
        #   ours            | pubs reader 0 | subs reader 1  | pubs writer 0 | subs writer 1
        writers = [PUBLICATIONS_WRITER, SUBSCRIPTIONS_WRITER]
        readers = [PUBLICATIONS_READER, SUBSCRIPTIONS_READER]
        place, word = s.at[:2], s.rows_memory.write_word
        m.d.comb += [
            s.rows_memory.writes.eq(1),
            s.rows_memory.write_at.eq(Cat(place, peer)),
            Value.cast(word).eq(0),
            word.valid.eq(1),
            word.writes.eq(place[1]),
            word.local.eq(place[0]),
            word.peer.eq(peer),
            word.remote.eq(constant([raw(each) for each in (*writers, *readers)], place)),
            word.reliable.eq(1),
            word.next.eq(1),
            word.end.eq(1),
            word.first.eq(1),
            word.ask.eq(1),
        ]
        m.d.sync += s.at.eq(s.at + 1)
        with m.If(place == BUILTIN_ROWS - 1):
            m.next = "DONE"
