"""Discovery as a peer sees it: single announcements in, datagrams and events out."""

from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import pytest

from firm_hdl.rtps import Qos, Reliability, core
from firm_hdl.rtps.discovery import EndpointData, ParticipantData, key_payload
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import (
    PARTICIPANT,
    PUBLICATIONS_WRITER,
    SPDP_READER,
    SPDP_WRITER,
    SUBSCRIPTIONS_WRITER,
    Guid,
)
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import Pid
from firm_hdl.rtps.wire.submessages import AckNack, Data, Heartbeat
from tests.rtps.network import GROUP, TOPIC, TYPE, Network

PREFIX, OTHER = b"\x01\x10" + bytes(9) + b"\x09", b"\x01\x10" + bytes(9) + b"\x08"
PEER = ParticipantData(
    prefix=PREFIX,
    discovery=(Address("10.0.0.9", 7410),),
    user=(Address("10.0.0.9", 7411),),
    lease=10.0,
    domain=0,
)
READER = EndpointData(guid=Guid(PREFIX, 0x104), topic=TOPIC, type_name=TYPE, qos=Qos())
WRITER = replace(READER, guid=Guid(PREFIX, 0x203))


@pytest.fixture
def station():
    return Network().station()


def tell(station, now, *submessages, prefix=PREFIX):
    station.core.receive(message.write(prefix, submessages), now)


def announce(station, now, peer=PEER):
    payload = peer.encode()
    data = Data(reader=SPDP_READER, writer=SPDP_WRITER, sequence_number=1, payload=payload)
    tell(station, now, data, prefix=peer.prefix)


def announcement(endpoint, number, entity):
    """What a writer of SEDP says of an endpoint, and how its sequence begins."""
    begin = Heartbeat(reader=0, writer=entity, first=1, last=0, count=1, final=True)
    payload = endpoint.encode()
    return begin, Data(reader=0, writer=entity, sequence_number=number, payload=payload)


def farewell(guid, pid, number, entity):
    payload = key_payload(guid, pid)
    return Data(reader=0, writer=entity, sequence_number=number, payload=payload, key=True)


def posted(station):
    """Take what is to be sent: addresses, and submessages."""
    found = []
    while station.core.outbox:
        address, datagram = station.core.pop()
        content = message.read(datagram, PREFIX)
        found += [(address, each.submessage) for each in content.received]
    return found


def happened(station):
    names = [type(each).__name__ for each in station.core.events]
    station.core.events.clear()
    return names


def test_a_peer_that_moves_is_reached_at_its_new_address(station):
    writer = station.writer()
    announce(station, 0.0)
    tell(station, 0.0, *announcement(READER, 1, SUBSCRIPTIONS_WRITER))
    for host in ("10.0.0.9", "10.0.0.7"):
        announce(station, 0.0, replace(PEER, user=(Address(host, 7411),)))
        posted(station)
        station.write(writer, b"abcd")
        assert {to for to, each in posted(station) if isinstance(each, Data)} == {(host, 7411)}
    # An endpoint's own address counts more than that of its participant.
    own = replace(READER, addresses=(Address("10.0.0.6", 9000),))
    tell(station, 0.0, announcement(own, 2, SUBSCRIPTIONS_WRITER)[1])
    posted(station)
    station.write(writer, b"abcd")
    assert {to for to, each in posted(station)} == {("10.0.0.6", 9000)}


def test_only_built_in_endpoints_that_a_peer_has_are_talked_to():
    """9.3.2: bits 2 and 3 are writer and reader of publications, 4 and 5 of subscriptions."""
    for bit, talk in (
        (2, (AckNack, PUBLICATIONS_WRITER)),
        (3, (Heartbeat, PUBLICATIONS_WRITER)),
        (4, (AckNack, SUBSCRIPTIONS_WRITER)),
        (5, (Heartbeat, SUBSCRIPTIONS_WRITER)),
    ):
        station = Network().station()
        announce(station, 0.0, replace(PEER, endpoints=1 << bit))
        station.core.tick(0.0)
        sent = [each for _, each in posted(station) if not isinstance(each, Data)]
        assert {(type(each), each.writer) for each in sent} == {talk}


def test_a_flood_of_announcements_makes_no_flood_of_answers(station):
    counts = []
    for now, name in ((0.0, "a"), (0.2, "b"), (0.4, "c"), (0.5, "d")):
        announce(station, now, replace(PEER, name=name))
        counts.append(
            sum(
                to == PEER.discovery[0]
                for to, each in posted(station)
                if isinstance(each, Data) and each.writer == SPDP_WRITER
            )
        )
    assert counts == [1, 0, 0, 1]
    assert [each.name for each in station.core.peers] == ["d"]


def test_only_a_peer_that_left_is_not_found_again_at_once(station):
    leaves = farewell(Guid(PREFIX, PARTICIPANT), Pid.PARTICIPANT_GUID, 2, SPDP_WRITER)
    tell(station, 0.0, leaves)
    announce(station, 0.1)
    assert happened(station) == ["PeerFound"]
    # Nobody speaks for others.
    tell(station, 0.2, leaves, prefix=OTHER)
    assert happened(station) == []
    tell(station, 0.3, leaves)
    assert happened(station) == ["PeerLost"]
    station.core.tick(1.2)
    announce(station, 1.2)
    assert happened(station) == []
    station.core.tick(1.3)
    announce(station, 1.3)
    assert happened(station) == ["PeerFound"]


def test_endpoints_are_ended_by_their_own_participant_alone(station):
    station.reader()
    for prefix in (PREFIX, OTHER):
        announce(station, 0.0, replace(PEER, prefix=prefix))
    tell(station, 0.0, *announcement(WRITER, 1, PUBLICATIONS_WRITER))
    theirs = replace(WRITER, guid=Guid(OTHER, 0x203))
    tell(station, 0.0, *announcement(theirs, 1, PUBLICATIONS_WRITER), prefix=OTHER)
    happened(station)
    ends = farewell(WRITER.guid, Pid.ENDPOINT_GUID, 2, PUBLICATIONS_WRITER)
    tell(station, 0.0, ends, prefix=OTHER)
    assert happened(station) == []
    tell(station, 0.0, ends)
    assert happened(station) == ["Unmatched"]
    assert [each.guid for each in station.core.remotes(writers=True)] == [theirs.guid]


def test_what_is_for_all_readers_reaches_each_that_is_matched(station):
    """8.3.8.2: reader 0 means all of them."""
    readers = [station.reader() for _ in range(3)]
    other = station.reader(topic="rt/other")
    announce(station, 0.0)
    tell(station, 0.0, *announcement(WRITER, 1, PUBLICATIONS_WRITER))
    happened(station)
    begin = Heartbeat(reader=0, writer=0x203, first=1, last=0, count=1, final=True)
    sample = Data(reader=0, writer=0x203, sequence_number=1, payload=b"abcd")
    tell(station, 0.0, begin, sample)
    arrived = [event.reader for event in station.core.events]
    assert sorted(map(bytes, arrived)) == sorted(bytes(each.guid) for each in readers)
    # One that is named is the only one.
    station.core.events.clear()
    for number, each in enumerate((readers[1], other), 2):
        tell(station, 0.0, replace(sample, reader=each.guid.entity, sequence_number=number))
    assert [event.reader for event in station.core.events] == [readers[1].guid]


def test_policies_that_change(station):
    station.reader()
    announce(station, 0.0)
    bad = replace(WRITER, qos=Qos(reliability=Reliability.BEST_EFFORT))
    worse = replace(bad, qos=replace(bad.qos, deadline=9.0))
    ends = farewell(WRITER.guid, Pid.ENDPOINT_GUID, 5, PUBLICATIONS_WRITER)
    happened(station)
    for number, (endpoint, events) in enumerate(
        (
            (WRITER, ["Matched"]),
            (bad, ["Unmatched", "Incompatible"]),
            # Said once.
            (worse, []),
            (WRITER, ["Matched"]),
        ),
        1,
    ):
        tell(station, 0.0, *announcement(endpoint, number, PUBLICATIONS_WRITER))
        assert happened(station) == events
    tell(station, 0.0, ends)
    assert happened(station) == ["Unmatched"]
    # An endpoint that comes again is a new one.
    for number in (6, 8):
        tell(station, 0.0, *announcement(bad, number, PUBLICATIONS_WRITER))
        assert happened(station) == ["Incompatible"]
        tell(station, 0.0, replace(ends, sequence_number=number + 1))


def test_bad_discovery_data_does_not_concern_what_follows(station):
    bad = Data(reader=0, writer=SPDP_WRITER, sequence_number=1, payload=b"\0\1\0\0")
    good = replace(bad, payload=PEER.encode())
    tell(station, 0.0, bad, good)
    assert happened(station) == ["PeerFound"]
    assert station.core.counters["malformed"] == 1


def test_datagrams_that_wait_take_limited_memory(station, monkeypatch):
    station.core.tick(0.0)
    ((_, datagram),) = station.core.outbox
    station.core.pop()
    monkeypatch.setattr(core, "_MAX_OUTBOX_BYTES", 4 * len(datagram))
    for now in (1.0, 2.0, 3.0):
        station.core.tick(now)
    # The other half is left for other addresses.
    assert (len(station.core.outbox), station.core.counters["dropped"]) == (2, 1)
    announce(station, 3.5)
    assert {to for to, _ in station.core.outbox} == {GROUP, PEER.discovery[0]}
    # What was sent waits no longer.
    posted(station)
    dropped = station.core.counters["dropped"]
    station.core.tick(4.0)
    assert station.core.outbox and station.core.counters["dropped"] == dropped


def test_an_endpoint_can_be_removed_twice():
    network = Network()
    one, two = network.station(), network.station()
    writer, reader = one.writer(), two.reader()
    assert network.run(5, lambda: len(writer.matched) == 1)
    for _ in range(2):
        one.core.remove(writer.guid, network.now)
        two.core.remove(reader.guid, network.now)
    assert network.run(5, lambda: not list(two.core.remotes(writers=True)))
    assert writer.matched == reader.matched == ()


def test_an_endpoint_that_is_removed_takes_no_memory():
    network = Network()
    one, two = network.station(), network.station()

    def use():
        writer, reader = one.writer(Qos(depth=0)), two.reader()
        assert network.run(5, lambda: len(writer.matched) == 1)
        one.write(writer, bytes(100))
        one.core.remove(writer.guid, network.now)
        two.core.remove(reader.guid, network.now)
        return weakref.ref(writer), weakref.ref(reader)

    kept = use()
    assert network.run(5, lambda: not list(two.core.remotes(writers=True)))
    gc.collect()
    assert [each() for each in kept] == [None, None]
