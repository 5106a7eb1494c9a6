"""What a participant that closes does with those that wait for it."""

from __future__ import annotations

import logging
import threading
import time

import pytest

from firm_hdl.rtps import ClosedError, Participant, Qos
from firm_hdl.rtps.transport import Transport
from tests.rtps.test_participant import DOMAIN, OPTIONS, TOPIC, TYPE, wait

HOUR = 3600.0


@pytest.fixture
def pair():
    with Participant(**OPTIONS) as one, Participant(**OPTIONS) as two:
        yield one, two


def started(work):
    """Run a function in a thread; return a list that gets its result, or its error."""
    found = []

    def run():
        try:
            found.append(work())
        except Exception as error:
            found.append(error)

    threading.Thread(target=run, daemon=True).start()
    return found


def test_nobody_waits_longer_than_a_participant_is_open(pair, monkeypatch):
    one, two = pair
    writer = one.writer(TOPIC, TYPE, Qos(depth=0, max_samples=1))
    two.reader(TOPIC, TYPE, lambda sample: None, Qos(depth=0))
    assert writer.wait_for_match()
    # Nothing is acknowledged any more, so the first sample takes all room.
    monkeypatch.setattr(two._core, "receive", lambda *_: None)
    writer.write(b"1234")
    waiting = [
        started(lambda: writer.write(b"1234", timeout=HOUR)),
        started(lambda: writer.wait_for_acknowledgments(HOUR)),
        started(lambda: writer.wait_for_match(2, HOUR)),
    ]
    one.close()
    assert wait(lambda: all(waiting))
    (failed,), *others = waiting
    assert isinstance(failed, ClosedError) and others == [[False], [False]]


def test_a_callback_may_close_its_participant(pair, caplog):
    one, two = pair
    writer = one.writer(TOPIC, TYPE)
    two.reader(TOPIC, TYPE, lambda sample: two.close())
    assert writer.wait_for_match()
    with caplog.at_level(logging.ERROR, "firm_hdl.rtps"):
        writer.write(b"1234")
        assert wait(lambda: not two._thread.is_alive())
    assert not caplog.records


def test_what_was_written_arrives_before_its_writer_leaves(pair):
    """Though it takes a while: 300 kB at 1 MB/s."""
    _, two = pair
    got = []
    two.reader(TOPIC, TYPE, got.append, Qos(depth=0))
    for close_all in (True, False):
        got.clear()
        one = Participant(**OPTIONS, bytes_per_second=1e6)
        writer = one.writer(TOPIC, TYPE, Qos(depth=0))
        assert writer.wait_for_match()
        for number in range(15):
            writer.write(bytes([number]) * 20_000)
        (one if close_all else writer).close()
        assert wait(lambda: len(got) == 15)
        assert [each.payload[0] for each in got] == list(range(15))
        assert not (one.counters["unsent"] or one.counters["unacknowledged"])
        one.close()


def test_closing_waits_for_a_second_at_most_and_counts_what_is_left(pair, monkeypatch):
    one, two = pair
    writer = one.writer(TOPIC, TYPE)
    two.reader(TOPIC, TYPE, lambda sample: None)
    assert writer.wait_for_match()
    monkeypatch.setattr(two._core, "receive", lambda *_: None)
    for _ in range(12):
        writer.write(b"1234")
    begin = time.monotonic()
    one.close()
    assert 0.9 < time.monotonic() - begin < 10
    # Two of them had given way before.
    assert writer.overwritten == one.counters["overwritten"] == 2
    assert one.counters["unacknowledged"] == 10


def test_a_participant_that_has_left_says_nothing_more(pair):
    one, two = pair
    writer, reader = one.writer(TOPIC, TYPE), one.reader(TOPIC, TYPE, lambda sample: None)
    two.reader(TOPIC, TYPE, lambda sample: None)
    assert writer.wait_for_match()
    one.close()
    sent = one.counters["sent"]
    for each in (writer, reader):
        each.close()
    one.close()
    assert one.counters["sent"] == sent > 0 and not one._core.outbox


BURST = 64 << 10
MOST_DATAGRAM = 1500


class NotingTransport(Transport):
    """A transport that notes the sizes of datagrams, and says whether the system takes them."""

    def __init__(self, takes=True):
        super().__init__(DOMAIN, OPTIONS["interface"])
        self.takes, self.sizes = takes, []

    def send(self, address, datagram):
        self.sizes.append(len(datagram))
        return super().send(address, datagram) and self.takes


def slow_participant(transport):
    """Return a participant that sends a byte per second after its first burst."""
    return Participant(**OPTIONS, bytes_per_second=1.0, transport=transport)


@pytest.fixture
def other():
    with Participant(**OPTIONS) as made:
        yield made


def test_no_more_than_a_burst_is_sent_at_once_and_what_is_left_at_the_end_is_counted(other):
    transport = NotingTransport()
    made = slow_participant(transport)
    other.reader(TOPIC, TYPE, lambda sample: None)
    writer = made.writer(TOPIC, TYPE, Qos(depth=0))
    assert writer.wait_for_match()
    writer.write(bytes(300_000))
    assert sum(transport.sizes) < BURST + MOST_DATAGRAM
    fragments = -(-300_000 // 1280)
    begun = len(transport.sizes)
    made.close()
    # Heartbeats wait, too. The farewell does not.
    assert made.counters["unsent"] >= fragments - begun > 0
    assert made.counters["unacknowledged"] == 1
    assert made.counters["sent"] == len(transport.sizes) > begun
    assert not made.counters["dropped"]


def test_datagrams_that_the_system_does_not_take_are_counted():
    transport = NotingTransport(takes=False)
    made = slow_participant(transport)
    assert wait(lambda: transport.sizes)
    made.close()
    assert made.counters["dropped"] == made.counters["sent"] == len(transport.sizes)
