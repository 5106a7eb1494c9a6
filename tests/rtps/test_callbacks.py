"""What a participant announces, what it tells its user, and whom it forgets."""

from __future__ import annotations

import threading

import pytest

from firm_hdl.rtps import Durability, Participant, Qos
from firm_hdl.rtps.transport import Transport
from tests.rtps.test_participant import DOMAIN, OPTIONS, TOPIC, TYPE, wait

HERE = "127.0.0.1"


class NotingTransport(Transport):
    """A transport that sends nothing, and notes where to."""

    def __init__(self, domain, host):
        super().__init__(domain, host)
        self.addresses = []

    def send(self, address, datagram):
        self.addresses.append(address)
        return True


def discovery(host):
    """Return the addresses of the first five participants of a host (9.6.2.3 of the standard)."""
    return [(host, 7400 + 250 * DOMAIN + 10 + 2 * number) for number in range(5)]


@pytest.mark.parametrize(
    ("options", "targets"),
    [
        ({}, [("239.255.0.1", 7400 + 250 * DOMAIN), *discovery(HERE)]),
        ({"multicast": False}, discovery(HERE)),
        # Each host once.
        (
            {"multicast": False, "peers": ("10.0.0.5", HERE, "10.0.0.5", "10.0.0.4")},
            [*discovery(HERE), *discovery("10.0.0.5"), *discovery("10.0.0.4")],
        ),
    ],
)
def test_announcements_go_to_the_group_and_to_named_hosts(options, targets):
    transport = NotingTransport(DOMAIN, HERE)
    with Participant(DOMAIN, interface=HERE, transport=transport, **options) as made:
        assert [tuple(each) for each in made._core.settings.targets] == targets
        assert wait(lambda: {*targets} <= {tuple(each) for each in transport.addresses})


def test_a_participant_is_what_its_options_say():
    given = {"name": "n", "user_data": b"u", "lease": 7.0, "period": 0.5, "fragment_bytes": 999}
    with Participant(**OPTIONS, **given) as made:
        settings = made._core.settings
        assert (settings.period, settings.fragment_bytes, settings.host) == (0.5, 999, HERE)
        own = settings.own
        assert (own.name, own.user_data, own.lease, own.domain) == ("n", b"u", 7.0, DOMAIN)
        assert own.prefix == made.prefix
        assert (own.discovery, own.user) == ((made._transport.discovery,), (made._transport.user,))
        assert made._transport.participant in range(120)


@pytest.fixture
def told():
    return []


@pytest.fixture
def pair(told):
    def note(event):
        told.append(type(event).__name__)

    # It says that it leaves: nobody here waits until it is taken for gone.
    with Participant(**OPTIONS, on_event=note) as one, Participant(**OPTIONS, lease=500.0) as two:
        yield one, two


def test_a_user_is_told_of_peers_and_matches_and_not_of_samples(pair, told):
    one, two = pair
    got = []
    reader = one.reader(TOPIC, TYPE, got.append, user_data=b"r")
    writer = two.writer(TOPIC, TYPE, user_data=b"w")
    assert writer.wait_for_match() and reader.wait_for_match()
    ((found,), (back,)) = reader.matched, writer.matched
    assert (found.guid, found.user_data, found.topic) == (writer.guid, b"w", TOPIC)
    assert (back.guid, back.user_data, back.type_name) == (reader.guid, b"r", TYPE)
    assert [each.guid for each in one.remotes(True)] == [writer.guid]
    assert [each.guid for each in two.remotes(False)] == [reader.guid]
    assert one.remotes(False) == two.remotes(True) == ()
    writer.write(b"abcd")
    assert wait(lambda: got) and got[0].payload == b"abcd"
    assert [each.prefix for each in one.peers] == [two.prefix]
    two.close()
    assert wait(lambda: not one.peers and "PeerLost" in told)
    assert reader.matched == () and one.remotes(True) == ()
    assert told == ["PeerFound", "Matched", "Unmatched", "PeerLost"]


def test_each_callback_is_that_of_its_endpoint(pair):
    one, two = pair
    matches, clashes = [], []

    def notes(name):
        return {
            "on_match": lambda remote, came: matches.append((name, remote.guid, came)),
            "on_incompatible": lambda remote, policies: clashes.append((name, policies)),
        }

    first = one.reader(TOPIC, TYPE, print, **notes("first"))
    one.reader("rt/other", TYPE, print, **notes("other"))
    durable = Qos(durability=Durability.TRANSIENT_LOCAL)
    one.reader(TOPIC, TYPE, print, durable, **notes("durable"))
    writer = two.writer(TOPIC, TYPE, **notes("writer"))
    assert writer.wait_for_match() and wait(lambda: len(clashes) == 2)
    assert {name for name, _ in clashes} == {"durable", "writer"}
    assert {policies for _, policies in clashes} == {("DURABILITY",)}
    # A reader that is closed is told nothing more, and the writer that it is gone.
    first.close()
    assert wait(lambda: ("writer", first.guid, False) in matches)
    assert matches.count(("first", writer.guid, True)) == 1
    assert {name for name, _, _ in matches} == {"first", "writer"}
    assert first.guid not in one._endpoints and len(one._endpoints) == 2


def test_endpoints_without_callbacks_are_told_nothing_and_the_user_of_all(pair, told, caplog):
    one, two = pair
    writer = two.writer(TOPIC, TYPE)
    reader = one.reader(TOPIC, TYPE, print)
    durable = one.reader(TOPIC, TYPE, print, Qos(durability=Durability.TRANSIENT_LOCAL))
    assert wait(lambda: {"Matched", "Incompatible"} <= {*told})
    assert reader.matched and writer.wait_for_match() and durable.matched == ()
    assert [each.message for each in caplog.records] == []


def test_callbacks_may_close_endpoints_that_are_to_be_told_next(pair, told, caplog):
    """Two readers match, and two clash; that which is told first closes the other of its kind."""
    one, two = pair
    pairs, heard = {}, []

    def notes(kind, number):
        def note(*_):
            heard.append(kind)
            pairs[kind][1 - number].close()

        return {"on_match": note, "on_incompatible": note}

    durable = Qos(durability=Durability.TRANSIENT_LOCAL)
    for kind, qos in (("fits", Qos()), ("clashes", durable)):
        pairs[kind] = [
            one.reader(TOPIC, TYPE, print, qos, **notes(kind, number)) for number in (0, 1)
        ]
    two.writer(TOPIC, TYPE)
    assert wait(lambda: told.count("Matched") == told.count("Incompatible") == 2)
    assert sorted(heard) == ["clashes", "fits"] and len(one._endpoints) == 2
    assert [each.message for each in caplog.records] == []


def test_a_reader_that_closes_itself_gets_no_sample_that_has_arrived(pair, caplog):
    one, two = pair
    heard, sent = [], threading.Event()

    def take(sample):
        heard.append(sample.payload)
        if len(heard) == 1:
            sent.wait(20)
        else:
            reader.close()

    reader = one.reader(TOPIC, TYPE, take)
    writer = two.writer(TOPIC, TYPE)
    assert writer.wait_for_match()
    for payload in (b"1...", b"2...", b"3..."):
        writer.write(payload)
    sent.set()
    assert wait(lambda: not writer.matched)
    one.close()
    assert heard == [b"1...", b"2..."] and [each.message for each in caplog.records] == []


def test_closing_twice_is_closing_once():
    made = Participant(**OPTIONS)
    writer = made.writer(TOPIC, TYPE)
    made.close()
    sent = made.counters["sent"]
    made.close()
    # Nor does an endpoint say that it is gone from what is closed.
    writer.close()
    assert made.counters["sent"] == sent and not made._thread.is_alive()
