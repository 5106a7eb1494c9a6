"""Participants in a simulated network: discovery, reliability, fragments, faults of peers."""

from __future__ import annotations

from functools import partial

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from firm_hdl.rtps import Durability, Qos, Reliability, SampleIdentity
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.submessages import AckNack, Data
from tests.depth import by_depth
from tests.rtps.network import Network

# A busy machine is no fault.
SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]

KEEP_ALL = Qos(depth=0)
BEST_EFFORT = Qos(reliability=Reliability.BEST_EFFORT)
DURABLE = Qos(durability=Durability.TRANSIENT_LOCAL, depth=5)
SIZES = st.lists(st.sampled_from([4, 100, 1280, 1281, 2560, 5000]), min_size=1, max_size=30)


def pair(network, writer_qos=KEEP_ALL, reader_qos=KEEP_ALL):
    """Return two stations that found each other, and the writer of the first."""
    one, two = network.station(), network.station()
    writer, _ = one.writer(writer_qos), two.reader(reader_qos)
    assert network.run(60, lambda: one.named("Matched") and two.named("Matched"))
    return one, two, writer


def payloads(sizes):
    return [number.to_bytes(4, "big") + bytes(size - 4) for number, size in enumerate(sizes)]


def sent_to(station, kind):
    """Return all submessages of a kind that were sent to a station."""
    read = (message.read(each, station.core.prefix) for each in station.network.sent)
    every = [each.submessage for content in read for each in content.received]
    return [each for each in every if isinstance(each, kind)]


@given(
    seed=st.integers(0, 2**32),
    loss=st.floats(0, 0.3),
    repeat=st.floats(0, 0.3),
    delay=st.sampled_from([1e-5, 0.01, 0.2]),
    sizes=SIZES,
)
@settings(max_examples=by_depth(25, 1000), deadline=None, suppress_health_check=SLOW)
def test_reliable_samples_come_once_and_in_order(seed, loss, repeat, delay, sizes):
    network = Network(seed, loss, repeat, delay)
    one, two, writer = pair(network)
    sent = payloads(sizes)
    for each in sent:
        one.write(writer, each)
        network.run(0.003)
    assert network.run(120, lambda: len(two.payloads) >= len(sent) and writer.acknowledged)
    assert two.payloads == sent
    assert [each.sequence_number for each in two.samples] == list(range(1, len(sent) + 1))


def test_that_losses_would_be_noticed(monkeypatch):
    """The twin: without ACKNACKs, the same network loses samples."""
    network = Network()
    one, two, writer = pair(network)
    monkeypatch.setattr(Reader, "_answer", lambda self, proxy, now: None)
    network.loss = 0.3
    for each in payloads([100] * 30):
        one.write(writer, each)
    assert not network.run(30, lambda: len(two.payloads) == 30)
    assert not writer.acknowledged


@given(seed=st.integers(0, 2**32), sizes=SIZES)
@settings(max_examples=by_depth(10, 300), deadline=None, suppress_health_check=SLOW)
def test_best_effort_samples_come_at_most_once_and_in_order(seed, sizes):
    network = Network(seed, 0, 0.3, 0.05)
    one, two, writer = pair(network, BEST_EFFORT, BEST_EFFORT)
    network.loss = 0.2
    sent = payloads(sizes)
    for each in sent:
        one.write(writer, each)
        network.run(0.01)
    network.run(5)
    numbers = [each.sequence_number for each in two.samples]
    assert numbers == sorted(set(numbers))
    assert [sent[n - 1] for n in numbers] == two.payloads
    assert not [each for each in sent_to(one, AckNack) if each.writer == writer.guid.entity]


def test_the_end_of_an_instance_is_no_sample():
    network = Network()
    one, two, writer = pair(network)
    one.write(writer, b"abcd")
    writer.write(b"key.", network.now, key=True)
    writer.write(None, network.now)
    one.write(writer, b"efgh")
    network.run(1)
    assert two.payloads == [b"abcd", b"efgh"]


def test_a_late_reader_gets_what_a_durable_writer_keeps():
    network = Network(loss=0.2, seed=3)
    one, two, writer = pair(network, DURABLE, DURABLE)
    sent = payloads([8] * 12 + [4000])
    for each in sent:
        one.write(writer, each)
        network.run(0.5)
    network.run(5)
    assert two.payloads == sent
    late, volatile = network.station(), network.station()
    late.reader(DURABLE)
    volatile.reader()
    assert network.run(60, lambda: len(late.payloads) >= 5)
    network.run(5)
    assert late.payloads == sent[-5:]
    assert volatile.payloads == []


@pytest.mark.parametrize(
    "other", [{"topic": "rt/u"}, {"type_name": "p::msg::dds_::U_"}], ids=["topic", "type"]
)
def test_other_topics_and_types_do_not_match(other):
    network = Network()
    one, two = network.station(), network.station()
    one.writer()
    two.reader(**other)
    network.run(5)
    assert not one.named("Matched") and not one.named("Incompatible")


def test_a_peer_that_leaves_and_one_that_is_silent():
    network = Network()
    one, two, _ = pair(network)
    three = network.station(lease=2.0)
    assert network.run(5, lambda: len(one.core.peers) == 2)
    two.core.leave()
    network.run(0.1)
    assert [each.expired for each in one.named("PeerLost")] == [False]
    assert len(one.named("Unmatched")) == 1
    two.dead = three.dead = True
    network.run(1.5)
    assert len(one.named("PeerLost")) == 1
    network.run(1)
    assert [each.expired for each in one.named("PeerLost")] == [False, True]
    assert one.core.peers == ()


def test_a_peer_that_starts_again_is_a_new_one():
    network = Network()
    one, two, writer = pair(network)
    one.write(writer, b"old.")
    network.run(1)
    two.dead = True
    again = network.station()
    again.reader(KEEP_ALL)
    assert network.run(5, lambda: len(writer.matched) == 2)
    one.write(writer, b"new.")
    assert network.run(1, lambda: again.payloads == [b"new."])
    # The dead one holds nothing up once its lease is over.
    network.run(15)
    assert writer.acknowledged and len(writer.matched) == 1


@pytest.mark.parametrize("qos", [KEEP_ALL, BEST_EFFORT], ids=["reliable", "best effort"])
def test_a_peer_that_starts_again_under_its_old_name_is_heard_from_its_beginning(qos):
    network = Network(seed=1, delay=0.2)
    prefix = b"\x01\x10" + bytes(9) + b"\x07"
    one = network.station()
    one.reader(qos)
    sent = payloads([8] * 30)
    for begin in (0, 20):
        two = network.station(prefix)
        writer = two.writer(KEEP_ALL)
        # Endpoints that it had before have other numbers now.
        two.writer(KEEP_ALL, topic=f"rt/{begin}")
        assert network.run(10, lambda two=two: bool(two.named("Matched")))
        # The reader's participant finds out after a second.
        network.run(3)
        for each in sent[begin : begin + 20]:
            two.write(writer, each)
            network.run(0.3)
        network.run(2)
        two.dead = True
        network.stations.remove(two)
    assert one.payloads == sent[:20] + sent[20:]
    topics = [each.topic for each in one.core.remotes(writers=True)]
    assert sorted(topics) == ["rt/20", "rt/t"]
    assert one.core.counters["restarted"] >= 1


def test_a_sample_may_be_for_some_readers_alone():
    network = Network(seed=4, loss=0.2)
    one, two, three = (network.station() for _ in range(3))
    writer = one.writer(KEEP_ALL)
    own, other = two.reader(KEEP_ALL), three.reader(KEEP_ALL)
    network.run(5)
    sent = payloads([8] * 40)
    for number, each in enumerate(sent):
        to = (own, other)[number % 2].guid
        one.core.write(writer, each, network.now, None, to=[to])
        network.run(0.01)
    assert network.run(20, lambda: writer.acknowledged)
    # Each got its own, and waited for nothing else.
    assert (two.payloads, three.payloads) == (sent[::2], sent[1::2])
    assert own.lost == other.lost == 0
    assert not [each for each in sent_to(three, Data) if each.payload in sent[::2]]


def test_endpoints_come_and_go():
    network = Network(seed=5, loss=0.2)
    one, two, writer = pair(network)
    first = two.reader()
    assert network.run(20, lambda: len(writer.matched) == 2)
    two.core.remove(first.guid, network.now)
    assert network.run(20, lambda: len(writer.matched) == 1)
    one.core.remove(writer.guid, network.now)
    assert network.run(20, lambda: len(two.named("Unmatched")) == 2)
    # The announcement of what is gone is not kept: a new station hears of nothing.
    late = network.station()
    late.reader()
    network.run(5)
    assert not late.named("Matched")
    assert [each.topic for each in late.core.remotes(writers=True)] == []


def test_a_peer_that_multicast_does_not_reach():
    network = Network(seed=1)
    one, two = network.station(lease=3.0), network.station()
    two.deaf = True
    network.loss = 0.3
    assert network.run(10, lambda: len(two.core.peers) == len(one.core.peers) == 1)
    network.loss = 0
    network.run(20)
    assert not two.named("PeerLost")
    one.core.leave()
    assert network.run(0.1, lambda: len(two.named("PeerLost")) == 1)


def test_a_peer_that_did_not_listen_yet():
    network = Network()
    one, two = network.station(), network.station()
    two.deaf = True
    two.core.receive, listening = lambda *_: None, two.core.receive
    assert network.run(1, lambda: len(one.core.peers) == 1)
    network.run(0.01)
    two.core.receive = listening
    assert network.run(0.2, lambda: len(two.core.peers) == 1)


def test_participants_of_another_domain_are_none():
    network = Network()
    one, two = network.station(domain=0), network.station(domain=1)
    network.run(3)
    assert one.core.peers == two.core.peers == ()
    # One that does not say its domain is taken for one of this domain: old versions do not say it.
    network.station(domain=None)
    network.run(3)
    assert len(one.core.peers) == len(two.core.peers) == 1


def test_samples_go_in_fragments_that_fit_an_ethernet_frame():
    network = Network()
    one, two, writer = pair(network)
    related = SampleIdentity(Guid(bytes(12), 0x1304), 1)
    one.core.write(writer, bytes(1_000_000), network.now, 1, related)
    one.core.write(writer, bytes(1280), network.now, 1, related)
    network.run(1)
    assert [len(each) for each in two.payloads] == [1_000_000, 1280]
    assert max(map(len, network.sent)) <= 1472


def test_peers_of_the_other_byte_order(monkeypatch):
    monkeypatch.setattr(message, "write", partial(message.write, little=False))
    network = Network(seed=2, loss=0.1)
    one, two, writer = pair(network)
    sent = payloads([8, 5000, 100, 3000])
    for each in sent:
        one.write(writer, each)
    assert network.run(20, lambda: two.payloads == sent)
    assert not any(datagram[21] & 1 for datagram in network.sent)
