"""The two protocols of discovery alone: who is believed, and when somebody is told."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

import pytest

from firm_hdl.rtps import Durability, Guid, Qos, sedp
from firm_hdl.rtps.discovery import EndpointData, ParticipantData, key_payload
from firm_hdl.rtps.events import Incompatible, Matched, Unmatched
from firm_hdl.rtps.fragments import Budget
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.sedp import Local, Sedp
from firm_hdl.rtps.spdp import Spdp
from firm_hdl.rtps.wire.guid import PARTICIPANT, SPDP_WRITER
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import Pid
from firm_hdl.rtps.wire.samples import Data
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

    def __init__(self, targets=(GROUP,), period=1.0):
        self.found, self.lost, self.sent = [], [], []
        super().__init__(
            OWN,
            "10.0.0.1",
            targets,
            period,
            self.sent.append,
            lambda peer, now: self.found.append(peer.prefix),
            lambda peer, expired: self.lost.append((peer.prefix, expired)),
        )

    def hear(self, peer, now, source=None):
        self.on_data(source or peer.prefix, said(peer.encode()), now)

    def hear_farewell(self, peer, now, source=None):
        payload = key_payload(Guid(peer.prefix, PARTICIPANT), Pid.PARTICIPANT_GUID)
        self.on_data(source or peer.prefix, said(payload, key=True), now)

    def times(self, begin, end):
        """Let time pass; return when it announced."""
        found, now = [], begin
        while now < end:
            self.sent.clear()
            due = self.tick(now)
            if self.sent:
                found.append(round(now, 6))
            now = due
        return found


def test_nobody_speaks_for_another_participant():
    announcer = Announcer()
    announcer.hear(ONE, 0.0)
    announcer.hear(TWO, 0.0, source=ONE.prefix)
    announcer.hear_farewell(ONE, 0.0, source=TWO.prefix)
    assert announcer.peers == (ONE,) and announcer.found == [ONE.prefix]
    announcer.hear(TWO, 0.0)
    announcer.hear_farewell(ONE, 0.0, source=TWO.prefix)
    assert announcer.peers == (ONE, TWO) and not announcer.lost
    announcer.hear_farewell(ONE, 0.0)
    assert announcer.peers == (TWO,) and announcer.lost == [(ONE.prefix, False)]


def test_an_announcement_again_is_a_sign_of_life_and_no_news():
    announcer = Announcer()
    for now in (0.0, 9.0):
        announcer.hear(ONE, now)
    assert announcer.found == [ONE.prefix]
    announcer.tick(18.9)
    assert announcer.peers == (ONE,)
    announcer.tick(19.0)
    assert announcer.peers == () and announcer.lost == [(ONE.prefix, True)]


def test_announcements_are_quick_at_first_and_when_somebody_is_new():
    announcer = Announcer()
    assert announcer.times(0.0, 4.0) == [0.0, 0.1, 0.2, 0.3, 0.4, 1.4, 2.4, 3.4]
    announcer.hear(ONE, 4.0)
    assert announcer.times(4.0, 8.0) == [4.1, 4.2, 5.2, 6.2, 7.2]
    # One that is due sooner does not wait for it.
    announcer.hear(TWO, 8.1625)
    assert announcer.times(8.1625, 9.0) == [8.2, 8.3]


def test_an_address_is_told_once():
    # The one named target is also a peer's address.
    announcer = Announcer((GROUP, ONE.discovery[0]))
    announcer.hear(ONE, 0.0)
    announcer.hear(TWO, 0.0)
    announcer.sent.clear()
    announcer.leave()
    assert [each.to for each in announcer.sent] == [GROUP, ONE.discovery[0], TWO.discovery[0]]
    (farewell,) = {each.submessages for each in announcer.sent}
    # It comes after the announcement, which has number 1.
    assert farewell[0].key and farewell[0].sequence_number == 2


# Endpoints.

ADDRESSES = (Address("10.0.0.2", 7499),)


def remote(peer, entity, topic="t", **options):
    guid = Guid(peer.prefix, entity)
    return EndpointData(
        guid=guid, topic=topic, type_name="T", qos=options.pop("qos", Qos()), **options
    )


class Matcher(Sedp):
    """The endpoints of `OWN`, and what happened to them."""

    def __init__(self):
        self.events = deque()
        super().__init__(OWN.prefix, "10.0.0.1", lambda each: None, Budget(1 << 20), self.events)
        for peer in (ONE, TWO):
            self.on_peer(peer, 0.0)

    def own(self, entity, topic="t", qos=None):
        qos, data = qos or Qos(), remote(OWN, entity, topic, qos=qos or Qos())
        if entity & 0x3F in (2, 3):
            endpoint = Writer(data.guid, qos, lambda each: None)
        else:
            endpoint = Reader(data.guid, qos, lambda each: None, print, Budget(1 << 20))
        self.add(Local(endpoint, data), 0.0)
        return data.guid

    def hear(self, data, writer, source=None):
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
    matcher.hear(remote(ONE, WRITER), True, source=TWO.prefix)
    assert list(matcher.remotes(True)) == []
    matcher.hear(remote(ONE, WRITER), True)
    assert [each.guid for each in matcher.remotes(True)] == [Guid(ONE.prefix, WRITER)]
    assert list(matcher.remotes(False)) == []
    gone = said(key_payload(Guid(ONE.prefix, WRITER), Pid.ENDPOINT_GUID), key=True)
    matcher._on_announcement(TWO.prefix, gone, True)
    assert len(list(matcher.remotes(True))) == 1
    matcher._on_announcement(ONE.prefix, gone, True)
    assert list(matcher.remotes(True)) == []


def test_each_participant_has_as_many_endpoints_as_it_may(monkeypatch):
    monkeypatch.setattr(sedp, "_MAX_ENDPOINTS", 2)
    matcher = Matcher()
    for peer in (ONE, TWO):
        for number in range(3):
            matcher.hear(remote(peer, number << 8 | 3), True)
    known = [(each.guid.prefix, each.guid.entity >> 8) for each in matcher.remotes(True)]
    assert known == [(ONE.prefix, 0), (ONE.prefix, 1), (TWO.prefix, 0), (TWO.prefix, 1)]


@pytest.mark.parametrize("is_first", [False, True])
@pytest.mark.parametrize(
    ("own", "other", "is_writer", "topic", "fits"),
    [
        (WRITER, READER, False, "t", True),
        (READER, WRITER, True, "t", True),
        (KEYED_READER, KEYED_WRITER, True, "t", True),
        (WRITER, WRITER, True, "t", False),
        (READER, READER, False, "t", False),
        (WRITER, READER, False, "u", False),
        (WRITER, KEYED_READER, False, "t", False),
        (KEYED_READER, WRITER, True, "t", False),
    ],
)
def test_who_fits_whom_whoever_comes_first(own, other, is_writer, topic, fits, is_first):
    matcher = Matcher()
    steps = [lambda: matcher.own(own), lambda: matcher.hear(remote(ONE, other, topic), is_writer)]
    for step in steps if is_first else reversed(steps):
        step()
    assert matcher.news() == ([Matched] if fits else [])


def test_policies_that_do_not_fit_are_told_when_they_change():
    durable = Durability.TRANSIENT_LOCAL
    matcher = Matcher()
    matcher.own(WRITER)
    fits = remote(ONE, READER)
    once = replace(fits, qos=Qos(durability=durable))
    twice = replace(fits, qos=Qos(durability=durable, deadline=5))
    for data, news in (
        (fits, [Matched]),
        (once, [Unmatched, Incompatible]),
        (once, []),
        (twice, [Incompatible]),
        (fits, [Matched]),
        (twice, [Unmatched, Incompatible]),
    ):
        matcher.hear(data, False)
        assert matcher.news() == news


def test_a_participant_that_is_gone_takes_all_with_it():
    matcher = Matcher()
    matcher.own(WRITER)
    matcher.hear(remote(ONE, READER), False)
    matcher.hear(remote(TWO, READER), False)
    builtin = [
        matcher.publications,
        matcher.subscriptions,
        matcher.publications_reader,
        matcher.subscriptions_reader,
    ]
    assert [len(each.matched) for each in builtin] == [2] * 4
    matcher.news()
    matcher.on_peer_lost(ONE.prefix)
    assert [[guid.prefix for guid in each.matched] for each in builtin] == [[TWO.prefix]] * 4
    assert matcher.news() == [Unmatched]
    # Where a late announcement of it would lead is not known any more.
    matcher.hear(remote(ONE, READER), False)
    assert matcher.news() == []
    matcher.on_peer(ONE, 1.0)
    assert matcher.news() == [Matched]
