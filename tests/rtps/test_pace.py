"""How fast a participant sends: a burst at once, and the rest at its rate, or when it closes."""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Participant, Qos
from firm_hdl.rtps.pacing import Pacer
from firm_hdl.rtps.transport import Transport
from tests.rtps.test_participant import DOMAIN, OPTIONS, TOPIC, TYPE, wait

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


def test_no_more_than_a_burst_is_sent_at_once_and_all_at_the_end(other):
    transport = NotingTransport()
    made = slow_participant(transport)
    other.reader(TOPIC, TYPE, lambda sample: None)
    writer = made.writer(TOPIC, TYPE, Qos(depth=0))
    assert writer.wait_for_match()
    writer.write(bytes(300_000))
    assert sum(transport.sizes) < BURST + MOST_DATAGRAM
    made.close()
    assert sum(transport.sizes) > 300_000
    assert made.counters["sent"] == len(transport.sizes)
    assert not made.counters["dropped"]


def test_datagrams_that_the_system_does_not_take_are_counted():
    transport = NotingTransport(takes=False)
    made = slow_participant(transport)
    assert wait(lambda: transport.sizes)
    made.close()
    assert made.counters["dropped"] == made.counters["sent"] == len(transport.sizes)


def passed(pacer, now):
    """Send datagrams of 1,024 bytes while there is no pause; return how many, and the pause."""
    for count in range(1000):
        if (pause := pacer.wait(now)) > 0:
            return count, pause
        pacer.note(1024)
    raise AssertionError


def test_after_a_pause_a_chunk_passes_at_once():
    """64 KiB at first, then 16 KiB after each pause, at 1,000 bytes per second."""
    pacer = Pacer(1000.0)
    assert passed(pacer, 0.0) == (64, pytest.approx(16.384))
    # The pause is not over.
    assert passed(pacer, 10.0) == (0, pytest.approx(6.384))
    # 17,000 bytes: the 17th datagram has 616 of them, and leaves a debt of 408.
    assert passed(pacer, 17.0) == (17, pytest.approx(16.792))
    # However long nothing is sent, no more than 64 KiB pass.
    assert passed(pacer, 1e6) == (64, pytest.approx(16.384))
