"""Attacks: what they cost in memory and datagrams, and honest peers that are served meanwhile.

Attackers send what a small program can: announcements under any name, endpoints that match, and
submessages of any content. Bytes are counted on both sides.
"""

from __future__ import annotations

import time
import tracemalloc
from collections import Counter
from contextlib import suppress
from dataclasses import replace

import pytest

from firm_hdl.rtps import Durability, Guid, HistoryFullError, Qos, Reliability
from firm_hdl.rtps.discovery import EndpointData, ParticipantData, key_payload
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SPDP_READER,
    SPDP_WRITER,
    SUBSCRIPTIONS_WRITER,
)
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import Pid
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    NackFrag,
    NumberSet,
)
from tests.rtps.network import TOPIC, TYPE, Network

KEEP_ALL = Qos(depth=0)
DURABLE = Qos(durability=Durability.TRANSIENT_LOCAL, depth=20)
MEGABYTE = 1 << 20


EVIL = "10.0.0.66"


class Attacker:
    """Whoever sends datagrams to a station, under a GUID prefix.

    Parameters
    ----------
    number : int
        For a prefix of its own.
    named : str
        The host that it names as its own.
    host : str
        Where its datagrams come from.
    """

    def __init__(self, station, number, named=EVIL, host=EVIL):
        self.station, self.host = station, host
        self.prefix = b"\x01\xee" + bytes(6) + number.to_bytes(4, "big")
        self.data = ParticipantData(
            prefix=self.prefix,
            discovery=(Address(named, 7410),),
            user=(Address(named, 7411),),
            lease=1e9,
            domain=0,
        )
        self.sent = self.count = 0
        self._numbers = Counter()

    def send(self, *submessages):
        datagram = message.write(self.prefix, submessages)
        self.sent += len(datagram)
        self.station.core.receive(datagram, self.station.network.now, self.host)

    def announce(self):
        payload = self.data.encode()
        self.send(Data(reader=SPDP_READER, writer=SPDP_WRITER, sequence_number=1, payload=payload))

    def endpoint(self, entity, topic=TOPIC, type_name=TYPE, qos=KEEP_ALL, **data):
        """Announce a writer (entities ``0x..03``) or a reader (``0x..04``)."""
        guid = Guid(self.prefix, entity)
        made = EndpointData(guid=guid, topic=topic, type_name=type_name, qos=qos, **data)
        self._say_of(entity, payload=made.encode())

    def end(self, entity):
        """Say that an endpoint is gone."""
        key = key_payload(Guid(self.prefix, entity), Pid.ENDPOINT_GUID)
        self._say_of(entity, payload=key, key=True)

    def _say_of(self, entity, **data):
        writer = PUBLICATIONS_WRITER if entity & 0x3F == 3 else SUBSCRIPTIONS_WRITER
        if not self._numbers[writer]:
            self.send(Heartbeat(reader=0, writer=writer, first=1, last=0, count=1, final=True))
        self._numbers[writer] += 1
        self.send(Data(reader=0, writer=writer, sequence_number=self._numbers[writer], **data))


@pytest.fixture
def memory():
    """Return a function that says how many bytes were in use at most, and measures no more."""
    tracemalloc.start()
    begin = tracemalloc.get_traced_memory()[0]

    def most():
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak - begin

    yield most
    tracemalloc.stop()


def pair(qos=KEEP_ALL, **options):
    """Return a network, two stations that are matched, and the writer of the first."""
    network = Network()
    one, two = network.station(), network.station(**options)
    writer = one.writer(qos)
    two.reader(KEEP_ALL)
    assert network.run(5, lambda: bool(one.named("Matched") and two.named("Matched")))
    network.run(0.5)
    return network, one, two, writer


def serves(network, one, two, writer, payloads=(b"good",)):
    """Return whether samples of one station reach the other."""
    before = len(two.payloads)
    for each in payloads:
        one.write(writer, each)
        network.run(0.01)
    return network.run(20, lambda: two.payloads[before:] == list(payloads))


# Discovery.


def test_strangers_do_not_close_a_participant_to_new_peers(memory):
    network, one, two, writer = pair()
    attackers = [Attacker(one, number) for number in range(500)]
    for number, each in enumerate(attackers):
        each.announce()
        if number == 250:
            late = network.station()
            late.reader(KEEP_ALL)
            network.run(0.02)
    assert memory() < 16 * MEGABYTE
    assert network.run(5, lambda: len(writer.matched) == 2)
    payloads = [bytes([number]) * 4 for number in range(20)]
    assert serves(network, one, two, writer, payloads) and late.payloads == payloads
    assert len(one.core.peers) <= 256 and one.core.counters["displaced"] > 200
    # To the address that all of them name.
    assert network.bytes_to[EVIL] < 4 * sum(each.sent for each in attackers)
    # They are gone soon, whatever lease they name.
    one.core.tick(network.now + 31)
    assert not {each.prefix for each in attackers} & {each.prefix for each in one.core.peers}


@pytest.mark.thorough
def test_strangers_with_endpoints_give_way_to_those_that_are_matched(memory):
    network, one, two, writer = pair()
    for number in range(280):
        attacker = Attacker(one, number, host=f"10.1.0.{number % 250}")
        attacker.announce()
        attacker.endpoint(0x104, topic="rt/other")
    assert memory() < 16 * MEGABYTE
    late = network.station()
    late.reader(KEEP_ALL)
    assert network.run(5, lambda: len(writer.matched) == 2)
    prefixes = {each.prefix for each in one.core.peers}
    assert len(prefixes) == 256 and {two.core.prefix, late.core.prefix} <= prefixes


def test_announcements_of_endpoints_take_limited_memory(memory, monkeypatch):
    monkeypatch.setattr("firm_hdl.rtps.sedp._SPACE_BYTES", MEGABYTE)
    network, one, two, writer = pair()
    attackers = [Attacker(one, number) for number in range(4)]
    for attacker in attackers:
        attacker.announce()
        for entity in range(150):
            attacker.endpoint(entity << 8 | 4, f"rt/{entity:0200}", user_data=bytes(4000))
    # 600 announcements of 4.5 kB each. All have the same share.
    assert memory() < 2.5 * MEGABYTE
    kept = Counter(each.guid.prefix for each in one.core.remotes(writers=False))
    shares = [kept[attacker.prefix] for attacker in attackers]
    assert max(shares) - min(shares) <= 1 and sum(shares) < MEGABYTE / 5000
    assert one.core.counters["not_kept"] == 600 - sum(shares) and kept[two.core.prefix] == 1
    # A new peer gets its share, too.
    late = network.station()
    late.reader(KEEP_ALL, topic="rt/late")
    other = one.writer(KEEP_ALL, topic="rt/late")
    assert network.run(5, lambda: bool(other.matched))
    assert serves(network, one, late, other) and serves(network, one, two, writer)


def test_announcements_cost_the_same_however_many_there_are():
    one = Network().station()
    times = []
    for number in range(4):
        attacker = Attacker(one, number)
        attacker.announce()
        begin = time.process_time()
        for entity in range(800):
            attacker.endpoint(entity << 8 | 4, f"rt/{entity}")
        times.append(time.process_time() - begin)
    # It was 20 times as long for the last ones.
    assert times[3] < 5 * times[0]


@pytest.mark.parametrize("size", [257, 60_000])
@pytest.mark.parametrize("what", ["topic", "type_name"])
def test_names_have_256_bytes(memory, what, size):
    one = Network().station()
    one.writer()
    attacker = Attacker(one, 1)
    attacker.announce()
    for number, length in enumerate([256] + [size] * 20):
        attacker.endpoint(number << 8 | 4, **{what: "n" * length})
    (known,) = one.core.remotes(writers=False)
    assert len(getattr(known, what)) == 256
    assert one.core.counters["malformed"] == 20
    assert memory() < MEGABYTE


def test_a_topic_is_matched_with_64_endpoints_of_a_peer():
    """Or each sample would go to an address as often as its owner likes."""
    network, one, two, writer = pair()
    attacker = Attacker(one, 1)
    attacker.announce()
    for entity in range(1, 201):
        attacker.endpoint(entity << 8 | 4)
    assert len(writer.matched) == 65 and one.core.counters["not_matched"] == 136
    before = network.bytes_to[EVIL]
    assert serves(network, one, two, writer, [bytes(1000)])
    assert network.bytes_to[EVIL] - before < 64 * 1500


# Memory of readers.


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("kind", ["early", "fragments", "tiny fragments"])
@pytest.mark.sampled(6)
def test_one_writer_does_not_take_the_memory_of_all_others(memory, kind, count):
    network, one, two, writer = pair(memory_bytes=2 * MEGABYTE)
    for number in range(count):
        attacker = Attacker(two, number)
        attacker.announce()
        attacker.endpoint(0x103)
        attacker.send(Heartbeat(reader=0, writer=0x103, first=1, last=0, count=1))
        # Sample 1 never comes.
        for each in range(2, 70):
            part = {"reader": 0, "writer": 0x103, "sequence_number": each}
            if kind == "early":
                attacker.send(Data(payload=bytes(60_000), **part))
            elif kind == "fragments":
                part |= {"count": 1, "fragment_bytes": 60_000, "sample_bytes": 1 << 22}
                attacker.send(DataFrag(first=9, payload=bytes(60_000), **part))
            else:
                part |= {"count": 500, "fragment_bytes": 1, "sample_bytes": 1000}
                attacker.send(DataFrag(first=1, payload=bytes(500), **part))
    assert MEGABYTE < two.core._budget.used <= 2 * MEGABYTE
    assert memory() < 4 * MEGABYTE and two.core.counters["refused"] > 30
    network.loss = 0.1
    payloads = [bytes([number]) * 100_000 for number in range(3)]
    assert serves(network, one, two, writer, payloads)


@pytest.mark.parametrize("size", [(1 << 32) - 1, (64 << 20) + 1])
def test_a_sample_of_4_gb_takes_nothing(memory, size):
    network, one, two, writer = pair()
    attacker = Attacker(two, 1)
    attacker.announce()
    attacker.endpoint(0x103)
    for number in range(1, 301):
        attacker.send(
            DataFrag(
                reader=0,
                writer=0x103,
                sequence_number=number,
                first=1,
                count=1,
                fragment_bytes=60_000,
                sample_bytes=size,
                payload=bytes(60_000),
            )
        )
    assert two.core._budget.used == 0 and two.core.counters["refused"] == 300
    assert memory() < MEGABYTE and serves(network, one, two, writer)


def test_huge_gaps_and_heartbeats_take_neither_memory_nor_time(memory):
    network, one, two, writer = pair()
    attacker = Attacker(two, 1)
    attacker.announce()
    entities = [number << 8 | 3 for number in range(1, 65)]
    for entity in entities:
        attacker.endpoint(entity)
    begin = time.process_time()
    for entity in entities:
        attacker.send(
            Heartbeat(reader=0, writer=entity, first=1, last=1 << 62, count=1),
            *(
                Gap(reader=0, writer=entity, start=start, numbers=NumberSet(1 << 61, (1 << 61,)))
                for start in (2, 3, 1 << 40, 1 << 60)
            ),
            Heartbeat(reader=0, writer=entity, first=1 << 50, last=1 << 62, count=2),
            Gap(reader=0, writer=entity, start=1, numbers=NumberSet(1 << 62)),
        )
        two.core.tick(network.now)
    # As sets of 4,096 numbers, gaps would take 15 MB.
    assert memory() < MEGABYTE and time.process_time() - begin < 10
    assert serves(network, one, two, writer)


def test_what_waits_for_long_is_forgotten():
    network, _, two, _ = pair()
    attacker = Attacker(two, 1)
    attacker.announce()
    attacker.endpoint(0x103)
    attacker.send(Data(reader=0, writer=0x103, sequence_number=2, payload=bytes(60_000)))
    network.run(25)
    assert two.core._budget.used > 60_000
    attacker.announce()
    network.run(10)
    assert two.core._budget.used == 0 and len(two.core.peers) == 2


@pytest.mark.sampled(2)
@pytest.mark.parametrize("size", [0, 1000])
def test_events_that_a_user_does_not_take_are_limited(memory, size, monkeypatch):
    monkeypatch.setattr("firm_hdl.rtps.core._MAX_EVENT_BYTES", MEGABYTE)
    monkeypatch.setattr("firm_hdl.rtps.core._MAX_EVENTS", 1500)
    network, one, two, writer = pair()
    attacker = Attacker(two, 1)
    attacker.announce()
    attacker.endpoint(0x103)
    attacker.send(Heartbeat(reader=0, writer=0x103, first=1, last=0, count=1))
    for number in range(1, 2501):
        if size:
            payload = bytes(size)
            attacker.send(Data(reader=0, writer=0x103, sequence_number=number, payload=payload))
        else:
            attacker.data = replace(attacker.data, name=str(number))
            attacker.announce()
    assert len(two.core.events) <= 1500 and memory() < 4 * MEGABYTE
    assert two.core.counters["refused"] > 1000
    # A reliable sample that comes meanwhile is not lost.
    one.write(writer, b"good")
    assert network.run(5, lambda: two.payloads[-1:] == [b"good"])


# Repairs.


def request(kind, attacker, entity, last):
    """Return a request for all that a writer may have, under a new count."""
    readers = {PUBLICATIONS_WRITER: PUBLICATIONS_READER}
    attacker.count += 1
    common = {"reader": readers.get(entity, 0x104), "writer": entity, "count": attacker.count}
    if kind == "samples":
        return AckNack(missing=NumberSet(1, tuple(range(1, last + 1))), **common)
    if kind == "fragments":
        missing = NumberSet(1, tuple(range(1, 257)))
        return NackFrag(sequence_number=1 + attacker.count % last, missing=missing, **common)
    return AckNack(missing=NumberSet(1), **common)


@pytest.mark.parametrize("kind", ["samples", "fragments", "heartbeat"])
@pytest.mark.parametrize("qos", [Qos(depth=20), KEEP_ALL, DURABLE], ids=["last", "all", "durable"])
@pytest.mark.parametrize("size", [1000, 20_000])
@pytest.mark.sampled(5)
def test_a_storm_of_requests_is_not_amplified(kind, qos, size):
    network, one, two, writer = pair(qos)
    attacker = Attacker(one, 1)
    attacker.announce()
    attacker.endpoint(0x104, qos=replace(qos, depth=1))
    assert serves(network, one, two, writer, [bytes(size)] * 20)
    asked, before = attacker.sent, network.bytes_to[EVIL]
    for _ in range(500):
        attacker.send(request(kind, attacker, writer.guid.entity, 20))
        network.run(0.002)
    gone = network.bytes_to[EVIL] - before
    # What was written may be asked for twice more; requests bring three times their own bytes.
    assert gone < 2 * 20 * (size + 150) + 3 * (attacker.sent - asked) + 1000
    if kind == "samples":
        assert gone > 20 * size and one.core.counters["withheld"] > 100
    assert serves(network, one, two, writer)


def test_requests_for_announcements_are_not_amplified():
    network, one, _, _ = pair()
    for number in range(50):
        one.writer(topic=f"rt/{number}")
    network.run(0.5)
    attacker = Attacker(one, 1)
    attacker.announce()
    history = 50 * 350
    for _ in range(500):
        attacker.send(request("samples", attacker, PUBLICATIONS_WRITER, 51))
        network.run(0.02)
    assert network.bytes_to[EVIL] < 2 * history + 4 * attacker.sent
    late = network.station()
    late.reader(topic="rt/7")
    assert network.run(5, lambda: bool(late.named("Matched")))


def test_readers_that_come_and_go_do_not_get_the_history_each_time():
    network = Network()
    one = network.station()
    writer, history = one.writer(DURABLE), 20 * 5000
    for _ in range(20):
        one.write(writer, bytes(5000))
    attacker = Attacker(one, 1)
    attacker.announce()
    qos = replace(DURABLE, reliability=Reliability.BEST_EFFORT)
    for number in range(1, 501):
        attacker.endpoint(number << 8 | 4, qos=qos)
        attacker.end(number << 8 | 4)
        network.run(0.001)
    # 64 of them do, and one each second.
    assert network.bytes_to[EVIL] < 66 * 2 * history + 3 * attacker.sent


def test_a_storm_of_heartbeats_is_not_amplified():
    network, one, two, writer = pair()
    attacker = Attacker(two, 1)
    attacker.announce()
    attacker.endpoint(0x103)
    common = {"reader": 0, "writer": 0x103}
    part = {**common, "count": 1, "fragment_bytes": 4, "sample_bytes": 40_000}
    for number in range(2, 10):
        attacker.send(DataFrag(sequence_number=number, first=9, payload=bytes(4), **part))
    network.run(1)
    sent, before = attacker.sent, network.bytes_to[EVIL]
    for count in range(0, 4000, 20):
        # Forty in a datagram.
        counts = range(count, count + 20)
        attacker.send(*(Heartbeat(first=1, last=300, count=each, **common) for each in counts))
        attacker.send(
            *(HeartbeatFrag(sequence_number=2, last=9999, count=n, **common) for n in counts)
        )
        network.run(0.0002)
    assert network.bytes_to[EVIL] - before <= 3 * (attacker.sent - sent) + 10_000
    assert serves(network, one, two, writer)


@pytest.mark.parametrize("is_reader_elsewhere", [False, True])
def test_nothing_much_goes_to_a_host_that_others_name(is_reader_elsewhere):
    """A peer on one host says that it, or its reader, is on another one."""
    network, one, two, writer = pair(DURABLE)
    victim = "10.0.0.99"
    attacker = Attacker(one, 1, named=EVIL if is_reader_elsewhere else victim)
    addresses = (Address(victim, 53),) if is_reader_elsewhere else ()
    attacker.announce()
    for entity in range(1, 65):
        attacker.endpoint(entity << 8 | 4, qos=DURABLE, addresses=addresses)
    for _ in range(5):
        attacker.announce()
        for _ in range(20):
            assert serves(network, one, two, writer, [bytes(1000)])
    # It would be 7 MB.
    assert network.bytes_to[victim] < 3.2 * attacker.sent
    assert one.core.counters["withheld"] > 5000


def test_a_reader_that_says_nothing_more_gets_nothing_more():
    """Though its participant is still there: 100 s at most, if it is silent."""
    network, one, two, writer = pair(Qos(depth=20))
    attacker = Attacker(one, 1)
    attacker.announce()
    attacker.endpoint(0x104)
    for _ in range(100):
        assert serves(network, one, two, writer, [bytes(1000)])
        network.run(0.1)
    before = network.bytes_to[EVIL]
    for _ in range(20):
        assert serves(network, one, two, writer, [bytes(1000)] * 20)
        network.run(1)
    # It would be 440 kB.
    assert network.bytes_to[EVIL] - before < 20_000
    # If it answers, it is served as before.
    missing = NumberSet(writer.last + 1)
    attacker.send(AckNack(reader=0x104, writer=writer.guid.entity, missing=missing, count=1))
    before = network.bytes_to[EVIL]
    assert serves(network, one, two, writer, [bytes(1000)] * 20)
    assert network.bytes_to[EVIL] - before > 20_000
    # And it is not kept for ever.
    network.run(70)
    assert len(one.core.peers) == 2
    network.run(31)
    assert [each.prefix for each in one.core.peers] == [two.core.prefix]


def test_a_reader_that_hangs_does_not_stop_a_writer_for_all_others():
    network, one, two, writer = pair(Qos(depth=0, max_samples=50))
    attacker = Attacker(one, 1)
    attacker.announce()
    attacker.endpoint(0x104)
    sent = []
    for number in range(400):
        network.run(0.1)
        attacker.announce()
        with suppress(HistoryFullError):
            one.write(writer, number.to_bytes(4, "big"))
            sent.append(number.to_bytes(4, "big"))
    network.run(1)
    assert two.payloads == sent and len(sent) > 290
    assert one.core.counters["left_behind"] == 1
    # It is waited for again once it has all, but not for long.
    attacker.send(
        AckNack(reader=0x104, writer=writer.guid.entity, missing=NumberSet(len(sent) + 1), count=1)
    )
    for number in range(50):
        one.write(writer, number.to_bytes(4, "big"))
    network.run(0.5)
    with pytest.raises(HistoryFullError):
        one.write(writer, b"full")
    network.run(0.6)
    one.write(writer, b"good")
    assert network.run(1, lambda: two.payloads[-1] == b"good")


def test_submessages_of_strangers_are_counted():
    one = Network().station()
    stranger = Attacker(one, 1)
    stranger.send(*(request("samples", stranger, one.writer().guid.entity, 9) for _ in range(7)))
    assert one.core.counters["strangers"] == 7
