"""The two protocols of discovery alone: who is believed, and when somebody is told."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

import pytest

from firm_hdl.rtps import Guid, Qos, sedp
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.discovery import EndpointData, ParticipantData, key_payload
from firm_hdl.rtps.events import PeerLost, Unmatched
from firm_hdl.rtps.peers import Peer
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.sedp import Local, Sedp
from firm_hdl.rtps.spdp import Settings, Spdp
from firm_hdl.rtps.wire.guid import PARTICIPANT, SPDP_WRITER
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.octets import MalformedError
from firm_hdl.rtps.wire.parameters import Pid
from firm_hdl.rtps.wire.submessages import Data
from firm_hdl.rtps.writer import Writer

GROUP = Address("239.255.0.1", 7400)


def participant(number):
    return ParticipantData(
        prefix=bytes(11) + bytes([number]),
        discovery=(Address(f"10.0.0.{number}", 7410),),
        user=(Address(f"10.0.0.{number}", 7411),),
        lease=10.0,
        domain=0,
    )


OWN, ONE, TWO = (participant(number) for number in (1, 2, 3))


def said(payload, key=False):
    return Data(reader=0, writer=SPDP_WRITER, sequence_number=1, payload=payload, key=key)


class Announcer(Spdp):
    """The announcer of `OWN`, with the participants that it found and lost, and what it sent."""

    def __init__(self, targets=(GROUP,), seldom=()):
        self.found, self.lost, self.sent, self.ranks = [], [], [], {}
        settings = Settings(own=OWN, host="10.0.0.1", targets=targets, seldom=seldom)
        super().__init__(settings, self, lambda *sent: self.sent.append(sent))

    def on_peer(self, peer, now):
        self.found.append(peer.data.prefix)

    def on_peer_lost(self, prefix, expired):
        self.lost.append((prefix, expired))

    def rank(self, prefix):
        return self.ranks.get(prefix, 0)

    def listen(self, peer, now, source=None, host=None):
        """Take an announcement."""
        source, data = source or peer.prefix, said(peer.encode())
        self.hear(source, host, 200, now)
        self.on_data(source, data, host, now)

    def listen_farewell(self, peer, now, source=None):
        payload = key_payload(Guid(peer.prefix, PARTICIPANT), Pid.PARTICIPANT_GUID)
        self.on_data(source or peer.prefix, said(payload, key=True), None, now)

    def times(self, begin, end, to=GROUP):
        """Let time pass; return when it announced to an address."""
        found, now = [], begin
        while now < end:
            self.sent.clear()
            due = self.tick(now)
            if to in [address for address, _ in self.sent]:
                found.append(round(now, 6))
            now = due
        return found


def test_nobody_speaks_for_another_participant():
    announcer = Announcer()
    announcer.listen(ONE, 0.0)
    for tell in (announcer.listen, announcer.listen_farewell):
        with pytest.raises(MalformedError, match=r"^an announcement of 0{23}3 by 0{23}2$"):
            tell(TWO, 0.0, source=ONE.prefix)
    assert announcer.peers == (ONE,) and announcer.found == [ONE.prefix]
    announcer.listen(TWO, 0.0)
    with pytest.raises(MalformedError):
        announcer.listen_farewell(ONE, 0.0, source=TWO.prefix)
    assert announcer.peers == (ONE, TWO) and not announcer.lost
    announcer.listen_farewell(ONE, 0.0)
    assert announcer.peers == (TWO,) and announcer.lost == [(ONE.prefix, False)]


def test_an_announcement_again_is_a_sign_of_life_and_no_news():
    announcer = Announcer()
    for now in (0.0, 9.0):
        announcer.listen(ONE, now)
    assert announcer.found == [ONE.prefix]
    announcer.tick(18.9)
    assert announcer.peers == (ONE,)
    announcer.tick(19.0)
    assert announcer.peers == () and announcer.lost == [(ONE.prefix, True)]


def test_announcements_are_quick_at_first_and_a_new_peer_is_told_twice():
    announcer = Announcer()
    assert announcer.times(0.0, 4.0) == [0.0, 0.1, 0.2, 0.3, 0.4, 1.4, 2.4, 3.4]
    announcer.sent.clear()
    announcer.listen(ONE, 4.0)
    assert [address for address, _ in announcer.sent] == [ONE.discovery[0]]
    assert announcer.times(4.0, 7.0, ONE.discovery[0]) == [4.1]
    # Peers that are matched with us are told each time: they may be in no group.
    announcer.ranks[ONE.prefix] = 2
    assert announcer.times(7.0, 10.0, ONE.discovery[0]) == [7.4, 8.4, 9.4]
    # Those that are not are told when they announce themselves, but not in a flood.
    announcer.ranks[ONE.prefix] = 1
    for now, count in ((10.0, 1), (10.4, 0), (10.5, 1), (10.9, 0)):
        announcer.sent.clear()
        announcer.listen(ONE, now)
        assert len(announcer.sent) == count


def test_an_address_where_a_peer_may_be_is_told_at_first_and_then_seldom():
    many = tuple(Address("10.0.0.2", port) for port in range(7420, 7520))
    announcer = Announcer(seldom=many)
    announcer.tick(0.0)
    assert [address for address, _ in announcer.sent] == [GROUP, *many]
    assert announcer.times(0.1, 41.0, many[7]) == [3.4, 13.4, 23.4, 33.4]
    announcer.sent.clear()
    announcer.tick(42.0)
    assert len(announcer.sent) == 1 + len(many) // 10


def strangers(count, host=9):
    """Return participants that announce themselves, and nothing else."""
    return [
        replace(participant(host), prefix=bytes([host]) + number.to_bytes(11, "big"))
        for number in range(count)
    ]


def test_strangers_give_way_to_those_who_come_later():
    announcer = Announcer()
    announcer.listen(ONE, 0.0)
    announcer.listen(TWO, 0.0)
    announcer.ranks = {ONE.prefix: 2, TWO.prefix: 1}
    flood = strangers(1000)
    for number, each in enumerate(flood):
        announcer.listen(each, 0.001 * number)
    assert len(announcer.peers) == 256 and {ONE, TWO} <= set(announcer.peers)
    assert announcer._counters == {"displaced": 1000 - 254}
    # The first 32 were met at once. Of the others, who said nothing more, the last ones are left.
    assert announcer.peers[2:] == (*flood[:32], *flood[-222:])
    assert announcer.found == [each.prefix for each in (ONE, TWO, *flood[:32])]
    # Whoever says something more is met then, and stays for longer than they do.
    announcer.hear(flood[-222].prefix, None, 100, 1.0)
    assert announcer.found[-1] == flood[-222].prefix
    for each in strangers(300, host=8):
        announcer.listen(each, 1.0)
    assert announcer.peers[34] == flood[-222] and len(announcer.peers) == 256
    # One that is matched stays as long as it says something.
    announcer.ranks |= {each.prefix: 2 for each in flood}
    announcer.ranks |= {each.prefix: 2 for each in announcer.peers if each != TWO}
    late = participant(200)
    for peer in announcer.peers:
        announcer.hear(peer.prefix, None, 100, 1.0)
    announcer.listen(late, 1.0)
    assert late in announcer.peers and TWO not in announcer.peers
    announcer.ranks[late.prefix] = 2
    announcer.hear(late.prefix, None, 100, 1.0)
    other = participant(201)
    announcer.listen(other, 9.0)
    assert other not in announcer.peers and announcer._counters["no_place"] == 1
    announcer.hear(ONE.prefix, None, 100, 9.0)
    announcer.listen(other, 11.5)
    assert other in announcer.peers and ONE in announcer.peers


def test_a_host_does_not_take_the_places_of_others():
    announcer = Announcer()
    flood = strangers(1000)
    announcer.ranks = {each.prefix: 2 for each in flood}
    for each in flood:
        announcer.listen(each, 0.0, host="10.0.0.9")
    assert len(announcer.peers) == 120 and announcer._counters["no_place"] == 880
    announcer.listen(ONE, 0.0, host="10.0.0.2")
    assert ONE in announcer.peers


def test_nobody_is_remembered_for_ever_for_having_left():
    announcer = Announcer()
    for each in strangers(1000):
        announcer.listen(each, 0.0)
        announcer.listen_farewell(each, 0.0)
    assert len(announcer._left) <= 256 and announcer.peers == ()


# Endpoints.


def remote(peer, entity, topic="t", **options):
    guid = Guid(peer.prefix, entity)
    return EndpointData(
        guid=guid, topic=topic, type_name="T", qos=options.pop("qos", Qos()), **options
    )


class Matcher(Sedp):
    """The endpoints of `OWN`, and what happened to them."""

    def __init__(self):
        self.events = deque()
        super().__init__(OWN.prefix, lambda each: None, Budget(1 << 20), self.events)
        self.peers = {each.prefix: Peer(each, "10.0.0.1", None) for each in (ONE, TWO)}
        for peer in self.peers.values():
            self.on_peer(peer, 0.0)
        self.news()

    def own(self, entity, topic="t", qos=None):
        qos, data = qos or Qos(), remote(OWN, entity, topic, qos=qos or Qos())
        if entity & 0x3F in (2, 3):
            endpoint = Writer(data.guid, qos, lambda each: None)
        else:
            endpoint = Reader(data.guid, qos, lambda each: None, print, Budget(1 << 20))
        self.add(Local(endpoint, data), 0.0)
        return data.guid

    def listen(self, data, writer, source=None):
        source = source or data.guid.prefix
        self._on_announcement(source, said(data.encode()), writer)

    def news(self):
        found = [type(each) for each in self.events]
        self.events.clear()
        return found


# Entities: a writer and a reader without a key, and both with one (9.3.1.2 of the standard).
WRITER, READER, KEYED_WRITER, KEYED_READER = 0x103, 0x204, 0x302, 0x407


def test_nobody_announces_endpoints_of_another_participant():
    matcher = Matcher()
    with pytest.raises(MalformedError, match=r"^an announcement of 0{23}2 by 0{23}3$"):
        matcher.listen(remote(ONE, WRITER), True, source=TWO.prefix)
    assert list(matcher.remotes(True)) == []
    matcher.listen(remote(ONE, WRITER), True)
    assert [each.guid for each in matcher.remotes(True)] == [Guid(ONE.prefix, WRITER)]
    assert list(matcher.remotes(False)) == []
    gone = said(key_payload(Guid(ONE.prefix, WRITER), Pid.ENDPOINT_GUID), key=True)
    with pytest.raises(MalformedError):
        matcher._on_announcement(TWO.prefix, gone, True)
    assert len(list(matcher.remotes(True))) == 1
    matcher._on_announcement(ONE.prefix, gone, True)
    assert list(matcher.remotes(True)) == []


def test_each_participant_has_as_many_endpoints_as_it_may(monkeypatch):
    monkeypatch.setattr(sedp, "_MAX_ENDPOINTS", 2)
    matcher = Matcher()
    for peer in (ONE, TWO):
        for number in range(3):
            matcher.listen(remote(peer, number << 8 | 3), True)
    known = [(each.guid.prefix, each.guid.entity >> 8) for each in matcher.remotes(True)]
    assert known == [(ONE.prefix, 0), (ONE.prefix, 1), (TWO.prefix, 0), (TWO.prefix, 1)]


def test_a_participant_that_is_gone_takes_all_with_it():
    matcher = Matcher()
    matcher.own(WRITER)
    matcher.listen(remote(ONE, READER), False)
    matcher.listen(remote(TWO, READER), False)
    builtin = [
        matcher.publications,
        matcher.subscriptions,
        matcher.publications_reader,
        matcher.subscriptions_reader,
    ]
    assert [len(each.matched) for each in builtin] == [2] * 4
    matcher.news()
    matcher.on_peer_lost(ONE.prefix, expired=True)
    assert [[guid.prefix for guid in each.matched] for each in builtin] == [[TWO.prefix]] * 4
    assert matcher.news() == [Unmatched, PeerLost]
    # A late announcement of it is none.
    matcher.listen(remote(ONE, READER), False)
    assert matcher.news() == [] and len(list(matcher.remotes(False))) == 1
